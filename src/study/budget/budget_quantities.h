/* The scenario's quantities in an error budget: what each part does to each of them.

   In budget.json, "quantities": {NAME: {"of": as it was understood, "value": of the run as given,
   "reference": what all parts together lead to, null where one is missing; "parts": [{"part",
   "change": signed, in the quantity's own unit; "error": its size over that of the reference (or
   of the value, where that is null); "bound", "low", "high", "floor", "order", "verdict": as of the
   displacement (budget.h)}]}} */
#ifndef COROT_STUDY_BUDGET_BUDGET_QUANTITIES_H
#define COROT_STUDY_BUDGET_BUDGET_QUANTITIES_H

#include "budget_runs.h"

/* The object above, the caller's to json_decref. */
corot_status budget_quantities(const budgeting *b, json_t **out);

/* A table for each. */
void budget_quantities_print(const json_t *budget, FILE *out);

#endif
