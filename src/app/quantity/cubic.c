/* Cubic polynomials over a step. */
#include "cubic.h"

#include <math.h>

cubic cubic_between(double t0, double x0, double slope0, double t1, double x1, double slope1) {
  double h = t1 - t0, d = x1 - x0, a = h * slope0, b = h * slope1;
  return (cubic){.t0 = t0,
                 .t1 = t1,
                 .h = h,
                 .x0 = x0,
                 .x1 = x1,
                 .c = {x0, a, 3 * d - 2 * a - b, a + b - 2 * d}};
}

double cubic_at(const cubic *p, double s) {
  if (s == 0) return p->x0;
  if (s == 1) return p->x1;
  return p->c[0] + s * (p->c[1] + s * (p->c[2] + s * p->c[3]));
}

double cubic_time(const cubic *p, double s) { return s == 1 ? p->t1 : p->t0 + s * p->h; }

/* Simpson's rule, which is exact for cubics. */
double cubic_integral(const cubic *p, double a, double b) {
  double sum = cubic_at(p, a) + 4 * cubic_at(p, (a + b) / 2) + cubic_at(p, b);
  return p->h * (b - a) / 6 * sum;
}

/* --- Cuts --- */

static void insert(double s[CUBIC_CUTS], int *n, double value) {
  int k = (*n)++;
  for (; k > 0 && s[k - 1] > value; k--) s[k] = s[k - 1];
  s[k] = value;
}

/* The zeros of the derivative c1 + 2 c2 s + 3 c3 s^2 within (a, b), by the formula that does not
   cancel. */
static int extremes(const cubic *p, double a, double b, double s[2]) {
  double A = 3 * p->c[3], B = p->c[2], C = p->c[1], root = B * B - A * C, candidate[2];
  if (!(root >= 0)) return 0;
  double q = -(B + copysign(sqrt(root), B));
  candidate[0] = q / A; /* infinite or no number where A = 0: not within */
  candidate[1] = C / q;
  int n = 0;
  for (int k = 0; k < 2; k++)
    if (candidate[k] > a && candidate[k] < b) s[n++] = candidate[k];
  return n;
}

static bool changes_sign(double x, double y) { return (x < 0 && y > 0) || (x > 0 && y < 0); }

/* The zero between two s where the signs differ: halved until there is nothing between them. */
static double zero_between(const cubic *p, double a, double b) {
  bool below = cubic_at(p, a) < 0;
  for (double middle = (a + b) / 2; middle > a && middle < b; middle = (a + b) / 2) {
    if ((cubic_at(p, middle) < 0) == below)
      a = middle;
    else
      b = middle;
  }
  return a;
}

int cubic_cuts(const cubic *p, double a, double b, bool zeros, double s[CUBIC_CUTS]) {
  double extreme[2];
  int n = 0, nextreme = extremes(p, a, b, extreme);
  insert(s, &n, a);
  for (int k = 0; k < nextreme; k++) insert(s, &n, extreme[k]);
  insert(s, &n, b);
  if (!zeros) return n;
  double end[4];
  int nend = n;
  for (int k = 0; k < nend; k++) end[k] = s[k];
  for (int k = 0; k + 1 < nend; k++)
    if (changes_sign(cubic_at(p, end[k]), cubic_at(p, end[k + 1])))
      insert(s, &n, zero_between(p, end[k], end[k + 1]));
  return n;
}

/* --- Slopes --- */

/* The derivative of Lagrange's interpolation at point k: with w_i = prod_(j != i) (t_i - t_j), it
   is sum_(i != k) (w_k / w_i) (x_i - x_k) / (t_k - t_i). */
double cubic_slope(int n, const double *t, const double *x, int k) {
  double w[4], slope = 0;
  for (int i = 0; i < n; i++) {
    w[i] = 1;
    for (int j = 0; j < n; j++)
      if (j != i) w[i] *= t[i] - t[j];
  }
  for (int i = 0; i < n; i++)
    if (i != k) slope += w[k] / w[i] * (x[i] - x[k]) / (t[k] - t[i]);
  return slope;
}
