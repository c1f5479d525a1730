/* What an integrator asks of a state beside evaluations: which of its parts have changed between
   two times, and what they mean for matrices. */
#ifndef COROT_CORE_ODE_STAMP_H
#define COROT_CORE_ODE_STAMP_H

#include <corot/inputs.h>
#include <stdbool.h>

#include "core/base/sisters.h"

/* Counts of changes: equal where nothing has changed. */
typedef struct state_stamp {
  bool inputs;   /* there are some, */
  bool moves;    /* that move supports, */
  bool feedback; /* of which K and D depend on the motion */
  long frames;   /* of the frames, or other inputs */
  long loads;    /* of input forces and factors of loads */
  long paths;    /* of supports */
  long matrices; /* of what else is in K and D */
} state_stamp;

COROT_SISTERS state_stamp corot_state_stamp(const corot_state *state);

/* *gain = the elastic energy that the body has gained by changes of its materials since this was
   last asked [J]. COROT_RETRY when a tet is inverted. */
COROT_SISTERS corot_status corot_materials_gain(const corot_model *model, corot_state *state,
                                                double t, const double *u, double *gain);

/* What has changed so far is where a run starts. */
COROT_SISTERS void corot_materials_settle(corot_state *state);

/* Whether they may hold a body that no support holds: there is a feedback with blocks. Takes NULL.
 */
COROT_SISTERS bool corot_inputs_may_hold(const corot_inputs *inputs);

#endif
