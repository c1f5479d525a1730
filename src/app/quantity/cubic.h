/* A column between the ends of one step: the cubic polynomial with the values and the slopes there
   (Hermite's). Of a smooth column, with exact slopes, it is off by at most h^4 / 384 times its
   fourth derivative; with slopes from neighbouring points (cubic_slope) by O(h^4) as well. */
#ifndef COROT_APP_QUANTITY_CUBIC_H
#define COROT_APP_QUANTITY_CUBIC_H

#include <stdbool.h>

/* In s = (t - t0) / h, from 0 to 1: x = c[0] + c[1] s + c[2] s^2 + c[3] s^3. h may be 0: a point.
 */
typedef struct cubic {
  double t0, t1, h; /* [s] */
  double x0, x1;    /* the values at the ends, to the last bit */
  double c[4];
} cubic;

/* From (t0, x0) to (t1, x1) with slopes dx/dt at both ends. */
cubic cubic_between(double t0, double x0, double slope0, double t1, double x1, double slope1);

double cubic_at(const cubic *p, double s);
double cubic_time(const cubic *p, double s);

/* The integral over t from s = a to b, exact. */
double cubic_integral(const cubic *p, double a, double b);

/* Cuts [a, b] where the cubic has an extreme and, if `zeros`, where it is zero: between two cuts it
   is monotone. Writes both ends and the cuts, ascending, and returns how many. */
enum { CUBIC_CUTS = 8 };
int cubic_cuts(const cubic *p, double a, double b, bool zeros, double s[CUBIC_CUTS]);

/* The slope at point k of the polynomial through n (2 to 4) points, t ascending. */
double cubic_slope(int n, const double *t, const double *x, int k);

#endif
