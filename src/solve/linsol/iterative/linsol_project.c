/* Row I of P'AP is the sum over the nodes k of W_k' P_k, with W = A P_I: of all nodes of column I
   of P, in ascending order, and their neighbours. A row depends on no other; blocks above the
   diagonal mirror those below. */
#include "linsol_project.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/lanes/simd.h"

enum { M = ROWS_MODES, MM = M * M };

static corot_status no_memory(int n) {
  return corot_fail(COROT_ENOMEM, "no memory to project a matrix of %d nodes", n);
}

static void forget_marks(const block_rows *A, projection *r) {
  for (int i = 0; i < A->n; i++) r->mark[i] = -1;
}

static void visit(int k, int column, projection *r) {
  if (r->mark[k] == column) return;
  r->mark[k] = column;
  r->where[k] = r->n;
  r->node[r->n++] = k;
}

static void find_reach(const block_rows *A, const prolongator *P, int column, projection *r) {
  r->n = 0;
  for (int p = P->colptr[column]; p < P->colptr[column + 1]; p++) {
    int i = P->row[p];
    visit(i, column, r);
    for (int k = A->rowptr[i]; k < A->rowptr[i + 1]; k++) visit(A->col[k], column, r);
  }
}

/* --- pattern --- */

static int compare(const void *a, const void *b) {
  int x = *(const int *)a, y = *(const int *)b;
  return (x > y) - (x < y);
}

/* Counts only if there is no room for columns yet. */
static int list_blocks(const block_rows *A, const prolongator *P, projection *r, int *rowptr,
                       int *col) {
  int total = 0;
  r->most = 0;
  forget_marks(A, r);
  for (int J = 0; J < P->ncoarse; J++) r->slot[J] = -1;
  for (int I = 0; I < P->ncoarse; I++) {
    rowptr[I] = total;
    r->slot[I] = I;
    find_reach(A, P, I, r);
    if (r->n > r->most) r->most = r->n;
    for (int k = 0; k < r->n; k++)
      for (int q = P->rowptr[r->node[k]]; q < P->rowptr[r->node[k] + 1]; q++) {
        int J = P->col[q];
        if (r->slot[J] == I) continue;
        r->slot[J] = I;
        if (col) col[total] = J;
        total++;
      }
    if (col) qsort(col + rowptr[I], (size_t)(total - rowptr[I]), sizeof *col, compare);
  }
  return rowptr[P->ncoarse] = total;
}

static corot_status make_pattern(const block_rows *A, const prolongator *P, projection *r,
                                 block_rows *coarse) {
  int *rowptr = malloc(((size_t)P->ncoarse + 2) * sizeof *rowptr);
  if (!rowptr) return no_memory(A->n);
  int total = list_blocks(A, P, r, rowptr, NULL);
  free(rowptr);
  COROT_TRY(corot_rows_allocate(P->ncoarse, total, M, coarse));
  list_blocks(A, P, r, coarse->rowptr, coarse->col);
  return corot_rows_allocate_values(coarse);
}

corot_status corot_project_create(const block_rows *A, const prolongator *P, projection *r,
                                  block_rows *coarse) {
  size_t n = (size_t)A->n + 1, m = (size_t)P->ncoarse + 1;
  *r = (projection){0};
  r->node = malloc(n * sizeof *r->node);
  r->where = malloc(n * sizeof *r->where);
  r->mark = malloc(n * sizeof *r->mark);
  r->slot = malloc(m * sizeof *r->slot);
  r->root = malloc(m * MM * sizeof *r->root);
  if (!r->node || !r->where || !r->mark || !r->slot || !r->root) return no_memory(A->n);
  COROT_TRY(make_pattern(A, P, r, coarse));
  r->W = malloc(((size_t)r->most * A->size * M + 1) * sizeof *r->W);
  return r->W ? COROT_OK : no_memory(A->n);
}

void corot_project_clear(projection *r) {
  free(r->node), free(r->W), free(r->where), free(r->mark), free(r->slot), free(r->root);
  *r = (projection){0};
}

/* --- values --- */

/* W += B' T with B by columns, T and W by rows: of a symmetric A, what the block of row i and
   column k makes of P_i at k. */
COROT_INLINE void add_transposed(int size, const double *B, const double *T, double *image) {
  for (int q = 0; q < size; q++)
    for (int r = 0; r < size; r++) {
      double factor = B[size * q + r];
      for (int c = 0; c < M; c++) image[M * q + c] += factor * T[M * r + c];
    }
}

/* S += W' T, S by columns. */
COROT_INLINE void add_square(int size, const double *image, const double *T, double *S) {
  for (int q = 0; q < size; q++)
    for (int d = 0; d < M; d++) {
      double factor = T[M * q + d];
      for (int c = 0; c < M; c++) S[M * d + c] += factor * image[M * q + c];
    }
}

COROT_INLINE void find_images(const block_rows *A, const prolongator *P, int size, int column,
                              projection *r) {
  size_t block = (size_t)size * M;
  double room[9];
  memset(r->W, 0, (size_t)r->n * block * sizeof *r->W);
  for (int p = P->colptr[column]; p < P->colptr[column + 1]; p++) {
    int i = P->row[p];
    const double *T = P->value + (size_t)P->place[p] * block;
    double *own = r->W + (size_t)r->where[i] * block;
    for (size_t k = 0; k < block; k++) own[k] += T[k];
    for (int k = A->rowptr[i]; k < A->rowptr[i + 1]; k++)
      add_transposed(size, rows_block(A, k, room), T, r->W + (size_t)r->where[A->col[k]] * block);
  }
}

/* Row I up to its diagonal block, which goes to D. */
COROT_INLINE void add_row(const prolongator *P, int size, int I, const projection *r,
                          block_rows *coarse, double *D) {
  size_t block = (size_t)size * M;
  for (int e = coarse->rowptr[I]; e < coarse->rowptr[I + 1]; e++) r->slot[coarse->col[e]] = e;
  memset(D, 0, MM * sizeof *D);
  memset(coarse->value + (size_t)coarse->rowptr[I] * MM, 0,
         (size_t)(coarse->rowptr[I + 1] - coarse->rowptr[I]) * MM * sizeof *D);
  for (int k = 0; k < r->n; k++)
    for (int q = P->rowptr[r->node[k]]; q < P->rowptr[r->node[k] + 1] && P->col[q] <= I; q++)
      add_square(size, r->W + k * block, P->value + q * block,
                 P->col[q] == I ? D : coarse->value + (size_t)r->slot[P->col[q]] * MM);
}

static COROT_CLONES void project_3(const block_rows *A, const prolongator *P, int I, projection *r,
                                   block_rows *coarse, double *D) {
  find_images(A, P, ROWS_NODE, I, r);
  add_row(P, ROWS_NODE, I, r, coarse, D);
}

static COROT_CLONES void project_6(const block_rows *A, const prolongator *P, int I, projection *r,
                                   block_rows *coarse, double *D) {
  find_images(A, P, ROWS_MODES, I, r);
  add_row(P, ROWS_MODES, I, r, coarse, D);
}

/* The diagonal blocks go to r->root. */
static void project(const block_rows *A, const prolongator *P, projection *r, block_rows *coarse) {
  forget_marks(A, r);
  for (int I = 0; I < P->ncoarse; I++) {
    find_reach(A, P, I, r);
    (A->size == ROWS_NODE ? project_3 : project_6)(A, P, I, r, coarse, r->root + (size_t)I * MM);
  }
}

/* --- scaling --- */

/* a = C C', and T = C^-1, both lower triangular by rows. False: a pivot is not positive. */
static bool root(const double a[MM], double C[M][M], double T[M][M]) {
  memset(C, 0, MM * sizeof **C), memset(T, 0, MM * sizeof **T);
  for (int i = 0; i < M; i++)
    for (int j = 0; j <= i; j++) {
      double s = a[M * j + i];
      for (int k = 0; k < j; k++) s -= C[i][k] * C[j][k];
      if (i == j && !(s > 0)) return false;
      C[i][j] = i == j ? sqrt(s) : s / C[j][j];
    }
  for (int j = 0; j < M; j++)
    for (int i = j; i < M; i++) {
      double s = i == j;
      for (int k = j; k < i; k++) s -= C[i][k] * T[k][j];
      T[i][j] = s / C[i][i];
    }
  return true;
}

/* B by columns becomes Ti B Tj'. */
COROT_INLINE void scale_block(const double *Ti, const double *Tj, double *B) {
  double H[MM] = {0};
  for (int c = 0; c < M; c++) /* H = B Tj' */
    for (int k = 0; k <= c; k++)
      for (int r = 0; r < M; r++) H[M * c + r] += B[M * k + r] * Tj[M * c + k];
  for (int c = 0; c < M; c++)
    for (int r = 0; r < M; r++) {
      double s = 0;
      for (int k = 0; k <= r; k++) s += Ti[M * r + k] * H[M * c + k];
      B[M * c + r] = s;
    }
}

/* Blocks below the diagonal are scaled, and mirrored above it; next [n] is scratch. */
static COROT_CLONES void scale_rows(const double *T, int *next, block_rows *A) {
  for (int i = 0; i < A->n; i++) {
    next[i] = A->rowptr[i];
    while (next[i] < A->rowptr[i + 1] && A->col[next[i]] < i) next[i]++;
  }
  for (int i = 0; i < A->n; i++)
    for (int e = A->rowptr[i]; e < A->rowptr[i + 1] && A->col[e] < i; e++) {
      int j = A->col[e];
      double *B = A->value + (size_t)e * MM, *mirror = A->value + (size_t)next[j]++ * MM;
      scale_block(T + (size_t)i * MM, T + (size_t)j * MM, B);
      for (int c = 0; c < M; c++)
        for (int r = 0; r < M; r++) mirror[M * r + c] = B[M * c + r];
    }
}

/* P becomes P C^-T, a row of six at a time. */
static COROT_CLONES void scale_columns(const double *T, prolongator *P) {
  for (int k = 0; k < P->rowptr[P->n]; k++) {
    const double *Tk = T + (size_t)P->col[k] * MM;
    for (int r = 0; r < P->size; r++) {
      double *row = P->value + ((size_t)k * P->size + r) * M;
      for (int c = M - 1; c >= 0; c--) {
        double s = 0;
        for (int q = 0; q <= c; q++) s += row[q] * Tk[M * c + q];
        row[c] = s;
      }
    }
  }
}

/* The factors of the blocks D, which become their inverses; R becomes C' R. Returns the aggregate
   whose block has none; -1: all have. */
static int factor_blocks(int n, double *D, double *R) {
  for (int I = 0; I < n; I++) {
    double C[M][M], T[M][M], *own = D + (size_t)I * MM;
    double(*motion)[M] = (double(*)[M])(R + (size_t)I * MM), moved[M][M] = {0};
    for (int k = 0; k < M; k++)
      if (motion[k][k] == 0) own[M * k + k] = 1;
    if (!root(own, C, T)) return I;
    memcpy(own, T, sizeof T);
    for (int r = 0; r < M; r++)
      for (int k = r; k < M; k++)
        for (int c = 0; c < M; c++) moved[r][c] += C[k][r] * motion[k][c];
    memcpy(motion, moved, sizeof moved);
  }
  return -1;
}

int corot_project_load(const block_rows *A, projection *r, prolongator *P, block_rows *coarse) {
  project(A, P, r, coarse);
  int at = factor_blocks(P->ncoarse, r->root, P->R);
  if (at >= 0) return at;
  scale_rows(r->root, r->slot, coarse);
  scale_columns(r->root, P);
  return -1;
}
