/* Where an integrator must stop, and whether it feels what changes between two steps. */
#include <float.h>
#include <math.h>
#include <nvector/nvector_serial.h>

#include "host.h"
#include "solve/pencil/pencil.h"
#include "solve/pencil/seam.h"
#include "solve/sundials/sun_status.h"

/* Two clocks that mean one instant differ by so much. */
static double rounding(double t, double h) { return 100 * DBL_EPSILON * (fabs(t) + h); }

/* A clock that is late by rounding has passed a horizon that is no further away. A stop that the
   step does not need is not set: SUNDIALS would shorten a later step to it, when there is another.
 */
double corot_sight(const corot_model *model, double t, double h_last, double h, double t_stop) {
  double horizon = corot_model_horizon(model, t + rounding(t, h_last));
  return h > 0 && t + h <= horizon ? t_stop : fmin(t_stop, horizon);
}

bool corot_sets_out(double t, double h, double sight, double t_stop) {
  return sight < t_stop && h > 100 * (sight - t);
}

corot_sun_stop corot_sun_next_stop(const corot_model *model, double t, double h, double t_stop) {
  corot_sun_stop stop = {.t = t_stop};
  if (!model || !(t < t_stop)) return stop;
  double late = rounding(t, h), kink;
  if (corot_model_kinks(model, t + late, t_stop + late, 1, &kink) > 0) {
    stop.kink = true;
    stop.t = kink;
  }
  double sight = corot_sight(model, t, h, h, stop.t);
  stop.sets_out = corot_sets_out(t, h, sight, stop.t);
  stop.kink = stop.kink && sight == stop.t;
  stop.t = sight;
  return stop;
}

/* The jump without the modes too fast for a step, in which M^-1 r tells nothing: what Newton's
   iteration left in u is a jump there that a step never sees. In its place stands what u jumps
   by. */
static corot_status slow_jump(corot_pencil *pencil, N_Vector jump, N_Vector weight, double *size) {
  double *du = N_VGetArrayPointer(jump), *dv = du + pencil->n;
  COROT_TRY(corot_pencil_slow_part(pencil, dv, dv));
  for (int i = 0; i < pencil->n; i++) du[i] = pencil->gamma * dv[i];
  *size = N_VWrmsNorm(jump, weight);
  return COROT_OK;
}

corot_status corot_sun_felt(corot_pencil *pencil, N_Vector jump, N_Vector weight, double t,
                            double h_last, double h_next, bool *felt, double *h_first) {
  COROT_TRY(corot_seam_pencil(pencil, NULL, "corot_sun_felt"));
  COROT_TRY(corot_seam_vectors("corot_sun_felt", 2 * pencil->n, 2, (N_Vector[]){jump, weight}));
  double all = N_VWrmsNorm(jump, weight), slow = 0;
  bool is_felt = h_next * all >= 0.5;
  if (is_felt) {
    corot_status status = slow_jump(pencil, jump, weight, &slow);
    if (sun_is_fatal(status)) return status;
    if (status == COROT_OK) is_felt = h_next * slow >= 0.5;
  }
  *felt = is_felt;
  *h_first = fmax(fmin(h_last, 0.5 / all), 100 * DBL_EPSILON * fabs(t));
  return COROT_OK;
}
