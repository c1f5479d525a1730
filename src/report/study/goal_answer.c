/* As many digits as the interval gives sense to. */
#include "goal_answer.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>

#include "report/read/lookup.h"

static int digits_of(double value, double half) {
  if (!(half > 0) || !(fabs(value) > 0)) return 6;
  int n = (int)ceil(log10(fabs(value) / half)) + 2;
  return n < 3 ? 3 : n > 12 ? 12 : n;
}

static bool is_absolute(const json_t *solved) { return json_is_true(lookup(solved, "within_abs")); }

static void write_amount(double x, const char *unit, char text[GOAL_AMOUNT_SIZE]) {
  if (isnan(x))
    snprintf(text, GOAL_AMOUNT_SIZE, "?");
  else
    snprintf(text, GOAL_AMOUNT_SIZE, "%.2g%s%.64s", x, *unit ? " " : "", unit);
}

void goal_amount(const json_t *solved, double error, char text[GOAL_AMOUNT_SIZE]) {
  double value = fabs(lookup_number(solved, "value"));
  if (is_absolute(solved))
    write_amount(error, lookup_text(solved, "unit"), text);
  else
    write_amount(100 * error / value, "%", text);
}

void goal_asked(const json_t *solved, char text[GOAL_AMOUNT_SIZE]) {
  double within = lookup_number(solved, "within");
  if (is_absolute(solved))
    write_amount(within, lookup_text(solved, "unit"), text);
  else
    write_amount(100 * within, "%", text);
}

void goal_answer(const json_t *solved, const char *plus_minus, char text[GOAL_ANSWER_SIZE]) {
  double value = lookup_number(solved, "value"), low = lookup_number(solved, "low"),
         high = lookup_number(solved, "high"), half = (high - low) / 2;
  const char *goal = lookup_text(solved, "goal"), *unit = lookup_text(solved, "unit");
  char known[GOAL_AMOUNT_SIZE], asked[GOAL_AMOUNT_SIZE];
  if (!isfinite(value)) {
    snprintf(text, GOAL_ANSWER_SIZE, "%.300s: not found", goal);
    return;
  }
  int n = digits_of(value, half);
  goal_amount(solved, half, known);
  goal_asked(solved, asked);
  int used = snprintf(text, GOAL_ANSWER_SIZE, "%.300s = %.*g%s%.64s", goal, n, value,
                      *unit ? " " : "", unit);
  if (isfinite(half))
    snprintf(text + used, GOAL_ANSWER_SIZE - (size_t)used,
             ", between %.*g and %.*g (%s %s; %s asked)", n, low, n, high, plus_minus, known,
             asked);
  else
    snprintf(text + used, GOAL_ANSWER_SIZE - (size_t)used,
             ", and its error is not known (%s asked)", asked);
}
