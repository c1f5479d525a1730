/* The folder that a run left, read back. */
#ifndef COROT_REPORT_READ_RUN_FOLDER_H
#define COROT_REPORT_READ_RUN_FOLDER_H

#include <jansson.h>
#include <stdbool.h>

#include "app/folder/read_csv.h"

typedef struct run_folder {
  const char *dir;
  json_t *result; /* result.json */
  json_t *budget; /* budget.json; NULL: there is none, or none of this run */
  bool stranger;  /* there is one of another run */
  json_t *groups; /* groups.json; NULL: there is none */
  /* without columns where there is no such file */
  csv probes, energy, history, steps, compare, reactions;
  json_t *lost; /* names of files that result.json lists, and that are not there; NULL: none are */
} run_folder;

/* `dir` must outlive the folder. COROT_EIO where there is no result.json; COROT_EFORMAT where a
   file is not what result.json says. */
corot_status run_folder_read(const char *dir, run_folder *folder);

/* The table that has a column at the most times: history.csv, else `table`. */
const csv *run_folder_finest(const run_folder *run, const csv *table, const char *column);

/* Whether it is of `corot static`; and what the times in its tables are multiples of there, the end
   time, so that quotients are load factors. Else 1. */
bool run_folder_is_static(const run_folder *run);
double run_folder_unit(const run_folder *run);

void run_folder_free(run_folder *folder);

#endif
