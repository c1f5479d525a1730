/* Looks what kind of folder it is, and hands it on. */
#include "report.h"

#include <stdbool.h>
#include <stdlib.h>

#include "app/folder/folder.h"
#include "report/page/save.h"
#include "report/run/budget_section.h"
#include "report/run/report_run.h"
#include "report/study/report_goal.h"
#include "report/study/report_study.h"

corot_status report_has(const char *dir, const char *name, bool *there) {
  char *path = folder_path(dir, name);
  if (!path) return COROT_ENOMEM;
  corot_status status = folder_look(path, there);
  free(path);
  return status;
}

corot_status report_write(const char *dir, const char *path) {
  bool run = false, study = false, budget = false, goal = false;
  COROT_TRY(report_has(dir, "result.json", &run));
  COROT_TRY(report_has(dir, "table.json", &study));
  COROT_TRY(report_has(dir, "budget.json", &budget));
  COROT_TRY(report_has(dir, "solve.json", &goal));
  if (study) return report_study(dir, path);
  if (run) return report_run(dir, path);
  if (budget) return report_budget(dir, path);
  if (goal) return report_goal(dir, path);
  return corot_fail(COROT_EIO,
                    "%s: holds no result.json of a run, no table.json of a study, no budget.json "
                    "and no solve.json",
                    dir);
}
