/* Reports: one HTML file that shows a run, a study, an error budget or a quantity within an error.
 */
#ifndef COROT_REPORT_COMMAND_REPORT_H
#define COROT_REPORT_COMMAND_REPORT_H

#include <stdbool.h>

#include <corot/base.h>

/* Whether a folder has a file of that name. */
corot_status report_has(const char *dir, const char *name, bool *there);

/* Writes the report of what is in `dir` (a table.json: a study; a result.json: a run, with
   its budget if there is a budget.json of it; that alone: a budget; a solve.json: what `corot
   solve` found) to `path`. COROT_EIO where it is none of these. */
corot_status report_write(const char *dir, const char *path);

#endif
