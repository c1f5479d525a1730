/* Co-Simulation: what an FMU answers at its communication points is, bit for bit, what `corot run`
   writes at these times. */
#include <stdio.h>

#include "check.h"
#include "importer.h"

/* What the fixtures' runs do at their k-th output time, if they have inputs. */
static double driven_push(int k) { return 0.5 + 0.25 * (k / 2 % 5); }
static double driven_flesh(int k) { return k < 6 ? 1.0 : 1.5; }

/* The outputs of all columns but t agree with the row of a run. */
static void check_row(const fmu *f, fmi3Instance instance, const fmu_table *run, int row) {
  for (int c = 1; c < run->ncolumn; c++) {
    double expected = run->value[row * run->ncolumn + c], got = fmu_get(f, instance, run->name[c]);
    if (memcmp(&got, &expected, sizeof got) != 0)
      fail_msg("row %d, %s: %.17g, and the run has %.17g", row, run->name[c], got, expected);
  }
}

static double time_of(const fmu_table *run, int row) { return run->value[row * run->ncolumn]; }

static void start(const fmu *f, fmi3Instance instance, double stop) {
  assert_int_equal(f->EnterInitializationMode(instance, false, 0, 0, stop > 0, stop), fmi3OK);
  assert_int_equal(f->ExitInitializationMode(instance), fmi3OK);
}

/* On from the row before. */
static void step_to_row(const fmu *f, fmi3Instance instance, const fmu_table *run, int row) {
  double t = time_of(run, row - 1), to = time_of(run, row);
  assert_true(fmu_step(f, instance, t, to - t) == to);
}

/* An instance that is ready to be compared with a run; all is released at the end. */
typedef struct comparison {
  fmu *f;
  fmu_log log;
  fmu_table run;
  fmi3Instance instance;
} comparison;

static void compare_begin(comparison *c, const char *name, const char *run) {
  char path[64];
  memset(c, 0, sizeof *c);
  snprintf(path, sizeof path, "%s.run/probes.csv", run);
  c->f = fmu_load(fmu_path(name));
  c->run = fmu_read_table(fmu_path(path));
  c->instance = fmu_simulation(c->f, &c->log);
  assert_true(c->run.nrow == 17);
}

static void compare_end(comparison *c) {
  c->f->FreeInstance(c->instance);
  assert_string_equal(c->log.message, "");
  fmu_free_table(&c->run);
  fmu_unload(c->f);
}

static void compare_undriven(const char *name, const char *run, void (*prepare)(comparison *)) {
  comparison c;
  compare_begin(&c, name, run);
  if (prepare) prepare(&c);
  start(c.f, c.instance, 0.125);
  check_row(c.f, c.instance, &c.run, 0);
  for (int k = 1; k < c.run.nrow; k++) {
    step_to_row(c.f, c.instance, &c.run, k);
    check_row(c.f, c.instance, &c.run, k);
  }
  compare_end(&c);
}

static void without_inputs_it_is_the_run(void **state) {
  (void)state;
  compare_undriven("free", "free", NULL);
  compare_undriven("bent", "bent", NULL);
}

static void set_shear_modulus(comparison *c) { fmu_set(c->f, c->instance, "material.mu", 2.0e4); }

static void with_a_parameter_it_is_the_run_with_that_key(void **state) {
  (void)state;
  compare_undriven("free", "stiff", set_shear_modulus);
}

static void after_a_reset_parameters_are_those_of_the_scenario(void **state) {
  (void)state;
  comparison c;
  compare_begin(&c, "free", "free");
  set_shear_modulus(&c);
  start(c.f, c.instance, 0.125);
  step_to_row(c.f, c.instance, &c.run, 1);
  assert_int_equal(c.f->Reset(c.instance), fmi3OK);
  assert_true(fmu_get(c.f, c.instance, "material.mu") == 1.0e4);
  start(c.f, c.instance, 0.125);
  for (int k = 1; k < 4; k++) {
    step_to_row(c.f, c.instance, &c.run, k);
    check_row(c.f, c.instance, &c.run, k);
  }
  compare_end(&c);
}

static void tolerance_is_that_of_the_integrator(void **state) {
  (void)state;
  comparison c;
  compare_begin(&c, "free", "coarse");
  assert_int_equal(c.f->EnterInitializationMode(c.instance, true, 1e-3, 0, true, 0.125), fmi3OK);
  assert_int_equal(c.f->ExitInitializationMode(c.instance), fmi3OK);
  for (int k = 1; k < c.run.nrow; k++) {
    step_to_row(c.f, c.instance, &c.run, k);
    check_row(c.f, c.instance, &c.run, k);
  }
  compare_end(&c);
}

/* Longer communication steps see the same motion, as the integrator does not stop there. */
static void communication_points_change_nothing_without_inputs(void **state) {
  (void)state;
  comparison c;
  compare_begin(&c, "free", "free");
  start(c.f, c.instance, 0.125);
  for (int k = 4; k < c.run.nrow; k += 4) {
    double t = time_of(&c.run, k - 4), to = time_of(&c.run, k);
    fmu_step(c.f, c.instance, t, to - t);
    check_row(c.f, c.instance, &c.run, k);
  }
  compare_end(&c);
}

/* What has not changed is not set: the run has two equal points there. */
static void set_driven(const comparison *c, fmi3Instance instance, int k) {
  if (k % 2 == 1) return;
  fmu_set(c->f, instance, "push", driven_push(k));
  fmu_set(c->f, instance, "flesh", driven_flesh(k));
}

static void compare_driven(const char *name) {
  comparison c;
  compare_begin(&c, name, name);
  set_driven(&c, c.instance, 0);
  start(c.f, c.instance, 0.125);
  check_row(c.f, c.instance, &c.run, 0);
  for (int k = 1; k < c.run.nrow; k++) {
    step_to_row(c.f, c.instance, &c.run, k);
    check_row(c.f, c.instance, &c.run, k);
    set_driven(&c, c.instance, k);
  }
  compare_end(&c);
}

static void with_inputs_it_is_the_run_whose_inputs_change_there(void **state) {
  (void)state;
  compare_driven("driven");
}

static void held_frames_are_found_anew_as_in_the_run(void **state) {
  (void)state;
  compare_driven("held");
}

static void constant_steps_are_those_of_the_run(void **state) {
  (void)state;
  compare_driven("stepped");
}

static void the_start_is_an_equilibrium_under_what_the_inputs_say(void **state) {
  (void)state;
  comparison c;
  compare_begin(&c, "strained", "strained");
  assert_int_equal(c.f->EnterInitializationMode(c.instance, false, 0, 0, false, 0), fmi3OK);
  check_row(c.f, c.instance, &c.run, 0);
  double before = fmu_get(c.f, c.instance, "corner.ux");
  fmu_set(c.f, c.instance, "push", 1.0); /* twice as much */
  assert_above(fmu_get(c.f, c.instance, "corner.ux"), 1.8 * before);
  fmu_set(c.f, c.instance, "push", 0.5);
  assert_int_equal(c.f->ExitInitializationMode(c.instance), fmi3OK);
  check_row(c.f, c.instance, &c.run, 0);
  compare_end(&c);
}

/* Outputs that depend on inputs directly follow them at once; the others wait for the next step. */
static void inputs_are_felt_when_they_are_set(void **state) {
  (void)state;
  comparison c;
  compare_begin(&c, "driven", "driven");
  start(c.f, c.instance, 0);
  fmu_step(c.f, c.instance, 0, 0.0078125);
  double a = fmu_get(c.f, c.instance, "push.ax"), u = fmu_get(c.f, c.instance, "corner.ux");
  double v = fmu_get(c.f, c.instance, "speed.vx");
  fmu_set(c.f, c.instance, "push", 3.0);
  assert_above(fabs(fmu_get(c.f, c.instance, "push.ax") - a), 1.0);
  assert_true(fmu_get(c.f, c.instance, "corner.ux") == u);
  assert_true(fmu_get(c.f, c.instance, "speed.vx") == v);
  fmu_set(c.f, c.instance, "push", 0.5);
  assert_true(fmu_get(c.f, c.instance, "push.ax") == a);
  compare_end(&c);
}

static void two_instances_do_not_know_of_each_other(void **state) {
  (void)state;
  comparison c;
  compare_begin(&c, "driven", "driven");
  fmi3Instance other = fmu_simulation(c.f, &c.log);
  set_driven(&c, c.instance, 0);
  fmu_set(c.f, other, "material.mu", 3.0e4);
  start(c.f, c.instance, 0.125);
  start(c.f, other, 0.125);
  for (int k = 1; k < 6; k++) {
    fmu_step(c.f, other, (k - 1) * 0.0078125, 0.0078125);
    step_to_row(c.f, c.instance, &c.run, k);
    check_row(c.f, c.instance, &c.run, k);
    assert_true(fmu_get(c.f, other, "corner.ux") != fmu_get(c.f, c.instance, "corner.ux"));
    set_driven(&c, c.instance, k);
  }
  c.f->FreeInstance(other);
  compare_end(&c);
}

/* --- Within a step --- */

typedef struct watch {
  const fmu *f;
  fmi3Instance instance;
  const fmu_table *history;
  int row;          /* of the history, that was seen last */
  double return_at; /* asks for an early return there; INFINITY: never */
  int calls, can_return;
  fmu_log log;
} watch;

static void look(fmi3InstanceEnvironment environment, fmi3Float64 time, fmi3Boolean set_requested,
                 fmi3Boolean get_allowed, fmi3Boolean step_finished, fmi3Boolean can_return_early,
                 fmi3Boolean *early_return_requested, fmi3Float64 *early_return_time) {
  watch *w = environment;
  assert_true(!set_requested && get_allowed && step_finished);
  w->calls++;
  w->can_return += can_return_early;
  if (w->history) {
    w->row++;
    assert_true(time == time_of(w->history, w->row));
    for (int c = 1; c < 4; c++)
      assert_true(fmu_get(w->f, w->instance, w->history->name[c]) ==
                  w->history->value[w->row * w->history->ncolumn + c]);
  }
  fmi3ValueReference reference = fmu_reference(w->f, "material.mu");
  double value = 1;
  int count = w->log.count;
  assert_int_equal(w->f->SetFloat64(w->instance, &reference, 1, &value, 1), fmi3Error);
  assert_int_equal(w->log.count, count + 1);
  *early_return_requested = time >= w->return_at || isfinite(w->return_at);
  *early_return_time = fmax(time, w->return_at);
}

static void take_watch_message(fmi3InstanceEnvironment environment, fmi3Status status,
                               fmi3String category, fmi3String message) {
  fmu_take_message(&((watch *)environment)->log, status, category, message);
}

static fmi3Instance watched(watch *w, bool early) {
  w->instance = w->f->InstantiateCoSimulation("watched", w->f->token, w->f->resources, false, false,
                                              false, early, NULL, 0, w, take_watch_message, look);
  assert_non_null(w->instance);
  start(w->f, w->instance, 0.125);
  return w->instance;
}

static void the_ends_of_steps_are_shown_as_the_history_has_them(void **state) {
  (void)state;
  fmu *f = fmu_load(fmu_path("free"));
  fmu_table history = fmu_read_table(fmu_path("free.run/history.csv"));
  watch w = {.f = f, .history = &history, .return_at = INFINITY};
  fmi3Instance instance = watched(&w, false);
  for (int k = 0; k < 16; k++) fmu_step(f, instance, k * 0.0078125, 0.0078125);
  assert_int_equal(w.row, history.nrow - 1);
  assert_int_equal(w.can_return, 0);
  f->FreeInstance(instance);
  fmu_free_table(&history);
  fmu_unload(f);
}

static void a_step_may_be_left_early(void **state) {
  static const char *const name[] = {"free", "driven", "stepped"};
  (void)state;
  for (int i = 0; i < 3; i++) {
    fmu *f = fmu_load(fmu_path(name[i]));
    watch w = {.f = f, .return_at = 0.02};
    fmi3Instance instance = watched(&w, true);
    fmi3Boolean event, terminate, early = false;
    double last = 0, t = 0.02, next = 0.125;
    if (i == 2) t = 11 * 0.001953125; /* the first end of a constant step after 0.02 */
    assert_int_equal(f->DoStep(instance, 0, next, true, &event, &terminate, &early, &last), fmi3OK);
    assert_true(early && w.can_return == w.calls);
    assert_true(last == t);
    assert_true(fmu_get(f, instance, "time") == t);
    w.return_at = INFINITY;
    assert_true(fmu_step(f, instance, last, next - last) == next);
    f->FreeInstance(instance);
    fmu_unload(f);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(without_inputs_it_is_the_run),
      cmocka_unit_test(with_a_parameter_it_is_the_run_with_that_key),
      cmocka_unit_test(after_a_reset_parameters_are_those_of_the_scenario),
      cmocka_unit_test(tolerance_is_that_of_the_integrator),
      cmocka_unit_test(communication_points_change_nothing_without_inputs),
      cmocka_unit_test(with_inputs_it_is_the_run_whose_inputs_change_there),
      cmocka_unit_test(held_frames_are_found_anew_as_in_the_run),
      cmocka_unit_test(constant_steps_are_those_of_the_run),
      cmocka_unit_test(the_start_is_an_equilibrium_under_what_the_inputs_say),
      cmocka_unit_test(inputs_are_felt_when_they_are_set),
      cmocka_unit_test(two_instances_do_not_know_of_each_other),
      cmocka_unit_test(the_ends_of_steps_are_shown_as_the_history_has_them),
      cmocka_unit_test(a_step_may_be_left_early),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
