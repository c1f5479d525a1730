/* A host that owns its CVODE (the plain one, where corot's own integrators use CVODES) and takes
   the solid through corot::solve: right-hand side, Newton matrix and linear solver. */
#include <corot/solve.h>
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>

#include "bar.h"

#ifndef SUN_COMM_NULL /* SUNDIALS before 7 */
#define SUN_COMM_NULL NULL
#endif

static void sun(int flag, const char *call) {
  if (flag >= 0) return;
  fprintf(stderr, "%s: %d\n", call, flag);
  exit(1);
}
#define SUN(call) sun(call, #call)

int main(void) {
  corot_model *model = bar_create();
  corot_state *state;
  corot_pencil *pencil;
  check(corot_state_create(model, &state));
  check(corot_pencil_create(model, state, NULL, &pencil));
  corot_sun_data data = {model, state, NULL};

  SUNContext ctx;
  SUN(SUNContext_Create(SUN_COMM_NULL, &ctx));
  N_Vector y = N_VNew_Serial(2 * corot_model_ndof(model), ctx);
  N_VConst(0, y);
  SUNMatrix A = corot_sun_matrix(pencil, ctx);
  SUNLinearSolver LS = corot_sun_linsol(pencil, ctx);
  void *cvode = CVodeCreate(CV_BDF, ctx);
  SUN(CVodeInit(cvode, corot_sun_rhs, 0, y));
  SUN(CVodeSStolerances(cvode, 1e-6, 1e-9));
  SUN(CVodeSetUserData(cvode, &data));
  SUN(CVodeSetMaxNumSteps(cvode, 100000));
  SUN(CVodeSetLinearSolver(cvode, LS, A));
  SUN(CVodeSetLinSysFn(cvode, corot_sun_linsys));

  sunrealtype t;
  SUN(CVode(cvode, T_END, y, &t, CV_NORMAL));
  bar_print(model, N_VGetArrayPointer(y));

  /* CVODE lags the Jacobian: K and D have been assembled less often than S was factored. */
  corot_pencil_counts counts = corot_pencil_statistics(pencil);
  fprintf(stderr, "%s: %ld assemblies, %ld factorisations, %ld solutions\n",
          corot_pencil_solver(pencil), counts.nassembly, counts.nfactor, counts.nsolve);
  int lagged = counts.nassembly < counts.nfactor && counts.nfactor < counts.nsolve;

  CVodeFree(&cvode);
  SUNLinSolFree(LS);
  SUNMatDestroy(A);
  N_VDestroy(y);
  SUNContext_Free(&ctx);
  corot_pencil_destroy(pencil);
  corot_state_destroy(state);
  corot_model_destroy(model);
  return !lagged;
}
