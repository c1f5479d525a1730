/* Writes what has been collected, and remarks on what a reader of the tables must know. */
#include "write_tables.h"

#include <string.h>

#include "app/scenario/warnings.h"
#include "app/text/escape.h"
#include "app/text/json_text.h"
#include "report/read/lookup.h"
#include "study/measure/collect.h"
#include "study/plan/json_file.h"
#include "table_csv.h"
#include "table_sqlite.h"

/* "warning: bending: 2 of 8 cells: ID ID", all too many left out. */
static void tell_code(const json_t *cells, const char *code, FILE *out) {
  enum { MOST = 8 };
  size_t count = 0, told = 0;
  for (size_t i = 0; i < json_array_size(cells); i++)
    count += lookup_has_text(json_object_get(json_array_get(cells, i), "warnings"), code);
  if (count == 0) return;
  fprintf(out, "warning: %s: %zu of %zu cells:", code, count, json_array_size(cells));
  for (size_t i = 0; i < json_array_size(cells) && told < MOST; i++) {
    const json_t *c = json_array_get(cells, i);
    if (!lookup_has_text(json_object_get(c, "warnings"), code)) continue;
    fprintf(out, " %s", json_string_value(json_object_get(c, "id")));
    told++;
  }
  fputs(count > MOST ? " ...\n" : "\n", out);
}

/* Runs that were lost, and why, all too many left out. */
static void tell_lost(const json_t *cells, FILE *out) {
  enum { MOST = 8 };
  size_t told = 0, count = 0;
  for (size_t i = 0; i < json_array_size(cells); i++) {
    const json_t *c = json_array_get(cells, i);
    const char *reason = json_string_value(json_object_get(c, "reason"));
    if (!reason || strcmp(json_string_value(json_object_get(c, "status")), "missing") != 0)
      continue;
    if (++count > MOST) continue;
    told++;
    fprintf(out, "%s is missing: ", json_string_value(json_object_get(c, "id")));
    escape_terminal(reason, out);
    fputc('\n', out);
  }
  if (count > told) fprintf(out, "and %zu more cells\n", count - told);
}

static void warn(const json_t *table, FILE *out) {
  const char *mixed = json_string_value(json_object_get(table, "mixed"));
  const json_t *references = json_object_get(table, "references");
  const json_t *cells = json_object_get(table, "cells");
  int nbelow = 0;
  for (size_t i = 0; i < json_array_size(references); i++) {
    const json_t *r = json_array_get(references, i);
    if (!json_is_true(json_object_get(r, "agree"))) {
      fprintf(out, "reference %zu: ", i);
      escape_terminal(json_string_value(json_object_get(r, "note")), out);
      fputc('\n', out);
    }
  }
  for (size_t i = 0; i < json_array_size(cells); i++)
    nbelow += json_is_true(json_object_get(json_array_get(cells, i), "below_floor"));
  if (nbelow > 0)
    fprintf(out, "%d of %zu cells are not rated: less than ten times what the references know\n",
            nbelow, json_array_size(cells));
  if (mixed) {
    fputs("warning: ", out);
    escape_terminal(mixed, out);
    fputc('\n', out);
  }
  for (int code = 0; code < WARNING_CODES; code++) tell_code(cells, warning_kinds[code].word, out);
}

corot_status write_tables(const manifest *m, const char *dir, bool looked, FILE *remarks,
                          int *ndamaged) {
  json_t *table = NULL;
  json_text_starved(); /* an earlier lack of memory is none of this table */
  COROT_TRY(collect_table(m, dir, looked, &table, ndamaged));
  corot_status status = json_file_write(dir, "table.json", table);
  if (status == COROT_OK) status = table_write_csv(table, dir);
  if (status == COROT_OK) status = table_write_sqlite(table, dir);
  if (status == COROT_OK && remarks && !looked) tell_lost(json_object_get(table, "cells"), remarks);
  if (status == COROT_OK && remarks) warn(table, remarks);
  json_decref(table);
  return status;
}
