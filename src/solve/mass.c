#include <stdlib.h>

#include "solve/linsol.h"

struct corot_mass_solver {
  int n;
  const double *lumped; /* [n] */
};

corot_status corot_mass_solver_create(const corot_model *model, corot_mass_solver **solver) {
  corot_mass_solver *s = calloc(1, sizeof *s);
  if (!s) return corot_fail(COROT_ENOMEM, "no memory for a mass");
  s->n = corot_model_ndof(model);
  s->lumped = corot_model_mass(model);
  *solver = s;
  return COROT_OK;
}

void corot_mass_solver_destroy(corot_mass_solver *s) { free(s); }

corot_status corot_mass_solve(corot_mass_solver *s, const double *b, double *x) {
  for (int i = 0; i < s->n; i++) x[i] = b[i] / s->lumped[i];
  return COROT_OK;
}
