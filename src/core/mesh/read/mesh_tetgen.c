/* TetGen's NAME.node, NAME.ele and NAME.face. */
#include <stdio.h>
#include <string.h>

#include "core/mesh/refine/mesh_refine.h"
#include "mesh_read.h"

static int compare_reals(const void *a, const void *b) {
  double p = *(const double *)a, q = *(const double *)b;
  return (p > q) - (p < q);
}

/* Sorts the different values among `value` [n] into `distinct`; 0 stands for none. */
static int find_distinct(int n, const double *value, double *distinct) {
  int m = 0, k = 0;
  for (int i = 0; i < n; i++)
    if (value[i] != 0) distinct[m++] = value[i];
  qsort(distinct, (size_t)m, sizeof *distinct, compare_reals);
  for (int i = 0; i < m; i++)
    if (i == 0 || distinct[i] != distinct[i - 1]) distinct[k++] = distinct[i];
  return k;
}

/* Names a group of dimension `dim` for each different value; the numbers of the groups are the
   values' places in `distinct` [*ndistinct], from 1. */
static corot_status name_values(corot_draft *d, int dim, const char *word, int n,
                                const double *value, double *distinct, int *ndistinct) {
  *ndistinct = find_distinct(n, value, distinct);
  for (int i = 0; i < *ndistinct; i++) {
    char name[64];
    snprintf(name, sizeof name, "%s-%.15g", word, distinct[i]);
    COROT_TRY(corot_draft_add_name(d, dim, i + 1, name));
  }
  return COROT_OK;
}

/* 0: it is none of them. */
static int number_of(double value, int ndistinct, const double *distinct) {
  const double *p = bsearch(&value, distinct, (size_t)ndistinct, sizeof value, compare_reals);
  return p ? (int)(p - distinct) + 1 : 0;
}

/* "INDEX X Y Z ATTRIBUTE... [MARKER]" */
static corot_status read_node(corot_reader *r, int nattribute, int nmarker, corot_draft *d, int i,
                              double *marker) {
  double ignored;
  int m = 0;
  d->node[i].at = r->at;
  COROT_TRY(corot_reader_long(r, "a node", &d->node[i].tag));
  COROT_TRY(corot_reader_point(r, d->x[i]));
  for (int k = 0; k < nattribute; k++) COROT_TRY(corot_reader_real(r, "an attribute", &ignored));
  if (nmarker) COROT_TRY(corot_reader_int(r, "a boundary marker", &m));
  *marker = m;
  int64_t first = d->node[0].tag;
  if (first != 0 && first != 1)
    return corot_reader_fail(r, d->node[0].at, "the first node is %lld, not 0 or 1",
                             (long long)first);
  if (d->node[i].tag != first + i)
    return corot_reader_fail(r, d->node[i].at, "node %lld stands where %lld should",
                             (long long)d->node[i].tag, (long long)first + i);
  return corot_reader_end_line(r);
}

/* "N 3 NATTRIBUTE NMARKER", then the nodes. marker [N] is the caller's to free, on failure too. */
static corot_status read_nodes(corot_reader *r, corot_draft *d, double **marker) {
  int n, dim, nattribute = 0, nmarker = 0;
  corot_reader_skip_lines(r);
  size_t at = r->at;
  COROT_TRY(corot_reader_count(r, "the number of nodes", 7, &n));
  COROT_TRY(corot_reader_int(r, "the dimension", &dim));
  if (dim != 3) return corot_reader_fail(r, at, "the dimension is %d, not 3", dim);
  if (corot_reader_more(r)) COROT_TRY(corot_reader_int(r, "the number of attributes", &nattribute));
  if (corot_reader_more(r)) COROT_TRY(corot_reader_int(r, "0 or 1 (boundary markers)", &nmarker));
  if (nattribute < 0 || nmarker < 0 || nmarker > 1)
    return corot_reader_fail(r, at, "nodes with %d attributes and %d boundary markers", nattribute,
                             nmarker);
  COROT_TRY(corot_reader_end_line(r));
  if (n == 0) return corot_reader_fail(r, at, "the file has no nodes: they are in another file");
  COROT_TRY(corot_draft_alloc_nodes(d, n));
  COROT_TRY(COROT_ALLOC(*marker, n));
  for (int i = 0; i < n; i++) COROT_TRY(read_node(r, nattribute, nmarker, d, i, &(*marker)[i]));
  if (r->at < r->size) return corot_reader_fail(r, r->at, "expected the end after %d nodes", n);
  return corot_draft_index_nodes(d);
}

/* "INDEX NODE NODE NODE NODE [six nodes] ATTRIBUTE..."; the last attribute is the region. */
static corot_status read_tet(corot_reader *r, int nnode, int nattribute, corot_draft *d,
                             double *region) {
  corot_draft_element element = {.at = r->at, .dim = 3};
  int middle[NMIDDLE_MAX];
  COROT_TRY(corot_reader_long(r, "a tet", &element.tag));
  for (int k = 0; k < nnode; k++) {
    int64_t tag;
    COROT_TRY(corot_reader_long(r, "a node", &tag));
    corot_draft_find_node(d, &element, tag, k < 4 ? &element.node[k] : &middle[k - 4]);
  }
  for (int k = 0; k < nattribute; k++) COROT_TRY(corot_reader_real(r, "an attribute", region));
  if (*region - *region != 0) return corot_reader_fail(r, element.at, "the region is %g", *region);
  COROT_TRY(corot_reader_end_line(r));
  return corot_draft_add_element(d, &element, nnode == 10 ? middle : NULL);
}

/* "N 4|10 NATTRIBUTE", then the tets. region [N] is the caller's to free, on failure too. */
static corot_status read_tets(corot_reader *r, corot_draft *d, double **region) {
  int n, nnode, nattribute = 0;
  corot_reader_skip_lines(r);
  size_t at = r->at;
  COROT_TRY(corot_reader_count(r, "the number of tets", 9, &n));
  COROT_TRY(corot_reader_int(r, "the number of nodes in a tet", &nnode));
  if (nnode != 4 && nnode != 10)
    return corot_reader_fail(r, at, "tets of %d nodes: only 4 or 10 are supported", nnode);
  if (corot_reader_more(r)) COROT_TRY(corot_reader_int(r, "the number of attributes", &nattribute));
  if (nattribute < 0) return corot_reader_fail(r, at, "tets with %d attributes", nattribute);
  COROT_TRY(corot_reader_end_line(r));
  COROT_TRY(COROT_ALLOC(*region, n));
  for (int i = 0; i < n; i++) COROT_TRY(read_tet(r, nnode, nattribute, d, &(*region)[i]));
  if (r->at < r->size) return corot_reader_fail(r, r->at, "expected the end after %d tets", n);
  return COROT_OK;
}

/* "INDEX NODE NODE NODE [three nodes on edges] [MARKER] [two tets]"; those in brackets are there or
   not as -o2, the first line of the file and -nn say. A face without a marker is left out. */
static corot_status read_face(corot_reader *r, int nmarker, corot_draft *d, double *marker) {
  corot_draft_element element = {.at = r->at, .dim = 2};
  int64_t tag, rest[6];
  int n = 0;
  COROT_TRY(corot_reader_long(r, "a face", &element.tag));
  for (int k = 0; k < 3; k++) {
    COROT_TRY(corot_reader_long(r, "a node", &tag));
    corot_draft_find_node(d, &element, tag, &element.node[k]);
  }
  for (; n < 6 && corot_reader_more(r); n++) COROT_TRY(corot_reader_long(r, "a number", &rest[n]));
  if (n < nmarker) return corot_reader_fail(r, r->at, "expected a marker, found the end");
  COROT_TRY(corot_reader_end_line(r));
  int64_t m = rest[n - nmarker >= 3 ? 3 : 0];
  if (m == 0) return COROT_OK;
  *marker = (double)m;
  return corot_draft_add_element(d, &element, NULL);
}

/* "N NMARKER", then the faces; marker [N], of those that have one, is the caller's to free, on
   failure too. */
static corot_status read_faces(corot_reader *r, corot_draft *d, double **marker) {
  int n, nmarker = 0;
  size_t ntet = d->nelement;
  corot_reader_skip_lines(r);
  size_t at = r->at;
  COROT_TRY(corot_reader_count(r, "the number of faces", 7, &n));
  if (corot_reader_more(r)) COROT_TRY(corot_reader_int(r, "0 or 1 (boundary markers)", &nmarker));
  if (nmarker < 0 || nmarker > 1)
    return corot_reader_fail(r, at, "faces with %d boundary markers", nmarker);
  COROT_TRY(corot_reader_end_line(r));
  if (nmarker == 0) return COROT_OK;
  COROT_TRY(COROT_ALLOC(*marker, n));
  d->raises = true;
  for (int i = 0; i < n; i++) COROT_TRY(read_face(r, nmarker, d, &(*marker)[d->nelement - ntet]));
  if (r->at < r->size) return corot_reader_fail(r, r->at, "expected the end after %d faces", n);
  return COROT_OK;
}

/* The numbers that a file gives its nodes, faces and tets; 0: none. */
typedef struct marks {
  double *region; /* [ntet] */
  double *face;   /* [nface] of the triangles in the draft; NULL: there are none */
  double *node;   /* [nnode] */
  double *distinct;
} marks;

/* Groups of the elements first to first + n - 1, by their values. */
static corot_status add_groups_of(corot_draft *d, int dim, const char *word, int first, int n,
                                  const double *value, double *distinct) {
  int ndistinct;
  COROT_TRY(name_values(d, dim, word, n, value, distinct, &ndistinct));
  for (int i = 0; i < n; i++)
    COROT_TRY(corot_draft_add_member(d, first + i, number_of(value[i], ndistinct, distinct)));
  return COROT_OK;
}

static corot_status add_points(corot_draft *d) {
  for (int i = 0; i < d->nnode; i++) {
    const corot_draft_element point = {.tag = d->node[i].tag, .node = {i}};
    COROT_TRY(corot_draft_add_element(d, &point, NULL));
  }
  return COROT_OK;
}

/* Groups of tets by their regions, and of faces and nodes by their markers. */
static corot_status add_groups(corot_draft *d, int ntet, marks *m) {
  int nface = (int)d->nelement - ntet;
  COROT_TRY(COROT_ALLOC(m->distinct, d->nelement + (size_t)d->nnode));
  COROT_TRY(add_groups_of(d, 3, "region", 0, ntet, m->region, m->distinct));
  if (m->face) COROT_TRY(add_groups_of(d, 2, "face", ntet, nface, m->face, m->distinct));
  if (find_distinct(d->nnode, m->node, m->distinct) == 0) return COROT_OK;
  COROT_TRY(add_points(d));
  return add_groups_of(d, 0, "marker", ntet + nface, d->nnode, m->node, m->distinct);
}

/* The nodes on edges have no markers: they are in the groups of both ends, as after octasection. */
static corot_status add_middles(corot_mesh *mesh) {
  int nskin, (*skin)[3];
  COROT_TRY(corot_mesh_boundary(mesh, &nskin, &skin));
  corot_status status = COROT_OK;
  for (int g = 0; g < mesh->ngroup && !status; g++)
    status = corot_group_add_middles(mesh, nskin, (const int(*)[3])skin, &mesh->group[g]);
  free(skin);
  return status;
}

static corot_status finish(corot_draft *d, corot_mesh **mesh) {
  corot_mesh *m;
  COROT_TRY(corot_draft_finish(d, &m));
  corot_status status = m->mid ? add_middles(m) : COROT_OK;
  if (status)
    corot_mesh_destroy(m);
  else
    *mesh = m;
  return status;
}

static corot_status parse(corot_reader *node, corot_reader *ele, corot_reader *face, corot_draft *d,
                          marks *m, corot_mesh **mesh) {
  COROT_TRY(read_nodes(node, d, &m->node));
  COROT_TRY(read_tets(ele, d, &m->region));
  int ntet = (int)d->nelement;
  if (d->order == 2) COROT_TRY(corot_draft_order_middles(d));
  corot_draft_turn_all(d);
  if (face) {
    d->face_file = face;
    COROT_TRY(read_faces(face, d, &m->face));
  }
  COROT_TRY(add_groups(d, ntet, m));
  return finish(d, mesh);
}

static corot_reader over(const corot_mesh_text *text) {
  return (corot_reader){.path = text->path, .data = text->data, .size = text->size, .comment = '#'};
}

corot_status corot_tetgen_parse(const corot_mesh_text *node, const corot_mesh_text *ele,
                                const corot_mesh_text *face, const corot_reading *how,
                                corot_mesh **mesh) {
  corot_reader n = over(node), e = over(ele), f = face ? over(face) : e;
  corot_draft d = {.how = how, .node_file = &n, .element_file = &e};
  marks m = {0};
  corot_status status = corot_draft_end(&d, parse(&n, &e, face ? &f : NULL, &d, &m, mesh));
  free(m.region);
  free(m.face);
  free(m.node);
  free(m.distinct);
  corot_draft_clear(&d);
  return status;
}
