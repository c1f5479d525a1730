/* CVODE's variable-order BDF, through the CVODES library (which has the work integrals as
   quadratures; one program must never link both).

   SUNDIALS before 6.6.1 has a defect: after a stop time has been reached by a CV_NORMAL call whose
   tout equals it, the next call returns at once without advancing. advance() steps in CV_ONE_STEP
   mode, and its tout always lies beyond the stop time.

   Where the model cannot be evaluated beyond some time (an element inverts), CVODE takes ever
   shorter steps towards it without end: collapsed() ends that. */
#include <cvodes/cvodes.h>
#include <float.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "solve/clock.h"
#include "solve/integrator.h"
#include "solve/sun_compat.h"

typedef struct cvode {
  corot_integrator *self; /* for the callbacks */
  SUNContext ctx;
  void *memory;
  N_Vector y;                      /* [2n] solution at self->t */
  N_Vector error, weight, scratch; /* [2n] */
  N_Vector work;                   /* [2] dissipated and external work at self->t */
  SUNMatrix A;
  SUNLinearSolver LS;
  double t_stop;           /* armed; NaN: none */
  corot_statistics before; /* counts of earlier starts */
  long nni;                /* at the end of the last step */
  double longest;          /* step so far [s] */
  bool collapsed;          /* the last step shows that there is no way on */
  char refusal[128];       /* why the model could not be evaluated in the last such trial */
  long refused;            /* steps taken by then */
  char message[512];       /* SUNDIALS' own words on its last failure */
} cvode;

static int refuse_trial(cvode *c, int status, const char *why) {
  snprintf(c->refusal, sizeof c->refusal, "%s", why);
  c->refused = c->self->nst;
  return status;
}

static int rhs(sunrealtype t, N_Vector y, N_Vector ydot, void *user_data) {
  cvode *c = user_data;
  corot_integrator *self = c->self;
  double start = clock_wall();
  int status =
      corot_rhs(self->model, self->state, t, N_VGetArrayPointer(y), N_VGetArrayPointer(ydot));
  self->force_s += clock_wall() - start;
  return status ? refuse_trial(c, status, corot_error()) : 0;
}

static int work_rate(sunrealtype t, N_Vector y, N_Vector rate, void *user_data) {
  corot_integrator *self = ((cvode *)user_data)->self;
  double start = clock_wall();
  const double *u = N_VGetArrayPointer(y);
  corot_energies e;
  int status = corot_energy(self->model, self->state, t, u, u + corot_model_ndof(self->model), &e);
  if (!status) {
    N_VGetArrayPointer(rate)[0] = e.power_dissipated;
    N_VGetArrayPointer(rate)[1] = e.power_external;
  }
  self->work_s += clock_wall() - start;
  return status;
}

/* Largest length of a node's vector in x [n], infinity if one is not a number: unlike componentwise
   sizes it does not change when the whole problem is rotated, so neither do the steps. */
static double largest_vector(const corot_model *model, const double *x) {
  int nnode = corot_model_mesh(model)->nnode;
  const int(*dof)[3] = corot_model_dof(model);
  double largest = 0;
  for (int n = 0; n < nnode; n++) {
    double square = 0;
    for (int c = 0; c < 3; c++)
      if (dof[n][c] >= 0) square += x[dof[n][c]] * x[dof[n][c]];
    if (!(square < INFINITY)) return INFINITY;
    largest = fmax(largest, square);
  }
  return sqrt(largest);
}

/* One weight for all displacements and one for all velocities. */
static int error_weights(N_Vector y, N_Vector weight, void *user_data) {
  cvode *c = user_data;
  corot_integrator *self = c->self;
  const corot_integrator_def *d = &self->def;
  int n = corot_model_ndof(self->model);
  const double *u = N_VGetArrayPointer(y);
  double *w = N_VGetArrayPointer(weight);
  double wu = 1 / (d->rtol * largest_vector(self->model, u) + d->atol_displacement);
  double wv = 1 / (d->rtol * largest_vector(self->model, u + n) + d->atol_velocity);
  if (!(wu > 0 && wv > 0)) return refuse_trial(c, -1, "the motion exceeds double precision");
  for (int i = 0; i < n; i++) w[i] = wu, w[n + i] = wv;
  return 0;
}

static void keep_message(cvode *c, const char *text) {
  snprintf(c->message, sizeof c->message, "%s", text);
  for (char *p = c->message; *p; p++)
    if (*p == '\n') *p = ' ';
}

#if SUNDIALS_VERSION_MAJOR >= 7
static void on_error(int line, const char *function, const char *file, const char *text,
                     SUNErrCode code, void *data, SUNContext ctx) {
  (void)line, (void)function, (void)file, (void)code, (void)ctx;
  keep_message(data, text);
}
static int catch_messages(cvode *c) { return SUNContext_PushErrHandler(c->ctx, on_error, c); }
#else
static void on_error(int code, const char *module, const char *function, char *text, void *data) {
  (void)code, (void)module, (void)function;
  keep_message(data, text);
}
static int catch_messages(cvode *c) { return CVodeSetErrHandlerFn(c->memory, on_error, c); }
#endif

static corot_status refuse(const cvode *c, const char *what) {
  return corot_fail(COROT_EINTEGRATE, "cvode: %s: %s", what,
                    c->message[0] ? c->message : "out of memory");
}

static int configure(cvode *c) {
  const corot_integrator_def *d = &c->self->def;
  void *m = c->memory;
  int bad = CVodeSetUserData(m, c) || CVodeWFtolerances(m, error_weights) ||
            CVodeSetMaxNumSteps(m, -1) || CVodeSetMaxOrd(m, d->max_order) ||
            CVodeSetStabLimDet(m, d->max_order > 2) || CVodeSetLinearSolver(m, c->LS, c->A) ||
            CVodeSetLinSysFn(m, corot_sun_linsys) ||
            CVodeSetLSetupFrequency(m, d->refactorisation) ||
            CVodeSetJacEvalFrequency(m, d->reassembly) ||
            CVodeSetDeltaGammaMaxLSetup(m, d->gamma_change) || CVodeQuadInit(m, work_rate, c->work);
  if (d->first_step > 0) bad = bad || CVodeSetInitStep(m, d->first_step);
  if (d->min_step > 0) bad = bad || CVodeSetMinStep(m, d->min_step);
  if (d->max_step > 0) bad = bad || CVodeSetMaxStep(m, d->max_step);
  return bad;
}

static void cvode_destroy(void *method) {
  cvode *c = method;
  if (c->memory) CVodeFree(&c->memory);
  if (c->LS) SUNLinSolFree(c->LS);
  if (c->A) SUNMatDestroy(c->A);
  N_Vector const vectors[] = {c->y, c->error, c->weight, c->scratch, c->work};
  for (int k = 0; k < 5; k++)
    if (vectors[k]) N_VDestroy(vectors[k]);
  if (c->ctx) SUNContext_Free(&c->ctx);
  free(c);
}

static corot_status cvode_create(corot_integrator *self, const double *u, const double *v) {
  int n = corot_model_ndof(self->model);
  cvode *c = self->method = calloc(1, sizeof *c);
  if (!c) return corot_fail(COROT_ENOMEM, "no memory for cvode");
  c->self = self;
  c->t_stop = NAN;
  if (sun_context_create(&c->ctx)) return corot_fail(COROT_ENOMEM, "no memory for SUNDIALS");
  c->y = N_VNew_Serial(2 * (sunindextype)n, c->ctx);
  c->work = N_VNew_Serial(2, c->ctx);
  c->error = c->y ? N_VClone(c->y) : NULL;
  c->weight = c->y ? N_VClone(c->y) : NULL;
  c->scratch = c->y ? N_VClone(c->y) : NULL;
  c->A = corot_sun_matrix(self->pencil, c->ctx);
  c->LS = corot_sun_linsol(self->pencil, c->ctx);
  c->memory = CVodeCreate(CV_BDF, c->ctx);
  if (!c->y || !c->work || !c->error || !c->weight || !c->scratch || !c->A || !c->LS || !c->memory)
    return corot_fail(COROT_ENOMEM, "no memory for cvode on %d unknowns", 2 * n);
  memcpy(N_VGetArrayPointer(c->y), u, n * sizeof *u);
  memcpy(N_VGetArrayPointer(c->y) + n, v, n * sizeof *v);
  N_VConst(0, c->work);
  if (catch_messages(c) || CVodeInit(c->memory, rhs, self->t, c->y) || configure(c))
    return refuse(c, "set-up");
  return COROT_OK;
}

/* Whether a trial of the last few steps met a state that cannot be evaluated. */
static bool recently_refused(const cvode *c) {
  return c->refusal[0] && c->self->nst - c->refused <= 3;
}

/* The model's reason, if it is to blame, and SUNDIALS' own. */
static corot_status give_up(const cvode *c, const char *why) {
  bool refused = recently_refused(c);
  char limit[48] = "";
  if (c->self->def.min_step > 0)
    snprintf(limit, sizeof limit, "; min_step = %g s", c->self->def.min_step);
  return corot_fail(COROT_EINTEGRATE, "cvode: cannot get past t = %.9g: %s%s%s%s%s", c->self->t,
                    refused ? c->refusal : "", refused ? " (" : "", why, limit, refused ? ")" : "");
}

static bool collapsed(cvode *c, double h, bool stopped) {
  c->longest = fmax(c->longest, h);
  return !(h > 0) || (!stopped && recently_refused(c) && h < 1e-9 * c->longest);
}

static corot_status advance(cvode *c, double t_stop, double *t) {
  if (t_stop != c->t_stop && CVodeSetStopTime(c->memory, t_stop)) return refuse(c, "stop time");
  c->t_stop = t_stop;
  double beyond = t_stop + (t_stop - c->self->t);
  c->message[0] = 0;
  int flag = CVode(c->memory, beyond, c->y, t, CV_ONE_STEP);
  if (flag == CV_LSETUP_FAIL || flag == CV_LSOLVE_FAIL) refuse_trial(c, flag, corot_error());
  if (flag < 0) return give_up(c, c->message);
  if (flag == CV_TSTOP_RETURN) {
    *t = t_stop;
    c->t_stop = NAN; /* reaching it disarms it */
  }
  c->collapsed = collapsed(c, *t - c->self->t, *t == t_stop);
  return COROT_OK;
}

static corot_status cvode_step(corot_integrator *self, double t_stop, corot_step *step) {
  cvode *c = self->method;
  double t, t_work;
  long nni = 0;
  if (c->collapsed) {
    snprintf(c->message, sizeof c->message, "steps have shrunk to %.2g s", self->hlast);
    return give_up(c, c->message);
  }
  COROT_TRY(advance(c, t_stop, &t));
  if (CVodeGetQuad(c->memory, &t_work, c->work) || CVodeGetNumNonlinSolvIters(c->memory, &nni) ||
      CVodeGetLastOrder(c->memory, &step->order) || CVodeGetEstLocalErrors(c->memory, c->error) ||
      CVodeGetErrWeights(c->memory, c->weight))
    return refuse(c, "statistics");
  step->t = t;
  step->error = N_VWrmsNorm(c->error, c->weight);
  step->newton = (int)(nni - c->nni);
  c->nni = nni;
  return COROT_OK;
}

static corot_status cvode_at(corot_integrator *self, double t, double *u, double *v) {
  cvode *c = self->method;
  int n = corot_model_ndof(self->model);
  N_Vector y = c->y;
  if (t != self->t) {
    y = c->error;
    if (CVodeGetDky(c->memory, t, 0, y)) return refuse(c, "interpolant");
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
    if (bad) return refuse(c, "interpolant");
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
  if (rhs(c->self->t, c->y, now, c)) return give_up(c, "after a change of the frames");
  if (CVodeGetDky(c->memory, c->self->t, 1, old) || CVodeGetErrWeights(c->memory, c->weight))
    return refuse(c, "interpolant");
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
  c->collapsed = false;
  self->before = self->t;
  if (CVodeReInit(c->memory, self->t, c->y) || CVodeQuadReInit(c->memory, c->work) ||
      CVodeSetInitStep(c->memory, h))
    return refuse(c, "restart");
  return COROT_OK;
}

static void cvode_statistics(const corot_integrator *self, corot_statistics *s) {
  const cvode *c = self->method;
  const corot_statistics *b = &c->before;
  s->nfe = b->nfe, s->nsetups = b->nsetups, s->netf = b->netf, s->nni = b->nni, s->ncfn = b->ncfn;
  s->nfeQ = b->nfeQ, s->nrestart = b->nrestart;
  add_counts(c, s);
}

const integrator_ops corot_integrator_cvode = {"cvode",       cvode_create,    cvode_destroy,
                                               cvode_step,    cvode_at,        cvode_work,
                                               cvode_changed, cvode_statistics};
