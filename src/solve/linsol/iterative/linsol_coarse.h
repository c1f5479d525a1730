/* Level 0 of a refined mesh: the coarse end of preconditioners. It is solved directly, or where it
   is large, by one V-cycle of algebraic multigrid. */
#ifndef COROT_SOLVE_LINSOL_ITERATIVE_LINSOL_COARSE_H
#define COROT_SOLVE_LINSOL_ITERATIVE_LINSOL_COARSE_H

#include "linsol_bottom.h"
#include "linsol_galerkin.h"

typedef struct coarse_level {
  const galerkin_level *level;
  const int *slot; /* of the node_matrix */
  bottom bottom;   /* of the unknowns that are free; or all that follows, and none */
  corot_csc *csc;  /* their lower triangle */
  double *value;   /* [csc->nnz] */
  node_matrix A;   /* the same by blocks */
  void *amg;
} coarse_level;

/* `csc` and A are those of the finest level: the unknowns of level 0 are their first ones. A, the
   level and plan->x are needed afterwards. What is half made is released by clear. */
corot_status corot_coarse_create(const corot_csc *csc, const node_matrix *A,
                                 const galerkin_level *level, const linsol_plan *plan,
                                 coarse_level *c);
void corot_coarse_clear(coarse_level *c);

/* Of the values that the level has now. COROT_RETRY: not positive definite; COROT_ESINGULAR. */
corot_status corot_coarse_factor(coarse_level *c);

/* v [level->n] becomes A_0^-1 v, or what a V-cycle makes of it, and zero where it is held. */
corot_status corot_coarse_solve(coarse_level *c, double (*v)[3]);

#endif
