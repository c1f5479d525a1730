/* How many threads a run has. */
#ifndef COROT_APP_SCENARIO_SCENARIO_THREADS_H
#define COROT_APP_SCENARIO_SCENARIO_THREADS_H

#include <corot/ode.h>

#include "scenario.h"

/* As many as the scenario says; else as many as pay for the model, but no more than OMP_NUM_THREADS
   says, which is how a user, a batch system, or corot study tells programs how many are theirs. */
int scenario_threads(const scenario *s, const corot_model *model);

/* They work for the state. Fewer, where the scenario does not say how many and the system does not
   start as many. */
corot_status scenario_share(const scenario *s, const corot_model *model, corot_state *state);

#endif
