/* Whether the nodes on the edges of ten-node tets are where they should be. */
#include <limits.h>
#include <math.h>
#include <stdio.h>

#include "core/mesh/refine/mesh_refine.h"
#include "mesh_check.h"

#define FAR 0.5 /* of an edge: a node so far off its middle is beyond half a circle */

/* The value is whether all are nodes. */
static bool check_range(const check *c, int e) {
  for (int k = 0; k < 6; k++) {
    int m = c->mesh->mid[e][k];
    if (m >= 0 && m < c->mesh->nnode) continue;
    corot_check_found(c, PLACE_TET, e, "%s %lld: node %d does not exist, the last is %d",
                      c->names->tet, tet_name(c, e), m, c->mesh->nnode - 1);
    return false;
  }
  return true;
}

/* No corner of any tet is a node on an edge. */
static corot_status check_no_corners(const check *c, bool *sound) {
  char *corner;
  COROT_TRY(COROT_ALLOC(corner, c->mesh->nnode));
  for (int e = 0; e < c->mesh->ntet; e++)
    for (int k = 0; k < 4; k++) corner[c->mesh->tet[e][k]] = 1;
  for (int e = 0; e < c->mesh->ntet; e++)
    for (int k = 0; k < 6; k++) {
      if (!corner[c->mesh->mid[e][k]]) continue;
      corot_check_found(c, PLACE_TET, e,
                        "%s %lld: node %lld is on an edge of it, and the corner of a tet",
                        c->names->tet, tet_name(c, e), node_name(c, c->mesh->mid[e][k]));
      *sound = false;
    }
  free(corner);
  return COROT_OK;
}

/* Enters that node m is on edge i of tet e; `middle` [edges] and `edge` [nodes] are -1 where
   nothing is entered yet. The value is whether it may be. */
static bool enter(const check *c, const corot_edges *edges, int e, int i, int m, int *middle,
                  int *edge) {
  const int *end = edges->end[i];
  if (middle[i] >= 0 && middle[i] != m) {
    corot_check_found(c, PLACE_TET, e, "%s %lld has node %lld on the edge %lld %lld, another %lld",
                      c->names->tet, tet_name(c, e), node_name(c, m), node_name(c, end[0]),
                      node_name(c, end[1]), node_name(c, middle[i]));
    return false;
  }
  if (edge[m] >= 0 && edge[m] != i) {
    const int *other = edges->end[edge[m]];
    corot_check_found(c, PLACE_TET, e,
                      "%s %lld has node %lld on the edge %lld %lld; it is on %lld %lld, too",
                      c->names->tet, tet_name(c, e), node_name(c, m), node_name(c, end[0]),
                      node_name(c, end[1]), node_name(c, other[0]), node_name(c, other[1]));
    return false;
  }
  middle[i] = m;
  edge[m] = i;
  return true;
}

/* Each edge has one node, and no other edge has it. */
static corot_status check_one_each(const check *c, const corot_edges *edges, bool *sound) {
  int *middle = NULL, *edge = NULL;
  corot_status status = COROT_ALLOC(middle, edges->n);
  if (!status) status = COROT_ALLOC(edge, c->mesh->nnode);
  if (!status) {
    for (int i = 0; i < edges->n; i++) middle[i] = -1;
    for (int i = 0; i < c->mesh->nnode; i++) edge[i] = -1;
  }
  for (int e = 0; e < c->mesh->ntet && !status; e++)
    for (int k = 0; k < 6; k++)
      if (!enter(c, edges, e, edges->tet[e][corot_edge_of_mid[k]], c->mesh->mid[e][k], middle,
                 edge))
        *sound = false;
  free(middle);
  free(edge);
  return status;
}

corot_status corot_check_middles(const check *c, bool *sound) {
  corot_edges edges = {0};
  if (c->mesh->ntet > INT_MAX / 10) {
    corot_check_found(c, PLACE_MESH, 0, "%d ten-node tets are too many: at most %d", c->mesh->ntet,
                      INT_MAX / 10);
    *sound = false;
  }
  for (int e = 0; e < c->mesh->ntet; e++) {
    if (c->bad_tet[e] || !check_range(c, e)) *sound = false;
  }
  if (*sound) COROT_TRY(check_no_corners(c, sound));
  if (!*sound) return COROT_OK;
  corot_status status = corot_edges_list(c->mesh, &edges);
  if (!status) status = check_one_each(c, &edges, sound);
  corot_edges_clear(&edges);
  return status;
}

/* The value is whether all nodes are near the middles of their edges. */
static bool check_near(const check *c, int e) {
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
    if (distance <= FAR * length) continue;
    corot_check_found(c, PLACE_TET, e,
                      "%s %lld: node %lld is far off, %g from the middle of its edge %lld %lld, "
                      "which is %g long",
                      c->names->tet, tet_name(c, e), node_name(c, m), distance, node_name(c, p),
                      node_name(c, q), length);
    return false;
  }
  return true;
}

static void inside_out(const check *c, int e, double determinant, const char *where, int node) {
  char number[24] = "";
  if (node >= 0) snprintf(number, sizeof number, " %lld", node_name(c, node));
  corot_check_found(c, PLACE_TET, e,
                    "%s %lld: its midpoints turn it inside out: the determinant of its map is %g "
                    "at %s%s",
                    c->names->tet, tet_name(c, e), determinant, where, number);
}

void corot_check_map(const check *c, int e, double edge) {
  const double(*x)[3] = (const double(*)[3])c->mesh->x;
  const double a = 0.5854101966249685, b = 0.1381966011250105,
               least = 6 * FLAT * edge * edge * edge;
  const int *v = c->mesh->tet[e], *mid = c->mesh->mid[e];
  if (!check_near(c, e)) return;
  for (int k = 0; k < 4; k++) {
    double at[4] = {0, 0, 0, 0};
    at[k] = 1;
    double d = corot_curved_determinant(x, v, mid, at);
    if (!(d > least)) {
      inside_out(c, e, d, "node", v[k]);
      return;
    }
  }
  for (int k = 0; k < 6; k++) {
    double at[4] = {0, 0, 0, 0};
    at[corot_tet_edge[k][0]] = at[corot_tet_edge[k][1]] = 0.5;
    double d = corot_curved_determinant(x, v, mid, at);
    if (!(d > least)) {
      inside_out(c, e, d, "node", mid[k]);
      return;
    }
  }
  for (int k = 0; k < 4; k++) {
    double at[4] = {b, b, b, b};
    at[k] = a;
    double d = corot_curved_determinant(x, v, mid, at);
    if (!(d > least)) {
      inside_out(c, e, d, "a point of integration", -1);
      return;
    }
  }
}
