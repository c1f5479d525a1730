/* The error budget of a run (budget.json, see study/budget/budget.h) as a section of a report, and
   as a report of its own. What is absent or null is left out. */
#ifndef COROT_REPORT_RUN_BUDGET_SECTION_H
#define COROT_REPORT_RUN_BUDGET_SECTION_H

#include <corot/base.h>
#include <jansson.h>
#include <stdio.h>

void budget_write(const json_t *budget, FILE *out);

/* The report of DIR/budget.json alone. */
corot_status report_budget(const char *dir, const char *path);

#endif
