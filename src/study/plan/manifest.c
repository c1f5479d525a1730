/* A study to JSON and back. */
#include "manifest.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/folder/folder.h"
#include "app/text/no_memory.h"
#include "json_file.h"

/* --- From JSON --- */

static corot_status malformed(const char *where, const char *what) {
  return corot_fail(COROT_EFORMAT, "%s: not the description of a study: %s", where, what);
}

static const char *text_of(const json_t *object, const char *key) {
  return json_string_value(json_object_get(object, key));
}

static bool index_of(const json_t *value, int n, int *out) {
  json_int_t i = json_integer_value(value);
  *out = (int)i;
  return json_is_integer(value) && i >= 0 && i < n;
}

static corot_status read_texts(const json_t *list, const char *where, const char *what, int *n,
                               const char ***out) {
  size_t count = json_array_size(list);
  if (!json_is_array(list)) return malformed(where, what);
  *out = calloc(count + 1, sizeof **out);
  if (!*out) return no_memory();
  for (size_t i = 0; i < count; i++) {
    (*out)[i] = json_string_value(json_array_get(list, i));
    if (!(*out)[i]) return malformed(where, what);
  }
  *n = (int)count;
  return COROT_OK;
}

static corot_status read_run(const json_t *entry, const char *where, study_run *run) {
  run->id = text_of(entry, "id");
  run->hash = text_of(entry, "hash");
  if (!run->id || strlen(run->id) != 16 || strspn(run->id, "0123456789abcdef") != 16 || !run->hash)
    return malformed(where, "a run without its identity");
  const json_t *end = json_object_get(entry, "t_end"), *work = json_object_get(entry, "work");
  run->t_end = json_is_number(end) ? json_number_value(end) : NAN;
  run->work = json_is_number(work) && json_number_value(work) > 0 ? json_number_value(work) : 1;
  return read_texts(json_object_get(entry, "set"), where, "runs", &run->nset, &run->set);
}

static corot_status read_cell(const manifest *m, const json_t *entry, const char *where,
                              study_cell *c) {
  const json_t *tolerance = json_object_get(entry, "tolerance");
  const json_t *reference = json_object_get(entry, "reference");
  c->settings = json_object_get(entry, "settings");
  c->series = text_of(entry, "series");
  c->tolerance = json_is_number(tolerance) ? json_number_value(tolerance) : NAN;
  c->tolerance_key = text_of(entry, "tolerance_key");
  c->reference = -1;
  if (!json_is_object(c->settings) || !c->series ||
      !index_of(json_object_get(entry, "run"), m->nrun, &c->run))
    return malformed(where, "cells");
  if (!json_is_null(reference) && !index_of(reference, m->nreference, &c->reference))
    return malformed(where, "a cell's reference");
  return COROT_OK;
}

static corot_status read_reference(const manifest *m, const json_t *entry, const char *where,
                                   study_reference *r) {
  const json_t *run = json_object_get(entry, "runs"), *method = json_object_get(entry, "methods");
  r->settings = json_object_get(entry, "settings");
  r->rtol = json_number_value(json_object_get(entry, "rtol"));
  bool whole = json_is_object(r->settings);
  for (size_t i = 0; i < 2; i++) {
    r->method[i] = json_string_value(json_array_get(method, i));
    whole &= index_of(json_array_get(run, i), m->nrun, &r->run[i]) && r->method[i];
  }
  return whole ? COROT_OK : malformed(where, "references");
}

static corot_status read_heads(manifest *m, const char *where) {
  m->title = text_of(m->root, "study");
  m->name = text_of(m->root, "name");
  m->base = text_of(m->root, "base");
  m->version = text_of(m->root, "corot");
  m->identity = text_of(m->root, "identity");
  m->cost = text_of(m->root, "cost");
  m->measure = text_of(m->root, "measure");
  m->still = json_is_true(json_object_get(m->root, "static"));
  m->repeat = (int)json_integer_value(json_object_get(m->root, "repeat"));
  if (!m->title || !m->name || !m->base || !m->version || !m->identity || !m->cost || !m->measure)
    return malformed(where, "one of its heads is missing");
  return read_texts(json_object_get(m->root, "columns"), where, "columns", &m->ncolumn, &m->column);
}

/* NULL: there is none. */
static bool read_known(const json_t *known, study_quantity *q) {
  q->known = known != NULL;
  if (!known) return true;
  q->value = json_number_value(json_object_get(known, "value"));
  q->within = json_number_value(json_object_get(known, "within"));
  q->scale = json_number_value(json_object_get(known, "scale"));
  return q->within >= 0 && q->scale > 0;
}

/* A study of an earlier version has none. */
static corot_status read_quantities(manifest *m, const char *where) {
  const json_t *list = json_object_get(m->root, "quantities");
  m->nquantity = (int)json_array_size(list);
  m->quantity = calloc((size_t)m->nquantity + 1, sizeof *m->quantity);
  if (!m->quantity) return no_memory();
  for (int i = 0; i < m->nquantity; i++) {
    const json_t *entry = json_array_get(list, (size_t)i);
    m->quantity[i] = (study_quantity){.text = text_of(entry, "of"), .name = text_of(entry, "name")};
    if (!m->quantity[i].text || !m->quantity[i].name ||
        !read_known(json_object_get(entry, "known"), &m->quantity[i]))
      return malformed(where, "quantities");
  }
  return COROT_OK;
}

static corot_status read_lists(manifest *m, const char *where) {
  const json_t *runs = json_object_get(m->root, "runs");
  const json_t *cells = json_object_get(m->root, "cells");
  const json_t *references = json_object_get(m->root, "references");
  m->nrun = (int)json_array_size(runs);
  m->ncell = (int)json_array_size(cells);
  m->nreference = (int)json_array_size(references);
  m->run = calloc((size_t)m->nrun + 1, sizeof *m->run);
  m->cell = calloc((size_t)m->ncell + 1, sizeof *m->cell);
  m->reference = calloc((size_t)m->nreference + 1, sizeof *m->reference);
  if (!m->run || !m->cell || !m->reference) return no_memory();
  for (int i = 0; i < m->nrun; i++)
    COROT_TRY(read_run(json_array_get(runs, (size_t)i), where, &m->run[i]));
  for (int i = 0; i < m->nreference; i++)
    COROT_TRY(read_reference(m, json_array_get(references, (size_t)i), where, &m->reference[i]));
  for (int i = 0; i < m->ncell; i++)
    COROT_TRY(read_cell(m, json_array_get(cells, (size_t)i), where, &m->cell[i]));
  return COROT_OK;
}

corot_status manifest_from_json(json_t *root, const char *where, manifest **out) {
  manifest *m = calloc(1, sizeof *m);
  if (!m) {
    json_decref(root);
    return no_memory();
  }
  m->root = root;
  corot_status status = read_heads(m, where);
  if (status == COROT_OK) status = read_quantities(m, where);
  if (status == COROT_OK) status = read_lists(m, where);
  if (status == COROT_OK)
    *out = m;
  else
    manifest_destroy(m);
  return status;
}

void manifest_destroy(manifest *m) {
  if (!m) return;
  for (int i = 0; m->run && i < m->nrun; i++) free(m->run[i].set);
  free(m->run);
  free(m->cell);
  free(m->reference);
  free(m->column);
  free(m->quantity);
  json_decref(m->root);
  free(m);
}

/* --- The file --- */

corot_status manifest_read(const char *dir, manifest **out) {
  char *path = folder_path(dir, "study.json");
  if (!path) return COROT_ENOMEM;
  json_t *root = NULL;
  corot_status status = json_file_read(path, &root);
  if (status == COROT_OK) status = manifest_from_json(root, path, out);
  free(path);
  return status;
}

corot_status manifest_write(const manifest *m, const char *dir) {
  return json_file_write(dir, "study.json", m->root);
}
