#include "run_figures.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "figure.h"
#include "lookup.h"

enum { SERIES = 16 };

static const char time_label[] = "t [s]";

/* The columns of one figure over the table's t. */
typedef struct columns {
  const csv *table;
  double *t, *y[SERIES];
  figure_series series[SERIES];
  int n;
} columns;

static void columns_free(columns *c) {
  free(c->t);
  for (int k = 0; k < c->n; k++) free(c->y[k]);
}

static corot_status columns_begin(const csv *table, columns *c) {
  *c = (columns){.table = table};
  return csv_column(table, "t", &c->t);
}

/* Adds a column, if there is such a one, under another name. */
static corot_status columns_add(columns *c, int column, const char *name, figure_style style) {
  if (column < 0 || c->n == SERIES) return COROT_OK;
  COROT_TRY(csv_numbers(c->table, column, &c->y[c->n]));
  c->series[c->n] = (figure_series){name, style, c->table->nrow, c->t, c->y[c->n], NULL};
  c->n++;
  return COROT_OK;
}

static bool all_zero(const columns *c, int k) {
  for (int i = 0; i < c->table->nrow; i++)
    if (!(c->y[k][i] == 0 || isnan(c->y[k][i]))) return false;
  return true;
}

/* Takes back the column added last where there is nothing to see in it. */
static void drop_if_zero(columns *c) {
  if (c->n == 0 || !all_zero(c, c->n - 1)) return;
  c->n--;
  free(c->y[c->n]);
}

static bool is_statics(const run_folder *run) {
  return json_is_object(lookup(run->result, "statics"));
}

static const char *over(const run_folder *run) {
  return is_statics(run) ? "load factor times end time [s]" : time_label;
}

static corot_status probe(const run_folder *run, int column, FILE *out) {
  static const char *const component[] = {"ux", "uy", "uz"};
  char name[128], id[32];
  const char *title = run->probes.name[column];
  size_t length = strlen(title);
  snprintf(name, sizeof name, "Displacement of %.*s", (int)(length > 3 ? length - 3 : length),
           title);
  snprintf(id, sizeof id, "probe-%d", (column - 1) / 3);
  columns c;
  corot_status status = columns_begin(&run->probes, &c);
  for (int k = 0; k < 3 && status == COROT_OK; k++)
    status = columns_add(&c, column + k, component[k], FIGURE_LINE);
  if (status == COROT_OK)
    figure_write(&(figure){.id = id,
                           .title = name,
                           .x_label = over(run),
                           .y_label = "u [m]",
                           .time = true,
                           .nseries = c.n,
                           .series = c.series,
                           .floor = NAN},
                 out);
  columns_free(&c);
  return status;
}

corot_status run_figures_probes(const run_folder *run, FILE *out) {
  for (int column = 1; column + 2 < run->probes.ncolumn; column += 3)
    COROT_TRY(probe(run, column, out));
  return COROT_OK;
}

/* One column of steps.csv as a figure of its own. */
typedef struct step_figure {
  const char *column, *id, *title, *label, *caption;
  bool log, whole;
  figure_style style;
} step_figure;

static corot_status step_chart(const run_folder *run, const step_figure *f, FILE *out) {
  columns c;
  corot_status status = columns_begin(&run->steps, &c);
  if (status == COROT_OK)
    status = columns_add(&c, csv_find(&run->steps, f->column), f->title, f->style);
  if (status == COROT_OK) drop_if_zero(&c);
  if (status == COROT_OK && c.n > 0)
    figure_write(&(figure){.id = f->id,
                           .title = f->title,
                           .caption = f->caption,
                           .x_label = over(run),
                           .y_label = f->label,
                           .y_log = f->log,
                           .time = true,
                           .whole = f->whole,
                           .nseries = c.n,
                           .series = c.series,
                           .floor = NAN},
                 out);
  columns_free(&c);
  return status;
}

corot_status run_figures_steps(const run_folder *run, FILE *out) {
  static const step_figure dynamic[] = {
      {"h", "step-size", "Step size", "h [s]", NULL, true, false, FIGURE_STEPS},
      {"order", "order", "Order of the method", "order", NULL, false, true, FIGURE_STEPS},
      {"error", "error-estimate", "Estimated local error", "error / tolerance",
       "A step is accepted below 1.", true, false, FIGURE_LINE},
      {"newton", "newton", "Nonlinear iterations", "iterations a step", NULL, false, true,
       FIGURE_STEPS},
      {"angle_max", "frame-angle", "Largest turn of a frame in an update", "angle [rad]", NULL,
       true, false, FIGURE_POINTS},
  };
  static const step_figure statics[] = {
      {"h", "step-size", "Load step", "step [s]", NULL, false, false, FIGURE_STEPS},
      {"newton", "newton", "Newton iterations", "iterations a step", NULL, false, true,
       FIGURE_STEPS},
  };
  if (run->steps.nrow == 0) return COROT_OK;
  bool quasi = is_statics(run);
  int n = quasi ? 2 : 5;
  for (int k = 0; k < n; k++) COROT_TRY(step_chart(run, quasi ? &statics[k] : &dynamic[k], out));
  return COROT_OK;
}

/* Some columns of energy.csv; the first is shown in any case. */
static corot_status ledger(const run_folder *run, figure *f, int n, const char *const *column,
                           const char *const *name, FILE *out) {
  columns c;
  corot_status status = columns_begin(&run->energy, &c);
  for (int k = 0; k < n && status == COROT_OK; k++) {
    status = columns_add(&c, csv_find(&run->energy, column[k]), name[k], FIGURE_LINE);
    if (k > 0) drop_if_zero(&c);
  }
  f->x_label = over(run);
  f->nseries = c.n;
  f->series = c.series;
  if (status == COROT_OK && c.n > 0) figure_write(f, out);
  columns_free(&c);
  return status;
}

corot_status run_figures_energy(const run_folder *run, FILE *out) {
  static const char *const energies[] = {"external_work", "elastic", "kinetic", "dissipated"};
  static const char *const names[] = {"work of loads and supports", "elastic", "kinetic",
                                      "dissipated"};
  static const char *const errors[] = {"balance", "frame_energy"};
  static const char *const error_names[] = {"balance", "put in by frame updates"};
  if (run->energy.nrow == 0) return COROT_OK;
  figure all = {
      .id = "energies", .title = "Energies", .y_label = "energy [J]", .time = true, .floor = NAN};
  figure off = {.id = "balance",
                .title = "Energy balance",
                .y_label = "energy [J]",
                .time = true,
                .floor = NAN,
                .caption =
                    "What is there and was dissipated, less what was put in: the error of "
                    "the integration in energy."};
  COROT_TRY(ledger(run, &all, 4, energies, names, out));
  return ledger(run, &off, 2, errors, error_names, out);
}

corot_status run_figures_compare(const run_folder *run, FILE *out) {
  if (run->compare.nrow == 0) return COROT_OK;
  columns c;
  corot_status status = columns_begin(&run->compare, &c);
  for (int column = 1; column < run->compare.ncolumn && status == COROT_OK; column += 3)
    status = columns_add(&c, column, run->compare.name[column], FIGURE_LINE);
  if (status == COROT_OK)
    figure_write(&(figure){.id = "compare",
                           .title = "Internal forces against those of green",
                           .caption = "Of other strain measures in the same motion.",
                           .x_label = over(run),
                           .y_label = "relative difference",
                           .y_log = true,
                           .time = true,
                           .nseries = c.n,
                           .series = c.series,
                           .floor = NAN},
                 out);
  columns_free(&c);
  return status;
}
