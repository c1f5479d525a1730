/* A host with an explicit loop of its own: the classical Runge-Kutta method at a constant step,
   with nothing but corot::core. */
#include <corot/ode.h>

#include "bar.h"

int main(void) {
  corot_model *model = bar_create();
  corot_state *state;
  check(corot_state_create(model, &state));
  int n = 2 * corot_model_ndof(model), nstep = 4000;
  double *y = calloc((size_t)n * 6, sizeof *y), *k[] = {y + n, y + 2 * n, y + 3 * n, y + 4 * n};
  if (!y) return 1;

  /* y = (u, v). Which step is the longest stable one depends on the mesh, not on the accuracy asked
     for: that is what implicit hosts are for. */
  double h = T_END / nstep, *z = y + 5 * n;
  for (int step = 0; step < nstep; step++) {
    double t = step * h;
    check(corot_rhs(model, state, t, y, k[0]));
    for (int i = 0; i < n; i++) z[i] = y[i] + h / 2 * k[0][i];
    check(corot_rhs(model, state, t + h / 2, z, k[1]));
    for (int i = 0; i < n; i++) z[i] = y[i] + h / 2 * k[1][i];
    check(corot_rhs(model, state, t + h / 2, z, k[2]));
    for (int i = 0; i < n; i++) z[i] = y[i] + h * k[2][i];
    check(corot_rhs(model, state, t + h, z, k[3]));
    for (int i = 0; i < n; i++) y[i] += h / 6 * (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i]);
  }
  bar_print(model, y);

  free(y);
  corot_state_destroy(state);
  corot_model_destroy(model);
}
