/* The inputs of a scenario as a run goes on: at each of their times the state's take what holds
   from there. */
#ifndef COROT_APP_RUN_LIVE_H
#define COROT_APP_RUN_LIVE_H

#include <corot/inputs.h>

#include "app/scenario/scenario.h"
#include "core/base/pack.h"

typedef struct live live;

/* As they are at t; the scenario and the model must outlive them. */
corot_status live_create(const scenario *s, const corot_model *model, double t, live **out);

/* Takes NULL. */
void live_destroy(live *l);

/* NULL: the scenario has none. */
corot_inputs *live_inputs(const live *l);

/* The times within (0, end) at which something changes, ascending for each input; at most `max` are
   written to `time`. Returns how many there are. */
int live_times(const live *l, double end, int max, double *time);

/* Writes or reads how far they have come; what they say then is the state's (corot/checkpoint.h).
 */
void live_exchange(pack *p, live *l);

/* What holds from t on. *changed: the integrator has to be told. */
corot_status live_enter(live *l, double t, bool *changed);

#endif
