/* Numbers with units: what they are in SI, and what is refused. */
#define TEST_NAME "unit"
#include "app/config/unit.h"

#include "scenario_text.h"

static double si(const char *number, const char *text) {
  measured_unit u;
  char wrong[32];
  assert_true(unit_parse(text, &u, sizeof wrong, wrong));
  return unit_scale(number, strlen(number), &u);
}

/* Powers of ten go into the digits: the same bits as the number in SI. */
static void decimal_units_are_exact(void **state) {
  (void)state;
  static const struct {
    const char *number, *unit;
    double si;
  } row[] = {{"20", "ms", 20e-3},
             {"2", "MPa", 2e6},
             {"5", "mm", 5e-3},
             {"1", "g/cm^3", 1e3},
             {"-9.81", "m/s^2", -9.81},
             {"210", "GPa", 210e9},
             {"7.85", "g/cm^3", 7850},
             {"3", "N/mm^2", 3e6},
             {"1.5e3", "kN", 1.5e6},
             {"3", "Pa*s", 3},
             {"3", "Pa s", 3},
             {"0.1", "us", 0.1e-6},
             {"0.1", "\xc2\xb5s", 0.1e-6},
             {"4", "1/ms", 4e3},
             {"4", "s^-1", 4},
             {"1", "bar", 1e5},
             {"1", "cP", 1e-3},
             {"2", "m / s", 2},
             {"1", "kg m^2/s^2", 1},
             {"12", "kN", 12e3},
             {"1", "t/m^3", 1e3}};
  for (size_t i = 0; i < sizeof row / sizeof *row; i++)
    assert_true(si(row[i].number, row[i].unit) == row[i].si);
}

/* To a rounding of the factor and one of the product. */
static void other_units(void **state) {
  (void)state;
  static const double pi = 3.14159265358979323846;
  assert_float_equal(si("30", "deg"), pi / 6, 1e-15);
  assert_float_equal(si("60", "rpm"), 2 * pi, 1e-14);
  assert_float_equal(si("360", "deg/s"), 2 * pi, 1e-14);
  assert_float_equal(si("1.5", "min"), 90, 0);
  assert_float_equal(si("36", "km/h"), 10, 1e-14);
  assert_float_equal(si("1", "in"), 0.0254, 1e-17);
  assert_float_equal(si("1", "psi"), 6894.757293168361, 1e-9);
}

static void what_is_no_unit(void **state) {
  (void)state;
  static const char *const text[] = {"",     "m/",  "/s",  "m^",   "m^0", "m^x",
                                     "m**s", "foo", "kkg", "mmin", "ms2", "m m m m m m m m m"};
  for (size_t i = 0; i < sizeof text / sizeof *text; i++) {
    measured_unit u;
    char wrong[32];
    assert_false(unit_parse(text[i], &u, sizeof wrong, wrong));
  }
}

static void near_names(void **state) {
  (void)state;
  static const char *const pair[][2] = {{"mpa", "MPa"},     {"sec", "s"}, {"m3", "m^3"},
                                        {"degrees", "deg"}, {"hz", "Hz"}, {"kgg", "kg"},
                                        {"wombat", ""}};
  for (size_t i = 0; i < sizeof pair / sizeof *pair; i++) {
    char near[32];
    unit_suggest(pair[i][0], sizeof near, near);
    assert_string_equal(near, pair[i][1]);
  }
}

static void a_scenario_is_resolved_in_si(void **state) {
  (void)state;
  scenario *s = accept(
      "mesh: {box: {size: [10 cm, 100 mm, 0.2], cells: [1, 1, 1]}}\n"
      "material: {lambda: 0, mu: 1 kPa, density: 1 g/cm^3}\n"
      "loads: [{gravity: [0, 0, \"-9.81 m/s^2\"], amplitude: [[10 ms, 1]]}]\n"
      "integrator: {first_step: 5 us}\n"
      "time: {end: 20 ms}\n");
  assert_true(s->box.size[0] == 0.1 && s->box.size[1] == 0.1 && s->box.size[2] == 0.2);
  assert_true(s->model.material[0].mu == 1e3 && s->model.material[0].density == 1e3);
  assert_true(s->model.load[0].value[2] == -9.81 && s->t_end == 0.02);
  char *text = json_dumps(s->resolved, JSON_COMPACT | JSON_SORT_KEYS);
  assert_non_null(text);
  assert_non_null(strstr(text, "\"amplitude\":[[0.01,1.0]]"));
  assert_non_null(strstr(text, "\"end\":0.02"));
  free(text);
  scenario_destroy(s);
}

/* Radians are no pure number: a frequency is not a rate of turning. */
static void another_dimension_is_refused(void **state) {
  (void)state;
  refuse(MESH MATERIAL "time: {end: 3 mm}\n",
         "3:13: time.end: expected a number in s, or with another unit of the kind, found 3 mm");
  refuse(MESH MATERIAL "time: {end: 3 sec}\n",
         "3:13: time.end: unknown unit sec; did you mean s? (in SI: s)");
  refuse(MESH MATERIAL "time: {end: 1}\nintegrator: {rtol: 1 s}\n",
         "4:20: integrator.rtol: expected a number without a unit, found 1 s");
  refuse(MESH MATERIAL "time: {end: 1}\nintegrator: {method: newmark, step: -1 ms}\n",
         "4:37: integrator.step: must be > 0, found -1 ms");
  refuse(MESH MATERIAL "time: {end: 1}\nstart: {spin: {axis: [0, 0, 1], rate: 2 Hz}}\n",
         "4:39: start.spin.rate: expected a number in rad/s");
  refuse(MESH MATERIAL "time: {end: 1e300 h}\nloads: [{gravity: [0, 0, 1e307 km/s^2]}]\n",
         "4:26: loads[0].gravity[2]: expected a finite number, found 1e307 km/s^2");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(decimal_units_are_exact),
      cmocka_unit_test(other_units),
      cmocka_unit_test(what_is_no_unit),
      cmocka_unit_test(near_names),
      cmocka_unit_test(a_scenario_is_resolved_in_si),
      cmocka_unit_test(another_dimension_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
