/* MFEM's .mesh: sections of a word, a count, and a line each; elements stand before the vertices,
   so they are read when these are known. */
#include <string.h>

#include "mesh_read.h"

typedef struct mfem {
  corot_reader r;
  corot_draft d;
  size_t elements, boundary; /* where the sections begin, behind their word; 0: there is none */
  bool has_nodes;
} mfem;

/* MFEM's numbers of shapes. */
static const struct {
  int number, dim, nnode;
  corot_draft_kind kind;
} shapes[] = {
    {2, 2, 3, DRAFT_SIMPLEX}, {3, 2, 4, DRAFT_QUAD},  {4, 3, 4, DRAFT_SIMPLEX},
    {5, 3, 8, DRAFT_HEX},     {6, 3, 6, DRAFT_PRISM}, {7, 3, 5, DRAFT_PYRAMID},
};

static const char *const words[] = {"dimension",       "elements",       "boundary",
                                    "vertices",        "attribute_sets", "bdr_attribute_sets",
                                    "nodes",           "nc_mesh",        "vertex_parents",
                                    "coarse_elements", "mfem_mesh_end"};

static bool is_word_here(const corot_reader *r) {
  for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
    size_t n = strlen(words[i]);
    if (strncmp(r->data + r->at, words[i], n) == 0 && strchr(" \t\r\n", r->data[r->at + n]))
      return true;
  }
  return false;
}

static void skip_section(corot_reader *r) {
  corot_reader_skip_lines(r);
  while (r->at < r->size && !is_word_here(r)) {
    corot_reader_skip_line(r);
    corot_reader_skip_lines(r);
  }
}

static corot_status read_dimension(corot_reader *r) {
  int dim;
  corot_reader_skip_lines(r);
  size_t at = r->at;
  COROT_TRY(corot_reader_int(r, "the dimension", &dim));
  if (dim != 3) return corot_reader_fail(r, at, "the dimension is %d, not 3", dim);
  return COROT_OK;
}

/* N, 3, then N points. Curved meshes have no such number, but nodes behind it. */
static corot_status read_vertices(mfem *m) {
  corot_reader *r = &m->r;
  int n;
  if (m->has_nodes) return corot_reader_fail(r, r->at, "vertices are listed twice");
  COROT_TRY(corot_reader_count_line(r, "the number of vertices", 1, &n));
  if (r->at >= r->size || is_word_here(r)) return COROT_OK;
  m->has_nodes = true;
  COROT_TRY(read_dimension(r));
  COROT_TRY(corot_reader_end_line(r));
  COROT_TRY(corot_draft_alloc_nodes(&m->d, n));
  for (int i = 0; i < n; i++) {
    m->d.node[i] = (corot_draft_node){i, r->at};
    COROT_TRY(corot_reader_point(r, m->d.x[i]));
    COROT_TRY(corot_reader_end_line(r));
  }
  return corot_draft_index_nodes(&m->d);
}

/* ATTRIBUTE SHAPE VERTEX..., of elements of that dimension. */
static corot_status read_element(mfem *m, int dim, int number) {
  corot_reader *r = &m->r;
  corot_draft_element e = {.tag = number, .at = r->at, .dim = dim};
  int attribute, shape, nnode = 0, middle[NMIDDLE_MAX];
  COROT_TRY(corot_reader_int(r, "an attribute", &attribute));
  COROT_TRY(corot_reader_int(r, "a shape", &shape));
  for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++)
    if (shapes[i].number == shape && shapes[i].dim == dim)
      nnode = shapes[i].nnode, e.kind = shapes[i].kind;
  if (nnode == 0)
    return corot_reader_fail(r, e.at, "%s %d is of shape %d, which there is not in %d dimensions",
                             corot_draft_word(&m->d, &e), number, shape, dim);
  for (int k = 0; k < nnode; k++) {
    int64_t tag;
    COROT_TRY(corot_reader_long(r, "a vertex", &tag));
    corot_draft_find_node(&m->d, &e, tag, corot_draft_slot(&e, middle, k));
  }
  COROT_TRY(corot_reader_end_line(r));
  if (dim == 2 && attribute <= 0) return COROT_OK;
  COROT_TRY(corot_draft_add_element(&m->d, &e, nnode > 4 ? middle : NULL));
  return corot_draft_add_member(&m->d, (int)m->d.nelement - 1, attribute > 0 ? attribute : 0);
}

static corot_status read_elements(mfem *m, int dim, size_t at) {
  int n;
  m->r.at = at;
  COROT_TRY(corot_reader_count_line(&m->r, "the number of elements", 9, &n));
  for (int i = 0; i < n; i++) COROT_TRY(read_element(m, dim, i + 1));
  return COROT_OK;
}

static corot_status read_section(mfem *m) {
  corot_reader *r = &m->r;
  size_t *begin = NULL, at = r->at;
  if (corot_reader_word(r, "dimension")) return read_dimension(r);
  if (corot_reader_word(r, "vertices")) return read_vertices(m);
  if (corot_reader_word(r, "nodes"))
    return corot_reader_fail(r, at,
                             "the mesh is curved, by nodes of a finite element space, which is not "
                             "supported: save it with vertices alone");
  if (corot_reader_word(r, "elements")) begin = &m->elements;
  if (!begin && corot_reader_word(r, "boundary")) begin = &m->boundary;
  if (begin && *begin) return corot_reader_fail(r, at, "elements are listed twice");
  if (begin) *begin = r->at;
  if (!begin) corot_reader_skip_line(r);
  skip_section(r);
  return COROT_OK;
}

static corot_status parse(mfem *m, corot_mesh **mesh) {
  corot_reader *r = &m->r;
  corot_reader_skip_lines(r);
  corot_reader_skip_line(r); /* MFEM mesh v1.0 */
  for (corot_reader_skip_lines(r); r->at < r->size; corot_reader_skip_lines(r))
    COROT_TRY(read_section(m));
  if (!m->has_nodes) return corot_fail(COROT_EFORMAT, "%s: the file has no vertices", r->path);
  if (!m->elements) return corot_fail(COROT_EFORMAT, "%s: the file has no elements", r->path);
  COROT_TRY(read_elements(m, 3, m->elements));
  if (m->boundary) COROT_TRY(read_elements(m, 2, m->boundary));
  return corot_draft_finish(&m->d, mesh);
}

corot_status corot_mfem_parse(const char *path, const char *data, size_t size,
                              const corot_reading *how, corot_mesh **mesh) {
  mfem m = {.r = {.path = path, .data = data, .size = size, .comment = '#'}};
  m.d.how = how;
  m.d.node_file = m.d.element_file = m.d.face_file = &m.r;
  corot_status status = corot_draft_end(&m.d, parse(&m, mesh));
  corot_draft_clear(&m.d);
  return status;
}
