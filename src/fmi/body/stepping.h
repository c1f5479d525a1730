/* The integration inside of a Co-Simulation instance, from one communication point to the next, by
   the loop of a run: next event, advance, handle.

   Without inputs, with frames that are exact and error control, the steps take no notice of
   communication points, which are read off the interpolant: the outputs are, bit for bit, those of
   `corot run` with these output times. Else each communication point ends a step. What is due there
   (a kink, inputs that were set, frames that are to be found anew) is handled when the next step
   begins, so that outputs are those of before, as the rows of a run are; and the run to compare
   with has inputs whose values change there. */
#ifndef COROT_FMI_BODY_STEPPING_H
#define COROT_FMI_BODY_STEPPING_H

#include <corot/checkpoint.h>
#include <corot/inputs.h>

#include "core/base/pack.h"
#include "moment.h"

typedef struct stepping stepping;

/* What an instance and its integration have in common. Model, state and inputs must outlive the
   integration. */
typedef struct stepping_def {
  const body *body;
  corot_state *state;
  corot_inputs *inputs; /* or NULL */
  double rtol;          /* 0: the scenario's */
  double stop;          /* [s] no step goes beyond it; INFINITY: not known */
} stepping_def;

/* At (t, u, v), which the moment says. Failures as of corot_integrator_create. */
corot_status stepping_create(const stepping_def *def, const moment *start, stepping **out);

/* Takes NULL. */
void stepping_destroy(stepping *s);

/* Asked at the end of each step up to the communication point, which is read into the moment: true
   ends the advance there, or at *t if that is later. */
typedef bool stepping_hook(void *data, double *t);

/* On to `t`, later than the moment's; `now` becomes that of t, or of where the hook wants to end.
   It is that of the time reached if the integration fails. COROT_EINVAL: a constant step does not
   lead there; else failures as of corot_integrator_step. */
corot_status stepping_advance(stepping *s, double t, stepping_hook *hook, void *data, moment *now);

/* Whether a constant step, if there is one, leads to t. COROT_EINVAL says why not. */
corot_status stepping_check(const body *b, double t);

/* An input has been set since the last advance. */
void stepping_tell(stepping *s);

/* Writes or reads the integration at the moment, which is that of the last advance: a new
   beginning, from which who goes on and who restores get the same numbers (corot/checkpoint.h). A
   step that has gone beyond the moment is given up first. The status is also p's. */
corot_status stepping_exchange(stepping *s, pack *p, moment *now);

#endif
