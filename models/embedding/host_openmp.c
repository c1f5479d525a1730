/* A host with a parallel loop of its own, here OpenMP's: the evaluations of one state are shared
   out by it, and what comes out is the same to the last bit. (Without one,
   corot_state_threads(state, n) has the library start threads.) The loop over time is that of
   host_rk4.c. */
#include <corot/ode.h>
#include <omp.h>
#include <string.h>

#include "bar.h"

static void share_out(void *host, int nparts, void (*part)(void *work, int k), void *work) {
  int *nloop = host;
  ++*nloop;
#pragma omp parallel for schedule(static)
  for (int k = 0; k < nparts; k++) part(work, k);
}

/* y = (u, v) [n] at T_END by the classical Runge-Kutta method. */
static void integrate(const corot_model *model, corot_state *state, double *y) {
  int n = 2 * corot_model_ndof(model), nstep = 4000;
  double *k = calloc((size_t)n * 2, sizeof *k), *z = k + n, *sum = calloc((size_t)n, sizeof *sum);
  const double weight[] = {1, 2, 2, 1}, ahead[] = {0, 0.5, 0.5, 1};
  if (!k || !sum) exit(1);
  double h = T_END / nstep;
  for (int step = 0; step < nstep; step++) {
    memset(k, 0, (size_t)n * sizeof *k), memset(sum, 0, (size_t)n * sizeof *sum);
    for (int stage = 0; stage < 4; stage++) {
      for (int i = 0; i < n; i++) z[i] = y[i] + ahead[stage] * h * k[i];
      check(corot_rhs(model, state, (step + ahead[stage]) * h, z, k));
      for (int i = 0; i < n; i++) sum[i] += weight[stage] * k[i];
    }
    for (int i = 0; i < n; i++) y[i] += h / 6 * sum[i];
  }
  free(k), free(sum);
}

int main(void) {
  corot_model *model = bar_create();
  size_t n = 2 * (size_t)corot_model_ndof(model);
  double *y = calloc(2 * n, sizeof *y);
  int nloop = 0;
  if (!y) return 1;
  for (int run = 0; run < 2; run++) { /* alone, then shared out */
    corot_state *state;
    check(corot_state_create(model, &state));
    if (run == 1) check(corot_state_parallel(state, omp_get_max_threads() + 1, share_out, &nloop));
    integrate(model, state, y + run * n);
    corot_state_destroy(state);
  }
  bar_print(model, y);
  bool same = memcmp(y, y + n, n * sizeof *y) == 0;
  fprintf(stderr, "the same in %d parallel loops: %s\n", nloop, same ? "yes" : "no");

  free(y);
  corot_model_destroy(model);
  return !same || nloop == 0;
}
