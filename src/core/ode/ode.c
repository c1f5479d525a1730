/* The functions of the ODE: nodal fields, kernels over the tets, loads. */
#include <corot/ode.h>

#include <string.h>

#include "core/model/load_force.h"
#include "core/solid/measures.h"
#include "state.h"
#include "trial.h"

/* Where forces exceed double precision no tet is to blame, but a time. */
static corot_status status_at(const corot_state *s, double t, corot_status status) {
  if (status != COROT_RETRY || s->system.inverted >= 0) return status;
  return corot_fail(COROT_RETRY, "%s at t = %g", corot_error(), t);
}

corot_status corot_force_of_loads(const corot_model *m, corot_state *s, double t, const double *u,
                                  const double *v, double *f) {
  const instant now = corot_state_at(s, t);
  bool feeds_back = inputs_feed_back(&now);
  if (feeds_back || corot_loads_follow(m)) corot_state_displace(m, s, &now, u);
  if (feeds_back)
    COROT_TRY(corot_feedback_evaluate(&now, (nodal_field)s->u, corot_state_move(m, s, &now, v)));
  corot_loads_force(m, &now, (nodal_field)s->u, f);
  if (feeds_back) corot_feedback_add(&now, f);
  for (int i = m->body_ndof; i < m->ndof; i++) f[i] = 0;
  return COROT_OK;
}

/* f [ndof] += the force of the feedback for displacement and velocity of all nodes. */
static corot_status add_feedback(const instant *now, nodal_field u, nodal_field v, double *f) {
  COROT_TRY(corot_feedback_evaluate(now, u, v));
  corot_feedback_add(now, f);
  return COROT_OK;
}

corot_status corot_residual_trial(const corot_model *m, corot_state *s, double t, const double *u,
                                  const double *v, double *r) {
  const instant now = corot_state_at(s, t);
  bool damped = body_of(m, s)->damped && now.moving, feeds_back = inputs_feed_back(&now);
  nodal_field all_u = corot_state_displace(m, s, &now, u), all_v = NULL;
  if (damped || (feeds_back && now.moving)) all_v = corot_state_move(m, s, &now, v);
  corot_loads_force(m, &now, all_u, s->r);
  if (now.moving) corot_mass_damp(m, v, s->r);
  if (feeds_back) COROT_TRY(add_feedback(&now, all_u, all_v, s->r));
  corot_status status = corot_system_force(system_of(m, s), &s->system, age_of(s, t), all_u,
                                           damped ? all_v : NULL, (const int(*)[3])m->dof, s->r);
  COROT_TRY(status_at(s, t, status));
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
  COROT_TRY(corot_state_check(m, s, "corot_residual"));
  COROT_TRY(COROT_GIVEN(u));
  if (!s->still) COROT_TRY(COROT_GIVEN(v));
  COROT_TRY(COROT_GIVEN(r));
  corot_status status = corot_residual_trial(m, s, t, u, v, r);
  return status ? blame_nan(m, u, s->still ? NULL : v, status) : COROT_OK;
}

corot_status corot_rhs(const corot_model *m, corot_state *s, double t, const double *y,
                       double *ydot) {
  COROT_TRY(corot_state_check(m, s, "corot_rhs"));
  COROT_TRY(COROT_GIVEN(y));
  COROT_TRY(COROT_GIVEN(ydot));
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

static void clear_part(void *A, int from, int end) {
  double(*block)[9] = A;
  memset(block + from, 0, (end - from) * sizeof *block);
}

static void clear_blocks(const corot_state *s, int nblock, double (*A)[9]) {
  if (A) corot_team_loop(s->system.team, nblock, clear_part, A);
}

corot_status corot_jacobian(const corot_model *m, corot_state *s, double t, const double *u,
                            const double *v, corot_tangent tangent, double (*K)[9],
                            double (*D)[9]) {
  COROT_TRY(corot_state_check(m, s, "corot_jacobian"));
  COROT_TRY(COROT_GIVEN(u));
  const instant now = corot_state_at(s, t);
  const solid *body = body_of(m, s);
  nodal_field all_u = corot_state_displace(m, s, &now, u);
  clear_blocks(s, body->pattern.nblock, K);
  clear_blocks(s, body->pattern.nblock, D);
  if (tangent == COROT_TANGENT_AUTO) tangent = COROT_TANGENT_HELD;
  COROT_TRY(corot_system_matrices(system_of(m, s), &s->system, age_of(s, t), all_u, tangent, K,
                                  body->damped ? D : NULL));
  if (D) corot_mass_damping_matrix(m, D);
  if (!inputs_feed_back(&now)) return COROT_OK; /* all other forces are linear in v */
  nodal_field all_v = v && now.moving ? corot_state_move(m, s, &now, v) : NULL;
  return corot_feedback_matrices(&now, all_u, all_v, K, D);
}

void corot_load_stiffness(const corot_model *m, corot_state *s, double t, const double *u,
                          double (*K)[9]) {
  const instant now = corot_state_at(s, t);
  if (!corot_loads_follow(m)) return;
  corot_loads_stiffness(m, &now, corot_state_displace(m, s, &now, u), K);
}

corot_status corot_jvp(const corot_model *m, corot_state *s, double t, const double *u,
                       const double *v, corot_tangent tangent, const double *du, const double *dv,
                       double *jv) {
  COROT_TRY(corot_state_check(m, s, "corot_jvp"));
  COROT_TRY(COROT_GIVEN(u));
  COROT_TRY(COROT_GIVEN(du));
  COROT_TRY(COROT_GIVEN(jv));
  const instant now = corot_state_at(s, t);
  bool damped = body_of(m, s)->damped && now.moving, feeds_back = inputs_feed_back(&now);
  nodal_field all_u = corot_state_displace(m, s, &now, u),
              all_du = corot_state_spread(s, du, s->du);
  nodal_field all_v = NULL, all_dv = NULL;
  if (damped || (feeds_back && now.moving)) {
    all_v = corot_state_move(m, s, &now, v);
    all_dv = corot_state_spread(s, dv, s->dv);
  }
  memset(s->r, 0, m->ndof * sizeof *s->r);
  corot_loads_derivative(m, &now, all_u, all_du, s->r);
  if (now.moving) corot_mass_damp(m, dv, s->r);
  if (feeds_back) {
    COROT_TRY(corot_feedback_differentiate(&now, all_u, all_v, all_du, all_dv));
    corot_feedback_add(&now, s->r);
  }
  if (!damped) all_v = all_dv = NULL;
  corot_status status =
      corot_system_derivative(system_of(m, s), &s->system, age_of(s, t), all_u, all_v, all_du,
                              all_dv, tangent, (const int(*)[3])m->dof, s->r);
  COROT_TRY(status_at(s, t, status));
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

/* Kinetic energy and momenta from M v, which stays in s->r. */
static void add_inertia(const corot_model *m, corot_state *s, nodal_field all_u, const double *v,
                        corot_energies *e) {
  corot_mass_multiply(m, v, s->r);
  e->kinetic = 0.5 * dot(m->body_ndof, v, s->r);
  for (int n = 0; n < m->body_nnode; n++) {
    double x[3], p[3];
    for (int c = 0; c < 3; c++) {
      int i = m->dof[n][c];
      x[c] = m->mesh->x[n][c] + all_u[n][c];
      p[c] = i >= 0 ? s->r[i] : 0;
      e->momentum[c] += p[c];
    }
    add_cross(e->angular_momentum, x, p);
  }
}

/* Power of the internal and viscous forces, which become f [nnode], on moving supports: what the
   supports put in. Components at rest have no velocity. */
static corot_status support_power(const corot_model *m, corot_state *s, double t, nodal_field u,
                                  nodal_field v, double (*f)[4], double *power) {
  memset(f, 0, s->nnode * sizeof *f);
  COROT_TRY(corot_system_force(system_of(m, s), &s->system, age_of(s, t), u,
                               body_of(m, s)->damped ? v : NULL, NULL, f[0]));
  for (int n = 0; n < m->body_nnode; n++)
    for (int i = 0; i < 3; i++)
      if (m->dof[n][i] < 0) *power -= f[n][i] * v[n][i];
  return COROT_OK;
}

/* Of a field of nodes (or NULL) and of the forces r [ndof], on what is free, along a rigid motion:
   a force where the body is now, displaced by u. */
static double along(const corot_model *m, nodal_field u, const rigid_motion *g, nodal_field f,
                    const double *r) {
  double sum = 0;
  for (int n = 0; n < m->body_nnode; n++) {
    double arm[3], w[3] = {g->velocity[0], g->velocity[1], g->velocity[2]};
    for (int c = 0; c < 3; c++) arm[c] = m->mesh->x[n][c] + u[n][c] - g->center[c];
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
  const instant now = corot_state_at(s, t);
  rigid_motion g;
  if (!corot_motions_carry(m, &now, &g)) return 0;
  nodal_field all_u = corot_state_displace(m, s, &now, u);
  corot_mass_multiply(m, v, s->r);
  return along(m, all_u, &g, NULL, s->r);
}

corot_status corot_energy(const corot_model *m, corot_state *s, double t, const double *u,
                          const double *v, corot_energies *energies) {
  COROT_TRY(corot_state_check(m, s, "corot_energy"));
  COROT_TRY(COROT_GIVEN(u));
  COROT_TRY(COROT_GIVEN(energies));
  const instant now = corot_state_at(s, t);
  corot_energies e = {0};
  rigid_motion g;
  bool carried = m->nmotion > 0 && corot_motions_carry(m, &now, &g);
  nodal_field all_u = corot_state_displace(m, s, &now, u);
  nodal_field all_v = corot_state_move(m, s, &now, v), force = (nodal_field)s->du;
  COROT_TRY(corot_system_energy(system_of(m, s), &s->system, age_of(s, t), all_u,
                                body_of(m, s)->damped ? all_v : NULL, &e.elastic,
                                &e.power_dissipated));

  /* the supports, which need the forces on all nodes, and the loads */
  if (m->nmotion || inputs_move(&now))
    COROT_TRY(status_at(s, t, support_power(m, s, t, all_u, all_v, s->du, &e.power_supports)));
  corot_loads_force(m, &now, all_u, s->r);
  if (inputs_feed_back(&now)) COROT_TRY(add_feedback(&now, all_u, all_v, s->r));
  e.power_external = e.power_supports + dot(m->body_ndof, s->r, v);
  e.power_carried = e.power_supports;
  if (carried) e.power_carried -= along(m, all_u, &g, force, s->r);
  if (m->mass_damped) {
    memset(s->r, 0, m->ndof * sizeof *s->r);
    corot_mass_damp(m, v, s->r);
    e.power_dissipated -= dot(m->body_ndof, s->r, v);
    if (carried) e.power_carried -= along(m, all_u, &g, NULL, s->r);
  }

  /* add_inertia leaves M v in s->r */
  add_inertia(m, s, all_u, v, &e);
  if (carried) e.carried = along(m, all_u, &g, NULL, s->r);
  *energies = e;
  return COROT_OK;
}

/* f [nnode] = -(what is in s->du). */
static void negate(const corot_state *s, double (*f)[3]) {
  for (int n = 0; n < s->nnode; n++)
    for (int c = 0; c < 3; c++) f[n][c] = -s->du[n][c];
}

corot_status corot_elastic_force(const corot_model *m, corot_state *s, double t, const double *u,
                                 double (*f)[3]) {
  COROT_TRY(corot_state_check(m, s, "corot_elastic_force"));
  COROT_TRY(COROT_GIVEN(u));
  COROT_TRY(COROT_GIVEN(f));
  const instant now = corot_state_at(s, t);
  corot_frames frames = s->system.frames;
  nodal_field all_u = corot_state_displace(m, s, &now, u);
  memset(s->du, 0, s->nnode * sizeof *s->du);
  s->system.frames = COROT_FRAMES_EXACT;
  corot_status status =
      corot_system_force(system_of(m, s), &s->system, age_of(s, t), all_u, NULL, NULL, s->du[0]);
  s->system.frames = frames;
  COROT_TRY(status_at(s, t, status));
  negate(s, f);
  return COROT_OK;
}

corot_status corot_internal_force(const corot_model *m, corot_state *s, double t, const double *u,
                                  const char *strain, double lambda_part, double mu_part,
                                  double (*f)[3]) {
  COROT_TRY(corot_state_check(m, s, "corot_internal_force"));
  COROT_TRY(COROT_GIVEN(u));
  COROT_TRY(COROT_GIVEN(strain));
  COROT_TRY(COROT_GIVEN(f));
  const instant now = corot_state_at(s, t);
  force_sum sum = {.r = s->du[0], .sign = 1};
  int index;
  COROT_TRY(corot_strain_index(strain, &index));
  nodal_field all_u = corot_state_displace(m, s, &now, u);
  memset(s->du, 0, s->nnode * sizeof *s->du);
  corot_status status = corot_solid_internal(body_of(m, s), &s->system.of[0], all_u, index,
                                             lambda_part, mu_part, &sum);
  s->system.inverted = s->system.of[0].inverted;
  COROT_TRY(status);
  negate(s, f);
  return COROT_OK;
}
