/* An error budget as a section of a page: its parts with their bounds, as shares of the total, and
   what each does to the probes, with its sign. */
#include "budget_section.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "report/page/html.h"
#include "report/page/markup.h"
#include "report/page/save.h"
#include "report/read/lookup.h"

/* Where bars begin and end, in shares of the total: those of parts that are larger than the total,
   as others cancel them, or work against it, find their place. */
typedef struct bars {
  double total;     /* its error */
  double low, high; /* at most 0, at least 1 */
} bars;

/* Signed where the budget says so. */
static double share_of(const json_t *part, const bars *b) {
  double share = lookup_number(part, "share");
  return isfinite(share) ? share : lookup_number(part, "error") / b->total;
}

static bars find_bars(const json_t *budget) {
  const json_t *parts = lookup(budget, "parts");
  bars b = {.total = lookup_number(budget, "total"), .high = 1};
  for (size_t i = 0; i < json_array_size(parts); i++) {
    double share = share_of(json_array_get(parts, i), &b);
    if (!isfinite(share)) continue;
    b.low = fmin(b.low, share);
    b.high = fmax(b.high, share);
  }
  return b;
}

static void begin_row(const char *part, const char *pair, const char *advice, FILE *out) {
  fputs("<tr><th scope=\"row\">", out);
  markup_text(out, part);
  fputs("</th><td>", out);
  markup_text(out, pair);
  if (*advice) {
    fputs("<br><span class=\"advice\">to reduce it: ", out);
    markup_text(out, advice);
    fputs("</span>", out);
  }
}

static void end_name(const char *verdict, FILE *out) {
  if (*verdict) {
    fputs("<br><span class=\"advice\">", out);
    markup_text(out, verdict);
    fputs("</span>", out);
  }
  fputs("</td>", out);
}

/* A number with its bound: what is below the floor by what it is at most, what is doubtful in
   parentheses. */
static void error_cell(const json_t *object, const char *key, const char *prefix, FILE *out) {
  char name[32];
  snprintf(name, sizeof name, "%sbound", prefix);
  const char *bound = lookup_text(object, name);
  bool below = strcmp(bound, "at most") == 0;
  bool doubtful = strcmp(bound, "doubtful") == 0 || strcmp(bound, "unchecked") == 0;
  snprintf(name, sizeof name, "%shigh", prefix);
  double error = lookup_number(object, below ? name : key);
  if (!isfinite(error))
    fputs("<td class=\"number\">not known</td>", out);
  else
    fprintf(out, "<td class=\"number\">%s%.2e%s</td>",
            below                            ? "≤ "
            : doubtful                       ? "("
            : strcmp(bound, "at least") == 0 ? "≥ "
                                             : "",
            error, doubtful ? ")" : "");
}

static void bar_cell(double share, const bars *b, FILE *out) {
  fputs("<td class=\"share\">", out);
  if (isfinite(share)) {
    double unit = 100 / (b->high - b->low);
    fprintf(out, "<div style=\"margin-left:%.1f%%;width:%.1f%%\"%s></div>%+.0f %%",
            unit * (fmin(0, share) - b->low), unit * fabs(share),
            share < 0 ? " class=\"against\"" : "", 100 * share);
  }
  fputs("</td>", out);
}

static void write_part(const json_t *part, const bars *b, FILE *out) {
  begin_row(lookup_text(part, "part"), lookup_text(part, "pair"), lookup_text(part, "advice"), out);
  end_name(lookup_text(part, "verdict"), out);
  error_cell(part, "error", "", out);
  bar_cell(share_of(part, b), b, out);
  error_cell(part, "end", "end_", out);
  error_cell(part, "alone", "alone_", out);
  page_number(out, lookup_number(part, "cost"), 3);
  fputs("</tr>\n", out);
}

static void write_sum(const json_t *budget, const char *key, const char *prefix, const char *name,
                      const char *what, FILE *out) {
  if (!isfinite(lookup_number(budget, key))) return;
  begin_row(name, what, "", out);
  end_name("", out);
  error_cell(budget, key, prefix, out);
}

static void write_total(const json_t *budget, const bars *b, FILE *out) {
  if (!isfinite(b->total)) return;
  write_sum(budget, "total", "total_", "total", "all of them at once", out);
  bar_cell(1, b, out);
  error_cell(budget, "total_end", "total_end_", out);
  fputs("<td></td><td></td></tr>\n", out);
}

static void write_rest(const json_t *budget, const char *key, const char *name, const char *what,
                       FILE *out) {
  if (!isfinite(lookup_number(budget, key))) return;
  write_sum(budget, key, "", name, what, out);
  fputs("<td></td><td></td><td></td><td></td></tr>\n", out);
}

static void write_table(const json_t *budget, FILE *out) {
  const json_t *parts = lookup(budget, "parts");
  bars b = find_bars(budget);
  fputs(
      "<div class=\"scroll\"><table>\n<thead><tr><th>part</th><th>estimated by switching to</th>"
      "<th class=\"number\">error</th><th>share of the total at the end</th>"
      "<th class=\"number\">at the end</th><th class=\"number\">alone</th>"
      "<th class=\"number\">times the cost</th></tr></thead>\n<tbody>\n",
      out);
  for (size_t i = 0; i < json_array_size(parts); i++) write_part(json_array_get(parts, i), &b, out);
  write_total(budget, &b, out);
  write_rest(budget, "sum", "sum of the parts", "", out);
  write_rest(budget, "interaction", "interaction", "total less sum", out);
  write_rest(budget, "check", "check of time", "two independent methods", out);
  fputs("</tbody></table></div>\n", out);
}

/* --- Signed changes --- */

static void write_changes(const char *name, const json_t *probes, const char *probe, FILE *out) {
  const json_t *change = json_object_get(json_object_get(probes, probe), "signed");
  if (!json_is_array(change)) return;
  fputs("<tr><th scope=\"row\">", out);
  markup_text(out, name);
  fputs("</th>", out);
  for (size_t c = 0; c < 3; c++) {
    const json_t *x = json_array_get(change, c);
    if (json_is_number(x))
      fprintf(out, "<td class=\"number\">%+.3e</td>", json_number_value(x));
    else
      fputs("<td></td>", out);
  }
  fputs("</tr>\n", out);
}

static void write_probe(const json_t *budget, const char *probe, FILE *out) {
  const json_t *parts = lookup(budget, "parts");
  page_element(out, "p",
               "What each part changes of the displacement of probe %s at the end [m]: parts of "
               "opposite signs cancel.",
               probe);
  fputs(
      "<div class=\"scroll\"><table>\n<thead><tr><th>part</th><th class=\"number\">ux</th>"
      "<th class=\"number\">uy</th><th class=\"number\">uz</th></tr></thead>\n<tbody>\n",
      out);
  for (size_t i = 0; i < json_array_size(parts); i++) {
    const json_t *part = json_array_get(parts, i);
    write_changes(lookup_text(part, "part"), lookup(part, "probes"), probe, out);
  }
  write_changes("total", lookup(budget, "total_probes"), probe, out);
  fputs("</tbody></table></div>\n", out);
}

static void write_probes(const json_t *budget, FILE *out) {
  json_t *probes = (json_t *)lookup(budget, "total_probes");
  const char *name;
  json_t *probe;
  json_object_foreach(probes, name, probe) {
    if (json_is_array(json_object_get(probe, "signed"))) write_probe(budget, name, out);
  }
}

/* What each part does to one of the run's quantities. */
static void write_quantity(const char *name, const json_t *quantity, FILE *out) {
  const json_t *parts = lookup(quantity, "parts");
  page_element(out, "p", "%s, %s: %.6g as given, %.6g without all parts.", name,
               lookup_text(quantity, "of"), lookup_number(quantity, "value"),
               lookup_number(quantity, "reference"));
  fputs(
      "<div class=\"scroll\"><table>\n<thead><tr><th>part</th><th class=\"number\">change</th>"
      "<th class=\"number\">relative</th><th>what is known</th></tr></thead>\n<tbody>\n",
      out);
  for (size_t i = 0; i < json_array_size(parts); i++) {
    const json_t *part = json_array_get(parts, i);
    fputs("<tr><th scope=\"row\">", out);
    markup_text(out, lookup_text(part, "part"));
    fputs("</th>", out);
    page_number(out, lookup_number(part, "change"), 3);
    page_number(out, lookup_number(part, "error"), 2);
    fputs("<td>", out);
    markup_text(out, lookup_text(part, "verdict"));
    fputs("</td></tr>\n", out);
  }
  fputs("</tbody></table></div>\n", out);
}

static void write_quantities(const json_t *budget, FILE *out) {
  json_t *all = (json_t *)lookup(budget, "quantities");
  const char *name;
  json_t *quantity;
  json_object_foreach(all, name, quantity) write_quantity(name, quantity, out);
}

/* --- The section, and a page of it alone --- */

void budget_write(const json_t *budget, FILE *out) {
  const char *first = lookup_text(budget, "first"), *measure = lookup_text(budget, "measure");
  bool whole = !json_is_false(lookup(budget, "complete"));
  page_section("budget", "Error budget", out);
  if (*first) page_element(out, whole ? "p class=\"answer\"" : "p class=\"warning\"", "%s", first);
  if (*measure) page_element(out, "p", "Error of the %s.", measure);
  page_warning(lookup_text(budget, "mixed"), out);
  write_table(budget, out);
  write_probes(budget, out);
  write_quantities(budget, out);
  page_section_end(out);
}

static corot_status write_page(const void *budget, FILE *out) {
  const char *title = lookup_text(budget, "title");
  page_begin(*title ? title : "Error budget", "budget", out);
  budget_write(budget, out);
  page_end(out);
  return COROT_OK;
}

corot_status report_budget(const char *dir, const char *path) {
  json_t *budget;
  COROT_TRY(lookup_read(dir, "budget.json", &budget));
  corot_status status = save_text(path, write_page, budget);
  json_decref(budget);
  return status;
}
