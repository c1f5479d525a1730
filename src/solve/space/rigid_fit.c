/* The rigid motion that fits points best, in closed form (B. K. P. Horn, J. Opt. Soc. Am. A 4,
   1987): the quaternion of the rotation is the eigenvector of the largest eigenvalue of a symmetric
   matrix made of S = sum X x', of points X and x about their means. It minds no points in a plane.
 */
#include "rigid_fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct fit {
  double weight;
  double from[3], to[3]; /* means of the points at rest and now */
  double S[3][3];
  double R[3][3];
} fit;

/* R of S; the last two rows and columns of the matrix are there for company. */
static void find_rotation(fit *f) {
  const double(*S)[3] = (const double(*)[3])f->S;
  double N[6][6] = {{0}}, V[6][6];
  /* Horn's matrix */
  N[0][0] = S[0][0] + S[1][1] + S[2][2];
  for (int c = 0; c < 3; c++) {
    int i = (c + 1) % 3, j = (c + 2) % 3;
    N[0][1 + c] = N[1 + c][0] = S[i][j] - S[j][i];
    N[1 + c][1 + c] = S[c][c] - S[i][i] - S[j][j];
    N[1 + i][1 + j] = N[1 + j][1 + i] = S[i][j] + S[j][i];
  }
  corot_diagonalise(N, V);
  int best = 0;
  for (int k = 1; k < 6; k++)
    if (N[k][k] > N[best][best]) best = k;
  /* its quaternion; without any points none */
  double w = V[0][best], q[3] = {V[1][best], V[2][best], V[3][best]};
  double length = sqrt(w * w + q[0] * q[0] + q[1] * q[1] + q[2] * q[2]);
  if (!(length > 0.5)) w = length = 1, memset(q, 0, sizeof q);
  w /= length;
  for (int c = 0; c < 3; c++) q[c] /= length;
  for (int c = 0; c < 3; c++) {
    int i = (c + 1) % 3, j = (c + 2) % 3;
    f->R[c][c] = 1 - 2 * (q[i] * q[i] + q[j] * q[j]);
    f->R[c][i] = 2 * (q[c] * q[i] - w * q[j]);
    f->R[c][j] = 2 * (q[c] * q[j] + w * q[i]);
  }
}

/* How much a node tells of the motion of its part: where that is free, as much as its mass. */
static double weight_of(const corot_model *model, const corot_rigid *rigid, int node) {
  const int *dof = corot_model_dof(model)[node];
  bool loose = rigid->nfree[rigid->part[node]] > 0;
  for (int c = 0; c < 3; c++)
    if (dof[c] >= 0) return loose ? corot_model_mass(model)[dof[c]] : 0;
  return !loose && corot_model_moves(model);
}

static void find_fits(const corot_model *model, const corot_rigid *rigid, const double (*d)[3],
                      fit *all) {
  const corot_mesh *mesh = corot_model_mesh(model);
  for (int i = 0; i < mesh->nnode; i++) {
    double weight = weight_of(model, rigid, i);
    if (weight == 0) continue;
    fit *f = &all[rigid->part[i]];
    f->weight += weight;
    for (int c = 0; c < 3; c++) {
      f->from[c] += (mesh->x[i][c] - f->from[c]) * weight / f->weight;
      f->to[c] += (mesh->x[i][c] + d[i][c] - f->to[c]) * weight / f->weight;
    }
  }
  for (int i = 0; i < mesh->nnode; i++) {
    double weight = weight_of(model, rigid, i);
    fit *f = &all[rigid->part[i]];
    for (int a = 0; a < 3 && weight > 0; a++)
      for (int b = 0; b < 3; b++)
        f->S[a][b] += weight * (mesh->x[i][a] - f->from[a]) * (mesh->x[i][b] + d[i][b] - f->to[b]);
  }
  for (int k = 0; k < rigid->npart; k++)
    if (all[k].weight > 0) find_rotation(&all[k]);
}

corot_status corot_fit_out(const corot_model *model, const corot_rigid *rigid, double (*d)[3]) {
  const corot_mesh *mesh = corot_model_mesh(model);
  fit *all = calloc((size_t)rigid->npart, sizeof *all);
  if (!all) return corot_fail(COROT_ENOMEM, "no memory for %d parts of the body", rigid->npart);
  find_fits(model, rigid, (const double(*)[3])d, all);
  for (int i = 0; i < mesh->nnode; i++) {
    const fit *f = &all[rigid->part[i]];
    double moved[3];
    if (f->weight == 0) continue;
    for (int c = 0; c < 3; c++) {
      moved[c] = f->to[c] - mesh->x[i][c];
      for (int j = 0; j < 3; j++) moved[c] += f->R[c][j] * (mesh->x[i][j] - f->from[j]);
    }
    for (int c = 0; c < 3; c++) d[i][c] -= moved[c];
  }
  free(all);
  return COROT_OK;
}
