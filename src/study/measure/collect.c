/* Reads the runs of a study and measures them. */
#include "collect.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/text/json_text.h"
#include "app/text/no_memory.h"
#include "collect_json.h"
#include "collect_measure.h"
#include "collect_quantities.h"
#include "collect_shared.h"
#include "collect_space.h"
#include "report/read/lookup.h"

static corot_status copy_text(const char *text, char **out) {
  char *copy = malloc(strlen(text) + 1);
  if (!copy) return no_memory();
  *out = strcpy(copy, text);
  return COROT_OK;
}

/* What cannot be measured is noted; what the system refuses (memory, reading) ends the collecting:
   the next time it may be there. */
static corot_status note(corot_status status, char **out) {
  if (status == COROT_ENOMEM || status == COROT_EIO) return status;
  return status == COROT_OK ? COROT_OK : copy_text(corot_error(), out);
}

/* --- References --- */

/* The errors of the second run against the first, by name; those of norms are measured. */
static corot_status measure_floor(measuring *g, const json_t *second, table_reference *t) {
  double *value = NULL;
  COROT_TRY(quantities_read(g->m, second, &value));
  corot_status status = quantities_measure(g->m, value, t->quantity, &t->quantity_floor);
  free(value);
  COROT_TRY(status);
  t->floor_json =
      quantities_with_errors(g->m, t->quantity_floor, errors_json(g->yardstick, &t->floor));
  return t->floor_json ? COROT_OK : no_memory();
}

static corot_status look_reference(measuring *g, int index, table_reference *t) {
  const study_reference *r = &g->m->reference[index];
  run_record record[2] = {{0}, {0}};
  corot_status status = measure_look(g, &g->m->run[r->run[0]], &record[0]);
  if (status == COROT_OK) status = measure_look(g, &g->m->run[r->run[1]], &record[1]);
  t->reference = r;
  t->state = RUN_DONE;
  /* the first that is not done says what the pair is */
  for (int i = 1; i >= 0 && status == COROT_OK; i--) {
    if (record[i].state == RUN_DONE) continue;
    t->state = record[i].state;
    if (record[i].reason && !t->reason) status = copy_text(record[i].reason, &t->reason);
  }
  /* the floor: the second run against the first */
  if (status == COROT_OK && t->state == RUN_DONE) {
    t->approximations = approximations_of(record[0].result);
    drift ignored;
    corot_status measured =
        measure_run(g, &g->m->run[r->run[1]], record[1].result, index, &t->floor, &ignored);
    t->known = measured == COROT_OK;
    status = note(measured, &t->note);
    if (status == COROT_OK) status = quantities_read(g->m, record[0].result, &t->quantity);
    if (status == COROT_OK && t->known) status = measure_floor(g, record[1].result, t);
  }
  /* which builds made them */
  for (int i = 0; i < 2; i++) {
    if (record[i].state == RUN_DONE)
      builds_add(&g->builds, &g->m->run[r->run[i]], record[i].result, true);
    run_record_free(&record[i]);
  }
  return status;
}

/* --- Cells --- */

/* Its errors by name: against a reference, NULL: there is none, and against known values. */
static corot_status name_errors(measuring *g, const table_reference *r, table_row *t) {
  const manifest *m = g->m;
  bool measured = r != NULL;
  COROT_TRY(quantities_rate(m, t->quantity, measured ? r->quantity : NULL,
                            measured ? r->quantity_floor : NULL, &t->off));
  if (!measured && !quantities_are_known(m)) return COROT_OK;
  json_t *named = measured ? errors_json(g->yardstick, &t->error) : json_object();
  json_t *unrated = measured ? errors_unrated(g->yardstick, &t->error, &r->floor) : json_array();
  t->error_json = quantities_with_off(m, t->off, measured, named);
  t->unrated = quantities_with_unrated(m, t->off, measured, unrated);
  t->at_most = quantities_at_most(m, t->off);
  return t->error_json && t->unrated && t->at_most ? COROT_OK : no_memory();
}

/* Of a run that is done: what it cost, and how far off it is. */
static corot_status measure_cell(measuring *g, const table_reference *references,
                                 const json_t *result, table_row *t) {
  const study_cell *c = t->cell;
  const table_reference *r = c->reference >= 0 ? &references[c->reference] : NULL;
  bool known = r && r->known;
  t->approximations = approximations_of(result);
  COROT_TRY(costs_read(g->dir, t->run, result, &g->builds, &t->cost));
  COROT_TRY(quantities_read(g->m, result, &t->quantity));
  corot_status status =
      measure_run(g, t->run, result, known ? c->reference : -1, &t->error, &t->drift);
  t->measured = status == COROT_OK && known;
  if (status != COROT_OK)
    COROT_TRY(note(status, &t->note));
  else if (r && !known)
    COROT_TRY(copy_text("its reference is not known", &t->note));
  return name_errors(g, t->measured ? r : NULL, t);
}

/* The codes in a run's result, each once, in the order they were given in. */
static corot_status read_warnings(const json_t *result, json_t **out) {
  const json_t *given = json_object_get(result, "warnings");
  json_t *list = json_array();
  bool complete = list != NULL;
  for (size_t i = 0; complete && i < json_array_size(given); i++) {
    const char *code = json_string_value(json_object_get(json_array_get(given, i), "code"));
    if (code && !lookup_has_text(list, code))
      complete = json_array_append_new(list, json_string(code)) == 0;
  }
  if (complete) {
    *out = list;
    return COROT_OK;
  }
  json_decref(list);
  return no_memory();
}

static corot_status look_cell(measuring *g, const table_reference *references, int index,
                              table_row *t) {
  const study_cell *c = &g->m->cell[index];
  run_record record = {0};
  *t = (table_row){.cell = c, .run = &g->m->run[c->run], .drift = {NAN, NAN}};
  COROT_TRY(measure_look(g, t->run, &record));
  t->state = record.state;
  t->damaged = record.damaged;
  t->reason = record.reason;
  record.reason = NULL;
  corot_status status = COROT_OK;
  if (record.state == RUN_DONE) builds_add(&g->builds, t->run, record.result, false);
  if (record.state == RUN_DONE) status = read_warnings(record.result, &t->warnings);
  if (record.state == RUN_DONE && status == COROT_OK)
    status = measure_cell(g, references, record.result, t);
  run_record_free(&record);
  return status;
}

/* --- The whole --- */

/* -1: it is unknown. */
static int find_measure(const manifest *m) {
  for (int i = 0; i <= m->nquantity; i++)
    if (strcmp(quantity_error_name(m, i), m->measure) == 0) return ERROR_PROBES + i;
  return error_named(m->measure);
}

static corot_status collect(measuring *g, table_reference *references, table_row *rows,
                            json_t **out) {
  const manifest *m = g->m;
  for (int i = 0; i < m->nreference; i++) COROT_TRY(look_reference(g, i, &references[i]));
  for (int i = 0; i < m->ncell; i++) COROT_TRY(look_cell(g, references, i, &rows[i]));
  table_rows t = {.n = m->ncell,
                  .row = rows,
                  .reference = references,
                  .measure = find_measure(m),
                  .cost = m->cost,
                  .still = m->still};
  if (t.measure < 0 || !is_cost(t.cost))
    return corot_fail(COROT_EFORMAT, "%s/study.json: unknown measure or cost", g->dir);
  t.total = table_is_total(&t);
  json_t *space;
  COROT_TRY(collect_space(g, references, &space));
  builds_sort(&g->builds);
  corot_status status = collect_json(m, &t, space, g->builds.list, out);
  json_decref(space);
  return status;
}

static void free_rows(int n, table_row *row) {
  for (int i = 0; i < n; i++) {
    free(row[i].reason);
    free(row[i].note);
    errors_free(&row[i].error);
    free(row[i].quantity);
    free(row[i].off);
    json_decref(row[i].error_json);
    json_decref(row[i].unrated);
    json_decref(row[i].at_most);
    json_decref(row[i].approximations);
    json_decref(row[i].warnings);
  }
  free(row);
}

static void free_references(int n, table_reference *reference) {
  for (int i = 0; i < n; i++) {
    free(reference[i].reason);
    free(reference[i].note);
    errors_free(&reference[i].floor);
    free(reference[i].quantity);
    free(reference[i].quantity_floor);
    json_decref(reference[i].floor_json);
    json_decref(reference[i].approximations);
  }
  free(reference);
}

corot_status collect_table(const manifest *m, const char *dir, bool looked, json_t **table,
                           int *ndamaged) {
  measuring g = {.m = m, .dir = dir, .looked = looked, .reference = -1, .builds = builds_begin()};
  table_row *rows = calloc((size_t)m->ncell + 1, sizeof *rows);
  table_reference *references = calloc((size_t)m->nreference + 1, sizeof *references);
  corot_status status = rows && references ? collect(&g, references, rows, table) : no_memory();
  if (rows) free_rows(m->ncell, rows);
  if (references) free_references(m->nreference, references);
  measuring_free(&g);
  *ndamaged = g.ndamaged;
  return status;
}
