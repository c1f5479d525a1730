/* The folder that a run left, read back. */
#ifndef COROT_REPORT_RUN_FOLDER_H
#define COROT_REPORT_RUN_FOLDER_H

#include <jansson.h>

#include <app/read_csv.h>

typedef struct run_folder {
  const char *dir;
  json_t *result;                     /* result.json */
  json_t *budget;                     /* budget.json; NULL: there is none */
  csv probes, energy, steps, compare; /* without columns where there is no such file */
} run_folder;

/* `dir` must outlive the folder. COROT_EIO where there is no result.json. */
corot_status run_folder_read(const char *dir, run_folder *folder);

void run_folder_free(run_folder *folder);

#endif
