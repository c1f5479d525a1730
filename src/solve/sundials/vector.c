/* Replaces the operations of SUNDIALS' serial vector one by one. */
#include "vector.h"

#include <math.h>
#include <nvector/nvector_serial.h>

#include "core/lanes/simd.h"
#include "solve/sundials/sun_compat.h"

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

/* Sums of (x w)^2 and of x y, in a fixed order: eight lanes, twice. */
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

COROT_CLONES static double loop_dot(long n, const double *x, const double *y) {
  vd even = vd_all(0), odd = vd_all(0);
  long i = 0;
  for (; i + 2 * W <= n; i += 2 * W) {
    even += vd_load(x + i) * vd_load(y + i);
    odd += vd_load(x + i + W) * vd_load(y + i + W);
  }
  double rest = 0;
  for (; i < n; i++) rest += x[i] * y[i];
  return vd_sum(even + odd) + rest;
}

/* --- Shared out --- */

static _Thread_local team *in_use;

team *corot_vector_share(team *by) {
  team *before = in_use;
  in_use = by;
  return before;
}

/* Shorter vectors are not worth the while. */
enum { LEAST = 1 << 13 };

/* Sums are those of segments, one after the other: as many as there would be of this length, up to
   the number below. */
enum { SEGMENT = 1 << 13, MOST_SEGMENTS = 64 };

typedef double a_sum(long n, const double *x, const double *y);

/* One operation, of which each takes a part. */
typedef struct operation {
  long n;
  int nparts;
  double a, b;
  const double *x, *y;
  double *z;
  void (*loop)(const struct operation *o, long from, long count);
  a_sum *sum;
  double part[MOST_SEGMENTS];
} operation;

static void do_part(void *work, int k) {
  const operation *o = work;
  long from = o->n * k / o->nparts, end = o->n * (k + 1) / o->nparts;
  o->loop(o, from, end - from);
}

static void each(operation *o) {
  o->nparts = o->n < LEAST ? 1 : corot_team_size(in_use);
  corot_team_run(in_use, o->nparts, do_part, o);
}

static void sum_part(void *work, int k) {
  operation *o = work;
  long from = o->n * k / o->nparts, end = o->n * (k + 1) / o->nparts;
  o->part[k] = o->sum(end - from, o->x + from, o->y + from);
}

static double add_up(long n, a_sum *sum, const double *x, const double *y) {
  operation o = {.n = n, .x = x, .y = y, .sum = sum};
  double all = 0;
  o.nparts = n / SEGMENT < MOST_SEGMENTS ? (int)(n / SEGMENT) + 1 : MOST_SEGMENTS;
  corot_team_run(in_use, o.nparts, sum_part, &o);
  for (int k = 0; k < o.nparts; k++) all += o.part[k];
  return all;
}

/* --- Operations --- */

static long length(N_Vector x) { return (long)NV_LENGTH_S(x); }
static double *data(N_Vector x) { return NV_DATA_S(x); }

static void part_of_sum(const operation *o, long at, long n) {
  loop_sum(n, o->a, o->x + at, o->b, o->y + at, o->z + at);
}

static void sum(long n, double a, const double *x, double b, const double *y, double *z) {
  operation o = {.n = n, .a = a, .x = x, .b = b, .y = y, .z = z, .loop = part_of_sum};
  each(&o);
}

static void part_of_difference(const operation *o, long at, long n) {
  loop_difference(n, o->a, o->x + at, o->y + at, o->z + at);
}

static void part_of_add_to(const operation *o, long at, long n) {
  loop_add_to(n, o->a, o->x + at, o->z + at);
}

static void part_of_scale(const operation *o, long at, long n) {
  loop_scale(n, o->a, o->x + at, o->z + at);
}

static void part_of_set(const operation *o, long at, long n) { loop_set(n, o->a, o->z + at); }

static void linear_sum(sunrealtype a, N_Vector x, sunrealtype b, N_Vector y, N_Vector z) {
  operation o = {.n = length(x), .a = a, .x = data(x), .b = b, .y = data(y), .z = data(z)};
  /* the factor after the difference: a large one must not make infinities of it */
  o.loop = a == -b ? part_of_difference : part_of_sum;
  each(&o);
}

static void scale(sunrealtype a, N_Vector x, N_Vector z) {
  operation o = {.n = length(x), .a = a, .x = data(x), .z = data(z), .loop = part_of_scale};
  each(&o);
}

static void set_all(sunrealtype a, N_Vector z) {
  operation o = {.n = length(z), .a = a, .z = data(z), .loop = part_of_set};
  each(&o);
}

static sunrealtype wrms_norm(N_Vector x, N_Vector w) {
  return sqrt(add_up(length(x), loop_square, data(x), data(w)) / (double)length(x));
}

static sunrealtype dot_product(N_Vector x, N_Vector y) {
  return add_up(length(x), loop_dot, data(x), data(y));
}

/* z = sum of c_k x_k; z may be x_0. */
static sun_status linear_combination(int count, sunrealtype *c, N_Vector *x, N_Vector z) {
  long n = length(z);
  if (count == 1) {
    scale(c[0], x[0], z);
    return 0;
  }
  sum(n, c[0], data(x[0]), c[1], data(x[1]), data(z));
  for (int k = 2; k < count; k++) {
    operation o = {.n = n, .a = c[k], .x = data(x[k]), .z = data(z), .loop = part_of_add_to};
    each(&o);
  }
  return 0;
}

/* z_k = a_k x + y_k */
static sun_status scale_add_multi(int count, sunrealtype *a, N_Vector x, N_Vector *y, N_Vector *z) {
  for (int k = 0; k < count; k++) sum(length(x), a[k], data(x), 1, data(y[k]), data(z[k]));
  return 0;
}

void corot_vector_quicken(N_Vector x) {
  x->ops->nvlinearsum = linear_sum;
  x->ops->nvscale = scale;
  x->ops->nvconst = set_all;
  x->ops->nvwrmsnorm = wrms_norm;
  x->ops->nvdotprod = dot_product;
  x->ops->nvlinearcombination = linear_combination;
  x->ops->nvscaleaddmulti = scale_add_multi;
}
