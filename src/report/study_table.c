#include "study_table.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "folder.h"

const char *const study_cost_word[STUDY_COSTS] = {
    [STUDY_CPU] = "cpu",
    [STUDY_RHS] = "rhs",
    [STUDY_FACTORISATIONS] = "factorisations",
    [STUDY_STEPS] = "steps",
};
const char *const study_cost_label[STUDY_COSTS] = {
    [STUDY_CPU] = "CPU time [s]",
    [STUDY_RHS] = "right-hand sides",
    [STUDY_FACTORISATIONS] = "factorisations",
    [STUDY_STEPS] = "steps",
};

bool study_cell_rated(const study_cell *cell) {
  return cell->status == STUDY_DONE && !cell->below_floor;
}

void study_table_free(study_table *t) {
  json_decref(t->root);
  free(t->series);
  free(t->error_name);
  free(t->floor);
  free(t->cell);
  free(t->errors);
  *t = (study_table){0};
}

static double number(const json_t *object, const char *key) {
  const json_t *value = json_object_get(object, key);
  return json_is_number(value) ? json_number_value(value) : NAN;
}

static const char *text(const json_t *object, const char *key) {
  const char *s = json_string_value(json_object_get(object, key));
  return s ? s : "";
}

/* The place of a name in a list that it is added to if need be; names stay where they are. */
static int place_of(const char *name, int *n, const char **list) {
  for (int i = 0; i < *n; i++)
    if (strcmp(list[i], name) == 0) return i;
  list[*n] = name;
  return (*n)++;
}

static corot_status read_status(const json_t *cell, int i, study_status *status) {
  static const char *const word[] = {"done", "failed", "missing"};
  const char *given = text(cell, "status");
  for (int s = 0; s < 3; s++)
    if (strcmp(given, word[s]) == 0) return *status = (study_status)s, COROT_OK;
  return corot_fail(COROT_EFORMAT, "cell %d has the status '%s'; done, failed or missing is known",
                    i, given);
}

static corot_status read_cell(study_table *t, const json_t *cell, int i) {
  if (!json_is_object(cell)) return corot_fail(COROT_EFORMAT, "cell %d is not a map", i);
  const json_t *cost = json_object_get(cell, "cost"), *error = json_object_get(cell, "error");
  study_cell *c = &t->cell[i];
  *c = (study_cell){
      .id = text(cell, "id"),
      .reason = text(cell, "reason"),
      .series = place_of(text(cell, "series"), &t->nseries, t->series),
      .tolerance = number(cell, "tolerance"),
      .cpu_min = number(cost, "cpu_min"),
      .cpu_max = number(cost, "cpu_max"),
      .error = t->errors + (size_t)i * (size_t)t->nerror,
      .below_floor = json_is_true(json_object_get(cell, "below_floor")),
  };
  COROT_TRY(read_status(cell, i, &c->status));
  for (int k = 0; k < STUDY_COSTS; k++) c->cost[k] = number(cost, study_cost_word[k]);
  for (int e = 0; e < t->nerror; e++)
    t->errors[(size_t)i * (size_t)t->nerror + (size_t)e] = number(error, t->error_name[e]);
  return COROT_OK;
}

/* The names of the errors are those of the cell that has most of them. */
static corot_status find_error_names(study_table *t, json_t *cells) {
  json_t *most = NULL;
  for (size_t i = 0; i < json_array_size(cells); i++) {
    json_t *error = json_object_get(json_array_get(cells, i), "error");
    if (json_object_size(error) > json_object_size(most)) most = error;
  }
  size_t n = json_object_size(most);
  t->error_name = calloc(n + 1, sizeof *t->error_name);
  t->floor = calloc(n + 1, sizeof *t->floor);
  if (!t->error_name || !t->floor) return corot_fail(COROT_ENOMEM, "out of memory");
  const char *key;
  json_t *value;
  json_object_foreach(most, key, value) {
    if (json_is_number(value) || json_is_null(value)) t->error_name[t->nerror++] = key;
  }
  return COROT_OK;
}

static void find_floors(study_table *t) {
  const json_t *references = json_object_get(t->root, "references");
  for (int e = 0; e < t->nerror; e++) {
    t->floor[e] = NAN;
    for (size_t i = 0; i < json_array_size(references); i++) {
      const json_t *floor = json_object_get(json_array_get(references, i), "floor");
      t->floor[e] = fmax(t->floor[e], number(floor, t->error_name[e]));
    }
  }
}

/* -1, 0, 1: falling order; what is not known comes last. */
static int falling(double a, double b) {
  if (isnan(a) || isnan(b)) return isnan(a) - isnan(b);
  return (a < b) - (a > b);
}

static int by_series(const void *a, const void *b) {
  const study_cell *p = a, *q = b;
  if (p->series != q->series) return p->series < q->series ? -1 : 1;
  int order = falling(p->tolerance, q->tolerance);
  if (!order) order = -falling(p->cost[STUDY_STEPS], q->cost[STUDY_STEPS]);
  return order ? order : strcmp(p->id, q->id);
}

static corot_status take_apart(study_table *t) {
  json_t *cells = json_object_get(t->root, "cells");
  if (!json_is_array(cells)) return corot_fail(COROT_EFORMAT, "there is no list of cells");
  size_t n = json_array_size(cells);
  if (n > 10000000) return corot_fail(COROT_EFORMAT, "%zu cells are too many", n);
  COROT_TRY(find_error_names(t, cells));
  t->series = calloc(n + 1, sizeof *t->series);
  t->cell = calloc(n + 1, sizeof *t->cell);
  t->errors = calloc(n * (size_t)t->nerror + 1, sizeof *t->errors);
  if (!t->series || !t->cell || !t->errors) return corot_fail(COROT_ENOMEM, "out of memory");
  t->title = text(t->root, "title");
  for (size_t i = 0; i < n; i++) COROT_TRY(read_cell(t, json_array_get(cells, i), (int)i));
  t->ncell = (int)n;
  qsort(t->cell, n, sizeof *t->cell, by_series);
  find_floors(t);
  return COROT_OK;
}

static corot_status load(const char *path, json_t **root) {
  json_error_t where;
  *root = json_load_file(path, JSON_REJECT_DUPLICATES, &where);
  if (*root) return COROT_OK;
  if (json_error_code(&where) == json_error_cannot_open_file)
    return corot_fail(COROT_EIO, "%s: %s", path, strerror(errno));
  return corot_fail(COROT_EFORMAT, "%s:%d:%d: %s", path, where.line, where.column, where.text);
}

corot_status study_table_read(const char *dir, study_table *table) {
  char *path = folder_path(dir, "table.json");
  if (!path) return COROT_ENOMEM;
  study_table t = {0};
  corot_status status = load(path, &t.root);
  if (status == COROT_OK) {
    status = take_apart(&t);
    if (status != COROT_OK) corot_fail(status, "%s: %s", path, corot_error());
  }
  free(path);
  if (status != COROT_OK) {
    study_table_free(&t);
    return status;
  }
  *table = t;
  return COROT_OK;
}
