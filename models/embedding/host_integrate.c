/* A host that lets corot::integrate do it. */
#include <corot/integrate.h>

#include "bar.h"

int main(void) {
  corot_model *model = bar_create();
  corot_state *state;
  corot_integrator *integrator;
  check(corot_state_create(model, &state));
  double *u = calloc(2 * (size_t)corot_model_ndof(model), sizeof *u);
  if (!u) return 1;
  double *v = u + corot_model_ndof(model);

  corot_integrator_def def = corot_integrator_defaults();
  def.rtol = 1e-7;
  def.max_order = 5;
  check(corot_integrator_create(&def, model, state, 0, u, v, &integrator));
  for (corot_step step = {0}; step.t < T_END;)
    check(corot_integrator_step(integrator, T_END, &step));
  check(corot_integrator_at(integrator, T_END, u, v));
  bar_print(model, u);

  corot_integrator_destroy(integrator);
  corot_state_destroy(state);
  corot_model_destroy(model);
  free(u);
}
