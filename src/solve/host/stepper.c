/* A host's integrator, step by step: where to stop, what to do at kinks, and how it fails.

   SUNDIALS before 6.6.1 has a defect: after a stop time has been reached by a call whose tout
   equals it, the next call returns at once without advancing. So tout always lies beyond the stop
   time. */
#include <float.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdlib.h>

#include "core/ode/state.h"
#include "host.h"
#include "solve/pencil/pencil.h"
#include "solve/pencil/seam.h"
#include "solve/sundials/sun_status.h"

corot_status corot_sun_judge(int flag, const char *call) {
  if (flag >= 0) return COROT_OK;
  const char *why = corot_error();
  return corot_fail(COROT_EINTEGRATE, "%s: flag %d%s%s", call, flag,
                    why[0] ? "; corot's last failure: " : "", why);
}

/* --- Opening and closing ---------------------------------------------------------------------- */

static corot_status check(const corot_sun_host *h, double t, N_Vector y) {
  const corot_sun_data *d = &h->data;
  COROT_TRY(corot_seam_data(d, h->api->name));
  COROT_TRY(corot_seam_pencil(h->pencil, d, h->api->name));
  COROT_TRY(corot_seam_vectors(h->api->name, 2 * h->pencil->n, 1, &y));
  if (!isfinite(t)) return corot_fail(COROT_EINVAL, "%s: cannot start at t = %g", h->api->name, t);
  if (corot_model_mass_kind(d->model) == COROT_MASS_CONSISTENT && !d->mass)
    return corot_fail(COROT_EINVAL, "%s: consistent mass needs a corot_mass_solver", h->api->name);
  return COROT_OK;
}

static corot_status take_advice(corot_sun_host *h) {
  corot_sun_data *d = &h->data;
  if (!(d->atol_displacement >= 0 && isfinite(d->atol_displacement)) ||
      !(d->atol_velocity >= 0 && isfinite(d->atol_velocity)))
    return corot_fail(COROT_EINVAL, "%s: an absolute tolerance (%g m, %g m/s) is negative, or none",
                      h->api->name, d->atol_displacement, d->atol_velocity);
  if (d->rtol == 0) d->rtol = 1e-4;
  COROT_TRY(corot_sun_advise(d->model, h->api->method, d->rtol, &h->advice));
  if (d->atol_displacement == 0) d->atol_displacement = h->advice.atol_displacement;
  if (d->atol_velocity == 0)
    d->atol_velocity = d->atol_displacement * corot_model_frequency(d->model);
  return COROT_OK;
}

static corot_status allocate(corot_sun_host *h, N_Vector y) {
  h->jump = N_VClone(y);
  h->old = N_VClone(y);
  h->weight = N_VClone(y);
  h->A = corot_sun_matrix(h->pencil, y->sunctx);
  h->LS = h->api->method == COROT_SUN_IDA ? corot_sun_linsol_dae(h->pencil, y->sunctx)
                                          : corot_sun_linsol(h->pencil, y->sunctx);
  if (h->jump && h->old && h->weight && h->A && h->LS) return COROT_OK;
  return corot_fail(COROT_ENOMEM, "no memory for %s on %d unknowns", h->api->name,
                    2 * h->pencil->n);
}

corot_status corot_sun_host_open(corot_sun_host *h, const corot_sun_api *api, void *memory,
                                 corot_pencil *pencil, const corot_sun_data *data, double t,
                                 N_Vector y) {
  if (!h || !memory || !data)
    return corot_fail(COROT_EINVAL, "%s: there is no %s", api->name,
                      !h       ? "corot_sun_host"
                      : memory ? "corot_sun_data"
                               : "integrator");
  *h = (corot_sun_host){
      .data = *data, .api = api, .memory = memory, .pencil = pencil, .t = t, .fresh = true};
  h->data.pencil = pencil;
  corot_status status = check(h, t, y);
  if (!status) status = take_advice(h);
  if (!status) status = allocate(h, y);
  if (status) {
    corot_sun_host_close(h);
    return status;
  }
  corot_pencil_use(pencil, h->advice.tangent);
  corot_state_enter(h->data.state, t);
  return COROT_OK;
}

void corot_sun_host_close(corot_sun_host *h) {
  if (!h) return;
  if (h->LS) SUNLinSolFree(h->LS);
  if (h->A) SUNMatDestroy(h->A);
  N_Vector const vectors[] = {h->jump, h->old, h->weight};
  for (int k = 0; k < 3; k++)
    if (vectors[k]) N_VDestroy(vectors[k]);
  *h = (corot_sun_host){0};
}

/* --- Changes ---------------------------------------------------------------------------------- */

corot_status corot_sun_host_restart(corot_sun_host *h, double t, N_Vector y, double first) {
  COROT_TRY(corot_seam_vectors(h->api->name, 2 * h->pencil->n, 1, &y));
  if (!isfinite(t) || !(first >= 0 && isfinite(first)))
    return corot_fail(COROT_EINVAL, "%s: cannot begin again at t = %g with a step of %g s",
                      h->api->name, t, first);
  corot_state_enter(h->data.state, t);
  h->t = t;
  h->fresh = true;
  h->assembled = 0;
  COROT_TRY(corot_sun_judge(h->api->restart(h, t, y), h->api->name));
  COROT_TRY(corot_sun_judge(h->api->failures(h->memory, &h->ncfn), h->api->name));
  return corot_sun_judge(h->api->set_first_step(h->memory, first), h->api->name);
}

/* y' at (t, y). */
static corot_status judge_rate(corot_sun_host *h, double t, N_Vector y, N_Vector rate) {
  return corot_sun_judge(-abs(corot_sun_rhs(t, y, rate, &h->data)), "after a change of r");
}

/* Whether a multistep method feels a jump of y' at the time reached. */
static corot_status look(corot_sun_host *h, N_Vector y, bool *felt, double *first) {
  sunrealtype h_last = 0, h_next = 0;
  COROT_TRY(
      corot_sun_judge(-abs(corot_sun_rhs(h->t, y, h->jump, &h->data)), "after a change of r"));
  int bad = h->api->interpolate(h->memory, h->t, 1, h->old) ||
            h->api->error_weights(h->memory, h->weight) || h->api->last_step(h->memory, &h_last) ||
            h->api->next_step(h->memory, &h_next);
  if (bad) return corot_sun_judge(-1, h->api->name);
  N_VLinearSum(1, h->jump, -1, h->old, h->jump);
  return corot_sun_felt(h->pencil, h->jump, h->weight, h->t, h_last, h_next, felt, first);
}

/* *h, the first step after a change, is shortened to a radian of what this excites in modes too
   fast for it, as error control may not see that. */
static corot_status resolve_transient(corot_sun_host *h, N_Vector y, double *step) {
  int n = h->pencil->n;
  double delta = 1e-4 * *step, radian = INFINITY;
  COROT_TRY(judge_rate(h, h->t, y, h->jump));
  COROT_TRY(judge_rate(h, h->t + delta, y, h->old));
  if (h->api->error_weights(h->memory, h->weight)) return corot_sun_judge(-1, h->api->name);
  double *a = N_VGetArrayPointer(h->jump) + n, *change = N_VGetArrayPointer(h->old) + n;
  double *w = N_VGetArrayPointer(h->weight), weight = w[0];
  double *const room[] = {N_VGetArrayPointer(h->old), w, w + n};
  for (int i = 0; i < n; i++) change[i] = (change[i] - a[i]) / delta;
  corot_status status =
      corot_transient(h->pencil, N_VGetArrayPointer(y) + n, a, change, weight, room, &radian);
  if (status == COROT_OK) *step = fmin(*step, radian);
  return sun_is_fatal(status) ? status : COROT_OK;
}

/* A Runge-Kutta method has no history to lose but the rate at the start of its step. */
static corot_status begin_step_anew(corot_sun_host *h, N_Vector y) {
  sunrealtype next = 0;
  if (!h->fresh) {
    if (h->api->next_step(h->memory, &next)) return corot_sun_judge(-1, h->api->name);
    COROT_TRY(resolve_transient(h, y, &next));
  }
  return corot_sun_host_restart(h, h->t, y, next);
}

/* `matrices`: they depend on what has changed. */
static corot_status change(corot_sun_host *h, N_Vector y, bool matrices) {
  bool felt = true;
  double first = 0;
  if (matrices) corot_pencil_invalidate(h->pencil);
  if (h->api->method == COROT_SUN_ARKODE) return begin_step_anew(h, y);
  if (!h->fresh) {
    COROT_TRY(look(h, y, &felt, &first));
    if (!felt) return COROT_OK;
    h->nrestart++;
  }
  return corot_sun_host_restart(h, h->t, y, first);
}

corot_status corot_sun_host_changed(corot_sun_host *h, N_Vector y) {
  COROT_TRY(corot_seam_vectors(h->api->name, 2 * h->pencil->n, 1, &y));
  return change(h, y, true);
}

corot_status corot_sun_host_loaded(corot_sun_host *h, N_Vector y) {
  COROT_TRY(corot_seam_vectors(h->api->name, 2 * h->pencil->n, 1, &y));
  return change(h, y, false);
}

/* --- A step ----------------------------------------------------------------------------------- */

/* Where the body cannot be evaluated beyond some time (an element inverts), SUNDIALS takes ever
   shorter steps towards it without end. */
static corot_status watch(corot_sun_host *h, double taken, bool stopped) {
  long ncfn = 0;
  if (h->api->failures(h->memory, &ncfn)) return corot_sun_judge(-1, h->api->name);
  if (ncfn > h->ncfn) h->refused = h->nst;
  bool refused = h->refused > 0 && h->nst - h->refused <= 3;
  h->ncfn = ncfn;
  h->longest = fmax(h->longest, taken);
  if (taken > 0 && (stopped || !refused || taken >= 1e-9 * h->longest)) return COROT_OK;
  return corot_fail(COROT_EINTEGRATE,
                    "%s: steps have shrunk to %.2g s at t = %.9g; corot's last failure: %s",
                    h->api->name, taken, h->t, corot_error());
}

/* One attempt, which ends at *t; *stopped: at `stop`. */
static corot_status attempt(corot_sun_host *h, double stop, N_Vector y, double *t, bool *stopped) {
  sunrealtype reached = h->t;
  h->stop = stop;
  COROT_TRY(corot_sun_judge(h->api->set_stop_time(h->memory, stop), "stop time"));
  int flag = h->api->advance(h, stop + (stop - h->t), y, &reached);
  *stopped = flag == h->api->stopped;
  *t = *stopped ? stop : reached;
  return corot_sun_judge(flag, h->api->name);
}

static corot_status step(corot_sun_host *h, double t_stop, N_Vector y) {
  /* where to */
  sunrealtype next = 0;
  if (!h->fresh && h->api->next_step(h->memory, &next)) return corot_sun_judge(-1, h->api->name);
  corot_sun_stop stop = corot_sun_next_stop(h->data.model, h->t, next, t_stop);
  if (stop.sets_out && h->api->method != COROT_SUN_ARKODE) {
    h->nrestart++;
    COROT_TRY(corot_sun_host_restart(h, h->t, y, 0));
  }
  /* the step */
  double t;
  bool stopped;
  COROT_TRY(attempt(h, stop.t, y, &t, &stopped));
  double taken = t - h->t;
  h->t = t;
  h->nst++;
  h->fresh = false;
  COROT_TRY(watch(h, taken, stopped));
  /* what is there */
  if (!stopped || !stop.kink) return COROT_OK;
  corot_state_enter(h->data.state, t);
  return change(h, y, false);
}

corot_status corot_sun_host_step(corot_sun_host *h, double t_stop, N_Vector y, double *t) {
  COROT_TRY(corot_seam_vectors(h->api->name, 2 * h->pencil->n, 1, &y));
  if (!(t_stop > h->t) || !isfinite(t_stop))
    return corot_fail(COROT_EINVAL, "%s: cannot stop at t = %.17g, being at %.17g", h->api->name,
                      t_stop, h->t);
  /* two clocks that mean one instant differ by rounding, over which there is no step to take */
  if (t_stop - h->t <= 100 * DBL_EPSILON * fabs(t_stop))
    h->t = t_stop;
  else
    COROT_TRY(step(h, t_stop, y));
  *t = h->t;
  return COROT_OK;
}

corot_status corot_sun_host_advance(corot_sun_host *h, double t_stop, N_Vector y) {
  double t;
  do {
    COROT_TRY(corot_sun_host_step(h, t_stop, y, &t));
  } while (t < t_stop);
  return COROT_OK;
}
