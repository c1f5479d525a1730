#include "report.h"

#include <stdbool.h>
#include <stdlib.h>
#include <unistd.h>

#include "folder.h"
#include "report_run.h"
#include "report_study.h"
#include "save.h"

static corot_status has(const char *dir, const char *name, bool *there) {
  char *path = folder_path(dir, name);
  if (!path) return COROT_ENOMEM;
  *there = access(path, F_OK) == 0;
  free(path);
  return COROT_OK;
}

corot_status report_write(const char *dir, const char *path) {
  bool run = false, study = false;
  COROT_TRY(has(dir, "result.json", &run));
  COROT_TRY(has(dir, "table.json", &study));
  if (study) return report_study(dir, path);
  if (run) return report_run(dir, path);
  return corot_fail(
      COROT_EIO, "%s: holds neither the result.json of a run nor the table.json of a study", dir);
}
