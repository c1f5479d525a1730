#include "run_folder.h"

#include <stdlib.h>

#include "folder.h"
#include "lookup.h"

void run_folder_free(run_folder *f) {
  json_decref(f->result);
  json_decref(f->budget);
  json_decref(f->groups);
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

static corot_status read_all(run_folder *f) {
  COROT_TRY(lookup_read(f->dir, "result.json", &f->result));
  COROT_TRY(read_if_there(f->dir, "budget.json", &f->budget));
  COROT_TRY(read_if_there(f->dir, "groups.json", &f->groups));
  COROT_TRY(csv_read_if_there(f->dir, "probes.csv", &f->probes));
  COROT_TRY(csv_read_if_there(f->dir, "energy.csv", &f->energy));
  COROT_TRY(csv_read_if_there(f->dir, "history.csv", &f->history));
  COROT_TRY(csv_read_if_there(f->dir, "reactions.csv", &f->reactions));
  COROT_TRY(csv_read_if_there(f->dir, "steps.csv", &f->steps));
  return csv_read_if_there(f->dir, "compare.csv", &f->compare);
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
