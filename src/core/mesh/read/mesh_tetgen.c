/* TetGen's NAME.node and NAME.ele. */
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
    COROT_TRY(corot_draft_find_node(d, &element, tag, k < 4 ? &element.node[k] : &middle[k - 4]));
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

/* The format does not say how a tet is wound: if all are left-handed, they are turned round. */
static void turn_left_handed(corot_draft *d) {
  for (size_t e = 0; e < d->nelement; e++)
    if (!(corot_tet_volume((const double(*)[3])d->x, d->element[e].node) < 0)) return;
  for (size_t e = 0; e < d->nelement; e++) {
    int *v = d->element[e].node, swap = v[0];
    v[0] = v[1];
    v[1] = swap;
  }
}

/* Groups of tets by their regions, and of nodes by their markers; `distinct` is scratch. */
static corot_status add_groups(corot_draft *d, const double *region, const double *marker,
                               double *distinct) {
  int n, ntet = (int)d->nelement;
  COROT_TRY(name_values(d, 3, "region", ntet, region, distinct, &n));
  for (int e = 0; e < ntet; e++)
    COROT_TRY(corot_draft_add_member(d, e, number_of(region[e], n, distinct)));
  COROT_TRY(name_values(d, 0, "marker", d->nnode, marker, distinct, &n));
  for (int i = 0; i < d->nnode; i++) {
    const corot_draft_element point = {.tag = d->node[i].tag, .node = {i}};
    if (marker[i] == 0) continue;
    COROT_TRY(corot_draft_add_element(d, &point, NULL));
    COROT_TRY(corot_draft_add_member(d, (int)d->nelement - 1, number_of(marker[i], n, distinct)));
  }
  return COROT_OK;
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

corot_status corot_tetgen_parse(const char *node_path, const char *node_data, size_t node_size,
                                const char *ele_path, const char *ele_data, size_t ele_size,
                                corot_mesh **mesh) {
  corot_reader node = {.path = node_path, .data = node_data, .size = node_size, .comment = '#'};
  corot_reader ele = {.path = ele_path, .data = ele_data, .size = ele_size, .comment = '#'};
  corot_draft d = {.node_file = &node, .element_file = &ele};
  double *marker = NULL, *region = NULL, *distinct = NULL;
  corot_status status = read_nodes(&node, &d, &marker);
  if (!status) status = read_tets(&ele, &d, &region);
  if (!status) turn_left_handed(&d);
  if (!status && d.order == 2) status = corot_draft_order_middles(&d);
  if (!status) status = COROT_ALLOC(distinct, d.nelement + (size_t)d.nnode);
  if (!status) status = add_groups(&d, region, marker, distinct);
  if (!status) status = finish(&d, mesh);
  free(distinct);
  free(region);
  free(marker);
  corot_draft_clear(&d);
  return status;
}
