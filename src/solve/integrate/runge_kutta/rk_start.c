/* The first step of a Runge-Kutta method after r has changed: at a kink of a load, with new frames.

   Of a transient in modes too fast for a step error control may see nothing: the method damps it,
   and so does the embedded one. So what the change leaves in these modes is estimated by the matrix
   of the last set-up, S = M + g D + g^2 K, F = S^-1 M, a factor 1 / (1 + (g w)^2):

     w_u = (I - F) g^2 F M^-1 r               how far u is from balance with the load,
     w_v = (I - F) v - g^2 S^-1 dr/dt         how far v is from following it;

   its amplitude squared is w_u^2 + (w_v / w)^2, with g^2 F for 1 / w^2. If that is more than the
   tolerance, the first step is as long as a radian of it. */
#include <math.h>

#include "runge_kutta.h"

static double product(int n, const double *x, const double *y) {
  double sum = 0;
  for (int i = 0; i < n; i++) sum += x[i] * y[i];
  return sum;
}

/* x [n] = g^2 F a, less its slow part. */
static corot_status imbalance(const corot_integrator *self, const double *a, double *x,
                              double *room) {
  int n = corot_model_ndof(self->model);
  double g = self->pencil->gamma;
  COROT_TRY(corot_pencil_slow_part(self->pencil, a, x));
  COROT_TRY(corot_pencil_slow_part(self->pencil, x, room));
  for (int i = 0; i < n; i++) x[i] = g * g * (x[i] - room[i]);
  return COROT_OK;
}

/* x [n] = the fast part of v, less what follows the load: `change` is M^-1 dr/dt. */
static corot_status excess(const corot_integrator *self, const double *v, const double *change,
                           double *x, double *room) {
  int n = corot_model_ndof(self->model);
  double g = self->pencil->gamma;
  COROT_TRY(corot_pencil_slow_part(self->pencil, v, x));
  COROT_TRY(corot_pencil_slow_part(self->pencil, change, room));
  for (int i = 0; i < n; i++) x[i] = v[i] - x[i] - g * g * room[i];
  return COROT_OK;
}

/* A radian of the transient at m->start, whose rate is known [s]; infinity: it is no larger than
   the tolerance. */
static corot_status transient(runge_kutta *m, double h, double *radian) {
  driver *d = &m->driver;
  const corot_integrator *self = d->self;
  int n = corot_model_ndof(self->model);
  double g = self->pencil->gamma, delta = 1e-4 * h, weight = N_VGetArrayPointer(m->weight)[0];
  const double *v = N_VGetArrayPointer(m->start.y) + n, *a = N_VGetArrayPointer(m->start.rate) + n;
  double *change = N_VGetArrayPointer(m->error) + n, *room = N_VGetArrayPointer(m->slope[0]);
  double *w = N_VGetArrayPointer(m->slope[1]), *Fw = w + n;
  *radian = INFINITY;
  m->inside_known = false;
  m->nfe++;
  if (corot_driver_rhs(m->start.t + delta, m->start.y, m->error, d)) return d->fatal;
  for (int i = 0; i < n; i++) change[i] = (change[i] - a[i]) / delta;

  COROT_TRY(imbalance(self, a, w, room));
  double square = product(n, w, w), rate = product(n, w, a);
  COROT_TRY(excess(self, v, change, w, room));
  COROT_TRY(corot_pencil_slow_part(self->pencil, w, Fw));
  square += g * g * product(n, w, Fw), rate += product(n, w, w);
  if (square > 0 && rate > 0 && sqrt(square / n) * weight > 0.5) *radian = sqrt(square / rate);
  return COROT_OK;
}

corot_status corot_rk_first_step(runge_kutta *m, double *h) {
  double radian;
  if (!m->driver.self->pencil || !(*h > 0)) return COROT_OK;
  corot_status status = transient(m, *h, &radian);
  if (status == COROT_OK) *h = fmin(*h, radian);
  return sun_is_fatal(status) ? status : COROT_OK;
}
