/* Numbers as text: to the last character what printf makes of them. */
#include <stdio.h>

#include "app/text/number_text.h"
#include "solid.h"

static void assert_like_printf(double x) {
  char text[NUMBER_TEXT], expected[64];
  size_t length = number_text(x, text);
  snprintf(expected, sizeof expected, "%.17g", x);
  assert_string_equal(text, expected);
  assert_int_equal(length, strlen(expected));
}

static void special_numbers(void **state) {
  (void)state;
  const double x[] = {0,
                      -0.0,
                      1,
                      -1,
                      0.1,
                      0.5,
                      1e16,
                      1e17,
                      99999999999999984,
                      1e-4,
                      9.9999999999999991e-05,
                      1e-5,
                      123.5,
                      1e22,
                      1e23,
                      5e-324,
                      2.2250738585072014e-308,
                      1.7976931348623157e308,
                      INFINITY,
                      -INFINITY};
  for (size_t i = 0; i < sizeof x / sizeof *x; i++) assert_like_printf(x[i]);
  char text[NUMBER_TEXT];
  number_text(NAN, text);
  assert_non_null(strstr(text, "nan"));
}

/* Every power of ten and of two, their neighbours, and multiples. */
static void powers(void **state) {
  (void)state;
  for (int k = -323; k <= 308; k++)
    for (int d = 1; d < 10; d++) {
      char text[32];
      snprintf(text, sizeof text, "%de%d", d, k);
      double x = strtod(text, NULL);
      assert_like_printf(x);
      assert_like_printf(nextafter(x, 0));
      assert_like_printf(-nextafter(x, INFINITY));
    }
  for (int k = -1074; k < 1024; k++) {
    assert_like_printf(ldexp(1, k));
    assert_like_printf(nextafter(ldexp(1, k), 0));
  }
}

/* Any bits, whole numbers, and decimals of few digits. */
static void random_numbers(void **state) {
  (void)state;
  uint64_t seed = 1;
  for (int i = 0; i < 300000; i++) {
    double x = noise(&seed);
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    bits ^= (uint64_t)(noise(&seed) * 1e18) << 5;
    double any;
    memcpy(&any, &bits, sizeof any);
    if (isfinite(any)) assert_like_printf(any);
    assert_like_printf(x);
    assert_like_printf(x * pow(10, 300 * noise(&seed)));
    assert_like_printf(floor(x * 1e6));
    assert_like_printf(floor(x * 1e6) / 1000);
    assert_like_printf(floor(x * 9e15));
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(special_numbers),
      cmocka_unit_test(powers),
      cmocka_unit_test(random_numbers),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
