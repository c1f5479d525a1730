/* What an equilibrium's report shows in place of motion: curves over the load factor, and how each
   load step was solved. */
#include "static_figures.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "columns.h"
#include "report/read/lookup.h"
#include "run_figures.h"

/* Three columns of one name, at most, over the load factor; what is zero throughout is left out
   unless all are. */
static corot_status take_triple(const run_folder *run, const csv *table, int column,
                                const char *const name[3], columns *c) {
  COROT_TRY(columns_begin(run, table, c));
  for (int k = 0; k < 3; k++) {
    COROT_TRY(columns_add(c, column + k, name[k], FIGURE_MARKED));
    if (c->n > 1) columns_drop_if_zero(c);
  }
  return COROT_OK;
}

/* "TITLE PREFIX" of the column PREFIX.xx */
static void make_title(const char *title, const char *column, size_t size, char *text) {
  snprintf(text, size, "%s %.*s", title, (int)strlen(column) - 3, column);
}

static corot_status probe(const run_folder *run, const csv *table, int column, int number,
                          FILE *out) {
  static const char *const component[] = {"ux", "uy", "uz"};
  char name[160], id[32];
  make_title("Load over displacement of", table->name[column], sizeof name, name);
  snprintf(id, sizeof id, "curve-%d", number);
  columns c;
  corot_status status = take_triple(run, table, column, component, &c);
  for (int k = 0; k < c.n; k++) c.series[k].x = c.y[k], c.series[k].y = c.t;
  const figure f = {.id = id, .title = name, .x_label = "u [m]", .y_label = "load factor"};
  status = columns_write(run, f, &c, status, out);
  columns_free(&c);
  return status;
}

corot_status static_figures_probes(const run_folder *run, FILE *out) {
  const csv *table = &run->probes;
  int number = 0;
  for (int i = 0; (i = columns_find_triple(table, ".ux", i)) >= 0; i += 3)
    COROT_TRY(probe(run, table, i, number++, out));
  return run_figures_quantities(run, out);
}

static corot_status reaction(const run_folder *run, int column, int number, FILE *out) {
  static const char *const component[] = {"fx", "fy", "fz"};
  char name[160], id[32];
  make_title("Supports of", run->reactions.name[column], sizeof name, name);
  snprintf(id, sizeof id, "reaction-%d", number);
  columns c;
  corot_status status = take_triple(run, &run->reactions, column, component, &c);
  const figure f = {.id = id,
                    .title = name,
                    .caption = "The force of the supports on the body.",
                    .y_label = "force [N]",
                    .time = true};
  status = columns_write(run, f, &c, status, out);
  columns_free(&c);
  return status;
}

corot_status static_figures_reactions(const run_folder *run, FILE *out) {
  int number = 0;
  for (int i = 0; (i = columns_find_triple(&run->reactions, ".fx", i)) >= 0; i += 3)
    COROT_TRY(reaction(run, i, number++, out));
  return COROT_OK;
}

/* --- Residuals --- */

/* One after the other, the load steps apart by a point that is no number. */
typedef struct residuals {
  int n;
  double *x, *y;     /* [n] iteration, residual over the largest force */
  char (*text)[64];  /* [n] */
  const char **note; /* [n] */
} residuals;

static void residuals_free(residuals *r) {
  free(r->x);
  free(r->y);
  free(r->text);
  free(r->note);
}

static corot_status residuals_create(size_t most, residuals *r) {
  *r = (residuals){.x = malloc((most + 1) * sizeof *r->x),
                   .y = malloc((most + 1) * sizeof *r->y),
                   .text = malloc((most + 1) * sizeof *r->text),
                   .note = malloc((most + 1) * sizeof *r->note)};
  if (r->x && r->y && r->text && r->note) return COROT_OK;
  residuals_free(r);
  return corot_fail(COROT_ENOMEM, "the residuals of %zu iterations: out of memory", most);
}

static void add_point(residuals *r, double x, double y, const char *format, double factor, int k) {
  r->x[r->n] = x, r->y[r->n] = y;
  snprintf(r->text[r->n], sizeof r->text[0], format, factor, k);
  r->note[r->n] = r->text[r->n];
  r->n++;
}

/* Adds a step, whose first point is at iteration *at, and moves *at on to the last. */
static void add_step(residuals *r, const json_t *step, double *at) {
  const json_t *list = lookup(step, "residual");
  double force = lookup_number(step, "force"), factor = lookup_number(step, "factor");
  if (r->n > 0) add_point(r, *at, NAN, "", 0, 0);
  for (size_t k = 0; k < json_array_size(list); k++) {
    double y = json_number_value(json_array_get(list, k)) / (force > 0 ? force : 1);
    if (k > 0) *at += 1;
    add_point(r, *at, y, "load factor %.6g, iteration %d", factor, (int)k);
  }
}

static corot_status write_residuals(const run_folder *run, const json_t *steps, FILE *out) {
  size_t most = 0;
  for (size_t i = 0; i < json_array_size(steps); i++)
    most += json_array_size(lookup(json_array_get(steps, i), "residual")) + 1;
  residuals r;
  COROT_TRY(residuals_create(most, &r));
  /* a point for each iteration, and the tolerance as a line */
  double at = 0, tolerance = lookup_number(run->result, "statics.tolerance");
  for (size_t i = 0; i < json_array_size(steps); i++) add_step(&r, json_array_get(steps, i), &at);
  const double ends[2] = {0, at}, level[2] = {tolerance, tolerance};
  const figure_series series[2] = {{"residual", FIGURE_MARKED, r.n, r.x, r.y, r.note},
                                   {"tolerance", FIGURE_LINE, 2, ends, level, NULL}};
  if (r.n > 0)
    figure_write(&(figure){.id = "residuals",
                           .title = "Residuals",
                           .caption = "Where each Newton iteration begins, and at the end of each "
                                      "load step: the largest component over the largest force on "
                                      "a node.",
                           .x_label = "Newton iterations since the start",
                           .y_label = "residual / force",
                           .y_log = true,
                           .nseries = tolerance > 0 ? 2 : 1,
                           .series = series,
                           .floor = NAN},
                 out);
  residuals_free(&r);
  return COROT_OK;
}

/* Every load step as a point at the factor it reached. */
static corot_status write_steps(const run_folder *run, FILE *out) {
  if (run->steps.nrow < 2) return COROT_OK;
  columns c;
  corot_status status = columns_begin(run, &run->steps, &c);
  if (status == COROT_OK)
    status = columns_add(&c, csv_find(&run->steps, "newton"), "Newton iterations", FIGURE_MARKED);
  const figure f = {.id = "newton",
                    .title = "Newton iterations of each load step",
                    .x_label = "load factor reached",
                    .y_label = "iterations a step",
                    .time = true,
                    .whole = true};
  status = columns_write(run, f, &c, status, out);
  columns_free(&c);
  return status;
}

corot_status static_figures_steps(const run_folder *run, FILE *out) {
  COROT_TRY(write_residuals(run, lookup(run->result, "statics.steps"), out));
  return write_steps(run, out);
}
