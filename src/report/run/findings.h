/* What the reader of a run's report should see first: its warnings, and the extremes of the motion.
 */
#ifndef COROT_REPORT_RUN_FINDINGS_H
#define COROT_REPORT_RUN_FINDINGS_H

#include <stdio.h>

#include "report/read/run_folder.h"

/* The texts of result.json's `warnings`, {code, text} or plain strings; that there are none, where
   the list is empty; nothing, where there is no list. */
void findings_warnings(const run_folder *run, FILE *out);

/* A table of result.json's `extremes`, if it has any. */
void findings_extremes(const run_folder *run, FILE *out);

/* The same of `quantities`: what was asked for. */
void findings_quantities(const run_folder *run, FILE *out);

#endif
