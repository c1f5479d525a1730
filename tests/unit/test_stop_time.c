/* Stop times: each is reached exactly and once, whatever happens there; and what can be asked of
   the last step. */
#include <corot/solve.h>
#include <cvodes/cvodes.h>
#include <nvector/nvector_serial.h>

#include "bar.h"
#include "solve/sundials/sun_compat.h"
#include "solver.h"

static bar quick_bar(void) {
  bar_def def = example2;
  def.ramp = 0.5;
  return bar_create(&def);
}

/* Bare CVODE on the pencil. */
typedef struct bare {
  bar bar;
  SUNContext ctx;
  N_Vector y;
  corot_sun_data data;
  corot_pencil *pencil;
  SUNMatrix A;
  SUNLinearSolver LS;
  void *cvode;
} bare;

static void bare_start(bare *b) {
  b->bar = quick_bar();
  assert_int_equal(sun_context_create(&b->ctx), 0);
  b->y = N_VMake_Serial(2 * b->bar.n, b->bar.u, b->ctx);
  b->data = (corot_sun_data){b->bar.model, b->bar.state, NULL};
  assert_ok(corot_mass_solver_create(b->bar.model, &b->data.mass));
  assert_ok(corot_pencil_create(b->bar.model, b->bar.state, SOLVER("klu"), &b->pencil));
  b->A = corot_sun_matrix(b->pencil, b->ctx);
  b->LS = corot_sun_linsol(b->pencil, b->ctx);
  b->cvode = CVodeCreate(CV_BDF, b->ctx);
  int bad = CVodeInit(b->cvode, corot_sun_rhs, 0, b->y) || CVodeSetUserData(b->cvode, &b->data) ||
            CVodeSStolerances(b->cvode, 1e-4, 1e-6) || CVodeSetMaxOrd(b->cvode, 2) ||
            CVodeSetLinearSolver(b->cvode, b->LS, b->A) ||
            CVodeSetLinSysFn(b->cvode, corot_sun_linsys);
  assert_int_equal(bad, 0);
}

static void bare_end(bare *b) {
  CVodeFree(&b->cvode);
  SUNLinSolFree(b->LS);
  SUNMatDestroy(b->A);
  corot_pencil_destroy(b->pencil);
  N_VDestroy(b->y);
  SUNContext_Free(&b->ctx);
  corot_mass_solver_destroy(b->data.mass);
  bar_destroy(&b->bar);
}

/* To a stop at t = 0.1 with the given tout, and then one call towards 0.2: its flag, and the time
   it reached. */
static int go_on_after_a_stop(double tout, int mode, double *t) {
  bare b;
  bare_start(&b);
  assert_int_equal(CVodeSetStopTime(b.cvode, 0.1), 0);
  do assert_true(CVode(b.cvode, tout, b.y, t, mode) >= 0);
  while (*t < 0.1);
  int flag = CVode(b.cvode, 0.2, b.y, t, mode);
  bare_end(&b);
  return flag;
}

/* The defect that integrate_cvode.c works around, in the SUNDIALS of Debian 12: if tout was the
   stop time, the stop is not disarmed when reached, and the next call does nothing but report it
   again. */
static void cvode_stands_still_where_tout_was_the_stop_time(void **state) {
  (void)state;
  if (strcmp(corot_sundials_version(), "6.4.1") != 0) skip();
  double t;
  assert_int_equal(go_on_after_a_stop(0.1, CV_NORMAL, &t), CV_TSTOP_RETURN);
  assert_true(t == 0.1);
  assert_int_equal(go_on_after_a_stop(0.15, CV_NORMAL, &t), CV_SUCCESS);
  assert_true(t == 0.2);
  for (int k = 0; k < 2; k++) {
    assert_int_equal(go_on_after_a_stop(0.1 + 0.05 * k, CV_ONE_STEP, &t), CV_SUCCESS);
    assert_true(t > 0.1);
  }
}

/* 1000 stops, in turn without consequence, after a change that keeps the history, and with a
   restart. */
static void every_stop_is_reached_exactly_and_once(void **state) {
  (void)state;
  enum { STOPS = 1000 };
  bar b = quick_bar();
  corot_integrator_def def = corot_integrator_defaults();
  def.rtol = 1e-3;
  corot_integrator *integrator = start(&b, &def);
  corot_step step = {0};
  long steps = 0, restarts = 0;
  for (int k = 1; k <= STOPS; k++) {
    double stop = 1e-3 * k;
    int here = 0;
    while (step.t < stop) {
      double before = step.t;
      assert_ok(corot_integrator_step(integrator, stop, &step));
      assert_true(step.t > before && step.t <= stop);
      assert_true(step.h == step.t - before);
      assert_true(++here <= 50);
    }
    assert_true(step.t == stop);
    steps += here;
    restarts += k % 3 == 2;
    if (k % 3 == 1) assert_ok(corot_integrator_changed(integrator, COROT_HISTORY_KEEP));
    if (k % 3 == 2) assert_ok(corot_integrator_changed(integrator, COROT_HISTORY_RESTART));
  }
  corot_statistics s = corot_integrator_statistics(integrator);
  assert_int_equal(s.nst, steps);
  assert_int_equal(s.nrestart, restarts);
  corot_integrator_destroy(integrator);
  bar_destroy(&b);
}

/* A restart at each of 1000 stops. */
static void a_restart_at_every_stop_does_not_stall(void **state) {
  (void)state;
  enum { STOPS = 1000 };
  bar b = quick_bar();
  corot_integrator_def def = corot_integrator_defaults();
  def.rtol = 1e-2;
  corot_integrator *integrator = start(&b, &def);
  corot_step step = {0};
  for (int k = 1; k <= STOPS; k++) {
    for (int here = 0; step.t < 1e-3 * k; here++) {
      assert_true(here < 50);
      double before = step.t;
      assert_ok(corot_integrator_step(integrator, 1e-3 * k, &step));
      assert_true(step.t > before);
    }
    assert_true(step.t == 1e-3 * k);
    assert_ok(corot_integrator_changed(integrator, COROT_HISTORY_RESTART));
  }
  assert_int_equal(corot_integrator_statistics(integrator).nrestart, STOPS);
  corot_integrator_destroy(integrator);
  bar_destroy(&b);
}

static void a_stop_that_is_not_ahead_is_refused(void **state) {
  (void)state;
  bar b = quick_bar();
  corot_integrator_def def = corot_integrator_defaults();
  corot_integrator *integrator = start(&b, &def);
  corot_step step = {.t = -7};
  const double stops[] = {0, -1, NAN, INFINITY};
  for (int k = 0; k < 4; k++)
    assert_fails(corot_integrator_step(integrator, stops[k], &step), COROT_EINVAL,
                 "cannot stop at");
  assert_true(step.t == -7);
  assert_ok(corot_integrator_step(integrator, 1, &step));
  assert_fails(corot_integrator_step(integrator, step.t, &step), COROT_EINVAL, "cannot stop at");
  assert_ok(corot_integrator_step(integrator, 1, &step));
  corot_integrator_destroy(integrator);
  bar_destroy(&b);
}

/* The stop comes nearer than the step under way, or recedes. */
static void a_stop_can_be_moved(void **state) {
  (void)state;
  bar b = quick_bar();
  corot_integrator_def def = corot_integrator_defaults();
  corot_integrator *integrator = start(&b, &def);
  corot_step step = {0};
  for (int k = 0; k < 30; k++) assert_ok(corot_integrator_step(integrator, 40, &step));
  double near = step.t + step.h / 3;
  assert_ok(corot_integrator_step(integrator, near, &step));
  assert_true(step.t == near);
  assert_ok(corot_integrator_step(integrator, near + 1e-9, &step));
  assert_true(step.t == near + 1e-9);
  assert_ok(corot_integrator_step(integrator, 40, &step));
  assert_true(step.t < 40);
  corot_integrator_destroy(integrator);
  bar_destroy(&b);
}

/* Two clocks that differ by rounding: no step is taken, and none is counted. */
static void a_stop_within_rounding_is_reached_without_a_step(void **state) {
  (void)state;
  bar b = quick_bar();
  corot_integrator_def def = corot_integrator_defaults();
  corot_integrator *integrator = start(&b, &def);
  corot_step step = {0};
  double *u = malloc(2 * b.n * sizeof *u), *u_after = u + b.n;
  run_to(integrator, 0.3);
  for (int restart = 0; restart < 2; restart++) {
    double t = nextafter(0.3, 1);
    if (restart) {
      run_to(integrator, 0.6);
      assert_ok(corot_integrator_changed(integrator, COROT_HISTORY_RESTART));
      t = nextafter(0.6, 1);
    }
    long nst = corot_integrator_statistics(integrator).nst;
    assert_ok(corot_integrator_at(integrator, restart ? 0.6 : 0.3, u, NULL));
    assert_ok(corot_integrator_step(integrator, t, &step));
    assert_true(step.t == t && step.h > 0);
    assert_int_equal(corot_integrator_statistics(integrator).nst, nst);
    assert_ok(corot_integrator_at(integrator, t, u_after, NULL));
    assert_int_equal(memcmp(u, u_after, b.n * sizeof *u), 0);
    assert_ok(corot_integrator_step(integrator, 1, &step));
    assert_true(step.h > 1e-12 && step.newton > 0);
  }
  free(u);
  corot_integrator_destroy(integrator);
  bar_destroy(&b);
}

/* Against steps so short that their ends are the truth. */
static void the_interpolant_follows_the_solution(void **state) {
  (void)state;
  bar b = quick_bar();
  corot_integrator_def def = corot_integrator_defaults();
  def.rtol = 1e-5;
  corot_integrator *integrator = start(&b, &def);
  def.rtol = 1e-8;
  bar exact = quick_bar();
  corot_integrator *fine = start(&exact, &def);
  corot_step step = {0};
  for (int k = 0; k < 60; k++) assert_ok(corot_integrator_step(integrator, 40, &step));
  for (int j = 0; j <= 4; j++) {
    double t = j == 4 ? step.t : step.t - step.h + j * (step.h / 4);
    run_to(fine, t);
    assert_ok(corot_integrator_at(fine, t, exact.u, exact.v));
    assert_ok(corot_integrator_at(integrator, t, b.u, b.v));
    assert_below(difference_of(b.n, b.u, exact.u), 2e-3 * norm_max(b.n, exact.u));
    assert_below(difference_of(b.n, b.v, exact.v), 2e-2 * norm_max(b.n, exact.v));
    double dissipated, external, dissipated_fine, external_fine;
    assert_ok(corot_integrator_work(integrator, t, &dissipated, &external));
    assert_ok(corot_integrator_work(fine, t, &dissipated_fine, &external_fine));
    assert_close(dissipated, dissipated_fine, 2e-2, 0);
    assert_close(external, external_fine, 1e-2, 0);
  }
  /* one at a time, and the same again */
  double *u = malloc(b.n * sizeof *u), middle = step.t - step.h / 2;
  assert_ok(corot_integrator_at(integrator, middle, b.u, b.v));
  assert_ok(corot_integrator_at(integrator, step.t, u, NULL));
  assert_ok(corot_integrator_at(integrator, middle, u, NULL));
  assert_int_equal(memcmp(u, b.u, b.n * sizeof *u), 0);
  assert_ok(corot_integrator_at(integrator, middle, NULL, u));
  assert_int_equal(memcmp(u, b.v, b.n * sizeof *u), 0);
  free(u);
  corot_integrator_destroy(integrator);
  corot_integrator_destroy(fine);
  bar_destroy(&b);
  bar_destroy(&exact);
}

static void refuse_both(corot_integrator *integrator, double t, const char *words) {
  double dissipated = -7, external = -7;
  assert_fails(corot_integrator_at(integrator, t, NULL, NULL), COROT_EINVAL, words);
  assert_fails(corot_integrator_work(integrator, t, &dissipated, &external), COROT_EINVAL, words);
  assert_true(dissipated == -7 && external == -7);
}

static void only_the_last_step_can_be_asked_for(void **state) {
  (void)state;
  bar b = quick_bar();
  corot_integrator_def def = corot_integrator_defaults();
  corot_integrator *integrator = start(&b, &def);
  double dissipated, external;
  b.u[0] = 1;
  assert_ok(corot_integrator_at(integrator, 0, b.u, b.v));
  assert_true(b.u[0] == 0);
  assert_ok(corot_integrator_work(integrator, 0, &dissipated, &external));
  assert_true(dissipated == 0 && external == 0);
  refuse_both(integrator, 1e-9, "(re)started");

  corot_step step = {0};
  for (int k = 0; k < 20; k++) assert_ok(corot_integrator_step(integrator, 40, &step));
  const double outside[] = {step.t + 1e-3 * step.h, step.t - 1.001 * step.h, 0, NAN, -INFINITY};
  for (int k = 0; k < 5; k++) refuse_both(integrator, outside[k], "not in the last step");
  assert_ok(corot_integrator_at(integrator, step.t - step.h, b.u, b.v));

  /* a restart keeps the end of the step and its work, but not its inside */
  double *u = malloc(b.n * sizeof *u), dissipated_after, external_after;
  assert_ok(corot_integrator_at(integrator, step.t, b.u, NULL));
  assert_ok(corot_integrator_work(integrator, step.t, &dissipated, &external));
  assert_true(external > 0);
  assert_ok(corot_integrator_changed(integrator, COROT_HISTORY_RESTART));
  assert_ok(corot_integrator_at(integrator, step.t, u, NULL));
  assert_int_equal(memcmp(u, b.u, b.n * sizeof *u), 0);
  assert_ok(corot_integrator_work(integrator, step.t, &dissipated_after, &external_after));
  assert_true(dissipated_after == dissipated && external_after == external);
  refuse_both(integrator, step.t - step.h / 2, "(re)started");
  assert_ok(corot_integrator_step(integrator, 40, &step));
  assert_ok(corot_integrator_work(integrator, step.t, &dissipated_after, &external_after));
  assert_true(external_after > external);
  free(u);
  corot_integrator_destroy(integrator);
  bar_destroy(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(cvode_stands_still_where_tout_was_the_stop_time),
      cmocka_unit_test(every_stop_is_reached_exactly_and_once),
      cmocka_unit_test(a_restart_at_every_stop_does_not_stall),
      cmocka_unit_test(a_stop_that_is_not_ahead_is_refused),
      cmocka_unit_test(a_stop_can_be_moved),
      cmocka_unit_test(a_stop_within_rounding_is_reached_without_a_step),
      cmocka_unit_test(the_interpolant_follows_the_solution),
      cmocka_unit_test(only_the_last_step_can_be_asked_for),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
