/* Inside of a pencil. */
#ifndef COROT_SOLVE_PENCIL_H
#define COROT_SOLVE_PENCIL_H

#include <corot/solve.h>

#include "solve/linsol.h"

struct corot_pencil {
  const corot_model *model;
  corot_state *state;
  int n;
  corot_role role;
  corot_tangent tangent; /* to be used */
  bool dirty;            /* K and D do not belong to the present frames, or were never assembled */
  double (*K)[9], (*D)[9]; /* [nblock] */
  double t, *u;            /* [n] where they were assembled, */
  corot_tangent assembled; /* and how */
  double a, b, c;          /* of S */
  linsol chosen;
  linsol klu;           /* made when first needed */
  const linsol *solver; /* which of them holds the factor */
  const corot_csc *csc; /* of the chosen one */
  double *S;            /* [csc->nnz] */
  double *work;         /* [2 n] */
  double gamma;         /* of S, as set by corot_sun_linsys */
  corot_pencil_counts counts;
};

/* The solve operation of corot_sun_linsol_dae. */
int corot_sun_solve_dae(SUNLinearSolver LS, SUNMatrix A, N_Vector x, N_Vector b, sunrealtype tol);

#endif
