/* Ticks, escaping, and charts of whatever comes. */
#include <stdio.h>

#include "check.h"
#include "report/chart/chart.h"
#include "report/chart/ticks.h"
#include "report/page/markup.h"

static int labelled(int n, const tick *ticks) {
  int count = 0;
  for (int i = 0; i < n; i++) count += ticks[i].label[0] != '\0';
  return count;
}

static void assert_labels(axis_range range, int most, int n, const char *const *label) {
  tick ticks[TICKS_MAX];
  int count = axis_ticks(&range, most, ticks), k = 0;
  for (int i = 0; i < count; i++) {
    if (!ticks[i].label[0]) continue;
    if (k < n) assert_string_equal(ticks[i].label, label[k]);
    k++;
  }
  assert_int_equal(k, n);
}

static void linear_ticks_are_round(void **state) {
  (void)state;
  assert_labels((axis_range){0, 40, false}, 5, 5, (const char *[]){"0", "10", "20", "30", "40"});
  assert_labels((axis_range){-0.21, 0.42, false}, 7, 7,
                (const char *[]){"-0.2", "-0.1", "0", "0.1", "0.2", "0.3", "0.4"});
  assert_labels((axis_range){0.9, 1.13, false}, 5, 5,
                (const char *[]){"0.90", "0.95", "1.00", "1.05", "1.10"});
  assert_labels((axis_range){0, 4.1e-6, false}, 5, 5,
                (const char *[]){"0", "1e-6", "2e-6", "3e-6", "4e-6"});
  assert_labels((axis_range){0.99e9, 1.05e9, false}, 4, 3,
                (const char *[]){"1.00e9", "1.02e9", "1.04e9"});
}

static void logarithmic_ticks_are_decades_and_what_is_between(void **state) {
  (void)state;
  tick ticks[TICKS_MAX];
  assert_labels((axis_range){0.5e-2, 2e1, true}, 8, 4,
                (const char *[]){"10^-2", "10^-1", "1", "10"});
  /* 5 to 9 e-3, then 9 in each of three decades, then 10 and 20 */
  assert_int_equal(axis_ticks(&(axis_range){0.5e-2, 2e1, true}, 8, ticks), 5 + 3 * 9 + 2);
  assert_labels((axis_range){1e-12, 1e0, true}, 7, 7,
                (const char *[]){"10^-12", "10^-10", "10^-8", "10^-6", "10^-4", "10^-2", "1"});
  assert_labels((axis_range){0.15, 0.9, true}, 7, 2, (const char *[]){"0.2", "0.5"});
  assert_labels((axis_range){2.11, 2.34, true}, 5, 4,
                (const char *[]){"2.15", "2.20", "2.25", "2.30"});
}

/* All ranges that the numbers of a chart may have: some labels, no more than asked for, in order
   and within the range. */
static void any_range_has_ticks(void **state) {
  (void)state;
  const double end[] = {-1e300, -1e20,     -1, -1e-300,   0,   1e-300,
                        3e-9,   0.9999999, 1,  1.0000001, 7e5, 1e300};
  int nend = (int)(sizeof end / sizeof *end);
  for (int log = 0; log < 2; log++)
    for (int a = 0; a < nend; a++)
      for (int b = 0; b < nend; b++) {
        axis_range range = axis_range_of(2, (double[]){end[a], end[b]}, log);
        assert_true(range.low < range.high);
        if (log) assert_true(range.low > 0);
        assert_close(axis_place(&range, range.low), 0, 0, 1e-12);
        assert_close(axis_place(&range, range.high), 1, 0, 1e-12);
        for (int most = 4; most < 10; most++) {
          tick ticks[TICKS_MAX];
          int n = axis_ticks(&range, most, ticks);
          assert_in_range(n, 1, TICKS_MAX);
          assert_in_range(labelled(n, ticks), 1, most + 1);
          for (int i = 0; i < n; i++) {
            assert_true(ticks[i].at >= range.low && ticks[i].at <= range.high);
            if (i) assert_true(ticks[i].at > ticks[i - 1].at);
          }
        }
      }
}

static void a_range_holds_what_an_axis_takes(void **state) {
  (void)state;
  const double x[] = {NAN, 1, INFINITY, 100, -INFINITY, 0, -5};
  axis_range linear = axis_range_of(7, x, false), log = axis_range_of(7, x, true);
  assert_true(linear.low < -5 && linear.low > -20 && linear.high > 100 && linear.high < 120);
  assert_true(log.low < 1 && log.low > 0.5 && log.high > 100 && log.high < 200);
  axis_range none = axis_range_of(1, x, true);
  assert_true(none.low > 0 && none.low < none.high);
}

static void assert_text(const char *text, int most, const char *expected) {
  char *written = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&written, &size);
  if (most)
    markup_text_cut(out, text, most);
  else
    markup_text(out, text);
  fclose(out);
  assert_string_equal(written, expected);
  free(written);
}

static void text_is_escaped(void **state) {
  (void)state;
  assert_text("a<b> & \"c\" 'd'", 0, "a&lt;b&gt; &amp; &quot;c&quot; &#39;d&#39;");
  assert_text("caf\xc3\xa9 \xf0\x9f\x98\x80 \xe2\x80\x94", 0,
              "caf\xc3\xa9 \xf0\x9f\x98\x80 \xe2\x80\x94");
  assert_text("\x01\x1b[\x7f\r", 0, "??[??");
  assert_text("\xff\xc3(\xe2\x82", 0,
              "?"
              "?(?"
              "?");                                               /* no UTF-8, cut short */
  assert_text("\xc0\xaf\xed\xa0\x80\xef\xbf\xbf", 0, "????????"); /* overlong, surrogate, U+FFFF */
  assert_text(NULL, 0, "");
  assert_text("abcdef", 6, "abcdef");
  assert_text("abc<ef", 5, "abc&lt;\xe2\x80\xa6");
  assert_int_equal(markup_length("caf\xc3\xa9<"), 5);
}

static char *drawn(const chart *c) {
  char *svg = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&svg, &size);
  chart_write(c, out);
  fclose(out);
  return svg;
}

static int count(const char *text, const char *word) {
  int n = 0;
  for (const char *at = text; (at = strstr(at, word)); at++) n++;
  return n;
}

/* A mark for each point and one in the legend; what cannot be drawn is counted instead. */
static void each_point_is_drawn_or_counted(void **state) {
  (void)state;
  const double x[] = {1, 10, 100, 1000, -1}, y[] = {1e-1, 0, 1e-3, NAN, 1e-5};
  chart_series s[] = {{"first", 5, x, y, NULL, NULL}, {"<second>", 3, x, x, x, x}};
  chart c = {"title", NULL, {"x [m]", true}, {"y [s]", true}, 2, s, 1e-4, "floor"};
  assert_int_equal(chart_skipped(&c), 3);
  char *svg = drawn(&c);
  assert_int_equal(count(svg, "class=\"mark\""), 2 + 3 + 2);
  assert_int_equal(count(svg, "class=\"bar\""), 3);
  assert_int_equal(count(svg, "class=\"floor\""), 1);
  assert_int_equal(count(svg, "3 points not drawn"), 1);
  assert_int_equal(count(svg, "<second>"), 0);
  assert_int_equal(count(svg, "&lt;second&gt;"), 2); /* in full, and as the legend has room */
  free(svg);

  c.x.log = c.y.log = false;
  assert_int_equal(chart_skipped(&c), 1);
}

/* Whatever the numbers, no coordinate is written that is none. */
static void charts_of_anything_are_charts(void **state) {
  (void)state;
  const double odd[] = {0,      -0.0,  1,        -1,        1e308, -1e308,    5e-324, 1e-310,
                        1e-300, 1e300, INFINITY, -INFINITY, NAN,   1 + 1e-15, 1,      -3};
  srand(1);
  for (int trial = 0; trial < 2000; trial++) {
    double x[8], y[8], low[8], high[8];
    for (int i = 0; i < 8; i++) {
      double *to[] = {x, y, low, high};
      for (int k = 0; k < 4; k++) to[k][i] = odd[rand() % 16];
    }
    chart_series s[12] = {0};
    int nseries = rand() % 12;
    for (int k = 0; k < nseries; k++)
      s[k] = (chart_series){"s", rand() % 9, x, y, rand() % 2 ? low : NULL, high};
    chart c = {rand() % 2 ? "t" : NULL, NULL, {"x", rand() % 2}, {"y", rand() % 2}, nseries, s,
               odd[rand() % 16],        NULL};
    char *svg = drawn(&c);
    assert_null(strstr(svg, "nan"));
    assert_null(strstr(svg, "inf"));
    assert_non_null(strstr(svg, "</svg>"));
    assert_in_range(count(svg, "class=\"tick\""), 2, 20);
    free(svg);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(linear_ticks_are_round),
      cmocka_unit_test(logarithmic_ticks_are_decades_and_what_is_between),
      cmocka_unit_test(any_range_has_ticks),
      cmocka_unit_test(a_range_holds_what_an_axis_takes),
      cmocka_unit_test(text_is_escaped),
      cmocka_unit_test(each_point_is_drawn_or_counted),
      cmocka_unit_test(charts_of_anything_are_charts),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
