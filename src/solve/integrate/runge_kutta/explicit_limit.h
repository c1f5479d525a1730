/* How long the steps of an explicit Runge-Kutta method may be before the fastest vibration grows.
   Error control alone finds that limit again and again by a failure, and lets the noise of the
   modes beyond it into the solution. */
#ifndef COROT_SOLVE_INTEGRATE_RUNGE_KUTTA_EXPLICIT_LIMIT_H
#define COROT_SOLVE_INTEGRATE_RUNGE_KUTTA_EXPLICIT_LIMIT_H

#include <corot/solve.h>

#include "core/base/pack.h"

typedef struct explicit_limit explicit_limit;

/* `stability` [degree + 1]: the coefficients of the method's stability polynomial R(z), of at most
   degree 15. */
corot_status corot_explicit_limit_create(const corot_model *model, corot_state *state,
                                         corot_mass_solver *mass, int degree,
                                         const double *stability, explicit_limit **limit);

/* Takes NULL. */
void corot_explicit_limit_destroy(explicit_limit *limit);

/* Call this before each step: it follows the fastest vibration by an iteration now and then. Where
   that fails, the limit is the old one. */
corot_status corot_explicit_limit_follow(explicit_limit *limit, double t, const double *u);

/* Writes or reads what has been followed so far. */
void corot_explicit_limit_exchange(pack *p, explicit_limit *limit);

/* The longest stable step [s]; infinity: none was found. */
double corot_explicit_limit(const explicit_limit *limit);

#endif
