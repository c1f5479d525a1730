/* Frames held for an interval, as in Hauth & Strasser 2004, and what an update does to the
   integration. */
#include "bar.h"

static bar quick_bar(void) {
  bar_def def = example2;
  def.ramp = 0.2, def.traction[0] = 1000;
  return bar_create(&def);
}

/* What a run from rest to t_end leaves behind. */
typedef struct trace {
  double *u; /* [n] at t_end */
  int n;
  corot_statistics s;
  long nupdate;
} trace;

/* interval 0: exact frames. */
static trace run(double rtol, double interval, corot_history history, double t_end) {
  bar b = quick_bar();
  corot_integrator_def def = corot_integrator_defaults();
  def.rtol = rtol;
  corot_state_use(b.state, interval > 0 ? COROT_FRAMES_HELD : COROT_FRAMES_EXACT);
  corot_integrator *integrator = start(&b, &def);
  trace r = {.n = b.n};
  for (long k = 1; interval > 0 && k * interval < t_end * (1 - 1e-9); k++) {
    run_to(integrator, k * interval);
    assert_ok(corot_integrator_at(integrator, k * interval, b.u, NULL));
    assert_ok(corot_frames_update(b.model, b.state, k * interval, b.u, NULL));
    assert_ok(corot_integrator_changed(integrator, history));
    r.nupdate++;
  }
  run_to(integrator, t_end);
  r.u = malloc(b.n * sizeof *r.u);
  assert_ok(corot_integrator_at(integrator, t_end, r.u, NULL));
  r.s = corot_integrator_statistics(integrator);
  corot_integrator_destroy(integrator);
  bar_destroy(&b);
  return r;
}

/* Of first order in the interval, whatever is done with the history; here 0.04 % to 0.3 % of the
   displacement, with integration errors a hundred times smaller. */
static void the_error_is_proportional_to_the_interval(void **state) {
  (void)state;
  const double interval[] = {2.5e-3, 5e-3, 10e-3, 20e-3};
  const corot_history history[] = {COROT_HISTORY_KEEP, COROT_HISTORY_RESTART, COROT_HISTORY_AUTO};
  trace exact = run(1e-9, 0, COROT_HISTORY_KEEP, 0.4);
  for (int h = 0; h < 3; h++) {
    double error[4];
    for (int k = 0; k < 4; k++) {
      trace held = run(1e-7, interval[k], history[h], 0.4);
      error[k] = difference_of(exact.n, held.u, exact.u) / norm_max(exact.n, exact.u);
      free(held.u);
    }
    for (int k = 1; k < 4; k++) {
      double slope = log2(error[k] / error[k - 1]);
      assert_true(slope > 0.8 && slope < 1.3);
    }
  }
  free(exact.u);
}

static void restarts_are_made_as_told(void **state) {
  (void)state;
  trace keep = run(1e-3, 10e-3, COROT_HISTORY_KEEP, 0.4);
  trace restart = run(1e-3, 10e-3, COROT_HISTORY_RESTART, 0.4);
  trace choose = run(1e-3, 10e-3, COROT_HISTORY_AUTO, 0.4); /* 24 of 39 */
  assert_int_equal(keep.nupdate, 39);
  assert_int_equal(keep.s.nrestart, 0);
  assert_int_equal(restart.s.nrestart, restart.nupdate);
  assert_true(choose.s.nrestart > 5 && choose.s.nrestart < 35);
  free(keep.u), free(restart.u), free(choose.u);
}

/* The same frames again: no jump, no restart. One evaluation tells. */
static void a_jump_that_is_not_felt_keeps_the_history(void **state) {
  (void)state;
  bar b = quick_bar();
  corot_integrator_def def = corot_integrator_defaults();
  corot_state_use(b.state, COROT_FRAMES_HELD);
  corot_integrator *integrator = start(&b, &def);
  assert_ok(corot_integrator_changed(integrator, COROT_HISTORY_RESTART)); /* there is none yet */
  assert_int_equal(corot_integrator_statistics(integrator).nrestart, 0);
  run_to(integrator, 0.2);
  corot_statistics before = corot_integrator_statistics(integrator);
  assert_ok(corot_integrator_changed(integrator, COROT_HISTORY_AUTO));
  corot_statistics after = corot_integrator_statistics(integrator);
  assert_int_equal(after.nrestart, 0);
  assert_int_equal(after.nfe, before.nfe + 1);

  /* whereas this one is felt: frames of 0.2 s ago */
  assert_ok(corot_integrator_at(integrator, 0.2, b.u, NULL));
  assert_ok(corot_frames_update(b.model, b.state, 0.2, b.u, NULL));
  assert_ok(corot_integrator_changed(integrator, COROT_HISTORY_AUTO));
  after = corot_integrator_statistics(integrator);
  assert_int_equal(after.nrestart, 1);
  assert_ok(corot_integrator_changed(integrator, COROT_HISTORY_RESTART)); /* nothing more to drop */
  assert_int_equal(corot_integrator_statistics(integrator).nrestart, 1);

  corot_step step;
  assert_ok(corot_integrator_step(integrator, 40, &step));
  assert_int_equal(step.order, 1);
  corot_integrator_destroy(integrator);
  bar_destroy(&b);
}

/* K and D belong to the frames: the first set-up after an update makes them anew. */
static void an_update_outdates_the_matrices(void **state) {
  (void)state;
  bar b = quick_bar();
  corot_integrator_def def = corot_integrator_defaults();
  def.reassembly = 1000, def.refactorisation = 1;
  corot_state_use(b.state, COROT_FRAMES_HELD);
  corot_integrator *integrator = start(&b, &def);
  run_to(integrator, 0.1);
  corot_step step;
  assert_ok(corot_integrator_step(integrator, 40, &step));
  long nje = corot_integrator_statistics(integrator).nje;
  assert_ok(corot_integrator_step(integrator, 40, &step));
  assert_int_equal(corot_integrator_statistics(integrator).nje, nje);
  assert_ok(corot_integrator_changed(integrator, COROT_HISTORY_KEEP));
  assert_ok(corot_integrator_step(integrator, 40, &step));
  assert_int_equal(corot_integrator_statistics(integrator).nje, nje + 1);
  corot_integrator_destroy(integrator);
  bar_destroy(&b);
}

static void statistics_go_on_over_restarts(void **state) {
  (void)state;
  bar b = quick_bar();
  corot_integrator_def def = corot_integrator_defaults();
  corot_integrator *integrator = start(&b, &def);
  long steps = 0, newton = 0;
  for (int k = 1; k <= 10; k++) {
    corot_step step = {0};
    while (step.t < 0.03 * k) {
      assert_ok(corot_integrator_step(integrator, 0.03 * k, &step));
      steps++;
      newton += step.newton;
    }
    corot_statistics before = corot_integrator_statistics(integrator);
    assert_ok(corot_integrator_changed(integrator, COROT_HISTORY_RESTART));
    corot_statistics s = corot_integrator_statistics(integrator);
    assert_int_equal(s.nrestart, k);
    assert_true(s.nst == steps && s.nni == newton && s.nfe == before.nfe);
    assert_true(s.nsetups == before.nsetups && s.nfactor == s.nsetups && s.netf == before.netf);
    assert_true(s.nfeQ == before.nfeQ && s.nje == before.nje && s.nsolve == before.nsolve);
    assert_true(s.hlast == step.h && s.qlast == step.order);
  }
  corot_integrator_destroy(integrator);
  bar_destroy(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_error_is_proportional_to_the_interval),
      cmocka_unit_test(restarts_are_made_as_told),
      cmocka_unit_test(a_jump_that_is_not_felt_keeps_the_history),
      cmocka_unit_test(an_update_outdates_the_matrices),
      cmocka_unit_test(statistics_go_on_over_restarts),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
