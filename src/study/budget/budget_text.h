/* An error budget in words and columns. */
#ifndef COROT_STUDY_BUDGET_BUDGET_TEXT_H
#define COROT_STUDY_BUDGET_BUDGET_TEXT_H

#include <jansson.h>
#include <stdio.h>

/* The largest part and what to do about it, or that it is not known. parts: as in budget.json. The
   caller's; NULL: no memory. */
json_t *budget_verdict(const json_t *parts, double total);

void budget_print(const json_t *budget, FILE *out);

#endif
