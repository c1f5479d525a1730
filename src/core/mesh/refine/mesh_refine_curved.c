/* Where the shape functions of a ten-node tet have the middles of its children's edges.

   Let s_ab = x_ab - (x_a + x_b) / 2 be how far the node on an edge is off its middle. In these
   terms a child's edge, whose ends are corners or nodes on edges of the parent, has

     s = s_ab / 4                                        from a corner a to the node on ab
     s = s_bc / 4                                        from the node on ab to the node on ac
     s = (s_ac + s_ad + s_bc + s_bd - s_ab - s_cd) / 4   from the node on ab to the node on cd

   so that straight edges stay straight to the last bit. */
#include "mesh_refine.h"

/* The number of a node within a tet: its corners, then its nodes on edges. */
static int place_in(const corot_mesh *mesh, int e, int node) {
  for (int k = 0; k < 4; k++)
    if (mesh->tet[e][k] == node) return k;
  for (int k = 0; k < 6; k++)
    if (mesh->mid[e][k] == node) return 4 + k;
  return -1;
}

static bool touches(int edge, int corner) {
  return corot_tet_edge[edge][0] == corner || corot_tet_edge[edge][1] == corner;
}

/* weight[k] of s on edge k of the parent, in quarters, for the child's edge between its nodes p and
   q, of which q is on an edge. */
static void weigh(int p, int q, double weight[6]) {
  for (int k = 0; k < 6; k++) weight[k] = 0;
  if (p < 4) {
    weight[q - 4] = 1;
    return;
  }
  const int *a = corot_tet_edge[p - 4], *b = corot_tet_edge[q - 4];
  int met = 0, other[2] = {0, 0}; /* the ends of both that are not shared */
  for (int i = 0; i < 2; i++) {
    if (touches(q - 4, a[i]))
      met++;
    else
      other[0] = a[i];
    if (!touches(p - 4, b[i])) other[1] = b[i];
  }
  for (int k = 0; k < 6; k++)
    if (met)
      weight[k] = touches(k, other[0]) && touches(k, other[1]);
    else
      weight[k] = k == p - 4 || k == q - 4 ? -1 : 1;
}

/* The s of the edges of tet e. */
static void measure(const corot_mesh *mesh, int e, double s[6][3]) {
  for (int k = 0; k < 6; k++) {
    const double *a = mesh->x[mesh->tet[e][corot_tet_edge[k][0]]],
                 *b = mesh->x[mesh->tet[e][corot_tet_edge[k][1]]], *m = mesh->x[mesh->mid[e][k]];
    for (int i = 0; i < 3; i++) s[k][i] = m[i] - (a[i] + b[i]) / 2;
  }
}

/* Moves x, the middle of the edge between the nodes `end` of tet e. */
static void bend(const corot_mesh *mesh, int e, const double s[6][3], const int end[2],
                 double x[3]) {
  double weight[6];
  int p = place_in(mesh, e, end[0]), q = place_in(mesh, e, end[1]);
  weigh(p < q ? p : q, p < q ? q : p, weight);
  for (int i = 0; i < 3; i++) {
    double sum = 0;
    for (int k = 0; k < 6; k++) sum += weight[k] * s[k][i];
    x[i] += sum / 4;
  }
}

corot_status corot_edges_bend(const corot_mesh *mesh, const corot_mesh *fine,
                              const corot_edges *fine_edges, double (*x)[3]) {
  char *done;
  double s[6][3];
  COROT_TRY(COROT_ALLOC(done, fine_edges->n));
  for (int c = 0; c < fine->ntet; c++) {
    if (c % 8 == 0) measure(mesh, c / 8, s);
    for (int k = 0; k < 6; k++) {
      int i = fine_edges->tet[c][k];
      if (done[i]) continue;
      done[i] = 1;
      bend(mesh, c / 8, (const double(*)[3])s, fine_edges->end[i], x[fine->nnode + i]);
    }
  }
  free(done);
  return COROT_OK;
}
