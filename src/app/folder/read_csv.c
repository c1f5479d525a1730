/* A file is loaded whole, counted, and cut into cells in place. */
#include "read_csv.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/text/escape.h"
#include "core/mesh/read/reader.h"
#include "folder.h"

void csv_free(csv *t) {
  free(t->text);
  free(t->name);
  free(t->cell);
  *t = (csv){0};
}

/* Ends the cell at *at with a 0, undoes its quotes, and goes past what separates it from the next.
 *whole is set to whether the row ends here, *end to whether the file does. */
static char *take_cell(char **at, bool *row_ends, bool *file_ends) {
  char *cell = *at, *to = cell, *from = cell;
  bool quoted = *from == '"';
  if (quoted) from++;
  for (; *from; from++) {
    if (quoted && from[0] == '"' && from[1] == '"')
      from++;
    else if (quoted && *from == '"') {
      quoted = false;
      continue;
    } else if (!quoted && (*from == ',' || *from == '\n' || *from == '\r'))
      break;
    *to++ = *from;
  }
  *row_ends = *from == '\n' || *from == '\r';
  *file_ends = *from == '\0';
  if (*from == '\r' && from[1] == '\n') from++;
  *at = *from ? from + 1 : from;
  *to = '\0';
  return escape_csv_undo(cell);
}

/* Takes a row of exactly n cells. *n < 0: of as many as there are, at most `most`; *n is set.
 *cut: the file ends within the row. */
static bool take_row(char **at, int *n, int most, char **cell, bool *cut) {
  bool row_ends = false, file_ends = false;
  int k = 0;
  while (!row_ends && !file_ends) {
    char *c = take_cell(at, &row_ends, &file_ends);
    if (k < most) cell[k] = c;
    k++;
  }
  *cut = file_ends;
  bool right = *n < 0 ? k <= most : k == *n;
  if (*n < 0) *n = k;
  return right;
}

/* No row has more cells than it has commas, no file more rows than it has lines. */
static size_t count(const char *text, char what) {
  size_t n = 0;
  for (; *text; text++) n += *text == what;
  return n;
}

enum { MOST_CELLS = 200000000 };

static corot_status parse(csv *t, const char *path) {
  char *at = t->text;
  size_t commas = count(t->text, ','), lines = count(t->text, '\n');
  if (commas + lines > MOST_CELLS)
    return corot_fail(COROT_EFORMAT, "%s: %zu cells, more than %d, the limit of a table", path,
                      commas + lines, MOST_CELLS);
  /* room for all, were every comma in the header, or none */
  bool cut = false;
  t->name = malloc((commas + 1) * sizeof *t->name);
  t->cell = malloc((commas + lines + 1) * sizeof *t->cell);
  if (!t->name || !t->cell) return corot_fail(COROT_ENOMEM, "%s: out of memory", path);
  t->ncolumn = -1;
  take_row(&at, &t->ncolumn, (int)commas + 1, t->name, &cut);
  if (cut) return corot_fail(COROT_EFORMAT, "%s: its header is cut short", path);
  /* a row that is cut is the last one of a run that was killed */
  while (*at) {
    char **row = t->cell + (size_t)t->nrow * (size_t)t->ncolumn;
    size_t left = commas + lines + 1 - (size_t)(row - t->cell);
    int most = left < (size_t)t->ncolumn ? (int)left : t->ncolumn, n = t->ncolumn;
    bool right = take_row(&at, &n, most, row, &cut);
    if (cut) break;
    if (!right || most < n)
      return corot_fail(COROT_EFORMAT, "%s: row %d has not the %d cells of the header", path,
                        t->nrow + 1, t->ncolumn);
    t->nrow++;
  }
  return COROT_OK;
}

corot_status csv_read(const char *dir, const char *name, csv *table) {
  char *path = folder_path(dir, name);
  if (!path) return COROT_ENOMEM;
  csv t = {0};
  size_t size;
  corot_status status = corot_file_load(path, &t.text, &size);
  if (status == COROT_OK) status = parse(&t, path);
  free(path);
  if (status != COROT_OK) {
    csv_free(&t);
    return status;
  }
  *table = t;
  return COROT_OK;
}

corot_status csv_read_if_there(const char *dir, const char *name, csv *table) {
  char *path = folder_path(dir, name);
  if (!path) return COROT_ENOMEM;
  bool there;
  corot_status status = folder_look(path, &there);
  free(path);
  COROT_TRY(status);
  if (there) return csv_read(dir, name, table);
  *table = (csv){0};
  return COROT_OK;
}

int csv_find(const csv *t, const char *name) {
  for (int i = 0; i < t->ncolumn; i++)
    if (strcmp(t->name[i], name) == 0) return i;
  return -1;
}

corot_status csv_numbers(const csv *t, int column, double **number) {
  double *x = malloc(((size_t)t->nrow + 1) * sizeof *x);
  if (!x) return corot_fail(COROT_ENOMEM, "out of memory");
  for (int i = 0; i < t->nrow; i++) {
    const char *cell = t->cell[(size_t)i * (size_t)t->ncolumn + (size_t)column];
    char *end;
    x[i] = strtod(cell, &end);
    if (end == cell || *end) x[i] = NAN;
  }
  *number = x;
  return COROT_OK;
}

corot_status csv_column(const csv *t, const char *name, double **number) {
  int column = csv_find(t, name);
  if (column < 0) return corot_fail(COROT_EFORMAT, "a table of the run has no column %s", name);
  return csv_numbers(t, column, number);
}
