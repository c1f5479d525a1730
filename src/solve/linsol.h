/* Linear solvers behind one interface, found by name. */
#ifndef COROT_SOLVE_LINSOL_H
#define COROT_SOLVE_LINSOL_H

#include <corot/solve.h>
#include <stdbool.h>

typedef struct linsol_ops {
  const char *name;
  corot_triangle triangle; /* the part of the matrix it reads */

  /* Symbolic analysis, once; `pattern` is borrowed for the solver's life. */
  corot_status (*create)(const corot_csc *pattern, void **solver);
  /* Numeric factorisation of value [nnz]; *fresh: the pivots were chosen anew. COROT_RETRY: not
     positive definite; COROT_ESINGULAR: no pivot. */
  corot_status (*factor)(void *solver, const double *value, bool *fresh);
  /* x [n] becomes A^-1 x. */
  corot_status (*solve)(void *solver, double *x);
  void (*destroy)(void *solver);

  /* Of iterative solvers; else NULL: the relative residual to reach, and iterations so far. */
  void (*set_tolerance)(void *solver, double tolerance);
  long (*iterations)(const void *solver);
} linsol_ops;

extern const linsol_ops corot_linsol_klu;
extern const linsol_ops corot_linsol_pcg;
#ifdef COROT_HAVE_CHOLMOD
extern const linsol_ops corot_linsol_cholmod;
#endif

/* The solver of that name; "auto" picks by the number n of unknowns. */
corot_status corot_linsol_find(const char *name, int n, const linsol_ops **ops);

#endif
