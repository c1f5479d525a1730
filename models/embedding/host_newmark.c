/* A host with an implicit loop of its own, Newmark's method of average acceleration, that takes no
   more of corot than the pencil: assemble, combine, factor, solve. No object of SUNDIALS is made.
 */
#include <corot/solve.h>
#include <math.h>

#include "bar.h"

int main(void) {
  /* the solid */
  corot_model *model = bar_create();
  corot_state *state;
  corot_pencil *pencil;
  check(corot_state_create(model, &state));
  check(corot_pencil_create(model, state, NULL, &pencil));
  int n = corot_model_ndof(model), nstep = 1000, niteration = 0;
  double *u = calloc(7 * (size_t)n, sizeof *u), *v = u + n, *a = v + n, *u1 = a + n, *v1 = u1 + n;
  double *r = v1 + n, *Ma = r + n;
  if (!u) return 1;

  /* a step of h: u1 = u + h/2 (v + v1), a1 = 2/h (v1 - v) - a, and M a1 = r(u1, v1) by Newton's
     iteration for v1, whose matrix is 2/h S with S = M + g D + g^2 K, g = h/2. (The bar begins at
     rest without a load: a = 0.) */
  double h = T_END / nstep, g = h / 2;
  for (int step = 1; step <= nstep; step++) {
    double largest = INFINITY;
    for (int i = 0; i < n; i++) v1[i] = v[i] + h * a[i];
    for (int k = 0; largest > 1e-9; k++) {
      for (int i = 0; i < n; i++)
        u1[i] = u[i] + g * (v[i] + v1[i]), r[i] = (v1[i] - v[i]) / g - a[i];
      corot_mass_multiply(model, r, Ma);
      check(corot_residual(model, state, step * h, u1, v1, r));
      for (int i = 0; i < n; i++) r[i] = g * (r[i] - Ma[i]);
      if (k % 4 == 0) { /* a new matrix, and another after each four iterations that did not do */
        if (k == 12) check(corot_fail(COROT_EINTEGRATE, "step %d does not converge", step));
        check(corot_pencil_assemble(pencil, step * h, u1, v1));
        corot_pencil_combine(pencil, 1, g, g * g);
        check(corot_pencil_factor(pencil));
      }
      check(corot_pencil_solve(pencil, r, r));
      largest = 0;
      for (int i = 0; i < n; i++) v1[i] += r[i], largest = fmax(largest, fabs(r[i])); /* [m/s] */
      niteration++;
    }
    for (int i = 0; i < n; i++) {
      a[i] = (v1[i] - v[i]) / g - a[i];
      u[i] += g * (v[i] + v1[i]);
      v[i] = v1[i];
    }
  }
  bar_print(model, u);
  fprintf(stderr, "%d steps, %d iterations by %s\n", nstep, niteration,
          corot_pencil_solver(pencil));

  free(u);
  corot_pencil_destroy(pencil);
  corot_state_destroy(state);
  corot_model_destroy(model);
}
