/* Work-precision diagrams: what each digit of a study costs. */
#ifndef COROT_REPORT_CHART_PRECISION_H
#define COROT_REPORT_CHART_PRECISION_H

#include "report/read/study_table.h"

/* A diagram is asked for by the cost (across) and the error (up), an index of error_name. */
typedef struct precision {
  const study_table *table;
  study_cost cost;
  int error;
} precision;

/* Whether what would be replaced of the following files is corot's own. COROT_EIO names one that is
   not. */
corot_status precision_permit(const char *base);

/* Writes BASE.svg, and BASE.csv with all cells, also those without a point, beside it; BASE.gp and
   BASE.py draw the same from the CSV with gnuplot and matplotlib. */
corot_status precision_write(const precision *p, const char *base);

#endif
