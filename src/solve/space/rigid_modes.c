/* Gram-Schmidt in the mass. Parts of the body share no node, so that one field holds a motion of
   each of them; sums are taken part by part. */
#include "rigid_modes.h"

#include <corot/ode.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* m->sum = x' y over each part. */
static void multiply_parts(rigid_modes *m, const double *x, const double *y) {
  const int(*dof)[3] = corot_model_dof(m->model);
  int nnode = corot_model_mesh(m->model)->nnode;
  memset(m->sum, 0, (size_t)m->rigid.npart * sizeof *m->sum);
  for (int i = 0; i < nnode; i++)
    for (int c = 0; c < 3; c++)
      if (dof[i][c] >= 0) m->sum[m->rigid.part[i]] += x[dof[i][c]] * y[dof[i][c]];
}

/* Divides by the root of each part's sum; a part without the motion has nothing but zeros. */
static void scale_parts(const rigid_modes *m, double *x) {
  const int(*dof)[3] = corot_model_dof(m->model);
  int nnode = corot_model_mesh(m->model)->nnode;
  for (int i = 0; i < nnode; i++) {
    double square = m->sum[m->rigid.part[i]];
    for (int c = 0; c < 3; c++)
      if (dof[i][c] >= 0) x[dof[i][c]] = square > 0 ? x[dof[i][c]] / sqrt(square) : 0;
  }
}

/* y -= each part's sum times x. */
static void subtract_parts(const rigid_modes *m, const double *x, double *y) {
  const int(*dof)[3] = corot_model_dof(m->model);
  int nnode = corot_model_mesh(m->model)->nnode;
  for (int i = 0; i < nnode; i++)
    for (int c = 0; c < 3; c++)
      if (dof[i][c] >= 0) y[dof[i][c]] -= m->sum[m->rigid.part[i]] * x[dof[i][c]];
}

static double *column(double *all, const rigid_modes *m, int k) {
  return all + (size_t)k * corot_model_ndof(m->model);
}

/* x loses what products with `by` say that it has of the fields `along`. */
static void take_out(rigid_modes *m, int count, double *by, double *along, double *x) {
  for (int k = 0; k < count; k++) {
    multiply_parts(m, column(by, m, k), x);
    subtract_parts(m, column(along, m, k), x);
  }
}

/* Field k becomes orthogonal to those before it, and of length one. */
static void orthonormalise(rigid_modes *m, int k) {
  double *z = column(m->rigid.field, m, k), *image = column(m->image, m, k);
  take_out(m, k, m->image, m->rigid.field, z);
  corot_mass_multiply(m->model, z, image);
  multiply_parts(m, z, image);
  scale_parts(m, z);
  scale_parts(m, image);
}

corot_status corot_rigid_modes_create(const corot_model *model, const double (*x)[3],
                                      rigid_modes *m) {
  size_t n = (size_t)corot_model_ndof(model);
  *m = (rigid_modes){.model = model};
  COROT_TRY(corot_rigid_create(model, x, &m->rigid));
  for (int p = 0; p < m->rigid.npart; p++) m->any |= m->rigid.nfree[p] > 0;
  if (!m->any) return COROT_OK;
  m->image = calloc(6 * n, sizeof *m->image);
  m->sum = calloc((size_t)m->rigid.npart, sizeof *m->sum);
  if (!m->image || !m->sum) return corot_fail(COROT_ENOMEM, "no memory for %zu unknowns", n);
  for (int k = 0; k < 6; k++) orthonormalise(m, k);
  return COROT_OK;
}

void corot_rigid_modes_clear(rigid_modes *m) {
  corot_rigid_clear(&m->rigid);
  free(m->image);
  free(m->sum);
  *m = (rigid_modes){0};
}

void corot_rigid_modes_leave(rigid_modes *m, double *u) {
  if (m->any) take_out(m, 6, m->image, m->rigid.field, u);
}

void corot_rigid_modes_balance(rigid_modes *m, double *f) {
  if (m->any) take_out(m, 6, m->rigid.field, m->image, f);
}
