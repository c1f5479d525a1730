/* What an integrator asks of a state beside evaluations: which of its parts have changed between
   two times, and what they mean for matrices. */
#ifndef COROT_CORE_ODE_STAMP_H
#define COROT_CORE_ODE_STAMP_H

#include <corot/inputs.h>
#include <stdbool.h>

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

state_stamp corot_state_stamp(const corot_state *state);

/* Whether they may hold a body that no support holds: there is a feedback with blocks. Takes NULL.
 */
bool corot_inputs_may_hold(const corot_inputs *inputs);

#endif
