/* Methods of constant step: order, counts, solution of a step, interpolant, work, refusals. */
#include "bar.h"
#include "follow.h"

static const struct {
  const char *name;
  int order;
} methods[] = {{"backward-euler", 1},   {"bdf2", 2},    {"bdf3", 3},
               {"midpoint", 2},         {"newmark", 2}, {"hht", 2},
               {"generalized-alpha", 2}};
enum { NMETHOD = 7 };

static corot_integrator_def fixed(const char *method, double step, corot_solution solution) {
  corot_integrator_def def = corot_integrator_defaults();
  def.method = method, def.step = step, def.solution = solution;
  return def;
}

static bar quick_bar(double ramp) {
  bar_def of = example2;
  of.ramp = ramp, of.traction[0] = 1000;
  of.viscosity = COROT_COROTATED; /* linear on held frames */
  return bar_create(&of);
}

/* A linear body, well damped, on a support that turns evenly: after 3 s only the smooth forced
   motion is left, also of what a start by backward Euler did wrong. */
static body turning_body(void) {
  corot_box box = {.size = {0.1, 0.1, 0.2}, .cells = {1, 1, 2}};
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  corot_material material = {.lambda = 1e5, .mu = 1e4, .density = 1000, .damping_mass = 20};
  material.damping_lambda = 0.02 * material.lambda, material.damping_mu = 0.02 * material.mu;
  corot_motion motion = {COROT_ROTATE, "zmin", {1, 2, 3}, {0, 0, 0}, 3, {0, 0, 0}, 0, INFINITY};
  corot_model_def def = corot_model_defaults();
  def.strain = "cauchy", def.nmaterial = 1, def.material = &material;
  def.nmotion = 1, def.motion = &motion;
  return make_body(mesh, def);
}

/* u at t = 3 from rest. */
static void turn_for_a_while(const corot_integrator_def *def, double *u, int n) {
  body b = turning_body();
  double *zero = calloc(2 * b.n, sizeof *zero);
  corot_integrator *integrator;
  assert_int_equal(b.n, n);
  assert_ok(corot_integrator_create(def, b.model, b.state, 0, zero, zero + n, &integrator));
  run_to(integrator, 3);
  assert_ok(corot_integrator_at(integrator, 3, u, NULL));
  corot_integrator_destroy(integrator), free(zero), drop_body(&b);
}

static void each_method_has_its_order(void **state) {
  (void)state;
  enum { N = 3 * 8 };
  double exact[N], u[N];
  corot_integrator_def reference = corot_integrator_defaults();
  reference.rtol = 1e-10, reference.atol_displacement = 1e-13;
  turn_for_a_while(&reference, exact, N);
  for (int m = 0; m < NMETHOD; m++) {
    double last = 0;
    for (int k = 0; k < 3; k++) {
      corot_integrator_def def = fixed(methods[m].name, 0.05 / (1 << k), COROT_SOLUTION_LINEAR);
      turn_for_a_while(&def, u, N);
      double error = difference_of(N, u, exact);
      if (k) assert_close(log2(last / error), methods[m].order, 0, 0.15);
      last = error;
    }
    assert_below(last, methods[m].order == 1 ? 1e-2 : 1e-3);
  }
}

/* On held frames a step is linear: one solve does what Newton does, to its tolerance. */
static void linear_and_newton_agree_on_held_frames(void **state) {
  (void)state;
  for (int m = 0; m < NMETHOD; m++) {
    double *u[2];
    int n = 0;
    for (int i = 0; i < 2; i++) {
      bar b = quick_bar(0.2);
      n = b.n;
      corot_integrator_def def =
          fixed(methods[m].name, 0.01, i ? COROT_SOLUTION_NEWTON : COROT_SOLUTION_LINEAR);
      def.newton_tolerance = 1e-12;
      corot_frame_policy policy = corot_frame_policy_defaults();
      policy.frames = COROT_FRAMES_HELD, policy.interval = 0.02;
      corot_integrator *integrator = start(&b, &def);
      corot_frame_clock *clock;
      assert_ok(
          corot_frame_clock_create(&policy, b.model, b.state, integrator, 0, b.u, b.v, &clock));
      follow(integrator, clock, 0, 0.2999);
      u[i] = malloc(b.n * sizeof *u[i]);
      assert_ok(corot_integrator_at(integrator, 30 * 0.01, u[i], NULL));
      corot_statistics s = corot_integrator_statistics(integrator);
      assert_int_equal(s.nst, 30);
      if (i) assert_int_equal(s.nni, 60); /* the second correction is found to be none */
      corot_frame_clock_destroy(clock), corot_integrator_destroy(integrator), bar_destroy(&b);
    }
    assert_below(difference_of(n, u[0], u[1]), 1e-10 * norm_max(n, u[0]));
    free(u[0]), free(u[1]);
  }
}

/* With exact frames Newton's method finds the solution CVODE finds, to second order. */
static void newton_follows_exact_frames(void **state) {
  (void)state;
  static const char *const second[] = {"bdf2", "midpoint", "newmark", "generalized-alpha"};
  bar b = quick_bar(0.2);
  corot_integrator_def reference = corot_integrator_defaults();
  reference.rtol = 1e-9;
  corot_integrator *integrator = start(&b, &reference);
  run_to(integrator, 0.4);
  assert_ok(corot_integrator_at(integrator, 0.4, b.u, NULL));
  for (int m = 0; m < 4; m++)
    for (corot_tangent tangent = COROT_TANGENT_HELD; tangent <= COROT_TANGENT_EXACT; tangent++) {
      double error[2];
      for (int k = 0; k < 2; k++) {
        bar c = quick_bar(0.2);
        corot_integrator_def def = fixed(second[m], 0.004 / (1 << k), COROT_SOLUTION_NEWTON);
        def.tangent = tangent;
        corot_integrator *other = start(&c, &def);
        run_to(other, 0.3999);
        assert_ok(corot_integrator_at(other, 0.4, c.u, NULL));
        error[k] = difference_of(b.n, b.u, c.u);
        corot_integrator_destroy(other), bar_destroy(&c);
      }
      assert_close(log2(error[0] / error[1]), 2, 0, 0.3);
      assert_below(error[1], 2e-3 * norm_max(b.n, b.u));
    }
  corot_integrator_destroy(integrator), bar_destroy(&b);
}

/* Where frames follow the body, or a basis is F, the one solve of a step is with a matrix of its
   own: the first iteration of Newton's method, which leaves an error of the order of the step's.
   With the matrix of the rest position the bar would fold up. */
static void one_solve_follows_exact_frames_nearly(void **state) {
  (void)state;
  bar_def of = example2;
  of.ramp = 0.2, of.traction[0] = 1000;
  for (int m = 0; m < NSTRAIN; m++) {
    if (!is_polar(m)) continue;
    double tip[2][2];
    of.strain = measures[m];
    for (int k = 0; k < 2; k++)
      for (int linear = 0; linear < 2; linear++) {
        bar b = bar_create(&of);
        corot_integrator_def def =
            fixed("bdf2", 0.04 / (1 << k), linear ? COROT_SOLUTION_LINEAR : COROT_SOLUTION_NEWTON);
        corot_integrator *integrator = start(&b, &def);
        run_to(integrator, 0.7999);
        assert_ok(corot_integrator_at(integrator, 0.8, b.u, NULL));
        tip[k][linear] = b.u[b.tip];
        corot_statistics s = corot_integrator_statistics(integrator);
        if (linear) assert_true(s.nfe == s.nst && s.nfactor == s.nst && s.nje == s.nst);
        corot_integrator_destroy(integrator), bar_destroy(&b);
      }
    assert_close(tip[0][1], tip[0][0], 2e-3, 0);
    assert_close(tip[1][1], tip[1][0], 5e-4, 0);
    assert_above(tip[1][0], 0.4); /* of 0.6 m */
  }
}

/* The linear rows of Hauth & Strasser 2004, Table 1: one evaluation a step, and a factorisation for
   each set of frames that is stepped with, the frames of the end not being. BDF has one more, where
   it changes from backward Euler to its own coefficients. */
static void counts_follow_from_the_method(void **state) {
  (void)state;
  static const struct {
    const char *method;
    double step, interval;
    long nst, nfactor;
  } row[] = {{"bdf3", 0.02, 0.02, 2000, 2000},
             {"bdf3", 0.02, 0.2, 2000, 201},
             {"bdf3", 0.06, 0.3, 667, 135},
             {"bdf2", 0.02, 0.2, 2000, 201},
             {"backward-euler", 0.02, 0.2, 2000, 200},
             {"backward-euler", 0.06, 0.3, 667, 134},
             {"midpoint", 0.02, 0.2, 2000, 200},
             {"newmark", 0.02, 0.2, 2000, 200}};
  for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
    bar_def of = example2;
    of.viscosity = COROT_COROTATED;        /* whose matrix depends on the frames alone */
    of.damping = 300, of.traction[0] = 50; /* BDF3 needs it, else it grows until a tet inverts */
    bar b = bar_create(&of);
    corot_integrator_def def = fixed(row[k].method, row[k].step, COROT_SOLUTION_LINEAR);
    corot_frame_policy policy = corot_frame_policy_defaults();
    policy.frames = COROT_FRAMES_HELD, policy.interval = row[k].interval;
    corot_integrator *integrator = start(&b, &def);
    corot_frame_clock *clock;
    assert_ok(corot_frame_clock_create(&policy, b.model, b.state, integrator, 0, b.u, b.v, &clock));
    follow(integrator, clock, 0, 40);
    corot_statistics s = corot_integrator_statistics(integrator);
    bool acceleration = strcmp(row[k].method, "newmark") == 0; /* the first one is evaluated */
    assert_int_equal(s.nst, row[k].nst);
    assert_int_equal(s.nfe, row[k].nst + acceleration);
    assert_int_equal(s.nfactor, row[k].nfactor);
    assert_int_equal(s.nsetups, row[k].nfactor);
    assert_int_equal(s.nsolve, row[k].nst);
    assert_true(s.nni == 0 && s.nfeQ == row[k].nst + 1 && s.nrestart == 0);
    corot_frame_clock_destroy(clock), corot_integrator_destroy(integrator), bar_destroy(&b);
  }
}

/* A load put on at once bends the bar so far in half a second that whole corrections overshoot:
   evaluations exceed iterations by the halvings, and the equation is solved all the same. */
static void newton_backtracks(void **state) {
  (void)state;
  bar_def of = example2;
  of.ramp = 0;
  double tip[2];
  for (int k = 0; k < 2; k++) {
    bar b = bar_create(&of);
    corot_integrator_def def = fixed("backward-euler", 0.5, COROT_SOLUTION_NEWTON);
    def.newton_tolerance = k ? 1e-12 : 1e-9;
    def.tangent = k ? COROT_TANGENT_EXACT : COROT_TANGENT_HELD;
    corot_integrator *integrator = start(&b, &def);
    corot_step step;
    for (int i = 0; i < 4; i++) {
      assert_ok(corot_integrator_step(integrator, 10, &step));
      assert_true(step.newton > 2);
    }
    corot_statistics s = corot_integrator_statistics(integrator);
    assert_true(s.nfe > s.nni);
    assert_ok(corot_integrator_at(integrator, 2, b.u, NULL));
    tip[k] = b.u[b.tip];
    corot_integrator_destroy(integrator), bar_destroy(&b);
  }
  assert_close(tip[0], tip[1], 1e-7, 0);
}

static void failures_name_the_step(void **state) {
  (void)state;
  bar b = quick_bar(0);
  corot_step step = {.t = -1};
  corot_integrator_def def = fixed("bdf2", 0.1, COROT_SOLUTION_NEWTON);
  def.newton_iterations = 1;
  corot_integrator *integrator = start(&b, &def);
  assert_fails(
      corot_integrator_step(integrator, 1, &step), COROT_EINTEGRATE,
      "bdf2: in the step from t = 0: Newton has not converged in 1 iterations (correction");
  assert_true(step.t == -1);
  assert_ok(corot_integrator_at(integrator, 0, b.u, NULL)); /* still readable */
  assert_true(norm_max(b.n, b.u) == 0);
  corot_integrator_destroy(integrator);

  def = fixed("newmark", 0.1, COROT_SOLUTION_LINEAR); /* thrown into itself: not to be evaluated */
  b.v[b.tip] = -1e3;
  integrator = start(&b, &def);
  corot_status status = COROT_OK;
  long steps = -1;
  for (; !status; steps++) status = corot_integrator_step(integrator, 1, &step);
  assert_int_equal(status, COROT_EINTEGRATE);
  assert_non_null(strstr(corot_error(), "newmark: in the step from t = "));
  assert_non_null(strstr(corot_error(), "0.1 s are too long: tet "));
  assert_int_equal(corot_integrator_statistics(integrator).nst, steps);
  corot_integrator_destroy(integrator), bar_destroy(&b);
}

/* Midpoint's end may be inverted where its middle is not: then the step is refused as a whole, and
   what was reached before is there. */
static void a_step_to_an_inverted_state_is_taken_back(void **state) {
  (void)state;
  static const char *const method[] = {"midpoint", "generalized-alpha"};
  for (int m = 0; m < 2; m++) {
    bar_def of = example2;
    of.ramp = 0, of.traction[0] = 12800;
    bar b = bar_create(&of);
    corot_integrator_def def = fixed(method[m], 0.02, COROT_SOLUTION_NEWTON);
    corot_integrator *integrator = start(&b, &def);
    corot_step step = {0};
    double *before = malloc(4 * b.n * sizeof *before), *after = before + 2 * b.n, t = 0, work[4];
    for (corot_status status = COROT_OK; !status;) {
      t = step.t;
      assert_ok(corot_integrator_at(integrator, t, before, before + b.n));
      assert_ok(corot_integrator_work(integrator, t, work, work + 1));
      status = corot_integrator_step(integrator, 10, &step);
      if (status) assert_int_equal(status, COROT_EINTEGRATE);
    }
    assert_above(t, 0.1);
    assert_non_null(strstr(corot_error(), "s are too long: tet 5 is inverted"));
    assert_ok(corot_integrator_at(integrator, t, after, after + b.n));
    assert_ok(corot_integrator_work(integrator, t, work + 2, work + 3));
    assert_memory_equal(after, before, 2 * b.n * sizeof *before);
    assert_true(work[0] == work[2] && work[1] == work[3]);
    free(before), corot_integrator_destroy(integrator), bar_destroy(&b);
  }
}

/* Between the points of the grid: the cubic through both ends' u and v, and its derivative. */
static void states_between_steps_are_interpolated(void **state) {
  (void)state;
  bar b = quick_bar(0.2);
  corot_integrator_def def = fixed("newmark", 0.03, COROT_SOLUTION_LINEAR);
  corot_integrator *integrator = start(&b, &def);
  double *y = malloc(8 * b.n * sizeof *y), *at[4], h = 1e-6;
  for (int k = 0; k < 4; k++) at[k] = y + 2 * k * b.n;
  assert_fails(corot_integrator_at(integrator, 0.01, at[0], NULL), COROT_EINVAL,
               "is not where the integrator (re)started");
  corot_step step = {0};
  while (step.t < 0.1) { /* an output at 0.1 s is in the step from 0.09 to 0.12 */
    assert_ok(corot_integrator_at(integrator, step.t, at[0], at[0] + b.n));
    assert_ok(corot_integrator_step(integrator, 0.1, &step));
  }
  assert_close(step.t, 0.12, 1e-15, 0);
  assert_fails(corot_integrator_at(integrator, 0.08, at[1], NULL), COROT_EINVAL,
               "is not in the last step, 0.0");
  assert_fails(corot_integrator_at(integrator, 0.121, at[1], NULL), COROT_EINVAL,
               "is not in the last step");
  assert_ok(corot_integrator_at(integrator, 0.09, at[1], at[1] + b.n));
  for (int i = 0; i < 2 * b.n; i++) assert_close(at[1][i], at[0][i], 1e-12, 1e-14);
  assert_ok(corot_integrator_at(integrator, 0.1 - h, at[0], NULL));
  assert_ok(corot_integrator_at(integrator, 0.1 + h, at[1], NULL));
  assert_ok(corot_integrator_at(integrator, 0.1, at[2], at[2] + b.n));
  double largest = norm_max(b.n, at[2] + b.n);
  for (int i = 0; i < b.n; i++)
    assert_close((at[1][i] - at[0][i]) / (2 * h), at[2][b.n + i], 0, 1e-8 * largest);

  assert_ok(corot_integrator_changed(integrator, COROT_HISTORY_RESTART)); /* it is forgotten */
  assert_fails(corot_integrator_at(integrator, 0.1, at[0], NULL), COROT_EINVAL, "(re)started");
  assert_ok(corot_integrator_at(integrator, step.t, at[0], NULL));
  free(y), corot_integrator_destroy(integrator), bar_destroy(&b);
}

/* kinetic + elastic + dissipated - external after the ramp, over the external work. */
static double imbalance(const char *method, double step) {
  bar b = quick_bar(0.2);
  corot_integrator_def def = fixed(method, step, COROT_SOLUTION_LINEAR);
  corot_state_use(b.state, COROT_FRAMES_HELD); /* those at rest: a linear body */
  corot_integrator *integrator = start(&b, &def);
  double dissipated, external;
  corot_energies e;
  run_to(integrator, 0.2999);
  assert_ok(corot_integrator_at(integrator, 0.3, b.u, b.v));
  assert_ok(corot_integrator_work(integrator, 0.3, &dissipated, &external));
  assert_ok(corot_energy(b.model, b.state, 0.3, b.u, b.v, &e));
  corot_integrator_destroy(integrator), bar_destroy(&b);
  return (e.kinetic + e.elastic + dissipated - external) / external;
}

/* The ledger is short of what numerical damping takes: the most with backward Euler, of first
   order; nothing with Newmark's, where the rest is the error of the work integrals, of second. */
static void the_ledger_shows_numerical_damping(void **state) {
  (void)state;
  double lossy[2], newmark[2], damped[2];
  for (int k = 0; k < 2; k++) {
    lossy[k] = imbalance("backward-euler", 0.005 / (1 << k));
    newmark[k] = imbalance("newmark", 0.005 / (1 << k));
    damped[k] = imbalance("bdf2", 0.005 / (1 << k));
  }
  assert_below(lossy[0], -2e-3);
  assert_close(log2(lossy[0] / lossy[1]), 1, 0, 0.3);
  assert_below(damped[0], 0);
  assert_below(fabs(damped[0]), 0.3 * fabs(lossy[0]));
  assert_below(fabs(newmark[1]), 1e-3);
  assert_close(log2(newmark[0] / newmark[1]), 2, 0, 0.5);
}

/* BDF reports the order it used: one until there is a past, and after a restart. */
static void order_is_that_of_the_formula_used(void **state) {
  (void)state;
  for (int m = 0; m < NMETHOD; m++) {
    bar b = quick_bar(0.2);
    corot_integrator_def def = fixed(methods[m].name, 0.01, COROT_SOLUTION_LINEAR);
    corot_integrator *integrator = start(&b, &def);
    bool bdf = m < 3;
    for (int i = 0; i < 10; i++) {
      corot_step step;
      if (i == 5) assert_ok(corot_integrator_changed(integrator, COROT_HISTORY_RESTART));
      if (i == 8) assert_ok(corot_integrator_changed(integrator, COROT_HISTORY_AUTO));
      assert_ok(corot_integrator_step(integrator, 10, &step));
      int past = i < 5 ? i + 1 : i - 4, order = methods[m].order;
      assert_int_equal(step.order, bdf && past < order ? 1 : order);
      assert_close(step.h, 0.01, 1e-12, 0);
      assert_true(step.error == 0 && step.newton == 0);
    }
    corot_statistics s = corot_integrator_statistics(integrator);
    assert_true(s.nrestart == 1 && s.qlast == methods[m].order && s.hlast > 0);
    corot_integrator_destroy(integrator), bar_destroy(&b);
  }
}

static void unusable_definitions_are_refused(void **state) {
  (void)state;
  bar b = quick_bar(0.2);
  corot_integrator *integrator = NULL;
  const struct {
    corot_integrator_def def;
    const char *words;
  } bad[] = {{{.method = "bdf2", .step = 0}, "bdf2 needs a step"},
             {{.method = "bdf2", .step = -0.1}, "step = -0.1 is not positive"},
             {{.method = "bdf4", .step = 0.1}, "no integrator 'bdf4'"},
             {{.method = "hht", .step = 0.1, .spectral_radius = 0.4}, "is not in 0.5 to 1"},
             {{.method = "generalized-alpha", .step = 0.1, .spectral_radius = 1.1}, "in 0 to 1"}};
  for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
    corot_integrator_def def = corot_integrator_defaults();
    def.method = bad[k].def.method, def.step = bad[k].def.step;
    if (bad[k].def.spectral_radius > 0) def.spectral_radius = bad[k].def.spectral_radius;
    assert_fails(corot_integrator_create(&def, b.model, b.state, 0, b.u, b.v, &integrator),
                 COROT_EINVAL, bad[k].words);
  }
  assert_null(integrator);
  bar_destroy(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(each_method_has_its_order),
      cmocka_unit_test(linear_and_newton_agree_on_held_frames),
      cmocka_unit_test(newton_follows_exact_frames),
      cmocka_unit_test(one_solve_follows_exact_frames_nearly),
      cmocka_unit_test(counts_follow_from_the_method),
      cmocka_unit_test(newton_backtracks),
      cmocka_unit_test(failures_name_the_step),
      cmocka_unit_test(a_step_to_an_inverted_state_is_taken_back),
      cmocka_unit_test(states_between_steps_are_interpolated),
      cmocka_unit_test(the_ledger_shows_numerical_damping),
      cmocka_unit_test(order_is_that_of_the_formula_used),
      cmocka_unit_test(unusable_definitions_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
