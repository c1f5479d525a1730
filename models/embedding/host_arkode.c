/* A host that owns its ARKODE: implicit Runge-Kutta steps, the better choice where little damps the
   body. The solid is the implicit part; a host may add an explicit one of its own. */
#include <corot/sun_arkode.h>

#include "bar.h"
#include "sun.h"

int main(void) {
  /* the solid */
  corot_model *model = bar_create();
  corot_state *state;
  corot_pencil *pencil;
  check(corot_state_create(model, &state));
  check(corot_pencil_create(model, state, NULL, &pencil));

  /* the host's own objects: y = (u, v), at rest, and ARKODE */
  SUNContext ctx;
  SUN(SUNContext_Create(SUN_COMM_NULL, &ctx));
  N_Vector y = zeros(2 * corot_model_ndof(model), ctx);
  void *ark = ARKStepCreate(NULL, corot_sun_rhs, 0, y, ctx);

  /* the rest is set up as corot's own integrator is */
  corot_sun_host host = {0};
  corot_sun_data data = {.model = model, .state = state, .rtol = 1e-7};
  check(corot_sun_arkode_open(&host, ark, pencil, &data, y));

  /* step by step; in between, the host looks at where the bar is at times of its own */
  N_Vector at = zeros(2 * corot_model_ndof(model), ctx);
  double next = 0.25;
  for (double t = 0; t < T_END;) {
    check(corot_sun_host_step(&host, T_END, y, &t));
    for (; next <= t && next < T_END; next += 0.25) SUN(COROT_SUN_ARK_(GetDky)(ark, next, 0, at));
  }
  bar_print(model, N_VGetArrayPointer(y));
  fprintf(stderr, "%ld steps\n", host.nst);

  void (*release)(void **) = COROT_SUN_ARK_(Free);
  release(&ark);
  corot_sun_arkode_close(&host);
  N_VDestroy(y), N_VDestroy(at);
  SUNContext_Free(&ctx);
  corot_pencil_destroy(pencil);
  corot_state_destroy(state);
  corot_model_destroy(model);
}
