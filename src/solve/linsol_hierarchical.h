/* The preconditioner of the hierarchical basis u = T y of a refined mesh (Yserentant, Numer. Math.
   49, 1986; corot/hierarchy.h): M^-1 = T D^-1 T', where D is what the matrix in that basis, T' A T,
   has on level 0, and of each later node its own 3x3 block. Level 0 is factored. */
#ifndef COROT_SOLVE_LINSOL_HIERARCHICAL_H
#define COROT_SOLVE_LINSOL_HIERARCHICAL_H

#include "solve/linsol_coarse.h"

typedef struct hierarchical {
  const node_matrix *A; /* borrowed, as is its pattern: */
  const corot_csc *csc;
  galerkin levels;
  coarse_level coarse;
  double (*inverse)[9]; /* [nodes not of level 0] of their blocks of D */
  double (*v)[3];       /* [nodes + 1] the last stands for all that are wholly held */
} hierarchical;

/* The refinement is not needed afterwards, csc and A are. What is half made is released by clear.
 */
corot_status corot_hierarchical_create(const corot_csc *csc, const node_matrix *A,
                                       const corot_refinement *refinement, hierarchical *h);
void corot_hierarchical_clear(hierarchical *h);

/* Of the values that A has now, not scaled. COROT_RETRY: not positive definite; COROT_ESINGULAR. */
corot_status corot_hierarchical_factor(hierarchical *h);

/* z = M^-1 r [3 nodes]; z may be r. */
corot_status corot_hierarchical_apply(hierarchical *h, const double *r, double *z);

#endif
