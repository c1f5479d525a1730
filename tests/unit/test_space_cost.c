/* Whether the space error is estimated goes by what the run has done. */
#include "app/run/space.h"
#include "check.h"

/* Twenty factors pay for the factor that an estimate makes; as many preconditioners do not. */
static void iterations_are_no_factors_for_the_space_error(void **state) {
  (void)state;
  run_work by_factors = {100, 1, 20, 100, 0}, by_iterations = {100, 1, 20, 100, 2500};
  assert_true(space_is_cheap(1.38e6, 738360, &by_factors));
  assert_false(space_is_cheap(1.38e6, 738360, &by_iterations));
  by_iterations.niteration = 250000000;
  assert_true(space_is_cheap(1.38e6, 738360, &by_iterations));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(iterations_are_no_factors_for_the_space_error),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
