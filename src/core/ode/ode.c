/* The functions of the ODE: nodal fields, kernels over the tets, loads. */
#include <corot/ode.h>

#include <string.h>

#include "core/model/load_force.h"
#include "core/solid/kernel.h"
#include "core/system/levels.h"
#include "trial.h"

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

corot_status corot_sum_forces(const corot_model *m, corot_state *s, double t, force_kernel *kernel,
                              bool option) {
  const int *ready = m->pattern.ready;
  double check = 0;
  for (int c = 0; c < m->pattern.nchunk; c++) {
    COROT_TRY(corot_state_check(s, kernel(m, s, option, c)));
    check += collect(m, s, ready[c], ready[c + 1]);
  }
  if (!isfinite(check))
    return corot_fail(COROT_RETRY, "the forces exceed double precision at t = %g", t);
  return COROT_OK;
}

corot_status corot_nodal_forces(const corot_model *m, corot_state *s, force_kernel *kernel,
                                bool option, double (*f)[4]) {
  const double *force = (const double *)s->force;
  const int *ready = m->pattern.ready, *begin = m->pattern.first, *slot = m->pattern.slot;
  for (int c = 0; c < m->pattern.nchunk; c++) {
    COROT_TRY(corot_state_check(s, kernel(m, s, option, c)));
    for (int n = ready[c]; n < ready[c + 1]; n++)
      for (int i = 0; i < 3; i++) {
        f[n][i] = 0;
        for (int k = begin[n]; k < begin[n + 1]; k++) f[n][i] += force[slot[k] + i * W];
      }
  }
  return COROT_OK;
}

static load_clock loads_now(const corot_state *s, double t) {
  if (s->still) return (load_clock){NAN, s->load_time, s->load_factor};
  return (load_clock){s->phase, t, 1};
}

/* f = the loads on the body where it is in s->u. */
static void external_force(const corot_model *m, const corot_state *s, double t, double *f) {
  load_clock now = loads_now(s, t);
  corot_loads_force(m, &now, (const double(*)[4])s->u, f);
}

void corot_force_of_loads(const corot_model *m, corot_state *s, double t, const double *u,
                          double *f) {
  if (corot_loads_follow(m)) corot_state_displace(m, s, t, u);
  external_force(m, s, t, f);
  for (int i = m->body_ndof; i < m->ndof; i++) f[i] = 0;
}

/* f += their change in the direction s->du. */
static void external_derivative(const corot_model *m, const corot_state *s, double t, double *f) {
  load_clock now = loads_now(s, t);
  corot_loads_derivative(m, &now, (const double(*)[4])s->u, (const double(*)[4])s->du, f);
}

corot_status corot_residual_trial(const corot_model *m, corot_state *s, double t, const double *u,
                                  const double *v, double *r) {
  corot_state_displace(m, s, t, u);
  bool damped = m->damped && !s->still;
  if (damped) corot_model_velocity(m, s->phase, t, v, s->v[0], 4);
  external_force(m, s, t, s->r);
  if (!s->still) corot_mass_damp(m, v, s->r);
  corot_kernel_dilatation(m, s);
  COROT_TRY(m->levels ? corot_levels_force(m, s, t, damped)
                      : corot_sum_forces(m, s, t, corot_kernel_force, damped));
  memcpy(r, s->r, m->ndof * sizeof *r);
  return COROT_OK;
}

/* The first component of x [n] that is not a number; -1: all are. */
static int find_nan(int n, const double *x) {
  int any = 0;
  for (int i = 0; i < n; i++) any |= x[i] != x[i];
  for (int i = 0; any && i < n; i++)
    if (x[i] != x[i]) return i;
  return -1;
}

static corot_status refuse_nan(const corot_model *m, char name, int dof) {
  for (int n = 0; n < m->mesh->nnode; n++)
    for (int c = 0; c < 3; c++)
      if (m->dof[n][c] == dof)
        return corot_fail(COROT_EINVAL, "%c[%d], the %c component at node %d, is not a number",
                          name, dof, "xyz"[c], n);
  return corot_fail(COROT_EINVAL, "%c[%d] is not a number", name, dof);
}

/* The status of an evaluation, of which NaN is the more telling reason to fail. It is looked for
   where it must have led to a failure, or where it passes through. */
static corot_status blame_nan(const corot_model *m, const double *u, const double *v,
                              corot_status status) {
  int at = status ? find_nan(m->ndof, u) : -1;
  if (at >= 0) return refuse_nan(m, 'u', at);
  at = v ? find_nan(m->ndof, v) : -1;
  return at >= 0 ? refuse_nan(m, 'v', at) : status;
}

corot_status corot_residual(const corot_model *m, corot_state *s, double t, const double *u,
                            const double *v, double *r) {
  corot_status status = corot_residual_trial(m, s, t, u, v, r);
  return status ? blame_nan(m, u, s->still ? NULL : v, status) : COROT_OK;
}

corot_status corot_rhs(const corot_model *m, corot_state *s, double t, const double *y,
                       double *ydot) {
  return blame_nan(m, y, y + m->ndof, corot_rhs_trial(m, s, t, y, ydot));
}

corot_status corot_rhs_trial(const corot_model *m, corot_state *s, double t, const double *y,
                             double *ydot) {
  int n = m->ndof;
  if (m->mass_pair)
    return corot_fail(COROT_EINVAL,
                      "the right-hand side takes a factor of the consistent mass: "
                      "use corot_residual and corot_mass_solve");
  COROT_TRY(corot_residual_trial(m, s, t, y, y + n, ydot + n));
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
  if (tangent == COROT_TANGENT_AUTO) tangent = COROT_TANGENT_HELD;
  corot_kernel_dilatation(m, s);
  corot_tangent own = m->levels ? COROT_TANGENT_HELD : tangent;
  if (m->levels) COROT_TRY(corot_levels_hand_down(m, s, t));
  for (int c = 0; c < m->pattern.nchunk; c++)
    COROT_TRY(corot_state_check(s, corot_kernel_tangent(m, s, own, c, K, m->damped ? D : NULL)));
  if (K) corot_kernel_dilatation_tangent(m, s, K);
  if (m->levels) COROT_TRY(corot_levels_add_matrices(m, s, t, tangent, K, m->damped ? D : NULL));
  if (D) corot_mass_damping_matrix(m, D);
  return COROT_OK;
}

corot_status corot_jvp(const corot_model *m, corot_state *s, double t, const double *u,
                       const double *v, corot_tangent tangent, const double *du, const double *dv,
                       double *jv) {
  corot_state_displace(m, s, t, u);
  if (s->still) { /* v plays no part, and neither does dv */
    memset(s->v, 0, s->nnode * sizeof *s->v);
    memset(s->dv, 0, s->nnode * sizeof *s->dv);
  } else {
    corot_model_velocity(m, s->phase, t, v, s->v[0], 4);
    corot_model_spread(m, dv, s->dv[0], 4);
  }
  corot_model_spread(m, du, s->du[0], 4);
  memset(s->r, 0, m->ndof * sizeof *s->r);
  external_derivative(m, s, t, s->r);
  if (!s->still) corot_mass_damp(m, dv, s->r);
  bool exact = tangent > COROT_TANGENT_HELD;
  corot_kernel_dilatation(m, s);
  corot_kernel_dilatation_change(m, s, exact);
  COROT_TRY(m->levels ? corot_levels_derivative(m, s, t, tangent)
                      : corot_sum_forces(m, s, t, corot_kernel_derivative, exact));
  memcpy(jv, s->r, m->ndof * sizeof *jv);
  return COROT_OK;
}

static void add_cross(double a[3], const double x[3], const double p[3]) {
  a[0] += x[1] * p[2] - x[2] * p[1];
  a[1] += x[2] * p[0] - x[0] * p[2];
  a[2] += x[0] * p[1] - x[1] * p[0];
}

static double dot(int n, const double *a, const double *b) {
  double sum = 0;
  for (int i = 0; i < n; i++) sum += a[i] * b[i];
  return sum;
}

/* Kinetic energy and momenta from M v, which goes through s->r. */
static void add_inertia(const corot_model *m, corot_state *s, const double *v, corot_energies *e) {
  corot_mass_multiply(m, v, s->r);
  e->kinetic = 0.5 * dot(m->body_ndof, v, s->r);
  for (int n = 0; n < m->body_nnode; n++) {
    double x[3], p[3];
    for (int c = 0; c < 3; c++) {
      int i = m->dof[n][c];
      x[c] = m->mesh->x[n][c] + s->u[n][c];
      p[c] = i >= 0 ? s->r[i] : 0;
      e->momentum[c] += p[c];
    }
    add_cross(e->angular_momentum, x, p);
  }
}

/* Power of the internal and viscous forces on moving supports: what the supports put in. Components
   at rest have no velocity. */
static corot_status support_power(const corot_model *m, corot_state *s, double t, double *power) {
  double(*f)[4] = s->du; /* directions play no part here */
  COROT_TRY(m->levels ? corot_levels_nodal_force(m, s, t, m->damped, f)
                      : corot_nodal_forces(m, s, corot_kernel_force, m->damped, f));
  for (int n = 0; n < m->body_nnode; n++)
    for (int i = 0; i < 3; i++)
      if (m->dof[n][i] < 0) *power -= f[n][i] * s->v[n][i];
  return COROT_OK;
}

/* Of a field of nodes (or NULL) and of the forces r [ndof], on what is free, along a rigid motion:
   a force where the body is now, s->u. */
static double along(const corot_model *m, const corot_state *s, const rigid_motion *g,
                    const double (*f)[4], const double *r) {
  double sum = 0;
  for (int n = 0; n < m->body_nnode; n++) {
    double arm[3], w[3] = {g->velocity[0], g->velocity[1], g->velocity[2]};
    for (int c = 0; c < 3; c++) arm[c] = m->mesh->x[n][c] + s->u[n][c] - g->center[c];
    add_cross(w, g->spin, arm);
    for (int c = 0; c < 3; c++) {
      int i = m->dof[n][c];
      if (i >= 0) sum += w[c] * (r[i] + (f ? f[n][c] : 0));
    }
  }
  return sum;
}

double corot_carried(const corot_model *m, corot_state *s, double t, const double *u,
                     const double *v) {
  rigid_motion g;
  if (!corot_motions_carry(m, s->phase, t, &g)) return 0;
  corot_state_displace(m, s, t, u);
  corot_mass_multiply(m, v, s->r);
  return along(m, s, &g, NULL, s->r);
}

corot_status corot_energy(const corot_model *m, corot_state *s, double t, const double *u,
                          const double *v, corot_energies *energies) {
  corot_energies e = {0};
  rigid_motion g;
  bool carried = m->nmotion > 0 && corot_motions_carry(m, s->phase, t, &g);
  corot_state_displace(m, s, t, u);
  corot_model_velocity(m, s->phase, t, v, s->v[0], 4);
  corot_kernel_dilatation(m, s);
  double *viscous = &e.power_dissipated;
  if (m->levels)
    COROT_TRY(corot_levels_energy(m, s, t, m->damped, &e.elastic, viscous));
  else
    COROT_TRY(corot_state_check(s, corot_kernel_energy(m, s, m->damped, &e.elastic, viscous)));

  /* the supports and the loads; support_power leaves the forces of all nodes in s->du */
  if (m->nmotion) COROT_TRY(support_power(m, s, t, &e.power_supports));
  external_force(m, s, t, s->r);
  e.power_external = e.power_supports + dot(m->body_ndof, s->r, v);
  e.power_carried = e.power_supports;
  if (carried) e.power_carried -= along(m, s, &g, (const double(*)[4])s->du, s->r);
  if (m->mass_damped) {
    memset(s->r, 0, m->ndof * sizeof *s->r);
    corot_mass_damp(m, v, s->r);
    e.power_dissipated -= dot(m->body_ndof, s->r, v);
    if (carried) e.power_carried -= along(m, s, &g, NULL, s->r);
  }

  /* add_inertia leaves M v in s->r */
  add_inertia(m, s, v, &e);
  if (carried) e.carried = along(m, s, &g, NULL, s->r);
  *energies = e;
  return COROT_OK;
}

corot_status corot_elastic_force(const corot_model *m, corot_state *s, double t, const double *u,
                                 double (*f)[3]) {
  if (!m->levels) return corot_internal_force(m, s, t, u, corot_model_strain(m), 1, 1, f);
  corot_frames frames = s->levels->frames;
  corot_state_displace(m, s, t, u);
  corot_levels_use(s->levels, COROT_FRAMES_EXACT);
  corot_status status = corot_levels_nodal_force(m, s, t, false, s->du);
  corot_levels_use(s->levels, frames);
  COROT_TRY(status);
  for (int n = 0; n < m->mesh->nnode; n++)
    for (int c = 0; c < 3; c++) f[n][c] = -s->du[n][c];
  return COROT_OK;
}

corot_status corot_internal_force(const corot_model *m, corot_state *s, double t, const double *u,
                                  const char *strain, double lambda_part, double mu_part,
                                  double (*f)[3]) {
  int index;
  COROT_TRY(corot_model_find_strain(strain, &index));
  corot_state_displace(m, s, t, u);
  corot_kernel_internal_dilatation(m, s, index);
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
