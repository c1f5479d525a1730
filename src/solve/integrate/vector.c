/* Replaces the operations of SUNDIALS' serial vector one by one. */
#include "vector.h"

#include <math.h>
#include <nvector/nvector_serial.h>

#include "core/lanes/simd.h"
#include "solve/pencil/sun_compat.h"

/* Outputs may be inputs, entry by entry. */
#if defined(__clang__)
#define INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#elif defined(__GNUC__)
#define INDEPENDENT _Pragma("GCC ivdep")
#else
#define INDEPENDENT
#endif

COROT_CLONES static void loop_sum(long n, double a, const double *x, double b, const double *y,
                                  double *z) {
  INDEPENDENT
  for (long i = 0; i < n; i++) z[i] = a * x[i] + b * y[i];
}

COROT_CLONES static void loop_difference(long n, double a, const double *x, const double *y,
                                         double *z) {
  INDEPENDENT
  for (long i = 0; i < n; i++) z[i] = a * (x[i] - y[i]);
}

COROT_CLONES static void loop_add_to(long n, double a, const double *x, double *z) {
  INDEPENDENT
  for (long i = 0; i < n; i++) z[i] += a * x[i];
}

COROT_CLONES static void loop_scale(long n, double a, const double *x, double *z) {
  INDEPENDENT
  for (long i = 0; i < n; i++) z[i] = a * x[i];
}

COROT_CLONES static void loop_set(long n, double a, double *z) {
  for (long i = 0; i < n; i++) z[i] = a;
}

/* Sum of (x w)^2, in a fixed order: eight lanes, twice. */
COROT_CLONES static double loop_square(long n, const double *x, const double *w) {
  vd even = vd_all(0), odd = vd_all(0);
  long i = 0;
  for (; i + 2 * W <= n; i += 2 * W) {
    vd a = vd_load(x + i) * vd_load(w + i), b = vd_load(x + i + W) * vd_load(w + i + W);
    even += a * a, odd += b * b;
  }
  double rest = 0;
  for (; i < n; i++) rest += x[i] * w[i] * (x[i] * w[i]);
  return vd_sum(even + odd) + rest;
}

static long length(N_Vector x) { return (long)NV_LENGTH_S(x); }
static double *data(N_Vector x) { return NV_DATA_S(x); }

static void linear_sum(sunrealtype a, N_Vector x, sunrealtype b, N_Vector y, N_Vector z) {
  if (a == -b) /* the factor after the difference: a large one must not make infinities of it */
    loop_difference(length(x), a, data(x), data(y), data(z));
  else
    loop_sum(length(x), a, data(x), b, data(y), data(z));
}

static void scale(sunrealtype a, N_Vector x, N_Vector z) {
  loop_scale(length(x), a, data(x), data(z));
}

static void set_all(sunrealtype a, N_Vector z) { loop_set(length(z), a, data(z)); }

static sunrealtype wrms_norm(N_Vector x, N_Vector w) {
  return sqrt(loop_square(length(x), data(x), data(w)) / (double)length(x));
}

/* z = sum of c_k x_k; z may be x_0. */
static sun_status linear_combination(int count, sunrealtype *c, N_Vector *x, N_Vector z) {
  long n = length(z);
  if (count == 1) {
    loop_scale(n, c[0], data(x[0]), data(z));
    return 0;
  }
  loop_sum(n, c[0], data(x[0]), c[1], data(x[1]), data(z));
  for (int k = 2; k < count; k++) loop_add_to(n, c[k], data(x[k]), data(z));
  return 0;
}

/* z_k = a_k x + y_k */
static sun_status scale_add_multi(int count, sunrealtype *a, N_Vector x, N_Vector *y, N_Vector *z) {
  for (int k = 0; k < count; k++) loop_sum(length(x), a[k], data(x), 1, data(y[k]), data(z[k]));
  return 0;
}

void corot_vector_quicken(N_Vector x) {
  x->ops->nvlinearsum = linear_sum;
  x->ops->nvscale = scale;
  x->ops->nvconst = set_all;
  x->ops->nvwrmsnorm = wrms_norm;
  x->ops->nvlinearcombination = linear_combination;
  x->ops->nvscaleaddmulti = scale_add_multi;
}
