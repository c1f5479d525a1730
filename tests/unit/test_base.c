/* Status and message. */
#include <pthread.h>
#include "check.h"

static void message_is_empty_at_first(void **state) {
  (void)state;
  assert_string_equal(corot_error(), "");
}

static void failure_returns_its_status_and_keeps_the_message(void **state) {
  (void)state;
  assert_int_equal(corot_fail(COROT_EINVAL, "tet %d: volume %g", 12, -3e-9), COROT_EINVAL);
  assert_string_equal(corot_error(), "tet 12: volume -3e-09");
}

static void old_message_may_be_an_argument_of_the_new(void **state) {
  (void)state;
  corot_fail(COROT_EFORMAT, "no number");
  corot_fail(COROT_EFORMAT, "bar.msh:3: %s", corot_error());
  assert_string_equal(corot_error(), "bar.msh:3: no number");
}

static void long_message_is_cut(void **state) {
  (void)state;
  char text[9000];
  memset(text, 'x', sizeof text - 1);
  text[sizeof text - 1] = 0;
  corot_fail(COROT_EINVAL, "%s", text);
  assert_int_equal(strlen(corot_error()), 4095);
}

static void *fail_elsewhere(void *arg) {
  (void)arg;
  corot_fail(COROT_EINVAL, "elsewhere");
  return NULL;
}

static void message_belongs_to_its_thread(void **state) {
  (void)state;
  pthread_t thread;
  corot_fail(COROT_EINVAL, "here");
  assert_int_equal(pthread_create(&thread, NULL, fail_elsewhere, NULL), 0);
  pthread_join(thread, NULL);
  assert_string_equal(corot_error(), "here");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(message_is_empty_at_first),
      cmocka_unit_test(failure_returns_its_status_and_keeps_the_message),
      cmocka_unit_test(old_message_may_be_an_argument_of_the_new),
      cmocka_unit_test(long_message_is_cut),
      cmocka_unit_test(message_belongs_to_its_thread),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
