/* A host with threads: a model never changes and is shared; each thread has a state of its own, and
   whatever integrates it. Two threads run the same bar at the same time, at two tolerances; then
   the first run is repeated in another thread, and comes out the same to the last bit. */
#include <corot/integrate.h>
#include <pthread.h>
#include <string.h>

#include "bar.h"

typedef struct job {
  const corot_model *model;
  double rtol;
  double *u; /* [n] at the end */
} job;

static void *run(void *argument) {
  job *j = argument;
  corot_state *state;
  corot_integrator *integrator;
  int n = corot_model_ndof(j->model);
  double *v = calloc((size_t)n, sizeof *v);
  if (!v) exit(1);

  corot_integrator_def def = corot_integrator_defaults();
  def.rtol = j->rtol;
  def.max_order = 5;
  check(corot_state_create(j->model, &state)); /* corot_error() is each thread's own */
  check(corot_integrator_create(&def, j->model, state, 0, j->u, v, &integrator));
  for (corot_step step = {0}; step.t < T_END;)
    check(corot_integrator_step(integrator, T_END, &step));
  check(corot_integrator_at(integrator, T_END, j->u, v));

  corot_integrator_destroy(integrator);
  corot_state_destroy(state);
  free(v);
  return NULL;
}

int main(void) {
  corot_model *model = bar_create();
  size_t n = (size_t)corot_model_ndof(model);
  double *u = calloc(3 * n, sizeof *u);
  if (!u) return 1;

  pthread_t other;
  job mine = {model, 1e-7, u}, yours = {model, 1e-5, u + n}, again = {model, 1e-7, u + 2 * n};
  if (pthread_create(&other, NULL, run, &yours)) return 1;
  run(&mine);
  pthread_join(other, NULL);
  if (pthread_create(&other, NULL, run, &again)) return 1;
  pthread_join(other, NULL);
  bar_print(model, u);
  bool same = memcmp(u, u + 2 * n, n * sizeof *u) == 0;
  fprintf(stderr, "the same in another thread: %s\n", same ? "yes" : "no");

  free(u);
  corot_model_destroy(model);
  return !same;
}
