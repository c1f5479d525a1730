/* A host's own CVODE, or CVODES, set up as well as corot's "cvode". A program that links
   corot::integrate as well takes CVODES (and IDAS): CVODE and CVODES define the same names, and corot
   uses the latter.

     void *cvode = CVodeCreate(CV_BDF, ctx);
     CVodeInit(cvode, corot_sun_rhs, t0, y);
     corot_sun_host host = {0};
     corot_sun_cvode_open(&host, cvode, pencil, &(corot_sun_data){.model = model, .state = state},
   y); while (host.t < t_end) corot_sun_host_step(&host, t_end, y, &t); CVodeFree(&cvode);
     corot_sun_host_close(&host);

   sets linear solver, error weights, orders, Newton's tolerance, how old matrices may grow; a step
   stops at kinks and begins again where it must. What the host sets afterwards holds. Functions are
   inline, so that the program links the one library that the host wants: with CVODES, include
   cvodes/cvodes.h before this.

   A complete program: models/embedding/host_cvode.c. */
#ifndef COROT_SUN_CVODE_H
#define COROT_SUN_CVODE_H

#include <corot/host.h>
#include <corot/solve.h>
#if !defined(_CVODE_H) && !defined(_CVODES_H)
#include <cvode/cvode.h>
#endif

#ifdef __cplusplus
extern "C" {
#endif

static inline int corot_sun_cvode_advance_(corot_sun_host *host, double beyond, N_Vector y,
                                           sunrealtype *t) {
  return CVode(host->memory, beyond, y, t, CV_ONE_STEP);
}

static inline int corot_sun_cvode_restart_(corot_sun_host *host, double t, N_Vector y) {
  return CVodeReInit(host->memory, t, y);
}

static inline const corot_sun_api *corot_sun_cvode_api_(void) {
  static const corot_sun_api api = {"cvode",
                                    COROT_SUN_CVODE,
                                    CV_TSTOP_RETURN,
                                    corot_sun_cvode_advance_,
                                    corot_sun_cvode_restart_,
                                    CVodeSetStopTime,
                                    CVodeSetInitStep,
                                    CVodeGetDky,
                                    CVodeGetLastStep,
                                    CVodeGetCurrentStep,
                                    CVodeGetErrWeights,
                                    CVodeGetNumNonlinSolvConvFails};
  return &api;
}

/* Sets `cvode` up, on which CVodeInit has been called with corot_sun_rhs and y [2n]. Of *data,
   which is copied, `mass` is needed for consistent mass, and rtol and both atol may be zero: 1e-4,
   and as corot_sun_advise says. Pencil, model, state and mass must outlive the host.
   COROT_EINTEGRATE: CVODE refuses; else as corot_sun_host_open. Then there is nothing to close. */
static inline corot_status corot_sun_cvode_open(corot_sun_host *host, void *cvode,
                                                corot_pencil *pencil, const corot_sun_data *data,
                                                N_Vector y) {
  sunrealtype t = 0;
  if (cvode) COROT_TRY(corot_sun_judge(CVodeGetCurrentTime(cvode, &t), "CVodeGetCurrentTime"));
  COROT_TRY(corot_sun_host_open(host, corot_sun_cvode_api_(), cvode, pencil, data, t, y));
  const corot_sun_advice *a = &host->advice;
  int f;
  if ((f = CVodeSetUserData(cvode, host)) || (f = CVodeWFtolerances(cvode, corot_sun_weights)) ||
      (f = CVodeSetLinearSolver(cvode, host->LS, host->A)) ||
      (f = CVodeSetLinSysFn(cvode, corot_sun_linsys)) ||
      (f = CVodeSetMaxOrd(cvode, a->max_order)) ||
      (f = CVodeSetStabLimDet(cvode, a->max_order > 2)) || (f = CVodeSetMaxNumSteps(cvode, -1)) ||
      (f = CVodeSetMaxErrTestFails(cvode, a->error_failures)) ||
      (f = CVodeSetLSetupFrequency(cvode, a->refactorisation)) ||
      (f = CVodeSetJacEvalFrequency(cvode, a->reassembly)) ||
      (f = CVodeSetDeltaGammaMaxLSetup(cvode, a->gamma_change)) ||
      (f = CVodeSetNonlinConvCoef(cvode, a->convergence))) {
    corot_sun_host_close(host);
    return corot_sun_judge(f > 0 ? -f : f, "corot_sun_cvode_open: a setting");
  }
  return COROT_OK;
}

#ifdef __cplusplus
}
#endif
#endif
