/* What a study found, in words and tables. */
#ifndef COROT_REPORT_STUDY_STUDY_SUMMARY_H
#define COROT_REPORT_STUDY_STUDY_SUMMARY_H

#include <stdio.h>

#include "report/read/study_table.h"

/* What was run, what the references are worth, and which series is cheapest at which error. */
void study_summary_write(const study_table *table, FILE *out);

/* All cells, with the reasons of those that failed. */
void study_summary_cells(const study_table *table, FILE *out);

#endif
