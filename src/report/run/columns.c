/* From tables to the series of a figure. */
#include "columns.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "report/read/lookup.h"

void columns_free(columns *c) {
  free(c->t);
  for (int k = 0; k < c->n; k++) free(c->y[k]);
}

corot_status columns_begin(const run_folder *run, const csv *table, columns *c) {
  *c = (columns){.table = table};
  COROT_TRY(csv_column(table, "t", &c->t));
  double unit = run_folder_unit(run);
  for (int i = 0; i < table->nrow; i++) c->t[i] /= unit;
  return COROT_OK;
}

corot_status columns_add(columns *c, int column, const char *name, figure_style style) {
  if (column < 0 || c->n == COLUMNS_MOST) return COROT_OK;
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

void columns_drop_if_zero(columns *c) {
  if (c->n == 0 || !all_zero(c, c->n - 1)) return;
  c->n--;
  free(c->y[c->n]);
}

const char *columns_unit(const run_folder *run, const char *name) {
  const char *dot = strrchr(name, '.');
  char probe[160];
  if (!dot || dot - name >= (long)sizeof probe) return "";
  snprintf(probe, sizeof probe, "%.*s", (int)(dot - name), name);
  const json_t *of = json_object_get(lookup(run->result, "probes"), probe);
  const char *unit = json_string_value(json_object_get(json_object_get(of, "unit"), dot + 1));
  return unit ? unit : "";
}

int columns_find_triple(const csv *table, const char *ending, int from) {
  for (int i = from; i + 2 < table->ncolumn; i++) {
    size_t length = strlen(table->name[i]), end = strlen(ending);
    if (length >= end && strcmp(table->name[i] + length - end, ending) == 0) return i;
  }
  return -1;
}

corot_status columns_write(const run_folder *run, figure f, const columns *c, corot_status status,
                           FILE *out) {
  if (status != COROT_OK || c->n == 0) return status;
  if (!f.x_label) f.x_label = run_folder_is_static(run) ? "load factor" : "t [s]";
  f.nseries = c->n;
  f.series = c->series;
  f.floor = NAN;
  figure_write(&f, out);
  return COROT_OK;
}
