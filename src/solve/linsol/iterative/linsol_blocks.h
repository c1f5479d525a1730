/* Products with the 3x3 blocks of a symmetric matrix below the diagonal, stored by columns. Vectors
   of nodes have a fourth component, so that they load as one; a block is followed by three doubles
   to read beyond. What calls these inside a function of COROT_CLONES is compiled with it. */
#ifndef COROT_SOLVE_LINSOL_ITERATIVE_LINSOL_BLOCKS_H
#define COROT_SOLVE_LINSOL_ITERATIVE_LINSOL_BLOCKS_H

#include "core/lanes/simd.h"

/* The blocks of one column. */
typedef struct block_column {
  const double *B;
  const int *row, *end;
} block_column;

/* Column j of a matrix of n nodes whose diagonal blocks stand first in `value`. */
COROT_INLINE block_column block_column_of(int n, const int *colptr, const int *row,
                                          const double *value, int j) {
  return (block_column){value + 9 * ((size_t)n + colptr[j]), row + colptr[j], row + colptr[j + 1]};
}

COROT_INLINE void vd4_store(double *x, vd4 a) { memcpy(x, &a, sizeof a); }
COROT_INLINE double vd4_sum(vd4 a) { return (a[0] + a[1]) + (a[2] + a[3]); }

/* x [3] with a zero behind it */
COROT_INLINE vd4 vd4_padded(const double *x) { return (vd4){x[0], x[1], x[2], 0}; }

/* B x; the fourth component becomes anything. */
COROT_INLINE vd4 block_times(const double *B, vd4 x) {
  return vd4_load(B) * x[0] + vd4_load(B + 3) * x[1] + vd4_load(B + 6) * x[2];
}

/* Sum of B' x, where fourth components of x are zero. */
COROT_INLINE vd4 column_product(block_column A, const double (*x)[4]) {
  vd4 s0 = {0}, s1 = {0}, s2 = {0};
  for (; A.row < A.end; A.row++, A.B += 9) {
    vd4 xi = vd4_load(x[*A.row]);
    s0 += vd4_load(A.B) * xi;
    s1 += vd4_load(A.B + 3) * xi;
    s2 += vd4_load(A.B + 6) * xi;
  }
  return (vd4){vd4_sum(s0), vd4_sum(s1), vd4_sum(s2), 0};
}

/* y += B s. Fourth components become anything. */
COROT_INLINE void add_column(block_column A, vd4 s, double (*y)[4]) {
  for (; A.row < A.end; A.row++, A.B += 9) {
    double *yi = y[*A.row];
    vd4_store(yi, vd4_load(yi) + block_times(A.B, s));
  }
}

#endif
