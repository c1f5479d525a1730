/* Quantities of whole runs: at the resolution of the steps, whatever is written of them. */
#include "whole_run.h"

static const char asked[] =
    "quantities={peak: max(corner.ux), low: \"min(elastic, 0.2, 0.9)\", end: corner.ux@end, "
    "half: corner.ux@0.5, mean: mean(corner.ux), work: integral(external_work), "
    "when: when(max(corner.ux)), way: amplitude(corner.uz)}";

static double quantity_of(json_t *result, const char *name, const char *part) {
  return number(json_object_get(result, "quantities"), name, part);
}

enum { T, UX, UY, UZ, KINETIC, ELASTIC, DISSIPATED, WORK };

static double largest(const csv *table, int k) {
  double x = -INFINITY;
  for (int i = 0; i < table->nrow; i++) x = fmax(x, table->x[i][k]);
  return x;
}

static double trapezoid(const csv *table, int k) {
  double sum = 0;
  for (int i = 0; i + 1 < table->nrow; i++)
    sum += (table->x[i + 1][T] - table->x[i][T]) * (table->x[i][k] + table->x[i + 1][k]) / 2;
  return sum;
}

/* Between its neighbours in the table, but for a hundredth of the largest value. */
static void assert_between_rows(const csv *table, int k, double t, double value) {
  double slack = 0.01 * largest(table, k);
  for (int i = 0; i + 1 < table->nrow; i++) {
    if (table->x[i][T] > t || table->x[i + 1][T] < t) continue;
    double a = table->x[i][k], b = table->x[i + 1][k];
    assert_true(value >= fmin(a, b) - slack && value <= fmax(a, b) + slack);
  }
}

/* Against what the rows of history.csv say at once, which are 30 to 150: an extreme between rows is
   higher by a part of the way between them, and the trapezoidal rule errs by a thousandth. */
static void they_are_those_of_the_history(void **state) {
  (void)state;
  char *dir = temporary_folder();
  for (int m = 0; m < NEVERY; m++) {
    run_ok(dir, SET(every_method[m], asked, "output.fields=none"));
    json_t *result = result_of(dir);
    csv history = read_csv(in(dir, "out/history.csv"));
    double top = largest(&history, UX), peak = quantity_of(result, "peak", "value");
    assert_true(peak >= top);
    assert_below(peak, 1.01 * top);
    assert_close(quantity_of(result, "when", "value"), quantity_of(result, "peak", "t"), 0, 0);
    assert_between_rows(&history, UX, 0.5, quantity_of(result, "half", "value"));
    assert_close(quantity_of(result, "end", "value"), history.x[history.nrow - 1][UX], 0, 0);
    assert_close(quantity_of(result, "end", "t"), 1, 0, 0);
    assert_close(quantity_of(result, "mean", "value"), trapezoid(&history, UX), 5e-3, 0);
    assert_close(quantity_of(result, "work", "value"), trapezoid(&history, WORK), 5e-3, 0);
    free_csv(history);
    json_decref(result);
  }
  remove_folder(dir);
}

/* To the last bit: neither the output grid nor what is written has a say. */
static void outputs_do_not_matter(void **state) {
  (void)state;
  char *dir = temporary_folder();
  const char *const written[] = {"time.output=0.1", "time.output=0.01", "output.history=false",
                                 "output.states=binary"};
  json_t *first = NULL;
  for (int k = 0; k < 4; k++) {
    run_ok(dir, SET(asked, "output.fields=none", written[k]));
    json_t *result = result_of(dir), *quantities = json_object_get(result, "quantities");
    assert_int_equal(json_object_size(quantities), 8);
    if (first && !json_equal(first, quantities)) fail_msg("%s changes quantities", written[k]);
    if (!first) first = json_incref(quantities);
    json_decref(result);
  }
  json_decref(first);
  remove_folder(dir);
}

/* A free body falls: u = -g t^2 / 2, and the momentum is -m g t. */
static void a_fall_is_in_closed_form(void **state) {
  (void)state;
  static const struct {
    const char *of, *unit;
    double value;
  } fall[] = {
      {"p.uz@end", "m", -20},
      {"p.uz@0.5", "m", -1.25},
      {"min(p.uz, 0.5, 1.5)", "m", -11.25},
      {"max(abs(p.uz), 0.5, 1.5)", "m", 11.25},
      {"when(max(p.uz))", "s", 0},
      {"mean(p.uz)", "m", -20. / 3},
      {"integral(p.uz, 1, end)", "m s", -35. / 3},
      {"amplitude(p.uz)", "m", 10},
      {"pz@1.25", "kg m/s", -12.5 * 4},
      {"integral(kinetic)", "J s", 4 * 50 * 8. / 3},
  };
  char *dir = temporary_folder();
  static const char body[] =
      "mesh: {box: {size: [0.1, 0.1, 0.4], cells: [1, 1, 2]}}\n"
      "material: {lambda: 1.0e5, mu: 1.0e4, density: 1000.0}\n"
      "loads: [{gravity: [0, 0, -10]}]\n"
      "time: {end: 2.0}\n"
      "output: {fields: none}\n"
      "probes: {p: {node: 0}}\n";
  char set[NEVERY + sizeof fall / sizeof *fall][96];
  for (int m = 0; m < 4; m++) {
    const char *all[sizeof fall / sizeof *fall + 3] = {every_method[m]};
    size_t n = 1;
    for (size_t i = 0; i < sizeof fall / sizeof *fall; i++, n++) {
      snprintf(set[i], sizeof set[i], "quantities.q%zu=%s", i, fall[i].of);
      all[n] = set[i];
    }
    all[n] = "integrator.rtol=1e-6";
    answer a = run_text(dir, body, (run_options){.quiet = true}, all);
    if (a.code != 0) fail_msg("%s: %s", every_method[m], a.err);
    forget(a);
    json_t *result = result_of(dir);
    for (size_t i = 0; i < sizeof fall / sizeof *fall; i++) {
      char name[8];
      snprintf(name, sizeof name, "q%zu", i);
      json_t *q = json_object_get(json_object_get(result, "quantities"), name);
      /* rtol 1e-6 a step, of which there are 20 to 100, of numbers up to 20 */
      assert_close(number(q, "value", NULL), fall[i].value, 2e-5, 2e-5);
      assert_string_equal(word(q, "of", NULL), fall[i].of);
      assert_string_equal(word(q, "unit", NULL), fall[i].unit);
    }
    json_decref(result);
  }
  remove_folder(dir);
}

/* The run is well, and the question has no answer. */
static void what_does_not_oscillate_is_told(void **state) {
  (void)state;
  char *dir = temporary_folder();
  answer a = run_with(dir, (run_options){0},
                      SET("output.fields=none", "quantities={T: \"period(dissipated, 0, 0.3)\"}"));
  assert_int_equal(a.code, 1);
  assert_non_null(strstr(a.err,
                         "quantities.T has no value: period(dissipated, 0, 0.3): it does not "
                         "oscillate: it turns "));
  assert_non_null(strstr(a.err, "T              no value"));
  forget(a);
  json_t *result = result_of(dir), *q;
  assert_string_equal(word(result, "status", NULL), "ok");
  assert_true(json_is_null(json_object_get(result, "reason")));
  assert_int_equal((int)number(result, "exit_code", NULL), 1);
  q = json_object_get(json_object_get(result, "quantities"), "T");
  assert_true(json_is_null(json_object_get(q, "value")) && !json_object_get(q, "t"));
  assert_non_null(strstr(word(q, "reason", NULL), "does not oscillate"));
  json_t *warned = json_object_get(result, "warnings");
  json_t *last = json_array_get(warned, json_array_size(warned) - 1);
  assert_string_equal(word(last, "code", NULL), "quantity");
  json_decref(result);
  remove_folder(dir);
}

/* A run that gives up answers what it has reached, and nothing half. */
static void a_run_that_fails_answers_no_more_than_it_knows(void **state) {
  (void)state;
  char *dir = temporary_folder();
  answer a = run_with(dir, (run_options){.quiet = true},
                      SET("output.fields=none", "integrator.max_steps=12", asked,
                          "quantities.soon=max(corner.ux, 0, 1e-5)"));
  assert_int_equal(a.code, 4);
  forget(a);
  json_t *result = result_of(dir), *all = json_object_get(result, "quantities");
  assert_string_equal(word(result, "status", NULL), "failed");
  assert_true(json_is_null(json_object_get(json_object_get(all, "peak"), "value")));
  assert_non_null(strstr(word(all, "peak", "reason"), "and does not reach 1 s"));
  assert_true(json_is_number(json_object_get(json_object_get(all, "soon"), "value")));
  json_t *warned = json_object_get(result, "warnings");
  for (size_t i = 0; i < json_array_size(warned); i++)
    assert_string_not_equal(word(json_array_get(warned, i), "code", NULL), "quantity");
  json_decref(result);
  remove_folder(dir);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(they_are_those_of_the_history),
      cmocka_unit_test(outputs_do_not_matter),
      cmocka_unit_test(a_fall_is_in_closed_form),
      cmocka_unit_test(what_does_not_oscillate_is_told),
      cmocka_unit_test(a_run_that_fails_answers_no_more_than_it_knows),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
