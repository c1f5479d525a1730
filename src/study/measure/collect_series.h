/* What is said of whole series: how errors follow tolerances, and which is the cheapest. */
#ifndef COROT_STUDY_MEASURE_COLLECT_SERIES_H
#define COROT_STUDY_MEASURE_COLLECT_SERIES_H

#include "collect_rows.h"

/* Fits and rankings of rows, as lists. NULL: no memory. */
json_t *collect_fits(const table_rows *t);
json_t *collect_rankings(const table_rows *t);

#endif
