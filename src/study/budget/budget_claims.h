/* What an error budget claims of each part. */
#ifndef COROT_STUDY_BUDGET_BUDGET_CLAIMS_H
#define COROT_STUDY_BUDGET_BUDGET_CLAIMS_H

#include "budget_runs.h"

typedef struct budget_claims {
  claim part[BUDGET_KINDS], total;
  errors check; /* of time: two methods at the finest tolerance; n = 0: none */
  errors chain; /* what the runs after time are known by; n = 0: nobody knows */
} budget_claims;

corot_status budget_claims_make(const budgeting *b, budget_claims *out);
void budget_claims_free(budget_claims *c);

#endif
