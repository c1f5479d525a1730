/* Settings of SUNDIALS' integrators that suit an elastic body. */
#include <math.h>

#include "core/base/sized.h"
#include "host.h"

/* Order 2 unless higher orders are stable or cheap. BDF 3, 4, 5 of step h are stable for all modes
   of M u'' + beta K u' + K u = 0 if beta/h >= 0.145, 0.367, 0.738 (numerical scan of their
   stability regions); below, lightly damped modes hold the step down or grow. The largest step to
   expect is taken as the time a shear wave needs across the body at a tolerance of 1e-3, falling
   with the cube root of the tolerance as that of order 2 does. At 1e-7 and below error control
   alone keeps the steps short enough, given any damping: on the paper's bar order 5 then takes
   twice the steps of order 2 and has a 300th of its error. */
static int choose_max_order(const corot_model *model, double rtol, double max_step) {
  double beta = corot_model_damping_time(model);
  if (rtol <= 1e-7 && beta > 0) return 5;
  double h = cbrt(rtol / 1e-3) / corot_model_frequency(model);
  if (max_step > 0) h = fmin(h, max_step);
  return beta >= 0.738 * h ? 5 : beta >= 0.367 * h ? 4 : beta >= 0.145 * h ? 3 : 2;
}

/* A matrix a hundred steps old costs few more iterations than one twenty steps old (SUNDIALS' own
   choice), and saves a quarter of a run on the paper's bar. Without damping the iteration's error
   may put energy into the body, unless it ends at a small fraction of the tolerance: at a tenth of
   it (SUNDIALS' own choice) an elastic bar gains 11 % in 20 s, at 0.003 nothing. Supports that turn
   take the body away from an old matrix, and what the iteration leaves shakes it: of the paper's
   turning bar, at rtol 1e-4, the ledger is off by 3.1 % with a matrix of a hundred steps and 0.03,
   by 0.1 % with one of thirty and 0.01, for a tenth more time; its cube takes half the steps. */
static void advise_bdf(const corot_model *model, double rtol, double max_step, bool moves,
                       corot_sun_advice *a) {
  bool damped = corot_model_damping_time(model) > 0;
  a->max_order = choose_max_order(model, rtol, max_step);
  a->tangent = COROT_TANGENT_HELD;
  a->reassembly = a->refactorisation = moves ? 30 : 100;
  a->gamma_change = 0.3;
  a->convergence = !damped ? 0.003 : moves ? 0.01 : 0.03;
}

/* There is no rule by the number of steps: the linear solver is set up when c = dy'/dy changes. */
static void advise_ida(corot_sun_advice *a) {
  a->refactorisation = 0;
  a->gamma_change = 0.25;
  a->convergence = 0.33;
}

/* On the paper's bar, at a tolerance of 1e-4, against SUNDIALS' own choices: a tenth of the
   set-ups and less than half of the time. A long step changes K much, but a solve costs far less
   than a factor: hence the exact tangent, a fresh K with every S, and many iterations with one S.
   What Newton's iteration leaves is noise in the error estimate: at a tenth of the tolerance it
   doubles the steps of some methods. From a tolerance of 1e-5 on, order 5 has the least error for
   its time. */
static void advise_arkode(double rtol, corot_sun_advice *a) {
  a->max_order = rtol <= 1e-5 ? 5 : 4;
  a->table = a->max_order == 5 ? "ARKODE_ESDIRK547L2SA2_7_4_5" : "ARKODE_ARK437L2SA_DIRK_7_3_4";
  a->tangent = COROT_TANGENT_EXACT;
  a->reassembly = 1;
  a->refactorisation = 20;
  a->gamma_change = 0.5;
  a->convergence = 0.02;
  a->newton_iterations = 10;
  a->predictor = 4;
}

corot_sun_advice corot_advise(const corot_model *model, corot_sun_method method, double rtol,
                              double max_step, bool moves) {
  corot_sun_advice a = {.error_failures = 40};
  a.atol_displacement = 0.01 * rtol * corot_model_length(model);
  a.atol_velocity = a.atol_displacement * corot_model_frequency(model);
  if (method == COROT_SUN_ARKODE)
    advise_arkode(rtol, &a);
  else
    advise_bdf(model, rtol, max_step, moves, &a);
  if (method == COROT_SUN_IDA) advise_ida(&a);
  return a;
}

corot_status corot_sun_advise(const corot_model *model, corot_sun_method method, double rtol,
                              corot_sun_advice *advice) {
  COROT_TRY(COROT_GIVEN(model));
  COROT_TRY(COROT_GIVEN(advice));
  if (method < COROT_SUN_CVODE || method > COROT_SUN_ARKODE)
    return corot_fail(COROT_EINVAL, "corot_sun_advise: method %d is none", (int)method);
  if (!(rtol > 0) || !isfinite(rtol))
    return corot_fail(COROT_EINVAL, "corot_sun_advise: rtol = %g is not positive and finite", rtol);
  *advice = corot_advise(model, method, rtol, 0, corot_model_moves(model));
  return COROT_OK;
}
