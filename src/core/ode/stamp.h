/* What an integrator asks of a state beside evaluations: which of its parts have changed between
   two times, and what they mean for matrices. */
#ifndef COROT_CORE_ODE_STAMP_H
#define COROT_CORE_ODE_STAMP_H

#include <corot/inputs.h>
#include <stdbool.h>

/* Counts of changes: equal where nothing has changed. */
typedef struct state_stamp {
  bool inputs; /* there are some */
  long frames; /* of the frames, or other inputs */
  long loads;  /* of input forces and factors of loads */
} state_stamp;

state_stamp corot_state_stamp(const corot_state *state);

#endif
