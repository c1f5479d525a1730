/* Model Exchange: states, their derivatives, and the times of events. */
#include <math.h>
#include <string.h>

#include "instance.h"

static size_t ndof(const instance *in) { return (size_t)corot_model_ndof(in->body.model); }

/* An array of all states has 2 ndof numbers: u, then v. */
static corot_status check_states(const instance *in, const double *x, size_t n) {
  if (!in->exchange)
    return corot_fail(COROT_EINVAL, "is of Model Exchange, and this instance of Co-Simulation");
  if (n > 0) COROT_TRY(instance_given(x, "the array"));
  if (n == 2 * ndof(in)) return COROT_OK;
  return corot_fail(COROT_EINVAL, "there are %zu continuous states, and the array has %zu numbers",
                    2 * ndof(in), n);
}

/* --- Time and states --- */

static corot_status set_time(instance *in, double t) {
  if (!(t >= 0) || !isfinite(t))
    return corot_fail(COROT_EINVAL, "time is %g s: the model begins at t = 0", t);
  in->now.t = t;
  in->seen = false;
  return COROT_OK;
}

fmi3Status fmi3SetTime(fmi3Instance instance_, fmi3Float64 time) {
  FMI3_CALL(instance_, CONTINUOUS, set_time(in, time));
}

static corot_status set_states(instance *in, const double *x, size_t n) {
  COROT_TRY(check_states(in, x, n));
  for (size_t i = 0; i < n; i++)
    if (!isfinite(x[i]))
      return corot_fail(COROT_EINVAL, "state %zu is %g, and not a finite number", i, x[i]);
  memcpy(in->now.u, x, ndof(in) * sizeof *x);
  memcpy(in->now.v, x + ndof(in), ndof(in) * sizeof *x);
  in->seen = false;
  return COROT_OK;
}

fmi3Status fmi3SetContinuousStates(fmi3Instance instance_, const fmi3Float64 state[], size_t n) {
  FMI3_CALL(instance_, CONTINUOUS, set_states(in, state, n));
}

static corot_status get_states(instance *in, double *x, size_t n) {
  COROT_TRY(check_states(in, x, n));
  COROT_TRY(instance_settle(in));
  memcpy(x, in->now.u, ndof(in) * sizeof *x);
  memcpy(x + ndof(in), in->now.v, ndof(in) * sizeof *x);
  return COROT_OK;
}

fmi3Status fmi3GetContinuousStates(fmi3Instance instance_, fmi3Float64 state[], size_t n) {
  FMI3_CALL(instance_, INITIALIZATION | EVENT | CONTINUOUS | TERMINATED, get_states(in, state, n));
}

static corot_status get_slopes(instance *in, double *x, size_t n) {
  COROT_TRY(check_states(in, x, n));
  COROT_TRY(instance_slopes(in));
  COROT_TRY(slopes_find(&in->slopes, &in->now, x + ndof(in)));
  memcpy(x, in->now.v, ndof(in) * sizeof *x);
  return COROT_OK;
}

fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance instance_, fmi3Float64 derivative[],
                                             size_t n) {
  FMI3_CALL(instance_, INITIALIZATION | EVENT | CONTINUOUS | TERMINATED,
            get_slopes(in, derivative, n));
}

/* The length of the model, and that times its frequency: of their hundredth part, times rtol, our
   own integrators make their absolute tolerances. */
static corot_status get_nominals(instance *in, double *x, size_t n) {
  COROT_TRY(check_states(in, x, n));
  double length = corot_model_length(in->body.model);
  double speed = length * corot_model_frequency(in->body.model);
  for (size_t i = 0; i < n; i++) x[i] = i < ndof(in) ? length : speed;
  return COROT_OK;
}

fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance instance_, fmi3Float64 nominal[],
                                             size_t n) {
  FMI3_CALL(instance_, INITIALIZATION | EVENT | CONTINUOUS | TERMINATED,
            get_nominals(in, nominal, n));
}

static corot_status count(const instance *in, bool states, size_t *n) {
  COROT_TRY(instance_given(n, "the number"));
  COROT_TRY(check_states(in, (const double *)"", 2 * ndof(in)));
  *n = states ? 2 * ndof(in) : 0;
  return COROT_OK;
}

fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance instance_, size_t *n) {
  FMI3_CALL(instance_, ALIVE, count(in, true, n));
}

fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance instance_, size_t *n) {
  FMI3_CALL(instance_, ALIVE, count(in, false, n));
}

static corot_status get_indicators(size_t n) {
  if (n == 0) return COROT_OK;
  return corot_fail(COROT_EINVAL, "there are no event indicators, and the array has %zu numbers",
                    n);
}

fmi3Status fmi3GetEventIndicators(fmi3Instance instance_, fmi3Float64 indicator[], size_t n) {
  (void)indicator;
  FMI3_CALL(instance_, INITIALIZATION | EVENT | CONTINUOUS | TERMINATED, get_indicators(n));
}

/* --- Events --- */

fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance instance_) {
  FMI3_CALL(instance_, INITIALIZATION | EVENT, COROT_OK); /* there are none */
}

/* At a kink of an amplitude, the law of the time after it begins. */
static corot_status update(instance *in, fmi3Boolean *flag[4], fmi3Boolean *defined,
                           fmi3Float64 *next) {
  for (int i = 0; i < 4; i++) COROT_TRY(instance_given(flag[i], "an answer's place"));
  COROT_TRY(instance_given(defined, "nextEventTimeDefined"));
  COROT_TRY(instance_given(next, "nextEventTime"));
  instance_enter(in);
  in->seen = false;
  for (int i = 0; i < 4; i++) *flag[i] = false;
  *defined = isfinite(in->next_kink);
  if (*defined) *next = in->next_kink;
  return COROT_OK;
}

fmi3Status fmi3UpdateDiscreteStates(fmi3Instance instance_, fmi3Boolean *need_update,
                                    fmi3Boolean *terminate, fmi3Boolean *nominals_changed,
                                    fmi3Boolean *states_changed, fmi3Boolean *next_event_defined,
                                    fmi3Float64 *next_event) {
  fmi3Boolean *flag[4] = {need_update, terminate, nominals_changed, states_changed};
  FMI3_CALL(instance_, EVENT, update(in, flag, next_event_defined, next_event));
}

/* Nothing happens at the end of a step that the model did not know before. */
static corot_status complete(fmi3Boolean *enter_event_mode, fmi3Boolean *terminate) {
  COROT_TRY(instance_given(enter_event_mode, "enterEventMode"));
  COROT_TRY(instance_given(terminate, "terminateSimulation"));
  *enter_event_mode = *terminate = false;
  return COROT_OK;
}

fmi3Status fmi3CompletedIntegratorStep(fmi3Instance instance_, fmi3Boolean no_set_prior,
                                       fmi3Boolean *enter_event_mode, fmi3Boolean *terminate) {
  (void)no_set_prior;
  FMI3_CALL(instance_, CONTINUOUS, complete(enter_event_mode, terminate));
}
