/* What values on ever finer meshes say of the last one's error. */
#define TEST_NAME "test_goal_rule"
#include "check.h"
#include "study/goal/goal_rule.h"

static const double ratios[] = {2, 1.2, 1.3, 1.5, 1.7};
enum { MOST = 12 };

/* Values of limit 1 with errors that fall at an order. */
static void make(double order, double first, double r, goal_level level[MOST]) {
  for (int i = 0; i < MOST; i++) {
    double size = pow(r, -i);
    level[i] = (goal_level){1 - first * pow(size, order), size};
  }
}

/* One power of the size: the error is found, whatever the sizes; and the truth is inside. */
static void a_power_is_found(void **state) {
  (void)state;
  static const double orders[] = {0.6, 1, 1.5, 2, 3, 4, 4.8};
  for (int local = 0; local < 2; local++)
    for (int i = 0; i < 7; i++)
      for (int k = 0; k < 5; k++) {
        goal_level level[MOST];
        make(orders[i], 0.1, ratios[k], level);
        int n = ratios[k] < GOAL_STRIDE ? 7 : 4;
        goal_error e = goal_judge(n, level, NAN, 0, local);
        double error = 1 - level[n - 1].value;
        assert_false(goal_judge(n - 1, level, NAN, 0, local).asymptotic);
        assert_true(e.asymptotic && !e.why && !e.settled && !e.diverging);
        assert_close(e.order, orders[i], 1e-7, 0);
        assert_close(e.estimate, error, 1e-6, 0);
        assert_true(e.half >= GOAL_SAFETY * error * (1 - 1e-6));
      }
}

/* Three meshes always have an order, which proves nothing: the estimate errs on the safe side. */
static void three_meshes_prove_little(void **state) {
  (void)state;
  static const double orders[] = {0.6, 1, 1.5, 2, 3, 4, 4.8};
  for (int i = 0; i < 7; i++)
    for (int k = 0; k < 5; k++) {
      goal_level level[MOST];
      make(orders[i], 0.1, ratios[k], level);
      goal_error e = goal_judge(3, level, NAN, 0, false);
      double error = 1 - level[2].value;
      assert_false(e.asymptotic);
      assert_non_null(strstr(e.why, "fourth"));
      if (orders[i] >= 3)
        assert_close(e.estimate, error, 1e-7, 0);
      else
        assert_true(e.estimate > error && e.estimate < 1.3 * error);
      assert_true(e.half >= GOAL_SAFETY * error * (1 - 1e-7));
    }
}

/* Sizes need not be in one ratio. */
static void ratios_may_differ(void **state) {
  (void)state;
  const double size[4] = {1, 0.7, 0.35, 0.2};
  goal_level level[4];
  for (int i = 0; i < 4; i++) level[i] = (goal_level){2 + 0.3 * pow(size[i], 1.4), size[i]};
  goal_error e = goal_judge(4, level, NAN, 0, false);
  assert_true(e.asymptotic);
  assert_close(e.order, 1.4, 1e-8, 0);
  assert_close(e.estimate, 2 - level[3].value, 1e-7, 0);
}

/* Where values are called asymptotic, the estimate is 0.8 to 1.3 times the error, whatever two
   powers of one sign they are a sum of. (Of two signs the error may be none at all on one mesh.) */
static void asymptotic_estimates_are_near(void **state) {
  (void)state;
  int claimed = 0;
  for (int share = 0; share <= 100; share++)
    for (int k = 0; k < 5; k++) {
      goal_level level[MOST];
      for (int i = 0; i < MOST; i++) {
        double size = pow(ratios[k], -i);
        double error = 0.01 * share * pow(size, 1.2) + pow(size, 3);
        level[i] = (goal_level){1 - 0.1 * error, size};
      }
      for (int n = 4; n <= MOST; n++) {
        goal_error e = goal_judge(n, level, NAN, 0, false);
        double error = 1 - level[n - 1].value;
        claimed += e.asymptotic;
        if (e.asymptotic) assert_true(e.estimate / error > 0.8 && e.estimate / error < 1.3);
      }
    }
  assert_true(claimed > 1000);
}

/* A smooth part of order 4 that is the larger one to begin with, and a singular one of order 1.2
   that remains: the truth is inside all the same. */
static void two_powers_stay_inside(void **state) {
  (void)state;
  for (int share = 0; share <= 100; share++)
    for (int k = 0; k < 5; k++) {
      goal_level level[3];
      double singular = 0.001 * share;
      for (int i = 0; i < 3; i++) {
        double size = pow(ratios[k], -i);
        double error = singular * pow(size, 1.2) + (0.1 - singular) * pow(size, 4);
        level[i] = (goal_level){1 - error, size};
      }
      goal_error e = goal_judge(3, level, NAN, 0, false);
      assert_true(e.half >= 1.2 * (1 - level[2].value));
    }
}

static void doubts_are_told(void **state) {
  (void)state;
  static const struct {
    double value[3];
    bool diverging;
    const char *why;
  } cases[] = {
      {{1, 2, 1.5}, false, "alternate"},  {{1, 2, 3.5}, true, "do not settle"},
      {{1, 2, 3}, true, "do not settle"}, {{1, 2, 2.9}, false, "hardly"},
      {{1, 2, 2.01}, false, "faster"},    {{NAN, 2, 2.5}, false, "no value"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    goal_level level[3];
    for (int k = 0; k < 3; k++) level[k] = (goal_level){cases[i].value[k], exp2(-k)};
    goal_error e = goal_judge(3, level, NAN, 0, false);
    assert_false(e.asymptotic);
    assert_int_equal(e.diverging, cases[i].diverging);
    assert_non_null(strstr(e.why, cases[i].why));
    double d = fabs(cases[i].value[2] - cases[i].value[1]);
    assert_true(e.half >= GOAL_SAFETY_UNPROVEN * d);
    assert_true(isnan(e.estimate));
  }
}

/* One mesh is known by the four-node tets on it, or by nothing; two, by three times what the second
   has changed. */
static void few_meshes_prove_little(void **state) {
  (void)state;
  const goal_level level[2] = {{1, 1}, {1.1, 0.5}};
  goal_error one = goal_judge(1, level, 0.6, 0, false), none = goal_judge(1, level, NAN, 0, false),
             two = goal_judge(2, level, 0.6, 0, false);
  assert_false(one.asymptotic || none.asymptotic || two.asymptotic);
  assert_close(one.half, GOAL_SAFETY_ALONE * 0.4, 1e-15, 0);
  assert_true(isinf(none.half));
  assert_close(two.half, 0.3, 1e-14, 0);
}

/* Values that differ by less than each is known by do not differ. */
static void noise_is_no_convergence(void **state) {
  (void)state;
  const goal_level level[3] = {{1, 1}, {1 + 1e-6, 0.5}, {1 - 1e-6, 0.25}};
  goal_error e = goal_judge(3, level, NAN, 1e-5, false);
  assert_true(e.settled && e.asymptotic);
  assert_true(e.half >= 1e-5);
  e = goal_judge(3, level, NAN, 1e-7, false);
  assert_false(e.settled || e.asymptotic);
}

/* What falls too fast for its order, but no more so than the values are known by, is no doubt. */
static void a_fast_fall_may_be_noise(void **state) {
  (void)state;
  const goal_level level[3] = {{1, 1}, {1.1, 0.5}, {1.1005, 0.25}};
  assert_non_null(strstr(goal_judge(3, level, NAN, 0, false).why, "faster"));
  assert_non_null(strstr(goal_judge(3, level, NAN, 2e-3, false).why, "faster"));
  goal_error e = goal_judge(3, level, NAN, 5e-3, false);
  assert_non_null(strstr(e.why, "fourth"));
  assert_true(e.half >= GOAL_SAFETY * 5e-3 / (exp2(GOAL_CAUTIOUS_ORDER) - 1));
}

/* A fourth mesh that leads elsewhere is none either. */
static void limits_have_to_agree(void **state) {
  (void)state;
  for (int local = 0; local < 2; local++) {
    goal_level level[MOST];
    make(2, 0.1, 1.5, level);
    assert_true(goal_judge(4, level, NAN, 0, local).asymptotic);
    level[3].value = level[2].value + 0.6 * (level[3].value - level[2].value);
    goal_error e = goal_judge(4, level, NAN, 0, local);
    assert_false(e.asymptotic);
    assert_non_null(strstr(e.why, "same limit"));
  }
}

/* Where values have once gone the other way, what they seem to tend to is not believed. */
static void a_turn_is_remembered(void **state) {
  (void)state;
  const goal_level level[5] = {
      {0.018594, 1}, {0.019076, 0.8}, {0.018833, 0.64}, {0.018718, 0.5}, {0.018672, 0.4}};
  goal_error e = goal_judge(5, level, NAN, 0, true);
  assert_false(e.asymptotic);
  assert_non_null(strstr(e.why, "turned"));
  assert_true(e.half > 0.018672 - 0.018506); /* what finer meshes tend to */
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_power_is_found),          cmocka_unit_test(ratios_may_differ),
      cmocka_unit_test(two_powers_stay_inside),    cmocka_unit_test(doubts_are_told),
      cmocka_unit_test(few_meshes_prove_little),   cmocka_unit_test(noise_is_no_convergence),
      cmocka_unit_test(a_fast_fall_may_be_noise),  cmocka_unit_test(limits_have_to_agree),
      cmocka_unit_test(three_meshes_prove_little), cmocka_unit_test(asymptotic_estimates_are_near),
      cmocka_unit_test(a_turn_is_remembered),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
