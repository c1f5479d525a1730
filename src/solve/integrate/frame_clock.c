/* When held and extrapolated frames follow the body. */
#include <corot/integrate.h>
#include <math.h>
#include <stdlib.h>

#include "core/base/sized.h"
#include "integrator.h"

struct corot_frame_clock {
  corot_frame_policy policy;
  const corot_model *model;
  corot_state *state;
  corot_integrator *integrator;
  double *u, *v; /* [n] scratch */
  long ticks;    /* multiples of the interval passed */
  double cap;    /* when extrapolated frames will have turned as far as they may [s] */
};

void corot_frame_policy_set_defaults(corot_frame_policy *def, size_t bytes) {
  const corot_frame_policy ours = {.frames = COROT_FRAMES_EXACT, .history = COROT_HISTORY_AUTO};
  corot_sized_fill(def, bytes, &ours, sizeof ours);
}

static corot_status check(const corot_frame_policy *p) {
  if (!(p->interval >= 0) || !isfinite(p->interval))
    return corot_fail(COROT_EINVAL, "frames: interval = %g is not positive", p->interval);
  if (!(p->max_angle >= 0) || !isfinite(p->max_angle))
    return corot_fail(COROT_EINVAL, "frames: max_angle = %g is not positive", p->max_angle);
  bool some = p->every_step || p->interval > 0 || p->max_angle > 0 || p->hook;
  if (p->frames != COROT_FRAMES_EXACT && !some)
    return corot_fail(COROT_EINVAL,
                      "frames: neither an interval, an angle, a hook nor every step updates them");
  return COROT_OK;
}

/* Multiples of the interval up to t, counting one that t misses by rounding. */
static long ticks_until(double t, double interval) {
  double x = t / interval;
  return (long)floor(x + 1e-12 * fmax(1, fabs(x)));
}

/* Spin of newly found frames, and how long it may be trusted. */
static corot_status spin_up(corot_frame_clock *c, double t) {
  double spin;
  c->cap = INFINITY;
  if (c->policy.frames != COROT_FRAMES_EXTRAPOLATED) return COROT_OK;
  COROT_TRY(corot_frames_spin(c->model, c->state, t, c->u, c->v, &spin));
  if (spin > 0) c->cap = t + COROT_EXTRAPOLATION_CAP / spin;
  return COROT_OK;
}

static corot_status start(corot_frame_clock *c, double t, const double *u, const double *v) {
  size_t n = corot_model_ndof(c->model);
  c->u = malloc(n * sizeof *c->u);
  c->v = malloc(n * sizeof *c->v);
  if (!c->u || !c->v) return corot_fail(COROT_ENOMEM, "no memory for a frame clock");
  if (c->policy.frames != COROT_FRAMES_EXACT) {
    for (size_t i = 0; i < n; i++) c->u[i] = u[i], c->v[i] = v[i];
    if (c->policy.interval > 0) c->ticks = ticks_until(t, c->policy.interval);
    COROT_TRY(corot_frames_update(c->model, c->state, t, u, NULL));
    COROT_TRY(spin_up(c, t));
  }
  corot_state_use(c->state, c->policy.frames);
  return COROT_OK;
}

corot_status corot_frame_clock_create(const corot_frame_policy *policy, const corot_model *model,
                                      corot_state *state, corot_integrator *integrator, double t,
                                      const double *u, const double *v, corot_frame_clock **clock) {
  COROT_TRY(COROT_DEFINED(policy, corot_frame_policy));
  COROT_TRY(COROT_GIVEN(model));
  COROT_TRY(COROT_GIVEN(state));
  COROT_TRY(COROT_GIVEN(integrator));
  COROT_TRY(COROT_GIVEN(u));
  COROT_TRY(COROT_GIVEN(v));
  COROT_TRY(COROT_GIVEN(clock));
  COROT_TRY(check(policy));
  corot_frame_clock *c = calloc(1, sizeof *c);
  if (!c) return corot_fail(COROT_ENOMEM, "no memory for a frame clock");
  *c = (corot_frame_clock){
      .policy = *policy, .model = model, .state = state, .integrator = integrator, .cap = INFINITY};
  corot_status status = start(c, t, u, v);
  if (status) {
    corot_frame_clock_destroy(c);
    return status;
  }
  integrator->clock = c;
  if (integrator->nst == 0) integrator->seen.frames = corot_state_stamp(state).frames;
  *clock = c;
  return COROT_OK;
}

void corot_frame_clock_destroy(corot_frame_clock *c) {
  if (!c) return;
  if (c->integrator && c->integrator->clock == c) c->integrator->clock = NULL;
  free(c->u);
  free(c->v);
  free(c);
}

void corot_frame_clock_orphan(corot_frame_clock *c) { c->integrator = NULL; }

/* What the count of intervals is of. */
static uint64_t sum_of(const corot_frame_policy *policy) {
  const double number[] = {policy->frames,    policy->every_step, policy->interval,
                           policy->max_angle, policy->history,    policy->hook != NULL};
  return corot_checksum(COROT_CHECKSUM, number, sizeof number);
}

void corot_frame_clock_exchange(pack *p, corot_frame_clock *c) {
  corot_pack_same(p, sum_of(&c->policy), "the checksum of the frames' policy");
  corot_pack_long(p, &c->ticks);
  corot_pack_double(p, &c->cap);
}

double corot_frame_clock_stop(const corot_frame_clock *c) {
  if (c->policy.frames == COROT_FRAMES_EXACT) return INFINITY;
  double next = c->policy.interval > 0 ? (c->ticks + 1) * c->policy.interval : INFINITY;
  return fmin(next, c->cap);
}

/* Why the frames are due at t; the drift is found only where something asks for it. */
static corot_status reason_at(corot_frame_clock *c, double t, corot_frame_reason *reason) {
  const corot_frame_policy *p = &c->policy;
  corot_frames_change drift;
  *reason = COROT_FRAMES_KEPT;
  if (p->every_step)
    *reason = COROT_FRAMES_BY_STEP;
  else if (p->interval > 0 && ticks_until(t, p->interval) > c->ticks)
    *reason = COROT_FRAMES_BY_INTERVAL;
  else if (t >= c->cap)
    *reason = COROT_FRAMES_BY_CAP;
  if (*reason || !(p->max_angle > 0 || p->hook)) return COROT_OK;

  COROT_TRY(corot_frames_drift(c->model, c->state, t, c->u, &drift));
  if (p->max_angle > 0 && drift.angle_max > p->max_angle)
    *reason = COROT_FRAMES_BY_ANGLE;
  else if (p->hook && p->hook(p->hook_data, t, c->u, c->v, &drift))
    *reason = COROT_FRAMES_BY_HOOK;
  return COROT_OK;
}

corot_status corot_frame_clock_tick(corot_frame_clock *c, double t, corot_frame_event *event) {
  corot_frame_event e = {0};
  COROT_TRY(COROT_GIVEN_AS(c, "clock"));
  if (c->policy.frames != COROT_FRAMES_EXACT) {
    COROT_TRY(corot_integrator_at(c->integrator, t, c->u, c->v));
    COROT_TRY(reason_at(c, t, &e.reason));
  }
  if (e.reason) {
    COROT_TRY(corot_frames_update(c->model, c->state, t, c->u, &e.change));
    COROT_TRY(spin_up(c, t));
    if (c->policy.interval > 0) c->ticks = ticks_until(t, c->policy.interval);
    long before = corot_integrator_statistics(c->integrator).nrestart;
    COROT_TRY(corot_integrator_changed(c->integrator, c->policy.history));
    e.restarted = corot_integrator_statistics(c->integrator).nrestart > before;
  }
  *event = e;
  return COROT_OK;
}
