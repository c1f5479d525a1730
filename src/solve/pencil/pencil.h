/* Inside of a pencil. */
#ifndef COROT_SOLVE_PENCIL_PENCIL_H
#define COROT_SOLVE_PENCIL_PENCIL_H

#include <corot/solve.h>

#include "core/base/pack.h"
#include "core/base/sisters.h"
#include "solve/linsol/linsol.h"

struct corot_pencil {
  const corot_model *model;
  corot_state *state;
  int n;
  corot_role role;
  corot_tangent tangent;          /* to be used */
  bool known, combined, factored; /* K and D have been assembled; S made of them; and factored */
  bool dirty; /* K and D do not belong to the present frames, or were never assembled */
  double (*K)[9], (*D)[9]; /* [nblock] */
  double t, *u, *v;        /* [n] where they were assembled, */
  corot_tangent assembled; /* and how */
  double a, b, c;          /* of S */
  linsol chosen;
  bool tentative;       /* it is iterative, and was not asked for by name */
  linsol set_aside;     /* what was chosen before it and did not do; without a solver: nothing */
  long niteration;      /* of what was chosen before, and, where a state was taken in, by then */
  long origin;          /* iterations of the chosen one that do not count any more */
  linsol klu;           /* made when first needed */
  const linsol *solver; /* which of them holds the factor */
  const corot_csc *csc; /* of the chosen one */
  double *S;            /* [csc->nnz] */
  double *work;         /* [2 n] */
  double gamma;         /* b, which is gamma where S is that of a step */
  double aim;           /* of an iterative solver; 0: the definition's */
  corot_pencil_counts counts;
};

/* COROT_EINVAL: it is NULL. `who` is the function that a host called. */
corot_status corot_pencil_check(const corot_pencil *pencil, const char *who);

/* K once more, where it was assembled, with another derivative of the frames. */
corot_status corot_pencil_assemble_again(corot_pencil *pencil, corot_tangent tangent);

/* Writes or reads which of the solvers is in use, and the counts. */
COROT_SISTERS void corot_pencil_exchange(pack *p, corot_pencil *pencil);

/* Makes the pencil one that was just created, but for what corot_pencil_exchange knows: matrices
   and factors are gone, pivots, too; the analysis stays. */
COROT_SISTERS void corot_pencil_forget(corot_pencil *pencil);

/* corot_pencil_factor, and COROT_RETRY from a direct solver, too, that does not mind what is not
   positive definite. An iterative one sees that later, if it has to: as it solves. */
COROT_SISTERS corot_status corot_pencil_factor_definite(corot_pencil *pencil);

/* The same, and an iterative solver makes sure. *known: whether it could; if not, its iteration
   does not converge. */
COROT_SISTERS corot_status corot_pencil_factor_proved(corot_pencil *pencil, bool *known);

/* Factor and solution of K = S(0, 0, 1) as it was assembled; where K is not positive definite a
   clamped one takes its place. That leads downhill in the energy, so that Newton's iteration does
   not end on an unstable equilibrium beside a stable one. */
COROT_SISTERS corot_status corot_pencil_factor_downhill(corot_pencil *pencil);
COROT_SISTERS corot_status corot_pencil_solve_downhill(corot_pencil *pencil, const double *b,
                                                       double *x);

/* The relative residual of solutions from now on, of an iterative solver; 0: the definition's. */
COROT_SISTERS void corot_pencil_aim(corot_pencil *pencil, double tolerance);

/* y = S^-1 M x [n] by the latest factor, S = M + g D + g^2 K: x where a mode is slow, g w small,
   and x / (g w)^2 where it is fast: what a step of an implicit method resolves. y may be x. */
COROT_SISTERS corot_status corot_pencil_slow_part(corot_pencil *pencil, const double *x, double *y);

/* What is behind corot_sun_linsys: S at (t, y) for this gamma; *made: K and D were assembled, which
   `keep` spares unless they are out of date. */
COROT_SISTERS corot_status corot_pencil_linsys(corot_pencil *pencil, double t, N_Vector y,
                                               bool keep, sunbooleantype *made, double gamma);

/* ydot = (v, M^-1 r), and F = (u' - v, M v' - r). */
COROT_SISTERS corot_status corot_rate(const corot_sun_data *data, double t, N_Vector y,
                                      N_Vector ydot);
COROT_SISTERS corot_status corot_defect(const corot_sun_data *data, double t, N_Vector y,
                                        N_Vector yp, N_Vector F);

#endif
