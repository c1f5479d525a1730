/* CVODE's variable-order BDF, through the CVODES library (whose quadratures ask for the
   powers at the end of each step; one program must never link both). */
#include <cvodes/cvodes.h>
#include <stdlib.h>

#include "multistep.h"

static int advance(multistep *m, double beyond, double *t) {
  return CVode(m->memory, beyond, m->driver.y, t, CV_ONE_STEP);
}

static int restart(multistep *m) { return CVodeReInit(m->memory, m->driver.self->t, m->driver.y); }

static const multistep_api api = {.stopped = CV_TSTOP_RETURN,
                                  .advance = advance,
                                  .restart = restart,
                                  .set_stop_time = CVodeSetStopTime,
                                  .set_first_step = CVodeSetInitStep,
                                  .interpolate = CVodeGetDky,
                                  .restart_work = CVodeQuadReInit,
                                  .last_order = CVodeGetLastOrder,
                                  .last_step = CVodeGetLastStep,
                                  .next_step = CVodeGetCurrentStep,
                                  .local_errors = CVodeGetEstLocalErrors,
                                  .error_weights = CVodeGetErrWeights,
                                  .nfe = CVodeGetNumRhsEvals,
                                  .nsetups = CVodeGetNumLinSolvSetups,
                                  .netf = CVodeGetNumErrTestFails,
                                  .nni = CVodeGetNumNonlinSolvIters,
                                  .ncfn = CVodeGetNumNonlinSolvConvFails,
                                  .nfeQ = CVodeGetQuadNumRhsEvals};

static int configure(multistep *c) {
  const corot_integrator_def *d = &c->driver.self->def;
  void *m = c->memory;
  /* a step of 0 leaves it to SUNDIALS */
  return CVodeSetUserData(m, c) || CVodeWFtolerances(m, corot_driver_weights) ||
         CVodeSetMaxNumSteps(m, -1) || CVodeSetMaxErrTestFails(m, DRIVER_MOST_FAILURES) ||
         CVodeSetMaxOrd(m, d->max_order) || CVodeSetStabLimDet(m, d->max_order > 2) ||
         CVodeSetLinearSolver(m, c->driver.LS, c->driver.A) ||
         CVodeSetLinSysFn(m, corot_driver_linsys) ||
         CVodeSetLSetupFrequency(m, d->refactorisation) ||
         CVodeSetJacEvalFrequency(m, d->reassembly) ||
         CVodeSetDeltaGammaMaxLSetup(m, d->gamma_change) ||
         CVodeSetNonlinConvCoef(m, d->convergence) ||
         CVodeQuadInit(m, corot_driver_work_rate, c->work) || CVodeSetInitStep(m, d->first_step) ||
         CVodeSetMinStep(m, d->min_step) || CVodeSetMaxStep(m, d->max_step);
}

static void choose(corot_integrator *self) { corot_integrator_take_advice(self, COROT_SUN_CVODE); }

static void destroy(void *method) {
  multistep *c = method;
  if (c->memory) CVodeFree(&c->memory);
  corot_multistep_close(c);
}

static corot_status create(corot_integrator *self, const double *u, const double *v) {
  multistep *c = self->method = calloc(1, sizeof *c);
  if (!c) return corot_fail(COROT_ENOMEM, "no memory for cvode");
  COROT_TRY(corot_multistep_open(c, self, &api, u, v));
  driver *d = &c->driver;
  c->memory = CVodeCreate(CV_BDF, d->ctx);
  if (!c->memory) return corot_fail(COROT_ENOMEM, "no memory for cvode");
  if (SUN_CATCH_ERRORS(CVodeSetErrHandlerFn, c->memory, d->ctx, corot_driver_on_error, d->message))
    return corot_driver_refuse(d, "set-up");
  if (CVodeInit(c->memory, corot_driver_rhs, self->t, d->y)) {
    c->memory = NULL; /* lost: without memory CVodeInit frees what CVodeFree would free again */
    return corot_driver_refuse(d, "set-up");
  }
  if (configure(c)) return corot_driver_refuse(d, "set-up");
  return COROT_OK;
}

const integrator_ops corot_integrator_cvode = {
    .kind = {.name = "cvode",
             .controls_error = true,
             .multistep = true,
             .order_min = 1,
             .order_max = 5},
    .choose = choose,
    .create = create,
    .destroy = destroy,
    .step = corot_multistep_step,
    .at = corot_multistep_at,
    .work = corot_multistep_work,
    .changed = corot_multistep_changed,
    .loaded = corot_multistep_loaded,
    .statistics = corot_multistep_statistics,
    .exchange = corot_multistep_exchange,
};
