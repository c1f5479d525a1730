/* Lobatto's rules of integration, and the integrals of polynomials through points. */
#ifndef COROT_SOLVE_INTEGRATE_MULTISTEP_LOBATTO_H
#define COROT_SOLVE_INTEGRATE_MULTISTEP_LOBATTO_H

enum { LOBATTO_MOST = 5 }; /* points */

typedef struct lobatto_point {
  double x, weight; /* on (0, 1) */
} lobatto_point;

/* The rule of npoint points, 2 to LOBATTO_MOST. The ends are among them; its order is
   2 npoint - 2. */
const lobatto_point *corot_lobatto(int npoint);

/* Points of the shortest rule of this order or a higher one, as far as there is one. */
int corot_lobatto_points(int order);

/* The integral from a to b of the polynomial that is 1 at x[k] and 0 at the other points of x [n],
   n <= LOBATTO_MOST. */
double corot_lagrange_integral(int n, const double *x, int k, double a, double b);

/* The derivative of that polynomial at x[j]. */
double corot_lagrange_slope(int n, const double *x, int k, int j);

#endif
