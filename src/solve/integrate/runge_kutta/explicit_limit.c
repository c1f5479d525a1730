/* The largest eigenvalue by power iteration, followed from step to step. */
#include "explicit_limit.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
  MOST_COEFFICIENTS = 16,
  FIRST_ITERATIONS = 40, /* of the power method */
  STEPS_BETWEEN = 25,    /* its further iterations */
};

/* A mode that grows by less in a step is left to error control: near the imaginary axis some
   methods are never quite stable. */
static const double growth = 1e-3;

struct explicit_limit {
  const corot_model *model;
  corot_state *state;
  corot_mass_solver *mass;
  int n, degree;
  double stability[MOST_COEFFICIENTS];
  double *x, *y, *none; /* [n] mode, work, zero */
  double frequency;     /* of the fastest mode, undamped [rad/s] */
  double damping;       /* v' D v / v' M v of it [1/s] */
  double ratio, reach;  /* step times frequency that is stable at this damping / frequency */
  long steps;
};

corot_status corot_explicit_limit_create(const corot_model *model, corot_state *state,
                                         corot_mass_solver *mass, int degree,
                                         const double *stability, explicit_limit **limit) {
  explicit_limit *l = calloc(1, sizeof *l);
  if (!l) return corot_fail(COROT_ENOMEM, "no memory for a stability limit");
  int n = corot_model_ndof(model);
  *l = (explicit_limit){.model = model, .state = state, .mass = mass, .n = n, .degree = degree};
  memcpy(l->stability, stability, (degree + 1) * sizeof *stability);
  l->ratio = -1;
  l->x = malloc(n * sizeof *l->x);
  l->y = malloc(n * sizeof *l->y);
  l->none = calloc(n, sizeof *l->none);
  if (!l->x || !l->y || !l->none) {
    corot_explicit_limit_destroy(l);
    return corot_fail(COROT_ENOMEM, "no memory for a mode of %d unknowns", n);
  }
  for (int i = 0; i < n; i++) l->x[i] = cos(2.4 * i); /* neighbours against each other */
  *limit = l;
  return COROT_OK;
}

void corot_explicit_limit_destroy(explicit_limit *l) {
  if (!l) return;
  free(l->x);
  free(l->y);
  free(l->none);
  free(l);
}

static double dot(int n, const double *a, const double *b) {
  double sum = 0;
  for (int i = 0; i < n; i++) sum += a[i] * b[i];
  return sum;
}

/* y = K x, or D x where `of_velocity`. */
static corot_status apply(explicit_limit *l, double t, const double *u, bool of_velocity) {
  corot_tangent tangent =
      corot_state_frames(l->state) == COROT_FRAMES_EXACT ? COROT_TANGENT_EXACT : COROT_TANGENT_HELD;
  const double *du = of_velocity ? l->none : l->x, *dv = of_velocity ? l->x : l->none;
  COROT_TRY(corot_jvp(l->model, l->state, t, u, l->none, tangent, du, dv, l->y));
  for (int i = 0; i < l->n; i++) l->y[i] = -l->y[i];
  return COROT_OK;
}

/* x' M x = 1. */
static void normalise(explicit_limit *l) {
  corot_mass_multiply(l->model, l->x, l->y);
  double length = sqrt(dot(l->n, l->x, l->y));
  for (int i = 0; i < l->n; i++) l->x[i] /= length;
}

/* The power method on M^-1 K: x = M^-1 K x, with Rayleigh's quotient of the x before. */
static corot_status iterate(explicit_limit *l, double t, const double *u) {
  COROT_TRY(apply(l, t, u, false));
  l->frequency = sqrt(fabs(dot(l->n, l->x, l->y)));
  COROT_TRY(corot_mass_solve(l->mass, l->y, l->x));
  normalise(l);
  return COROT_OK;
}

/* |R(h lambda)| of the mode whose frequency is `part` of the fastest one's, damping being
   proportional to stiffness: lambda^2 + part^2 (damping lambda + frequency^2) = 0. */
static double amplification(const explicit_limit *l, double h, double part) {
  double d = part * part * l->damping / 2, w = part * l->frequency;
  double complex z = h * (-d + csqrt(d * d - w * w)), R = 0;
  if (d > w) z = h * (-d - sqrt(d * d - w * w)); /* of two real roots the faster */
  for (int k = l->degree; k >= 0; k--) R = R * z + l->stability[k];
  return cabs(R);
}

static bool grows(const explicit_limit *l, double h) {
  for (int part = 1; part <= 20; part++)
    if (!(amplification(l, h, part / 20.0) <= 1 + growth)) return true;
  return false;
}

/* Found again only when the fastest mode is damped otherwise than before. */
static void find_reach(explicit_limit *l) {
  double ratio = l->damping / l->frequency;
  if (fabs(ratio - l->ratio) <= 0.02 * ratio) return;
  double reach = 0.02;
  while (reach > 1e-12 && grows(l, reach / l->frequency)) reach /= 2;
  while (reach < 100 && !grows(l, 1.02 * reach / l->frequency)) reach *= 1.02;
  l->reach = reach;
  l->ratio = ratio;
}

corot_status corot_explicit_limit_follow(explicit_limit *l, double t, const double *u) {
  int iterations = l->steps == 0 ? FIRST_ITERATIONS : l->steps % STEPS_BETWEEN == 0;
  if (l->steps++ == 0) normalise(l);
  if (iterations == 0) return COROT_OK;
  for (int k = 0; k < iterations; k++) COROT_TRY(iterate(l, t, u));
  COROT_TRY(apply(l, t, u, true));
  l->damping = fmax(dot(l->n, l->x, l->y), 0);
  if (l->frequency > 0) find_reach(l);
  return COROT_OK;
}

void corot_explicit_limit_exchange(pack *p, explicit_limit *l) {
  double *const number[] = {&l->frequency, &l->damping, &l->ratio, &l->reach};
  for (size_t k = 0; k < sizeof number / sizeof *number; k++) corot_pack_double(p, number[k]);
  corot_pack_long(p, &l->steps);
  corot_pack_doubles(p, l->x, (size_t)l->n);
}

double corot_explicit_limit(const explicit_limit *l) {
  return l->reach > 0 ? l->reach / l->frequency : INFINITY;
}
