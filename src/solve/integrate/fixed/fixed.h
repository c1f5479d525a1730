/* Inside of the methods of constant step.

   Each step is one nonlinear system for an unknown w, a velocity or an acceleration,

     G(w) = s M (w - W) - k r(t, U + p w, V + q w) = 0,   G' = s M + k q D + k p K,

   and a formula that makes the new state of it:

     BDF             w = v_1:  u = U + g v_1, v = v_1; s = 1, k = p = g, q = 1
     midpoint        w = v at t + h/2: backward Euler over h/2, then the state is mirrored in it
     Newmark family  w = a_1:  p = (1 - af) beta h^2, q = (1 - af) gamma h, s = 1 - am, k = 1

   (Newmark 1959; Hilber, Hughes & Taylor 1977; Chung & Hulbert 1993.) */
#ifndef COROT_SOLVE_INTEGRATE_FIXED_FIXED_H
#define COROT_SOLVE_INTEGRATE_FIXED_FIXED_H

#include "solve/integrate/integrator.h"

/* Coefficients of a step's system, and the time its force is evaluated at. */
typedef struct stage {
  double t, s, k, p, q;
} stage;

typedef struct fixed fixed;

typedef struct scheme {
  const char *name;
  int order; /* of a BDF formula; 0: other */
  bool needs_acceleration;
  /* Coefficients, U, V, W and the predictor w of the next step. */
  void (*prepare)(fixed *f, stage *g);
  /* The new u, v in u[0], v[0] from w, the old ones having moved to u[1], v[1]. */
  void (*finish)(fixed *f);
  /* Sets am and af from the spectral radius rho; NULL: they are zero. */
  void (*means)(fixed *f, double rho);
} scheme;

enum { NHISTORY = 4, NVECTOR = 2 * NHISTORY + 11 };

struct fixed {
  const scheme *scheme;
  const double *lumped; /* [n] the lumped mass */
  int n;
  double t0, h; /* t = t0 + count h */
  long count;
  int depth; /* states known since the start or a restart, the present one included */
  double am, af, beta, gamma;            /* of the Newmark family */
  double *u[NHISTORY], *v[NHISTORY];     /* [n] present and earlier states, latest first */
  double *a;                             /* [n] acceleration of the Newmark family, */
  double *r;                             /* [n] r where it is, */
  bool r_known;                          /* at the start and with inputs */
  double *U, *V, *W, *w, *trial, *G, *d; /* [n] of the stage */
  double *apart, *inertia;               /* [n] trial - W and M times that */
  double *memory;
  stage factored;                        /* coefficients the factor belongs to; s = 0: none */
  double power[2], work[2], old_work[2]; /* dissipated and external: rate and integral at t */
  corot_statistics counts;
};

/* The scheme of that name; NULL: there is none. */
const scheme *corot_scheme_find(const char *name);

/* The Newmark family's constants from the spectral radius rho at infinite frequency: 1 no numerical
   damping, 0 most. HHT: rho = (1 - alpha) / (1 + alpha), alpha up to 1/3. */
void corot_scheme_set_family(fixed *f, double rho);

#endif
