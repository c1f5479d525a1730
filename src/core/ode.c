#include <corot/ode.h>
#include <string.h>

#include "core/kernel.h"

/* Adds to s->r the element forces of nodes first to last - 1, each node's own in the order of the
   tets. Returns the sum of these r, which is finite only if they are. */
static double collect(const corot_model *m, const corot_state *s, int first, int last) {
  const double *force = (const double *)s->force;
  const int *begin = m->pattern.first, *slot = m->pattern.slot;
  double check = 0;
  for (int n = first; n < last; n++) {
    double f[3] = {0, 0, 0};
    for (int k = begin[n]; k < begin[n + 1]; k++)
      for (int c = 0; c < 3; c++) f[c] += force[slot[k] + c * W];
    for (int c = 0; c < 3; c++) {
      int i = m->dof[n][c];
      if (i >= 0) check += s->r[i] += f[c];
    }
  }
  return check;
}

static corot_status inverted(corot_state *s, int tet) {
  s->inverted = tet;
  if (tet < 0) return COROT_OK;
  return corot_fail(COROT_RETRY, "tet %d is inverted", tet);
}

typedef int force_kernel(const corot_model *m, corot_state *state, bool option, int chunk);

/* Adds to s->r the forces that the kernel finds, chunk by chunk, and hands the result on. */
static corot_status sum_forces(const corot_model *m, corot_state *s, double t, force_kernel *kernel,
                               bool option, double *r) {
  const int *ready = m->pattern.ready;
  double check = 0;
  for (int c = 0; c < m->pattern.nchunk; c++) {
    COROT_TRY(inverted(s, kernel(m, s, option, c)));
    check += collect(m, s, ready[c], ready[c + 1]);
  }
  if (!isfinite(check))
    return corot_fail(COROT_RETRY, "the forces exceed double precision at t = %g", t);
  memcpy(r, s->r, m->ndof * sizeof *r);
  return COROT_OK;
}

corot_status corot_residual(const corot_model *m, corot_state *s, double t, const double *u,
                            const double *v, double *r) {
  model_spread(m, u, s->u[0], 4);
  if (m->damped) model_spread(m, v, s->v[0], 4);
  loads_force(m, t, s->r);
  return sum_forces(m, s, t, kernel_force, m->damped, r);
}

corot_status corot_rhs(const corot_model *m, corot_state *s, double t, const double *y,
                       double *ydot) {
  int n = m->ndof;
  COROT_TRY(corot_residual(m, s, t, y, y + n, ydot + n));
  memcpy(ydot, y + n, n * sizeof *ydot);
  for (int i = 0; i < n; i++) ydot[n + i] *= m->inverse_mass[i];
  return COROT_OK;
}

corot_status corot_jacobian(const corot_model *m, corot_state *s, double t, const double *u,
                            const double *v, corot_tangent tangent, double (*K)[9],
                            double (*D)[9]) {
  (void)t, (void)v; /* dead loads, and viscous forces linear in v: neither enters K and D */
  model_spread(m, u, s->u[0], 4);
  size_t bytes = m->pattern.nblock * sizeof *K;
  if (K) memset(K, 0, bytes);
  if (D) memset(D, 0, bytes);
  bool exact = tangent == COROT_TANGENT_EXACT;
  for (int c = 0; c < m->pattern.nchunk; c++)
    COROT_TRY(inverted(s, kernel_tangent(m, s, exact, c, K, m->damped ? D : NULL)));
  return COROT_OK;
}

corot_status corot_jvp(const corot_model *m, corot_state *s, double t, const double *u,
                       const double *v, corot_tangent tangent, const double *du, const double *dv,
                       double *jv) {
  model_spread(m, u, s->u[0], 4);
  model_spread(m, v, s->v[0], 4);
  model_spread(m, du, s->du[0], 4);
  model_spread(m, dv, s->dv[0], 4);
  memset(s->r, 0, m->ndof * sizeof *s->r); /* of dead loads there is no change */
  return sum_forces(m, s, t, kernel_derivative, tangent == COROT_TANGENT_EXACT, jv);
}

/* Largest and mean angle between two sets of frames: tr(A' B) = 1 + 2 cos, |A - B| = sqrt(8) sin
   of half the angle, which keeps its digits where the angle is small. */
static void compare_frames(const corot_model *m, const mat3 *A, const mat3 *B,
                           corot_frames_change *change) {
  double sum = 0;
  for (int b = 0; b < m->tets.nblock; b++)
    for (int l = 0; l < m->tets.block[b].ntet; l++) {
      double square = 0;
      EACH_IJ {
        double d = A[b].m[i][j][l] - B[b].m[i][j][l];
        square += d * d;
      }
      double angle = 2 * asin(fmin(1, sqrt(square / 8)));
      sum += angle;
      if (angle > change->angle_max) {
        change->angle_max = angle;
        change->angle_tet = m->tets.number[b * W + l];
      }
    }
  change->angle_mean = sum / m->mesh->ntet;
}

/* Elastic energy with the held frames, whatever the policy. */
static corot_status held_energy(const corot_model *m, corot_state *s, double *energy) {
  corot_frames policy = s->frames;
  double power;
  s->frames = COROT_FRAMES_HELD;
  int tet = kernel_energy(m, s, false, energy, &power);
  s->frames = policy;
  return inverted(s, tet);
}

corot_status corot_frames_update(const corot_model *m, corot_state *s, double t, const double *u,
                                 corot_frames_change *change) {
  (void)t; /* supports do not move */
  corot_frames_change c = {0};
  double before = 0, after = 0;
  model_spread(m, u, s->u[0], 4);
  COROT_TRY(inverted(s, kernel_frames(m, s, s->new_R)));
  if (change) {
    COROT_TRY(held_energy(m, s, &before));
    compare_frames(m, s->R, s->new_R, &c);
  }
  mat3 *old = s->R;
  s->R = s->new_R;
  s->new_R = old;
  if (!change) return COROT_OK;
  COROT_TRY(held_energy(m, s, &after));
  c.energy = after - before;
  *change = c;
  return COROT_OK;
}

static void add_cross(double a[3], double m, const double x[3], const double v[3]) {
  a[0] += m * (x[1] * v[2] - x[2] * v[1]);
  a[1] += m * (x[2] * v[0] - x[0] * v[2]);
  a[2] += m * (x[0] * v[1] - x[1] * v[0]);
}

corot_status corot_energy(const corot_model *m, corot_state *s, double t, const double *u,
                          const double *v, corot_energies *energies) {
  corot_energies e = {0};
  model_spread(m, u, s->u[0], 4);
  model_spread(m, v, s->v[0], 4);
  COROT_TRY(inverted(s, kernel_energy(m, s, m->damped, &e.elastic, &e.power_dissipated)));
  loads_force(m, t, s->r);
  for (int i = 0; i < m->ndof; i++) {
    e.kinetic += 0.5 * m->mass[i] * v[i] * v[i];
    e.power_external += s->r[i] * v[i];
  }
  for (int n = 0; n < m->mesh->nnode; n++) {
    double x[3], mass = 0;
    for (int c = 0; c < 3; c++) {
      int i = m->dof[n][c];
      x[c] = m->mesh->x[n][c] + s->u[n][c];
      if (i >= 0) mass = m->mass[i], e.momentum[c] += mass * v[i];
    }
    add_cross(e.angular_momentum, mass, x, s->v[n]);
  }
  *energies = e;
  return COROT_OK;
}
