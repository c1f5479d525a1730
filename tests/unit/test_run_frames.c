/* Whole runs: frames and motions, constant steps, other measures beside the run's own. */
#include "whole_run.h"

static double updates_by(json_t *result, const char *reason) {
  return number(json_object_get(result, "frames"), "updates_by", reason);
}

/* --- Frames --- */

static void held_frames_are_updated_on_time(void **state) {
  (void)state;
  char *dir = temporary_folder();
  run_ok(dir, SET("frames={policy: hold, interval: 0.05, history: restart}"));
  csv steps = read_csv(in(dir, "out/steps.csv")), energy = read_csv(in(dir, "out/energy.csv"));
  json_t *result = result_of(dir);
  int updates = 0;
  double injected = 0, angle_max = 0, mean = 0;
  for (int i = 0; i < steps.nrow; i++) {
    if (!strstr(steps.event[i], "frames")) {
      assert_string_equal(steps.event[i], "");
      assert_true(isnan(steps.x[i][6]) && isnan(steps.x[i][8]));
      continue;
    }
    updates++;
    /* 6 * 0.05 is a rounding above the kink at 0.3: one event, at the earlier of the two. */
    assert_close(steps.x[i][0], updates == 6 ? 0.3 : updates * 0.05, 0, 0);
    assert_string_equal(steps.event[i], updates == 6 ? "kink+frames+restart" : "frames+restart");
    assert_string_equal(steps.reason[i], "interval");
    assert_true(steps.x[i][6] > steps.x[i][7] && steps.x[i][7] > 0);
    mean += steps.x[i][7] / 19;
    angle_max = fmax(angle_max, steps.x[i][6]);
    injected += steps.x[i][8];
  }
  assert_int_equal(updates, 19); /* the one at the end would have no effect */
  assert_close(number(result, "statistics", "nframes"), 19, 0, 0);
  assert_close(number(result, "statistics", "nrestart"), 19, 0, 0);
  assert_close(number(result, "frames", "angle_max"), angle_max, 0, 0);
  assert_close(number(result, "frames", "angle_mean"), mean, 1e-14, 0);
  assert_close(updates_by(result, "interval"), 19, 0, 0);
  assert_close(number(result, "frames", "energy"), injected, 1e-14, 0);
  assert_close(energy.x[energy.nrow - 1][6], injected, 1e-14, 0);
  free_csv(steps), free_csv(energy);
  json_decref(result);
  remove_folder(dir);
}

static void frames_are_updated_at_every_step(void **state) {
  (void)state;
  char *dir = temporary_folder();
  run_ok(dir, SET("frames.policy=step"));
  csv steps = read_csv(in(dir, "out/steps.csv"));
  json_t *result = result_of(dir);
  for (int i = 0; i < steps.nrow - 1; i++) assert_string_equal(steps.reason[i], "step");
  assert_string_equal(steps.event[steps.nrow - 1], ""); /* the end */
  assert_close(updates_by(result, "step"), steps.nrow - 1, 0, 0);
  assert_string_equal(word(result, "frames", "policy"), "step");
  free_csv(steps);
  json_decref(result);
  remove_folder(dir);
}

static void frames_are_updated_at_an_angle(void **state) {
  (void)state;
  char *dir = temporary_folder();
  run_ok(dir, SET("frames={policy: hold, max_angle: 0.01, interval: 0.45}"));
  csv steps = read_csv(in(dir, "out/steps.csv"));
  json_t *result = result_of(dir);
  int by_angle = 0, by_interval = 0;
  for (int i = 0; i < steps.nrow; i++) {
    if (strcmp(steps.reason[i], "angle") == 0) {
      assert_above(steps.x[i][6], 0.01);
      assert_below(steps.x[i][6], 0.02); /* a step does not turn a frame by much */
      by_angle++;
    } else if (strcmp(steps.reason[i], "interval") == 0) {
      by_interval++;
    }
  }
  assert_true(by_angle > 3);
  assert_int_equal(by_interval, 2);
  assert_close(updates_by(result, "angle"), by_angle, 0, 0);
  assert_close(number(result, "frames", "updates"), by_angle + by_interval, 0, 0);
  assert_close(number(result, "frames", "max_angle"), 0.01, 0, 0);
  free_csv(steps);
  json_decref(result);
  remove_folder(dir);
}

/* A support that turns fast takes extrapolated frames to their cap long before the interval. */
static void an_extrapolation_ends_at_its_cap(void **state) {
  (void)state;
  char *dir = temporary_folder();
  run_ok(dir, SET("boundary=[{group: base, rotate: {axis: [0, 0, 1], rate: 5}}]", "loads=[]",
                  "frames={policy: extrapolate, interval: 0.5}", "time.end=0.6"));
  csv steps = read_csv(in(dir, "out/steps.csv"));
  json_t *result = result_of(dir);
  assert_above(updates_by(result, "cap"), 0.6 * 5 / COROT_EXTRAPOLATION_CAP - 1);
  assert_close(updates_by(result, "interval"), 1, 0, 0);
  int caps = 0;
  for (int i = 0; i < steps.nrow; i++) caps += strcmp(steps.reason[i], "cap") == 0;
  assert_close(updates_by(result, "cap"), caps, 0, 0);
  free_csv(steps);
  json_decref(result);
  remove_folder(dir);
}

/* The largest difference of the corner's deflection from that with exact frames. */
static double frame_error(const char *dir, const char *frames) {
  double exact[11], other[11], error = 0;
  run_ok(dir, SET("integrator.rtol=1.0e-6"));
  assert_int_equal(column(dir, "probes.csv", 1, 11, exact), 11);
  run_ok(dir, SET("integrator.rtol=1.0e-6", frames));
  assert_int_equal(column(dir, "probes.csv", 1, 11, other), 11);
  for (int i = 0; i < 11; i++) error = fmax(error, fabs(other[i] - exact[i]));
  return error;
}

static void extrapolated_frames_are_better_than_held_ones(void **state) {
  (void)state;
  char *dir = temporary_folder();
  double held = frame_error(dir, "frames={policy: hold, interval: 0.02}");
  double turned = frame_error(dir, "frames={policy: extrapolate, interval: 0.02}");
  assert_above(held, 1e-5);
  assert_below(turned, 0.1 * held);
  remove_folder(dir);
}

/* --- Motions and loads --- */

#define TURN                                                                                   \
  "boundary=[{group: base, rotate: {axis: [0, 0, 2], center: [0.05, 0.05, 0], rate: 2, from: " \
  "0.15, to: 0.65}}]"
#define AT_REST "loads=[]"
#define OF_BASE "probes={foot: {point: [0.1, 0.1, 0]}, corner: {point: [0.1, 0.1, 0.4]}}"

/* The foot at (0.05, 0.05) from the axis has turned by `angle`. */
static void assert_foot(const double row[], double t) {
  double angle = 2 * (fmin(fmax(t, 0.15), 0.65) - 0.15);
  assert_close(row[1], 0.05 * (cos(angle) - sin(angle) - 1), 0, 1e-15);
  assert_close(row[2], 0.05 * (sin(angle) + cos(angle) - 1), 0, 1e-15);
  assert_close(row[3], 0, 0, 0);
}

static void a_support_keeps_to_its_path(void **state) {
  (void)state;
  char *dir = temporary_folder();
  for (int constant = 0; constant < 2; constant++) {
    run_ok(dir, SET(TURN, AT_REST, OF_BASE,
                    constant ? "integrator={method: newmark, step: 0.02}" : "integrator=null"));
    csv probes = read_csv(in(dir, "out/probes.csv")), steps = read_csv(in(dir, "out/steps.csv"));
    for (int i = 0; i < probes.nrow; i++) assert_foot(probes.x[i], probes.x[i][0]);
    double kink[2] = {0};
    int n = 0;
    for (int i = 0; i < steps.nrow; i++)
      if (strstr(steps.event[i], "kink")) kink[n++ % 2] = steps.x[i][0];
    assert_int_equal(n, 2);
    assert_close(kink[0], constant ? 0.16 : 0.15, 1e-14, 0);
    assert_close(kink[1], constant ? 0.66 : 0.65, 1e-14, 0);
    free_csv(probes), free_csv(steps);
  }
  remove_folder(dir);
}

/* The jump of a support's velocity is felt through the damping, here at the tolerance. */
static void the_integrator_begins_again_where_a_support_jumps(void **state) {
  (void)state;
  char *dir = temporary_folder();
  run_ok(dir, SET(TURN, AT_REST, "integrator.rtol=1.0e-6"));
  csv steps = read_csv(in(dir, "out/steps.csv"));
  for (int i = 0; i < steps.nrow; i++)
    assert_string_equal(steps.event[i], strstr(steps.event[i], "kink") ? "kink+restart" : "");
  free_csv(steps);
  json_t *result = result_of(dir);
  assert_close(number(result, "statistics", "nrestart"), 2, 0, 0);
  json_decref(result);
  run_ok(dir, SET("integrator.rtol=1.0e-6")); /* the kink of a load is none */
  result = result_of(dir);
  assert_close(number(result, "statistics", "nrestart"), 0, 0, 0);
  json_decref(result);
  remove_folder(dir);
}

static void the_ledger_closes_over_a_moving_support(void **state) {
  (void)state;
  char *dir = temporary_folder();
  run_ok(dir, SET(TURN, AT_REST, "integrator.rtol=1.0e-7"));
  csv energy = read_csv(in(dir, "out/energy.csv"));
  double work = 0, imbalance = 0;
  for (int i = 0; i < energy.nrow; i++) {
    work = fmax(work, fabs(energy.x[i][4]));
    imbalance = fmax(imbalance, fabs(energy.x[i][5]));
  }
  assert_above(work, 1e-3);
  assert_below(imbalance, 1e-3 * work);
  free_csv(energy);
  remove_folder(dir);
}

static double last_deflection(const char *dir, const char *const *set) {
  double x[COLUMNS];
  run_ok(dir, set);
  return x[column(dir, "probes.csv", 1, COLUMNS, x) - 1];
}

static double constant_step_imbalance(const char *dir, const char *integrator) {
  double balance[11], largest = 0;
  run_ok(dir, SET(TURN, AT_REST, integrator));
  assert_int_equal(column(dir, "energy.csv", 5, 11, balance), 11);
  for (int i = 0; i < 11; i++) largest = fmax(largest, fabs(balance[i]));
  return largest;
}

/* Kinks within steps cost no more than a step's own error. A support that ran on to the end of the
   step and came back would put in 0.016 J at a step of 0.02. */
static void constant_steps_cross_kinks(void **state) {
  (void)state;
  char *dir = temporary_folder();
  double exact = last_deflection(dir, SET(TURN, AT_REST, "integrator.rtol=1.0e-7"));
  double coarse =
      last_deflection(dir, SET(TURN, AT_REST, "integrator={method: midpoint, step: 0.004}"));
  double fine =
      last_deflection(dir, SET(TURN, AT_REST, "integrator={method: midpoint, step: 0.001}"));
  assert_below(fabs(coarse - exact), 0.01);
  assert_below(fabs(fine - exact), 0.25 * fabs(coarse - exact));
  assert_below(constant_step_imbalance(dir, "integrator={method: midpoint, step: 0.02}"), 0.006);
  remove_folder(dir);
}

static void loads_and_dampings_reach_the_model(void **state) {
  (void)state;
  char *dir = temporary_folder();
  double traction = last_deflection(dir, SET("loads=[{group: top, traction: [200, 0, 0]}]"));
  double force = last_deflection(dir, SET("loads=[{group: top, force: [2, 0, 0]}]"));
  assert_close(force, traction, 0.1, 0); /* the same in total, spread otherwise */
  double slow = last_deflection(
      dir, SET("loads=[{group: top, force: [2, 0, 0]}]", "material.damping.mass=100.0"));
  assert_below(fabs(slow), 0.8 * fabs(force));

  double sink[16];
  run_ok(dir, SET("loads=[{group: top, pressure: 200}]"));
  int n = column(dir, "probes.csv", 3, 16, sink);
  assert_below(sink[n - 1], -1e-4);

  double corotated = last_deflection(dir, SET("viscosity=corotated"));
  double objective = last_deflection(dir, SET("viscosity=objective"));
  assert_true(corotated != objective);
  assert_close(objective, corotated, 1e-2, 0);
  remove_folder(dir);
}

/* --- Constant steps --- */

/* Steps of 0.03 meet neither the outputs at multiples of 0.1 nor the end at 1. */
static void a_step_need_not_divide_the_output_times(void **state) {
  (void)state;
  char *dir = temporary_folder();
  double exact[11], x[11];
  run_ok(dir, SET("integrator.rtol=1.0e-6"));
  assert_int_equal(column(dir, "probes.csv", 1, 11, exact), 11);
  run_ok(dir, SET("integrator={method: newmark, step: 0.03}"));
  csv steps = read_csv(in(dir, "out/steps.csv")), probes = read_csv(in(dir, "out/probes.csv"));
  json_t *result = result_of(dir);
  assert_int_equal(steps.nrow, 34);
  for (int i = 0; i < 34; i++) assert_close(steps.x[i][0], (i + 1) * 0.03, 1e-14, 0);
  assert_int_equal(probes.nrow, 11);
  for (int i = 0; i < 10; i++) assert_close(probes.x[i][0], i * 0.1, 0, 0);
  assert_close(last_time(probes), 1, 0, 0);
  assert_close(number(result, "t_reached", NULL), 1, 0, 0);
  assert_close(number(result, "integrator", "step"), 0.03, 0, 0);
  assert_string_equal(word(result, "integrator", "solution"), "newton");

  run_ok(dir, SET("integrator={method: newmark, step: 0.003}"));
  assert_int_equal(column(dir, "probes.csv", 1, 11, x), 11);
  for (int i = 0; i < 11; i++) assert_close(x[i], exact[i], 0, 0.01 * fabs(exact[10]));
  free_csv(steps), free_csv(probes);
  json_decref(result);
  remove_folder(dir);
}

/* Where it divides them, rounding makes no step more and no output less. */
static void a_step_that_divides_the_end_reaches_it(void **state) {
  (void)state;
  static const struct {
    const char *integrator;
    int nstep;
  } grid[] = {{"integrator={method: bdf2, step: 0.1}", 10},
              {"integrator={method: bdf2, step: 0.02}", 50},
              {"integrator={method: bdf2, step: 0.01}", 100},
              {"integrator={method: bdf2, step: 0.007142857142857143}", 140}};
  char *dir = temporary_folder();
  for (int k = 0; k < 4; k++) {
    run_ok(dir, SET(grid[k].integrator, "output.fields=none"));
    csv steps = read_csv(in(dir, "out/steps.csv")), probes = read_csv(in(dir, "out/probes.csv"));
    assert_int_equal(steps.nrow, grid[k].nstep);
    assert_int_equal(probes.nrow, 11);
    assert_close(last_time(probes), 1, 0, 0);
    free_csv(steps), free_csv(probes);
  }
  remove_folder(dir);
}

typedef struct counts {
  int nst, nfe, nni, nli, nfactor, nframes;
} counts;

static counts counts_of(const char *dir, const char *const *set) {
  run_ok(dir, set);
  json_t *r = result_of(dir);
  counts c = {.nst = (int)number(r, "statistics", "nst"),
              .nfe = (int)number(r, "statistics", "nfe"),
              .nni = (int)number(r, "statistics", "nni"),
              .nli = (int)number(r, "statistics", "nli"),
              .nfactor = (int)number(r, "statistics", "nfactor"),
              .nframes = (int)number(r, "statistics", "nframes")};
  json_decref(r);
  return c;
}

/* One evaluation and one solve a step, one factorisation for each set of frames; BDF of order 3
   begins with backward Euler, which has a matrix of its own. The counts of Table 1 of Hauth &
   Strasser 2004, for the same steps and intervals. */
static void linear_steps_cost_what_the_paper_says(void **state) {
  (void)state;
  static const struct {
    const char *method, *step, *interval;
    int nst, nfactor;
  } row[] = {{"bdf3", "0.02", "0.02", 2000, 2000},
             {"bdf3", "0.02", "0.2", 2000, 201},
             {"bdf3", "0.06", "0.3", 667, 135},
             {"backward-euler", "0.02", "0.2", 2000, 200}};
  char *dir = temporary_folder(), integrator[128], frames[64];
  for (int k = 0; k < 4; k++) {
    snprintf(integrator, sizeof integrator, "integrator={method: %s, step: %s, solution: linear}",
             row[k].method, row[k].step);
    snprintf(frames, sizeof frames, "frames={policy: hold, interval: %s}", row[k].interval);
    counts c = counts_of(dir, SET(integrator, frames, "viscosity=corotated",
                                  "time={end: 40, output: 0.1}", AT_REST, "output.fields=none"));
    assert_int_equal(c.nst, row[k].nst);
    assert_int_equal(c.nfe, row[k].nst);
    assert_int_equal(c.nfactor, row[k].nfactor);
    assert_int_equal(c.nni + c.nli, 0);
  }
  counts moved =
      counts_of(dir, SET("integrator={method: bdf2, step: 0.02, solution: linear}", TURN,
                         "frames={policy: hold, interval: 0.2}", "viscosity=corotated", AT_REST));
  assert_int_equal(moved.nfactor, 2 + 4); /* no velocity stands in the matrix */
  remove_folder(dir);
}

static void iterations_are_counted(void **state) {
  (void)state;
  char *dir = temporary_folder();
  const char *hold = "frames={policy: hold, interval: 0.2}";
  const char *linear = "integrator={method: backward-euler, step: 0.02, solution: linear}";
  counts direct = counts_of(dir, SET(hold, linear));
  double by_direct = last_deflection(dir, SET(hold, linear));
  counts pcg = counts_of(dir, SET(hold, linear, "linear_solver={name: pcg, tolerance: 1.0e-6}"));
  assert_int_equal(direct.nli, 0);
  assert_int_equal(direct.nframes, 4);
  assert_true(pcg.nli > pcg.nst);
  counts rough = counts_of(dir, SET(hold, linear, "linear_solver={name: pcg, tolerance: 1.0e-2}"));
  assert_true(rough.nli < pcg.nli);
  double by_pcg =
      last_deflection(dir, SET(hold, linear, "linear_solver={name: pcg, tolerance: 1.0e-6}"));
  assert_close(by_pcg, by_direct, 1e-3, 0);

  counts newton = counts_of(dir, SET(hold, "integrator={method: backward-euler, step: 0.02}"));
  csv steps = read_csv(in(dir, "out/steps.csv"));
  double sum = 0;
  for (int i = 0; i < steps.nrow; i++) sum += steps.x[i][4];
  assert_true(newton.nni >= 2 * 50);
  assert_close(newton.nni, sum, 0, 0);
  free_csv(steps);
  remove_folder(dir);
}

/* Both begin in an equilibrium, which the same solver finds, and go the same way to the tolerance
   of the steps. */
static void a_refined_body_is_solved_by_its_levels(void **state) {
  (void)state;
  char *dir = temporary_folder();
  const char *start = "start=equilibrium", *refined = "mesh.refine=1";
  const char *load = "loads=[{group: top, traction: [200, 0, 0], amplitude: [[0, 1], [0.3, 2]]}]";
  double by_default = last_deflection(dir, SET(start, refined, load));
  double by_levels = last_deflection(
      dir, SET(start, refined, load, "linear_solver={name: pcg, preconditioner: multigrid}"));
  json_t *result = result_of(dir);
  assert_string_equal(word(result, "integrator", "linear_solver"), "pcg, multigrid");
  assert_true(number(result, "statistics", "nli") > number(result, "statistics", "nst"));
  assert_close(by_levels, by_default, 1e-4, 0);
  json_decref(result);
  remove_folder(dir);
}

static void a_step_that_cannot_be_solved_ends_the_run(void **state) {
  (void)state;
  char *dir = temporary_folder();
  answer a = run_with(dir, (run_options){.quiet = true},
                      SET("integrator={method: newmark, step: 0.02, newton: {iterations: 1}}"));
  assert_int_equal(a.code, 4);
  assert_non_null(strstr(a.err, "newmark: "));
  assert_non_null(strstr(a.err, "Newton has not converged in 1 iterations"));
  json_t *result = result_of(dir);
  csv probes = read_csv(in(dir, "out/probes.csv"));
  assert_close(last_time(probes), number(result, "t_reached", NULL), 0, 0);
  free_csv(probes);
  json_decref(result);
  forget(a);
  remove_folder(dir);
}

/* --- Comparison --- */

enum { TOTAL = 1, PRESSURE, SHEAR }; /* columns of the first measure; the next has them 3 on */

static void forces_are_compared_with_those_of_green(void **state) {
  (void)state;
  char *dir = temporary_folder();
  run_ok(dir, SET("compare=[cauchy, hybrid]"));
  char *text = slurp(in(dir, "out/compare.csv"), NULL);
  const char *head =
      "t,cauchy.total,cauchy.pressure,cauchy.shear,hybrid.total,hybrid.pressure,hybrid.shear,"
      "polar.total,polar.pressure,polar.shear\n0,,,,,,,,,\n";
  assert_memory_equal(text, head, strlen(head));
  free(text);

  csv compare = read_csv(in(dir, "out/compare.csv"));
  enum { CAUCHY = 0, HYBRID = 3, POLAR = 6 };
  assert_int_equal(compare.nrow, 11);
  for (int i = 1; i < 11; i++) {
    const double *x = compare.x[i];
    assert_close(x[HYBRID + PRESSURE], 0, 0, 1e-10); /* the same term as green's */
    assert_close(x[HYBRID + SHEAR], x[POLAR + SHEAR], 1e-12, 0);
    assert_true(x[POLAR + TOTAL] > 0 && x[POLAR + TOTAL] < 0.5);
    assert_above(x[CAUCHY + PRESSURE], x[POLAR + PRESSURE]);
    assert_close(x[0], i * 0.1, 1e-15, 0);
  }
  free_csv(compare);

  run_ok(dir, NULL);
  assert_false(exists(in(dir, "out/compare.csv"))); /* that of the run before is gone */
  remove_folder(dir);
}

static void a_comparison_disturbs_nothing(void **state) {
  (void)state;
  char *dir = temporary_folder();
  const char *hold = "frames={policy: extrapolate, interval: 0.07}";
  run_ok(dir, SET(hold));
  assert_int_equal(rename(in(dir, "out"), in(dir, "without")), 0);
  run_ok(dir, SET(hold, "compare=[cauchy, warp, polar, hybrid]"));
  assert_same_file(in(dir, "out/steps.csv"), in(dir, "without/steps.csv"));
  assert_same_file(in(dir, "out/energy.csv"), in(dir, "without/energy.csv"));
  remove_folder(dir);
}

/* The linear measure takes elements through themselves, where the others have no force. */
static void a_comparison_survives_inverted_elements(void **state) {
  (void)state;
  char *dir = temporary_folder();
  run_ok(dir, SET("strain=cauchy", "compare=[polar]", "output.fields=none",
                  "loads=[{group: top, traction: [0, 0, -2.0e5], amplitude: [[0, 0], [1, 1]]}]"));
  csv compare = read_csv(in(dir, "out/compare.csv"));
  assert_int_equal(compare.nrow, 11);
  assert_above(compare.x[1][TOTAL], 0);
  assert_true(isnan(compare.x[10][TOTAL]));
  free_csv(compare);
  remove_folder(dir);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(held_frames_are_updated_on_time),
      cmocka_unit_test(frames_are_updated_at_every_step),
      cmocka_unit_test(frames_are_updated_at_an_angle),
      cmocka_unit_test(an_extrapolation_ends_at_its_cap),
      cmocka_unit_test(extrapolated_frames_are_better_than_held_ones),
      cmocka_unit_test(a_support_keeps_to_its_path),
      cmocka_unit_test(the_integrator_begins_again_where_a_support_jumps),
      cmocka_unit_test(the_ledger_closes_over_a_moving_support),
      cmocka_unit_test(constant_steps_cross_kinks),
      cmocka_unit_test(loads_and_dampings_reach_the_model),
      cmocka_unit_test(a_step_need_not_divide_the_output_times),
      cmocka_unit_test(a_step_that_divides_the_end_reaches_it),
      cmocka_unit_test(linear_steps_cost_what_the_paper_says),
      cmocka_unit_test(iterations_are_counted),
      cmocka_unit_test(a_refined_body_is_solved_by_its_levels),
      cmocka_unit_test(a_step_that_cannot_be_solved_ends_the_run),
      cmocka_unit_test(forces_are_compared_with_those_of_green),
      cmocka_unit_test(a_comparison_disturbs_nothing),
      cmocka_unit_test(a_comparison_survives_inverted_elements),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
