/* Diagonally implicit Runge-Kutta methods, through ARKODE's ARKStep. */
#include <stdlib.h>

#include "runge_kutta.h"
#include "solve/sundials/sun_ark.h"

/* The first of each order is what the order stands for: on bars that vibrate, the one with the
   least error for its CPU time. */
const rk_table corot_rk_implicit[] = {
    {"ARKODE_TRBDF2_3_3_2", 2},
    {"ARKODE_SDIRK_2_1_2", 2},
    {"ARKODE_BILLINGTON_3_3_2", 2},
    {"ARKODE_ESDIRK325L2SA_5_2_3", 3},
    {"ARKODE_ESDIRK324L2SA_4_2_3", 3},
    {"ARKODE_ESDIRK32I5L2SA_5_2_3", 3},
    {"ARKODE_ARK324L2SA_DIRK_4_2_3", 3},
    {"ARKODE_KVAERNO_4_2_3", 3},
    {"ARKODE_ARK437L2SA_DIRK_7_3_4", 4},
    {"ARKODE_ARK436L2SA_DIRK_6_3_4", 4},
    {"ARKODE_ESDIRK436L2SA_6_3_4", 4},
    {"ARKODE_ESDIRK43I6L2SA_6_3_4", 4},
    {"ARKODE_ESDIRK437L2SA_7_3_4", 4},
    {"ARKODE_QESDIRK436L2SA_6_3_4", 4},
    {"ARKODE_SDIRK_5_3_4", 4},
    {"ARKODE_CASH_5_2_4", 4},
    {"ARKODE_CASH_5_3_4", 4},
    {"ARKODE_KVAERNO_5_3_4", 4},
    {"ARKODE_ESDIRK547L2SA2_7_4_5", 5},
    {"ARKODE_ESDIRK547L2SA_7_4_5", 5},
    {"ARKODE_ARK548L2SAb_DIRK_8_4_5", 5},
    {"ARKODE_ARK548L2SA_DIRK_8_4_5", 5},
    {"ARKODE_KVAERNO_7_4_5", 5},
    {NULL, 0},
};

static const rk_api api = {.advance = SUN_ARK(Evolve),
                           .reset = SUN_ARK(Reset),
                           .release = SUN_ARK(Free),
                           .set_stop_time = SUN_ARK(SetStopTime),
                           .set_first_step = SUN_ARK(SetInitStep),
                           .interpolate = SUN_ARK(GetDky),
                           .next_step = SUN_ARK(GetCurrentStep),
                           .local_errors = SUN_ARK(GetEstLocalErrors),
                           .error_weights = SUN_ARK(GetErrWeights),
                           .observe_stages = SUN_ARK(SetPostprocessStageFn),
                           .nfe = sun_ark_nfe,
                           .netf = SUN_ARK(GetNumErrTestFails),
                           .nsetups = SUN_ARK(GetNumLinSolvSetups),
                           .nni = SUN_ARK(GetNumNonlinSolvIters),
                           .ncfn = SUN_ARK(GetNumNonlinSolvConvFails)};

static void choose(corot_integrator *self) {
  corot_integrator_def *d = &self->def;
  corot_sun_advice a = corot_advise(self->model, COROT_SUN_ARKODE, d->rtol, d->max_step, false);
  if (d->order == 0)
    d->order = d->table ? corot_rk_order(d->table, corot_rk_implicit) : a.max_order;
  if (d->predictor < 0) d->predictor = a.predictor;
  int max_order = d->max_order; /* means nothing here */
  corot_integrator_take_advice(self, COROT_SUN_ARKODE);
  d->max_order = max_order;
}

static corot_status set_table(runge_kutta *m, const char *name) {
  ARKodeButcherTable B = ARKodeButcherTable_LoadDIRKByName(name);
  if (!B) return corot_fail(COROT_ENOMEM, "no memory for %s", name);
  corot_status status = ARKStepSetTables(m->memory, B->q, B->p, B, NULL)
                            ? corot_driver_refuse(&m->driver, "table")
                            : corot_rk_keep_stages(m, B);
  ARKodeButcherTable_Free(B);
  return status;
}

static int configure(runge_kutta *m) {
  const corot_integrator_def *d = &m->driver.self->def;
  void *a = m->memory;
  /* a step of 0 leaves it to SUNDIALS */
  return SUN_ARK(SetUserData)(a, m) || SUN_ARK(WFtolerances)(a, corot_driver_weights) ||
         SUN_ARK(SetMaxNumSteps)(a, -1) || SUN_ARK(SetMaxErrTestFails)(a, DRIVER_MOST_FAILURES) ||
         SUN_ARK(SetLinearSolver)(a, m->driver.LS, m->driver.A) ||
         SUN_ARK(SetLinSysFn)(a, corot_driver_linsys_ark) ||
         SUN_ARK(SetLSetupFrequency)(a, d->refactorisation) ||
         SUN_ARK(SetJacEvalFrequency)(a, d->reassembly) ||
         SUN_ARK(SetDeltaGammaMax)(a, d->gamma_change) ||
         SUN_ARK(SetNonlinConvCoef)(a, d->convergence) || SUN_ARK(SetMaxNonlinIters)(a, 10) ||
         SUN_ARK(SetPredictorMethod)(a, d->predictor) || SUN_ARK(SetInterpolantDegree)(a, 3) ||
         SUN_ARK(SetDeduceImplicitRhs)(a, SUNTRUE) ||
         sun_ark_control(a, m->driver.ctx, &m->controller) || SUN_ARK(SetSafetyFactor)(a, 0.9) ||
         SUN_ARK(SetInitStep)(a, d->first_step) || SUN_ARK(SetMinStep)(a, d->min_step) ||
         SUN_ARK(SetMaxStep)(a, d->max_step);
}

static corot_status create(corot_integrator *self, const double *u, const double *v) {
  const rk_table *table = corot_rk_find(&self->def, corot_rk_implicit);
  if (!table)
    return corot_rk_refuse(self, corot_rk_implicit, corot_rk_explicit, "explicit, of erk");
  if (self->def.predictor > 4)
    return corot_fail(COROT_EINVAL, "arkode: predictor = %d is not in 0 to 4 (-1: choose)",
                      self->def.predictor);
  runge_kutta *m = self->method = calloc(1, sizeof *m);
  if (!m) return corot_fail(COROT_ENOMEM, "no memory for arkode");
  COROT_TRY(corot_rk_open(m, self, &api, table->order, u, v));
  driver *d = &m->driver;
  m->memory = ARKStepCreate(NULL, corot_driver_rhs, self->t, d->y, d->ctx);
  if (!m->memory) return corot_fail(COROT_ENOMEM, "no memory for arkode");
  if (SUN_CATCH_ERRORS(ARKStepSetErrHandlerFn, m->memory, d->ctx, corot_driver_on_error,
                       d->message) ||
      configure(m))
    return corot_driver_refuse(d, "set-up");
  COROT_TRY(set_table(m, table->name));
  self->table = table->name;
  self->def.order = table->order;
  return COROT_OK;
}

const integrator_ops corot_integrator_arkode = {
    .kind =
        {.name = "arkode", .controls_error = true, .stages = true, .order_min = 2, .order_max = 5},
    .choose = choose,
    .create = create,
    .destroy = corot_rk_close,
    .step = corot_rk_step,
    .at = corot_rk_at,
    .work = corot_rk_work,
    .changed = corot_rk_changed,
    .loaded = corot_rk_loaded,
    .statistics = corot_rk_statistics,
    .settle = corot_rk_settle,
    .exchange = corot_rk_exchange,
};
