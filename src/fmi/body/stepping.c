/* Advances an integrator, its frame clock and the phases of the model together. */
#include "stepping.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "app/run/integration.h"
#include "app/text/no_memory.h"

struct stepping {
  stepping_def def;
  corot_integrator_def method;
  corot_integrator *integrator;
  corot_frame_clock *clock;
  double t;                         /* reached by the integrator [s] */
  double dissipated, external_work; /* before the integrator began [J] */
  bool due;                         /* what is to be done at t has not been done yet */
  bool told;                        /* inputs were set since */
  bool shown;                       /* the hook has seen the end of the last step */
  double kink;                      /* the next one; INFINITY: there is none */
};

static bool is_constant(const body *b) { return b->used.integrator.step > 0; }

static bool runs_free(const stepping *s) {
  const scenario *of = &s->def.body->used;
  return !s->def.inputs && of->frames.frames == COROT_FRAMES_EXACT && !is_constant(s->def.body);
}

/* --- Beginning and end --- */

static void find_kink(stepping *s, double t) {
  s->kink = INFINITY;
  corot_model_kinks(s->def.body->model, t, INFINITY, 1, &s->kink);
}

static corot_status begin(stepping *s, const moment *at) {
  const body *b = s->def.body;
  COROT_TRY(corot_integrator_create(&s->method, b->model, s->def.state, at->t, at->u, at->v,
                                    &s->integrator));
  return corot_frame_clock_create(&b->used.frames, b->model, s->def.state, s->integrator, at->t,
                                  at->u, at->v, &s->clock);
}

corot_status stepping_create(const stepping_def *def, const moment *start, stepping **out) {
  stepping *s = calloc(1, sizeof *s);
  if (!s) return no_memory();
  s->def = *def;
  s->t = start->t;
  s->shown = true;
  s->method = def->body->used.integrator;
  s->method.linear.refinement = def->body->refinement;
  if (def->rtol > 0 && !is_constant(def->body)) s->method.rtol = def->rtol;
  find_kink(s, start->t);
  corot_status status = begin(s, start);
  if (status)
    stepping_destroy(s);
  else
    *out = s;
  return status;
}

void stepping_destroy(stepping *s) {
  if (!s) return;
  corot_frame_clock_destroy(s->clock);
  corot_integrator_destroy(s->integrator);
  free(s);
}

/* --- Between two steps --- */

/* The values that hold from now on. Of a load they are set once more where they have not changed,
   which costs nothing; a material would be assembled anew. */
static corot_status set_inputs(stepping *s, bool *changed) {
  const scenario *of = &s->def.body->used;
  for (int i = 0; i < of->ninput; i++) {
    const input_def *in = &of->input[i];
    if (in->of != INPUT_LOAD) continue;
    COROT_TRY(corot_inputs_set_load(s->def.inputs, in->index, s->def.body->value[i]));
    *changed = true;
  }
  return COROT_OK;
}

void stepping_tell(stepping *s) { s->told = true; }

/* Kinks, inputs, frames, in the order of a run. `pause`: a communication point, where inputs may
   have been set. */
static corot_status handle(stepping *s, bool pause, moment *now) {
  bool kinked = false, changed = s->told;
  bool inputs = pause && s->def.inputs;
  for (; s->due && s->kink <= s->t + 4 * DBL_EPSILON * s->t; find_kink(s, s->kink)) {
    corot_state_enter(s->def.state, fmax(s->kink, s->t));
    kinked = true;
  }
  if (s->due && inputs) {
    if (!kinked) corot_state_enter(s->def.state, s->t);
    COROT_TRY(set_inputs(s, &changed));
  }
  if (changed)
    COROT_TRY(corot_integrator_changed(s->integrator, COROT_HISTORY_AUTO));
  else if (kinked)
    COROT_TRY(corot_integrator_kink(s->integrator));
  s->told = false;
  if (!s->due) return COROT_OK;
  corot_frame_event event;
  s->due = false;
  COROT_TRY(corot_frame_clock_tick(s->clock, s->t, &event));
  if (event.reason) now->frame_energy += event.change.energy;
  return COROT_OK;
}

/* Where the next step has to end at the latest, for a communication point at t. */
static double stop_before(const stepping *s, double t) {
  double end = t;
  if (runs_free(s)) {
    double known = isfinite(s->def.stop) ? s->def.stop : s->def.body->used.t_end;
    end = fmax(known, t);
  }
  double other = fmin(s->kink, corot_frame_clock_stop(s->clock));
  return other < end - 1e-12 * end ? other : end;
}

/* A constant step may cross a kink: in that one each motion follows its law at every time. */
static void prepare(stepping *s) {
  double h = s->method.step;
  if (is_constant(s->def.body) && s->kink < s->t + h - 1e-12 * (s->t + h))
    corot_state_enter(s->def.state, NAN);
}

static corot_status step(stepping *s, double t, bool pause, moment *now) {
  corot_step taken;
  COROT_TRY(handle(s, pause, now));
  prepare(s);
  COROT_TRY(corot_integrator_step(s->integrator, stop_before(s, t), &taken));
  s->t = taken.t;
  s->due = true;
  s->shown = false;
  return COROT_OK;
}

/* --- A communication step --- */

/* The moment t, which is within the last step but for rounding. */
static corot_status read(stepping *s, double t, moment *now) {
  double within = fmin(t, s->t);
  COROT_TRY(corot_integrator_at(s->integrator, within, now->u, now->v));
  COROT_TRY(corot_integrator_work(s->integrator, within, &now->dissipated, &now->external_work));
  now->dissipated += s->dissipated;
  now->external_work += s->external_work;
  now->t = t;
  return COROT_OK;
}

/* Whole steps of length h, of which times hold but for rounding. */
static double steps_to(double t, double h) { return t / h; }

static bool is_whole(double n) { return fabs(n - round(n)) <= 1e-9 * fmax(1, fabs(n)); }

corot_status stepping_check(const body *b, double t) {
  double h = b->used.integrator.step;
  if (!is_constant(b) || is_whole(steps_to(t, h))) return COROT_OK;
  return corot_fail(COROT_EINVAL,
                    "the communication point t = %.17g s is not at the end of a step: the steps of "
                    "%s are of %.17g s, and constant",
                    t, b->used.integrator.method, h);
}

/* Where the hook ends the advance: at `wanted`, or the end of the constant step in which that is.
 */
static double end_early(const stepping *s, double wanted, double t) {
  double h = s->method.step;
  if (is_constant(s->def.body)) wanted = h * ceil(steps_to(wanted, h) - 1e-9);
  return fmin(t, fmax(wanted, s->t));
}

/* Shows the end of the last step, if it has not been shown and is not beyond *t, which becomes the
   earlier end that the hook wants. */
static corot_status show(stepping *s, double near, stepping_hook *hook, void *data, moment *now,
                         double *t) {
  double wanted = s->t;
  if (!hook || s->shown || s->t > *t + near) return COROT_OK;
  COROT_TRY(read(s, s->t, now));
  s->shown = true;
  if (hook(data, &wanted)) *t = end_early(s, wanted, *t);
  return COROT_OK;
}

/* From step to step, until one has reached *t. */
static corot_status advance(stepping *s, double near, stepping_hook *hook, void *data, moment *now,
                            double *t) {
  bool pause = true;
  COROT_TRY(show(s, near, hook, data, now, t));
  while (s->t < *t - near) {
    COROT_TRY(step(s, *t, pause, now));
    COROT_TRY(show(s, near, hook, data, now, t));
    pause = false;
  }
  return COROT_OK;
}

corot_status stepping_advance(stepping *s, double t, stepping_hook *hook, void *data, moment *now) {
  COROT_TRY(stepping_check(s->def.body, t));
  double near = is_constant(s->def.body) ? 1e-9 * s->method.step : 1e-12 * t;
  corot_status status = advance(s, near, hook, data, now, &t);
  if (status == COROT_OK) return read(s, t, now);
  char reason[512];
  snprintf(reason, sizeof reason, "%s", corot_error());
  read(s, s->t, now); /* which was sound */
  return corot_fail(status, "%s", reason);
}

/* --- The whole as bytes --- */

/* The last step is given up beyond the moment: a new integrator begins there. */
static corot_status go_back(stepping *s, const moment *now) {
  stepping fresh = *s;
  fresh.integrator = NULL, fresh.clock = NULL;
  corot_status status = begin(&fresh, now);
  if (status) {
    corot_integrator_destroy(fresh.integrator);
    return status;
  }
  corot_frame_clock_destroy(s->clock);
  corot_integrator_destroy(s->integrator);
  *s = fresh;
  s->t = now->t;
  s->due = false;
  s->shown = true;
  s->dissipated = now->dissipated;
  s->external_work = now->external_work;
  find_kink(s, now->t);
  return COROT_OK;
}

/* What was set for the next step is told now: the state knows of it. */
static corot_status tell(stepping *s) {
  if (s->told) COROT_TRY(corot_integrator_changed(s->integrator, COROT_HISTORY_AUTO));
  s->told = false;
  return COROT_OK;
}

corot_status stepping_exchange(stepping *s, pack *p, moment *now) {
  if (!p->reading && runs_free(s) && s->t > now->t) COROT_TRY(go_back(s, now));
  stepping as = *s;
  corot_pack_double(p, &as.t);
  corot_pack_double(p, &as.dissipated);
  corot_pack_double(p, &as.external_work);
  corot_pack_double(p, &as.kink);
  corot_pack_bool(p, &as.due);
  corot_pack_bool(p, &as.shown);
  if (!p->reading) COROT_TRY(tell(s));
  COROT_TRY(integration_exchange(p, s->integrator));
  if (!p->reading) return COROT_OK;
  s->t = as.t, s->dissipated = as.dissipated, s->external_work = as.external_work;
  s->kink = as.kink, s->due = as.due, s->shown = as.shown;
  s->told = false;
  return COROT_OK;
}
