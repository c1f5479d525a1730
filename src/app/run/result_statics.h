/* The parts of result.json that are a search's for an equilibrium, not a run's. */
#ifndef COROT_APP_RUN_RESULT_STATICS_H
#define COROT_APP_RUN_RESULT_STATICS_H

#include <jansson.h>

#include "result.h"

/* Settings, load factors, and every load step with its residuals. NULL: no memory. */
json_t *result_statics(const scenario *s, const statics_summary *statics);

/* Counts, KINSOL's under its own names. NULL: no memory. */
json_t *result_statics_counts(const corot_statics_counts *counts);

#endif
