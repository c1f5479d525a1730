/* Lobatto's rules of integration, and the integrals of polynomials through points. */
#include "lobatto.h"

static const lobatto_point rules[LOBATTO_MOST - 1][LOBATTO_MOST] = {
    {{0, 1. / 2}, {1, 1. / 2}},
    {{0, 1. / 6}, {0.5, 2. / 3}, {1, 1. / 6}},
    {{0, 1. / 12}, {0.2763932022500210, 5. / 12}, {0.7236067977499790, 5. / 12}, {1, 1. / 12}},
    {{0, 1. / 20},
     {0.1726731646460115, 49. / 180},
     {0.5, 16. / 45},
     {0.8273268353539885, 49. / 180},
     {1, 1. / 20}},
};

const lobatto_point *corot_lobatto(int npoint) { return rules[npoint - 2]; }

int corot_lobatto_points(int order) {
  return order <= 2 ? 2 : order <= 4 ? 3 : order <= 6 ? 4 : LOBATTO_MOST;
}

static double lagrange(int n, const double *x, int k, double at) {
  double value = 1;
  for (int i = 0; i < n; i++)
    if (i != k) value *= (at - x[i]) / (x[k] - x[i]);
  return value;
}

/* By the rule of order 4 or 6, which is exact for a degree below 6. */
double corot_lagrange_integral(int n, const double *x, int k, double a, double b) {
  int npoint = n <= 4 ? 3 : 4;
  const lobatto_point *rule = corot_lobatto(npoint);
  double sum = 0;
  for (int j = 0; j < npoint; j++)
    sum += rule[j].weight * lagrange(n, x, k, a + (b - a) * rule[j].x);
  return (b - a) * sum;
}

double corot_lagrange_slope(int n, const double *x, int k, int j) {
  double sum = 0;
  for (int i = 0; i < n; i++) {
    if (i == k) continue;
    double product = 1 / (x[k] - x[i]);
    for (int l = 0; l < n; l++)
      if (l != k && l != i) product *= (x[j] - x[l]) / (x[k] - x[l]);
    sum += product;
  }
  return sum;
}
