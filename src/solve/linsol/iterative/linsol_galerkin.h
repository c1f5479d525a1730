/* A symmetric matrix of 3x3 blocks on every level of a refined mesh: on the finest what it is, on
   each coarser one A_(l-1) = P' A_l P, P the linear interpolation. With nodes numbered level by
   level, the matrix of the hierarchical basis (corot/hierarchy.h) has as diagonal blocks A_0, and
   for each later node that of the level it is new on.

   A component that is held stays zero, whatever its node's parents do, and so does what the node's
   children inherit. */
#ifndef COROT_SOLVE_LINSOL_ITERATIVE_LINSOL_GALERKIN_H
#define COROT_SOLVE_LINSOL_ITERATIVE_LINSOL_GALERKIN_H

#include "linsol_nodes.h"

typedef struct galerkin_level {
  int n;             /* nodes that have a free component: the first ones of all finer levels */
  int *colptr, *row; /* [n + 1], [colptr[n]] blocks below the diagonal, as in node_matrix */
  double *value;     /* blocks of 9 and 3 more, as in node_matrix */
  int (*to)[4];      /* of each block, where its parts go on the next coarser level: twice a block,
                        plus one where it is transposed; -1: nowhere */
} galerkin_level;

typedef struct galerkin {
  int nlevel;
  galerkin_level *level; /* [nlevel + 1] the last is the node_matrix itself, borrowed */
  int n;                 /* nodes of the finest level */
  int (*parent)[2];      /* [n - level[0].n] of the later nodes; n: one that is wholly held */
  unsigned char *held;   /* [n] bit c: component c is held */
} galerkin;

/* `csc` is that of A, on the finest mesh. The refinement is not needed afterwards, A is.
   COROT_EINVAL: a node has parents that are not of coarser levels. What is half made is released by
   clear. */
corot_status corot_galerkin_create(const corot_csc *csc, const node_matrix *A,
                                   const corot_refinement *refinement, galerkin *g);
void corot_galerkin_clear(galerkin *g);

/* The values of the coarser levels, those of A being loaded and not scaled. */
void corot_galerkin_load(galerkin *g);

/* inverse [level[l].n - first]: of the diagonal blocks of level l from node `first` on, where held
   components count as one. Returns the node whose block is not positive definite; -1: none. */
int corot_galerkin_invert(const galerkin *g, int l, int first, double (*inverse)[9]);

/* The block of a level at row i and column j <= i, which must be there. */
int corot_galerkin_find(const galerkin_level *level, int i, int j);

#endif
