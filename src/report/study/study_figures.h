/* The charts of a study. */
#ifndef COROT_REPORT_STUDY_STUDY_FIGURES_H
#define COROT_REPORT_STUDY_STUDY_FIGURES_H

#include <stdio.h>

#include "report/read/study_table.h"

/* Work and precision: all cells, from which the page draws any error against any cost. Of a table
   with errors. */
void study_figures_precision(const study_table *table, FILE *out);

/* The error against the tolerance, and what lines fit it. */
corot_status study_figures_tolerance(const study_table *table, FILE *out);

#endif
