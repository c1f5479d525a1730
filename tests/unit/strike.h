/* Calls from one part of corot to another that fail on demand, in programs linked with --wrap for
   each of them (tests/CMakeLists.txt): the k-th call of a function, or each from the k-th on. To be
   included in one source of a program. */
#ifndef STRIKE_H
#define STRIKE_H

#include <stdio.h>

#include "check.h"
#include "core/ode/trial.h"
#include "solve/linsol/linsol.h"
#include "solve/pencil/pencil.h"

typedef enum seam {
  RESIDUAL,
  RATE,
  JACOBIAN,
  ENERGY,
  FORCE,
  PRODUCT,
  MASS_SOLVE,
  FACTOR,
  SOLVE,
  INERTIA,
  NSEAM,
} seam;

static const char *const seam_name[NSEAM] = {"residual", "rate", "Jacobian", "energy",   "force",
                                             "product",  "M^-1", "factor",   "solution", "inertia"};

static struct {
  seam where;
  long at;             /* 0: never */
  bool forever;        /* or once */
  corot_status status; /* of the call that fails */
  long count[NSEAM];   /* calls */
  long struck;         /* of these failed */
} strike;

static inline void strike_at(seam where, long at, bool forever, corot_status status) {
  memset(&strike, 0, sizeof strike);
  strike.where = where, strike.at = at, strike.forever = forever, strike.status = status;
}

static inline bool is_struck(seam here) {
  long k = ++strike.count[here];
  bool hit =
      strike.at && here == strike.where && (strike.forever ? k >= strike.at : k == strike.at);
  strike.struck += hit;
  return hit;
}

/* The real call, or a failure that leaves the outputs alone. */
#define STRIKE(here, name, parameters, arguments)                                              \
  corot_status __real_##name parameters;                                                       \
  corot_status __wrap_##name parameters;                                                       \
  corot_status __wrap_##name parameters {                                                      \
    if (is_struck(here))                                                                       \
      return corot_fail(strike.status, "struck: %s %ld", seam_name[here], strike.count[here]); \
    return __real_##name arguments;                                                            \
  }

STRIKE(RESIDUAL, corot_residual,
       (const corot_model *m, corot_state *s, double t, const double *u, const double *v,
        double *r),
       (m, s, t, u, v, r))
STRIKE(RESIDUAL, corot_residual_trial,
       (const corot_model *m, corot_state *s, double t, const double *u, const double *v,
        double *r),
       (m, s, t, u, v, r))
STRIKE(RATE, corot_rhs_trial,
       (const corot_model *m, corot_state *s, double t, const double *y, double *ydot),
       (m, s, t, y, ydot))
STRIKE(JACOBIAN, corot_jacobian,
       (const corot_model *m, corot_state *s, double t, const double *u, const double *v,
        corot_tangent tangent, double (*K)[9], double (*D)[9]),
       (m, s, t, u, v, tangent, K, D))
STRIKE(ENERGY, corot_energy,
       (const corot_model *m, corot_state *s, double t, const double *u, const double *v,
        corot_energies *e),
       (m, s, t, u, v, e))
STRIKE(FORCE, corot_elastic_force,
       (const corot_model *m, corot_state *s, double t, const double *u, double (*f)[3]),
       (m, s, t, u, f))
STRIKE(PRODUCT, corot_jvp,
       (const corot_model *m, corot_state *s, double t, const double *u, const double *v,
        corot_tangent tangent, const double *du, const double *dv, double *jv),
       (m, s, t, u, v, tangent, du, dv, jv))
STRIKE(MASS_SOLVE, corot_mass_solve, (corot_mass_solver * s, const double *b, double *x), (s, b, x))
STRIKE(FACTOR, corot_pencil_factor, (corot_pencil * p), (p))
STRIKE(SOLVE, corot_pencil_solve, (corot_pencil * p, const double *b, double *x), (p, b, x))
STRIKE(INERTIA, corot_inertia, (const corot_csc *A, const double *value, int *negative),
       (A, value, negative))

#endif
