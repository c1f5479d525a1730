/* The mass of an element, between its nodes and lumped.

   Where edges are straight the determinant of the Jacobian is constant, and the mass matrix is the
   kind's own times the mass. On a curved ten-node tet the integrand N_i N_j det J has degree 7. It
   is integrated by Gauss's rule of five points in each direction of the cube that collapses to the
   tet, L_1 = r, L_2 = (1 - r) s, L_3 = (1 - r)(1 - s) t, whose Jacobian (1 - r)^2 (1 - s) adds two
   to the degree: five points are exact for nine. */
#include <stdbool.h>

#include "core/mesh/mesh.h"
#include "tets.h"

enum { GAUSS = 5 };

/* Gauss's points in [0, 1] and their weights (Abramowitz & Stegun, table 25.4). */
static const double gauss_point[GAUSS] = {0.046910077030668004, 0.23076534494715845, 0.5,
                                          0.76923465505284155, 0.953089922969332};
static const double gauss_weight[GAUSS] = {0.11846344252809454, 0.23931433524968324,
                                           0.28444444444444444, 0.23931433524968324,
                                           0.11846344252809454};

/* Whether the middles are where straight edges have them, but for rounding. */
static bool is_straight(const corot_mesh *mesh, const int node[KIND_NODES]) {
  for (int k = 0; k < 6; k++) {
    const double *a = mesh->x[node[corot_tet_edge[k][0]]], *b = mesh->x[node[corot_tet_edge[k][1]]];
    const double *middle = mesh->x[node[4 + k]];
    double off = 0, edge = 0;
    for (int c = 0; c < 3; c++) {
      off = fmax(off, fabs(middle[c] - 0.5 * (a[c] + b[c])));
      edge = fmax(edge, fabs(a[c]) + fabs(b[c]));
    }
    if (off > 1e-14 * edge) return false;
  }
  return true;
}

static void shapes_at(const double L[4], double N[10]) {
  for (int i = 0; i < 4; i++) N[i] = L[i] * (2 * L[i] - 1);
  for (int k = 0; k < 6; k++) N[4 + k] = 4 * L[corot_tet_edge[k][0]] * L[corot_tet_edge[k][1]];
}

/* mass[i][j] = density times the integral of N_i N_j, by roles. */
static void integrate(const corot_mesh *mesh, const int node[KIND_NODES], double density,
                      double mass[KIND_NODES][KIND_NODES]) {
  const double(*x)[3] = (const double(*)[3])mesh->x;
  memset(mass, 0, KIND_NODES * sizeof *mass);
  for (int p = 0; p < GAUSS * GAUSS * GAUSS; p++) {
    int i = p % GAUSS, j = p / GAUSS % GAUSS, k = p / GAUSS / GAUSS;
    double r = gauss_point[i], s = gauss_point[j], t = gauss_point[k];
    double L[4] = {0, r, (1 - r) * s, (1 - r) * (1 - s) * t}, N[10];
    L[0] = 1 - L[1] - L[2] - L[3];
    shapes_at(L, N);
    double w = gauss_weight[i] * gauss_weight[j] * gauss_weight[k] * (1 - r) * (1 - r) * (1 - s);
    w *= density * fabs(corot_curved_determinant(x, node, node + 4, L));
    for (int a = 0; a < 10; a++)
      for (int b = 0; b < 10; b++) mass[a][b] += w * N[a] * N[b];
  }
}

/* By roles: true where the kind's own shares do not hold. */
static bool integrate_if_curved(const corot_mesh *mesh, const element_set *e, int number,
                                double density, double mass[KIND_NODES][KIND_NODES]) {
  int node[KIND_NODES];
  if (e->kind->number != TET10) return false;
  corot_tets_nodes(mesh, number, node);
  if (is_straight(mesh, node)) return false;
  integrate(mesh, node, density, mass);
  return true;
}

void corot_element_mass(const corot_mesh *mesh, const element_set *e, int b, int lane,
                        double density, double mass[KIND_NODES][KIND_NODES]) {
  const element_kind *kind = e->kind;
  double curved[KIND_NODES][KIND_NODES], whole = density * volume_at(e, b, lane);
  bool is_curved = integrate_if_curved(mesh, e, e->number[b * W + lane], density, curved);
  for (int i = 0; i < kind->nnode; i++)
    for (int j = 0; j < kind->nnode; j++) {
      int r = role_at(e, b, i, lane), s = role_at(e, b, j, lane);
      mass[i][j] = is_curved ? curved[r][s] : whole * kind->mass[r][s] / kind->mass_over;
    }
}

void corot_element_lumped(const corot_mesh *mesh, const element_set *e, int b, int lane,
                          double density, double mass[KIND_NODES]) {
  const element_kind *kind = e->kind;
  double curved[KIND_NODES][KIND_NODES], whole = density * volume_at(e, b, lane), trace = 0;
  bool is_curved = integrate_if_curved(mesh, e, e->number[b * W + lane], density, curved);
  if (is_curved) whole = 0;
  for (int i = 0; is_curved && i < kind->nnode; i++) {
    trace += curved[i][i];
    for (int j = 0; j < kind->nnode; j++) whole += curved[i][j];
  }
  for (int i = 0; i < kind->nnode; i++) {
    int r = role_at(e, b, i, lane);
    mass[i] =
        is_curved ? whole * curved[r][r] / trace : whole * kind->lumped[r] / kind->lumped_over;
  }
}
