/* Reads the document once, and keeps pointers into it. */
#include "study_table.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lookup.h"

const char *const study_cost_word[STUDY_COSTS] = {
    [STUDY_CPU] = "cpu",
    [STUDY_WALL] = "wall",
    [STUDY_STEPS] = "steps",
    [STUDY_RHS] = "rhs",
    [STUDY_FACTORISATIONS] = "factorisations",
    [STUDY_SOLVES] = "solves",
};
const char *const study_cost_label[STUDY_COSTS] = {
    [STUDY_CPU] = "CPU time [s]",
    [STUDY_WALL] = "wall time [s]",
    [STUDY_STEPS] = "steps",
    [STUDY_RHS] = "right-hand sides",
    [STUDY_FACTORISATIONS] = "factorisations",
    [STUDY_SOLVES] = "solves",
};

bool study_cell_rated(const study_cell *cell, int error) {
  return cell->status == STUDY_DONE && !cell->unrated[error];
}

double study_floor(const study_table *t, int error) {
  return (t->known[error] ? 1 : STUDY_FLOOR_FACTOR) * t->floor[error];
}

void study_error_label(const char *name, size_t size, char *label) {
  size_t length = strlen(name);
  bool end = length > 4 && strcmp(name + length - 4, "_end") == 0;
  int base = (int)(end ? length - 4 : length);
  const char *when = end ? "at the end" : "largest over time";
  if (strcmp(name, "total") == 0)
    snprintf(label, size, "total error, the largest against known values");
  else if (strpbrk(name, "(@"))
    snprintf(label, size, "relative error of %s", name);
  else if (strncmp(name, "probe.", 6) == 0)
    snprintf(label, size, "error of probe %.*s, %s [m]", base - 6, name + 6, when);
  else if (strncmp(name, "mixed", 5) == 0)
    snprintf(label, size, "mixed error, %s", when);
  else
    snprintf(label, size, "relative error of %.*s, %s", base, name, when);
}

void study_left_out(const study_table *t, int error, size_t size, char *note) {
  static const char *const word[] = {"below the floor", "failed", "missing"};
  int count[3] = {0};
  for (int i = 0; i < t->ncell; i++)
    if (!study_cell_rated(&t->cell[i], error)) count[t->cell[i].status]++;
  size_t at = 0;
  note[0] = '\0';
  for (int k = 0; k < 3; k++)
    if (count[k] && at < size)
      at += (size_t)snprintf(note + at, size - at, "%s%d %s",
                             at ? ", " : "without a point: ", count[k], word[k]);
}

void study_table_free(study_table *t) {
  json_decref(t->root);
  free(t->series);
  free(t->error_name);
  free(t->floor);
  free(t->known);
  free(t->cell);
  free(t->errors);
  free(t->unrated);
  *t = (study_table){0};
}

/* A measure's name may have points, which paths may not. */
static double number(const json_t *object, const char *key) {
  return lookup_number(json_object_get(object, key), "");
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
  const char *given = lookup_text(cell, "status");
  for (int s = 0; s < 3; s++)
    if (strcmp(given, word[s]) == 0) return *status = (study_status)s, COROT_OK;
  return corot_fail(COROT_EFORMAT, "cell %d has the status '%s'; done, failed or missing is known",
                    i, given);
}

/* The cost of that name, and its extremes NAME_min and NAME_max where it has some. */
static void read_cost(const json_t *cost, int k, study_cell *c) {
  char name[32];
  c->cost[k] = lookup_number(cost, study_cost_word[k]);
  snprintf(name, sizeof name, "%s_min", study_cost_word[k]);
  c->low[k] = lookup_number(cost, name);
  snprintf(name, sizeof name, "%s_max", study_cost_word[k]);
  c->high[k] = lookup_number(cost, name);
}

static bool lists(const json_t *list, const char *word) {
  for (size_t i = 0; i < json_array_size(list); i++) {
    const char *s = json_string_value(json_array_get(list, i));
    if (s && strcmp(s, word) == 0) return true;
  }
  return false;
}

static corot_status read_cell(study_table *t, const json_t *cell, int i) {
  if (!json_is_object(cell)) return corot_fail(COROT_EFORMAT, "cell %d is not a map", i);
  const json_t *cost = json_object_get(cell, "cost"), *error = json_object_get(cell, "error");
  const json_t *most = json_object_get(cell, "at_most");
  size_t at = (size_t)i * (size_t)t->nerror;
  double *errors = t->errors + 2 * at, *bounds = errors + t->nerror;
  study_cell *c = &t->cell[i];
  *c = (study_cell){
      .id = lookup_text(cell, "id"),
      .reason = lookup_text(cell, "reason"),
      .key = lookup_text(cell, "tolerance_key"),
      .series = place_of(lookup_text(cell, "series"), &t->nseries, t->series),
      .tolerance = lookup_number(cell, "tolerance"),
      .error = errors,
      .at_most = bounds,
      .unrated = t->unrated + at,
  };
  COROT_TRY(read_status(cell, i, &c->status));
  for (int k = 0; k < STUDY_COSTS; k++) read_cost(cost, k, c);
  for (int e = 0; e < t->nerror; e++) {
    errors[e] = number(error, t->error_name[e]);
    bounds[e] = number(most, t->error_name[e]);
    t->unrated[at + (size_t)e] = lists(json_object_get(cell, "unrated"), t->error_name[e]);
  }
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
  t->known = calloc(n + 1, sizeof *t->known);
  if (!t->error_name || !t->floor || !t->known) return corot_fail(COROT_ENOMEM, "out of memory");
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

/* Those against known values have theirs; that of the total is not the same for all cells. */
static void find_known(study_table *t) {
  const json_t *known = json_object_get(t->root, "known");
  for (int e = 0; e < t->nerror; e++) {
    bool total = strcmp(t->error_name[e], "total") == 0;
    t->known[e] = total && json_array_size(known) > 0;
    for (size_t i = 0; i < json_array_size(known); i++) {
      const json_t *k = json_array_get(known, i);
      if (strcmp(lookup_text(k, "measure"), t->error_name[e]) != 0) continue;
      t->known[e] = true;
      double floor = lookup_number(k, "within") / lookup_number(k, "scale");
      t->floor[e] = floor > 0 ? floor : NAN;
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

/* What the study compares by; the first of its kind where it does not say. */
static void find_choice(study_table *t) {
  const char *cost = lookup_text(t->root, "cost"), *measure = lookup_text(t->root, "measure");
  for (int k = STUDY_COSTS; k-- > 0;)
    if (strcmp(study_cost_word[k], cost) == 0) t->cost = (study_cost)k;
  for (int e = t->nerror; e-- > 0;)
    if (strcmp(t->error_name[e], measure) == 0) t->measure = e;
}

static corot_status take_apart(study_table *t) {
  json_t *cells = json_object_get(t->root, "cells");
  if (!json_is_array(cells)) return corot_fail(COROT_EFORMAT, "there is no list of cells");
  size_t n = json_array_size(cells);
  if (n > 10000000) return corot_fail(COROT_EFORMAT, "%zu cells are too many", n);
  COROT_TRY(find_error_names(t, cells));
  t->series = calloc(n + 1, sizeof *t->series);
  t->cell = calloc(n + 1, sizeof *t->cell);
  t->errors = calloc(2 * n * (size_t)t->nerror + 1, sizeof *t->errors);
  t->unrated = calloc(n * (size_t)t->nerror + 1, sizeof *t->unrated);
  if (!t->series || !t->cell || !t->errors || !t->unrated)
    return corot_fail(COROT_ENOMEM, "out of memory");
  t->title = lookup_text(t->root, "title");
  for (size_t i = 0; i < n; i++) COROT_TRY(read_cell(t, json_array_get(cells, i), (int)i));
  t->ncell = (int)n;
  qsort(t->cell, n, sizeof *t->cell, by_series);
  find_floors(t);
  find_known(t);
  find_choice(t);
  return COROT_OK;
}

corot_status study_table_read(const char *dir, study_table *table) {
  study_table t = {0};
  corot_status status = lookup_read(dir, "table.json", &t.root);
  if (status == COROT_OK) {
    status = take_apart(&t);
    if (status != COROT_OK) corot_fail(status, "%s/table.json: %s", dir, corot_error());
  }
  if (status != COROT_OK) {
    study_table_free(&t);
    return status;
  }
  *table = t;
  return COROT_OK;
}
