/* The matrix of the next coarser level, A_c = P' A P, scaled as those of all levels are. */
#ifndef COROT_SOLVE_LINSOL_ITERATIVE_LINSOL_PROJECT_H
#define COROT_SOLVE_LINSOL_ITERATIVE_LINSOL_PROJECT_H

#include "linsol_prolong.h"

/* Scratch for one pair of levels. */
typedef struct projection {
  int n, most;  /* nodes that a column of P reaches: of the last one, and at most */
  int *node;    /* [most] these, */
  double *W;    /* [most][size][6] and A P at them */
  int *where;   /* [fine nodes] place in `node` of those that are reached */
  int *mark;    /* [fine nodes] the last column that has reached each */
  int *slot;    /* [coarse nodes] */
  double *root; /* [coarse nodes][6][6] C^-1 by rows; before, the diagonal blocks by columns */
} projection;

/* The pattern of P' A P, without its diagonal blocks, and room for its values. What is half made is
   released by clear, of both. COROT_ENOMEM. */
corot_status corot_project_create(const block_rows *A, const prolongator *P, projection *p,
                                  block_rows *coarse);
void corot_project_clear(projection *p);

/* The values, with C C' the diagonal blocks of P' A P: C^-1 (P' A P) C^-T; P becomes P C^-T, and
   the motions P->R become C' R. An unknown that nothing depends on, whose row of R is zero, has a
   one in the diagonal. Returns the aggregate whose block is not positive definite; -1: none. */
int corot_project_load(const block_rows *A, projection *p, prolongator *P, block_rows *coarse);

#endif
