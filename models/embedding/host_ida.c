/* A host that owns its IDA, as where the solid is a part of a differential-algebraic system. The
   solid is F(t, y, y') = (u' - v, M v' - r), so that a consistent mass is only multiplied by; but
   the start asks for an acceleration that is consistent, M v' = r, and for that there is a mass
   solver. */
#include <corot/sun_ida.h>

#include "bar.h"
#include "sun.h"

int main(void) {
  /* the solid */
  corot_model *model = bar_create();
  corot_state *state;
  corot_pencil *pencil;
  corot_mass_solver *mass;
  check(corot_state_create(model, &state));
  check(corot_pencil_create(model, state, NULL, &pencil));
  check(corot_mass_solver_create(model, &mass));
  corot_sun_data data = {.model = model, .state = state, .mass = mass, .rtol = 1e-7};

  /* the host's own objects: y = (u, v) at rest, y' that satisfies the equations there, and IDA */
  SUNContext ctx;
  SUN(SUNContext_Create(SUN_COMM_NULL, &ctx));
  int n = 2 * corot_model_ndof(model);
  N_Vector y = zeros(n, ctx), yp = zeros(n, ctx);
  if (corot_sun_rhs(0, y, yp, &data)) check(COROT_EINTEGRATE);
  void *ida = IDACreate(ctx);
  SUN(IDAInit(ida, corot_sun_residual, 0, y, yp));

  /* the rest is set up as corot's own integrator is; then step by step */
  corot_sun_host host = {0};
  check(corot_sun_ida_open(&host, ida, pencil, &data, y, yp));
  for (double t = 0; t < T_END;) check(corot_sun_host_step(&host, T_END, y, &t));
  bar_print(model, N_VGetArrayPointer(y));
  fprintf(stderr, "%ld steps\n", host.nst);

  IDAFree(&ida);
  corot_sun_host_close(&host);
  N_VDestroy(y), N_VDestroy(yp);
  SUNContext_Free(&ctx);
  corot_mass_solver_destroy(mass);
  corot_pencil_destroy(pencil);
  corot_state_destroy(state);
  corot_model_destroy(model);
}
