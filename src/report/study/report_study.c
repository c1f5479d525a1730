/* The sections of the page of a study, in their order. */
#include "report_study.h"

#include "report/page/html.h"
#include "report/page/save.h"
#include "study_figures.h"
#include "study_summary.h"

static corot_status write_study(const void *what, FILE *out) {
  const study_table *t = what;
  page_begin(*t->title ? t->title : "A study", "study", out);
  study_summary_write(t, out);
  corot_status status = COROT_OK;
  if (t->nerror > 0) {
    study_figures_precision(t, out);
    status = study_figures_tolerance(t, out);
  }
  study_summary_cells(t, out);
  page_end(out);
  return status;
}

corot_status report_study(const char *dir, const char *path) {
  study_table t;
  COROT_TRY(study_table_read(dir, &t));
  corot_status status = save_text(path, write_study, &t);
  study_table_free(&t);
  return status;
}
