/* Columns of the tables of a run, made into figures. */
#include "run_figures.h"

#include <stdbool.h>
#include <string.h>

#include "columns.h"
#include "report/page/figure.h"
#include "report/read/lookup.h"

static corot_status probe(const run_folder *run, const csv *table, int column, int number,
                          FILE *out) {
  static const char *const component[] = {"ux", "uy", "uz"};
  char name[128], id[32];
  const char *title = table->name[column];
  snprintf(name, sizeof name, "Displacement of %.*s", (int)strlen(title) - 3, title);
  snprintf(id, sizeof id, "probe-%d", number);
  columns c;
  corot_status status = columns_begin(run, table, &c);
  for (int k = 0; k < 3 && status == COROT_OK; k++)
    status = columns_add(&c, column + k, component[k], FIGURE_LINE);
  const figure f = {.id = id, .title = name, .y_label = "u [m]", .time = true};
  status = columns_write(run, f, &c, status, out);
  columns_free(&c);
  return status;
}

/* --- Probes of other quantities --- */

static size_t probe_length(const char *name) {
  const char *dot = strrchr(name, '.');
  return dot ? (size_t)(dot - name) : 0;
}

/* Whether a column goes on with what is shown of the one before: the same probe and unit. */
static bool goes_on(const run_folder *run, const csv *table, int i) {
  const char *a = table->name[i - 1], *b = table->name[i];
  size_t n = probe_length(a);
  return n == probe_length(b) && memcmp(a, b, n) == 0 &&
         strcmp(columns_unit(run, a), columns_unit(run, b)) == 0;
}

/* Columns `first` to first + n - 1 of one probe. */
static corot_status other_probe(const run_folder *run, const csv *table, int first, int n,
                                int number, FILE *out) {
  char name[128], id[32], label[64];
  const char *title = table->name[first], *unit = columns_unit(run, title);
  snprintf(name, sizeof name, "%.*s", (int)probe_length(title), title);
  snprintf(id, sizeof id, "quantity-%d", number);
  snprintf(label, sizeof label, "%s%s%s", *unit ? "[" : "", unit, *unit ? "]" : "");
  columns c;
  corot_status status = columns_begin(run, table, &c);
  for (int k = 0; k < n && status == COROT_OK; k++)
    status =
        columns_add(&c, first + k, table->name[first + k] + probe_length(title) + 1, FIGURE_LINE);
  const figure f = {.id = id, .title = name, .y_label = label, .time = true};
  status = columns_write(run, f, &c, status, out);
  columns_free(&c);
  return status;
}

corot_status run_figures_quantities(const run_folder *run, FILE *out) {
  const csv *all = &run->probes;
  int number = 0;
  for (int i = 1, n; i < all->ncolumn; i += n) {
    for (n = 1; i + n < all->ncolumn && goes_on(run, all, i + n);) n++;
    const char *name = all->name[i];
    if (!probe_length(name) || strcmp(name + probe_length(name), ".ux") == 0) continue;
    const csv *table = run_folder_finest(run, all, name);
    int first = csv_find(table, name);
    if (first >= 0 && first + n <= table->ncolumn)
      COROT_TRY(other_probe(run, table, first, n, number++, out));
  }
  return COROT_OK;
}

corot_status run_figures_probes(const run_folder *run, FILE *out) {
  int number = 0;
  for (int i = 0; (i = columns_find_triple(&run->probes, ".ux", i)) >= 0; i += 3) {
    const csv *table = run_folder_finest(run, &run->probes, run->probes.name[i]);
    int column = csv_find(table, run->probes.name[i]);
    if (column + 2 < table->ncolumn) COROT_TRY(probe(run, table, column, number++, out));
  }
  return run_figures_quantities(run, out);
}

/* One column of steps.csv as a figure of its own. */
typedef struct step_figure {
  const char *column, *id, *title, *label, *caption;
  bool log, whole;
  figure_style style;
} step_figure;

static corot_status step_chart(const run_folder *run, const step_figure *f, FILE *out) {
  columns c;
  corot_status status = columns_begin(run, &run->steps, &c);
  if (status == COROT_OK)
    status = columns_add(&c, csv_find(&run->steps, f->column), f->title, f->style);
  if (status == COROT_OK) columns_drop_if_zero(&c);
  const figure chart = {.id = f->id,
                        .title = f->title,
                        .caption = f->caption,
                        .y_label = f->label,
                        .y_log = f->log,
                        .time = true,
                        .whole = f->whole};
  status = columns_write(run, chart, &c, status, out);
  columns_free(&c);
  return status;
}

corot_status run_figures_steps(const run_folder *run, FILE *out) {
  static const step_figure figures[] = {
      {"h", "step-size", "Step size", "h [s]", NULL, true, false, FIGURE_STEPS},
      {"order", "order", "Order of the method", "order", NULL, false, true, FIGURE_STEPS},
      {"error", "error-estimate", "Estimated local error", "error / tolerance",
       "A step is accepted below 1.", true, false, FIGURE_LINE},
      {"newton", "newton", "Nonlinear iterations", "iterations a step", NULL, false, true,
       FIGURE_STEPS},
      {"angle_max", "frame-angle", "Largest turn of a frame in an update", "angle [rad]", NULL,
       true, false, FIGURE_POINTS},
  };
  if (run->steps.nrow == 0) return COROT_OK;
  double steps = lookup_number(run->result, "steps_csv.steps");
  if (steps > lookup_number(run->result, "steps_csv.rows"))
    fprintf(out, "<p class=\"note\">Of %.0f steps, %d are shown: %s.</p>\n", steps, run->steps.nrow,
            lookup_text(run->result, "steps_csv.kept"));
  for (size_t k = 0; k < sizeof figures / sizeof *figures; k++)
    COROT_TRY(step_chart(run, &figures[k], out));
  return COROT_OK;
}

/* Some columns of the energies; the first is shown in any case. */
static corot_status ledger(const run_folder *run, figure f, int n, const char *const *column,
                           const char *const *name, FILE *out) {
  columns c;
  const csv *table = run_folder_finest(run, &run->energy, column[0]);
  corot_status status = columns_begin(run, table, &c);
  for (int k = 0; k < n && status == COROT_OK; k++) {
    int before = c.n;
    status = columns_add(&c, csv_find(table, column[k]), name[k], FIGURE_LINE);
    if (k > 0 && c.n > before) columns_drop_if_zero(&c);
  }
  status = columns_write(run, f, &c, status, out);
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
  const figure all = {.id = "energies", .title = "Energies", .y_label = "energy [J]", .time = true};
  const figure off = {.id = "balance",
                      .title = "Energy balance",
                      .y_label = "energy [J]",
                      .time = true,
                      .caption =
                          "What is there and was dissipated, less what was put in: the error of "
                          "the integration in energy."};
  COROT_TRY(ledger(run, all, 4, energies, names, out));
  if (run_folder_is_static(run)) return COROT_OK; /* a load step is no step in time */
  return ledger(run, off, 2, errors, error_names, out);
}

corot_status run_figures_compare(const run_folder *run, FILE *out) {
  if (run->compare.nrow == 0) return COROT_OK;
  columns c;
  corot_status status = columns_begin(run, &run->compare, &c);
  for (int column = 1; column < run->compare.ncolumn && status == COROT_OK; column += 3)
    status = columns_add(&c, column, run->compare.name[column], FIGURE_LINE);
  const figure f = {.id = "compare",
                    .title = "Internal forces against those of green",
                    .caption = "Of other strain measures in the same motion.",
                    .y_label = "relative difference",
                    .y_log = true,
                    .time = true};
  status = columns_write(run, f, &c, status, out);
  columns_free(&c);
  return status;
}
