#include "run_folder.h"

#include <stdlib.h>
#include <unistd.h>

#include "folder.h"
#include "lookup.h"

void run_folder_free(run_folder *f) {
  json_decref(f->result);
  json_decref(f->budget);
  csv_free(&f->probes);
  csv_free(&f->energy);
  csv_free(&f->steps);
  csv_free(&f->compare);
  *f = (run_folder){0};
}

static corot_status read_budget(const char *dir, json_t **budget) {
  char *path = folder_path(dir, "budget.json");
  if (!path) return COROT_ENOMEM;
  int there = access(path, F_OK) == 0;
  free(path);
  return there ? lookup_read(dir, "budget.json", budget) : COROT_OK;
}

static corot_status read_all(run_folder *f) {
  COROT_TRY(lookup_read(f->dir, "result.json", &f->result));
  COROT_TRY(read_budget(f->dir, &f->budget));
  COROT_TRY(csv_read_if_there(f->dir, "probes.csv", &f->probes));
  COROT_TRY(csv_read_if_there(f->dir, "energy.csv", &f->energy));
  COROT_TRY(csv_read_if_there(f->dir, "steps.csv", &f->steps));
  return csv_read_if_there(f->dir, "compare.csv", &f->compare);
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
