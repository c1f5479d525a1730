/* MEDIT's .mesh in ASCII, as Mmg, gmsh and FreeFEM write it: keywords, counts and numbers, wherever
   the lines end. */
#include <string.h>

#include "mesh_read.h"

typedef struct medit {
  corot_reader r;
  corot_draft d;
  bool has_nodes, has_tets;
} medit;

/* A list of elements. */
typedef struct list {
  const char *name;
  int dim, nnode; /* nnode 0: solids that are not supported */
  corot_draft_kind kind;
} list;

static const list lists[] = {
    {"Triangles", 2, 3, DRAFT_SIMPLEX},     {"TrianglesP2", 2, 6, DRAFT_SIMPLEX},
    {"Quadrilaterals", 2, 4, DRAFT_QUAD},   {"Tetrahedra", 3, 4, DRAFT_SIMPLEX},
    {"TetrahedraP2", 3, 10, DRAFT_SIMPLEX}, {"TetrahedraP3", 3, 0, DRAFT_SIMPLEX},
    {"TetrahedraP4", 3, 0, DRAFT_SIMPLEX},  {"Hexahedra", 3, 8, DRAFT_HEX},
    {"HexahedraQ2", 3, 0, DRAFT_HEX},       {"Prisms", 3, 6, DRAFT_PRISM},
    {"PrismsP2", 3, 0, DRAFT_PRISM},        {"Pentahedra", 3, 6, DRAFT_PRISM},
    {"PentahedraP2", 3, 0, DRAFT_PRISM},    {"Pyramids", 3, 5, DRAFT_PYRAMID},
    {"PyramidsP2", 3, 0, DRAFT_PYRAMID},
};

static corot_status read_dimension(medit *m) {
  int dim;
  corot_reader_skip_lines(&m->r);
  size_t at = m->r.at;
  COROT_TRY(corot_reader_int(&m->r, "the dimension", &dim));
  if (dim != 3) return corot_reader_fail(&m->r, at, "the dimension is %d, not 3", dim);
  return COROT_OK;
}

/* N, then N times "X Y Z REFERENCE". */
static corot_status read_nodes(medit *m) {
  corot_reader *r = &m->r;
  int n;
  int64_t ignored;
  if (m->has_nodes) return corot_reader_fail(r, r->at, "Vertices are listed twice");
  m->has_nodes = true;
  COROT_TRY(corot_reader_count(r, "the number of vertices", 8, &n));
  COROT_TRY(corot_draft_alloc_nodes(&m->d, n));
  for (int i = 0; i < n; i++) {
    corot_reader_skip_lines(r);
    m->d.node[i] = (corot_draft_node){i + 1, r->at};
    COROT_TRY(corot_reader_point(r, m->d.x[i]));
    COROT_TRY(corot_reader_long(r, "a reference", &ignored));
  }
  return corot_draft_index_nodes(&m->d);
}

/* "NODE... REFERENCE"; references other than 0 are groups. */
static corot_status read_element(medit *m, const list *l, int number) {
  corot_reader *r = &m->r;
  int middle[NMIDDLE_MAX], reference;
  int64_t tag;
  corot_reader_skip_lines(r);
  corot_draft_element element = {.tag = number, .at = r->at, .dim = l->dim, .kind = l->kind};
  for (int i = 0; i < l->nnode; i++) {
    COROT_TRY(corot_reader_long(r, "a vertex", &tag));
    corot_draft_find_node(&m->d, &element, tag, corot_draft_slot(&element, middle, i));
  }
  COROT_TRY(corot_reader_int(r, "a reference", &reference));
  if (reference < 0)
    return corot_reader_fail(
        r, element.at, "the reference is %d: groups have positive ones, 0 is none", reference);
  if (l->dim == 2 && reference == 0) return COROT_OK;
  COROT_TRY(corot_draft_add_element(&m->d, &element, l->nnode > 4 ? middle : NULL));
  return corot_draft_add_member(&m->d, (int)m->d.nelement - 1, reference);
}

static corot_status read_elements(medit *m, const list *l) {
  corot_reader *r = &m->r;
  int n;
  corot_reader_skip_lines(r);
  size_t at = r->at;
  COROT_TRY(
      corot_reader_count(r, "the number of elements", l->nnode ? 2 * (size_t)l->nnode + 1 : 1, &n));
  if (n > 0 && l->nnode == 0)
    return corot_reader_fail(
        r, at,
        "the file has %s: only tets of 4 or 10 nodes are supported, and other solids "
        "of first order, to be cut into tets",
        l->name);
  if (!m->has_nodes) return corot_reader_fail(r, at, "%s are listed before Vertices", l->name);
  for (int i = 0; i < n; i++) COROT_TRY(read_element(m, l, i + 1));
  m->has_tets = m->has_tets || (l->dim == 3 && n > 0);
  return COROT_OK;
}

static bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }

/* Goes past a keyword that is of no use here, and its numbers. */
static void skip_keyword(corot_reader *r) {
  do {
    while (r->at < r->size && (r->data[r->at] == 0 || !strchr(" \t\r\n", r->data[r->at]))) r->at++;
    corot_reader_skip_lines(r);
  } while (r->at < r->size && !is_letter(r->data[r->at]));
}

static corot_status read_keyword(medit *m) {
  corot_reader *r = &m->r;
  size_t at = r->at;
  if (!is_letter(r->data[at])) return corot_reader_fail(r, at, "expected a keyword");
  if (corot_reader_word(r, "Dimension")) return read_dimension(m);
  if (corot_reader_word(r, "Vertices")) return read_nodes(m);
  for (size_t i = 0; i < sizeof lists / sizeof *lists; i++)
    if (corot_reader_word(r, lists[i].name)) return read_elements(m, &lists[i]);
  if (corot_reader_word(r, "End"))
    r->at = r->size;
  else
    skip_keyword(r);
  return COROT_OK;
}

static corot_status parse(medit *m, corot_mesh **mesh) {
  corot_reader *r = &m->r;
  corot_reader_skip_lines(r);
  while (r->at < r->size) {
    COROT_TRY(read_keyword(m));
    corot_reader_skip_lines(r);
  }
  if (!m->has_nodes) return corot_fail(COROT_EFORMAT, "%s: the file has no Vertices", r->path);
  if (!m->has_tets) return corot_fail(COROT_EFORMAT, "%s: the file has no Tetrahedra", r->path);
  return corot_draft_finish(&m->d, mesh);
}

corot_status corot_medit_parse(const char *path, const char *data, size_t size,
                               const corot_reading *how, corot_mesh **mesh) {
  medit m = {.r = {.path = path, .data = data, .size = size, .comment = '#', .flows = true}};
  m.d.how = how;
  m.d.node_file = m.d.element_file = m.d.face_file = &m.r;
  m.d.raises = true;
  corot_status status = corot_draft_end(&m.d, parse(&m, mesh));
  corot_draft_clear(&m.d);
  return status;
}
