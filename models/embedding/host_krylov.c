/* A host whose CVODE solves by GMRES, as where the solid is a part of a system that has no matrix
   as a whole: products with the exact Jacobian, and the pencil as the preconditioner
   (corot/host.h). Here there is nothing but the solid, so that a few iterations do. */
#include <corot/host.h>
#include <cvode/cvode.h>
#include <sunlinsol/sunlinsol_spgmr.h>

#include "bar.h"
#include "sun.h"

int main(void) {
  /* the solid, and all of it in one pointer */
  corot_model *model = bar_create();
  corot_state *state;
  corot_pencil *pencil;
  corot_sun_advice advice;
  check(corot_state_create(model, &state));
  check(corot_pencil_create(model, state, NULL, &pencil));
  check(corot_sun_advise(model, COROT_SUN_CVODE, 1e-7, &advice));
  corot_sun_data data = {.model = model,
                         .state = state,
                         .pencil = pencil,
                         .rtol = 1e-7,
                         .atol_displacement = advice.atol_displacement,
                         .atol_velocity = advice.atol_velocity};

  /* the host's own objects, and what it takes of corot's advice */
  SUNContext ctx;
  SUN(SUNContext_Create(SUN_COMM_NULL, &ctx));
  N_Vector y = zeros(2 * corot_model_ndof(model), ctx);
  void *cvode = CVodeCreate(CV_BDF, ctx);
  SUNLinearSolver gmres = SUNLinSol_SPGMR(y, SUN_PREC_LEFT, 0, ctx);
  SUN(CVodeInit(cvode, corot_sun_rhs, 0, y));
  SUN(CVodeSetUserData(cvode, &data));
  SUN(CVodeWFtolerances(cvode, corot_sun_weights));
  SUN(CVodeSetMaxOrd(cvode, advice.max_order));
  SUN(CVodeSetMaxNumSteps(cvode, -1));
  SUN(CVodeSetLinearSolver(cvode, gmres, NULL));
  SUN(CVodeSetJacTimes(cvode, NULL, corot_sun_jtimes));
  SUN(CVodeSetPreconditioner(cvode, corot_sun_psetup, corot_sun_psolve));

  /* to each stop in turn: the load has a kink at 1 s */
  sunrealtype t = 0;
  while (t < T_END) {
    corot_sun_stop stop = corot_sun_next_stop(model, t, 0, T_END);
    SUN(CVodeSetStopTime(cvode, stop.t));
    SUN(CVode(cvode, stop.t + 1, y, &t,
              CV_NORMAL)); /* beyond the stop: see src/solve/host/stepper.c */
    if (stop.kink) corot_state_enter(state, t);
  }
  bar_print(model, N_VGetArrayPointer(y));
  long nni = 0, nli = 0;
  SUN(CVodeGetNumNonlinSolvIters(cvode, &nni) || CVodeGetNumLinIters(cvode, &nli));
  fprintf(stderr, "%ld iterations of Newton's, %ld of GMRES\n", nni, nli);

  CVodeFree(&cvode);
  SUNLinSolFree(gmres);
  N_VDestroy(y);
  SUNContext_Free(&ctx);
  corot_pencil_destroy(pencil);
  corot_state_destroy(state);
  corot_model_destroy(model);
}
