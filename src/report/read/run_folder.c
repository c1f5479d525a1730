/* Reads result.json and the tables that are there. */
#include "run_folder.h"

#include <stdlib.h>
#include <string.h>

#include "app/folder/folder.h"
#include "app/folder/folder_files.h"
#include "app/folder/hash.h"
#include "lookup.h"

void run_folder_free(run_folder *f) {
  json_decref(f->result);
  json_decref(f->budget);
  json_decref(f->groups);
  json_decref(f->lost);
  csv_free(&f->probes);
  csv_free(&f->energy);
  csv_free(&f->history);
  csv_free(&f->steps);
  csv_free(&f->compare);
  csv_free(&f->reactions);
  *f = (run_folder){0};
}

static corot_status read_if_there(const char *dir, const char *name, json_t **document) {
  char *path = folder_path(dir, name);
  if (!path) return COROT_ENOMEM;
  bool there;
  corot_status status = folder_look(path, &there);
  free(path);
  COROT_TRY(status);
  return there ? lookup_read(dir, name, document) : COROT_OK;
}

/* What is not there any more is left out, and said. */
static corot_status verify(run_folder *f, const char *name) {
  bool lost;
  COROT_TRY(folder_verify_file(f->dir, f->result, name, &lost));
  if (!lost) return COROT_OK;
  if (!f->lost) f->lost = json_array();
  if (json_array_append_new(f->lost, json_string(name)))
    return corot_fail(COROT_ENOMEM, "%s/%s: out of memory", f->dir, name);
  return COROT_OK;
}

/* Keeps the budget only if it is of what the folder holds. */
static corot_status claim_budget(run_folder *f) {
  char digest[HASH_SIZE];
  const json_t *scenario = lookup(f->result, "scenario");
  COROT_TRY(read_if_there(f->dir, "budget.json", &f->budget));
  if (!f->budget) return COROT_OK;
  f->stranger = true;
  if (json_is_object(scenario)) {
    COROT_TRY(hash_solution(scenario, digest));
    f->stranger =
        strcmp(lookup_text(f->budget, "hashes.solution"), digest) != 0 ||
        strcmp(lookup_text(f->budget, "hashes.mesh"), lookup_text(f->result, "hashes.mesh")) != 0 ||
        json_is_true(lookup(f->budget, "static")) != run_folder_is_static(f);
  }
  if (!f->stranger) return COROT_OK;
  json_decref(f->budget);
  f->budget = NULL;
  return COROT_OK;
}

static corot_status read_all(run_folder *f) {
  const struct {
    const char *name;
    csv *table;
  } table[] = {{"probes.csv", &f->probes},       {"energy.csv", &f->energy},
               {"history.csv", &f->history},     {"steps.csv", &f->steps},
               {"reactions.csv", &f->reactions}, {"compare.csv", &f->compare}};
  COROT_TRY(lookup_read(f->dir, "result.json", &f->result));
  if (json_is_object(lookup(f->result, "modes")))
    return corot_fail(COROT_EFORMAT,
                      "%s: holds the modes of corot modes: their shapes are in fields.pvd, for "
                      "ParaView; reports are of runs, equilibria and studies",
                      f->dir);
  COROT_TRY(claim_budget(f));
  COROT_TRY(verify(f, "groups.json"));
  COROT_TRY(read_if_there(f->dir, "groups.json", &f->groups));
  for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
    COROT_TRY(verify(f, table[i].name));
    COROT_TRY(csv_read_if_there(f->dir, table[i].name, table[i].table));
  }
  return verify(f, "fields.pvd");
}

const csv *run_folder_finest(const run_folder *run, const csv *table, const char *column) {
  return csv_find(&run->history, column) >= 0 ? &run->history : table;
}

bool run_folder_is_static(const run_folder *run) {
  return json_is_object(lookup(run->result, "statics"));
}

double run_folder_unit(const run_folder *run) {
  double end = lookup_number(run->result, "t_end");
  return run_folder_is_static(run) && end > 0 ? end : 1;
}

corot_status run_folder_read(const char *dir, run_folder *folder) {
  run_folder f = {.dir = dir};
  corot_status status = read_all(&f);
  if (status != COROT_OK) {
    run_folder_free(&f);
    return status;
  }
  *folder = f;
  return COROT_OK;
}
