/* The first step of a Runge-Kutta method after r has changed: at a kink of a load, with new frames.
   If the transient that the change leaves in modes too fast for the step is more than the
   tolerance, it is as long as a radian of it. */
#include <math.h>

#include "runge_kutta.h"

/* A radian of the transient at m->start, whose rate is known [s]; infinity: it is no larger than
   the tolerance. */
static corot_status transient(runge_kutta *m, double h, double *radian) {
  driver *d = &m->driver;
  const corot_integrator *self = d->self;
  int n = corot_model_ndof(self->model);
  double delta = 1e-4 * h, weight = N_VGetArrayPointer(m->weight)[0];
  const double *v = N_VGetArrayPointer(m->start.y) + n, *a = N_VGetArrayPointer(m->start.rate) + n;
  double *change = N_VGetArrayPointer(m->error) + n;
  double *room[] = {N_VGetArrayPointer(m->slope[0]), N_VGetArrayPointer(m->slope[1]),
                    N_VGetArrayPointer(m->slope[1]) + n};
  *radian = INFINITY;
  m->inside_known = false;
  m->nfe++;
  if (corot_driver_rhs(m->start.t + delta, m->start.y, m->error, d)) return d->fatal;
  for (int i = 0; i < n; i++) change[i] = (change[i] - a[i]) / delta;
  return corot_transient(self->pencil, v, a, change, weight, room, radian);
}

corot_status corot_rk_first_step(runge_kutta *m, double *h) {
  double radian;
  const corot_pencil *p = m->driver.self->pencil;
  if (!p || !p->factored || !(*h > 0)) return COROT_OK;
  corot_status status = transient(m, *h, &radian);
  if (status == COROT_OK) *h = fmin(*h, radian);
  return sun_is_fatal(status) ? status : COROT_OK;
}
