/* The coarsest matrix of a preconditioner, by the best direct solver of the build. */
#ifndef COROT_SOLVE_LINSOL_ITERATIVE_LINSOL_BOTTOM_H
#define COROT_SOLVE_LINSOL_ITERATIVE_LINSOL_BOTTOM_H

#include "solve/linsol/linsol.h"

typedef struct bottom {
  linsol s;  /* no solver where nothing is unknown */
  double *x; /* [s.csc->n] right-hand side, then solution */
} bottom;

/* A matrix of n columns without entries, and room for nnz of them. What is half made is released by
   corot_csc_destroy. */
corot_status corot_bottom_allocate(int n, corot_csc **csc);
corot_status corot_bottom_allocate_entries(int nnz, corot_csc *csc);

/* `lower` becomes its own, whatever is returned: the `source` of its entries says where among the
   values each stands. What is half made is released by clear. */
corot_status corot_bottom_create(corot_csc *lower, bottom *b);
void corot_bottom_clear(bottom *b);

/* COROT_RETRY: not positive definite; COROT_ESINGULAR. */
corot_status corot_bottom_factor(bottom *b, const double *value);
corot_status corot_bottom_solve(bottom *b);

#endif
