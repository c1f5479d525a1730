/* Prints solve.json. */
#include "goal_text.h"

#include <math.h>
#include <stdbool.h>

#include "report/read/lookup.h"
#include "report/study/goal_answer.h"

static void print_line(const json_t *j, FILE *out) {
  char answer[GOAL_ANSWER_SIZE];
  goal_answer(j, "+-", answer);
  fprintf(out, "%s%s\n", answer,
          json_is_true(json_object_get(j, "asymptotic")) ? ", asymptotic" : "");
}

/* What each part widens the interval by. */
static void print_parts(const json_t *j, FILE *out) {
  static const char *const name[] = {"space", "time", "algebra", "tail"};
  const json_t *half = json_object_get(j, "half"), *parts = json_object_get(j, "parts");
  bool still = json_is_true(json_object_get(j, "static"));
  char amount[GOAL_AMOUNT_SIZE];
  fputc('\n', out);
  for (size_t i = 0; i < sizeof name / sizeof *name; i++) {
    double part = lookup_number(half, name[i]);
    if ((i == 1 && still) || (i == 3 && part == 0)) continue;
    goal_amount(j, part, amount);
    fprintf(out, "  %-16s%14s\n", name[i], amount);
  }
  double model = lookup_number(parts, "model");
  if (!(model > 0)) return;
  goal_amount(j, model, amount);
  fprintf(out, "  %-16s%14s  against green; %s\n", "strain measure", amount,
          json_is_true(json_object_get(j, "model_counts")) ? "it counts"
                                                           : "it does not count (--exact-model)");
}

static void print_levels(const json_t *j, FILE *out) {
  const json_t *levels = json_object_get(j, "levels"), *level;
  size_t i;
  fprintf(out, "\n%10s %10s %16s %10s  run\n", "tets", "unknowns", "value", "CPU [s]");
  json_array_foreach(levels, i, level)
      fprintf(out, "%10.0f %10.0f %16.8g %10.2g  %s\n", lookup_number(level, "tets"),
              lookup_number(level, "dofs"), lookup_number(level, "value"),
              lookup_number(level, "cpu_s"), lookup_text(level, "label"));
  fputc('\n', out);
}

void goal_print(const json_t *j, FILE *out) {
  print_line(j, out);
  bool value = isfinite(lookup_number(j, "value"));
  if (value) {
    print_parts(j, out);
    print_levels(j, out);
  }
  const char *why = lookup_text(j, "why_not"), *obstacle = lookup_text(j, "obstacle"),
             *advice = lookup_text(j, "advice");
  if (value && *why) fprintf(out, "not asymptotic: %s\n", why);
  if (*obstacle) fprintf(out, "not met: %s\n", obstacle);
  if (*advice) fprintf(out, "advice: %s\n", advice);
  double overhead = lookup_number(j, "overhead");
  fprintf(out, "%.3g s of CPU in all", lookup_number(j, "cpu_s"));
  if (isfinite(overhead)) fprintf(out, ", %.2g times the last mesh", overhead);
  fputc('\n', out);
}
