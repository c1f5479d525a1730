/* From the scenario, the model and the environment. */
#include "scenario_threads.h"

#include <stdlib.h>

int scenario_threads(const scenario *s, const corot_model *model) {
  if (s->threads) return s->threads;
  int n = corot_model_threads(model);
  const char *most = getenv("OMP_NUM_THREADS");
  long said = most ? strtol(most, NULL, 10) : 0; /* of a list, the outermost: the first */
  return said > 0 && said < n ? (int)said : n;
}

corot_status scenario_share(const scenario *s, const corot_model *model, corot_state *state) {
  corot_status status = COROT_ENOMEM;
  if (s->threads) return corot_state_threads(state, s->threads);
  for (int n = scenario_threads(s, model); n > 0 && status == COROT_ENOMEM; n /= 2)
    status = corot_state_threads(state, n);
  return status;
}
