/* A host that owns its KINSOL, and asks where the bar comes to rest under the load in full
   (corot/sun_kinsol.h). */
#include <corot/sun_kinsol.h>

#include "bar.h"
#include "sun.h"

int main(void) {
  /* the solid: the matrix of an equilibrium is K alone, for which another solver may be best */
  corot_model *model = bar_create();
  corot_state *state;
  corot_pencil *pencil;
  corot_linear_def linear = corot_linear_defaults();
  linear.role = COROT_ROLE_STATIC;
  check(corot_state_create(model, &state));
  check(corot_pencil_create(model, state, &linear, &pencil));

  /* the host's own objects: u, and KINSOL with corot's system function */
  SUNContext ctx;
  SUN(SUNContext_Create(SUN_COMM_NULL, &ctx));
  N_Vector u = zeros(corot_model_ndof(model), ctx);
  void *kinsol = KINCreate(ctx);
  SUN(KINInit(kinsol, corot_sun_force, u));

  /* the rest is set up as in corot's own equilibria; half of the load first, then all of it */
  corot_sun_rest rest = {0};
  corot_sun_data data = {.model = model, .state = state};
  check(corot_sun_kinsol_open(&rest, kinsol, pencil, &data, u));
  for (double factor = 0.5; factor <= 1; factor += 0.5)
    check(corot_sun_kinsol_solve(&rest, T_END, factor, 1e-10, u));
  bar_print(model, N_VGetArrayPointer(u));
  long iterations = 0;
  SUN(KINGetNumNonlinSolvIters(kinsol, &iterations));
  fprintf(stderr, "%ld iterations for the second half of the load\n", iterations);

  KINFree(&kinsol);
  corot_sun_rest_close(&rest);
  N_VDestroy(u);
  SUNContext_Free(&ctx);
  corot_pencil_destroy(pencil);
  corot_state_destroy(state);
  corot_model_destroy(model);
}
