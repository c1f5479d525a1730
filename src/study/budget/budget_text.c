/* An error budget in words and columns. */
#include "budget_text.h"

#include <math.h>
#include <string.h>

#include "budget_quantities.h"
#include "report/read/lookup.h"
#include "study/measure/claim.h"

/* --- Verdicts --- */

static bool has_bound(const json_t *part, claim_kind kind) {
  return strcmp(lookup_text(part, "bound"), claim_words[kind]) == 0;
}

static const json_t *find_largest(const json_t *parts) {
  const json_t *largest = NULL;
  for (size_t i = 0; i < json_array_size(parts); i++) {
    const json_t *part = json_array_get(parts, i);
    double error = lookup_number(part, "error");
    if (!isfinite(error) || has_bound(part, CLAIM_AT_MOST)) continue;
    if (!largest || error > lookup_number(largest, "error")) largest = part;
  }
  return largest;
}

/* "A, B": the parts of that kind. */
static size_t name_parts(const json_t *parts, claim_kind kind, size_t size, char *text) {
  size_t count = 0, used = 0;
  text[0] = '\0';
  for (size_t i = 0; i < json_array_size(parts) && used < size; i++) {
    const json_t *part = json_array_get(parts, i);
    if (!has_bound(part, kind)) continue;
    used += (size_t)snprintf(text + used, size - used, "%s%s", count++ ? ", " : "",
                             lookup_text(part, "part"));
  }
  return count;
}

/* Parts beside the largest that may be larger than it. */
static void name_rivals(const json_t *parts, const json_t *largest, size_t size, char *text) {
  size_t used = 0;
  text[0] = '\0';
  for (size_t i = 0; i < json_array_size(parts) && used < size; i++) {
    const json_t *part = json_array_get(parts, i);
    if (part == largest || has_bound(part, CLAIM_MISSING) || has_bound(part, CLAIM_UNCHECKED))
      continue;
    double high = lookup_number(part, "high"); /* NaN: no bound */
    if (high <= lookup_number(largest, "error")) continue;
    used += (size_t)snprintf(
        text + used, size - used, " The part of %s may be larger: it is %s %.1e.",
        lookup_text(part, "part"), has_bound(part, CLAIM_AT_LEAST) ? "at least" : "at most",
        has_bound(part, CLAIM_AT_LEAST) ? lookup_number(part, "low") : high);
  }
}

static json_t *verdict_below_floors(const json_t *parts) {
  double high = 0;
  for (size_t i = 0; i < json_array_size(parts); i++)
    high = fmax(high, lookup_number(json_array_get(parts, i), "high"));
  return json_sprintf("No part is above its floor; none is larger than %.1e of the displacement.",
                      high);
}

json_t *budget_verdict(const json_t *parts, double total) {
  char missing[256], unchecked[256], rivals[512], cancel[128] = "", doubt[320] = "";
  const json_t *largest = find_largest(parts);
  size_t nmissing = name_parts(parts, CLAIM_MISSING, sizeof missing, missing);
  /* nothing is large enough to be told */
  if (!largest && nmissing == 0) return verdict_below_floors(parts);
  if (!largest)
    return json_sprintf(
        "Parts are missing, as runs failed: %s. None of the others is above its floor.", missing);
  /* how far the largest is to be trusted */
  if (name_parts(parts, CLAIM_UNCHECKED, sizeof unchecked, unchecked) > 0)
    snprintf(doubt, sizeof doubt, " No run has checked the references of: %s.", unchecked);
  double error = lookup_number(largest, "error");
  const char *least = has_bound(largest, CLAIM_AT_LEAST) ? "at least " : "";
  const char *part = lookup_text(largest, "part");
  if (nmissing > 0)
    return json_sprintf(
        "Parts are missing, as runs failed: %s. So it is not known which part is the largest; of "
        "those that are known it is %s, %s%.1e of the displacement.%s",
        missing, part, least, error, doubt);
  /* what else there is to know before anything is changed */
  if (total < 0.7 * error)
    snprintf(cancel, sizeof cancel,
             " Parts cancel one another: together they are %.1e; look at each alone.", total);
  name_rivals(parts, largest, sizeof rivals, rivals);
  return json_sprintf(
      "The largest part is that of %s, %s%.1e of the displacement. Change first: %s.%s%s%s", part,
      least, error, lookup_text(largest, "advice"), rivals, cancel, doubt);
}

/* --- The table --- */

enum { TEXT_SIZE = 32 };

/* "1.20e-03", ">1.20e-03" at least, "<..." below the floor, "(...)" doubtful, "?" */
static void print_error(const json_t *object, const char *key, const char *prefix, FILE *out) {
  char name[64], text[TEXT_SIZE];
  double error = lookup_number(object, key);
  snprintf(name, sizeof name, "%sbound", prefix);
  const char *bound = lookup_text(object, name);
  snprintf(name, sizeof name, "%shigh", prefix);
  if (!isfinite(error))
    snprintf(text, TEXT_SIZE, "?");
  else if (strcmp(bound, claim_words[CLAIM_AT_MOST]) == 0)
    snprintf(text, TEXT_SIZE, "<%.2e", lookup_number(object, name));
  else if (strcmp(bound, claim_words[CLAIM_AT_LEAST]) == 0)
    snprintf(text, TEXT_SIZE, ">%.2e", error);
  else if (strcmp(bound, "doubtful") == 0 || strcmp(bound, claim_words[CLAIM_UNCHECKED]) == 0)
    snprintf(text, TEXT_SIZE, "(%.2e)", error);
  else
    snprintf(text, TEXT_SIZE, "%.2e", error);
  fprintf(out, "  %10s", text);
}

static void print_share(double share, FILE *out) {
  if (isfinite(share))
    fprintf(out, "  %+5.0f%%", 100 * share);
  else
    fprintf(out, "  %6s", "?");
}

static void print_part(const json_t *part, FILE *out) {
  fprintf(out, "%-18s", lookup_text(part, "part"));
  print_error(part, "error", "", out);
  print_error(part, "end", "end_", out);
  print_error(part, "alone", "alone_", out);
  double cost = lookup_number(part, "cost");
  if (isfinite(cost))
    fprintf(out, "  %5.3g", cost);
  else
    fprintf(out, "  %5s", "?");
  fprintf(out, "  %s\n", lookup_text(part, "pair"));
}

static void print_line(const json_t *budget, const char *name, const char *key, const char *prefix,
                       FILE *out) {
  fprintf(out, "%-18s", name);
  print_error(budget, key, prefix, out);
  fputc('\n', out);
}

/* What a part changes of a component of a probe at the end [m]. */
static double change_of(const json_t *part, const char *probe, size_t component) {
  const json_t *own = json_object_get(json_object_get(part, "probes"), probe);
  return json_number_value(json_array_get(json_object_get(own, "signed"), component));
}

/* The component in which most happens, even if it cancels. */
static size_t busiest_component(const json_t *parts, const char *probe) {
  double sum[3] = {0, 0, 0};
  for (size_t i = 0; i < json_array_size(parts); i++)
    for (size_t c = 0; c < 3; c++) sum[c] += fabs(change_of(json_array_get(parts, i), probe, c));
  size_t c = sum[1] > sum[0] ? 1 : 0;
  return sum[2] > sum[c] ? 2 : c;
}

static void print_probes(const json_t *budget, FILE *out) {
  const json_t *parts = json_object_get(budget, "parts");
  json_t *probes = json_object_get(budget, "total_probes");
  const char *name;
  json_t *probe;
  json_object_foreach(probes, name, probe) {
    const json_t *total = json_object_get(probe, "signed");
    if (!total) continue;
    size_t c = busiest_component(parts, name);
    fprintf(out, "%s.u%c at the end changes by %+.2e m:", name, "xyz"[c],
            json_number_value(json_array_get(total, c)));
    for (size_t i = 0; i < json_array_size(parts); i++) {
      const json_t *part = json_array_get(parts, i);
      fprintf(out, "%s %+.2e by %s", i ? "," : "", change_of(part, name, c),
              lookup_text(part, "part"));
    }
    fputc('\n', out);
  }
}

void budget_print(const json_t *budget, FILE *out) {
  const json_t *parts = json_object_get(budget, "parts");
  fprintf(out, "%-18s  %10s  %10s  %10s  %5s  %s\n", "part", "largest", "at end", "alone", "cost",
          "estimated by switching to");
  for (size_t i = 0; i < json_array_size(parts); i++) print_part(json_array_get(parts, i), out);
  /* the whole */
  fprintf(out, "%-18s", "total");
  print_error(budget, "total", "total_", out);
  print_error(budget, "total_end", "total_end_", out);
  fputc('\n', out);
  print_line(budget, "sum of the parts", "sum", "sum_", out);
  print_line(budget, "interaction", "interaction", "interaction_", out);
  if (!json_is_true(json_object_get(budget, "static")))
    print_line(budget, "check of time", "check", "check_", out);
  /* what is known of each part */
  fputs("\nshare of the total at the end, and what is known of each part\n", out);
  for (size_t i = 0; i < json_array_size(parts); i++) {
    const json_t *part = json_array_get(parts, i);
    fprintf(out, "%-18s", lookup_text(part, "part"));
    print_share(lookup_number(part, "share"), out);
    fprintf(out, "  %s\n", lookup_text(part, "verdict"));
  }
  print_probes(budget, out);
  budget_quantities_print(budget, out);
  const char *first = json_string_value(json_object_get(budget, "first"));
  if (first) fprintf(out, "\n%s\n", first);
  const char *mixed = json_string_value(json_object_get(budget, "mixed"));
  if (mixed) fprintf(out, "\n%s\n", mixed);
}
