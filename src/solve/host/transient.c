/* What a change of r leaves in modes too fast for a step of an implicit method: error control may
   see nothing of it, for the method damps it, and so does the embedded one. By the matrix of the
   last set-up, S = M + g D + g^2 K, F = S^-1 M, a factor 1 / (1 + (g w)^2), it is

     w_u = (I - F) g^2 F M^-1 r               how far u is from balance with the load,
     w_v = (I - F) v - g^2 S^-1 dr/dt         how far v is from following it;

   its amplitude squared is w_u^2 + (w_v / w)^2, with g^2 F for 1 / w^2. */
#include <math.h>

#include "host.h"
#include "solve/pencil/pencil.h"

static double product(int n, const double *x, const double *y) {
  double sum = 0;
  for (int i = 0; i < n; i++) sum += x[i] * y[i];
  return sum;
}

/* x [n] = g^2 F a, less its slow part. */
static corot_status imbalance(corot_pencil *p, const double *a, double *x, double *room) {
  int n = p->n;
  double g = p->gamma;
  COROT_TRY(corot_pencil_slow_part(p, a, x));
  COROT_TRY(corot_pencil_slow_part(p, x, room));
  for (int i = 0; i < n; i++) x[i] = g * g * (x[i] - room[i]);
  return COROT_OK;
}

/* x [n] = the fast part of v, less what follows the load: `change` is M^-1 dr/dt. */
static corot_status excess(corot_pencil *p, const double *v, const double *change, double *x,
                           double *room) {
  int n = p->n;
  double g = p->gamma;
  COROT_TRY(corot_pencil_slow_part(p, v, x));
  COROT_TRY(corot_pencil_slow_part(p, change, room));
  for (int i = 0; i < n; i++) x[i] = v[i] - x[i] - g * g * room[i];
  return COROT_OK;
}

corot_status corot_transient(corot_pencil *p, const double *v, const double *a,
                             const double *change, double weight, double *const room[3],
                             double *radian) {
  int n = p->n;
  double g = p->gamma, *w = room[1], *Fw = room[2];
  *radian = INFINITY;
  COROT_TRY(imbalance(p, a, w, room[0]));
  double square = product(n, w, w), rate = product(n, w, a);
  COROT_TRY(excess(p, v, change, w, room[0]));
  COROT_TRY(corot_pencil_slow_part(p, w, Fw));
  square += g * g * product(n, w, Fw), rate += product(n, w, w);
  if (square > 0 && rate > 0 && sqrt(square / n) * weight > 0.5) *radian = sqrt(square / rate);
  return COROT_OK;
}
