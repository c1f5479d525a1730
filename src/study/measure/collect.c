/* Reads the runs, measures them, and writes the tables. */
#include "collect.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/scenario/warnings.h"
#include "app/text/escape.h"
#include "app/text/json_text.h"
#include "app/text/no_memory.h"
#include "collect_parts.h"
#include "flat.h"
#include "study/plan/json_file.h"

int measure_named(const char *name) {
  for (int i = 0; i < ERROR_PROBES; i++)
    if (strcmp(error_words[i], name) == 0) return i;
  return -1;
}

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

static corot_status look_reference(measuring *g, int index, table_reference *t) {
  const study_reference *r = &g->m->reference[index];
  run_record record[2] = {{0}, {0}};
  corot_status status = measure_look(g, &g->m->run[r->run[0]], &record[0]);
  if (status == COROT_OK) status = measure_look(g, &g->m->run[r->run[1]], &record[1]);
  t->reference = r;
  t->state = RUN_DONE;
  for (int i = 1; i >= 0 && status == COROT_OK; i--) {
    if (record[i].state == RUN_DONE) continue;
    t->state = record[i].state;
    if (record[i].reason && !t->reason) status = copy_text(record[i].reason, &t->reason);
  }
  if (status == COROT_OK && t->state == RUN_DONE) {
    t->approximations = approximations_of(record[0].result);
    drift ignored;
    corot_status measured =
        measure_run(g, &g->m->run[r->run[1]], record[1].result, index, &t->floor, &ignored);
    t->known = measured == COROT_OK;
    status = note(measured, &t->note);
    if (t->known && !(t->floor_json = errors_json(g->yardstick, &t->floor))) status = no_memory();
  }
  for (int i = 0; i < 2; i++) {
    if (record[i].state == RUN_DONE)
      builds_add(&g->builds, &g->m->run[r->run[i]], record[i].result, true);
    run_record_free(&record[i]);
  }
  return status;
}

/* --- Cells --- */

/* Of a run that is done: what it cost, and how far off it is. */
static corot_status measure_cell(measuring *g, const table_reference *references,
                                 const json_t *result, table_row *t) {
  const study_cell *c = t->cell;
  const table_reference *r = c->reference >= 0 ? &references[c->reference] : NULL;
  bool known = r && r->known;
  t->approximations = approximations_of(result);
  COROT_TRY(costs_read(g->dir, t->run, result, &g->builds, &t->cost));
  corot_status status =
      measure_run(g, t->run, result, known ? c->reference : -1, &t->error, &t->drift);
  if (status != COROT_OK) return note(status, &t->note);
  if (r && !known) return copy_text("its reference is not known", &t->note);
  if (!known) return COROT_OK;
  t->measured = true;
  t->error_json = errors_json(g->yardstick, &t->error);
  t->unrated = errors_unrated(g->yardstick, &t->error, &r->floor);
  return t->error_json && t->unrated ? COROT_OK : no_memory();
}

static bool has_text(const json_t *list, const char *text) {
  for (size_t i = 0; i < json_array_size(list); i++)
    if (strcmp(json_string_value(json_array_get(list, i)), text) == 0) return true;
  return false;
}

/* The codes in a run's result, each once, in the order they were given in. */
static corot_status read_warnings(const json_t *result, json_t **out) {
  const json_t *given = json_object_get(result, "warnings");
  json_t *list = json_array();
  bool complete = list != NULL;
  for (size_t i = 0; complete && i < json_array_size(given); i++) {
    const char *code = json_string_value(json_object_get(json_array_get(given, i), "code"));
    if (code && !has_text(list, code))
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

/* --- As JSON --- */

static const char *const state_words[] = {"missing", "done", "failed"};

static json_t *set_pair(json_t *object, const char *name, const error_pair *e) {
  char end[160];
  snprintf(end, sizeof end, "%s_end", name);
  object = json_text_with(object, name, json_text_real(e->max));
  return json_text_with(object, end, json_text_real(e->end));
}

static void error_name(const yardstick *y, int i, size_t size, char *name) {
  if (i < ERROR_PROBES)
    snprintf(name, size, "%s", error_words[i]);
  else
    snprintf(name, size, "probe.%s", y->probe_def[i - ERROR_PROBES].name);
}

json_t *errors_json(const yardstick *y, const errors *e) {
  json_t *object = json_object();
  char name[128];
  for (int i = 0; i < e->n; i++) {
    error_name(y, i, sizeof name, name);
    object = set_pair(object, name, &e->of[i]);
  }
  return object;
}

json_t *errors_unrated(const yardstick *y, const errors *e, const errors *floor) {
  json_t *list = json_array();
  char name[128];
  for (int i = 0; i < e->n && i < floor->n; i++) {
    if (is_rated(&e->of[i], &floor->of[i], false)) continue;
    error_name(y, i, sizeof name, name);
    list = json_text_push(list, json_string(name));
  }
  return list;
}

/* mescd, if it is rated (floor NULL: in any case). */
static json_t *digits(const errors *e, const errors *floor) {
  const error_pair *mixed = &e->of[ERROR_MIXED];
  bool rated = !floor || is_rated(mixed, &floor->of[ERROR_MIXED], true);
  return rated && mixed->end > 0 ? json_text_real(-log10(mixed->end)) : json_null();
}

static json_t *owned(json_t *value) { return value ? json_incref(value) : json_null(); }

static json_t *cell_json(const table_rows *t, const table_row *r) {
  const study_cell *c = r->cell;
  const table_reference *reference = r->measured ? &t->reference[c->reference] : NULL;
  const errors *floor = reference ? &reference->floor : NULL;
  bool below = floor && !is_rated(&r->error.of[t->measure], &floor->of[t->measure], false);
  json_t *drifts = json_pack("{s:o, s:o}", "energy", json_text_real(r->drift.energy), "momentum",
                             json_text_real(r->drift.momentum));
  return json_pack(
      "{s:s, s:s, s:O, s:o, s:s?, s:s, s:s?, s:o, s:o, s:o, s:b, s:o, s:o, s:o, s:s?, s:o, s:o}",
      "id", r->run->id, "series", c->series, "settings", c->settings, "tolerance",
      json_text_real(c->tolerance), "tolerance_key", c->tolerance_key, "status",
      state_words[r->state], "reason", r->reason, "cost",
      r->state == RUN_DONE ? costs_json(&r->cost) : json_null(), "error", owned(r->error_json),
      "digits", floor ? digits(&r->error, floor) : json_null(), "below_floor", below, "unrated",
      owned(r->unrated), "drift", drifts, "reference",
      c->reference >= 0 ? json_integer(c->reference) : json_null(), "note", r->note, "shared",
      cell_shared(t, r), "warnings", owned(r->warnings));
}

/* How far two references agree, in words. */
static void describe(const table_reference *t, size_t size, char *text) {
  const study_reference *r = t->reference;
  if (!t->known)
    snprintf(text, size, "%s", t->note ? t->note : t->reason ? t->reason : "not run yet");
  else if (isnan(t->floor.parting))
    snprintf(text, size, "%s and %s agree to %.1e of the displacement", r->method[0], r->method[1],
             t->floor.of[ERROR_DISPLACEMENT].max);
  else
    snprintf(text, size,
             "%s and %s part ways: from t = %.4g s on they are more than 1e-3 of the displacement "
             "apart; either the motion is unstable, or one of them is wrong",
             r->method[0], r->method[1], t->floor.parting);
}

static json_t *reference_json(const manifest *m, const table_reference *t) {
  const study_reference *r = t->reference;
  char text[512];
  describe(t, sizeof text, text);
  return json_pack(
      "{s:[s, s], s:[s, s], s:f, s:O, s:s, s:s?, s:o, s:o, s:o, s:o, s:s}", "runs",
      m->run[r->run[0]].id, m->run[r->run[1]].id, "methods", r->method[0], r->method[1], "rtol",
      r->rtol, "settings", r->settings, "status", state_words[t->state], "reason", t->reason,
      "agree", t->known ? json_boolean(isnan(t->floor.parting)) : json_null(), "parts_at",
      t->known ? json_text_real(t->floor.parting) : json_null(), "floor", owned(t->floor_json),
      "digits", t->known ? digits(&t->floor, NULL) : json_null(), "note", text);
}

static json_t *series_json(const table_rows *t) {
  json_t *list = json_array();
  for (int i = 0; i < t->n; i++)
    if (i == 0 || strcmp(t->row[i].cell->series, t->row[i - 1].cell->series) != 0)
      list = json_text_push(list, json_string(t->row[i].cell->series));
  return list;
}

static json_t *columns_json(const manifest *m) {
  json_t *list = json_array();
  for (int i = 0; i < m->ncolumn; i++) list = json_text_push(list, json_string(m->column[i]));
  return list;
}

static corot_status make_table(const manifest *m, const table_rows *t, json_t *space,
                               json_t *made_by, json_t **out) {
  json_t *cells = json_array(), *references = json_array();
  for (int i = 0; i < t->n; i++) cells = json_text_push(cells, cell_json(t, &t->row[i]));
  for (int i = 0; i < m->nreference; i++)
    references = json_text_push(references, reference_json(m, &t->reference[i]));
  bool whole =
      (int)json_array_size(cells) == t->n && (int)json_array_size(references) == m->nreference;
  json_t *table =
      json_pack("{s:s, s:s, s:s, s:s, s:O, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:O}", "title",
                m->title, "cost", m->cost, "measure", m->measure, "corot", m->version, "builds",
                made_by, "mixed", builds_sentence(made_by), "columns", columns_json(m), "series",
                series_json(t), "shared", table_shared(t), "references", references, "fits",
                collect_fits(t), "rankings", collect_rankings(t), "cells", cells, "space", space);
  if (!whole || !table) {
    json_decref(table);
    return no_memory();
  }
  *out = table;
  return COROT_OK;
}

/* --- The whole --- */

static corot_status collect(measuring *g, table_reference *references, table_row *rows,
                            json_t **out) {
  const manifest *m = g->m;
  for (int i = 0; i < m->nreference; i++) COROT_TRY(look_reference(g, i, &references[i]));
  for (int i = 0; i < m->ncell; i++) COROT_TRY(look_cell(g, references, i, &rows[i]));
  table_rows t = {.n = m->ncell,
                  .row = rows,
                  .reference = references,
                  .measure = measure_named(m->measure),
                  .cost = m->cost};
  if (t.measure < 0 || !is_cost(t.cost))
    return corot_fail(COROT_EFORMAT, "%s/study.json: unknown measure or cost", g->dir);
  json_t *space;
  COROT_TRY(collect_space(g, references, &space));
  builds_sort(&g->builds);
  corot_status status = make_table(m, &t, space, g->builds.list, out);
  json_decref(space);
  return status;
}

static void free_rows(int n, table_row *row) {
  for (int i = 0; i < n; i++) {
    free(row[i].reason);
    free(row[i].note);
    errors_free(&row[i].error);
    json_decref(row[i].error_json);
    json_decref(row[i].unrated);
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
    json_decref(reference[i].floor_json);
    json_decref(reference[i].approximations);
  }
  free(reference);
}

static corot_status make(const manifest *m, const char *dir, bool looked, json_t **table,
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

corot_status collect_table(const manifest *m, const char *dir, json_t **table) {
  int ignored;
  return make(m, dir, false, table, &ignored);
}

/* "warning: bending: 2 of 8 cells: ID ID", all too many left out. */
static void tell_code(const json_t *cells, const char *code, FILE *out) {
  enum { MOST = 8 };
  size_t count = 0, told = 0;
  for (size_t i = 0; i < json_array_size(cells); i++)
    count += has_text(json_object_get(json_array_get(cells, i), "warnings"), code);
  if (count == 0) return;
  fprintf(out, "warning: %s: %zu of %zu cells:", code, count, json_array_size(cells));
  for (size_t i = 0; i < json_array_size(cells) && told < MOST; i++) {
    const json_t *c = json_array_get(cells, i);
    if (!has_text(json_object_get(c, "warnings"), code)) continue;
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

corot_status collect_runs(const manifest *m, const char *dir, bool looked, FILE *remarks,
                          int *ndamaged) {
  json_t *table = NULL;
  json_text_starved(); /* an earlier lack of memory is none of this table */
  COROT_TRY(make(m, dir, looked, &table, ndamaged));
  corot_status status = json_file_write(dir, "table.json", table);
  if (status == COROT_OK) status = table_write_csv(table, dir);
  if (status == COROT_OK) status = table_write_sqlite(table, dir);
  if (status == COROT_OK && remarks && !looked) tell_lost(json_object_get(table, "cells"), remarks);
  if (status == COROT_OK && remarks) warn(table, remarks);
  json_decref(table);
  return status;
}

corot_status collect_study(const manifest *m, const char *dir, FILE *remarks) {
  int ignored;
  return collect_runs(m, dir, false, remarks, &ignored);
}
