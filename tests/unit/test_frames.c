/* Frames between updates: spin, extrapolation, drift, and what a lag does to forces and energy. */
#include "core/lanes/polar.h"
#include "solid.h"

/* A crooked box turned by `angle` about `axis` through the origin, stretched by S first, all free.
 */
typedef struct turned {
  corot_mesh *mesh;
  corot_model *model;
  corot_state *state;
  int n;
  double *u, *v, *r;
} turned;

static turned make(const char *strain) {
  turned s = {.mesh = crooked_box(2, 1, 2)};
  corot_model_def def = corot_model_defaults();
  corot_material material = soft;
  material.damping_lambda = material.damping_mu = 0;
  def.mesh = s.mesh, def.strain = strain, def.nmaterial = 1, def.material = &material;
  assert_ok(corot_model_create(&def, &s.model));
  assert_ok(corot_state_create(s.model, &s.state));
  s.n = corot_model_ndof(s.model);
  s.u = calloc(3 * s.n, sizeof *s.u);
  s.v = s.u + s.n, s.r = s.v + s.n;
  return s;
}

static void drop(turned *s) {
  corot_state_destroy(s->state);
  corot_model_destroy(s->model);
  corot_mesh_destroy(s->mesh);
  free(s->u);
}

/* x = Q(angle) S X with S = diag, turning at `rate`. All components are free, so dof 3n + c. */
static void turn(turned *s, const double axis[3], double angle, double rate, const double S[3]) {
  double Q[9], n = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
  rotation(axis, angle, Q);
  for (int k = 0; k < s->mesh->nnode; k++) {
    double y[3], x[3];
    for (int c = 0; c < 3; c++) y[c] = S[c] * s->mesh->x[k][c];
    apply(Q, y, x);
    for (int c = 0; c < 3; c++) {
      int i = (c + 1) % 3, j = (c + 2) % 3;
      s->u[3 * k + c] = x[c] - s->mesh->x[k][c];
      s->v[3 * k + c] = rate * (axis[i] * x[j] - axis[j] * x[i]) / n;
    }
  }
}

static double largest(int n, const double *a) {
  double m = 0;
  for (int i = 0; i < n; i++) m = fmax(m, fabs(a[i]));
  return m;
}

static const double axis[3] = {1, -2, 0.5}, none[3] = {1, 1, 1}, stretched[3] = {1.2, 0.9, 1.05};

static void rotate_by_is_the_exponential(void **state) {
  (void)state;
  for (double angle = 0; angle <= 3.14; angle += 0.157) {
    double Q[9], E[9], length = sqrt(1 + 4 + 0.25);
    vec3 w;
    for (int c = 0; c < 3; c++) w.v[c] = vd_all(axis[c] / length);
    rotation(axis, angle, Q);
    mat3_store(rotate_by(w, angle, mat3_identity()), 3, E);
    for (int k = 0; k < 9; k++) assert_close(E[k], Q[k], 0, 4e-15);
  }
}

static void spin_of_a_turning_body_is_its_angular_velocity(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++) {
    if (!corot_strain_traits(m)->frames) continue;
    turned s = make(measures[m]);
    turn(&s, axis, 0.7, 2.5, stretched);
    double spin;
    assert_ok(corot_frames_update(s.model, s.state, 0, s.u, NULL));
    assert_ok(corot_frames_spin(s.model, s.state, 0, s.u, s.v, &spin));
    assert_close(spin, 2.5, 1e-12, 0);
    drop(&s);
  }
}

/* In a steady turn of a stretched body the extrapolated frames stay exact. */
static void extrapolation_follows_a_steady_turn(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++) {
    if (!corot_strain_traits(m)->frames) continue;
    turned s = make(measures[m]);
    double *exact = malloc(s.n * sizeof *exact);
    turn(&s, axis, 0.3, 2.0, stretched);
    corot_state_use(s.state, COROT_FRAMES_EXTRAPOLATED);
    assert_ok(corot_frames_update(s.model, s.state, 5.0, s.u, NULL));
    assert_ok(corot_frames_spin(s.model, s.state, 5.0, s.u, s.v, NULL));
    turn(&s, axis, 0.3 + 2.0 * 0.4, 2.0, stretched); /* 0.4 s later */
    assert_ok(corot_residual(s.model, s.state, 5.4, s.u, s.v, s.r));
    corot_frames_change drift;
    assert_ok(corot_frames_drift(s.model, s.state, 5.4, s.u, &drift));
    assert_below(drift.angle_max, 1e-14);
    corot_state_use(s.state, COROT_FRAMES_EXACT);
    assert_ok(corot_residual(s.model, s.state, 5.4, s.u, s.v, exact));
    for (int i = 0; i < s.n; i++) /* rounding of stresses of 1e4 Pa on faces of 0.2 m^2 */
      assert_close(s.r[i], exact[i], 0, 1e-13 * largest(s.n, exact));
    free(exact), drop(&s);
  }
}

static void drift_is_the_angle_turned_since_the_update(void **state) {
  (void)state;
  turned s = make("polar");
  corot_state_use(s.state, COROT_FRAMES_HELD);
  corot_frames_change drift, change;
  turn(&s, axis, 0.2, 0, stretched);
  assert_ok(corot_frames_drift(s.model, s.state, 0, s.u, &drift));
  assert_close(drift.angle_max, 0.2, 1e-13, 0);
  assert_close(drift.angle_mean, 0.2, 1e-13, 0);
  assert_ok(corot_frames_update(s.model, s.state, 0, s.u, &change));
  assert_close(change.angle_max, drift.angle_max, 0, 0);
  assert_close(change.energy, drift.energy, 0, 0);
  turn(&s, axis, 0.2001, 0, stretched);
  assert_ok(corot_frames_drift(s.model, s.state, 0, s.u, &drift));
  assert_close(drift.angle_max, 1e-4, 1e-10, 0);
  drop(&s);
}

/* Jump of the elastic energy at an update after a lag of theta, principal stretches s1, s2 in the
   plane of rotation: V theta^2/2 (s1 + s2) (mu (s1 + s2 - 2) + lambda tr(S - I)) + O(theta^4), with
   the sign of new less old turned: the lagged energy is lower in tension. For a rigid turn it is
   -V (lambda + mu) theta^4 / 2. */
static void energy_jump_of_an_update_follows_its_law(void **state) {
  (void)state;
  turned s = make("polar");
  corot_state_use(s.state, COROT_FRAMES_HELD);
  double volume = corot_mesh_measure(s.mesh).volume, z[3] = {0, 0, 1}, theta = 1e-3;
  double s1 = stretched[0], s2 = stretched[1], trace = s1 + s2 + stretched[2] - 3;
  double law =
      volume * 0.5 * theta * theta * (s1 + s2) * (soft.mu * (s1 + s2 - 2) + soft.lambda * trace);
  corot_frames_change change;
  turn(&s, z, 0.5, 0, stretched);
  assert_ok(corot_frames_update(s.model, s.state, 0, s.u, NULL));
  turn(&s, z, 0.5 + theta, 0, stretched);
  assert_ok(corot_frames_update(s.model, s.state, 0, s.u, &change));
  assert_close(change.energy, law, 1e-5, 0); /* next term: theta^2 smaller, some ten times larger */

  theta = 0.05;
  turn(&s, z, 0.5, 0, none);
  assert_ok(corot_frames_update(s.model, s.state, 0, s.u, NULL));
  turn(&s, z, 0.5 + theta, 0, none);
  assert_ok(corot_frames_update(s.model, s.state, 0, s.u, &change));
  assert_close(change.energy, -volume * (soft.lambda + soft.mu) * pow(theta, 4) / 2, 2e-3, 0);
  drop(&s);
}

/* The first-order error of lagged frames is a pure couple: P_held - P_exact =
   -R [(mu (tr E I - E) + lambda tr(E) I) w]x, so halving the lag halves the force error, and what
   the law leaves is of second order. */
static void lagged_stress_is_a_couple_of_first_order(void **state) {
  (void)state;
  double R[9], last = 0;
  rotation(axis, 0.4, R);
  for (int half = 0; half < 3; half++) {
    turned s = make("polar");
    double theta = 1e-2 / (1 << half), w[3] = {0.6 * theta, -0.64 * theta, 0.48 * theta};
    (void)w;
    double *exact = malloc(s.n * sizeof *exact);
    turn(&s, axis, 0.4, 0, stretched);
    assert_ok(corot_frames_update(s.model, s.state, 0, s.u, NULL));
    turn(&s, axis, 0.4 + theta, 0, stretched);
    assert_ok(corot_residual(s.model, s.state, 0, s.u, s.v, exact));
    corot_state_use(s.state, COROT_FRAMES_HELD);
    assert_ok(corot_residual(s.model, s.state, 0, s.u, s.v, s.r));
    for (int i = 0; i < s.n; i++) s.r[i] -= exact[i];
    double error = largest(s.n, s.r);
    if (half) assert_close(last / error, 2, 2e-2, 0);
    last = error;
    free(exact), drop(&s);
  }
}

static void the_plane_formula_is_the_polar_factor(void **state) {
  (void)state;
  uint64_t seed = 3;
  for (int k = 0; k < 100; k++) {
    double J[4], R[4];
    for (int i = 0; i < 4; i++) J[i] = noise(&seed);
    if (fabs(J[0] * J[3] - J[1] * J[2]) < 1e-3) continue;
    assert_ok(corot_polar_2d(J, R));
    double S01 = R[0] * J[1] + R[2] * J[3], S10 = R[1] * J[0] + R[3] * J[2];
    double S00 = R[0] * J[0] + R[2] * J[2], S11 = R[1] * J[1] + R[3] * J[3];
    assert_close(R[0] * R[1] + R[2] * R[3], 0, 0, 1e-13);
    assert_close(R[0] * R[0] + R[2] * R[2], 1, 1e-15, 0);
    assert_close(S01, S10, 0, 1e-13);
    assert_true(S00 + S11 > 0 && S00 * S11 - S01 * S10 > 0); /* positive definite stretch */
  }
  double flat[4] = {1, 2, 2, 4}, R[4];
  assert_fails(corot_polar_2d(flat, R), COROT_RETRY, "singular");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rotate_by_is_the_exponential),
      cmocka_unit_test(spin_of_a_turning_body_is_its_angular_velocity),
      cmocka_unit_test(extrapolation_follows_a_steady_turn),
      cmocka_unit_test(drift_is_the_angle_turned_since_the_update),
      cmocka_unit_test(energy_jump_of_an_update_follows_its_law),
      cmocka_unit_test(lagged_stress_is_a_couple_of_first_order),
      cmocka_unit_test(the_plane_formula_is_the_polar_factor),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
