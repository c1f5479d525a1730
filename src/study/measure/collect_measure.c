/* Trajectories from the folders of runs, and the model they belong to. */
#include "collect_measure.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/command/cli.h"
#include "app/folder/hash.h"
#include "app/text/json_text.h"
#include "app/text/no_memory.h"

/* All that a yardstick depends on: the scenario without what only the solution depends on. */
static char *yardstick_key(const json_t *result) {
  static const char *const solution[] = {"title",  "integrator", "linear_solver", "frames",
                                         "time",   "statics",    "start",         "compare",
                                         "output", "quantities"};
  json_t *solid = json_copy(json_object_get(result, "scenario"));
  for (size_t i = 0; i < sizeof solution / sizeof *solution; i++)
    json_object_del(solid, solution[i]);
  const json_t *hash = json_object_get(json_object_get(result, "hashes"), "mesh");
  json_t *both = json_pack("{s:o, s:O}", "solid", solid, "mesh", hash);
  char *text = json_text_dump_plain(both, JSON_COMPACT | JSON_SORT_KEYS | JSON_REAL_PRECISION(17));
  json_decref(both);
  return text;
}

static corot_status check_mesh(const yardstick *y, const json_t *result) {
  char digest[HASH_SIZE];
  hash_mesh(y->mesh, digest);
  const char *was = json_string_value(json_object_get(json_object_get(result, "hashes"), "mesh"));
  if (strcmp(digest, was) == 0) return COROT_OK;
  return corot_fail(COROT_EINVAL, "the mesh has changed since the run");
}

/* The scenario as the run recorded it; its files are found from the base. */
static corot_status read_scenario(const manifest *m, const json_t *result, scenario **out) {
  char *text = json_text_dump(json_object_get(result, "scenario"), JSON_REAL_PRECISION(17));
  if (!text) return no_memory();
  corot_status status = scenario_read_text(m->base, text, strlen(text), 0, NULL, out);
  free(text);
  return status;
}

static void drop_yardstick(measuring *g) {
  yardstick_destroy(g->yardstick);
  scenario_destroy(g->scenario);
  free(g->key);
  g->yardstick = NULL;
  g->scenario = NULL;
  g->key = NULL;
}

/* A result that somebody has edited may lack what its yardstick is found by. */
static corot_status check_result(const json_t *result) {
  const json_t *hash = json_object_get(json_object_get(result, "hashes"), "mesh");
  if (!json_is_object(json_object_get(result, "scenario")))
    return corot_fail(COROT_EFORMAT, "its result has no scenario");
  if (!json_is_string(hash)) return corot_fail(COROT_EFORMAT, "its result has no hash of the mesh");
  return COROT_OK;
}

/* Finds the yardstick of a run, which often is that of the run before. */
static corot_status hold_yardstick(measuring *g, const json_t *result) {
  COROT_TRY(check_result(result));
  char *key = yardstick_key(result);
  if (!key) return no_memory();
  if (g->key && strcmp(g->key, key) == 0) {
    free(key);
    return COROT_OK;
  }
  drop_yardstick(g);
  g->key = key;
  corot_status status = read_scenario(g->m, result, &g->scenario);
  if (status == COROT_OK) status = yardstick_create(g->scenario, &g->yardstick);
  if (status == COROT_OK) status = check_mesh(g->yardstick, result);
  if (status != COROT_OK) drop_yardstick(g);
  return status;
}

static corot_status read_states(const char *dir, const study_run *run, trajectory *out) {
  char *path = store_path(dir, run, ""), *file = store_path(dir, run, "states.bin");
  corot_status status = path && file ? states_read(path, out) : COROT_ENOMEM;
  if (status == COROT_EIO) status = read_failure(status, file);
  free(file);
  free(path);
  return status;
}

corot_status measure_states(measuring *g, int reference, trajectory *out) {
  return read_states(g->dir, &g->m->run[g->m->reference[reference].run[0]], out);
}

static corot_status hold_reference(measuring *g, int reference) {
  if (g->reference == reference) return COROT_OK;
  states_free(&g->kept);
  g->reference = -1;
  COROT_TRY(measure_states(g, reference, &g->kept));
  g->reference = reference;
  return COROT_OK;
}

corot_status measure_run(measuring *g, const study_run *run, const json_t *result, int reference,
                         errors *e, drift *d) {
  trajectory t = {0};
  COROT_TRY(hold_yardstick(g, result));
  char *path = store_path(g->dir, run, "");
  if (!path) return COROT_ENOMEM;
  *d = (drift){NAN, NAN}; /* equilibria have no books of that kind */
  corot_status status = g->m->still ? COROT_OK : drift_measure(g->yardstick, g->scenario, path, d);
  free(path);
  COROT_TRY(status);
  if (reference < 0) return COROT_OK;
  COROT_TRY(hold_reference(g, reference));
  COROT_TRY(read_states(g->dir, run, &t));
  status = errors_measure(g->yardstick, &t, &g->kept, e);
  states_free(&t);
  return status;
}

corot_status measure_look(measuring *g, const study_run *run, run_record *record) {
  COROT_TRY(g->looked ? store_look(g->dir, run, record) : store_verify(g->dir, run, record));
  g->ndamaged += record->damaged;
  return COROT_OK;
}

corot_status measure_hold(measuring *g, int reference) {
  const study_run *run = &g->m->run[g->m->reference[reference].run[0]];
  run_record record;
  COROT_TRY(store_look(g->dir, run, &record));
  corot_status status = record.state == RUN_DONE
                            ? hold_yardstick(g, record.result)
                            : corot_fail(COROT_EINVAL, "the reference is not known");
  run_record_free(&record);
  return status;
}

void measuring_free(measuring *g) {
  builds_free(&g->builds);
  drop_yardstick(g);
  states_free(&g->kept);
}
