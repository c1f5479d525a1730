/* Shape functions: l_a of a tet of order 1; l_a (2 l_a - 1) and 4 l_a l_b of order 2. */
#include "gradients.h"

#include <stdlib.h>

#include "core/mesh/mesh.h"

static const double near_corner = 0.5854101966249685, elsewhere = 0.1381966011250105;

/* m = sum_a x_a (d l_a / d xi)', from corner 0, at a point with barycentric coordinates l; xi are
   the last three of these. A function of l has the derivative by l_j less that by l_0. */
static void map_slope(const fields *f, const double (*x)[3], int e, const double l[4],
                      double m[9]) {
  const int *tet = f->tet[e];
  double by[4][3] = {{0}};
  for (int i = 0; i < 3; i++) {
    double origin = x[tet[0]][i];
    for (int a = 1; a < 4; a++) by[a][i] = (f->mid ? 4 * l[a] - 1 : 1) * (x[tet[a]][i] - origin);
    for (int k = 0; k < 6 && f->mid; k++) {
      int a = corot_tet_edge[k][0], b = corot_tet_edge[k][1];
      double middle = 4 * (x[f->mid[e][k]][i] - origin);
      by[a][i] += l[b] * middle;
      by[b][i] += l[a] * middle;
    }
  }
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) m[3 * i + j] = by[j + 1][i] - by[0][i];
}

static void point(int q, double l[4]) {
  for (int k = 0; k < 4; k++) l[k] = k == q ? near_corner : elsewhere;
}

static void invert(const double m[9], double inverse[9]) {
  double c[9];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      int p = (i + 1) % 3, q = (i + 2) % 3, r = (j + 1) % 3, s = (j + 2) % 3;
      c[3 * j + i] = m[3 * p + r] * m[3 * q + s] - m[3 * p + s] * m[3 * q + r];
    }
  double det = m[0] * c[0] + m[1] * c[3] + m[2] * c[6];
  for (int k = 0; k < 9; k++) inverse[k] = c[k] / det;
}

corot_status gradients_create(const fields *f, int ntet, const int *tet, gradients *out) {
  gradients g = {.f = f, .npoint = f->mid ? 4 : 1, .ntet = ntet, .tet = tet};
  g.inverse = malloc(((size_t)ntet * (size_t)g.npoint + 1) * sizeof *g.inverse);
  if (!g.inverse) return corot_fail(COROT_ENOMEM, "the surface's tets: out of memory");
  for (int i = 0; i < ntet; i++)
    for (int q = 0; q < g.npoint; q++) {
      double l[4], m[9];
      point(q, l);
      map_slope(f, (const double(*)[3])f->x, tet[i], l, m);
      invert(m, g.inverse[i * g.npoint + q]);
    }
  *out = g;
  return COROT_OK;
}

void gradients_free(gradients *g) {
  free(g->inverse);
  *g = (gradients){0};
}

void gradients_at(const gradients *g, const double (*u)[3], int i, int q, double F[9]) {
  const double *inverse = g->inverse[i * g->npoint + q];
  double l[4], du[9];
  point(q, l);
  map_slope(g->f, u, g->tet[i], l, du);
  for (int r = 0; r < 3; r++)
    for (int c = 0; c < 3; c++) {
      F[3 * r + c] = r == c;
      for (int k = 0; k < 3; k++) F[3 * r + c] += du[3 * r + k] * inverse[3 * k + c];
    }
}

void gradients_to_corners(const double at[4], double corner[4]) {
  double sum = at[0] + at[1] + at[2] + at[3];
  for (int k = 0; k < 4; k++) corner[k] = (at[k] - elsewhere * sum) / (near_corner - elsewhere);
}
