/* Rows and references as JSON, and all that is said of them together. */
#include "collect_json.h"

#include <math.h>
#include <string.h>

#include "app/text/json_text.h"
#include "app/text/no_memory.h"
#include "collect_quantities.h"
#include "collect_series.h"
#include "collect_shared.h"
#include "study/execute/builds.h"

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
    snprintf(name, size, "probe.%s", y->probe_def[i - ERROR_PROBES]->name);
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

static json_t *cell_json(const manifest *m, const table_rows *t, const table_row *r) {
  const study_cell *c = r->cell;
  const table_reference *reference = r->measured ? &t->reference[c->reference] : NULL;
  const errors *floor = reference ? &reference->floor : NULL;
  bool below = row_has_error(t, r) && !isnan(row_error(t, r)) && !row_is_rated(t, r);
  json_t *drifts = json_pack("{s:o, s:o}", "energy", json_text_real(r->drift.energy), "momentum",
                             json_text_real(r->drift.momentum));
  return json_pack(
      "{s:s, s:s, s:O, s:o, s:s?, s:s, s:s?, s:o, s:o, s:o, s:o, s:b, s:o, s:o, s:o, s:o, s:s?, "
      "s:o, s:o}",
      "id", r->run->id, "series", c->series, "settings", c->settings, "tolerance",
      json_text_real(c->tolerance), "tolerance_key", c->tolerance_key, "status",
      state_words[r->state], "reason", r->reason, "cost",
      r->state == RUN_DONE ? costs_json(&r->cost) : json_null(), "quantity",
      quantities_values(m, r->quantity), "error", owned(r->error_json), "digits",
      floor ? digits(&r->error, floor) : json_null(), "below_floor", below, "unrated",
      owned(r->unrated), "at_most", owned(r->at_most), "drift", drifts, "reference",
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
  return json_pack("{s:[s, s], s:[s, s], s:f, s:O, s:s, s:s?, s:o, s:o, s:o, s:o, s:o, s:s}",
                   "runs", m->run[r->run[0]].id, m->run[r->run[1]].id, "methods", r->method[0],
                   r->method[1], "rtol", r->rtol, "settings", r->settings, "status",
                   state_words[t->state], "reason", t->reason, "agree",
                   t->known ? json_boolean(isnan(t->floor.parting)) : json_null(), "parts_at",
                   t->known ? json_text_real(t->floor.parting) : json_null(), "quantity",
                   quantities_values(m, t->quantity), "floor", owned(t->floor_json), "digits",
                   t->known ? digits(&t->floor, NULL) : json_null(), "note", text);
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

static json_t *quantity_texts(const manifest *m) {
  json_t *list = json_array();
  for (int i = 0; i < m->nquantity; i++)
    list = json_text_push(list, json_string(m->quantity[i].text));
  return list;
}

/* Of all quantities but the measure, which has its own. */
static json_t *quantity_fits(const manifest *m, const table_rows *t) {
  json_t *list = json_array();
  for (int i = 0; i < m->nquantity; i++) {
    table_rows by = *t;
    by.measure = ERROR_PROBES + i;
    json_t *fits = by.measure == t->measure ? json_array() : collect_fits(&by);
    for (size_t k = 0; k < json_array_size(fits); k++)
      list = json_text_push(list, json_text_with(json_incref(json_array_get(fits, k)), "measure",
                                                 json_string(m->quantity[i].text)));
    if (!fits) list = json_text_push(list, NULL); /* no memory */
    json_decref(fits);
  }
  return list;
}

corot_status collect_json(const manifest *m, const table_rows *t, json_t *space, json_t *made_by,
                          json_t **out) {
  json_t *cells = json_array(), *references = json_array();
  for (int i = 0; i < t->n; i++) cells = json_text_push(cells, cell_json(m, t, &t->row[i]));
  for (int i = 0; i < m->nreference; i++)
    references = json_text_push(references, reference_json(m, &t->reference[i]));
  bool whole =
      (int)json_array_size(cells) == t->n && (int)json_array_size(references) == m->nreference;
  json_t *table = json_pack(
      "{s:s, s:b, s:s, s:s, s:o, s:o, s:s, s:O, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:O}",
      "title", m->title, "static", m->still, "cost", m->cost, "measure", m->measure, "quantities",
      quantity_texts(m), "known", quantities_known(m), "corot", m->version, "builds", made_by,
      "mixed", builds_sentence(made_by), "columns", columns_json(m), "series", series_json(t),
      "shared", table_shared(t), "references", references, "fits", collect_fits(t), "quantity_fits",
      quantity_fits(m, t), "rankings", collect_rankings(t), "cells", cells, "space", space);
  if (!whole || !table) {
    json_decref(table);
    return no_memory();
  }
  *out = table;
  return COROT_OK;
}
