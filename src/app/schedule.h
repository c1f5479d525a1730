/* What is due when, in a run from 0 to its end.

   Only what changes the right-hand side stops the integrator: kinks of the loads, updates of held
   frames, the end. Output times are read off its interpolant and leave its steps alone.
   The k-th of a series stands at k * interval: times do not add up their rounding. */
#ifndef COROT_APP_SCHEDULE_H
#define COROT_APP_SCHEDULE_H

#include <corot/model.h>

typedef struct schedule {
  double end;            /* [s] */
  double output_step;    /* [s]; 0: at the start and the end only */
  double frame_interval; /* [s]; 0: frames are not held */
  int nkink;
  double *kink; /* [nkink] ascending, within (0, end) */
  double near;  /* times closer than this are the same: an interval of 0.1 meets a kink at 0.3 */

  int next_kink;
  long next_frames, next_output; /* counting from 1, from 0 */
} schedule;

corot_status schedule_create(const corot_model *model, double end, double output_step,
                             double frame_interval, schedule **out);
void schedule_destroy(schedule *s);

/* The next time at which the right-hand side changes, or the end. */
double schedule_stop(const schedule *s);

/* True once if t is at a kink (at an update), which is then past. */
bool schedule_take_kink(schedule *s, double t);
bool schedule_take_frames(schedule *s, double t);

/* The next output time if it is not beyond t, which is then past. The start and the end are output
   times, each once. */
bool schedule_take_output(schedule *s, double t, double *output);

#endif
