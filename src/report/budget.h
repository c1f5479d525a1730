/* The error budget of a run, DIR/budget.json, as a table:

     {"measure": "displacement at the end, relative",
      "parts": [{"part": "time integration", "pair": "rtol 1e-4 against 1e-6", "error": 1.2e-3,
                 "advice": "..."}, ...],
      "total": 2.0e-3, "interaction": -1.0e-4, "first": "what to change first"}

   What is absent is left out. */
#ifndef COROT_REPORT_BUDGET_H
#define COROT_REPORT_BUDGET_H

#include <jansson.h>
#include <stdio.h>

void budget_write(const json_t *budget, FILE *out);

#endif
