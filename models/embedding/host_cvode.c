/* A host that owns its CVODE (the plain one, where corot's own integrators use CVODES) and takes
   the solid through corot::solve: right-hand side, Newton matrix, linear solver, error weights and
   all settings, by corot/sun_cvode.h. */
#include <corot/sun_cvode.h>

#include "bar.h"
#include "sun.h"

int main(void) {
  /* the solid: a model, what its evaluations need, and the matrices of a step */
  corot_model *model = bar_create();
  corot_state *state;
  corot_pencil *pencil;
  check(corot_state_create(model, &state));
  check(corot_pencil_create(model, state, NULL, &pencil));

  /* the host's own objects: y = (u, v), at rest, and CVODE with corot's right-hand side */
  SUNContext ctx;
  SUN(SUNContext_Create(SUN_COMM_NULL, &ctx));
  N_Vector y = zeros(2 * corot_model_ndof(model), ctx);
  void *cvode = CVodeCreate(CV_BDF, ctx);
  SUN(CVodeInit(cvode, corot_sun_rhs, 0, y));

  /* the rest is set up as corot's own integrator is; rtol is of the longest displacement */
  corot_sun_host host = {0};
  corot_sun_data data = {.model = model, .state = state, .rtol = 1e-7};
  check(corot_sun_cvode_open(&host, cvode, pencil, &data, y));
  SUN(CVodeSetMaxOrd(cvode, 5)); /* but what the host sets afterwards holds: at such a tolerance 5
                                    pays, where the body is damped in shear as this one is */

  /* step by step, between which the host may act; loads with kinks and jumps are taken care of */
  for (double t = 0; t < T_END;) check(corot_sun_host_step(&host, T_END, y, &t));
  bar_print(model, N_VGetArrayPointer(y));

  /* CVODE lags the Jacobian: K and D have been assembled less often than S was factored. */
  corot_pencil_counts counts = corot_pencil_statistics(pencil);
  fprintf(stderr, "%ld steps by %s: %ld assemblies, %ld factorisations, %ld solutions\n", host.nst,
          corot_pencil_solver(pencil), counts.nassembly, counts.nfactor, counts.nsolve);
  int lagged = counts.nassembly < counts.nfactor && counts.nfactor < counts.nsolve;

  CVodeFree(&cvode);
  corot_sun_host_close(&host);
  N_VDestroy(y);
  SUNContext_Free(&ctx);
  corot_pencil_destroy(pencil);
  corot_state_destroy(state);
  corot_model_destroy(model);
  return !lagged;
}
