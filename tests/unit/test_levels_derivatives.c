/* A hierarchical model: K, D and the Jacobian-vector product against differences of the force, and
   the policies of its frames. */
#include "hierarchical.h"

/* --- Derivatives ----------------------------------------------------------------------------- */

/* r(u + h du, v + h dv) differenced centrally. */
static void difference(const solid *s, const double *u, const double *v, const double *du,
                       const double *dv, double *work, double *dr) {
  double *x = work, *y = x + s->n, *r = y + s->n, h = 1e-5;
  for (int side = 0; side < 2; side++) {
    double step = side ? h : -h;
    for (int i = 0; i < s->n; i++) x[i] = u[i] + step * du[i], y[i] = v[i] + step * dv[i];
    assert_ok(corot_residual(s->model, s->state, 0, x, y, r));
    for (int i = 0; i < s->n; i++) dr[i] = side ? (r[i] - dr[i]) / (2 * h) : r[i];
  }
}

static void test_product_with_the_derivative(void **state) {
  corot_coupling coupling = coupling_of(state);
  const choice choices[] = {
      {"green", "polar", 2, 0, true},
      {"green", "polar", 2, 1, true},
      {"polar", "polar", 1, 1, true},
      {"hybrid", "polar", 1, 0, false},
      {"green", "warp", 2, 0, false},
      {"warp", "warp", 1, 0, false},
      {"green", "cauchy", 1, 0, true},
      {"green", "polar", 0, 0, true, .raised = true},
      {"green", "polar", 0, 1, true, .raised = true},
      {"green", "polar", 1, 0, true, .raised = true},
      {"green", "polar", 1, 1, true, .raised = true},
      {"hybrid", "polar", 0, 0, false, .raised = true},
      {"green", "warp", 0, 0, false, .raised = true},
      {"green", "cauchy", 0, 0, true, .raised = true},
  };
  for (size_t k = 0; k < sizeof choices / sizeof *choices; k++)
    for (int held = 0; held < 2; held++) {
      solid s = make_solid(&choices[k], coupling, &soft, true);
      double *u = vectors(9, s.n), *v = u + s.n, *du = v + s.n, *dv = du + s.n;
      double *jv = dv + s.n, *expected = jv + s.n, *work = expected + s.n;
      bend(&s, 0.6, 0.01, u);
      fill_noise(s.n, 3, 100, v); /* fast, so that the viscous part shows */
      fill_noise(s.n, 4, 1, du);
      fill_noise(s.n, 6, 100, dv);
      corot_tangent tangent = held ? COROT_TANGENT_HELD : COROT_TANGENT_EXACT;
      if (held) {
        corot_state_use(s.state, COROT_FRAMES_HELD);
        assert_ok(corot_frames_update(s.model, s.state, 0, u, NULL));
      }
      difference(&s, u, v, du, dv, work, expected);
      assert_ok(corot_jvp(s.model, s.state, 0, u, v, tangent, du, dv, jv));
      assert_near(s.n, jv, expected, 1e-7);
      free(u);
      drop_solid(&s);
    }
}

/* K at v = 0 and D, with the frames held: those of the force or, where means couple the levels,
   of that with the model's own measure on level 0. */
static void test_matrices(void **state) {
  corot_coupling coupling = coupling_of(state);
  const choice choices[] = {{"green", "polar", 1, 0, true},
                            {"green", "polar", 2, 1, true},
                            {"polar", "warp", 1, 0, false},
                            {"green", "cauchy", 2, 0, true},
                            {"green", "polar", 0, 0, true, .raised = true},
                            {"green", "polar", 1, 1, true, .raised = true},
                            {"green", "polar", 1, 2, true, .raised = true},
                            {"green", "warp", 0, 0, false, .raised = true}};
  for (size_t k = 0; k < sizeof choices / sizeof *choices; k++) {
    choice other = choices[k];
    if (coupling == COROT_COUPLING_MEAN) other.coarse = other.fine;
    solid s = make_solid(&choices[k], coupling, &soft, true);
    solid o = make_solid(&other, coupling, &soft, true);
    double *u = vectors(9, s.n), *zero = u + s.n, *du = zero + s.n, *y = du + s.n;
    double *expected = y + s.n, *work = expected + s.n;
    int nblock = corot_model_nblock(s.model);
    double(*K)[9] = calloc(2 * nblock, sizeof *K), (*D)[9] = K + nblock;
    bend(&s, 0.6, 0.01, u);
    fill_noise(s.n, 4, 1, du);
    corot_state_use(s.state, COROT_FRAMES_HELD);
    corot_state_use(o.state, COROT_FRAMES_HELD);
    assert_ok(corot_frames_update(s.model, s.state, 0, u, NULL));
    assert_ok(corot_frames_update(o.model, o.state, 0, u, NULL));
    assert_ok(corot_jacobian(s.model, s.state, 0, u, zero, COROT_TANGENT_HELD, K, D));

    difference(&o, u, zero, du, zero, work, expected);
    corot_block_multiply(s.model, (const double(*)[9])K, du, y);
    for (int i = 0; i < s.n; i++) y[i] = -y[i];
    assert_near(s.n, y, expected, 1e-7);
    difference(&o, u, zero, zero, du, work, expected);
    corot_block_multiply(s.model, (const double(*)[9])D, du, y);
    for (int i = 0; i < s.n; i++) y[i] = -y[i];
    assert_near(s.n, y, expected, 1e-7);
    free(K), free(u);
    drop_solid(&o);
    drop_solid(&s);
  }
}

/* A model says that its matrices depend on the frames alone; then, and only then, held frames give
   the same ones wherever the body is. */
static void assert_matrices_by_frames(const choice *c, corot_coupling coupling) {
  solid s = make_solid(c, coupling, &soft, true);
  double *u = vectors(2, s.n), *zero = u + s.n;
  int nblock = corot_model_nblock(s.model);
  double(*K)[9] = calloc(2 * nblock, sizeof *K), (*bent)[9] = K + nblock;
  bend(&s, 0.6, 0.01, u);
  corot_state_use(s.state, COROT_FRAMES_HELD);
  assert_ok(corot_jacobian(s.model, s.state, 0, zero, zero, COROT_TANGENT_HELD, K, NULL));
  assert_ok(corot_jacobian(s.model, s.state, 0, u, zero, COROT_TANGENT_HELD, bent, NULL));
  bool same = memcmp(K, bent, nblock * sizeof *K) == 0;
  assert_int_equal(corot_model_matrices_by_frames(s.model), same);
  assert_int_equal(same, coupling == COROT_COUPLING_MEAN);
  free(K), free(u);
  drop_solid(&s);
}

static void test_matrices_by_frames(void **state) {
  corot_coupling coupling = coupling_of(state);
  assert_matrices_by_frames(&(choice){"green", "polar", 2, 0, true}, coupling);
  assert_matrices_by_frames(&(choice){"green", "polar", 0, 0, true, .raised = true}, coupling);
}

/* Under exact frames, what is left out is of the size of the strain times the difference. */
static void assert_exact_tangent_at_rest(const choice *c, corot_coupling coupling) {
  solid s = make_solid(c, coupling, &undamped, true);
  double *u = vectors(5, s.n), *zero = u + s.n, *du = zero + s.n, *y = du + s.n, *jv = y + s.n;
  double(*K)[9] = calloc(corot_model_nblock(s.model), sizeof *K);
  fill_noise(s.n, 4, 1, du);
  assert_ok(corot_jacobian(s.model, s.state, 0, u, zero, COROT_TANGENT_EXACT, K, NULL));
  assert_ok(corot_jvp(s.model, s.state, 0, u, zero, COROT_TANGENT_EXACT, du, zero, jv));
  corot_block_multiply(s.model, (const double(*)[9])K, du, y);
  for (int i = 0; i < s.n; i++) y[i] = -y[i];
  assert_near(s.n, y, jv, 1e-12);
  free(K), free(u);
  drop_solid(&s);
}

static void test_exact_tangent_at_rest(void **state) {
  corot_coupling coupling = coupling_of(state);
  assert_exact_tangent_at_rest(&(choice){"green", "polar", 2, 0, true}, coupling);
  assert_exact_tangent_at_rest(&(choice){"green", "polar", 0, 0, true, .raised = true}, coupling);
}

/* --- Frames ---------------------------------------------------------------------------------- */

static void test_frames_are_handed_down(void **state) {
  corot_coupling coupling = coupling_of(state);
  for (int level = 0; level < 3; level++) {
    choice c = {"green", "polar", 2, level, true};
    solid s = make_solid(&c, coupling, &undamped, true);
    int ntet = s.mesh->ntet, shift = 3 * (2 - level);
    double *u = vectors(1, s.n), (*R)[9] = calloc(ntet, sizeof *R);
    corot_element_fields fields = {.frame = R};
    bend(&s, 0.6, 0.01, u);
    assert_ok(corot_elements(s.model, s.state, 0, u, &fields));
    for (int e = 0; e < ntet; e++) assert_true(distance(R[e], R[e >> shift << shift]) == 0);
    assert_true(distance(R[0], R[1 << shift]) > 1e-3);
    assert_true(distance(R[0], R[ntet / 2]) > 1e-3);
    free(R), free(u);
    drop_solid(&s);
  }
}

/* At all four points of a ten-node tet stands the frame of the tet above it; on the level of these
   tets each point has its own. */
static void test_frames_are_handed_down_to_points(void **state) {
  corot_coupling coupling = coupling_of(state);
  for (int level = 0; level < 3; level++) {
    choice c = {"green", "polar", 1, level, true, .raised = true};
    solid s = make_solid(&c, coupling, &undamped, true);
    int ntet = s.mesh->ntet, below = level == 0 ? 8 : 1;
    double *u = vectors(1, s.n), (*R)[4][9] = calloc(ntet, sizeof *R);
    corot_element_fields fields = {.frame_at = R};
    bend(&s, 0.6, 0.01, u);
    assert_ok(corot_elements(s.model, s.state, 0, u, &fields));
    for (int e = 0; e < ntet; e++)
      for (int k = 0; k < 4; k++) {
        double off = distance(R[e][k], R[e / below * below][0]);
        assert_true(level < 2 ? off == 0 : k == 0 || off > 1e-3);
      }
    assert_true(distance(R[0][0], R[8][0]) > 1e-3);
    free(R), free(u);
    drop_solid(&s);
  }
}

static void assert_update_of_held_frames(const choice *of, corot_coupling coupling, double angle) {
  choice c = *of;
  solid s = make_solid(&c, coupling, &undamped, true);
  double *u = vectors(5, s.n), *zero = u + s.n, *r = zero + s.n, *exact = r + s.n;
  bend(&s, 0.6, 0.01, u);
  corot_state_use(s.state, COROT_FRAMES_HELD);
  double before = elastic_energy(s.model, s.state, u, zero);
  corot_frames_change drift, change;
  assert_ok(corot_frames_drift(s.model, s.state, 0, u, &drift));
  assert_close(elastic_energy(s.model, s.state, u, zero), before, 0, 0);
  assert_ok(corot_frames_update(s.model, s.state, 0, u, &change));
  double after = elastic_energy(s.model, s.state, u, zero);
  assert_close(change.energy, after - before, 1e-12, 0);
  assert_close(drift.energy, change.energy, 0, 0);
  assert_close(drift.angle_max, change.angle_max, 0, 0);
  assert_close(change.angle_max, angle, 0, 0.1);
  assert_int_equal(change.angle_tet % 8, 0);
  assert_ok(corot_frames_drift(s.model, s.state, 0, u, &drift));
  assert_below(drift.angle_max, 1e-15);

  /* the energies agree; the forces where nothing turns */
  corot_state_use(s.state, COROT_FRAMES_EXACT);
  assert_close(elastic_energy(s.model, s.state, u, zero), after, 1e-14, 0);
  choice paper = c;
  paper.conservative = false;
  solid p = make_solid(&paper, coupling, &undamped, true);
  assert_ok(corot_residual(p.model, p.state, 0, u, zero, exact));
  corot_state_use(s.state, COROT_FRAMES_HELD);
  assert_ok(corot_residual(s.model, s.state, 0, u, zero, r));
  assert_near(s.n, r, exact, 1e-14);
  free(u);
  drop_solid(&p);
  drop_solid(&s);
}

/* The angle is 0.66 at the top, and half the shear there, as far as the tets of the frame level are
   there. */
static void test_update_of_held_frames(void **state) {
  corot_coupling coupling = coupling_of(state);
  assert_update_of_held_frames(&(choice){"green", "polar", 2, 1, true}, coupling, 0.95);
  assert_update_of_held_frames(&(choice){"green", "polar", 1, 0, true, .raised = true}, coupling,
                               0.8);
}

/* A body that turns as a whole, seen 0.1 s later. */
static void assert_extrapolated_frames(const choice *c, corot_coupling coupling) {
  solid s = make_solid(c, coupling, &undamped, false);
  double *u = vectors(4, s.n), *v = u + s.n, *zero = v + s.n, *r = zero + s.n;
  double axis[3] = {0, 0, 1}, Q[9], spin;
  rotation(axis, 0.2, Q);
  for (int n = 0; n < s.mesh->nnode; n++) {
    v[3 * n] = -2 * s.mesh->x[n][1];
    v[3 * n + 1] = 2 * s.mesh->x[n][0];
  }
  assert_ok(corot_frames_update(s.model, s.state, 0, u, NULL));
  assert_ok(corot_frames_spin(s.model, s.state, 0, u, v, &spin));
  assert_close(spin, 2, 1e-12, 0);
  turn(&s, Q, zero, u);
  corot_state_use(s.state, COROT_FRAMES_EXTRAPOLATED);
  assert_int_equal(corot_state_frames(s.state), COROT_FRAMES_EXTRAPOLATED);
  assert_ok(corot_residual(s.model, s.state, 0.1, u, zero, r));
  assert_below(norm_max(s.n, r), 1e-10);
  corot_state_use(s.state, COROT_FRAMES_HELD);
  assert_ok(corot_residual(s.model, s.state, 0.1, u, zero, r));
  if (coupling == COROT_COUPLING_MEAN) /* in one old frame for all there is no detail either */
    assert_below(norm_max(s.n, r), 1e-10);
  else
    assert_above(norm_max(s.n, r), 1);
  free(u);
  drop_solid(&s);
}

static void test_extrapolated_frames(void **state) {
  corot_coupling coupling = coupling_of(state);
  assert_extrapolated_frames(&(choice){"green", "polar", 2, 1, true}, coupling);
  assert_extrapolated_frames(&(choice){"green", "polar", 0, 0, true, .raised = true}, coupling);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      each_coupling_unit_test(test_product_with_the_derivative),
      coupled_unit_test(test_matrices),
      each_coupling_unit_test(test_matrices_by_frames),
      coupled_unit_test(test_exact_tangent_at_rest),
      each_coupling_unit_test(test_frames_are_handed_down),
      each_coupling_unit_test(test_frames_are_handed_down_to_points),
      coupled_unit_test(test_update_of_held_frames),
      each_coupling_unit_test(test_extrapolated_frames),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
