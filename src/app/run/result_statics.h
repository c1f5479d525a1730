/* The parts of result.json that are a search's for an equilibrium, not a run's. */
#ifndef COROT_APP_RUN_RESULT_STATICS_H
#define COROT_APP_RUN_RESULT_STATICS_H

#include <jansson.h>

#include "app/scenario/scenario.h"

/* What a search for an equilibrium has to say beside a run's summary. */
typedef struct statics_summary {
  corot_statics_counts counts;
  const char *linear_solver;
  double factor;           /* reached */
  double stable, unstable; /* load factors between which stability was lost; NaN: nowhere */
  json_t *steps;           /* a list with an object for each load step */
  json_t *reactions;       /* by group, at the last equilibrium */
} statics_summary;

/* Settings, load factors, and every load step with its residuals. NULL: no memory. */
json_t *result_statics(const scenario *s, const statics_summary *statics);

/* Counts, KINSOL's under its own names. NULL: no memory. */
json_t *result_statics_counts(const corot_statics_counts *counts);

#endif
