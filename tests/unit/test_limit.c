/* The search for the end of stability, on laws that are known. */
#include <math.h>

#include "check.h"
#include "study/measure/limit.h"

typedef struct law {
  double limit;    /* stable up to it */
  double from, to; /* and again in here */
  int ntry;
} law;

static corot_status try_law(void *context, int n, limit_trial *trial) {
  law *l = context;
  l->ntry += n;
  for (int i = 0; i < n; i++) {
    double x = trial[i].value;
    trial[i].stable = x <= l->limit || (x >= l->from && x <= l->to);
  }
  return COROT_OK;
}

static const limit_def from_1_to_1000 = {.from = 1, .to = 1000, .nscan = 4, .precision = 0.01};

static void a_limit_is_enclosed(void **state) {
  (void)state;
  const double limits[] = {1, 1.7, 9.9999, 10, 31.4, 999};
  for (int i = 0; i < 6; i++) {
    law l = {.limit = limits[i]};
    limit_result r;
    assert_ok(limit_find(&from_1_to_1000, try_law, &l, &r));
    assert_true(r.stable <= limits[i] && r.unstable > limits[i]);
    assert_true(r.unstable / r.stable <= 1.01);
    assert_int_equal(r.ntrial, l.ntry);
    /* Four of the scan, and a decade is halved (in ratios) 8 times: 10^(1/256) - 1 < 0.01. */
    assert_int_equal(l.ntry, 4 + 8);
    for (int k = 1; k < r.ntrial; k++) assert_true(r.trial[k].value > r.trial[k - 1].value);
    assert_int_equal(r.nreturn, 0);
  }
}

static void no_limit_in_the_range(void **state) {
  (void)state;
  law all = {.limit = 1000}, none = {.limit = 0.5};
  limit_result r;
  assert_ok(limit_find(&from_1_to_1000, try_law, &all, &r));
  assert_true(r.stable == 1000 && isinf(r.unstable) && r.ntrial == 4);
  assert_ok(limit_find(&from_1_to_1000, try_law, &none, &r));
  assert_true(r.stable == 0 && r.unstable == 1 && r.ntrial == 4);
}

static void a_return_to_stability_is_told(void **state) {
  (void)state;
  law l = {.limit = 5, .from = 90, .to = 2000};
  limit_result r;
  assert_ok(limit_find(&from_1_to_1000, try_law, &l, &r));
  assert_true(r.stable <= 5 && r.unstable > 5 && r.unstable < 5.1);
  assert_int_equal(r.nreturn, 2); /* 100 and 1000 */
}

/* The scan succeeds, what comes after it does not. */
static corot_status fail_later(void *context, int n, limit_trial *trial) {
  (void)context;
  trial[0].stable = true;
  return n > 1 ? COROT_OK : corot_fail(COROT_EIO, "no space left");
}

static void what_makes_no_sense_is_refused(void **state) {
  (void)state;
  limit_result r;
  assert_fails(limit_find(&from_1_to_1000, fail_later, NULL, &r), COROT_EIO, "no space left");
  const struct {
    limit_def def;
    const char *message;
  } bad[] = {
      {{0, 1, 4, 0.01}, "from 0 to 1: expected 0 < from < to"},
      {{2, 1, 4, 0.01}, "from 2 to 1"},
      {{1, INFINITY, 4, 0.01}, "from 1 to inf"},
      {{NAN, 1, 4, 0.01}, "0 < from < to"},
      {{1, 2, 1, 0.01}, "a scan of 1 values"},
      {{1, 2, 65, 0.01}, "a scan of 65 values"},
      {{1, 2, 4, 0}, "precision 0"},
      {{1, 2, 4, NAN}, "precision nan"},
  };
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    law l = {.limit = 1};
    assert_fails(limit_find(&bad[i].def, try_law, &l, &r), COROT_EINVAL, bad[i].message);
    assert_int_equal(l.ntry, 0);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_limit_is_enclosed),
      cmocka_unit_test(no_limit_in_the_range),
      cmocka_unit_test(a_return_to_stability_is_told),
      cmocka_unit_test(what_makes_no_sense_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
