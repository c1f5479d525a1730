/* CVODE's variable-order BDF, through the CVODES library (which has the work integrals as
   quadratures; one program must never link both).

   SUNDIALS before 6.6.1 has a defect: after a stop time has been reached by a CV_NORMAL call whose
   tout equals it, the next call returns at once without advancing. advance() steps in CV_ONE_STEP
   mode, and its tout always lies beyond the stop time. */
#include <cvodes/cvodes.h>
#include <float.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdlib.h>
#include <string.h>

#include "solve/driver.h"

typedef struct cvode {
  driver driver; /* first: the callbacks' data */
  void *memory;
  N_Vector error, weight, scratch; /* [2n] */
  N_Vector work;                   /* [2] dissipated and external work at self->t */
  double t_stop;                   /* armed; NaN: none */
  corot_statistics before;         /* counts of earlier starts */
  long nni;                        /* at the end of the last step */
} cvode;

static int configure(cvode *c) {
  const corot_integrator_def *d = &c->driver.self->def;
  void *m = c->memory;
  int bad = CVodeSetUserData(m, c) || CVodeWFtolerances(m, corot_driver_weights) ||
            CVodeSetMaxNumSteps(m, -1) || CVodeSetMaxOrd(m, d->max_order) ||
            CVodeSetStabLimDet(m, d->max_order > 2) ||
            CVodeSetLinearSolver(m, c->driver.LS, c->driver.A) ||
            CVodeSetLinSysFn(m, corot_sun_linsys) ||
            CVodeSetLSetupFrequency(m, d->refactorisation) ||
            CVodeSetJacEvalFrequency(m, d->reassembly) ||
            CVodeSetDeltaGammaMaxLSetup(m, d->gamma_change) ||
            CVodeSetNonlinConvCoef(m, d->convergence) ||
            CVodeQuadInit(m, corot_driver_work_rate, c->work);
  if (d->first_step > 0) bad = bad || CVodeSetInitStep(m, d->first_step);
  if (d->min_step > 0) bad = bad || CVodeSetMinStep(m, d->min_step);
  if (d->max_step > 0) bad = bad || CVodeSetMaxStep(m, d->max_step);
  return bad;
}

static void cvode_destroy(void *method) {
  cvode *c = method;
  if (c->memory) CVodeFree(&c->memory);
  N_Vector const vectors[] = {c->error, c->weight, c->scratch, c->work};
  for (int k = 0; k < 4; k++)
    if (vectors[k]) N_VDestroy(vectors[k]);
  corot_driver_close(&c->driver);
  free(c);
}

static corot_status cvode_create(corot_integrator *self, const double *u, const double *v) {
  cvode *c = self->method = calloc(1, sizeof *c);
  if (!c) return corot_fail(COROT_ENOMEM, "no memory for cvode");
  c->t_stop = NAN;
  driver *d = &c->driver;
  COROT_TRY(corot_driver_open(d, self, u, v));
  c->work = N_VNew_Serial(2, d->ctx);
  c->error = N_VClone(d->y);
  c->weight = N_VClone(d->y);
  c->scratch = N_VClone(d->y);
  c->memory = CVodeCreate(CV_BDF, d->ctx);
  if (!c->work || !c->error || !c->weight || !c->scratch || !c->memory)
    return corot_fail(COROT_ENOMEM, "no memory for cvode on %d unknowns",
                      2 * corot_model_ndof(self->model));
  N_VConst(0, c->work);
  if (SUN_CATCH_ERRORS(CVodeSetErrHandlerFn, c->memory, d->ctx, corot_driver_on_error, d) ||
      CVodeInit(c->memory, corot_driver_rhs, self->t, d->y) || configure(c))
    return corot_driver_refuse(d, "set-up");
  return COROT_OK;
}

static corot_status advance(cvode *c, double t_stop, double *t) {
  driver *d = &c->driver;
  if (t_stop != c->t_stop && CVodeSetStopTime(c->memory, t_stop))
    return corot_driver_refuse(d, "stop time");
  c->t_stop = t_stop;
  double beyond = t_stop + (t_stop - d->self->t);
  d->message[0] = 0;
  int flag = CVode(c->memory, beyond, d->y, t, CV_ONE_STEP);
  if (flag == CV_LSETUP_FAIL || flag == CV_LSOLVE_FAIL)
    corot_driver_refuse_trial(d, flag, corot_error());
  if (flag < 0) return corot_driver_give_up(d, d->message);
  if (flag == CV_TSTOP_RETURN) {
    *t = t_stop;
    c->t_stop = NAN; /* reaching it disarms it */
  }
  corot_driver_watch(d, *t - d->self->t, *t == t_stop);
  return COROT_OK;
}

static corot_status cvode_step(corot_integrator *self, double t_stop, corot_step *step) {
  cvode *c = self->method;
  double t, t_work;
  long nni = 0;
  COROT_TRY(corot_driver_check(&c->driver));
  COROT_TRY(advance(c, t_stop, &t));
  if (CVodeGetQuad(c->memory, &t_work, c->work) || CVodeGetNumNonlinSolvIters(c->memory, &nni) ||
      CVodeGetLastOrder(c->memory, &step->order) || CVodeGetEstLocalErrors(c->memory, c->error) ||
      CVodeGetErrWeights(c->memory, c->weight))
    return corot_driver_refuse(&c->driver, "statistics");
  step->t = t;
  step->error = N_VWrmsNorm(c->error, c->weight);
  step->newton = (int)(nni - c->nni);
  c->nni = nni;
  return COROT_OK;
}

static corot_status cvode_at(corot_integrator *self, double t, double *u, double *v) {
  cvode *c = self->method;
  int n = corot_model_ndof(self->model);
  N_Vector y = c->driver.y;
  if (t != self->t) {
    y = c->error;
    if (CVodeGetDky(c->memory, t, 0, y)) return corot_driver_refuse(&c->driver, "interpolant");
  }
  if (u) memcpy(u, N_VGetArrayPointer(y), n * sizeof *u);
  if (v) memcpy(v, N_VGetArrayPointer(y) + n, n * sizeof *v);
  return COROT_OK;
}

static corot_status cvode_work(corot_integrator *self, double t, double *dissipated,
                               double *external) {
  cvode *c = self->method;
  const double *work = N_VGetArrayPointer(c->work);
  double at_end[2] = {work[0], work[1]};
  if (t != self->t) { /* c->work lends its room */
    bool bad = CVodeGetQuadDky(c->memory, t, 0, c->work);
    double inside[2] = {work[0], work[1]};
    memcpy(N_VGetArrayPointer(c->work), at_end, sizeof at_end);
    if (bad) return corot_driver_refuse(&c->driver, "interpolant");
    memcpy(at_end, inside, sizeof inside);
  }
  *dissipated = at_end[0];
  *external = at_end[1];
  return COROT_OK;
}

/* Counts since the last start are added to `s`. */
static void add_counts(const cvode *c, corot_statistics *s) {
  long nst = 0, nfe = 0, nsetups = 0, netf = 0, nni = 0, ncfn = 0, nfeQ = 0;
  CVodeGetNumSteps(c->memory, &nst);
  CVodeGetNumRhsEvals(c->memory, &nfe);
  CVodeGetNumLinSolvSetups(c->memory, &nsetups);
  CVodeGetNumErrTestFails(c->memory, &netf);
  CVodeGetNumNonlinSolvIters(c->memory, &nni);
  CVodeGetNumNonlinSolvConvFails(c->memory, &ncfn);
  CVodeGetQuadNumRhsEvals(c->memory, &nfeQ);
  s->nfe += nfe, s->nsetups += nsetups, s->netf += netf, s->nni += nni, s->ncfn += ncfn;
  s->nfeQ += nfeQ;
}

/* How fast the solution leaves its history, in units of the tolerance per second: the jump of the
   derivative from the interpolant's to the new right-hand side's, weighted. */
static corot_status derivative_jump(cvode *c, double *jump) {
  N_Vector now = c->error, old = c->scratch;
  c->before.nfe++;
  driver *d = &c->driver;
  if (corot_driver_rhs(d->self->t, d->y, now, d))
    return corot_driver_give_up(d, "after a change of the frames");
  if (CVodeGetDky(c->memory, d->self->t, 1, old) || CVodeGetErrWeights(c->memory, c->weight))
    return corot_driver_refuse(&c->driver, "interpolant");
  N_VLinearSum(1, now, -1, old, now);
  *jump = N_VWrmsNorm(now, c->weight);
  return COROT_OK;
}

/* A jump that the next step turns into less than half the tolerance is left to error control;
   otherwise the method begins again, with a first step that makes it half the tolerance. */
static corot_status cvode_changed(corot_integrator *self, corot_history history) {
  cvode *c = self->method;
  double h = self->def.first_step;
  bool fresh = self->before == self->t; /* no history yet */
  if (fresh || history == COROT_HISTORY_KEEP) return COROT_OK;
  if (history == COROT_HISTORY_AUTO) {
    double jump = 0, h_last = 0, h_next = 0;
    COROT_TRY(derivative_jump(c, &jump));
    CVodeGetLastStep(c->memory, &h_last);
    CVodeGetCurrentStep(c->memory, &h_next);
    if (h_next * jump < 0.5) return COROT_OK;
    h = fmax(fmin(h_last, 0.5 / jump), 100 * DBL_EPSILON * fabs(self->t));
  }
  add_counts(c, &c->before);
  c->before.nrestart++;
  c->nni = 0;
  c->t_stop = NAN;
  c->driver.collapsed = false;
  self->before = self->t;
  if (CVodeReInit(c->memory, self->t, c->driver.y) || CVodeQuadReInit(c->memory, c->work) ||
      CVodeSetInitStep(c->memory, h))
    return corot_driver_refuse(&c->driver, "restart");
  return COROT_OK;
}

static void cvode_statistics(const corot_integrator *self, corot_statistics *s) {
  const cvode *c = self->method;
  const corot_statistics *b = &c->before;
  s->nfe = b->nfe, s->nsetups = b->nsetups, s->netf = b->netf, s->nni = b->nni, s->ncfn = b->ncfn;
  s->nfeQ = b->nfeQ, s->nrestart = b->nrestart;
  add_counts(c, s);
}

const integrator_ops corot_integrator_cvode = {"cvode",         corot_integrator_choose_bdf,
                                               cvode_create,    cvode_destroy,
                                               cvode_step,      cvode_at,
                                               cvode_work,      cvode_changed,
                                               cvode_statistics};
