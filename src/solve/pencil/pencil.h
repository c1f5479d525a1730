/* Inside of a pencil. */
#ifndef COROT_SOLVE_PENCIL_PENCIL_H
#define COROT_SOLVE_PENCIL_PENCIL_H

#include <corot/solve.h>

#include "solve/linsol/linsol.h"

struct corot_pencil {
  const corot_model *model;
  corot_state *state;
  int n;
  corot_role role;
  corot_tangent tangent; /* to be used */
  bool dirty;            /* K and D do not belong to the present frames, or were never assembled */
  double (*K)[9], (*D)[9]; /* [nblock] */
  double t, *u, *v;        /* [n] where they were assembled, */
  corot_tangent assembled; /* and how */
  double a, b, c;          /* of S */
  linsol chosen;
  bool tentative;       /* it is iterative, and was not asked for by name */
  long niteration;      /* of what was chosen before it */
  linsol klu;           /* made when first needed */
  const linsol *solver; /* which of them holds the factor */
  const corot_csc *csc; /* of the chosen one */
  double *S;            /* [csc->nnz] */
  double *work;         /* [2 n] */
  double gamma;         /* of S, as set by corot_sun_linsys */
  corot_pencil_counts counts;
};

/* corot_pencil_factor, and COROT_RETRY from a solver, too, that does not mind what is not positive
   definite. */
corot_status corot_pencil_factor_definite(corot_pencil *pencil);

/* What is behind the functions that SUNDIALS calls (corot_sun_*), with a corot_status as the value.

   linsys: S at (t, y) for this gamma; *made: K and D were assembled, which `keep` spares unless
   they are out of date. newton, newton_dae: x solves the Newton system of y' = f, or of F(t, y, y')
   = 0, for the residual b. */
corot_status corot_pencil_linsys(corot_pencil *pencil, double t, N_Vector y, bool keep,
                                 sunbooleantype *made, double gamma);
corot_status corot_pencil_newton(corot_pencil *pencil, N_Vector b, N_Vector x);
corot_status corot_pencil_newton_dae(corot_pencil *pencil, N_Vector b, N_Vector x);

/* ydot = (v, M^-1 r), and F = (u' - v, M v' - r). */
corot_status corot_rate(const corot_sun_data *data, double t, N_Vector y, N_Vector ydot);
corot_status corot_defect(const corot_sun_data *data, double t, N_Vector y, N_Vector yp,
                          N_Vector F);

#endif
