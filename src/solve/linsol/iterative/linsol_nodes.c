/* Structure, values and factors by blocks. */
#include "linsol_nodes.h"

#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/lanes/simd.h"

/* --- structure --- */

/* order [g->n] the nodes, rank [g->n] where each stands. */
static void list_blocks(const node_graph *g, const int *order, const int *rank, node_matrix *A) {
  int nbelow = 0;
  for (int j = 0; j < A->n; j++) {
    A->colptr[j] = nbelow;
    for (int p = g->colptr[order[j]]; p < g->colptr[order[j] + 1]; p++) {
      int row = rank[g->row[p]], at = nbelow;
      if (row < j) continue;
      for (; at > A->colptr[j] && A->row[at - 1] > row; at--) A->row[at] = A->row[at - 1];
      A->row[at] = row;
      nbelow++;
    }
  }
  A->colptr[A->n] = nbelow;
}

/* The source of a diagonal entry is on the diagonal of a block, too: 0, 4 or 8 into it. */
static void number_unknowns(const corot_csc *csc, const node_graph *g, const int *rank,
                            node_matrix *A) {
  for (int i = 0; i < csc->n; i++)
    A->slot[i] = 3 * rank[g->rank[i]] + csc->source[csc->diagonal[i]] % 9 / 4;
}

static int find_block(const node_matrix *A, int row, int column) {
  int low = A->colptr[column], high = A->colptr[column + 1] - 1;
  while (low < high) {
    int mid = low + (high - low) / 2;
    if (A->row[mid] < row)
      low = mid + 1;
    else
      high = mid;
  }
  return low;
}

/* Where each entry of the lower triangle goes: what is above the diagonal in our order stands for
   what mirrors it. */
static void place_entries(const corot_csc *csc, node_matrix *A) {
  for (int j = 0; j < csc->n; j++)
    for (int p = csc->colptr[j]; p < csc->colptr[j + 1]; p++) {
      int i = csc->row[p], node_i = A->slot[i] / 3, node_j = A->slot[j] / 3;
      int low = node_i < node_j ? i : j, high = node_i < node_j ? j : i;
      int row = A->slot[high] / 3, column = A->slot[low] / 3;
      int block = row == column ? row : A->n + find_block(A, row, column);
      A->place[p] = 9 * block + 3 * (A->slot[low] % 3) + A->slot[high] % 3;
    }
}

/* The ends of columns in their domains, and the rows between domains. */
static corot_status list_between(node_matrix *A) {
  int first = A->parts.first[A->parts.n], nbetween = A->n - first;
  if (A->parts.n == 1) return COROT_OK;
  A->inner = malloc(((size_t)first + 1) * sizeof *A->inner);
  A->left_first = calloc((size_t)nbetween + 2, sizeof *A->left_first);
  if (!A->inner || !A->left_first)
    return corot_fail(COROT_ENOMEM, "no memory for a matrix of %d nodes", A->n);
  int *next = A->left_first + 1; /* shifted by one while filling, in place after */
  for (int j = 0; j < first; j++) {
    int k = A->colptr[j];
    while (k < A->colptr[j + 1] && A->row[k] < first) k++;
    A->inner[j] = k;
    for (; k < A->colptr[j + 1]; k++) next[A->row[k] - first + 1]++;
  }
  for (int i = 0; i < nbetween; i++) next[i + 1] += next[i];
  A->left = malloc(((size_t)next[nbetween] + 1) * sizeof *A->left);
  A->left_node = malloc(((size_t)next[nbetween] + 1) * sizeof *A->left_node);
  if (!A->left || !A->left_node)
    return corot_fail(COROT_ENOMEM, "no memory for a matrix of %d nodes", A->n);
  for (int j = 0; j < first; j++)
    for (int k = A->inner[j]; k < A->colptr[j + 1]; k++) {
      int at = next[A->row[k] - first]++;
      A->left[at] = k, A->left_node[at] = j;
    }
  return COROT_OK;
}

static corot_status find_structure(const corot_csc *csc, node_graph *g, bool by_domains, int *order,
                                   int *rank, node_matrix *A) {
  A->parts = (domains){.n = 1, .first = {0, g->n}};
  for (int i = 0; i < g->n; i++) order[i] = i;
  if (by_domains) COROT_TRY(corot_domains_find(g, order, &A->parts));
  for (int i = 0; i < g->n; i++) rank[order[i]] = i;
  A->n = g->n;
  list_blocks(g, order, rank, A);
  if (A->n + A->colptr[A->n] > INT_MAX / 9)
    return corot_fail(COROT_EINVAL, "pcg: the matrix exceeds 32-bit counts");
  number_unknowns(csc, g, rank, A);
  place_entries(csc, A);
  return list_between(A);
}

static corot_status make_structure(const corot_csc *csc, bool by_domains, node_matrix *A) {
  node_graph g;
  corot_status status = corot_graph_create(csc, &g);
  int *order = malloc(((size_t)csc->n + 1) * sizeof *order);
  int *rank = malloc(((size_t)csc->n + 1) * sizeof *rank);
  if (!status && (!order || !rank))
    status = corot_fail(COROT_ENOMEM, "no memory for a matrix of %d columns", csc->n);
  if (!status) status = find_structure(csc, &g, by_domains, order, rank, A);
  free(order), free(rank);
  corot_graph_clear(&g);
  return status;
}

corot_status corot_nodes_create(const corot_csc *csc, bool by_domains, node_matrix *A) {
  *A = (node_matrix){0};
  A->slot = malloc(csc->n * sizeof *A->slot);
  A->colptr = malloc((csc->n + 1) * sizeof *A->colptr);
  A->row = malloc(csc->nnz * sizeof *A->row);
  A->place = malloc(csc->nnz * sizeof *A->place);
  if (!A->slot || !A->colptr || !A->row || !A->place)
    return corot_fail(COROT_ENOMEM, "no memory for a matrix of %d columns", csc->n);
  COROT_TRY(make_structure(csc, by_domains, A));
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
  free(A->inner), free(A->left_first), free(A->left), free(A->left_node);
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

static COROT_CLONES void scale_columns(void *of, int from, int end) {
  node_matrix *A = of;
  double *L = A->value + 9 * (size_t)A->n;
  for (int i = from; i < end; i++) {
    for (int k = A->colptr[i]; k < A->colptr[i + 1]; k++)
      times_left(&A->Cinv[9 * A->row[k]], &L[9 * (size_t)k]);
    times_transposed(&A->value[9 * i], &A->Cinv[9 * i]);
    times_left(&A->Cinv[9 * i], &A->value[9 * i]);
  }
}

/* Once all C are there and L has its factors C^-T. */
static void scale_rows(node_matrix *A) { corot_team_loop(A->team, A->n, scale_columns, A); }

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
  while (A->slot[dof] / 3 != node) dof++;
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

/* Eliminates node j, whose diagonal block E has become what is left of it, from the rows of its
   blocks before `end`. False: a pivot is too small. */
COROT_INLINE bool eliminate_node(node_matrix *A, int j, int end) {
  const double least = 1e-3; /* smaller pivots make a positive, but a bad preconditioner */
  double *L = A->value + 9 * (size_t)A->n, *E = A->C, e[9];
  memcpy(e, &E[9 * j], sizeof e);
  if (!root(e, &A->value[9 * j], least, &A->C[9 * j], &A->Cinv[9 * j])) return false;
  for (int k = A->colptr[j]; k < A->colptr[j + 1]; k++) {
    times_transposed(&L[9 * (size_t)k], &A->Cinv[9 * j]);
    if (k < end) eliminate(&L[9 * (size_t)k], &E[9 * A->row[k]]);
  }
  return true;
}

/* The nodes of a domain, or those from `from` on; the first whose pivot is too small, or -1. */
static COROT_CLONES int eliminate_domain(node_matrix *A, int from, int end) {
  for (int j = from; j < end; j++)
    if (!eliminate_node(A, j, A->inner ? A->inner[j] : A->colptr[j + 1])) return j;
  return -1;
}

static COROT_CLONES int eliminate_between(node_matrix *A) {
  for (int j = A->parts.first[A->parts.n]; j < A->n; j++)
    if (!eliminate_node(A, j, A->colptr[j + 1])) return j;
  return -1;
}

/* What the rows between domains lose to these. */
static COROT_CLONES void gather_eliminated(void *of, int from, int end) {
  node_matrix *A = of;
  const double *L = A->value + 9 * (size_t)A->n;
  int first = A->parts.first[A->parts.n];
  for (int i = from; i < end; i++)
    for (int k = A->left_first[i]; k < A->left_first[i + 1]; k++)
      eliminate(&L[9 * (size_t)A->left[k]], &A->C[9 * (first + i)]);
}

typedef struct elimination {
  node_matrix *A;
  int failed[MOST_DOMAINS];
} elimination;

static void eliminate_part(void *work, int k) {
  elimination *e = work;
  e->failed[k] = eliminate_domain(e->A, e->A->parts.first[k], e->A->parts.first[k + 1]);
}

bool corot_nodes_cholesky(node_matrix *A, double shift, int *at) {
  elimination e = {.A = A};
  double *E = A->C;
  for (int i = 0; i < 9 * A->n; i++) E[i] = A->value[i];
  for (int i = 0; i < A->n; i++)
    for (int c = 0; c < 3; c++) E[9 * i + 4 * c] *= 1 + shift;
  corot_team_run(A->team, A->parts.n, eliminate_part, &e);
  for (int k = 0; k < A->parts.n; k++) {
    *at = e.failed[k];
    if (*at >= 0) return false;
  }
  if (A->parts.n > 1)
    corot_team_loop(A->team, A->n - A->parts.first[A->parts.n], gather_eliminated, A);
  *at = eliminate_between(A);
  if (*at >= 0) return false;
  scale_rows(A);
  return true;
}

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
