/* Splits a vector by the factor of the step. */
#include "slow.h"

corot_status corot_slow_part(const corot_integrator *self, const double *x, double *y) {
  corot_pencil *p = self->pencil;
  corot_pencil_counts counts = p->counts; /* are of the steps */
  corot_mass_multiply(self->model, x, p->work);
  corot_status status = corot_pencil_solve(p, p->work, y);
  p->counts = counts;
  return status;
}
