/* From the aggregates of a level to its nodes: the smoothed prolongator of Vanek, Mandel and
   Brezina (Computing 56, 1996),

     P = (I - omega A) T,   T R = B   with T' T = I aggregate by aggregate,

   A the level's matrix (I + O), B its rigid motions. Each aggregate has six unknowns, and R are the
   rigid motions of the next level. Where the motions of an aggregate depend on each other (few
   nodes, supports), columns of T and rows of R are zero: unknowns that nothing depends on. */
#ifndef COROT_SOLVE_LINSOL_ITERATIVE_LINSOL_PROLONG_H
#define COROT_SOLVE_LINSOL_ITERATIVE_LINSOL_PROLONG_H

#include "linsol_rows.h"

typedef struct prolongator {
  int n, size, ncoarse; /* nodes of the level, components of a node; aggregates */
  int *aggregate;       /* [n] -1: none */
  int *first, *node;    /* [ncoarse + 1], [n] the nodes of each aggregate, ascending */
  double *T;            /* [n][size][6] by rows: B, then T */
  double *R;            /* [ncoarse][6][6] by rows */
  int *rowptr, *col;    /* [n + 1], [rowptr[n]] blocks of P, columns ascending */
  double *value;        /* [rowptr[n]][size][6] by rows, and more to read beyond */
  int *colptr, *row;    /* [ncoarse + 1], [rowptr[n]] the same blocks by columns, rows ascending: */
  int *place;           /* [rowptr[n]] where in `value` each stands */
} prolongator;

/* `aggregate` becomes P's own, whatever is returned. What is half made is released by clear.
   COROT_ENOMEM. */
corot_status corot_prolong_create(const block_rows *A, int *aggregate, int ncoarse, prolongator *P);
void corot_prolong_clear(prolongator *P);

/* P->T and P->R of the B that is in P->T. */
void corot_prolong_split(prolongator *P);

/* P of A, whose largest eigenvalue is `largest`. */
void corot_prolong_smooth(const block_rows *A, double largest, prolongator *P);

/* Rows `from` to `end` - 1 of y [n] += P x [ncoarse], which is read by ROWS_BEYOND more, and of
   y [ncoarse] = P' x [n]. */
void corot_prolong_add(const prolongator *P, int from, int end, const double *x, double *y);
void corot_prolong_restrict(const prolongator *P, int from, int end, const double *x, double *y);

#endif
