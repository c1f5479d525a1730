/* Every combination of the axes, then the references. */
#define _XOPEN_SOURCE 700 /* realpath */
#include "plan.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "app/folder/folder.h"
#include "app/folder/hash.h"
#include "app/run/quantities.h"
#include "app/text/json_text.h"
#include "app/text/no_memory.h"

typedef struct planner {
  const study *study;
  json_t *runs, *cells, *references; /* lists in the making */
  json_t *run_at;                    /* hash -> index */
  json_t *reference_at;              /* settings of the first run -> index */
  json_t *mesh_at;                   /* mesh and groups as scenarios say -> [digest, tets] */
  double tightest;                   /* rtol of the cells */
  int refine[2], order[2]; /* the least and the largest mesh.refine and order of the cells */
  setting quiet, binary;   /* no fields, but states */
} planner;

/* --- Settings that stand in no file --- */

static corot_status make_setting(config *tree, const char *key, const char *text, setting *out) {
  config_source *source = config_alloc(tree, 1, sizeof *source);
  config_node *value = NULL;
  if (!source) return no_memory();
  *source = (config_source){.name = "the study's own settings", .text = text, .size = strlen(text)};
  COROT_TRY(config_parse(tree, source, false, &value));
  *out = (setting){key, value};
  return COROT_OK;
}

/* --- Runs --- */

/* What is known of the mesh of a scenario. */
typedef struct mesh_facts {
  char digest[HASH_SIZE];
  double tets; /* a tet of ten nodes is six */
} mesh_facts;

static corot_status look_at_mesh(planner *p, const scenario *s, const char *said,
                                 mesh_facts *facts) {
  corot_mesh *mesh = NULL;
  corot_model *model = NULL; /* built once, for what may be wrong with it */
  corot_status status = scenario_build(s, &mesh, NULL, &model);
  if (status == COROT_OK) status = quantities_check(s, model, p->study->still);
  if (status == COROT_OK) {
    hash_mesh(mesh, facts->digest);
    facts->tets = mesh->ntet * (corot_mesh_order(mesh) == 2 ? 6.0 : 1.0);
    json_t *entry = json_pack("[s, f]", facts->digest, facts->tets);
    if (json_object_set_new(p->mesh_at, said, entry)) status = no_memory();
  }
  corot_model_destroy(model);
  corot_mesh_destroy(mesh);
  return status;
}

static corot_status find_mesh(planner *p, const scenario *s, mesh_facts *facts) {
  json_t *said = json_pack("{s:O, s:O}", "mesh", json_object_get(s->resolved, "mesh"), "groups",
                           json_object_get(s->resolved, "groups"));
  char *text = json_text_dump_plain(said, JSON_COMPACT | JSON_SORT_KEYS | JSON_REAL_PRECISION(17));
  json_decref(said);
  if (!text) return no_memory();
  const json_t *known = json_object_get(p->mesh_at, text);
  corot_status status = COROT_OK;
  if (known) {
    memcpy(facts->digest, json_string_value(json_array_get(known, 0)), HASH_SIZE);
    facts->tets = json_real_value(json_array_get(known, 1));
  } else {
    status = look_at_mesh(p, s, text, facts);
  }
  free(text);
  return status;
}

static double guess_work(const planner *p, const scenario *s, double tets) {
  const corot_integrator_def *d = &s->integrator;
  double work = tets * sqrt(tets);
  if (p->study->still) return work;
  return work * s->t_end / (d->step > 0 ? d->step : cbrt(d->rtol));
}

/* "KEY=VALUE" for each setting. */
static json_t *assignments(config *tree, int nset, const setting *set) {
  json_t *list = json_array();
  for (int i = 0; list && i < nset; i++) {
    const char *text;
    json_t *item = study_value_text(tree, set[i].value, &text) == COROT_OK
                       ? json_sprintf("%s=%s", set[i].key, text)
                       : NULL;
    if (json_array_append_new(list, item)) {
      json_decref(list);
      list = NULL;
    }
  }
  return list;
}

/* The number of the run with these settings, made if there is none yet. */
static corot_status find_run(planner *p, const scenario *s, int nset, const setting *set,
                             json_int_t *index) {
  hashes h;
  mesh_facts mesh;
  char id[17];
  COROT_TRY(find_mesh(p, s, &mesh));
  COROT_TRY(hashes_with(s->resolved, mesh.digest, &h));
  if (p->study->still) hashes_static(&h);
  const json_t *known = json_object_get(p->run_at, h.run);
  *index = known ? json_integer_value(known) : (json_int_t)json_array_size(p->runs);
  if (known) return COROT_OK;
  snprintf(id, sizeof id, "%.16s", h.run);
  json_t *run = json_pack("{s:s, s:s, s:o, s:f, s:f}", "id", id, "hash", h.run, "set",
                          assignments(p->study->tree, nset, set), "t_end", s->t_end, "work",
                          guess_work(p, s, mesh.tets));
  if (json_array_append_new(p->runs, run) ||
      json_object_set_new(p->run_at, h.run, json_integer(*index)))
    return no_memory();
  return COROT_OK;
}

/* A cell's coordinates, for messages. */
static void coordinates(const cell *c, size_t size, char *text) {
  size_t used = 0;
  text[0] = '\0';
  for (int i = 0; i < c->nplace && used < size; i++) {
    const config_node *value = c->place[i].value;
    used += (size_t)snprintf(text + used, size - used, "%s%s = %s", i ? ", " : "", c->place[i].key,
                             value->kind == CONFIG_SCALAR ? value->text : "...");
  }
}

static corot_status read_scenario(const planner *p, const cell *c, int nset, const setting *set,
                                  scenario **out) {
  corot_status status = scenario_read_with(p->study->base, nset, set, out);
  bool made_up = !p->study->base_node->source->lines; /* no file: nobody can exclude its cells */
  if (status == COROT_OK || status == COROT_ENOMEM || p->study->ncell == 1 || made_up)
    return status;
  char text[512];
  coordinates(c, sizeof text, text);
  return corot_fail(status, "%s\n  (in the cell %s; exclude: leaves cells out)", corot_error(),
                    text);
}

/* --- References --- */

static bool is_below(const char *key, const char *map) {
  size_t length = strlen(map);
  return strncmp(key, map, length) == 0 && (key[length] == '\0' || key[length] == '.');
}

/* What has to do with how the equations are solved, and with what is written of it. Equilibria
   along a load are those that its steps have led to. */
static bool is_solution(const planner *p, const char *key) {
  if (p->study->still && (is_below(key, "statics.tolerance") || is_below(key, "statics.frames")))
    return true;
  return is_below(key, "integrator") || is_below(key, "linear_solver") || is_below(key, "output");
}

/* Whether cells differ in the resolution of the mesh, and have one reference for all that. */
static bool has_finest_mesh(const planner *p) {
  return !p->study->reference_is_own &&
         (p->refine[0] != p->refine[1] || p->order[0] != p->order[1]);
}

static bool is_resolution(const char *key) {
  return strcmp(key, "mesh.refine") == 0 || strcmp(key, "mesh.order") == 0;
}

/* What the reference sets, the cell need not. */
static bool is_overruled(const study *s, const char *key) {
  for (int i = 0; i < s->nreference_set; i++)
    if (is_below(key, s->reference_set[i].key)) return true;
  return false;
}

static double reference_rtol(const planner *p) {
  if (p->study->reference_rtol > 0) return p->study->reference_rtol;
  if (p->study->still) return 1e-12;
  return fmax(fmin(1e-9, p->tightest / 100), 1e-11);
}

/* A setting of a number or a word, by a format. */
static corot_status add_setting(config *tree, const char *key, setting *set, int *n,
                                const char *format, ...) {
  char *text = config_alloc(tree, 64, 1);
  if (!text) return no_memory();
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text, 64, format, arguments);
  va_end(arguments);
  return make_setting(tree, key, text, &set[(*n)++]);
}

/* How references are solved; `method` is a word of the integrator. */
static corot_status add_solution(const planner *p, const char *method, setting *set, int *n) {
  config *tree = p->study->tree;
  double rtol = reference_rtol(p);
  if (p->study->still) {
    COROT_TRY(add_setting(tree, "statics.tolerance", set, n, "%.4g", rtol));
    COROT_TRY(add_setting(tree, "statics.frames", set, n, "exact"));
  } else {
    COROT_TRY(add_setting(tree, "integrator", set, n, "{method: %s, rtol: %.4g}", method, rtol));
  }
  return add_setting(tree, "linear_solver", set, n, "auto");
}

static corot_status add_finest_mesh(const planner *p, setting *set, int *n) {
  config *tree = p->study->tree;
  if (p->refine[0] != p->refine[1] && !is_overruled(p->study, "mesh.refine"))
    COROT_TRY(add_setting(tree, "mesh.refine", set, n, "%d", p->refine[1]));
  if (p->order[0] != p->order[1] && !is_overruled(p->study, "mesh.order"))
    COROT_TRY(add_setting(tree, "mesh.order", set, n, "%d", p->order[1]));
  return COROT_OK;
}

/* Whether a reference has that setting of its cell. */
static bool is_taken_over(const planner *p, const char *key) {
  return !is_solution(p, key) && !is_overruled(p->study, key) &&
         !(has_finest_mesh(p) && is_resolution(key));
}

/* The cell's settings with the reference's way of solving in the place of its own. */
static corot_status refer(planner *p, const cell *c, const char *method, int *nset, setting **out) {
  const study *s = p->study;
  setting *set = config_alloc(s->tree, (size_t)(c->nset + s->nreference_set + 11), sizeof *set);
  if (!set) return no_memory();
  int n = 0;
  set[n++] = p->quiet;
  for (int i = 0; i < c->nset; i++)
    if (is_taken_over(p, c->set[i].key)) set[n++] = c->set[i];
  if (has_finest_mesh(p)) COROT_TRY(add_finest_mesh(p, set, &n));
  COROT_TRY(add_solution(p, method, set, &n));
  for (int i = 0; i < s->nreference_set; i++) set[n++] = s->reference_set[i];
  set[n++] = p->binary;
  *nset = n;
  *out = set;
  return COROT_OK;
}

static corot_status add_reference_run(planner *p, const cell *c, int nset, const setting *set,
                                      json_t *runs) {
  scenario *s = NULL;
  json_int_t index = 0;
  COROT_TRY(read_scenario(p, c, nset, set, &s));
  corot_status status = find_run(p, s, nset, set, &index);
  scenario_destroy(s);
  COROT_TRY(status);
  return json_array_append_new(runs, json_integer(index)) ? no_memory() : COROT_OK;
}

/* The load in steps of half the length, on the way to the same equilibrium; after all other
   settings. */
static corot_status halve_steps(planner *p, const cell *c, int *nset, setting *set) {
  scenario *s = NULL;
  COROT_TRY(read_scenario(p, c, *nset, set, &s));
  double longest = s->statics.max_step / 2, first = fmin(s->statics.first_step, longest);
  double shortest = fmin(s->statics.min_step, first);
  scenario_destroy(s);
  config *tree = p->study->tree;
  COROT_TRY(add_setting(tree, "statics.min_step", set, nset, "%.17g", shortest));
  COROT_TRY(add_setting(tree, "statics.first_step", set, nset, "%.17g", first));
  return add_setting(tree, "statics.max_step", set, nset, "%.17g", longest);
}

/* The two runs; `first` [nfirst] are the settings of the one. */
static corot_status make_reference(planner *p, const cell *c, int nfirst, const setting *first,
                                   json_t *runs) {
  setting *second;
  int nsecond;
  COROT_TRY(refer(p, c, p->study->reference_method[1], &nsecond, &second));
  if (p->study->still) COROT_TRY(halve_steps(p, c, &nsecond, second));
  COROT_TRY(add_reference_run(p, c, nfirst, first, runs));
  return add_reference_run(p, c, nsecond, second, runs);
}

/* What a reference has beside the base's values, in the order of the keys. */
static json_t *reference_settings(const planner *p, int nset, const setting *set) {
  json_t *object = json_object();
  for (int i = 0; i < nset; i++) {
    bool ours = is_solution(p, set[i].key) && i < nset - 1 - p->study->nreference_set;
    if (ours || is_below(set[i].key, "output") || is_below(set[i].key, "quantities")) continue;
    object = json_text_with(object, set[i].key, study_value_json(set[i].value));
  }
  return object;
}

/* The number of the reference of a cell, made if there is none yet. */
static corot_status find_reference(planner *p, const cell *c, json_int_t *index) {
  setting *set;
  int nset;
  COROT_TRY(refer(p, c, p->study->reference_method[0], &nset, &set));
  /* its settings as text are what it is found by */
  json_t *list = assignments(p->study->tree, nset, set);
  char *text = json_text_dump_plain(list, JSON_COMPACT);
  json_decref(list);
  if (!text) return no_memory();
  const json_t *known = json_object_get(p->reference_at, text);
  *index = known ? json_integer_value(known) : (json_int_t)json_array_size(p->references);
  /* a new one: two runs, by independent methods */
  corot_status status = COROT_OK;
  if (!known) {
    json_t *runs = json_array();
    status = make_reference(p, c, nset, set, runs);
    bool still = p->study->still;
    json_t *entry =
        json_pack("{s:o, s:[s, s], s:f, s:o}", "runs", runs, "methods",
                  still ? "newton" : p->study->reference_method[0],
                  still ? "newton in half steps" : p->study->reference_method[1], "rtol",
                  reference_rtol(p), "settings", reference_settings(p, nset, set));
    if (json_array_append_new(p->references, entry) ||
        json_object_set_new(p->reference_at, text, json_integer(*index)))
      status = status == COROT_OK ? no_memory() : status;
  }
  free(text);
  return status;
}

/* --- Cells --- */

static json_t *cell_settings(const cell *c) {
  json_t *object = json_object();
  for (int i = 0; i < c->nplace; i++)
    object = json_text_with(object, c->place[i].key, study_value_json(c->place[i].value));
  return object;
}

/* What references depend on of all cells. */
static void observe(planner *p, const scenario *s) {
  bool first = json_array_size(p->cells) == 0;
  int order = s->order > 0 ? s->order : 1;
  if (s->integrator.step == 0) p->tightest = fmin(p->tightest, s->integrator.rtol);
  p->refine[0] = first || s->refine < p->refine[0] ? s->refine : p->refine[0];
  p->refine[1] = first || s->refine > p->refine[1] ? s->refine : p->refine[1];
  p->order[0] = first || order < p->order[0] ? order : p->order[0];
  p->order[1] = first || order > p->order[1] ? order : p->order[1];
}

static corot_status add_cell(planner *p, const cell *c) {
  /* its settings: no fields, what the cell sets, states in binary */
  setting *set = config_alloc(p->study->tree, (size_t)c->nset + 2, sizeof *set);
  if (!set) return no_memory();
  set[0] = p->quiet;
  memcpy(set + 1, c->set, (size_t)c->nset * sizeof *set);
  set[c->nset + 1] = p->binary;

  /* the run of the scenario that they make, which other cells may have, too */
  scenario *s = NULL;
  json_int_t run = 0;
  COROT_TRY(read_scenario(p, c, c->nset + 2, set, &s));
  corot_status status = find_run(p, s, c->nset + 2, set, &run);
  if (status == COROT_OK) observe(p, s);
  scenario_destroy(s);
  COROT_TRY(status);

  /* its entry */
  double tolerance = study_tolerance(c->tolerance);
  json_t *entry =
      json_pack("{s:I, s:o, s:s, s:o, s:s?, s:n}", "run", run, "settings", cell_settings(c),
                "series", c->series, "tolerance", c->tolerance ? json_real(tolerance) : json_null(),
                "tolerance_key", c->tolerance ? c->tolerance->key : NULL, "reference");
  return json_array_append_new(p->cells, entry) ? no_memory() : COROT_OK;
}

static corot_status add_references(planner *p) {
  for (int i = 0; i < p->study->ncell; i++) {
    json_int_t index = 0;
    COROT_TRY(find_reference(p, &p->study->cell[i], &index));
    json_t *entry = json_array_get(p->cells, (size_t)i);
    if (json_object_set_new(entry, "reference", json_integer(index))) return no_memory();
  }
  return COROT_OK;
}

/* --- The whole --- */

static int by_name(const void *a, const void *b) {
  return strcmp(*(const char *const *)a, *(const char *const *)b);
}

static json_t *column_names(const study *s) {
  const char *name[64];
  size_t n = 0;
  for (int i = 0; i < s->ncell; i++)
    for (int k = 0; k < s->cell[i].nplace; k++) {
      const char *column = s->cell[i].place[k].key;
      size_t at = 0;
      while (at < n && strcmp(name[at], column) != 0) at++;
      if (at == n && n < sizeof name / sizeof *name) name[n++] = column;
    }
  qsort(name, n, sizeof *name, by_name);
  json_t *list = json_array();
  for (size_t i = 0; i < n; i++) list = json_text_push(list, json_string(name[i]));
  return list;
}

static json_t *quantity_json(const study_quantity *q) {
  json_t *entry = json_pack("{s:s, s:s}", "of", q->text, "name", q->name);
  if (!q->known) return entry;
  return json_text_with(
      entry, "known",
      json_pack("{s:f, s:f, s:f}", "value", q->value, "within", q->within, "scale", q->scale));
}

static json_t *quantity_list(const study *s) {
  json_t *list = json_array();
  for (int i = 0; i < s->nquantity; i++)
    list = json_text_push(list, quantity_json(&s->quantity[i]));
  return list;
}

/* Of the title and of what the base says, without defaults: those are the version's. */
static corot_status identify(const study *s, char digest[HASH_SIZE]) {
  config *base = NULL;
  COROT_TRY(config_read(s->base, &base));
  json_t *both = json_pack("{s:s, s:o}", "study", s->title, "base", study_value_json(base->root));
  config_destroy(base);
  char *text = json_text_dump_plain(both, JSON_COMPACT | JSON_SORT_KEYS | JSON_REAL_PRECISION(17));
  json_decref(both);
  if (!text) return no_memory();
  hash_text(text, digest);
  free(text);
  return COROT_OK;
}

static corot_status find_base(const study *s, char **base) {
  *base = realpath(s->base, NULL);
  if (*base) return COROT_OK;
  if (folder_says_absent(errno)) return config_fail(s->base_node, "%s: cannot be found", s->base);
  if (errno == ENOMEM) return no_memory();
  return corot_fail(COROT_EIO, "%s: cannot be looked at: %s", s->base, strerror(errno));
}

static corot_status finish(planner *p, manifest **out) {
  const study *s = p->study;
  char digest[HASH_SIZE], *base;
  COROT_TRY(identify(s, digest));
  COROT_TRY(find_base(s, &base));
  json_t *path = json_text_string(base);
  free(base);
  json_t *root =
      json_pack("{s:s, s:s, s:o, s:s, s:s, s:i, s:b, s:s, s:s, s:o, s:o, s:O, s:O, s:O}", "study",
                s->title, "name", s->name, "base", path, "identity", digest, "corot",
                corot_version(), "repeat", s->repeat, "static", s->still, "cost", s->cost,
                "measure", s->measure, "quantities", quantity_list(s), "columns", column_names(s),
                "references", p->references, "cells", p->cells, "runs", p->runs);
  if (s->pilot) root = json_text_with(root, "pilot", json_incref(s->pilot));
  return root ? manifest_from_json(root, s->path, out) : no_memory();
}

static corot_status plan(planner *p, manifest **out) {
  COROT_TRY(make_setting(p->study->tree, "output.fields", "none", &p->quiet));
  COROT_TRY(make_setting(p->study->tree, "output.states", "binary", &p->binary));
  for (int i = 0; i < p->study->ncell; i++) COROT_TRY(add_cell(p, &p->study->cell[i]));
  if (p->study->referred) COROT_TRY(add_references(p));
  return finish(p, out);
}

corot_status plan_study(const study *s, manifest **out) {
  json_text_starved(); /* from here on */
  planner p = {
      .study = s,
      .runs = json_array(),
      .cells = json_array(),
      .references = json_array(),
      .run_at = json_object(),
      .reference_at = json_object(),
      .mesh_at = json_object(),
      .tightest = INFINITY,
  };
  manifest *m = NULL;
  corot_status status = plan(&p, &m);
  if (status == COROT_OK && json_text_starved()) status = no_memory(); /* some key may be missing */
  json_decref(p.runs);
  json_decref(p.cells);
  json_decref(p.references);
  json_decref(p.run_at);
  json_decref(p.reference_at);
  json_decref(p.mesh_at);
  if (status == COROT_OK)
    *out = m;
  else
    manifest_destroy(m);
  return status;
}
