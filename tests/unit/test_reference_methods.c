/* Which methods references are found by, of what pilots cost. */
#include <math.h>

#include "check.h"
#include "study/command/reference_methods.h"

static void the_dearer_gives_way_to_what_is_half_as_dear(void **state) {
  (void)state;
  static const struct {
    double cost[3]; /* cvode, arkode, erk [s] */
    const char *taken[2];
  } row[] = {
      {{100, 50, 20}, {"arkode", "erk"}},
      {{50, 100, 20}, {"cvode", "erk"}},
      {{50, 100, 50}, {"cvode", "arkode"}},
      {{50, 100, 49}, {"cvode", "erk"}},
      {{1, 9, 0.1}, {"cvode", "arkode"}}, /* nothing to be gained */
      {{50, 60, INFINITY}, {"cvode", "arkode"}},
      {{INFINITY, 1, 0.1}, {"arkode", "erk"}},
      {{1, INFINITY, 0.1}, {"cvode", "erk"}},
      {{INFINITY, INFINITY, INFINITY}, {"cvode", "arkode"}},
  };
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    const char *taken[2];
    reference_methods_take(row[i].cost, taken);
    for (int k = 0; k < 2; k++) assert_string_equal(taken[k], row[i].taken[k]);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_dearer_gives_way_to_what_is_half_as_dear),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
