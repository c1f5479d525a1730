/* Prints solve.json. */
#include <math.h>
#include <string.h>

#include "goal_text.h"
#include "report/read/lookup.h"

/* Digits that the interval's width gives sense to. */
static int digits_of(double value, double half) {
  if (!(half > 0) || !(fabs(value) > 0)) return 6;
  int n = (int)ceil(log10(fabs(value) / half)) + 2;
  return n < 3 ? 3 : n > 12 ? 12 : n;
}

static void print_line(const json_t *j, FILE *out) {
  double value = lookup_number(j, "value"), low = lookup_number(j, "low"),
         high = lookup_number(j, "high"), within = lookup_number(j, "within");
  const char *goal = lookup_text(j, "goal"), *unit = lookup_text(j, "unit");
  bool absolute = json_is_true(json_object_get(j, "within_abs"));
  if (isnan(value)) {
    fprintf(out, "%s: not found\n", goal);
    return;
  }
  double half = (high - low) / 2;
  int n = digits_of(value, half);
  fprintf(out, "%s = %.*g%s%s", goal, n, value, *unit ? " " : "", unit);
  if (!isfinite(half)) {
    fprintf(out, ", nobody knows how sure\n");
    return;
  }
  fprintf(out, ", between %.*g and %.*g", n, low, n, high);
  if (absolute)
    fprintf(out, " (+- %.2g; %.2g asked)", half, within);
  else
    fprintf(out, " (+- %.2g %%; %.2g %% asked)", 100 * half / fabs(value), 100 * within);
  fprintf(out, "%s\n", json_is_true(json_object_get(j, "asymptotic")) ? ", asymptotic" : "");
}

static void print_parts(const json_t *j, FILE *out) {
  static const char *const name[] = {"space", "time", "algebra", "tail"};
  const json_t *half = json_object_get(j, "half");
  double value = fabs(lookup_number(j, "value"));
  const char *unit = lookup_text(j, "unit");
  fputs("of this", out);
  for (size_t i = 0; i < sizeof name / sizeof *name; i++) {
    double part = lookup_number(half, name[i]);
    if (i < 3 || part > 0) fprintf(out, "%s %s %.2g %%", i ? "," : "", name[i], 100 * part / value);
  }
  double model = lookup_number(json_object_get(j, "parts"), "model");
  if (model > 0)
    fprintf(out, "; the strain measure is off green by %.2g %s (%.2g %%)%s", model, unit,
            100 * model / value,
            json_is_true(json_object_get(j, "model_counts")) ? ", counted" : ", not counted");
  fputc('\n', out);
}

static void print_levels(const json_t *j, FILE *out) {
  const json_t *levels = json_object_get(j, "levels"), *level;
  size_t i;
  fprintf(out, "%12s %10s %16s %10s\n", "tets", "unknowns", "value", "cpu [s]");
  json_array_foreach(levels, i, level)
      fprintf(out, "%12.0f %10.0f %16.8g %10.2g  %s\n", lookup_number(level, "tets"),
              lookup_number(level, "dofs"), lookup_number(level, "value"),
              lookup_number(level, "cpu_s"), lookup_text(level, "label"));
}

void goal_print(const json_t *j, FILE *out) {
  print_line(j, out);
  bool value = !isnan(lookup_number(j, "value"));
  if (value) {
    print_parts(j, out);
    print_levels(j, out);
  }
  const char *why = lookup_text(j, "why_not"), *obstacle = lookup_text(j, "obstacle"),
             *advice = lookup_text(j, "advice");
  if (value && *why) fprintf(out, "not asymptotic: %s\n", why);
  if (*obstacle) fprintf(out, "not met: %s\n", obstacle);
  if (*advice) fprintf(out, "%s\n", advice);
  double overhead = lookup_number(j, "overhead");
  fprintf(out, "%.3g s of CPU in all", lookup_number(j, "cpu_s"));
  if (overhead > 0) fprintf(out, ", %.2g times the last mesh", overhead);
  fputc('\n', out);
}
