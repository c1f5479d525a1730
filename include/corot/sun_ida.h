/* A host's own IDA, or IDAS, set up as well as corot's "ida":

     IDAInit(ida, corot_sun_residual, t0, y, yp);    yp from corot_sun_rhs(t0, y, yp, &data)
     corot_sun_host host = {0};
     corot_sun_ida_open(&host, ida, pencil, &data, y, yp);
     while (host.t < t_end) corot_sun_host_step(&host, t_end, y, &t);

   as in corot/sun_cvode.h. K and D are kept while IDA asks for a Jacobian again and again, and only
   combined anew, until they are old or Newton's iteration has failed since. With IDAS, include
   idas/idas.h before this.

   A complete program: models/embedding/host_ida.c. */
#ifndef COROT_SUN_IDA_H
#define COROT_SUN_IDA_H

#include <corot/host.h>
#include <corot/solve.h>
#if !defined(_IDA_H) && !defined(_IDAS_H)
#include <ida/ida.h>
#endif

#ifdef __cplusplus
extern "C" {
#endif

static inline int corot_sun_ida_advance_(corot_sun_host *host, double beyond, N_Vector y,
                                         sunrealtype *t) {
  return IDASolve(host->memory, beyond, t, y, host->yp, IDA_ONE_STEP);
}

static inline int corot_sun_ida_restart_(corot_sun_host *host, double t, N_Vector y) {
  int flag = corot_sun_rhs(t, y, host->yp, &host->data);
  return flag ? -1 : IDAReInit(host->memory, t, y, host->yp);
}

static inline int corot_sun_ida_jacobian_(sunrealtype t, sunrealtype cj, N_Vector y, N_Vector yp,
                                          N_Vector F, SUNMatrix A, void *user_data, N_Vector tmp1,
                                          N_Vector tmp2, N_Vector tmp3) {
  corot_sun_host *host = (corot_sun_host *)user_data;
  sunbooleantype made = 0;
  long ncfn = 0;
  (void)yp;
  if (IDAGetNumNonlinSolvConvFails(host->memory, &ncfn)) return -1;
  int current = host->assembled > 0 && ncfn == host->ncfn_then &&
                host->nst + 1 - host->assembled < host->advice.reassembly;
  int flag = corot_sun_linsys(t, y, F, A, current, &made, 1 / cj, user_data, tmp1, tmp2, tmp3);
  if (flag == 0 && made) host->assembled = host->nst + 1, host->ncfn_then = ncfn;
  return flag;
}

static inline const corot_sun_api *corot_sun_ida_api_(void) {
  static const corot_sun_api api = {"ida",
                                    COROT_SUN_IDA,
                                    IDA_TSTOP_RETURN,
                                    corot_sun_ida_advance_,
                                    corot_sun_ida_restart_,
                                    IDASetStopTime,
                                    IDASetInitStep,
                                    IDAGetDky,
                                    IDAGetLastStep,
                                    IDAGetCurrentStep,
                                    IDAGetErrWeights,
                                    IDAGetNumNonlinSolvConvFails};
  return &api;
}

/* Sets `ida` up, on which IDAInit has been called with corot_sun_residual, y and yp [2n], which
   must outlive the host; the rest as corot_sun_cvode_open. COROT_EINTEGRATE: IDA refuses;
   COROT_EINVAL: there is no yp; else as corot_sun_host_open. */
static inline corot_status corot_sun_ida_open(corot_sun_host *host, void *ida, corot_pencil *pencil,
                                              const corot_sun_data *data, N_Vector y, N_Vector yp) {
  sunrealtype t = 0;
  if (!yp) return corot_fail(COROT_EINVAL, "corot_sun_ida_open: there is no yp");
  if (ida) COROT_TRY(corot_sun_judge(IDAGetCurrentTime(ida, &t), "IDAGetCurrentTime"));
  COROT_TRY(corot_sun_host_open(host, corot_sun_ida_api_(), ida, pencil, data, t, y));
  const corot_sun_advice *a = &host->advice;
  host->yp = yp;
  int f;
  if ((f = IDASetUserData(ida, host)) || (f = IDAWFtolerances(ida, corot_sun_weights)) ||
      (f = IDASetLinearSolver(ida, host->LS, host->A)) ||
      (f = IDASetJacFn(ida, corot_sun_ida_jacobian_)) || (f = IDASetMaxOrd(ida, a->max_order)) ||
      (f = IDASetMaxNumSteps(ida, -1)) || (f = IDASetMaxErrTestFails(ida, a->error_failures)) ||
      (f = IDASetDeltaCjLSetup(ida, a->gamma_change)) ||
      (f = IDASetNonlinConvCoef(ida, a->convergence))) {
    corot_sun_host_close(host);
    return corot_sun_judge(f > 0 ? -f : f, "corot_sun_ida_open: a setting");
  }
  return COROT_OK;
}

#ifdef __cplusplus
}
#endif
#endif
