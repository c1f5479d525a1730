/* Slow and fast: what a step of an implicit method resolves, and what it does not. */
#ifndef COROT_SOLVE_INTEGRATE_RUNGE_KUTTA_SLOW_H
#define COROT_SOLVE_INTEGRATE_RUNGE_KUTTA_SLOW_H

#include "solve/integrate/integrator.h"

/* y = S^-1 M x [n] by the pencil's latest factor, S = M + g D + g^2 K: x where a mode is slow,
   g w small, and x / (g w)^2 where it is fast. y may be x. */
corot_status corot_slow_part(const corot_integrator *self, const double *x, double *y);

#endif
