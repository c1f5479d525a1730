/* Products, sweeps and factors by blocks. */
#include "linsol_nodes.h"

#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "linsol_blocks.h"

/* --- structure --- */

static void list_blocks(const corot_csc *csc, node_matrix *A) {
  int *first = A->slot; /* for now: the node of each unknown */
  for (int i = 0, n = 0; i < csc->n; i++) {
    n += i > 0 && csc->node[i] != csc->node[i - 1];
    first[i] = n;
    A->n = n + 1;
  }
  int nbelow = 0;
  for (int j = 0; j < csc->n; j++) { /* the first unknown of a node sees all its neighbours */
    int last = first[j];
    if (j > 0 && first[j - 1] == last) continue;
    A->colptr[last] = nbelow;
    for (int p = csc->colptr[j]; p < csc->colptr[j + 1]; p++)
      if (first[csc->row[p]] > last) A->row[nbelow++] = last = first[csc->row[p]];
  }
  A->colptr[A->n] = nbelow;
}

/* The source of a diagonal entry is on the diagonal of a block, too: 0, 4 or 8 into it. */
static void number_unknowns(const corot_csc *csc, node_matrix *A) {
  for (int i = 0; i < csc->n; i++)
    A->slot[i] = 3 * A->slot[i] + csc->source[csc->diagonal[i]] % 9 / 4;
}

/* Where each entry of the lower triangle goes. */
static void place_entries(const corot_csc *csc, node_matrix *A) {
  for (int j = 0; j < csc->n; j++) {
    int node = A->slot[j] / 3, c = A->slot[j] % 3, k = A->colptr[node];
    for (int p = csc->colptr[j]; p < csc->colptr[j + 1]; p++) {
      int row = A->slot[csc->row[p]] / 3, r = A->slot[csc->row[p]] % 3;
      while (row != node && A->row[k] < row) k++;
      A->place[p] = 9 * (row == node ? node : A->n + k) + 3 * c + r;
    }
  }
}

corot_status corot_nodes_create(const corot_csc *csc, node_matrix *A) {
  *A = (node_matrix){0};
  A->slot = malloc(csc->n * sizeof *A->slot);
  A->colptr = malloc((csc->n + 1) * sizeof *A->colptr);
  A->row = malloc(csc->nnz * sizeof *A->row);
  A->place = malloc(csc->nnz * sizeof *A->place);
  if (!A->slot || !A->colptr || !A->row || !A->place)
    return corot_fail(COROT_ENOMEM, "no memory for a matrix of %d columns", csc->n);
  list_blocks(csc, A);
  if (A->n + A->colptr[A->n] > INT_MAX / 9)
    return corot_fail(COROT_EINVAL, "pcg: the matrix exceeds 32-bit counts");
  number_unknowns(csc, A);
  place_entries(csc, A);
  size_t n = A->n, nblock = n + A->colptr[n];
  A->value = malloc((9 * nblock + 3) * sizeof *A->value);
  A->C = malloc(9 * n * sizeof *A->C);
  A->Cinv = malloc(9 * n * sizeof *A->Cinv);
  A->work = malloc(2 * n * sizeof *A->work);
  if (!A->value || !A->C || !A->Cinv || !A->work)
    return corot_fail(COROT_ENOMEM, "no memory for a matrix of %zu blocks", nblock);
  return COROT_OK;
}

void corot_nodes_clear(node_matrix *A) {
  free(A->slot), free(A->colptr), free(A->row), free(A->place);
  free(A->value), free(A->C), free(A->Cinv), free(A->work);
}

/* --- values --- */

void corot_nodes_load(node_matrix *A, const corot_csc *csc, const double *value) {
  memset(A->value, 0, (9 * ((size_t)A->n + A->colptr[A->n]) + 3) * sizeof *A->value);
  for (int i = 0; i < A->n; i++)
    for (int c = 0; c < 3; c++) A->value[9 * i + 4 * c] = 1; /* unless an unknown says otherwise */
  for (int p = 0; p < csc->nnz; p++) A->value[A->place[p]] = value[p];
  for (int i = 0; i < A->n; i++) {
    double *d = &A->value[9 * i];
    d[3] = d[1], d[6] = d[2], d[7] = d[5];
  }
}

/* C C' = a, both row-major. False: a pivot is not above `least` times its entry in `original`. */
static bool root(const double a[9], const double original[9], double least, double C[9],
                 double Cinv[9]) {
  double p0 = a[0];
  if (!(p0 > least * original[0])) return false;
  p0 = sqrt(p0);
  double l10 = a[3] / p0, l20 = a[6] / p0, p1 = a[4] - l10 * l10;
  if (!(p1 > least * original[4])) return false;
  p1 = sqrt(p1);
  double l21 = (a[7] - l20 * l10) / p1, p2 = a[8] - l20 * l20 - l21 * l21;
  if (!(p2 > least * original[8])) return false;
  p2 = sqrt(p2);
  double i0 = 1 / p0, i1 = 1 / p1, i2 = 1 / p2;
  double i20 = (l10 * l21 * i1 - l20) * i0 * i2;
  memcpy(C, (double[]){p0, 0, 0, l10, p1, 0, l20, l21, p2}, 9 * sizeof *C);
  memcpy(Cinv, (double[]){i0, 0, 0, -l10 * i0 * i1, i1, 0, i20, -l21 * i1 * i2, i2}, 9 * sizeof *C);
  return true;
}

/* A block B by columns becomes B T' or T B, with T lower triangular by rows. */
COROT_INLINE void times_transposed(double *B, const double *T) {
  for (int r = 0; r < 3; r++) {
    double b0 = B[r], b1 = B[3 + r], b2 = B[6 + r];
    B[r] = b0 * T[0];
    B[3 + r] = b0 * T[3] + b1 * T[4];
    B[6 + r] = b0 * T[6] + b1 * T[7] + b2 * T[8];
  }
}

COROT_INLINE void times_left(const double *T, double *B) {
  for (int c = 0; c < 3; c++) {
    double *b = B + 3 * c;
    b[2] = T[6] * b[0] + T[7] * b[1] + T[8] * b[2];
    b[1] = T[3] * b[0] + T[4] * b[1];
    b[0] = T[0] * b[0];
  }
}

/* E -= B B' */
COROT_INLINE void eliminate(const double *B, double *E) {
  for (int r = 0; r < 3; r++)
    for (int c = 0; c < 3; c++)
      E[3 * r + c] -= B[r] * B[c] + B[3 + r] * B[3 + c] + B[6 + r] * B[6 + c];
}

/* Once all C are there and L has its factors C^-T. */
static void scale_rows(node_matrix *A) {
  double *L = A->value + 9 * (size_t)A->n;
  for (int k = 0; k < A->colptr[A->n]; k++) times_left(&A->Cinv[9 * A->row[k]], &L[9 * k]);
  for (int i = 0; i < A->n; i++) {
    times_transposed(&A->value[9 * i], &A->Cinv[9 * i]);
    times_left(&A->Cinv[9 * i], &A->value[9 * i]);
  }
}

void corot_nodes_keep(node_matrix *A) {
  for (int i = 0; i < 9 * A->n; i++) A->C[i] = A->Cinv[i] = i % 9 % 4 == 0;
}

bool corot_nodes_invert(const double block[9], double inverse[9]) {
  double C[9], T[9];
  if (!root(block, block, 0, C, T)) return false;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      inverse[3 * i + j] = T[i] * T[j] + T[3 + i] * T[3 + j] + T[6 + i] * T[6 + j];
  return true;
}

corot_status corot_nodes_indefinite(const node_matrix *A, const corot_csc *csc, int node) {
  int dof = 0;
  while (A->slot[dof] / 3 < node) dof++;
  return corot_fail(COROT_RETRY,
                    "pcg: the matrix is not positive definite (degree of freedom %d of node %d)",
                    A->unknown ? A->unknown[dof] : dof, csc->node[dof]);
}

bool corot_nodes_jacobi(node_matrix *A, int *at) {
  double *L = A->value + 9 * (size_t)A->n;
  for (int j = 0; j < A->n; j++) {
    const double *d = &A->value[9 * j];
    *at = j;
    if (!root(d, d, 0, &A->C[9 * j], &A->Cinv[9 * j])) return false;
    for (int k = A->colptr[j]; k < A->colptr[j + 1]; k++)
      times_transposed(&L[9 * k], &A->Cinv[9 * j]);
  }
  scale_rows(A);
  return true;
}

static COROT_CLONES bool cholesky(node_matrix *A, double shift, int *at) {
  const double least = 1e-3; /* smaller pivots make a positive, but a bad preconditioner */
  double *L = A->value + 9 * (size_t)A->n, *E = A->C;
  for (int i = 0; i < 9 * A->n; i++) E[i] = A->value[i];
  for (int i = 0; i < A->n; i++)
    for (int c = 0; c < 3; c++) E[9 * i + 4 * c] *= 1 + shift;
  for (int j = 0; j < A->n; j++) {
    double e[9];
    memcpy(e, &E[9 * j], sizeof e);
    *at = j;
    if (!root(e, &A->value[9 * j], least, &A->C[9 * j], &A->Cinv[9 * j])) return false;
    for (int k = A->colptr[j]; k < A->colptr[j + 1]; k++) {
      times_transposed(&L[9 * k], &A->Cinv[9 * j]);
      eliminate(&L[9 * k], &E[9 * A->row[k]]);
    }
  }
  scale_rows(A);
  return true;
}

bool corot_nodes_cholesky(node_matrix *A, double shift, int *at) { return cholesky(A, shift, at); }

/* --- products and sweeps; vectors of nodes have a fourth component that is zero --- */

COROT_INLINE block_column column(const node_matrix *A, int j) {
  return block_column_of(A->n, A->colptr, A->row, A->value, j);
}

COROT_INLINE void output(double *y, vd4 a) { y[0] = a[0], y[1] = a[1], y[2] = a[2]; }

static COROT_CLONES void multiply(node_matrix *A, const double *x, double *y) {
  double(*in)[4] = A->work, (*out)[4] = A->work + A->n;
  for (int i = 0; i < A->n; i++) {
    const double *xi = x + 3 * i;
    vd4_store(in[i], vd4_padded(xi));
    vd4_store(out[i], block_times(&A->value[9 * i], vd4_padded(xi)));
  }
  for (int j = 0; j < A->n; j++) {
    vd4 above = column_product(column(A, j), (const double(*)[4])in);
    output(y + 3 * j, vd4_load(out[j]) + above);
    add_column(column(A, j), vd4_padded(x + 3 * j), out);
  }
}

void corot_nodes_multiply(node_matrix *A, const double *x, double *y) { multiply(A, x, y); }

/* With D + L + L' = (I + L) + (I + L') - (2 I - D) and t = (I + L')^-1 x:
   y = t + (I + L)^-1 (x - (2 I - D) t). */
static COROT_CLONES void sandwich(node_matrix *A, const double *x, double *y) {
  double(*t)[4] = A->work, (*w)[4] = A->work + A->n;
  for (int j = A->n - 1; j >= 0; j--) {
    vd4 xj = vd4_padded(x + 3 * j), tj = xj - column_product(column(A, j), (const double(*)[4])t);
    vd4_store(t[j], tj);
    vd4_store(w[j], block_times(&A->value[9 * j], tj) - 2 * tj + xj);
  }
  for (int j = 0; j < A->n; j++) {
    vd4 s = vd4_padded(w[j]);
    output(y + 3 * j, vd4_load(t[j]) + s);
    add_column(column(A, j), -s, w);
  }
}

void corot_nodes_sandwich(node_matrix *A, const double *x, double *y) { sandwich(A, x, y); }

static COROT_CLONES void forward(node_matrix *A, double *x) {
  double(*w)[4] = A->work;
  for (int j = 0; j < A->n; j++) vd4_store(w[j], vd4_padded(x + 3 * j));
  for (int j = 0; j < A->n; j++) {
    vd4 s = vd4_padded(w[j]);
    output(x + 3 * j, s);
    add_column(column(A, j), -s, w);
  }
}

void corot_nodes_forward(node_matrix *A, double *x) { forward(A, x); }

static COROT_CLONES void backward(node_matrix *A, double *x) {
  double(*t)[4] = A->work;
  for (int j = A->n - 1; j >= 0; j--) {
    vd4 tj = vd4_padded(x + 3 * j) - column_product(column(A, j), (const double(*)[4])t);
    vd4_store(t[j], tj);
    output(x + 3 * j, tj);
  }
}

void corot_nodes_backward(node_matrix *A, double *x) { backward(A, x); }

void corot_nodes_scale(const node_matrix *A, double *x) {
  for (int i = 0; i < A->n; i++, x += 3) {
    const double *T = &A->Cinv[9 * i];
    x[2] = T[6] * x[0] + T[7] * x[1] + T[8] * x[2];
    x[1] = T[3] * x[0] + T[4] * x[1];
    x[0] = T[0] * x[0];
  }
}

void corot_nodes_unscale_transposed(const node_matrix *A, double *x) {
  for (int i = 0; i < A->n; i++, x += 3) {
    const double *T = &A->Cinv[9 * i];
    x[0] = T[0] * x[0] + T[3] * x[1] + T[6] * x[2];
    x[1] = T[4] * x[1] + T[7] * x[2];
    x[2] = T[8] * x[2];
  }
}

double corot_nodes_unscaled_norm(const node_matrix *A, const double *x) {
  double square = 0;
  for (int i = 0; i < A->n; i++, x += 3) {
    const double *T = &A->C[9 * i];
    double a = T[0] * x[0], b = T[3] * x[0] + T[4] * x[1],
           c = T[6] * x[0] + T[7] * x[1] + T[8] * x[2];
    square += a * a + b * b + c * c;
  }
  return sqrt(square);
}

double corot_nodes_rounding(node_matrix *A, const double *x) {
  double *y = A->work[0]; /* [3 n] */
  memset(y, 0, 3 * (size_t)A->n * sizeof *y);
  for (int j = 0; j < A->n; j++)
    for (int r = 0; r < 3; r++)
      for (int c = 0; c < 3; c++) {
        y[3 * j + r] += fabs(A->value[9 * j + 3 * c + r] * x[3 * j + c]);
        for (int k = A->colptr[j]; k < A->colptr[j + 1]; k++) {
          double entry = A->value[9 * ((size_t)A->n + k) + 3 * c + r];
          y[3 * A->row[k] + r] += fabs(entry * x[3 * j + c]);
          y[3 * j + c] += fabs(entry * x[3 * A->row[k] + r]);
        }
      }
  return DBL_EPSILON * corot_nodes_unscaled_norm(A, y);
}
