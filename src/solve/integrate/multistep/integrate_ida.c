/* IDA's variable-order BDF with fixed leading coefficient, through the IDAS library (whose
   quadratures ask for the powers at the end of each step). The residual needs no M^-1, except that
   the start and a restart ask for an acceleration that is consistent: M v' = r.

   IDA asks for a Jacobian at every set-up of the linear solver; here K and D are kept, and only
   combined anew, until `reassembly` steps are past or Newton's iteration has failed since. */
#include <idas/idas.h>
#include <stdlib.h>

#include "multistep.h"

typedef struct ida {
  multistep base; /* first */
  long assembled; /* steps taken when K and D were assembled; -1: they were not */
  long ncfn;      /* convergence failures by then */
} ida;

static int jacobian(sunrealtype t, sunrealtype cj, N_Vector y, N_Vector yp, N_Vector F, SUNMatrix A,
                    void *user_data, N_Vector tmp1, N_Vector tmp2, N_Vector tmp3) {
  (void)yp, (void)F, (void)A, (void)tmp1, (void)tmp2, (void)tmp3;
  ida *m = user_data;
  driver *d = user_data;
  corot_integrator *self = d->self;
  long ncfn = 0;
  if (IDAGetNumNonlinSolvConvFails(m->base.memory, &ncfn))
    return corot_driver_answer(d, corot_driver_refuse(d, "statistics"));
  bool current =
      m->assembled >= 0 && ncfn == m->ncfn && self->nst - m->assembled < self->def.reassembly;
  sunbooleantype anew;
  corot_status status = corot_pencil_linsys(self->pencil, t, y, current, &anew, 1 / cj);
  if (!status && anew) m->assembled = self->nst, m->ncfn = ncfn;
  return corot_driver_answer(d, status);
}

static int work_rate(sunrealtype t, N_Vector y, N_Vector yp, N_Vector rate, void *user_data) {
  (void)yp;
  return corot_driver_work_rate(t, y, rate, user_data);
}

static int advance(multistep *m, double beyond, double *t) {
  return IDASolve(m->memory, beyond, t, m->driver.y, m->rate, IDA_ONE_STEP);
}

/* y' that satisfies the residual at the present y. */
static int find_rate(multistep *m) {
  m->before.nfe++;
  return corot_driver_rhs(m->driver.self->t, m->driver.y, m->rate, &m->driver);
}

static int restart(multistep *m) {
  ((ida *)m)->assembled = -1;
  ((ida *)m)->ncfn = 0;
  if (find_rate(m)) return -1;
  return IDAReInit(m->memory, m->driver.self->t, m->driver.y, m->rate);
}

static const multistep_api api = {.stopped = IDA_TSTOP_RETURN,
                                  .advance = advance,
                                  .restart = restart,
                                  .set_stop_time = IDASetStopTime,
                                  .set_first_step = IDASetInitStep,
                                  .interpolate = IDAGetDky,
                                  .restart_work = IDAQuadReInit,
                                  .last_order = IDAGetLastOrder,
                                  .last_step = IDAGetLastStep,
                                  .next_step = IDAGetCurrentStep,
                                  .local_errors = IDAGetEstLocalErrors,
                                  .error_weights = IDAGetErrWeights,
                                  .nfe = IDAGetNumResEvals,
                                  .nsetups = IDAGetNumLinSolvSetups,
                                  .netf = IDAGetNumErrTestFails,
                                  .nni = IDAGetNumNonlinSolvIters,
                                  .ncfn = IDAGetNumNonlinSolvConvFails,
                                  .nfeQ = IDAGetQuadNumRhsEvals};

static int configure(multistep *c) {
  const corot_integrator_def *d = &c->driver.self->def;
  void *m = c->memory;
  /* a step of 0 leaves it to SUNDIALS */
  return IDASetUserData(m, c) || IDAWFtolerances(m, corot_driver_weights) ||
         IDASetMaxNumSteps(m, -1) || IDASetMaxErrTestFails(m, DRIVER_MOST_FAILURES) ||
         IDASetMaxOrd(m, d->max_order) || IDASetLinearSolver(m, c->driver.LS, c->driver.A) ||
         IDASetJacFn(m, jacobian) || IDASetDeltaCjLSetup(m, d->gamma_change) ||
         IDASetNonlinConvCoef(m, d->convergence) || IDAQuadInit(m, work_rate, c->work) ||
         IDASetInitStep(m, d->first_step) || IDASetMinStep(m, d->min_step) ||
         IDASetMaxStep(m, d->max_step);
}

static void choose(corot_integrator *self) {
  corot_integrator_take_advice(self, COROT_SUN_IDA);
  self->def.refactorisation = 0; /* there is no such rule */
}

static void destroy(void *method) {
  multistep *c = method;
  if (c->memory) IDAFree(&c->memory);
  corot_multistep_close(c);
}

static corot_status create(corot_integrator *self, const double *u, const double *v) {
  ida *m = self->method = calloc(1, sizeof *m);
  if (!m) return corot_fail(COROT_ENOMEM, "no memory for ida");
  m->assembled = -1;
  multistep *c = &m->base;
  COROT_TRY(corot_multistep_open(c, self, &api, u, v));
  if (!(self->def.gamma_change < 1))
    return corot_fail(COROT_EINVAL, "ida: gamma_change = %g is not below 1",
                      self->def.gamma_change);
  driver *d = &c->driver;
  c->rate = N_VClone(d->y);
  c->memory = IDACreate(d->ctx);
  if (!c->rate || !c->memory) return corot_fail(COROT_ENOMEM, "no memory for ida");
  d->LS->ops->solve = corot_driver_solve_dae;
  if (find_rate(c)) return corot_driver_give_up(d, "no acceleration at the start");
  if (SUN_CATCH_ERRORS(IDASetErrHandlerFn, c->memory, d->ctx, corot_driver_on_error, d->message) ||
      IDAInit(c->memory, corot_driver_residual, self->t, d->y, c->rate) || configure(c))
    return corot_driver_refuse(d, "set-up");
  return COROT_OK;
}

const integrator_ops corot_integrator_ida = {
    .kind = {.name = "ida",
             .controls_error = true,
             .multistep = true,
             .order_min = 1,
             .order_max = 5,
             .gamma_change_below = 1},
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
