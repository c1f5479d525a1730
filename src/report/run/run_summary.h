/* What a run was and how it went, in words and tables: the first section of its report. */
#ifndef COROT_REPORT_RUN_RUN_SUMMARY_H
#define COROT_REPORT_RUN_RUN_SUMMARY_H

#include <stdio.h>

#include "report/read/run_folder.h"

void run_summary_write(const run_folder *run, FILE *out);

/* The resolved scenario in full, and what the run's identity is hashed from. */
void run_summary_scenario(const run_folder *run, FILE *out);

#endif
