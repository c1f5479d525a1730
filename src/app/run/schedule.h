/* What is due when, in a run from 0 to its end.

   Kinks of loads and motions, and changes of inputs, stop the integrator, if it can be stopped: one
   of constant step keeps to its grid, and a kink is due at the end of the step it falls into.
   Output times are read off the integrator's interpolant and leave its steps alone. The k-th output
   stands at k * output_step: times do not add up their rounding. */
#ifndef COROT_APP_RUN_SCHEDULE_H
#define COROT_APP_RUN_SCHEDULE_H

#include <corot/model.h>

#include "core/base/pack.h"

typedef struct schedule {
  double end;         /* [s] */
  double output_step; /* [s]; 0: at the start and the end only */
  int nkink;
  double *kink; /* [nkink] ascending, each once, within (0, end); changes of inputs included */
  double near;  /* times closer than this are the same: an interval of 0.1 meets a kink at 0.3 */

  int next_kink;
  long next_output; /* counting from 0 */
} schedule;

/* `change` [nchange] are the times of the inputs, within (0, end), in any order. */
corot_status schedule_create(const corot_model *model, double end, double output_step, int nchange,
                             const double *change, schedule **out);
void schedule_destroy(schedule *s);

/* Writes or reads how far it has come. */
void schedule_exchange(pack *p, schedule *s);

/* The first of the next kink, `other` and the end. */
double schedule_stop(const schedule *s, double other);

/* Whether the end has been reached at t. */
bool schedule_over(const schedule *s, double t);

/* Whether the next kink lies before t, and not within rounding of it. */
bool schedule_kink_before(const schedule *s, double t);

/* The next kink if it is due at t, which is then past: t has reached it, but for rounding of its
   last digits. One that is only near is a stop of its own, which costs no step. */
bool schedule_take_kink(schedule *s, double t, double *kink);

/* The next output time if it is due at t, which is then past. It may be after t by rounding. The
   start and the end are output times, each once. */
bool schedule_take_output(schedule *s, double t, double *output);

#endif
