/* A host's own KINSOL, set up as in corot's equilibria:

     corot_linear_def linear = corot_linear_defaults();
     linear.role = COROT_ROLE_STATIC;                     for corot_pencil_create
     void *kinsol = KINCreate(ctx);
     KINInit(kinsol, corot_sun_force, u);
     corot_sun_rest rest = {0};
     corot_sun_kinsol_open(&rest, kinsol, pencil, &(corot_sun_data){.model = model, .state = state},
   u); corot_sun_kinsol_solve(&rest, t, factor, 1e-10, u); KINFree(&kinsol);
     corot_sun_rest_close(&rest);

   Full Newton steps with the exact tangent, whose error squares. corot/statics.h steps the load and
   judges stability by itself; this is for a host whose KINSOL has more to solve for, or another
   strategy.

   A complete program: models/embedding/host_kinsol.c. */
#ifndef COROT_SUN_KINSOL_H
#define COROT_SUN_KINSOL_H

#include <corot/host.h>
#include <corot/solve.h>
#include <kinsol/kinsol.h>
#include <math.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Sets `kinsol` up, on which KINInit has been called with corot_sun_force and u [n]. Of *data,
   which is copied, model and state are used; they and the pencil must outlive `rest`, which is to
   be zeroed before, and must stay where it is. What the host sets afterwards holds.
   COROT_EINTEGRATE: KINSOL refuses; else as corot_sun_rest_open. Then there is nothing to close. */
static inline corot_status corot_sun_kinsol_open(corot_sun_rest *rest, void *kinsol,
                                                 corot_pencil *pencil, const corot_sun_data *data,
                                                 N_Vector u) {
  COROT_TRY(corot_sun_rest_open(rest, kinsol, pencil, data, u));
  /* no Newton step longer than the body, in the root mean square; none too short but rounding */
  double n = corot_model_ndof(data->model);
  int f;
  if ((f = KINSetUserData(kinsol, rest)) || (f = KINSetLinearSolver(kinsol, rest->LS, rest->A)) ||
      (f = KINSetJacFn(kinsol, corot_sun_jacobian_static)) ||
      (f = KINSetMaxSetupCalls(kinsol, 1)) || (f = KINSetNoResMon(kinsol, 1)) ||
      (f = KINSetNumMaxIters(kinsol, 20)) ||
      (f = KINSetMaxNewtonStep(kinsol, n > 1 ? sqrt(n) : 1)) ||
      (f = KINSetScaledStepTol(kinsol, 1e-15))) {
    corot_sun_rest_close(rest);
    return corot_sun_judge(f > 0 ? -f : f, "corot_sun_kinsol_open: a setting");
  }
  return COROT_OK;
}

/* From u, a guess, to an equilibrium under `factor` times the loads of time t, supports where they
   are at time t; *state stands still from then on. `tolerance`: of the largest component of r over
   the largest force on a node; what double precision cannot reach is not asked for. COROT_RETRY:
   KINSOL found none, and u is where it ended: come nearer by steps of the factor. COROT_EINTEGRATE:
   KINSOL refuses. COROT_ENOMEM, COROT_EINVAL: as corot_sun_force_scale. */
static inline corot_status corot_sun_kinsol_solve(corot_sun_rest *rest, double t, double factor,
                                                  double tolerance, N_Vector u) {
  double force = 0, rounding = 0;
  corot_state_stand_still(rest->data.state, t, factor);
  COROT_TRY(corot_sun_force_scale(&rest->data, N_VGetArrayPointer(u), &force, &rounding));
  double unit = force > rounding ? force : rounding;
  double least = tolerance * unit > rounding ? tolerance * unit : rounding;
  N_VConst(1 / unit, rest->f_scale);
  COROT_TRY(corot_sun_judge(KINSetFuncNormTol(rest->memory, least / unit), "KINSetFuncNormTol"));
  int flag = KINSol(rest->memory, u, KIN_NONE, rest->u_scale, rest->f_scale);
  if (flag == KIN_SUCCESS || flag == KIN_INITIAL_GUESS_OK) return COROT_OK;
  if (flag == KIN_MEM_FAIL || flag == KIN_ILL_INPUT) return corot_sun_judge(flag, "KINSol");

  /* it stands still where rounding is all that is left, at the forces that are there now */
  sunrealtype left = 0;
  COROT_TRY(corot_sun_force_scale(&rest->data, N_VGetArrayPointer(u), &force, &rounding));
  COROT_TRY(corot_sun_judge(KINGetFuncNorm(rest->memory, &left), "KINGetFuncNorm"));
  if (left * unit <= tolerance * force || left * unit <= 100 * rounding) return COROT_OK;
  return corot_fail(COROT_RETRY, "KINSol: flag %d, with %g N left of %g N", flag,
                    (double)left * unit, force);
}

#ifdef __cplusplus
}
#endif
#endif
