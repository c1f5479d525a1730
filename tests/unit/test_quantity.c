/* Quantities: what their text may be, and what they make of columns whose answers are known. */
#include <stdio.h>

#include "alloc.h"
#include "app/quantity/cubic.h"
#include "app/quantity/meter.h"
#include "check.h"

#define PI 3.14159265358979323846

/* --- Text --- */

static const struct {
  const char *text, *printed, *name;
} good[] = {
    {"corner.ux@end", "corner.ux@end", "corner_ux_at_end"},
    {" corner.ux @ 1.5 ", "corner.ux@1.5", "corner_ux_at_1_5"},
    {"elastic@0", "elastic@0", "elastic_at_0"},
    {"max(corner.ux)", "max(corner.ux)", "max_corner_ux"},
    {"max(corner.ux, 0, end)", "max(corner.ux)", "max_corner_ux"},
    {"min( tip-2.fx , 1e-3 , 2.5E+1 )", "min(tip-2.fx, 0.001, 25)", "min_tip-2_fx_0_001_25"},
    {"mean(kinetic,0.1,0.3)", "mean(kinetic, 0.1, 0.3)", "mean_kinetic_0_1_0_3"},
    {"integral(a_b.value,.5,end)", "integral(a_b.value, 0.5, end)", "integral_a_b_value_0_5_end"},
    {"amplitude(3.ux)", "amplitude(3.ux)", "amplitude_3_ux"},
    {"period(corner.ux, 1, 2)", "period(corner.ux, 1, 2)", "period_corner_ux_1_2"},
    {"when(max(corner.ux))", "when(max(corner.ux))", "when_max_corner_ux"},
    {"when( min (abs(corner.ux), 1, 2) )", "when(min(abs(corner.ux), 1, 2))",
     "when_min_abs_corner_ux_1_2"},
    {"max(abs(corner.ux))", "max(abs(corner.ux))", "max_abs_corner_ux"},
    {"abs(min(corner.ux))", "abs(min(corner.ux))", "abs_min_corner_ux"},
    {"abs(corner.ux)@end", "abs(corner.ux)@end", "abs_corner_ux_at_end"},
    {"abs(corner.ux@2)", "abs(corner.ux@2)", "abs_corner_ux_at_2"},
    {"abs(mean(abs(corner.ux)))", "abs(mean(abs(corner.ux)))", "abs_mean_abs_corner_ux"},
    {"max.ux@end", "max.ux@end", "max_ux_at_end"},      /* a probe may be called max, */
    {"abs(abs)@end", "abs(abs)@end", "abs_abs_at_end"}, /* or abs */
    {"max(c, 0.1000000000000001, end)", "max(c, 0.1000000000000001, end)",
     "max_c_0_1000000000000001_end"},
};

static void text_is_read_and_printed(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
    quantity q, again;
    size_t at;
    char printed[QUANTITY_TEXT], twice[QUANTITY_TEXT], name[QUANTITY_TEXT];
    assert_ok(quantity_parse(good[i].text, &q, &at));
    quantity_print(&q, printed);
    assert_string_equal(printed, good[i].printed);
    quantity_name(&q, name);
    assert_string_equal(name, good[i].name);
    /* and means the same */
    assert_ok(quantity_parse(printed, &again, &at));
    quantity_print(&again, twice);
    assert_string_equal(twice, printed);
    assert_true(q.from == again.from && q.to == again.to && q.operation == again.operation);
    assert_true(q.when == again.when && q.magnitude == again.magnitude);
    assert_true(q.absolute == again.absolute);
  }
}

/* The caret stands under the character that is wrong; a + is no part of these texts. */
static const struct {
  const char *text, *caret, *words;
} bad[] = {
    {"", "^", "a quantity, such as max(corner.ux) or corner.ux@end is missing"},
    {"   ", "   ^", "is missing"},
    {"corner.ux", "         ^", "a column alone is no number: corner.ux@end"},
    {"(corner.ux)", "^", "expected a quantity"},
    {"mx(corner.ux)", "^", "no function mx; did you mean max?"},
    {"average(corner.ux)", "^", "no function average; there are max, min"},
    {"Max(corner.ux)", "^", "did you mean max?"},
    {"max corner.ux", "    ^", "expected @ or ( behind a name, found c"},
    {"max()", "    ^", "expected a column"},
    {"max(corner.ux", "             ^", "a text with commas wants quotes"},
    {"max(corner.ux]", "             ^", "expected ) or a comma, found ]"},
    {"max(corner.ux,", "              ^", "a time in seconds, or end is missing"},
    {"max(corner.ux, 1)", "                ^", "expected a comma and the end of the window"},
    {"max(corner.ux, 1, )", "                  ^", "expected a time in seconds, or end, found )"},
    {"max(corner.ux, 2, 1)", "                  ^", "the window is empty: it begins at 2 s"},
    {"max(corner.ux, 1, 1)", "                  ^", "the window is empty"},
    {"max(corner.ux, end, end)", "                    ^", "the window is empty"},
    {"max(corner.ux, -1, 1)", "               ^", "-1 s is before the run"},
    {"max(corner.ux, 1s, 2)", "               ^",
     "a time in seconds, such as 1.5, or end, found 1s"},
    {"max(corner.ux, 1, 2, 3)", "                   ^", "expected ), found ,"},
    {"max(corner.ux))", "              ^", "expected nothing more, found )"},
    {"max(max(corner.ux))", "    ^", "max(..) is no column"},
    {"mean(when(max(x)))", "     ^", "when(..) is no column"},
    {"corner.ux@", "          ^", "a time in seconds, or end is missing"},
    {"corner.ux@start", "          ^", "or end, found start"},
    {"corner.ux@1e999", "          ^", "expected a time in seconds"},
    {"corner.ux@0x10", "          ^", "expected a time in seconds"},
    {"corner.ux@end, 1", "             ^", "expected nothing more, found ,"},
    {"@end", "^", "expected a quantity"},
    {"when(corner.ux)", "     ^", "when is of max(..) or of min(..)"},
    {"when(mean(corner.ux))", "     ^", "when is of max(..) or of min(..)"},
    {"when(max(corner.ux)", "                   ^", "a ) is missing"},
    {"when(max(corner.ux), 1, 2)", "                   ^", "expected ), found ,"},
    {"abs(corner.ux)", "              ^", "a column alone is no number"},
    {"abs(when(max(x)))", "    ^", "when cannot stand here"},
    {"abs(abs(x@end))", "    ^", "abs cannot stand here"},
    {"max(abs(abs(x)))", "           ^", "expected ), found ("},
    {"abs()", "    ^", "expected a column"},
    {"corner ux@end", "       ^", "expected @ or ( behind a name, found u"},
    {"ma\xc3\xa4(x)", "  ^", "expected @ or ( behind a name"},
    {"max(x;y)", "     ^", "expected ) or a comma, found ;"},
};

static void what_is_wrong_is_pointed_at(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    quantity q = {.column = 7};
    size_t at = 99;
    corot_status status = quantity_parse(bad[i].text, &q, &at);
    if (status != COROT_EFORMAT || !strstr(corot_error(), bad[i].words))
      fail_msg("'%s': '%s' lacks '%s'", bad[i].text, corot_error(), bad[i].words);
    assert_int_equal(q.column, 7); /* nothing is set */
    if (at != strlen(bad[i].caret) - 1)
      fail_msg("'%s': at %zu, expected %zu: %s", bad[i].text, at, strlen(bad[i].caret) - 1,
               corot_error());
    /* the same as a message with a caret */
    char tail[300];
    snprintf(tail, sizeof tail, "\n  %s\n  %s", bad[i].text, bad[i].caret);
    assert_int_equal(quantity_point("--quantity", bad[i].text, at), COROT_EFORMAT);
    assert_int_equal(strncmp(corot_error(), "--quantity: ", 12), 0);
    assert_non_null(strstr(corot_error(), tail));
  }
}

static void a_long_text_is_refused(void **state) {
  (void)state;
  char text[QUANTITY_MOST + 2], printed[QUANTITY_TEXT];
  quantity q;
  size_t at;
  memset(text, 'x', sizeof text);
  text[QUANTITY_MOST + 1] = '\0';
  assert_fails(quantity_parse(text, &q, &at), COROT_EFORMAT, "at most 200 characters");
  assert_int_equal(at, QUANTITY_MOST);
  memcpy(text + QUANTITY_MOST - 4, "@end", 5);
  assert_ok(quantity_parse(text, &q, &at));
  quantity_print(&q, printed);
  assert_string_equal(printed, text);
  /* the longest that is printed longer than it is written */
  snprintf(text, sizeof text, "max(%0*d,1e-300,1e300)", QUANTITY_MOST - 18, 0);
  assert_ok(quantity_parse(text, &q, &at));
  quantity_print(&q, printed);
  assert_true(strlen(printed) < QUANTITY_TEXT - 1 && printed[strlen(printed) - 1] == ')');
}

static void columns_are_found(void **state) {
  (void)state;
  static const char *const name[] = {"corner.ux", "corner.uy", "elastic"};
  quantity q;
  size_t at;
  assert_ok(quantity_parse("max(corner.uy)", &q, &at));
  assert_ok(quantity_resolve(&q, 3, name, &at));
  assert_int_equal(q.column, 1);
  assert_ok(quantity_parse("abs(  cornr.uy)@end", &q, &at));
  assert_fails(quantity_resolve(&q, 3, name, &at), COROT_EFORMAT,
               "no column cornr.uy; did you mean corner.uy?");
  assert_int_equal(at, 6);
  assert_ok(quantity_parse("max(temperature)", &q, &at));
  assert_fails(quantity_resolve(&q, 3, name, &at), COROT_EFORMAT,
               "there are: corner.ux, corner.uy, elastic");
  assert_int_equal(at, 4);
}

static void windows_are_within_the_run(void **state) {
  (void)state;
  static const struct {
    const char *text, *words;
    size_t at;
  } outside[] = {
      {"max(x, 0, 2.1)", "t = 2.1 s is after the run, which ends at 2 s", 10},
      {"x@2.1", "t = 2.1 s is after the run", 2},
      {"max(x, 2, end)", "the window is empty: it begins at 2 s, and the run ends at 2 s", 7},
  };
  static const char *const inside[] = {"max(x, 0, 2)", "x@2", "x@0", "x@end", "max(x, 1.9, end)"};
  quantity q;
  size_t at;
  for (size_t i = 0; i < sizeof outside / sizeof *outside; i++) {
    assert_ok(quantity_parse(outside[i].text, &q, &at));
    assert_fails(quantity_check_window(&q, 2, &at), COROT_EFORMAT, outside[i].words);
    assert_int_equal(at, outside[i].at);
  }
  for (size_t i = 0; i < sizeof inside / sizeof *inside; i++) {
    assert_ok(quantity_parse(inside[i], &q, &at));
    assert_ok(quantity_check_window(&q, 2, &at));
  }
}

/* --- Columns --- */

/* A column as a function of time, with its derivative. */
typedef double function(double t, double *rate);

static double decay = 0.4, omega = 7, phase, height = 0.3;

static double damped(double t, double *rate) {
  double s = sin(omega * t + phase), c = cos(omega * t + phase), e = exp(-decay * t);
  *rate = e * (omega * c - decay * s);
  return height + e * s;
}

static double ramp(double t, double *rate) {
  *rate = -2;
  return 3 - 2 * t;
}

static double level(double t, double *rate) {
  (void)t;
  *rate = 0;
  return 1.25;
}

static double bent(double t,
                   double *rate) { /* bends at t = 1, where the derivative is that before */
  *rate = t <= 1 ? 1 : -3;
  return t < 1 ? t : 1 - 3 * (t - 1);
}

/* Steps of a run to `end` that are all of one length, or grow and shrink by a fifth as an
   integrator's do. */
static double step_end(int k, int n, double end, bool even) {
  double s = (double)k / n;
  return even ? end * s : end * (s + 0.2 * sin(2 * PI * 3 * s) / (2 * PI * 3));
}

/* What a quantity makes of it; with the derivatives, or without; broken where it is told. */
static quantity_value measure_of(const char *text, function *f, int n, double end, bool even,
                                 bool with_rates, double break_at) {
  static const char *const name[] = {"other", "x"};
  quantity q;
  meter *m;
  size_t at;
  assert_ok(quantity_parse(text, &q, &at));
  assert_ok(quantity_resolve(&q, 2, name, &at));
  assert_ok(meter_create(1, &q, end, &m));
  for (int k = 0; k <= n; k++) {
    double t = k < n ? step_end(k, n, end, even) : end, rate[2] = {NAN, 0}, value[2] = {NAN, 0};
    value[1] = f(t, &rate[1]);
    meter_row(m, t, value, with_rates ? rate : NULL);
    if (t == break_at) meter_break(m);
  }
  meter_close(m);
  assert_int_equal(meter_count(m), 1);
  quantity_value v = meter_value(m, 0);
  meter_destroy(m);
  return v;
}

static double measured(const char *text, function *f, int n, double end, bool even,
                       bool with_rates) {
  quantity_value v = measure_of(text, f, n, end, even, with_rates, NAN);
  if (!v.known) fail_msg("%s: %s", text, v.why);
  return v.value;
}

/* The integral of exp(-a t) sin(w t + p) up to t, but for a constant. */
static double primitive(double t) {
  double w = omega, a = decay, s = sin(w * t + phase), c = cos(w * t + phase);
  return -exp(-a * t) * (a * s + w * c) / (a * a + w * w);
}

/* The first time from `from` on where the damped sine has a maximum, or a minimum. */
static double extreme_time(double from, bool high) {
  double t0 = (atan2(omega, decay) - phase) / omega, half = PI / omega;
  long k = (long)ceil((from - t0) / half);
  if ((k % 2 != 0) == high) k++;
  return t0 + (double)k * half;
}

static double at_time(double t) {
  double rate;
  return damped(t, &rate);
}

enum { CLOSED = 10 };

static void closed_forms(double t, double exact[CLOSED]) {
  double high = extreme_time(0.5, true), low = extreme_time(0.5, false);
  double whole = height * 2.5 + primitive(3) - primitive(0.5);
  double each[CLOSED] = {at_time(t),    at_time(3), at_time(high),
                         at_time(low),  high,       low,
                         whole / 2.5,   whole,      (at_time(high) - at_time(low)) / 2,
                         2 * PI / omega};
  memcpy(exact, each, sizeof each);
}

static const struct {
  const char *text;
  double order;
} orders[CLOSED] = {
    {NULL, 4} /* x at a time that differs from signal to signal */,
    {"x@end", 9}, /* to the last digit */
    {"max(x, 0.5, 3)", 4},
    {"min(x, 0.5, 3)", 4},
    {"when(max(x, 0.5, 3))", 3},
    {"when(min(x, 0.5, 3))", 3},
    {"mean(x, 0.5, 3)", 4},
    {"integral(x, 0.5, end)", 4},
    {"amplitude(x, 0.5, 3)", 4},
    {"period(x, 0.5, 3)", 3},
};

/* The largest error over signals that lie differently on the steps. */
static void worst_errors(int n, bool even, bool with_rates, double error[CLOSED]) {
  for (int i = 0; i < CLOSED; i++) error[i] = 0;
  for (int p = 0; p < 24; p++) {
    double exact[CLOSED];
    phase = 0.1 + p * PI / 12; /* the largest of the window is an extreme, not its edge */
    if (fabs(at_time(0.5) - height) > 0.6 * exp(-decay * 0.5)) continue;
    char at[32];
    snprintf(at, sizeof at, "x@%.4f", 1.2345 + 0.037 * p);
    closed_forms(strtod(at + 2, NULL), exact);
    for (int i = 0; i < CLOSED; i++) {
      double found = measured(orders[i].text ? orders[i].text : at, damped, n, 3, even, with_rates);
      error[i] = fmax(error[i], fabs(found - exact[i]));
    }
  }
}

/* A damped sine about a level, of 3.3 periods, by 60 to 480 steps. The orders are those of the
   header less 0.4 for what the worst of a dozen phases leaves to chance. */
static void orders_are_as_promised(void **state) {
  (void)state;
  for (int kind = 0; kind < 4; kind++) {
    bool even = kind & 1, with_rates = kind & 2;
    double coarse[CLOSED], fine[CLOSED];
    worst_errors(60, even, with_rates, coarse);
    worst_errors(480, even, with_rates, fine);
    for (int i = 0; i < CLOSED; i++) {
      double order = log2(coarse[i] / fine[i]) / 3;
      const char *text = orders[i].text ? orders[i].text : "x@t";
      print_message("%s%s %s: %.1e, %.1e, order %.2f\n", text, even ? " even" : "",
                    with_rates ? "with rates" : "", coarse[i], fine[i], order);
      if (orders[i].order > 4)
        assert_below(coarse[i], 1e-15);
      else if (!(order > orders[i].order - 0.4))
        fail_msg("%s: order %.2f, %s", text, order, with_rates ? "with rates" : "without");
    }
  }
}

/* What is linear, constant or cubic is exact, on any steps; a window that cuts steps, too. */
static void lines_are_exact(void **state) {
  (void)state;
  static const struct {
    const char *text;
    function *f;
    double exact;
  } each[] = {
      {"max(x)", ramp, 3},
      {"min(x)", ramp, -3},
      {"min(x, 0.3, 1.7)", ramp, -0.4},
      {"when(min(x, 0.3, 1.7))", ramp, 1.7},
      {"mean(x, 0.3, 1.7)", ramp, 1},
      {"integral(x)", ramp, 0},
      {"integral(abs(x))", ramp, 4.5},
      {"mean(abs(x), 1, 2)", ramp, 0.5},
      {"min(abs(x))", ramp, 0},
      {"when(min(abs(x)))", ramp, 1.5},
      {"max(abs(x))", ramp, 3},
      {"abs(min(x))", ramp, 3},
      {"abs(x)@2", ramp, 1},
      {"abs(x@2)", ramp, 1},
      {"x@2", ramp, -1},
      {"amplitude(x)", ramp, 3},
      {"max(x)", level, 1.25},
      {"when(max(x))", level, 0},
      {"mean(x, 1, 2)", level, 1.25},
      {"amplitude(x)", level, 0},
      {"x@end", level, 1.25},
  };
  for (size_t i = 0; i < sizeof each / sizeof *each; i++)
    for (int n = 1; n <= 9; n++) /* of one step, too */
      for (int kind = 0; kind < 4; kind++)
        assert_close(measured(each[i].text, each[i].f, n, 3, kind & 1, kind & 2), each[i].exact, 0,
                     3e-14); /* of numbers up to 4.5, by sums of up to nine */
}

/* A kink that is told bends nothing beside it. */
static void pieces_are_apart(void **state) {
  (void)state;
  for (int with_rates = 0; with_rates < 2; with_rates++) {
    quantity_value v = measure_of("max(x)", bent, 8, 2, true, with_rates, 1);
    assert_close(v.value, 1, 0, 1e-15);
    assert_close(v.t, 1, 0, 0);
    v = measure_of("integral(x)", bent, 8, 2, true, false, 1);
    assert_close(v.value, 0.5 + 1 - 1.5, 0, 1e-15);
    v = measure_of("x@1.125", bent, 8, 2, true, with_rates, 1);
    assert_close(v.value, 1 - 3 * 0.125, 0, 1e-15);
    v = measure_of("x@0.875", bent, 8, 2, true, with_rates, 1);
    assert_close(v.value, 0.875, 0, 1e-15);
  }
}

/* Rows [n] of t and value through a meter for one quantity of a run to 2 s. */
static quantity_value of_rows(const char *text, int n, const double (*row)[2]) {
  static const char *const name[] = {"x"};
  quantity q;
  meter *m;
  size_t at;
  assert_ok(quantity_parse(text, &q, &at));
  assert_ok(quantity_resolve(&q, 1, name, &at));
  assert_ok(meter_create(1, &q, 2, &m));
  for (int k = 0; k < n; k++) meter_row(m, row[k][0], &row[k][1], NULL);
  meter_close(m);
  quantity_value v = meter_value(m, 0);
  meter_destroy(m);
  return v;
}

/* From 1 to 5 at t = 1, where there are two rows of one time. */
static void a_jump_is_no_slope(void **state) {
  (void)state;
  static const double row[][2] = {{0, 1}, {0.5, 1}, {1, 1}, {1, 5}, {1.5, 5}, {2, 5}};
  assert_close(of_rows("integral(x)", 6, row).value, 6, 0, 1e-15);
  assert_close(of_rows("mean(x, 0.25, 1)", 6, row).value, 1, 0, 1e-15);
  assert_close(of_rows("mean(x, 1, 1.75)", 6, row).value, 5, 0, 1e-15);
  assert_close(of_rows("max(x, 0, 1)", 6, row).value, 1, 0, 0); /* the window ends before it */
  assert_close(of_rows("min(x, 1, 2)", 6, row).value, 5, 0, 0); /* and this begins after it */
  assert_close(of_rows("x@1", 6, row).value, 1, 0, 0);          /* as the tables: just before */
  assert_close(of_rows("when(max(x))", 6, row).value, 1, 0, 0);
  assert_close(of_rows("amplitude(x)", 6, row).value, 2, 0, 0);
  /* in the beginning, and of a single step on either side */
  static const double first[][2] = {{0, 0}, {0, 2}, {1, 3}, {1, 1}, {2, 1}};
  assert_close(of_rows("integral(x)", 5, first).value, 3.5, 0, 1e-15);
  assert_close(of_rows("min(x)", 5, first).value, 0, 0, 0);
  assert_close(of_rows("x@0", 5, first).value, 0, 0, 0);
}

/* Steps that grow tenfold from a restart on, the column known to 1e-8: its noise over the shortest
   steps makes no slope of the longer. */
static void short_steps_make_no_slopes(void **state) {
  (void)state;
  double row[12][2], t = 0, h = 1e-7;
  int n = 0;
  for (; t < 2 && n < 12; t += h, h *= 30, n++) {
    row[n][0] = t;
    row[n][1] = 1 + (n % 2 ? 1e-8 : -1e-8);
  }
  row[n - 1][0] = 2;
  assert_close(of_rows("max(x)", n, (const double(*)[2])row).value, 1, 0, 3e-8);
  assert_close(of_rows("min(x)", n, (const double(*)[2])row).value, 1, 0, 3e-8);
}

static void what_is_not_there_is_said(void **state) {
  (void)state;
  static const double half[][2] = {{0, 1}, {0.5, 2}, {1, 4}};
  static const double hole[][2] = {{0, 1}, {0.5, NAN}, {1, 4}, {2, 4}};
  static const double rise[][2] = {{0, 0},        {0.2, 1e-17}, {0.4, -1e-17}, {0.6, 2e-17},
                                   {0.8, -1e-17}, {1, 0},       {1.5, 1},      {2, 2}};
  static const double all[][2] = {{0, 1}, {2 - 1e-12, 3}}; /* the end, but for rounding */
  static const struct {
    const char *text;
    int n;
    const double (*row)[2];
    const char *why;
  } unknown[] = {
      {"max(x)", 3, half, "the answer ends at t = 1 s, and does not reach 2 s"},
      {"x@end", 3, half, "the answer ends at t = 1 s, and does not reach 2 s"},
      {"x@1.5", 3, half, "the answer ends at t = 1 s, and does not reach 1.5 s"},
      {"mean(x, 1, 1.5)", 3, half, "does not reach 1.5 s"},
      {"max(x)", 4, hole, "no value at t = 0.5 s"},
      {"x@0.7", 4, hole, "no value there"},
      {"period(x)", 8, rise, "it does not oscillate: it turns"},
      {"period(x)", 2, all, "it does not oscillate: it turns 0 times"},
      {"max(x)", 0, half, "does not reach 2 s"},
  };
  for (size_t i = 0; i < sizeof unknown / sizeof *unknown; i++) {
    quantity_value v = of_rows(unknown[i].text, unknown[i].n, unknown[i].row);
    assert_false(v.known);
    assert_true(isnan(v.value) && isnan(v.t));
    if (!strstr(v.why, unknown[i].why)) fail_msg("%s: %s", unknown[i].text, v.why);
  }
  assert_close(of_rows("max(x, 0, 1)", 3, half).value, 4, 0, 0);
  assert_close(of_rows("x@1", 3, half).value, 4, 0, 0);
  assert_false(of_rows("x@0.5", 4, hole).known);
  assert_close(of_rows("max(x, 1, 2)", 4, hole).value, 4, 0, 1e-15);
  assert_close(of_rows("x@end", 2, all).value, 3, 0, 0);
  assert_close(of_rows("max(x)", 2, all).value, 3, 0, 0);
}

/* Mostly of the slow motion: what rides on it is less than a tenth. */
static double two_tones(double t, double *rate) {
  *rate = NAN;
  return sin(2 * PI * t) + 0.04 * sin(2 * PI * 9.3 * t);
}

static void period_is_that_of_the_main_motion(void **state) {
  (void)state;
  /* the fast part moves each of the turns by at most 0.04 9.3 / 2 pi of a period, over five */
  assert_close(measured("period(x)", two_tones, 2000, 5, true, false), 1, 0, 0.03);
}

static corot_status make_meter(void *context) {
  meter *m;
  COROT_TRY(meter_create(1, context, 1, &m));
  meter_destroy(m);
  return COROT_OK;
}

static void memory_may_be_refused(void **state) {
  (void)state;
  quantity q = {.operation = QUANTITY_MAX, .to = 1};
  assert_int_equal(assert_survives_failed_allocations(make_meter, &q), 1);
  meter_destroy(NULL);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(text_is_read_and_printed),
      cmocka_unit_test(what_is_wrong_is_pointed_at),
      cmocka_unit_test(a_long_text_is_refused),
      cmocka_unit_test(columns_are_found),
      cmocka_unit_test(windows_are_within_the_run),
      cmocka_unit_test(orders_are_as_promised),
      cmocka_unit_test(lines_are_exact),
      cmocka_unit_test(pieces_are_apart),
      cmocka_unit_test(a_jump_is_no_slope),
      cmocka_unit_test(short_steps_make_no_slopes),
      cmocka_unit_test(what_is_not_there_is_said),
      cmocka_unit_test(period_is_that_of_the_main_motion),
      cmocka_unit_test(memory_may_be_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
