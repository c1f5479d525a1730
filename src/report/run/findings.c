/* Warnings and extremes, near the top of a run's report. */
#include "findings.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "columns.h"
#include "report/page/html.h"
#include "report/page/markup.h"
#include "report/read/lookup.h"

static void write_warning(const json_t *warning, FILE *out) {
  const char *text = json_string_value(warning);
  fputs("<li>", out);
  markup_text(out, text ? text : lookup_text(warning, "text"));
  if (*lookup_text(warning, "code")) {
    fputs(" <span class=\"code\">", out);
    markup_text(out, lookup_text(warning, "code"));
    fputs("</span>", out);
  }
  fputs("</li>\n", out);
}

void findings_warnings(const run_folder *run, FILE *out) {
  const json_t *list = lookup(run->result, "warnings");
  size_t n = json_array_size(list);
  if (!json_is_array(list)) return;
  if (n == 0) {
    fputs("<p class=\"note\" id=\"warnings\">No warnings.</p>\n", out);
    return;
  }
  fputs("<div class=\"warning\" id=\"warnings\">", out);
  page_element(out, "h3", "%zu warning%s", n, n == 1 ? "" : "s");
  fputs("<ul>\n", out);
  for (size_t i = 0; i < n; i++) write_warning(json_array_get(list, i), out);
  fputs("</ul></div>\n", out);
}

/* What is known of a quantity "PROBE.ux" or "kinetic". */
typedef struct quantity {
  const char *name, *unit;
  bool moving; /* of a motion only, not of an equilibrium */
} quantity;

static const quantity *find_quantity(const char *name) {
  static const quantity known[] = {
      {".u", "m", false},          {".ux", "m", false},       {".uy", "m", false},
      {".uz", "m", false},         {"elastic", "J", false},   {"external_work", "J", false},
      {"kinetic", "J", true},      {"dissipated", "J", true}, {"balance", "J", true},
      {"frame_energy", "J", true},
  };
  static const quantity other = {"", "", false};
  const char *dot = strrchr(name, '.');
  for (size_t i = 0; i < sizeof known / sizeof *known; i++)
    if (strcmp(dot ? dot : name, known[i].name) == 0) return &known[i];
  return &other;
}

/* A cell: when that was, which a click shows. */
static void write_moment(const run_folder *run, const json_t *of, FILE *out) {
  double t = lookup_number(of, "t") / run_folder_unit(run);
  fputs("<td class=\"number\">", out);
  if (isfinite(t))
    fprintf(out, "<button type=\"button\" class=\"moment\" data-moment=\"%.17g\">%.6g</button>", t,
            t);
  fputs("</td>", out);
}

/* Two cells: a value, and when. */
static void write_extreme(const run_folder *run, const json_t *extreme, FILE *out) {
  page_number(out, lookup_number(extreme, "value"), 6);
  write_moment(run, extreme, out);
}

static const char *when_words(const run_folder *run) {
  return run_folder_is_static(run) ? "at load factor" : "at t [s]";
}

static void write_quantity(const run_folder *run, const char *name, const json_t *q, FILE *out) {
  const char *unit = lookup_text(q, "unit");
  fputs("<tr><th scope=\"row\">", out);
  markup_text(out, name);
  if (*unit) {
    fputs(" [", out);
    markup_text(out, unit);
    fputs("]", out);
  }
  fputs("</th><td>", out);
  markup_text(out, lookup_text(q, "of"));
  fputs("</td>", out);
  page_number(out, lookup_number(q, "value"), 6);
  write_moment(run, q, out);
  fputs("<td>", out);
  markup_text(out, lookup_text(q, "reason"));
  fputs("</td></tr>\n", out);
}

void findings_quantities(const run_folder *run, FILE *out) {
  json_t *all = (json_t *)lookup(run->result, "quantities");
  if (json_object_size(all) == 0) return;
  fprintf(out,
          "<div id=\"quantities\" class=\"scroll\"><h3>Quantities</h3><table><thead><tr><th></th>"
          "<th></th><th class=\"number\">value</th><th class=\"number\">%s</th><th></th></tr>"
          "</thead>\n<tbody>",
          when_words(run));
  const char *name;
  json_t *q;
  json_object_foreach(all, name, q) write_quantity(run, name, q, out);
  fputs("</tbody></table></div>\n", out);
}

void findings_extremes(const run_folder *run, FILE *out) {
  json_t *extremes =
      (json_t *)lookup(run->result, "extremes"); /* jansson's iteration wants it so */
  if (json_object_size(extremes) == 0) return;
  fputs("<div id=\"extremes\" class=\"scroll\"><h3>Extremes</h3><table><thead><tr><th></th>", out);
  for (int k = 0; k < 2; k++)
    fprintf(out, "<th class=\"number\">%s</th><th class=\"number\">%s</th>",
            k ? "largest" : "smallest", when_words(run));
  fputs("</tr></thead>\n<tbody>", out);
  const char *name;
  json_t *extreme;
  json_object_foreach(extremes, name, extreme) {
    const quantity *is = find_quantity(name);
    if (is->moving && run_folder_is_static(run)) continue;
    fputs("<tr><th scope=\"row\">", out);
    markup_text(out, name);
    const char *unit = *is->unit ? is->unit : columns_unit(run, name);
    if (*unit) fprintf(out, " [%s]", unit);
    fputs("</th>", out);
    write_extreme(run, lookup(extreme, "min"), out);
    write_extreme(run, lookup(extreme, "max"), out);
    fputs("</tr>\n", out);
  }
  fputs("</tbody></table></div>\n", out);
}
