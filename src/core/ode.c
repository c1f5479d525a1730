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

typedef int force_kernel(const corot_model *m, corot_state *state, bool option, int chunk);

/* Adds to s->r the forces that the kernel finds, chunk by chunk, and hands the result on. */
static corot_status sum_forces(const corot_model *m, corot_state *s, double t, force_kernel *kernel,
                               bool option, double *r) {
  const int *ready = m->pattern.ready;
  double check = 0;
  for (int c = 0; c < m->pattern.nchunk; c++) {
    COROT_TRY(corot_state_check(s, kernel(m, s, option, c)));
    check += collect(m, s, ready[c], ready[c + 1]);
  }
  if (!isfinite(check))
    return corot_fail(COROT_RETRY, "the forces exceed double precision at t = %g", t);
  memcpy(r, s->r, m->ndof * sizeof *r);
  return COROT_OK;
}

corot_status corot_residual(const corot_model *m, corot_state *s, double t, const double *u,
                            const double *v, double *r) {
  corot_state_displace(m, s, t, u);
  if (m->damped) corot_model_velocity(m, s->phase, t, v, s->v[0], 4);
  corot_loads_force(m, t, (const double(*)[4])s->u, s->r);
  if (m->mass_damped)
    for (int i = 0; i < m->ndof; i++) s->r[i] -= m->mass_damping[i] * v[i];
  return sum_forces(m, s, t, corot_kernel_force, m->damped, r);
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
  (void)v; /* viscous forces are linear in it */
  corot_state_displace(m, s, t, u);
  size_t bytes = m->pattern.nblock * sizeof *K;
  if (K) memset(K, 0, bytes);
  if (D) memset(D, 0, bytes);
  if (D && m->mass_damped)
    for (int n = 0; n < m->mesh->nnode; n++)
      for (int c = 0; c < 3; c++)
        if (m->dof[n][c] >= 0) D[m->pattern.colptr[n]][4 * c] = m->mass_damping[m->dof[n][c]];
  bool exact = tangent == COROT_TANGENT_EXACT;
  for (int c = 0; c < m->pattern.nchunk; c++)
    COROT_TRY(corot_state_check(s, corot_kernel_tangent(m, s, exact, c, K, m->damped ? D : NULL)));
  return COROT_OK;
}

corot_status corot_jvp(const corot_model *m, corot_state *s, double t, const double *u,
                       const double *v, corot_tangent tangent, const double *du, const double *dv,
                       double *jv) {
  corot_state_displace(m, s, t, u);
  corot_model_velocity(m, s->phase, t, v, s->v[0], 4);
  corot_model_spread(m, du, s->du[0], 4);
  corot_model_spread(m, dv, s->dv[0], 4);
  memset(s->r, 0, m->ndof * sizeof *s->r);
  corot_loads_derivative(m, t, (const double(*)[4])s->u, (const double(*)[4])s->du, s->r);
  if (m->mass_damped)
    for (int i = 0; i < m->ndof; i++) s->r[i] -= m->mass_damping[i] * dv[i];
  return sum_forces(m, s, t, corot_kernel_derivative, tangent == COROT_TANGENT_EXACT, jv);
}

void corot_mass_multiply(const corot_model *m, const double *x, double *y) {
  for (int i = 0; i < m->ndof; i++) y[i] = m->mass[i] * x[i];
}

static void add_cross(double a[3], double m, const double x[3], const double v[3]) {
  a[0] += m * (x[1] * v[2] - x[2] * v[1]);
  a[1] += m * (x[2] * v[0] - x[0] * v[2]);
  a[2] += m * (x[0] * v[1] - x[1] * v[0]);
}

/* Power of the internal and viscous forces on moving supports: what the supports put in. Components
   at rest have no velocity. */
static corot_status support_power(const corot_model *m, corot_state *s, double *power) {
  const double *force = (const double *)s->force;
  const int *ready = m->pattern.ready, *begin = m->pattern.first, *slot = m->pattern.slot;
  for (int c = 0; c < m->pattern.nchunk; c++) {
    COROT_TRY(corot_state_check(s, corot_kernel_force(m, s, m->damped, c)));
    for (int n = ready[c]; n < ready[c + 1]; n++)
      for (int k = begin[n]; k < begin[n + 1]; k++)
        for (int i = 0; i < 3; i++)
          if (m->dof[n][i] < 0) *power -= force[slot[k] + i * W] * s->v[n][i];
  }
  return COROT_OK;
}

corot_status corot_energy(const corot_model *m, corot_state *s, double t, const double *u,
                          const double *v, corot_energies *energies) {
  corot_energies e = {0};
  corot_state_displace(m, s, t, u);
  corot_model_velocity(m, s->phase, t, v, s->v[0], 4);
  COROT_TRY(
      corot_state_check(s, corot_kernel_energy(m, s, m->damped, &e.elastic, &e.power_dissipated)));
  if (m->nmotion) COROT_TRY(support_power(m, s, &e.power_external));
  corot_loads_force(m, t, (const double(*)[4])s->u, s->r);
  for (int i = 0; i < m->ndof; i++) {
    e.kinetic += 0.5 * m->mass[i] * v[i] * v[i];
    e.power_external += s->r[i] * v[i];
    if (m->mass_damped) e.power_dissipated += m->mass_damping[i] * v[i] * v[i];
  }
  for (int n = 0; n < m->mesh->nnode; n++) {
    double x[3], velocity[3] = {0, 0, 0}, mass = 0;
    for (int c = 0; c < 3; c++) {
      int i = m->dof[n][c];
      x[c] = m->mesh->x[n][c] + s->u[n][c];
      if (i < 0) continue;
      mass = m->mass[i], velocity[c] = v[i];
      e.momentum[c] += mass * v[i];
    }
    add_cross(e.angular_momentum, mass, x, velocity);
  }
  *energies = e;
  return COROT_OK;
}

corot_status corot_internal_force(const corot_model *m, corot_state *s, double t, const double *u,
                                  const char *strain, double lambda_part, double mu_part,
                                  double (*f)[3]) {
  int index;
  COROT_TRY(corot_model_find_strain(strain, &index));
  corot_state_displace(m, s, t, u);
  const double *force = (const double *)s->force;
  const int *ready = m->pattern.ready, *begin = m->pattern.first, *slot = m->pattern.slot;
  for (int c = 0; c < m->pattern.nchunk; c++) {
    COROT_TRY(corot_state_check(s, corot_kernel_internal(m, s, index, lambda_part, mu_part, c)));
    for (int n = ready[c]; n < ready[c + 1]; n++)
      for (int i = 0; i < 3; i++) {
        double sum = 0;
        for (int k = begin[n]; k < begin[n + 1]; k++) sum -= force[slot[k] + i * W];
        f[n][i] = sum;
      }
  }
  return COROT_OK;
}
