/* Where another integrator than that of the scenario is the better one. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "solve/statics/rigid.h"
#include "warnings.h"
#include "warnings_parts.h"

/* BDF of order two errs in the size and in the phase of each vibration, in every step, and where
   nothing damps all of it adds up. Measured by the studies of models/studies/default, cvode
   against arkode with exact frames, the error of the displacement at the worst time (and half the
   range of the angular momentum's components):

                           rtol 1e-3           1e-4               1e-5
     thrown, undamped      1.8e-3 : 8.2e-4     4.4e-4 : 7.3e-5    9.5e-5 : 2.7e-6
       angular momentum    2.7e-3 : 2.5e-3     1.1e-3 : 9.2e-5    3.2e-5 : 5.1e-6
       steps               1329 : 214          4177 : 471         9988 : 1331
     cantilever, undamped  2.8e-2 : 4.6e-3     5.8e-3 : 2.8e-4    5.0e-4 : 6.7e-6
       steps               470 : 162           1922 : 419         7927 : 1836
     let go, undamped      4.4e-1 : 2.0e-1     6.8e-2 : 3.0e-2    2.4e-2 : 2.5e-4
       steps               997 : 163           4411 : 405         10103 : 1073
     thrown, damped        6.6e-3 : 3.1e-3     2.6e-3 : 2.9e-4    7.0e-4 : 7.2e-5
       angular momentum    9.4e-3 : 7.3e-3     6.3e-3 : 5.5e-4    1.6e-3 : 1.4e-4

   and ida like cvode, in half to twice the CPU time of cvode where there is no damping (for the
   same error, in half of it or less) and 2 to 3.5 times where there is. Held and well damped,
   arkode is nearer at the same tolerance, too, but dearer, and not better for its time. At 1e-6
   cvode is still off by up to 0.5 % in displacement and 4.5 % in velocity, and at 1e-7 by less than
   1 % in both, and in energy, which is taken for the end of what matters. Frames that are held have
   an error of their own, which hides that of the method, and were not measured. */
#define SMALL_TOLERANCE 1e-7

static bool is_zero(const double x[3]) { return x[0] == 0 && x[1] == 0 && x[2] == 0; }

bool warnings_undamped(const scenario *s) {
  for (int i = 0; i < s->model.nmaterial; i++) {
    const corot_material *m = &s->model.material[i];
    if (m->damping_lambda > 0 || m->damping_mu > 0 || m->damping_mass > 0) return false;
  }
  return true;
}

static corot_status all_parts_free(const corot_model *model, bool *out) {
  int npart;
  corot_part *part;
  COROT_TRY(corot_model_parts(model, &npart, &part));
  *out = true;
  for (int k = 0; k < npart; k++) *out &= part[k].nfree == 6;
  free(part);
  return COROT_OK;
}

/* In free flight with one velocity, and under gravity, a free body neither turns nor vibrates. In
   an equilibrium of loads that stay as they are a body stays, too. */
static bool will_move(const scenario *s, bool is_free) {
  for (int i = 0; i < s->nstart; i++) {
    const start_def *d = &s->start[i];
    if (d->rate != 0) return true;
    if (!is_zero(d->velocity) && (d->group || !is_free)) return true;
  }
  for (int i = 0; i < s->model.nload; i++) {
    const corot_load *l = &s->model.load[i];
    bool stays = l->amplitude.curve == COROT_CURVE_LINEAR && l->amplitude.n < 2;
    if (is_zero(l->value) || (is_free && l->kind == COROT_GRAVITY)) continue;
    if (!(stays && s->start_at_equilibrium)) return true;
  }
  return s->model.nmotion > 0;
}

corot_status warnings_find_integrator(const scenario *s, const corot_model *model, warnings *w) {
  const corot_integrator_def *d = &s->integrator;
  /* BDF at tolerances at which its error shows, of a body whose energy nothing else changes */
  if (!corot_method_traits(d->method)->multistep || !(d->rtol > SMALL_TOLERANCE) ||
      s->frames.frames != COROT_FRAMES_EXACT)
    return COROT_OK;

  bool is_free, undamped = warnings_undamped(s);
  COROT_TRY(all_parts_free(model, &is_free));
  if (!(is_free || undamped) || !will_move(s, is_free)) return COROT_OK;

  /* which of the two it is */
  if (!undamped)
    return warnings_add(w, WARNING_INTEGRATOR,
                        "nothing holds the body, and what %s makes of its angular momentum adds up "
                        "(some 1e-2 of it in a few turns at rtol 1e-4); take integrator.method: "
                        "arkode, which keeps it up to ten times better at the same rtol, in about "
                        "as many steps and two to three times the CPU time",
                        d->method);
  return warnings_add(
      w, WARNING_INTEGRATOR,
      "nothing damps the body, so that the errors of %s in size and phase of its vibrations add "
      "up%s; "
      "take integrator.method: arkode, whose error is 2 to 20 times smaller at rtol 1e-4 and 30 to "
      "100 times at 1e-5, in a tenth to a quarter of the steps and half to twice the CPU time",
      d->method, is_free ? ", and nothing holds it, so that its angular momentum drifts" : "");
}
