/* history.csv: every step of a run; its extremes in result.json. */
#include "whole_run.h"

enum { T, UX, UY, UZ, KINETIC, ELASTIC, DISSIPATED, WORK, BALANCE }; /* columns */

static void every_step_has_its_row(void **state) {
  (void)state;
  char *dir = temporary_folder();
  for (int m = 0; m < NEVERY; m++) {
    run_ok(dir, SET(every_method[m], "output.fields=none"));
    csv steps = read_csv(in(dir, "out/steps.csv")), history = read_csv(in(dir, "out/history.csv"));
    assert_int_equal(history.nrow, steps.nrow + 1);
    assert_close(history.x[0][T], 0, 0, 0);
    for (int i = 0; i < steps.nrow; i++)
      assert_close(history.x[i + 1][T], fmin(steps.x[i][0], 1), 0, 0);
    free_csv(steps), free_csv(history);
  }
  remove_folder(dir);
}

/* Where an output time is the end of a step both tables say the same, up to the last digits that
   the quadratures of multistep methods see differently. */
static void rows_are_those_of_the_output_grid(void **state) {
  (void)state;
  char *dir = temporary_folder();
  for (int m = 0; m < NEVERY; m++) {
    run_ok(dir, SET(every_method[m], "output.fields=none", "time.output=0.3"));
    csv probes = read_csv(in(dir, "out/probes.csv")), energy = read_csv(in(dir, "out/energy.csv"));
    csv history = read_csv(in(dir, "out/history.csv"));
    int common = 0;
    for (int i = 0; i < history.nrow; i++)
      for (int k = 0; k < probes.nrow; k++) {
        if (history.x[i][T] != probes.x[k][T]) continue;
        common++;
        for (int c = UX; c <= UZ; c++) assert_close(history.x[i][c], probes.x[k][c], 0, 0);
        for (int c = 0; c < 12; c++)
          assert_close(history.x[i][KINETIC + c], energy.x[k][1 + c], 1e-9, 1e-13);
      }
    assert_true(common >= 2); /* the start and the end; the load's kink at 0.3 s as a rule */
    free_csv(probes), free_csv(energy), free_csv(history);
  }
  remove_folder(dir);
}

static void assert_extreme(json_t *extremes, const char *name, const csv *table, int column) {
  double low = INFINITY, high = -INFINITY, t_low = 0, t_high = 0;
  for (int i = 0; i < table->nrow; i++) {
    double x = column > 0
                   ? table->x[i][column]
                   : sqrt(table->x[i][UX] * table->x[i][UX] + table->x[i][UY] * table->x[i][UY] +
                          table->x[i][UZ] * table->x[i][UZ]);
    if (x < low) low = x, t_low = table->x[i][T];
    if (x > high) high = x, t_high = table->x[i][T];
  }
  json_t *of = json_object_get(extremes, name);
  if (!of) fail_msg("no extremes of %s", name);
  assert_close(number(json_object_get(of, "min"), "value", NULL), low, 0, 0);
  assert_close(number(json_object_get(of, "max"), "value", NULL), high, 0, 0);
  assert_close(number(json_object_get(of, "min"), "t", NULL), t_low, 0, 0);
  assert_close(number(json_object_get(of, "max"), "t", NULL), t_high, 0, 0);
}

static const struct {
  const char *name;
  int column; /* 0: the magnitude of the probe's displacement */
} signals[] = {
    {"corner.ux", UX},    {"corner.uy", UY},    {"corner.uz", UZ},          {"corner.u", 0},
    {"kinetic", KINETIC}, {"elastic", ELASTIC}, {"dissipated", DISSIPATED}, {"external_work", WORK},
    {"balance", BALANCE}};

static void extremes_are_those_of_the_table(void **state) {
  (void)state;
  char *dir = temporary_folder();
  for (int m = 0; m < NEVERY; m++) {
    run_ok(dir, SET(every_method[m], "output.fields=none"));
    json_t *result = result_of(dir), *extremes = json_object_get(result, "extremes");
    csv history = read_csv(in(dir, "out/history.csv"));
    for (size_t k = 0; k < sizeof signals / sizeof *signals; k++)
      assert_extreme(extremes, signals[k].name, &history, signals[k].column);
    assert_int_equal(json_object_size(extremes), 4 + 6);
    free_csv(history);
    json_decref(result);
  }
  remove_folder(dir);
}

/* Not written, but looked at: extremes are the same. That of the run before is gone. */
static void it_can_be_left_out(void **state) {
  (void)state;
  char *dir = temporary_folder();
  run_ok(dir, SET("output.fields=none"));
  json_t *first = result_of(dir);
  assert_true(exists(in(dir, "out/history.csv")));
  run_ok(dir, SET("output.fields=none", "output.history=false"));
  json_t *second = result_of(dir);
  assert_false(exists(in(dir, "out/history.csv")));
  assert_true(json_equal(json_object_get(first, "extremes"), json_object_get(second, "extremes")));
  assert_true(json_is_false(
      json_object_get(json_object_get(json_object_get(second, "scenario"), "output"), "history")));
  json_decref(first), json_decref(second);
  remove_folder(dir);
}

static void a_run_without_probes_has_energies(void **state) {
  (void)state;
  char *dir = temporary_folder();
  run_ok(dir, SET("output.fields=none", "probes={}"));
  json_t *result = result_of(dir);
  assert_int_equal(json_object_size(json_object_get(result, "extremes")), 6);
  char *text = slurp(in(dir, "out/history.csv"), NULL);
  assert_int_equal(strncmp(text, "t,kinetic,elastic,", 18), 0);
  free(text);
  json_decref(result);
  remove_folder(dir);
}

/* Undamped, under a load that is there at once: the period is that of the bar's first mode, with
   probes and without, and whatever the output grid. */
static void the_period_is_measured(void **state) {
  (void)state;
  char *dir = temporary_folder();
  double period[3];
  const char *more[] = {"time.output=0.01", "time.output=1", "probes={}"};
  for (int k = 0; k < 3; k++) {
    run_ok(dir, SET("output.fields=none", "time.end=6", "material.damping={lambda: 0, mu: 0}",
                    "loads.0={group: top, traction: [30, 0, 0]}", more[k]));
    json_t *result = result_of(dir);
    period[k] = number(result, "observed", "period");
    json_decref(result);
  }
  assert_close(period[1], period[0], 0, 0);
  assert_close(period[0], 0.84, 0.05, 0);
  assert_close(period[2], period[0], 0.1, 0);
  remove_folder(dir);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_step_has_its_row),
      cmocka_unit_test(rows_are_those_of_the_output_grid),
      cmocka_unit_test(extremes_are_those_of_the_table),
      cmocka_unit_test(it_can_be_left_out),
      cmocka_unit_test(a_run_without_probes_has_energies),
      cmocka_unit_test(the_period_is_measured),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
