/* Which of many steps have a row in steps.csv. */
#include "app/run/steps_kept.h"
#include "check.h"

/* Rows of so many steps without events. */
static long rows_of(long steps) {
  long rows = 0;
  for (long n = 1; n <= steps; n++) rows += thin_keeps(n, 0);
  return rows;
}

static void a_factor_of_ten_in_steps_adds_nine_thousand_rows(void **state) {
  (void)state;
  const long steps[] = {1, 9999, 10000, 100000, 1000000};
  const long rows[] = {1, 9999, 10000, 19000, 28000};
  for (int i = 0; i < 5; i++) assert_int_equal(rows_of(steps[i]), rows[i]);
  assert_false(thin_keeps(10001, 0));
  assert_true(thin_keeps(10010, 0));
  assert_false(thin_keeps(100010, 0));
}

static void what_happens_at_a_step_keeps_it(void **state) {
  (void)state;
  const unsigned kept[] = {EVENT_KINK,     EVENT_RESTART,    EVENT_FAILED,
                           EVENT_REJECTED, EVENT_CHECKPOINT, EVENT_FRAMES | EVENT_RESTART};
  for (int i = 0; i < 6; i++) assert_true(thin_keeps(123457, kept[i]));
  assert_false(thin_keeps(123457, EVENT_FRAMES)); /* may come with each step */
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_factor_of_ten_in_steps_adds_nine_thousand_rows),
      cmocka_unit_test(what_happens_at_a_step_keeps_it),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
