/* A scan side by side, then bisection of logarithms between the stable and the unstable. */
#include "limit.h"

#include <math.h>
#include <stdlib.h>

static corot_status check(const limit_def *d) {
  if (!(d->from > 0 && d->to > d->from && isfinite(d->to)))
    return corot_fail(COROT_EINVAL, "from %g to %g: expected 0 < from < to", d->from, d->to);
  if (d->nscan < 2 || d->nscan > LIMIT_SCAN_MOST)
    return corot_fail(COROT_EINVAL, "a scan of %d values: expected 2 to %d", d->nscan,
                      LIMIT_SCAN_MOST);
  if (!(d->precision >= 1e-6))
    return corot_fail(COROT_EINVAL, "precision %g: expected 1e-6 or more", d->precision);
  return COROT_OK;
}

/* The first unstable value and the one below it. */
static void bracket(limit_result *r) {
  r->stable = 0;
  r->unstable = INFINITY;
  for (int i = 0; i < r->ntrial; i++)
    if (!r->trial[i].stable) r->unstable = fmin(r->unstable, r->trial[i].value);
  for (int i = 0; i < r->ntrial; i++)
    if (r->trial[i].value < r->unstable) r->stable = fmax(r->stable, r->trial[i].value);
}

static int by_value(const void *a, const void *b) {
  double x = ((const limit_trial *)a)->value, y = ((const limit_trial *)b)->value;
  return (x > y) - (x < y);
}

corot_status limit_find(const limit_def *def, limit_try *try, void *context, limit_result *out) {
  COROT_TRY(check(def));
  limit_result r = {.ntrial = def->nscan};
  /* scan from end to end, in equal ratios */
  for (int i = 0; i < def->nscan; i++) {
    double part = (double)i / (def->nscan - 1);
    r.trial[i].value = i == 0               ? def->from
                       : i < def->nscan - 1 ? def->from * pow(def->to / def->from, part)
                                            : def->to;
  }
  COROT_TRY(try(context, def->nscan, r.trial));
  bracket(&r);
  /* bisect between the last stable and the first unstable value */
  while (r.stable > 0 && isfinite(r.unstable) && r.unstable / r.stable - 1 > def->precision &&
         r.ntrial < LIMIT_TRIAL_MOST) {
    limit_trial *trial = &r.trial[r.ntrial++];
    *trial = (limit_trial){.value = sqrt(r.stable * r.unstable)};
    COROT_TRY(try(context, 1, trial));
    bracket(&r);
  }
  /* stable values beyond an unstable one are counted: there the limit is not the only one */
  qsort(r.trial, (size_t)r.ntrial, sizeof *r.trial, by_value);
  for (int i = 0; i < r.ntrial; i++)
    r.nreturn += r.trial[i].stable && r.trial[i].value > r.unstable;
  *out = r;
  return COROT_OK;
}
