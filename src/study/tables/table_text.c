/* Columns as wide as their contents; units once. */
#include "table_text.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "app/text/escape.h"
#include "app/text/json_text.h"
#include "app/text/no_memory.h"

enum { MAX_COLUMNS = 80, CELL = 40 };

/* One column: where its values are, and how they are written. */
typedef struct column {
  const char *title, *group, *key;
  int width;
  bool number;    /* to the right */
  bool is_signed; /* it is an error against a known value */
} column;

typedef struct layout {
  int n;
  column column[MAX_COLUMNS];
} layout;

static void add(layout *l, const char *title, const char *group, const char *key, bool number) {
  if (l->n < MAX_COLUMNS)
    l->column[l->n++] = (column){title, group, key, (int)strlen(title), number, false};
}

static const json_t *value_of(const json_t *cell, const column *c) {
  return json_object_get(c->group ? json_object_get(cell, c->group) : cell, c->key);
}

static bool is_unrated(const json_t *cell, const char *name) {
  const json_t *list = json_object_get(cell, "unrated");
  for (size_t i = 0; i < json_array_size(list); i++) {
    const char *listed = json_string_value(json_array_get(list, i));
    if (listed && strcmp(listed, name) == 0) return true;
  }
  return false;
}

static void write_cell(const json_t *cell, const column *c, char text[CELL]) {
  const json_t *value = value_of(cell, c);
  bool error = c->group && strcmp(c->group, "error") == 0;
  bool quantity = c->group && strcmp(c->group, "quantity") == 0;
  bool imbalance = c->group && strcmp(c->group, "drift") == 0;
  bool doubtful = error && is_unrated(cell, c->key);
  const json_t *most = doubtful ? json_object_get(json_object_get(cell, "at_most"), c->key) : NULL;
  if (json_is_real(most))
    snprintf(text, CELL, "< %.1e", json_real_value(most));
  else if (json_is_string(value))
    escape_line_cut(json_string_value(value), CELL, text);
  else if (json_is_integer(value))
    snprintf(text, CELL, "%lld", (long long)json_integer_value(value));
  else if (json_is_real(value))
    snprintf(text, CELL,
             doubtful    ? "(%.1e)"
             : error     ? (c->is_signed ? "%+.2e" : "%.2e")
             : quantity  ? "%.6g"
             : imbalance ? "%.1e"
             : c->group  ? "%.4g"
                         : "%.2f",
             json_real_value(value));
  else if (!value || json_is_null(value))
    snprintf(text, CELL, "-");
  else if (json_is_boolean(value))
    snprintf(text, CELL, "%s", json_is_true(value) ? "yes" : "no");
  else
    snprintf(text, CELL, "[...]");
}

static bool has_numbers(const json_t *cells, const column *c) {
  bool found = false;
  for (size_t i = 0; i < json_array_size(cells); i++) {
    const json_t *value = value_of(json_array_get(cells, i), c);
    if (json_is_string(value)) return false;
    found |= json_is_number(value);
  }
  return found;
}

static bool is_known(const json_t *known, const char *quantity) {
  bool found = false;
  for (size_t i = 0; i < json_array_size(known); i++) {
    const char *text = json_string_value(json_object_get(json_array_get(known, i), "measure"));
    found |= text && strcmp(text, quantity) == 0;
  }
  return found;
}

static void lay_out(const json_t *table, layout *l) {
  static const char *const errors[] = {"displacement", "velocity", "energy"};
  const json_t *columns = json_object_get(table, "columns");
  const json_t *cells = json_object_get(table, "cells");
  const json_t *quantities = json_object_get(table, "quantities");
  const json_t *known = json_object_get(table, "known");
  bool norms = json_array_size(known) == 0 || json_array_size(json_object_get(table, "references"));
  /* the columns */
  for (size_t i = 0; i < json_array_size(columns); i++) {
    const char *key = json_string_value(json_array_get(columns, i));
    add(l, key, "settings", key, false);
    l->column[l->n - 1].number = has_numbers(cells, &l->column[l->n - 1]);
  }
  add(l, "status", NULL, "status", false);
  add(l, "cpu [s]", "cost", "cpu", true);
  add(l, "steps", "cost", "steps", true);
  add(l, "rhs", "cost", "rhs", true);
  add(l, "factorisations", "cost", "factorisations", true);
  for (size_t i = 0; norms && i < sizeof errors / sizeof *errors; i++)
    add(l, errors[i], "error", errors[i], true);
  if (norms) add(l, "digits", NULL, "digits", true);
  add(l, "imbalance", "drift", "energy", true);
  if (!has_numbers(cells, &l->column[l->n - 1])) l->n--;
  for (size_t i = 0; i < json_array_size(quantities); i++) {
    const char *text = json_string_value(json_array_get(quantities, i));
    if (!text) continue;
    add(l, text, "quantity", text, true);
    add(l, "error", "error", text, true);
    l->column[l->n - 1].is_signed = is_known(known, text);
  }
  if (json_array_size(known) > 1) add(l, "total error", "error", "total", true);

  /* each as wide as its widest cell */
  char text[CELL];
  for (int k = 0; k < l->n; k++)
    for (size_t i = 0; i < json_array_size(cells); i++) {
      write_cell(json_array_get(cells, i), &l->column[k], text);
      int length = (int)strlen(text);
      if (length > l->column[k].width) l->column[k].width = length;
    }
}

static void print_cell(const column *c, const char *text, bool last, FILE *out) {
  if (c->number)
    fprintf(out, "%*s%s", c->width, text, last ? "\n" : "  ");
  else
    fprintf(out, "%-*s%s", last ? 0 : c->width, text, last ? "\n" : "  ");
}

static void print_cells(const json_t *table, FILE *out) {
  layout l = {0};
  char text[CELL];
  lay_out(table, &l);
  const json_t *cells = json_object_get(table, "cells");
  for (int k = 0; k < l.n; k++) print_cell(&l.column[k], l.column[k].title, k == l.n - 1, out);
  for (size_t i = 0; i < json_array_size(cells); i++)
    for (int k = 0; k < l.n; k++) {
      write_cell(json_array_get(cells, i), &l.column[k], text);
      print_cell(&l.column[k], text, k == l.n - 1, out);
    }
}

static const char *text_at(const json_t *object, const char *key) {
  const char *text = json_string_value(json_object_get(object, key));
  return text ? text : "-";
}

static double number_at(const json_t *object, const char *key) {
  return json_number_value(json_object_get(object, key));
}

static corot_status print_references(const json_t *table, FILE *out) {
  const json_t *list = json_object_get(table, "references");
  const char *word = json_is_true(json_object_get(table, "static")) ? "tolerance" : "rtol";
  if (json_array_size(list) > 0) fputs("\nreferences\n", out);
  for (size_t i = 0; i < json_array_size(list); i++) {
    const json_t *r = json_array_get(list, i);
    char *settings = json_text_dump_plain(json_object_get(r, "settings"), JSON_REAL_PRECISION(6));
    if (!settings && json_object_get(r, "settings")) return no_memory();
    fprintf(out, "  %s, %s %.2g: %s\n", settings ? settings : "-", word, number_at(r, "rtol"),
            text_at(r, "note"));
    free(settings);
  }
  return COROT_OK;
}

static void print_known(const json_t *list, FILE *out) {
  if (json_array_size(list) > 0)
    fputs("\nknown values, against which errors are total, signed and relative\n", out);
  for (size_t i = 0; i < json_array_size(list); i++) {
    const json_t *k = json_array_get(list, i);
    fputs("  ", out);
    escape_line(text_at(k, "measure"), out);
    fprintf(out, " = %.6g", number_at(k, "value"));
    if (number_at(k, "within") > 0) fprintf(out, ", within %.3g", number_at(k, "within"));
    if (number_at(k, "scale") != fabs(number_at(k, "value")))
      fprintf(out, ", relative to %.6g", number_at(k, "scale"));
    fputc('\n', out);
  }
}

static void print_space(const json_t *list, FILE *out) {
  if (json_array_size(list) > 0) fputs("\nspace, by references of neighbouring levels\n", out);
  for (size_t i = 0; i < json_array_size(list); i++) {
    const json_t *s = json_array_get(list, i);
    bool quantity = strpbrk(text_at(s, "measure"), "(@") != NULL;
    fprintf(out, "  mesh.refine %.0f, reference %.0f%s%s: %s\n", number_at(s, "refine"),
            number_at(s, "reference"), quantity ? ", " : "", quantity ? text_at(s, "measure") : "",
            text_at(s, "verdict"));
  }
}

/* Of a fit through too few points, of which there may be one for each series. */
static bool says_nothing(const json_t *fit) {
  return strncmp(text_at(fit, "verdict"), "too few points", 14) == 0;
}

static void print_fits(const json_t *list, FILE *out) {
  size_t nothing = 0;
  for (size_t i = 0; i < json_array_size(list); i++)
    nothing += says_nothing(json_array_get(list, i));
  for (size_t i = 0; i < json_array_size(list); i++) {
    const json_t *f = json_array_get(list, i);
    if (nothing > 1 && says_nothing(f)) continue;
    bool measure = json_is_string(json_object_get(f, "measure"));
    fprintf(out, "  %s%s", measure ? text_at(f, "measure") : "", measure ? ", " : "");
    escape_line(text_at(f, "series"), out);
    fputs(": ", out);
    if (json_is_number(json_object_get(f, "exponent")))
      fprintf(out, "exponent %.2f, constant %.2g, within a factor of %.2g, over %s: ",
              number_at(f, "exponent"), number_at(f, "constant"), pow(10, number_at(f, "residual")),
              text_at(f, "tolerance_key"));
    fprintf(out, "%s\n", text_at(f, "verdict"));
  }
  if (nothing > 1) fprintf(out, "  too few points to say of %zu series\n", nothing);
}

static void print_rankings(const json_t *table, FILE *out) {
  const json_t *list = json_object_get(table, "rankings");
  bool total = strcmp(text_at(table, "measure"), "total") == 0;
  if (json_array_size(list) > 0)
    fprintf(out, "\ncheapest by %s for %s%s of at most\n", text_at(table, "cost"),
            total ? "a total error" : "an error of ", total ? "" : text_at(table, "measure"));
  for (size_t i = 0; i < json_array_size(list); i++) {
    const json_t *entry = json_array_get(list, i), *best = json_object_get(entry, "best");
    fprintf(out, "  %.0e: ", number_at(entry, "error"));
    for (size_t k = 0; k < json_array_size(best); k++) {
      const json_t *b = json_array_get(best, k);
      fputs(k > 0 ? ", " : "", out);
      escape_line(text_at(b, "series"), out);
      if (json_is_number(json_object_get(b, "tolerance")))
        fprintf(out, " at %.3g", number_at(b, "tolerance"));
      fprintf(out, " (%.3g)", number_at(b, "cost"));
    }
    fputc('\n', out);
  }
}

static corot_status check_columns(const json_t *table) {
  const json_t *columns = json_object_get(table, "columns");
  for (size_t i = 0; i < json_array_size(columns); i++)
    if (!json_is_string(json_array_get(columns, i)))
      return corot_fail(COROT_EFORMAT, "table.json: the name of column %zu is not a text", i);
  return COROT_OK;
}

corot_status table_print(const json_t *table, FILE *out) {
  if (!json_is_array(json_object_get(table, "cells")) ||
      !json_is_array(json_object_get(table, "columns")))
    return corot_fail(COROT_EFORMAT, "table.json: not a table of a study");
  COROT_TRY(check_columns(table));
  escape_line(text_at(table, "title"), out);
  fputs("\n\n", out);
  print_cells(table, out);
  if (json_is_string(json_object_get(table, "shared")))
    fprintf(out, "\n%s\n", text_at(table, "shared"));
  if (json_is_string(json_object_get(table, "mixed")))
    fprintf(out, "\n%s\n", text_at(table, "mixed"));
  print_known(json_object_get(table, "known"), out);
  COROT_TRY(print_references(table, out));
  print_space(json_object_get(table, "space"), out);
  if (json_array_size(json_object_get(table, "fits")) > 0)
    fputs("\nerror = constant * tolerance^exponent\n", out);
  print_fits(json_object_get(table, "fits"), out);
  print_fits(json_object_get(table, "quantity_fits"), out);
  print_rankings(table, out);
  return COROT_OK;
}
