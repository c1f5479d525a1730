/* A symmetric matrix by 3x3 blocks, one row of blocks for each node that has a free component, as
   the preconditioners of conjugate gradients see it:

     A = C (D + L + L') C'

   with C block diagonal, so chosen that the preconditioner becomes M = C C' (block Jacobi: D = I)
   or M = C (I + L)(I + L') C' (incomplete Cholesky of level 0), or C = I. Vectors are [3 n]; a
   component that is held has a one in the diagonal and zeros elsewhere.

   Where the nodes stand in domains, a team sweeps through these at the same time. What the nodes
   between them have from domains they gather, row by row; so all sums have one order. */
#ifndef COROT_SOLVE_LINSOL_ITERATIVE_LINSOL_NODES_H
#define COROT_SOLVE_LINSOL_ITERATIVE_LINSOL_NODES_H

#include <corot/ode.h>
#include <stdbool.h>

#include "core/base/team.h"
#include "linsol_domains.h"

typedef struct node_matrix {
  int n;              /* nodes */
  const int *unknown; /* [unknowns] the caller's number of each, borrowed; NULL: they are these */
  team *team;         /* who shares the loops out; NULL: nobody */
  domains parts;      /* of the nodes; one, unless they were asked for */
  int *slot;          /* [unknowns] where a vector [3 n] has each of them: 3 node + component */
  int *colptr, *row;  /* [n + 1], [nbelow]: blocks of L by columns, rows ascending */
  int *place;         /* [csc->nnz] where in `value` each entry goes */
  double *value;      /* blocks of 9 by columns: D [n], then L [nbelow]; 3 more to read beyond */
  double *C, *Cinv;   /* [n][9] lower triangular, row-major */
  double (*work)[4];  /* [2 n] */

  /* With several domains: */
  int *inner;      /* [parts.first[parts.n]] the end of a column's blocks in rows of its domain */
  int *left_first; /* [n - parts.first[parts.n] + 1] and of each row between domains the blocks */
  int *left;       /* in columns of domains, */
  int *left_node;  /* and these columns, ascending */
} node_matrix;

/* `csc`: a lower triangle, with its `source`. The nodes are in its order, or `by_domains`. What is
   half made is released by clear. */
corot_status corot_nodes_create(const corot_csc *csc, bool by_domains, node_matrix *A);
void corot_nodes_clear(node_matrix *A);

/* Takes the values of a csc, C = I. */
void corot_nodes_load(node_matrix *A, const corot_csc *csc, const double *value);

/* C = I for the values that are loaded from now on, unless they are scaled. */
void corot_nodes_keep(node_matrix *A);

/* Makes C and scales by it. False: a pivot was not positive, at node *at; load anew. */
bool corot_nodes_jacobi(node_matrix *A, int *at);

/* The off-diagonal blocks of the incomplete factor are those of A; its diagonal ones are what the
   elimination makes of those of A times 1 + shift, fill being dropped. */
bool corot_nodes_cholesky(node_matrix *A, double shift, int *at);

/* y = (D + L + L') x; they may not overlap. */
void corot_nodes_multiply(node_matrix *A, const double *x, double *y);

/* y = (I + L)^-1 (D + L + L') (I + L')^-1 x, for the price of one product (Eisenstat 1981). */
void corot_nodes_sandwich(node_matrix *A, const double *x, double *y);

/* x becomes (I + L)^-1 x or (I + L')^-1 x. */
void corot_nodes_forward(node_matrix *A, double *x);
void corot_nodes_backward(node_matrix *A, double *x);

/* x becomes C^-1 x or C^-T x. */
void corot_nodes_scale(const node_matrix *A, double *x);
void corot_nodes_unscale_transposed(const node_matrix *A, double *x);

/* |C x| */
double corot_nodes_unscaled_norm(const node_matrix *A, const double *x);

/* |C |A| |x|| eps: what rounding alone may leave of a residual at x. */
double corot_nodes_rounding(node_matrix *A, const double *x);

/* Of a symmetric block. False: a pivot was not positive. */
bool corot_nodes_invert(const double block[9], double inverse[9]);

/* Fails with COROT_RETRY: such a pivot was met at a node. */
corot_status corot_nodes_indefinite(const node_matrix *A, const corot_csc *csc, int node);

#endif
