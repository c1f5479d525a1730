/* Whether the nodes on the edges of ten-node tets are where they should be. */
#include <limits.h>
#include <math.h>
#include <stdio.h>

#include "core/mesh/refine/mesh_refine.h"
#include "mesh_check.h"

#define FAR 0.5 /* of an edge: a node so far off its middle is beyond half a circle */

static corot_status check_range(const check *c, int e) {
  for (int k = 0; k < 6; k++) {
    int m = c->mesh->mid[e][k];
    if (m < 0 || m >= c->mesh->nnode)
      return corot_fail(COROT_EINVAL, "%s %lld: node %d does not exist, the last is %d",
                        at_tet(c, e), tet_name(c, e), m, c->mesh->nnode - 1);
  }
  return COROT_OK;
}

/* No corner of any tet is a node on an edge. */
static corot_status check_no_corners(const check *c) {
  char *corner;
  corot_status status = COROT_OK;
  COROT_TRY(COROT_ALLOC(corner, c->mesh->nnode));
  for (int e = 0; e < c->mesh->ntet; e++)
    for (int k = 0; k < 4; k++) corner[c->mesh->tet[e][k]] = 1;
  for (int e = 0; e < c->mesh->ntet && !status; e++)
    for (int k = 0; k < 6 && !status; k++)
      if (corner[c->mesh->mid[e][k]])
        status = corot_fail(COROT_EINVAL,
                            "%s %lld: node %lld is on an edge of it, and the corner of a tet",
                            at_tet(c, e), tet_name(c, e), node_name(c, c->mesh->mid[e][k]));
  free(corner);
  return status;
}

/* Enters that node m is on edge i of tet e; `middle` [edges] and `edge` [nodes] are -1 where
   nothing is entered yet. */
static corot_status enter(const check *c, const corot_edges *edges, int e, int i, int m,
                          int *middle, int *edge) {
  const int *end = edges->end[i];
  if (middle[i] >= 0 && middle[i] != m)
    return corot_fail(COROT_EINVAL, "%s %lld has node %lld on the edge %lld %lld, another %lld",
                      at_tet(c, e), tet_name(c, e), node_name(c, m), node_name(c, end[0]),
                      node_name(c, end[1]), node_name(c, middle[i]));
  if (edge[m] >= 0 && edge[m] != i) {
    const int *other = edges->end[edge[m]];
    return corot_fail(COROT_EINVAL,
                      "%s %lld has node %lld on the edge %lld %lld; it is on %lld %lld, too",
                      at_tet(c, e), tet_name(c, e), node_name(c, m), node_name(c, end[0]),
                      node_name(c, end[1]), node_name(c, other[0]), node_name(c, other[1]));
  }
  middle[i] = m;
  edge[m] = i;
  return COROT_OK;
}

/* Each edge has one node, and no other edge has it. */
static corot_status check_one_each(const check *c, const corot_edges *edges) {
  int *middle = NULL, *edge = NULL;
  corot_status status = COROT_ALLOC(middle, edges->n);
  if (!status) status = COROT_ALLOC(edge, c->mesh->nnode);
  if (!status) {
    for (int i = 0; i < edges->n; i++) middle[i] = -1;
    for (int i = 0; i < c->mesh->nnode; i++) edge[i] = -1;
  }
  for (int e = 0; e < c->mesh->ntet && !status; e++)
    for (int k = 0; k < 6 && !status; k++)
      status =
          enter(c, edges, e, edges->tet[e][corot_edge_of_mid[k]], c->mesh->mid[e][k], middle, edge);
  free(middle);
  free(edge);
  return status;
}

corot_status corot_check_middles(const check *c) {
  corot_edges edges = {0};
  if (c->mesh->ntet > INT_MAX / 10)
    return corot_fail(COROT_EINVAL, "%d ten-node tets are too many: at most %d", c->mesh->ntet,
                      INT_MAX / 10);
  for (int e = 0; e < c->mesh->ntet; e++) COROT_TRY(check_range(c, e));
  COROT_TRY(check_no_corners(c));
  corot_status status = corot_edges_list(c->mesh, &edges);
  if (!status) status = check_one_each(c, &edges);
  corot_edges_clear(&edges);
  return status;
}

static corot_status check_near(const check *c, int e) {
  double(*x)[3] = c->mesh->x;
  for (int k = 0; k < 6; k++) {
    int m = c->mesh->mid[e][k], p = c->mesh->tet[e][corot_tet_edge[k][0]],
        q = c->mesh->tet[e][corot_tet_edge[k][1]];
    double off[3], edge[3];
    for (int i = 0; i < 3; i++) {
      off[i] = x[m][i] - (x[p][i] + x[q][i]) / 2;
      edge[i] = x[q][i] - x[p][i];
    }
    double distance = hypot(hypot(off[0], off[1]), off[2]),
           length = hypot(hypot(edge[0], edge[1]), edge[2]);
    if (!(distance <= FAR * length))
      return corot_fail(COROT_EINVAL,
                        "%s %lld: node %lld is far off, %g from the middle of its edge %lld %lld, "
                        "which is %g long",
                        at_tet(c, e), tet_name(c, e), node_name(c, m), distance, node_name(c, p),
                        node_name(c, q), length);
  }
  return COROT_OK;
}

static corot_status inside_out(const check *c, int e, double determinant, const char *where,
                               int node) {
  char number[24] = "";
  if (node >= 0) snprintf(number, sizeof number, " %lld", node_name(c, node));
  return corot_fail(COROT_EINVAL,
                    "%s %lld: its midpoints turn it inside out: the determinant of its map is %g "
                    "at %s%s",
                    at_tet(c, e), tet_name(c, e), determinant, where, number);
}

corot_status corot_check_map(const check *c, int e, double edge) {
  const double(*x)[3] = (const double(*)[3])c->mesh->x;
  const double a = 0.5854101966249685, b = 0.1381966011250105,
               least = 6 * FLAT * edge * edge * edge;
  const int *v = c->mesh->tet[e], *mid = c->mesh->mid[e];
  COROT_TRY(check_near(c, e));
  for (int k = 0; k < 4; k++) {
    double at[4] = {0, 0, 0, 0};
    at[k] = 1;
    double d = corot_curved_determinant(x, v, mid, at);
    if (!(d > least)) return inside_out(c, e, d, "node", v[k]);
  }
  for (int k = 0; k < 6; k++) {
    double at[4] = {0, 0, 0, 0};
    at[corot_tet_edge[k][0]] = at[corot_tet_edge[k][1]] = 0.5;
    double d = corot_curved_determinant(x, v, mid, at);
    if (!(d > least)) return inside_out(c, e, d, "node", mid[k]);
  }
  for (int k = 0; k < 4; k++) {
    double at[4] = {b, b, b, b};
    at[k] = a;
    double d = corot_curved_determinant(x, v, mid, at);
    if (!(d > least)) return inside_out(c, e, d, "a point of integration", -1);
  }
  return COROT_OK;
}
