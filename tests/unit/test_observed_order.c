/* Three levels of a quantity: the order, and where it is not believed. */
#define TEST_NAME "test_observed_order"
#include "check.h"
#include "study/measure/claim.h"

/* Errors e, e 2^-p, e 4^-p of three levels: what remains at the third is found exactly. */
static void a_power_is_found(void **state) {
  (void)state;
  static const double orders[] = {0.51, 1, 1.5, 2, 2.49};
  for (int i = 0; i < 5; i++) {
    double p = orders[i], e = 0.3, d1 = e * (1 - exp2(-p)), d2 = d1 * exp2(-p);
    convergence c = convergence_observe(d1, d2, 1, 0);
    assert_true(c.asymptotic && !c.why);
    assert_close(c.order, p, 1e-12, 0);
    assert_close(d1 + d2 + d2 * c.remainder, e, 1e-12, 0);
    assert_close(d2 * c.remainder, e * exp2(-2 * p), 1e-12, 0);
  }
}

static void doubts_are_told(void **state) {
  (void)state;
  static const struct {
    double d1, d2, cosine, known;
    const char *why;
  } cases[] = {
      {1, 0.99, 1, 0, "hardly smaller"}, {1, 1, 1, 0, "not smaller"},
      {1, 2, 1, 0, "not smaller"},       {1, 0.1, 1, 0, "faster"},
      {1, 0.5, -0.1, 0, "alternate"},    {1, 0.5, 1, 0.051, "ten times"},
      {0, 0, 1, 1e-14, "ten times"},     {NAN, 0.5, 1, 0, "not known"},
      {1, INFINITY, 1, 0, "not known"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    convergence c = convergence_observe(cases[i].d1, cases[i].d2, cases[i].cosine, cases[i].known);
    assert_false(c.asymptotic);
    assert_close(c.remainder, 0, 0, 0);
    assert_non_null(strstr(c.why, cases[i].why));
  }
}

/* The bounds themselves are believed or not, to the last bit that matters. */
static void the_limits_are_where_they_are_said(void **state) {
  (void)state;
  assert_true(convergence_observe(1, exp2(-CONVERGENCE_LOWEST) * (1 - 1e-12), 1, 0).asymptotic);
  assert_false(convergence_observe(1, exp2(-CONVERGENCE_LOWEST) * (1 + 1e-12), 1, 0).asymptotic);
  assert_true(convergence_observe(1, exp2(-CONVERGENCE_HIGHEST) * (1 + 1e-12), 1, 0).asymptotic);
  assert_false(convergence_observe(1, exp2(-CONVERGENCE_HIGHEST) * (1 - 1e-12), 1, 0).asymptotic);
  assert_true(convergence_observe(1, 0.5, 0, 0.05).asymptotic);
}

/* Ten-node tets may converge faster, and not by any order either. */
static void orders_are_believed_by_the_tets(void **state) {
  (void)state;
  double third = exp2(-3), fifth = exp2(-5);
  assert_false(convergence_observe_of(1, 1, third, 1, 0).asymptotic);
  convergence c = convergence_observe_of(2, 1, third, 1, 0);
  assert_true(c.asymptotic);
  assert_close(c.remainder, 1. / 7, 1e-15, 0);
  c = convergence_observe_of(2, 1, fifth, 1, 0);
  assert_false(c.asymptotic);
  assert_string_equal(c.why, "the levels converge faster than ten-node tets do");
}

/* A number whose levels are L + e, L + e 2^-p, L + e 4^-p tends to L; of two levels, and where the
   order is not believed, the error is at least what they have shown. */
static void numbers_are_claimed(void **state) {
  (void)state;
  const double L = -2, e = 0.1, p = 1.5;
  double q[] = {L + e, L + e * exp2(-p), L + e * exp2(-2 * p)}, limit;
  claim c = {0};
  assert_ok(claim_of_numbers(1, 3, q, 1e-6, &c, &limit));
  assert_close(limit, L, 1e-12, 0);
  claim_scale(&c, fabs(limit));
  claim_bound b = claim_bounds(&c, 0, false);
  assert_int_equal(b.kind, CLAIM_ABOUT);
  assert_close(b.value, e / 2, 1e-12, 0);
  assert_close(b.floor, 10 * 1e-6 / 2, 1e-12, 0);
  assert_true(b.low <= b.value && b.value <= b.high);
  claim_free(&c);

  c = (claim){0};
  assert_ok(claim_of_numbers(1, 2, q, 1e-6, &c, &limit));
  assert_close(limit, q[1], 0, 0);
  assert_int_equal(claim_bounds(&c, 0, false).kind, CLAIM_AT_LEAST);
  assert_close(claim_bounds(&c, 0, false).low, e * (1 - exp2(-p)) - 1e-6, 1e-12, 0);
  claim_free(&c);

  q[2] = q[1] + 0.5 * e; /* they alternate */
  c = (claim){0};
  assert_ok(claim_of_numbers(1, 3, q, 1e-6, &c, &limit));
  assert_close(limit, q[2], 0, 0);
  assert_int_equal(claim_bounds(&c, 0, false).kind, CLAIM_AT_LEAST);
  claim_free(&c);

  c = (claim){0}; /* of no mesh: a difference, which may be below what is known */
  assert_ok(claim_of_numbers(1, 0, q, 0.01, &c, &limit));
  assert_int_equal(claim_bounds(&c, 0, false).kind, CLAIM_AT_MOST);
  claim_free(&c);
  c = (claim){0};
  assert_ok(claim_of_numbers(1, 0, q, NAN, &c, &limit));
  assert_int_equal(claim_bounds(&c, 0, false).kind, CLAIM_UNCHECKED);
  assert_close(claim_bounds(&c, 0, false).value, fabs(q[1] - q[0]), 1e-15, 0);
  claim_free(&c);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_power_is_found),
      cmocka_unit_test(doubts_are_told),
      cmocka_unit_test(the_limits_are_where_they_are_said),
      cmocka_unit_test(orders_are_believed_by_the_tets),
      cmocka_unit_test(numbers_are_claimed),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
