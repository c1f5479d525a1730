/* MEDIT's .mesh in ASCII, as Mmg, gmsh and FreeFEM write it: keywords, counts and numbers, wherever
   the lines end. */
#include "mesh_medit.h"

#include <limits.h>
#include <string.h>

static const corot_medit_list lists[] = {
    {"Triangles", 6, 2, 3, DRAFT_SIMPLEX},      {"TrianglesP2", 24, 2, 6, DRAFT_SIMPLEX},
    {"Quadrilaterals", 7, 2, 4, DRAFT_QUAD},    {"Tetrahedra", 8, 3, 4, DRAFT_SIMPLEX},
    {"TetrahedraP2", 30, 3, 10, DRAFT_SIMPLEX}, {"TetrahedraP3", 96, 3, 0, DRAFT_SIMPLEX},
    {"TetrahedraP4", 97, 3, 0, DRAFT_SIMPLEX},  {"Hexahedra", 10, 3, 8, DRAFT_HEX},
    {"HexahedraQ2", 33, 3, 0, DRAFT_HEX},       {"HexahedraQ3", 98, 3, 0, DRAFT_HEX},
    {"HexahedraQ4", 99, 3, 0, DRAFT_HEX},       {"Prisms", 9, 3, 6, DRAFT_PRISM},
    {"PrismsP2", 86, 3, 0, DRAFT_PRISM},        {"PrismsP3", 102, 3, 0, DRAFT_PRISM},
    {"PrismsP4", 103, 3, 0, DRAFT_PRISM},       {"Pentahedra", 0, 3, 6, DRAFT_PRISM},
    {"PentahedraP2", 0, 3, 0, DRAFT_PRISM},     {"Pyramids", 49, 3, 5, DRAFT_PYRAMID},
    {"PyramidsP2", 87, 3, 0, DRAFT_PYRAMID},    {"PyramidsP3", 100, 3, 0, DRAFT_PYRAMID},
    {"PyramidsP4", 101, 3, 0, DRAFT_PYRAMID},
};

const corot_medit_list *corot_medit_list_of(int code) {
  for (size_t i = 0; i < sizeof lists / sizeof *lists; i++)
    if (code > 0 && lists[i].code == code) return &lists[i];
  return NULL;
}

/* To the next value of a text. */
static void next(corot_reader *r) {
  if (!r->binary) corot_reader_skip_lines(r);
}

corot_status corot_medit_dimension(corot_medit *m) {
  int dim;
  next(&m->r);
  size_t at = m->r.at;
  COROT_TRY(corot_reader_int(&m->r, "the dimension", &dim));
  if (dim != 3) return corot_reader_fail(&m->r, at, "the dimension is %d, not 3", dim);
  return COROT_OK;
}

/* N, then N times "X Y Z REFERENCE". */
corot_status corot_medit_nodes(corot_medit *m) {
  corot_reader *r = &m->r;
  int n;
  int64_t ignored;
  if (m->has_nodes) return corot_reader_fail(r, r->at, "Vertices are listed twice");
  m->has_nodes = true;
  COROT_TRY(corot_reader_count(r, "the number of vertices", 8, &n));
  COROT_TRY(corot_draft_alloc_nodes(&m->d, n));
  for (int i = 0; i < n; i++) {
    next(r);
    m->d.node[i] = (corot_draft_node){i + 1, r->at};
    COROT_TRY(corot_reader_point(r, m->d.x[i]));
    COROT_TRY(corot_reader_long(r, "a reference", &ignored));
  }
  return corot_draft_index_nodes(&m->d);
}

/* "NODE... REFERENCE"; references other than 0 are groups. */
static corot_status read_element(corot_medit *m, const corot_medit_list *l, int number) {
  corot_reader *r = &m->r;
  int middle[NMIDDLE_MAX];
  int64_t tag, reference;
  next(r);
  corot_draft_element element = {.tag = number, .at = r->at, .dim = l->dim, .kind = l->kind};
  bool ordered = !l->kind && l->nnode > l->dim + 1;
  for (int i = 0; i < l->nnode; i++) {
    int place = ordered ? m->place[l->dim][i] : i;
    COROT_TRY(corot_reader_long(r, "a vertex", &tag));
    corot_draft_find_node(&m->d, &element, tag, corot_draft_slot(&element, middle, place));
  }
  COROT_TRY(corot_reader_long(r, "a reference", &reference));
  if (reference < 0 || reference > INT_MAX)
    return corot_reader_fail(r, element.at,
                             "the reference is %lld: groups have numbers up to %d, 0 is none",
                             (long long)reference, INT_MAX);
  if (l->dim == 2 && reference == 0) return COROT_OK;
  COROT_TRY(corot_draft_add_element(&m->d, &element, l->nnode > 4 ? middle : NULL));
  return corot_draft_add_member(&m->d, (int)m->d.nelement - 1, (int)reference);
}

corot_status corot_medit_elements(corot_medit *m, const corot_medit_list *l) {
  corot_reader *r = &m->r;
  int n;
  next(r);
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

/* The place of the node at these barycentric coordinates among ours; -1: it has none. */
static int place_of(int dim, const int b[4]) {
  static const int triangle[3][2] = {{0, 1}, {1, 2}, {2, 0}};
  for (int k = 0; k <= dim; k++)
    if (b[k] == 2) return k;
  for (int k = 0; k < corot_draft_nedge(dim); k++) {
    const int *edge = dim == 3 ? corot_tet_edge[k] : triangle[k];
    if (b[edge[0]] == 1 && b[edge[1]] == 1) return dim + 1 + k;
  }
  return -1;
}

corot_status corot_medit_ordering(corot_medit *m, int dim) {
  corot_reader *r = &m->r;
  int n, nnode = dim + 1 + corot_draft_nedge(dim), seen = 0;
  next(r);
  size_t at = r->at;
  COROT_TRY(corot_reader_count(r, "the number of nodes", 1, &n));
  for (size_t i = 0; i < m->d.nelement; i++)
    if (m->d.element[i].dim == dim && m->d.element[i].middle && !m->d.element[i].kind)
      return corot_reader_fail(r, at, "the order of nodes is said behind the elements of it");
  for (int i = 0; i < n && n == nnode; i++) {
    int b[4] = {0};
    int64_t v;
    for (int k = 0; k <= dim; k++) {
      COROT_TRY(corot_reader_long(r, "a barycentric coordinate", &v));
      b[k] = v == 1 || v == 2 ? (int)v : 0;
    }
    m->place[dim][i] = place_of(dim, b);
    if (m->place[dim][i] >= 0) seen |= 1 << m->place[dim][i];
  }
  if (n != nnode || seen != (1 << nnode) - 1)
    return corot_reader_fail(r, at,
                             "the order of nodes does not have each of the %d corners and edges of "
                             "a %s of second order once",
                             nnode, dim == 3 ? "tet" : "triangle");
  return COROT_OK;
}

corot_status corot_medit_basis(corot_medit *m) {
  int64_t bezier;
  next(&m->r);
  size_t at = m->r.at;
  COROT_TRY(corot_reader_long(&m->r, "0 or 1 (BezierBasis)", &bezier));
  if (bezier != 0)
    return corot_reader_fail(&m->r, at,
                             "the nodes of second order are control points of Bezier's: write the "
                             "mesh with nodes on the edges");
  return COROT_OK;
}

void corot_medit_begin(corot_medit *m, const corot_reading *how) {
  m->d.how = how;
  m->d.node_file = m->d.element_file = m->d.face_file = &m->r;
  m->d.raises = true;
  for (int dim = 0; dim < 4; dim++)
    for (int k = 0; k < 10; k++) m->place[dim][k] = k;
}

corot_status corot_medit_finish(corot_medit *m, corot_mesh **mesh) {
  if (!m->has_nodes) return corot_fail(COROT_EFORMAT, "%s: the file has no Vertices", m->r.path);
  if (!m->has_tets) return corot_fail(COROT_EFORMAT, "%s: the file has no Tetrahedra", m->r.path);
  return corot_draft_finish(&m->d, mesh);
}

/* --- text --- */

static bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }

/* Goes past a keyword that is of no use here, and its numbers. */
static void skip_keyword(corot_reader *r) {
  do {
    while (r->at < r->size && (r->data[r->at] == 0 || !strchr(" \t\r\n", r->data[r->at]))) r->at++;
    corot_reader_skip_lines(r);
  } while (r->at < r->size && !is_letter(r->data[r->at]));
}

static corot_status read_keyword(corot_medit *m) {
  corot_reader *r = &m->r;
  size_t at = r->at;
  if (!is_letter(r->data[at])) return corot_reader_fail(r, at, "expected a keyword");
  if (corot_reader_word(r, "Dimension")) return corot_medit_dimension(m);
  if (corot_reader_word(r, "Vertices")) return corot_medit_nodes(m);
  if (corot_reader_word(r, "TrianglesP2Ordering")) return corot_medit_ordering(m, 2);
  if (corot_reader_word(r, "TetrahedraP2Ordering")) return corot_medit_ordering(m, 3);
  if (corot_reader_word(r, "BezierBasis")) return corot_medit_basis(m);
  for (size_t i = 0; i < sizeof lists / sizeof *lists; i++)
    if (corot_reader_word(r, lists[i].name)) return corot_medit_elements(m, &lists[i]);
  if (corot_reader_word(r, "End"))
    r->at = r->size;
  else
    skip_keyword(r);
  return COROT_OK;
}

static corot_status parse(corot_medit *m, corot_mesh **mesh) {
  corot_reader *r = &m->r;
  corot_reader_skip_lines(r);
  while (r->at < r->size) {
    COROT_TRY(read_keyword(m));
    corot_reader_skip_lines(r);
  }
  return corot_medit_finish(m, mesh);
}

corot_status corot_medit_parse(const char *path, const char *data, size_t size,
                               const corot_reading *how, corot_mesh **mesh) {
  corot_medit m = {.r = {.path = path, .data = data, .size = size, .comment = '#', .flows = true}};
  corot_medit_begin(&m, how);
  corot_status status = corot_draft_end(&m.d, parse(&m, mesh));
  corot_draft_clear(&m.d);
  return status;
}
