/* Reports: one HTML file that shows a run or a study. */
#ifndef COROT_REPORT_REPORT_H
#define COROT_REPORT_REPORT_H

#include <corot/base.h>

/* Writes the report of what is in `dir` (a table.json: a study; a result.json: a run) to `path`.
   COROT_EIO where it is neither. */
corot_status report_write(const char *dir, const char *path);

#endif
