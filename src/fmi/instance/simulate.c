/* Co-Simulation: from one communication point to the next. */
#include <math.h>

#include "instance.h"

/* What fmi3DoStep answers beside its status. */
typedef struct answers {
  fmi3Boolean *event, *terminate, *early;
  fmi3Float64 *last;
} answers;

static corot_status check_answers(const answers *a) {
  COROT_TRY(instance_given(a->event, "eventHandlingNeeded"));
  COROT_TRY(instance_given(a->terminate, "terminateSimulation"));
  COROT_TRY(instance_given(a->early, "earlyReturn"));
  return instance_given(a->last, "lastSuccessfulTime");
}

/* The time to go to: that of the end, if it is that but for rounding. */
static corot_status find_target(const instance *in, double current, double step, double *target) {
  if (!(step > 0) || !isfinite(step))
    return corot_fail(COROT_EINVAL, "communicationStepSize is %g s, and not positive", step);
  if (!(fabs(current - in->now.t) <= 1e-9 * step))
    return corot_fail(COROT_EINVAL,
                      "currentCommunicationPoint is %.17g s, and the last step led to %.17g s",
                      current, in->now.t);
  double t = current + step;
  if (fabs(t - in->stop) <= 1e-9 * step) t = in->stop;
  if (t > in->stop)
    return corot_fail(COROT_EINVAL, "t = %.17g s is after stopTime, %.17g s", t, in->stop);
  if (!(t > in->now.t))
    return corot_fail(COROT_EINVAL, "communicationStepSize is %g s, too small to leave %g s", step,
                      in->now.t);
  *target = t;
  return stepping_check(&in->body, t);
}

/* Shows the importer the end of a step of the integrator. */
static bool show(void *data, double *t) {
  instance *in = data;
  fmi3Boolean wanted = false;
  fmi3Float64 when = *t;
  in->seen = false;
  in->mode = INTERMEDIATE;
  in->intermediate_update(in->environment, *t, false, true, true, in->early_return_allowed, &wanted,
                          &when);
  in->mode = STEP;
  if (!wanted || !in->early_return_allowed) return false;
  if (when > *t) *t = when;
  return true;
}

static corot_status advance(instance *in, double current, double step, const answers *a) {
  double target = 0;
  COROT_TRY(check_answers(a));
  COROT_TRY(find_target(in, current, step, &target));
  in->seen = false;
  corot_status status =
      stepping_advance(in->stepping, target, in->intermediate_update ? show : NULL, in, &in->now);
  if (status) in->mode = FAILED;
  *a->event = *a->terminate = false;
  *a->early = status == COROT_OK && in->now.t < target;
  *a->last = in->now.t;
  /* a step that has been given up does not become right by trying it again */
  return status > 0 ? corot_fail(COROT_EINTEGRATE, "%s", corot_error()) : status;
}

fmi3Status fmi3DoStep(fmi3Instance instance_, fmi3Float64 current, fmi3Float64 step,
                      fmi3Boolean no_set_prior, fmi3Boolean *event_handling_needed,
                      fmi3Boolean *terminate, fmi3Boolean *early_return,
                      fmi3Float64 *last_successful) {
  (void)no_set_prior; /* nothing of the past is kept in any case */
  const answers a = {event_handling_needed, terminate, early_return, last_successful};
  FMI3_CALL(instance_, STEP, advance(in, current, step, &a));
}
