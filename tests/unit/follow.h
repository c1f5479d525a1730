/* A run under a frame clock, and what its updates were. */
#ifndef FOLLOW_H
#define FOLLOW_H

#include <corot/integrate.h>

#include "check.h"

typedef struct frame_log {
  long steps;
  long updates[COROT_FRAMES_BY_HOOK + 1]; /* by reason; [COROT_FRAMES_KEPT]: steps without */
  long restarts;
  double angle_max; /* largest change of a frame in any update [rad] */
  double last;      /* time of the last update */
} frame_log;

static inline long updates_in(const frame_log *log) {
  return log->steps - log->updates[COROT_FRAMES_KEPT];
}

/* Steps on from t until t_end is reached; a method of constant step may pass it. */
static inline frame_log follow(corot_integrator *integrator, corot_frame_clock *clock, double t,
                               double t_end) {
  frame_log log = {.last = NAN};
  corot_step step = {.t = t};
  while (step.t < t_end) {
    double stop = fmin(t_end, corot_frame_clock_stop(clock));
    corot_frame_event event;
    assert_ok(corot_integrator_step(integrator, stop, &step));
    assert_ok(corot_frame_clock_tick(clock, step.t, &event));
    log.steps++;
    log.updates[event.reason]++;
    log.restarts += event.restarted;
    log.angle_max = fmax(log.angle_max, event.change.angle_max);
    if (event.reason) log.last = step.t;
  }
  return log;
}

#endif
