/* A symmetric matrix by whole rows of square blocks, scaled from both sides so that the blocks on
   its diagonal are the identity, which are not stored: I + O. A row of a product depends on no
   other, and its sum has one order: rows may be shared out among threads.

   The rows of a node_matrix are of single precision: products take as long as it takes to read
   them. They are for smoothing, which rounding by 6e-8 does not change; both triangles are rounded
   alike, so that it stays symmetric. What coarser levels are made of is the node_matrix itself. */
#ifndef COROT_SOLVE_LINSOL_ITERATIVE_LINSOL_ROWS_H
#define COROT_SOLVE_LINSOL_ITERATIVE_LINSOL_ROWS_H

#include "linsol_nodes.h"

/* Components of a node of the mesh, and of an aggregate: its rigid motions. */
enum { ROWS_NODE = 3, ROWS_MODES = 6 };

typedef struct block_rows {
  int n, size;       /* rows of blocks, rows of a block: ROWS_NODE or ROWS_MODES */
  int *rowptr, *col; /* [n + 1], [rowptr[n]] blocks of O, columns ascending */
  double *value;     /* [rowptr[n]][size size] by columns; then a one, and more to read beyond */

  /* Instead of `value`: */
  const node_matrix *nodes; /* borrowed; NULL: there is none */
  int *source;              /* [rowptr[n]] of each block, twice its number below the diagonal, plus
                               one where it is transposed */
  float *single;            /* [rowptr[n]][9] by columns, and more to read beyond */
} block_rows;

/* How far beyond their end values and vectors are read. */
enum { ROWS_BEYOND = 8 };

/* Room for the pattern, or for the values once rowptr is there. What is half made is released by
   clear. */
corot_status corot_rows_allocate(int n, int nblock, int size, block_rows *R);
corot_status corot_rows_allocate_values(block_rows *R);
void corot_rows_clear(block_rows *R);

/* The pattern of A, which is borrowed; and its values, once it is scaled (corot_nodes_jacobi). */
corot_status corot_rows_create(const node_matrix *A, block_rows *R);
void corot_rows_load(block_rows *R);

/* Block e by columns, in double precision; `room` is where it may be put. */
static inline const double *rows_block(const block_rows *R, int e, double room[9]) {
  if (!R->nodes) return R->value + (size_t)R->size * R->size * e;
  const double *B = R->nodes->value + 9 * ((size_t)R->n + (R->source[e] >> 1));
  if (!(R->source[e] & 1)) return B;
  for (int c = 0; c < 3; c++)
    for (int r = 0; r < 3; r++) room[3 * c + r] = B[3 * r + c];
  return room;
}

/* A vector of n nodes or aggregates, of zeros. NULL: no memory. */
double *corot_rows_vector(int n, int size);

/* Rows `from` to `end` - 1 of y -= (I + O) x; x may be read by ROWS_BEYOND more than it has. */
void corot_rows_subtract(const block_rows *R, int from, int end, const double *x, double *y);

/* The largest eigenvalue of I + O, from below, by `steps` of Lanczos' method; work [3] are vectors.
   A team shares the products out; NULL: nobody does. */
double corot_rows_largest(const block_rows *R, team *by, int steps, double *const work[3]);

#endif
