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

/* What would end a run for want of memory, when all of it is there but the last file, is left out.
 */
static void it_is_not_begun_without_the_memory(void **state) {
  (void)state;
  assert_true(space_fits(9e5, 24e9));
  assert_false(space_fits(1.38e6, 24e9));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(it_is_not_begun_without_the_memory),
      cmocka_unit_test(iterations_are_no_factors_for_the_space_error),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
