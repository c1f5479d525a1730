/* Work-precision, and error against tolerance, as figures. */
#include "study_figures.h"

#include <math.h>
#include <stdlib.h>

#include "report/page/encode.h"
#include "report/page/figure.h"
#include "report/page/html.h"
#include "report/page/markup.h"
#include "report/read/lookup.h"

static void numbers(int n, const double *x, FILE *out) {
  fputc('[', out);
  for (int i = 0; i < n; i++) {
    if (i) fputc(',', out);
    encode_number(x[i], out);
  }
  fputc(']', out);
}

static void write_choices(const study_table *t, FILE *out) {
  fprintf(out, "{\"cost\":%d,\"error\":%d,\"costs\":[", t->cost, t->measure);
  for (int k = 0; k < STUDY_COSTS; k++) {
    if (k) fputc(',', out);
    encode_text(study_cost_label[k], out);
  }
  /* each error with its floor, and which cells are left out of its diagram */
  fputs("],\"errors\":[", out);
  for (int e = 0; e < t->nerror; e++) {
    char label[160];
    study_error_label(t->error_name[e], sizeof label, label);
    fputs(e ? ",{\"label\":" : "{\"label\":", out);
    encode_text(label, out);
    fputs(",\"floor\":", out);
    encode_number(study_floor(t, e), out);
    fputs(",\"leftOut\":", out);
    study_left_out(t, e, sizeof label, label);
    encode_text(label, out);
    fputc('}', out);
  }
  fputs("],\"series\":[", out);
  for (int k = 0; k < t->nseries; k++) {
    if (k) fputc(',', out);
    encode_text(t->series[k], out);
  }
  fputs("],\"cells\":[", out);
}

/* A cell that is done; errors that are not rated are left out. */
static void write_cell(const study_table *t, const study_cell *c, FILE *out) {
  fprintf(out, "{\"series\":%d,\"id\":", c->series);
  encode_text(c->id, out);
  fputs(",\"tolerance\":", out);
  encode_number(c->tolerance, out);
  fputs(",\"cost\":", out);
  numbers(STUDY_COSTS, c->cost, out);
  fputs(",\"low\":", out);
  numbers(STUDY_COSTS, c->low, out);
  fputs(",\"high\":", out);
  numbers(STUDY_COSTS, c->high, out);
  fputs(",\"error\":[", out);
  for (int e = 0; e < t->nerror; e++) {
    if (e) fputc(',', out);
    encode_number(study_cell_rated(c, e) ? fabs(c->error[e]) : NAN, out);
  }
  fputs("]}", out);
}

void study_figures_precision(const study_table *t, FILE *out) {
  page_section("precision", "Work and precision", out);
  fputs(
      "<p>Each point is a run: how large its error is, and what it costs. The lower left is where "
      "one wants to be.</p>\n",
      out);
  page_hint(out);
  fputs(
      "<figure class=\"precision\" id=\"work-precision\">"
      "<script type=\"application/json\">",
      out);
  write_choices(t, out);
  for (int i = 0, n = 0; i < t->ncell; i++) {
    if (t->cell[i].status != STUDY_DONE) continue;
    if (n++) fputc(',', out);
    write_cell(t, &t->cell[i], out);
  }
  fputs("]}</script></figure>\n", out);
  page_section_end(out);
}

static void write_fits(const study_table *t, FILE *out) {
  const json_t *fits = lookup(t->root, "fits");
  if (json_array_size(fits) == 0) return;
  fputs(
      "<p>Lines through the points: error = constant · tolerance<sup>exponent</sup>. Where the "
      "exponent is 1, a tenth of the tolerance is a tenth of the error.</p>\n"
      "<div class=\"scroll\"><table><thead><tr><th>series</th><th class=\"number\">exponent</th>"
      "<th class=\"number\">constant</th><th class=\"number\">scatter, decades</th><th>verdict</th>"
      "</tr></thead><tbody>\n",
      out);
  /* a row for each series */
  for (size_t i = 0; i < json_array_size(fits); i++) {
    const json_t *fit = json_array_get(fits, i);
    static const char *const key[] = {"exponent", "constant", "residual"};
    fputs("<tr><th scope=\"row\">", out);
    markup_text(out, lookup_text(fit, "series"));
    fputs("</th>", out);
    for (int k = 0; k < 3; k++) page_number(out, lookup_number(fit, key[k]), 2);
    fputs("<td>", out);
    markup_text(out, lookup_text(fit, "verdict"));
    fputs("</td></tr>\n", out);
  }
  fputs("</tbody></table></div>\n", out);
}

static void draw_tolerance(const study_table *t, double *x, double *y, figure_series *series,
                           FILE *out) {
  char label[160];
  const char *key = "";
  /* the points of a series stand together, as its cells do */
  for (int i = 0, k = 0; i < t->ncell; i++) {
    const study_cell *c = &t->cell[i];
    figure_series *s = &series[c->series];
    if (!s->name) *s = (figure_series){t->series[c->series], FIGURE_MARKED, 0, x + k, y + k, NULL};
    if (!study_cell_rated(c, t->measure) || !isfinite(c->tolerance)) continue;
    x[k] = c->tolerance;
    y[k] = fabs(c->error[t->measure]);
    key = c->key;
    s->n++;
    k++;
  }
  study_error_label(t->error_name[t->measure], sizeof label, label);
  figure_write(&(figure){.id = "error-tolerance",
                         .title = "Error against tolerance",
                         .x_label = *key ? key : "tolerance",
                         .y_label = label,
                         .x_log = true,
                         .y_log = true,
                         .tall = true,
                         .nseries = t->nseries,
                         .series = series,
                         .floor = study_floor(t, t->measure)},
               out);
}

corot_status study_figures_tolerance(const study_table *t, FILE *out) {
  size_t n = (size_t)t->ncell + 1;
  double *x = malloc(n * sizeof *x), *y = malloc(n * sizeof *y);
  figure_series *series = calloc((size_t)t->nseries + 1, sizeof *series);
  corot_status status = COROT_OK;
  if (x && y && series) {
    page_section("tolerance", "Does the error follow the tolerance?", out);
    draw_tolerance(t, x, y, series, out);
    write_fits(t, out);
    page_section_end(out);
  } else {
    status = corot_fail(COROT_ENOMEM, "%d cells: out of memory", t->ncell);
  }
  free(x);
  free(y);
  free(series);
  return status;
}
