/* Values over unknowns, between what is certain of the truth and what was asked for. */
#include "goal_figures.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "goal_answer.h"
#include "report/page/figure.h"
#include "report/page/html.h"
#include "report/page/markup.h"
#include "report/read/lookup.h"

typedef struct meshes {
  int n;
  double *x, *y;     /* [n] unknowns, value */
  const char **note; /* [n] */
} meshes;

static void meshes_free(meshes *m) {
  free(m->x);
  free(m->y);
  free(m->note);
}

static corot_status meshes_create(const json_t *levels, meshes *m) {
  size_t n = json_array_size(levels);
  *m = (meshes){.n = (int)n,
                .x = malloc((n + 1) * sizeof *m->x),
                .y = malloc((n + 1) * sizeof *m->y),
                .note = malloc((n + 1) * sizeof *m->note)};
  if (!m->x || !m->y || !m->note) {
    meshes_free(m);
    return corot_fail(COROT_ENOMEM, "the values on %zu meshes: out of memory", n);
  }
  for (size_t i = 0; i < n; i++) {
    const json_t *level = json_array_get(levels, i);
    m->x[i] = lookup_number(level, "dofs");
    m->y[i] = lookup_number(level, "value");
    m->note[i] = lookup_text(level, "label");
  }
  return COROT_OK;
}

/* Lines reach beyond the meshes on either side, so that one mesh has lines, too. */
static void find_ends(const meshes *m, double ends[2]) {
  ends[0] = INFINITY, ends[1] = 0;
  for (int i = 0; i < m->n; i++) {
    if (!(m->x[i] > 0)) continue;
    ends[0] = fmin(ends[0], m->x[i]);
    ends[1] = fmax(ends[1], m->x[i]);
  }
  ends[0] /= 2, ends[1] *= 2;
}

static void write_figure(const json_t *solved, const meshes *m, FILE *out) {
  double value = lookup_number(solved, "value"), allowed = lookup_number(solved, "allowed"),
         limit = lookup_number(solved, "limit"), ends[2];
  const char *goal = lookup_text(solved, "goal"), *unit = lookup_text(solved, "unit");
  find_ends(m, ends);
  /* the lines: two of what was asked, apart by a point that is no number */
  const double x[5] = {ends[0], ends[1], NAN, ends[0], ends[1]},
               asked[5] = {value - allowed, value - allowed, NAN, value + allowed, value + allowed},
               extrapolated[2] = {limit, limit};
  char amount[GOAL_AMOUNT_SIZE], name[GOAL_AMOUNT_SIZE + 32], label[256];
  goal_asked(solved, amount);
  snprintf(name, sizeof name, "asked: the last value ± %s", amount);
  snprintf(label, sizeof label, "%.150s%s%.64s%s", goal, *unit ? " [" : "", unit, *unit ? "]" : "");
  figure_series series[3] = {{"value on each mesh", FIGURE_MARKED, m->n, m->x, m->y, m->note},
                             {name, FIGURE_LINE, 5, x, asked, NULL},
                             {"extrapolated limit", FIGURE_LINE, 2, x, extrapolated, NULL}};
  const double interval[2] = {lookup_number(solved, "low"), lookup_number(solved, "high")};
  bool known = isfinite(interval[0]) && isfinite(interval[1]);
  figure_write(&(figure){.id = "meshes",
                         .title = "Value over unknowns",
                         .x_label = "unknowns",
                         .y_label = label,
                         .x_log = true,
                         .tall = true,
                         .nseries = isfinite(limit) ? 3 : 2,
                         .series = series,
                         .floor = NAN,
                         .interval = known ? interval : NULL,
                         .interval_label = "the truth is in here"},
               out);
}

/* What each mesh has changed. */
static void write_table(const json_t *levels, FILE *out) {
  double before = NAN;
  fputs(
      "<div class=\"scroll\"><table>\n<thead><tr><th>mesh</th><th class=\"number\">tets</th>"
      "<th class=\"number\">unknowns</th><th class=\"number\">value</th>"
      "<th class=\"number\">change</th><th class=\"number\">CPU [s]</th></tr></thead>\n<tbody>\n",
      out);
  for (size_t i = 0; i < json_array_size(levels); i++) {
    const json_t *level = json_array_get(levels, i);
    double value = lookup_number(level, "value");
    fputs("<tr><th scope=\"row\">", out);
    markup_text(out, lookup_text(level, "label"));
    fputs("</th>", out);
    page_number(out, lookup_number(level, "tets"), 12);
    page_number(out, lookup_number(level, "dofs"), 12);
    page_number(out, value, 8);
    page_number(out, value - before, 3);
    page_number(out, lookup_number(level, "cpu_s"), 3);
    fputs("</tr>\n", out);
    before = value;
  }
  fputs("</tbody></table></div>\n", out);
}

/* Whether the values tell what is left of the error. */
static void write_order(const json_t *solved, FILE *out) {
  double order = lookup_number(solved, "order");
  const char *why = lookup_text(solved, "why_not");
  bool asymptotic = json_is_true(lookup(solved, "asymptotic"));
  if (asymptotic && isfinite(order))
    page_element(out, "p",
                 "Asymptotic: the values converge at the observed order %.2f, and what is left "
                 "is extrapolated from them.",
                 order);
  else if (asymptotic)
    page_element(out, "p",
                 "The values differ by no more than each is known by: there is no order to be "
                 "seen, and none is needed.");
  else
    page_element(out, "p", "Not asymptotic: %s. The interval is widened for that.", why);
}

corot_status goal_figures_meshes(const json_t *solved, FILE *out) {
  const json_t *levels = lookup(solved, "levels");
  meshes m;
  if (json_array_size(levels) == 0) return COROT_OK;
  COROT_TRY(meshes_create(levels, &m));
  page_section("mesh", "What finer meshes do to it", out);
  write_order(solved, out);
  page_hint(out);
  write_figure(solved, &m, out);
  write_table(levels, out);
  page_section_end(out);
  meshes_free(&m);
  return COROT_OK;
}
