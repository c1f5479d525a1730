/* Gram-Schmidt within aggregates, one step of damped Jacobi, products. */
#include "linsol_prolong.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/lanes/simd.h"
#include "linsol_aggregate.h"

enum { M = ROWS_MODES };

/* --- patterns --- */

static void insert(int a, int first, int *end, int *col) {
  int at = *end;
  for (int k = first; k < *end; k++)
    if (col[k] == a) return;
  for (; at > first && col[at - 1] > a; at--) col[at] = col[at - 1];
  col[at] = a;
  ++*end;
}

/* The aggregates of each node and of its neighbours. Returns how many they are; scratch [most] has
   the row; P->col may be NULL. */
static int list_blocks(const block_rows *A, int *scratch, prolongator *P) {
  int total = 0;
  for (int i = 0; i < A->n; i++) {
    int end = 0;
    if (P->aggregate[i] >= 0) insert(P->aggregate[i], 0, &end, scratch);
    for (int k = A->rowptr[i]; k < A->rowptr[i + 1]; k++)
      if (P->aggregate[A->col[k]] >= 0) insert(P->aggregate[A->col[k]], 0, &end, scratch);
    P->rowptr[i] = total;
    if (P->col) memcpy(P->col + total, scratch, (size_t)end * sizeof *scratch);
    total += end;
  }
  return P->rowptr[A->n] = total;
}

static void transpose(prolongator *P) {
  int total = P->rowptr[P->n];
  for (int k = 0; k < total; k++) P->colptr[P->col[k] + 1]++;
  for (int a = 0; a < P->ncoarse; a++) P->colptr[a + 1] += P->colptr[a];
  for (int i = 0; i < P->n; i++)
    for (int k = P->rowptr[i]; k < P->rowptr[i + 1]; k++) {
      int at = P->colptr[P->col[k]]++;
      P->row[at] = i, P->place[at] = k;
    }
  for (int a = P->ncoarse; a > 0; a--) P->colptr[a] = P->colptr[a - 1];
  P->colptr[0] = 0;
}

static int longest_row(const block_rows *A) {
  int most = 0;
  for (int i = 0; i < A->n; i++) {
    int length = A->rowptr[i + 1] - A->rowptr[i];
    if (length > most) most = length;
  }
  return most;
}

static corot_status no_memory(const prolongator *P) {
  return corot_fail(COROT_ENOMEM, "no memory for the prolongator of %d nodes", P->n);
}

corot_status corot_prolong_create(const block_rows *A, int *aggregate, int ncoarse,
                                  prolongator *P) {
  size_t n = (size_t)A->n, m = (size_t)ncoarse;
  *P = (prolongator){.n = A->n, .size = A->size, .ncoarse = ncoarse, .aggregate = aggregate};
  P->first = calloc(m + 2, sizeof *P->first);
  P->node = malloc((n + 1) * sizeof *P->node);
  P->rowptr = calloc(n + 1, sizeof *P->rowptr);
  P->colptr = calloc(m + 2, sizeof *P->colptr);
  P->T = malloc(n * A->size * M * sizeof *P->T + sizeof *P->T);
  P->R = malloc((m + 1) * M * M * sizeof *P->R);
  int *scratch = malloc((longest_row(A) + 2) * sizeof *scratch);
  if (P->first && P->node && P->rowptr && P->colptr && P->T && P->R && scratch) {
    corot_aggregate_sort(P->n, aggregate, ncoarse, P->first, P->node);
    size_t total = (size_t)list_blocks(A, scratch, P);
    P->col = malloc((total + 1) * sizeof *P->col);
    P->row = malloc((total + 1) * sizeof *P->row);
    P->place = malloc((total + 1) * sizeof *P->place);
    P->value = calloc(total * A->size * M + ROWS_BEYOND, sizeof *P->value);
    if (P->col) list_blocks(A, scratch, P);
  }
  free(scratch);
  if (!P->col || !P->row || !P->place || !P->value) return no_memory(P);
  transpose(P);
  return COROT_OK;
}

void corot_prolong_clear(prolongator *P) {
  free(P->aggregate), free(P->first), free(P->node), free(P->T), free(P->R);
  free(P->rowptr), free(P->col), free(P->value);
  free(P->colptr), free(P->row), free(P->place);
  *P = (prolongator){0};
}

/* --- motions --- */

/* Component r of a node's motions: a row of six. */
static double *row_of(const prolongator *P, double *all, int p, int r) {
  return all + ((size_t)P->node[p] * P->size + r) * M;
}

static double column_dot(const prolongator *P, int a, double *B, int j, int k) {
  double sum = 0;
  for (int p = P->first[a]; p < P->first[a + 1]; p++)
    for (int r = 0; r < P->size; r++) {
      const double *row = row_of(P, B, p, r);
      sum += row[j] * row[k];
    }
  return sum;
}

/* Column k -= factor times column j. */
static void column_subtract(const prolongator *P, int a, double *B, double factor, int j, int k) {
  for (int p = P->first[a]; p < P->first[a + 1]; p++)
    for (int r = 0; r < P->size; r++) {
      double *row = row_of(P, B, p, r);
      row[k] -= factor * row[j];
    }
}

static void column_scale(const prolongator *P, int a, double *B, double factor, int k) {
  for (int p = P->first[a]; p < P->first[a + 1]; p++)
    for (int r = 0; r < P->size; r++) row_of(P, B, p, r)[k] *= factor;
}

/* A motion counts as one of its own if so much of it is left: rounding leaves 1e-16 of a rotation
   about an axis far away, the smallest aggregate of a million 1e-3. */
static const double least = 1e-9;

/* The columns of one aggregate become orthonormal, or zero. Twice is enough (Parlett). */
static void split(const prolongator *P, int a, double *B, double R[M][M]) {
  memset(R, 0, M * sizeof *R);
  for (int k = 0; k < M; k++) {
    double whole = sqrt(column_dot(P, a, B, k, k));
    for (int pass = 0; pass < 2; pass++)
      for (int j = 0; j < k; j++) {
        double part = column_dot(P, a, B, j, k);
        column_subtract(P, a, B, part, j, k);
        R[j][k] += part;
      }
    double left = sqrt(column_dot(P, a, B, k, k));
    bool own = left > least * whole;
    R[k][k] = own ? left : 0;
    column_scale(P, a, B, own ? 1 / left : 0, k);
  }
}

void corot_prolong_split(prolongator *P) {
  for (int a = 0; a < P->ncoarse; a++) split(P, a, P->T, (double(*)[M])(P->R + (size_t)a * M * M));
}

/* --- smoothing --- */

static double *block_at(const prolongator *P, int i, int aggregate) {
  int k = P->rowptr[i];
  while (P->col[k] != aggregate) k++;
  return P->value + (size_t)k * P->size * M;
}

/* to -= omega B T, B by columns, T by rows. */
COROT_INLINE void subtract_product(int size, double omega, const double *B, const double *T,
                                   double *to) {
  for (int r = 0; r < size; r++)
    for (int q = 0; q < size; q++) {
      double factor = omega * B[size * q + r];
      for (int c = 0; c < M; c++) to[M * r + c] -= factor * T[M * q + c];
    }
}

COROT_INLINE void smooth(const block_rows *A, double omega, int size, prolongator *P) {
  size_t block = (size_t)size * M;
  double room[9];
  for (int i = 0; i < A->n; i++) {
    size_t begin = P->rowptr[i] * block, end = P->rowptr[i + 1] * block;
    memset(P->value + begin, 0, (end - begin) * sizeof *P->value);
    if (P->aggregate[i] >= 0) {
      const double *T = P->T + i * block;
      double *own = block_at(P, i, P->aggregate[i]);
      for (size_t k = 0; k < block; k++) own[k] = (1 - omega) * T[k];
    }
    for (int k = A->rowptr[i]; k < A->rowptr[i + 1]; k++) {
      int j = A->col[k];
      if (P->aggregate[j] < 0) continue;
      subtract_product(size, omega, rows_block(A, k, room), P->T + j * block,
                       block_at(P, i, P->aggregate[j]));
    }
  }
}

static COROT_CLONES void smooth_3(const block_rows *A, double omega, prolongator *P) {
  smooth(A, omega, ROWS_NODE, P);
}
static COROT_CLONES void smooth_6(const block_rows *A, double omega, prolongator *P) {
  smooth(A, omega, ROWS_MODES, P);
}

void corot_prolong_smooth(const block_rows *A, double largest, prolongator *P) {
  double omega = 4.0 / 3 / largest;
  (A->size == ROWS_NODE ? smooth_3 : smooth_6)(A, omega, P);
}

/* --- products --- */

COROT_INLINE void add(const prolongator *P, int size, int from, int end, const double *x,
                      double *y) {
  for (int i = from; i < end; i++) {
    double sum[M] = {0};
    for (int k = P->rowptr[i]; k < P->rowptr[i + 1]; k++) {
      const double *B = P->value + (size_t)k * size * M, *xk = x + (size_t)P->col[k] * M;
      for (int r = 0; r < size; r++)
        for (int c = 0; c < M; c++) sum[r] += B[M * r + c] * xk[c];
    }
    for (int r = 0; r < size; r++) y[(size_t)i * size + r] += sum[r];
  }
}

static COROT_CLONES void add_3(const prolongator *P, int from, int end, const double *x,
                               double *y) {
  add(P, ROWS_NODE, from, end, x, y);
}
static COROT_CLONES void add_6(const prolongator *P, int from, int end, const double *x,
                               double *y) {
  add(P, ROWS_MODES, from, end, x, y);
}

void corot_prolong_add(const prolongator *P, int from, int end, const double *x, double *y) {
  (P->size == ROWS_NODE ? add_3 : add_6)(P, from, end, x, y);
}

COROT_INLINE void restrict_by(const prolongator *P, int size, int from, int end, const double *x,
                              double *y) {
  for (int a = from; a < end; a++) {
    double sum[M] = {0};
    for (int p = P->colptr[a]; p < P->colptr[a + 1]; p++) {
      const double *B = P->value + (size_t)P->place[p] * size * M;
      const double *xi = x + (size_t)P->row[p] * size;
      for (int r = 0; r < size; r++)
        for (int c = 0; c < M; c++) sum[c] += B[M * r + c] * xi[r];
    }
    memcpy(y + (size_t)a * M, sum, sizeof sum);
  }
}

static COROT_CLONES void restrict_3(const prolongator *P, int from, int end, const double *x,
                                    double *y) {
  restrict_by(P, ROWS_NODE, from, end, x, y);
}
static COROT_CLONES void restrict_6(const prolongator *P, int from, int end, const double *x,
                                    double *y) {
  restrict_by(P, ROWS_MODES, from, end, x, y);
}

void corot_prolong_restrict(const prolongator *P, int from, int end, const double *x, double *y) {
  (P->size == ROWS_NODE ? restrict_3 : restrict_6)(P, from, end, x, y);
}
