/* Names of columns, and a value for each cell. */
#include "flat.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static const char *const costs[] = {"cpu",      "cpu_min", "cpu_max", "wall",           "wall_min",
                                    "wall_max", "steps",   "rhs",     "factorisations", "solves",
                                    "repeats"};
static const char *const before[] = {"id", "series"};
static const char *const after[] = {"tolerance", "tolerance_key", "status", "reason"};
static const char *const last[] = {"digits", "below_floor", "note", "shared", "warnings"};
static const char *const drifts[] = {"energy", "momentum"};

#define COUNT(list) (sizeof(list) / sizeof *(list))

static corot_status add(flat *f, const char *group, const char *prefix, const char *key) {
  size_t size = strlen(prefix) + strlen(key) + 1;
  char *name = malloc(size);
  if (!name) return corot_fail(COROT_ENOMEM, "out of memory");
  snprintf(name, size, "%s%s", prefix, key);
  f->column[f->n++] = (flat_column){name, group, key};
  return COROT_OK;
}

static corot_status add_all(flat *f, const char *group, const char *prefix, size_t n,
                            const char *const *key) {
  for (size_t i = 0; i < n; i++) COROT_TRY(add(f, group, prefix, key[i]));
  return COROT_OK;
}

/* To SQL, columns that differ in case alone are the same. */
static bool among(const char *word, size_t n, const char *const *list) {
  for (size_t i = 0; i < n; i++)
    if (strcasecmp(word, list[i]) == 0) return true;
  return false;
}

/* Whether a coordinate has the name of a column of ours. */
static bool is_taken(const char *key) {
  static const char *const prefix[] = {"cost.", "error.", "at_most.", "drift.", "quantity."};
  for (size_t i = 0; i < COUNT(prefix); i++)
    if (strncasecmp(key, prefix[i], strlen(prefix[i])) == 0) return true;
  return among(key, COUNT(before), before) || among(key, COUNT(after), after) ||
         among(key, COUNT(last), last);
}

/* The object of errors that has most to say: all of a study have the same names but for those of
   probes that an axis may add. */
static json_t *richest_errors(const json_t *cells) {
  json_t *best = NULL;
  for (size_t i = 0; i < json_array_size(cells); i++) {
    json_t *e = json_object_get(json_array_get(cells, i), "error");
    if (json_object_size(e) > json_object_size(best)) best = e;
  }
  return best;
}

static corot_status add_coordinates(flat *f, const json_t *columns) {
  for (size_t i = 0; i < json_array_size(columns); i++) {
    const char *key = json_string_value(json_array_get(columns, i));
    if (!key) return corot_fail(COROT_EFORMAT, "table.json: not a table of a study");
    COROT_TRY(add(f, "settings", is_taken(key) ? "settings." : "", key));
  }
  return COROT_OK;
}

static corot_status add_errors(flat *f, json_t *errors) {
  void *i = json_object_iter(errors);
  for (; i; i = json_object_iter_next(errors, i))
    COROT_TRY(add(f, "error", "error.", json_object_iter_key(i)));
  return COROT_OK;
}

/* A table of an earlier version has no list of them. */
static corot_status add_quantities(flat *f, const json_t *quantities) {
  for (size_t i = 0; i < json_array_size(quantities); i++) {
    const char *text = json_string_value(json_array_get(quantities, i));
    if (!text) return corot_fail(COROT_EFORMAT, "table.json: not a table of a study");
    COROT_TRY(add(f, "quantity", "quantity.", text));
  }
  return COROT_OK;
}

/* Of errors against known values. */
static corot_status add_bounds(flat *f, const json_t *known) {
  for (size_t i = 0; i < json_array_size(known); i++) {
    const char *text = json_string_value(json_object_get(json_array_get(known, i), "measure"));
    if (!text) return corot_fail(COROT_EFORMAT, "table.json: not a table of a study");
    COROT_TRY(add(f, "at_most", "at_most.", text));
  }
  return json_array_size(known) > 0 ? add(f, "at_most", "at_most.", "total") : COROT_OK;
}

static corot_status fill(flat *f, const json_t *table, json_t *errors) {
  const json_t *columns = json_object_get(table, "columns");
  COROT_TRY(add_all(f, NULL, "", COUNT(before), before));
  COROT_TRY(add_coordinates(f, columns));
  COROT_TRY(add_all(f, NULL, "", COUNT(after), after));
  COROT_TRY(add_all(f, "cost", "cost.", COUNT(costs), costs));
  COROT_TRY(add_quantities(f, json_object_get(table, "quantities")));
  COROT_TRY(add_errors(f, errors));
  COROT_TRY(add_bounds(f, json_object_get(table, "known")));
  COROT_TRY(add_all(f, "drift", "drift.", COUNT(drifts), drifts));
  return add_all(f, NULL, "", COUNT(last), last);
}

corot_status flat_make(const json_t *table, flat *out) {
  const json_t *columns = json_object_get(table, "columns");
  const json_t *cells = json_object_get(table, "cells");
  if (!json_is_array(columns) || !json_is_array(cells))
    return corot_fail(COROT_EFORMAT, "table.json: not a table of a study");
  json_t *errors = richest_errors(cells);
  size_t n = json_array_size(columns) + json_array_size(json_object_get(table, "quantities")) +
             json_object_size(errors) + json_array_size(json_object_get(table, "known")) + 1 +
             COUNT(before) + COUNT(after) + COUNT(costs) + COUNT(drifts) + COUNT(last);
  flat f = {.column = calloc(n, sizeof *f.column)};
  if (!f.column) return corot_fail(COROT_ENOMEM, "out of memory");
  corot_status status = fill(&f, table, errors);
  if (status == COROT_OK)
    *out = f;
  else
    flat_free(&f);
  return status;
}

void flat_free(flat *f) {
  for (int i = 0; i < f->n; i++) free(f->column[i].name);
  free(f->column);
  *f = (flat){0};
}

const json_t *flat_value(const json_t *cell, const flat_column *c) {
  return json_object_get(c->group ? json_object_get(cell, c->group) : cell, c->key);
}
