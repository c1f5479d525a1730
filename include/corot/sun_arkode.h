/* A host's own ARKODE (an implicit ARKStep), set up as well as corot's "arkode":

     void *ark = ARKStepCreate(NULL, corot_sun_rhs, t0, y, ctx);
     corot_sun_host host = {0};
     corot_sun_arkode_open(&host, ark, pencil, &data, y);
     while (host.t < t_end) corot_sun_host_step(&host, t_end, y, &t);

   as in corot/sun_cvode.h (a file for errors, of SUNDIALS 6, is the host's to set afterwards). A
   step whose end cannot be evaluated is repeated with a shorter one, which ARKODE by itself takes
   for the end.

   A complete program: models/embedding/host_arkode.c. */
#ifndef COROT_SUN_ARKODE_H
#define COROT_SUN_ARKODE_H

#include <arkode/arkode_arkstep.h>
#include <corot/host.h>
#include <corot/solve.h>
#include <stdio.h>
#include <sundials/sundials_version.h>
#if SUNDIALS_VERSION_MAJOR >= 7
#include <sunadaptcontroller/sunadaptcontroller_soderlind.h>
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* From 7.1 on ARKODE's functions have one name for all its modules. */
#if SUNDIALS_VERSION_MAJOR > 7 || (SUNDIALS_VERSION_MAJOR == 7 && SUNDIALS_VERSION_MINOR >= 1)
#define COROT_SUN_ARK_(name) ARKode##name
#else
#define COROT_SUN_ARK_(name) ARKStep##name
#endif

static inline int corot_sun_arkode_restart_(corot_sun_host *host, double t, N_Vector y) {
  return COROT_SUN_ARK_(Reset)(host->memory, t, y);
}

/* host->old = y, from which a step that ARKODE took for the end is tried again. */
static inline int corot_sun_arkode_advance_(corot_sun_host *host, double beyond, N_Vector y,
                                            sunrealtype *t) {
  void *ark = host->memory;
  sunrealtype h = 0;
  N_VScale(1, y, host->old);
  int flag = COROT_SUN_ARK_(Evolve)(ark, beyond, y, t, ARK_ONE_STEP);
  for (int k = 0; k < 20; k++) {
    if (flag != ARK_UNREC_RHSFUNC_ERR && flag != ARK_REPTD_RHSFUNC_ERR && flag != ARK_RHSFUNC_FAIL)
      break;
    if (k == 0 && COROT_SUN_ARK_(GetCurrentStep)(ark, &h)) break;
    if (h > host->stop - host->t) h = host->stop - host->t;
    h /= 4;
    N_VScale(1, host->old, y);
    if (COROT_SUN_ARK_(Reset)(ark, host->t, y) || COROT_SUN_ARK_(SetInitStep)(ark, h) ||
        COROT_SUN_ARK_(SetStopTime)(ark, host->stop))
      break;
    flag = COROT_SUN_ARK_(Evolve)(ark, beyond, y, t, ARK_ONE_STEP);
  }
  if (flag < 0) N_VScale(1, host->old, y);
  return flag;
}

static inline const corot_sun_api *corot_sun_arkode_api_(void) {
  static const corot_sun_api api = {"arkode",
                                    COROT_SUN_ARKODE,
                                    ARK_TSTOP_RETURN,
                                    corot_sun_arkode_advance_,
                                    corot_sun_arkode_restart_,
                                    COROT_SUN_ARK_(SetStopTime),
                                    COROT_SUN_ARK_(SetInitStep),
                                    COROT_SUN_ARK_(GetDky),
                                    COROT_SUN_ARK_(GetLastStep),
                                    COROT_SUN_ARK_(GetCurrentStep),
                                    COROT_SUN_ARK_(GetErrWeights),
                                    COROT_SUN_ARK_(GetNumNonlinSolvConvFails)};
  return &api;
}

/* How the next step follows from the errors of the last two. */
static inline int corot_sun_arkode_adapt_(corot_sun_host *host) {
#if SUNDIALS_VERSION_MAJOR >= 7
  host->controller = (void *)SUNAdaptController_PI(host->jump->sunctx);
  return host->controller ? COROT_SUN_ARK_(SetAdaptController)(host->memory,
                                                               (SUNAdaptController)host->controller)
                          : ARK_MEM_FAIL;
#else
  return ARKStepSetAdaptivityMethod(host->memory, ARK_ADAPT_PI, SUNTRUE, SUNFALSE, NULL);
#endif
}

/* Where the stages' iterations begin: by the stages of the step before. SUNDIALS says that this may
   go one day (what may follow takes up to a third more steps); 6 prints that on stderr, unless
   there is no file for it. */
static inline int corot_sun_arkode_predict_(corot_sun_host *host) {
#if SUNDIALS_VERSION_MAJOR >= 7
  return COROT_SUN_ARK_(SetPredictorMethod)(host->memory, host->advice.predictor);
#else
  int flag = ARKStepSetErrFile(host->memory, NULL);
  if (flag == 0) flag = ARKStepSetPredictorMethod(host->memory, host->advice.predictor);
  return ARKStepSetErrFile(host->memory, stderr) || flag;
#endif
}

/* In place of corot_sun_host_close, which leaves the controller of SUNDIALS 7 behind. */
static inline void corot_sun_arkode_close(corot_sun_host *host) {
#if SUNDIALS_VERSION_MAJOR >= 7
  if (host && host->controller)
    (void)SUNAdaptController_Destroy((SUNAdaptController)host->controller);
#endif
  corot_sun_host_close(host);
}

/* Sets `ark` up, which ARKStepCreate has made of corot_sun_rhs as the implicit part, at t and y
   [2n]; the rest as corot_sun_cvode_open. Close it by corot_sun_arkode_close, after ARKODE is
   freed. COROT_EINTEGRATE: ARKODE refuses; else as corot_sun_host_open. */
static inline corot_status corot_sun_arkode_open(corot_sun_host *host, void *ark,
                                                 corot_pencil *pencil, const corot_sun_data *data,
                                                 N_Vector y) {
  sunrealtype t = 0;
  if (ark) COROT_TRY(corot_sun_judge(COROT_SUN_ARK_(GetCurrentTime)(ark, &t), "GetCurrentTime"));
  COROT_TRY(corot_sun_host_open(host, corot_sun_arkode_api_(), ark, pencil, data, t, y));
  const corot_sun_advice *a = &host->advice;
  int f;
  if ((f = COROT_SUN_ARK_(SetUserData)(ark, host)) ||
      (f = COROT_SUN_ARK_(WFtolerances)(ark, corot_sun_weights)) ||
      (f = COROT_SUN_ARK_(SetLinearSolver)(ark, host->LS, host->A)) ||
      (f = COROT_SUN_ARK_(SetLinSysFn)(ark, corot_sun_linsys_ark)) ||
      (f = ARKStepSetTableName(ark, a->table, "ARKODE_ERK_NONE")) ||
      (f = COROT_SUN_ARK_(SetMaxNumSteps)(ark, -1)) ||
      (f = COROT_SUN_ARK_(SetMaxErrTestFails)(ark, a->error_failures)) ||
      (f = COROT_SUN_ARK_(SetLSetupFrequency)(ark, a->refactorisation)) ||
      (f = COROT_SUN_ARK_(SetJacEvalFrequency)(ark, a->reassembly)) ||
      (f = COROT_SUN_ARK_(SetDeltaGammaMax)(ark, a->gamma_change)) ||
      (f = COROT_SUN_ARK_(SetNonlinConvCoef)(ark, a->convergence)) ||
      (f = COROT_SUN_ARK_(SetMaxNonlinIters)(ark, a->newton_iterations)) ||
      (f = corot_sun_arkode_predict_(host)) || (f = COROT_SUN_ARK_(SetInterpolantDegree)(ark, 3)) ||
      (f = COROT_SUN_ARK_(SetDeduceImplicitRhs)(ark, SUNTRUE)) ||
      (f = corot_sun_arkode_adapt_(host)) || (f = COROT_SUN_ARK_(SetSafetyFactor)(ark, 0.9)) ||
      (f = COROT_SUN_ARK_(SetErrorBias)(ark, 1))) {
    corot_sun_arkode_close(host);
    return corot_sun_judge(f > 0 ? -f : f, "corot_sun_arkode_open: a setting");
  }
  return COROT_OK;
}

#ifdef __cplusplus
}
#endif
#endif
