/* Patterns, products and the largest eigenvalue of matrices by rows. */
#include "linsol_rows.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "linsol_blocks.h"

corot_status corot_rows_allocate(int n, int nblock, int size, block_rows *R) {
  *R = (block_rows){.n = n, .size = size};
  R->rowptr = calloc((size_t)n + 2, sizeof *R->rowptr);
  R->col = malloc(((size_t)nblock + 1) * sizeof *R->col);
  if (R->rowptr && R->col) return COROT_OK;
  return corot_fail(COROT_ENOMEM, "no memory for a matrix of %d blocks", nblock);
}

corot_status corot_rows_allocate_values(block_rows *R) {
  size_t count = (size_t)R->rowptr[R->n] * R->size * R->size;
  R->value = calloc(count + ROWS_BEYOND, sizeof *R->value);
  if (!R->value) return corot_fail(COROT_ENOMEM, "no memory for %zu entries", count);
  R->value[count] = 1;
  return COROT_OK;
}

void corot_rows_clear(block_rows *R) {
  free(R->rowptr), free(R->col), free(R->source), free(R->value), free(R->single);
  *R = (block_rows){0};
}

/* With columns in turn, and their rows ascending, each row has got its blocks before the diagonal
   by the time those after it follow. */
static void fill_pattern(const node_matrix *A, int *next, block_rows *R) {
  for (int j = 0; j < A->n; j++)
    for (int k = A->colptr[j]; k < A->colptr[j + 1]; k++) {
      int above = next[j]++, below = next[A->row[k]]++;
      R->col[above] = A->row[k], R->source[above] = 2 * k + 1;
      R->col[below] = j, R->source[below] = 2 * k;
    }
}

corot_status corot_rows_create(const node_matrix *A, block_rows *R) {
  int nbelow = A->colptr[A->n];
  COROT_TRY(corot_rows_allocate(A->n, 2 * nbelow, ROWS_NODE, R));
  R->nodes = A;
  R->single = calloc(18 * (size_t)nbelow + ROWS_BEYOND, sizeof *R->single);
  R->source = malloc((2 * (size_t)nbelow + 1) * sizeof *R->source);
  int *next = malloc(((size_t)A->n + 1) * sizeof *next);
  bool enough = R->source && R->single && next;
  if (enough) {
    for (int j = 0; j < A->n; j++)
      for (int k = A->colptr[j]; k < A->colptr[j + 1]; k++)
        R->rowptr[j + 1]++, R->rowptr[A->row[k] + 1]++;
    for (int i = 0; i < A->n; i++) {
      next[i] = R->rowptr[i];
      R->rowptr[i + 1] += R->rowptr[i];
    }
    fill_pattern(A, next, R);
  }
  free(next);
  return enough ? COROT_OK : corot_fail(COROT_ENOMEM, "no memory for the rows of %d nodes", A->n);
}

void corot_rows_load(block_rows *R) {
  double room[9];
  for (int e = 0; e < R->rowptr[R->n]; e++) {
    const double *B = rows_block(R, e, room);
    float *to = R->single + 9 * (size_t)e;
    for (int k = 0; k < 9; k++) to[k] = (float)B[k];
  }
}

double *corot_rows_vector(int n, int size) {
  return calloc((size_t)n * size + ROWS_BEYOND, sizeof(double));
}

/* --- products --- */

static COROT_CLONES void subtract_3(const block_rows *R, int first, int end, const double *x,
                                    double *y) {
  const float *B = R->single + 9 * (size_t)R->rowptr[first];
  for (int i = first; i < end; i++) {
    vd4 s = vd4_load(x + 3 * (size_t)i), t = {0}, u = {0}; /* three sums go side by side */
    for (int k = R->rowptr[i]; k < R->rowptr[i + 1]; k++, B += 9) {
      const double *xk = x + 3 * (size_t)R->col[k];
      s += vd4_widen(B) * xk[0];
      t += vd4_widen(B + 3) * xk[1];
      u += vd4_widen(B + 6) * xk[2];
    }
    s += t + u;
    double *out = y + 3 * (size_t)i;
    out[0] -= s[0], out[1] -= s[1], out[2] -= s[2];
  }
}

static COROT_CLONES void subtract_6(const block_rows *R, int first, int end, const double *x,
                                    double *y) {
  const double *B = R->value + 36 * (size_t)R->rowptr[first];
  for (int i = first; i < end; i++) {
    vd4 s = vd4_load(x + 6 * (size_t)i);
    vd2 t = vd2_load(x + 6 * (size_t)i + 4);
    for (int k = R->rowptr[i]; k < R->rowptr[i + 1]; k++, B += 36) {
      const double *xk = x + 6 * (size_t)R->col[k];
      for (int c = 0; c < 6; c++) {
        s += vd4_load(B + 6 * c) * xk[c];
        t += vd2_load(B + 6 * c + 4) * xk[c];
      }
    }
    double *out = y + 6 * (size_t)i;
    for (int c = 0; c < 4; c++) out[c] -= s[c];
    out[4] -= t[0], out[5] -= t[1];
  }
}

void corot_rows_subtract(const block_rows *R, int from, int end, const double *x, double *y) {
  (R->size == ROWS_NODE ? subtract_3 : subtract_6)(R, from, end, x, y);
}

typedef struct product {
  const block_rows *R;
  const double *x;
  double *y;
} product;

static void subtract_part(void *work, int from, int end) {
  const product *p = work;
  corot_rows_subtract(p->R, from, end, p->x, p->y);
}

/* --- eigenvalue --- */

enum { CHUNK = 4096, MOST_STEPS = 32 };

/* By chunks, so that the sum has the same order whoever adds them up. */
static double dot(size_t n, const double *x, const double *y) {
  double sum = 0;
  for (size_t begin = 0; begin < n; begin += CHUNK) {
    size_t end = begin + CHUNK < n ? begin + CHUNK : n;
    double part = 0;
    for (size_t i = begin; i < end; i++) part += x[i] * y[i];
    sum += part;
  }
  return sum;
}

/* Whether all eigenvalues of the tridiagonal matrix with diagonal a [n] and b [n - 1] beside it are
   below x: all pivots of T - x are negative. */
static bool all_below(int n, const double *a, const double *b, double x) {
  double pivot = a[0] - x;
  for (int k = 1; k < n && pivot < 0; k++) pivot = a[k] - x - b[k - 1] * b[k - 1] / pivot;
  return pivot < 0;
}

static double largest_of(int n, const double *a, const double *b) {
  double low = a[0], high = a[0];
  for (int k = 0; k < n; k++) {
    double reach = (k > 0 ? fabs(b[k - 1]) : 0) + (k < n - 1 ? fabs(b[k]) : 0);
    low = fmax(low, a[k]), high = fmax(high, a[k] + reach); /* Gershgorin */
  }
  for (int k = 0; k < 40 && high - low > 1e-6 * fabs(high); k++) {
    double middle = (low + high) / 2;
    if (all_below(n, a, b, middle))
      high = middle;
    else
      low = middle;
  }
  return high;
}

/* Noise in which every vector has some part. */
static void start(size_t n, double *v) {
  uint64_t seed = 1;
  for (size_t i = 0; i < n; i++) {
    seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    v[i] = ldexp((double)(seed >> 11), -53) - 0.5;
  }
}

static void multiply_by(size_t n, double factor, double *v) {
  for (size_t i = 0; i < n; i++) v[i] *= factor;
}

double corot_rows_largest(const block_rows *R, team *by, int steps, double *const work[3]) {
  size_t n = (size_t)R->n * R->size;
  double a[MOST_STEPS] = {0}, b[MOST_STEPS], *v = work[0], *before = work[1], *w = work[2];
  int k = 0;
  start(n, v);
  memset(before, 0, n * sizeof *before);
  multiply_by(n, 1 / sqrt(dot(n, v, v)), v);
  while (k < steps && k < MOST_STEPS) {
    /* -w = A v less what it has of v and of the vector before */
    double last = k > 0 ? b[k - 1] : 0;
    for (size_t i = 0; i < n; i++) w[i] = last * before[i];
    product Av = {R, v, w};
    corot_team_loop(by, R->n, subtract_part, &Av);
    a[k] = -dot(n, v, w);
    for (size_t i = 0; i < n; i++) w[i] = -w[i] - a[k] * v[i];
    b[k] = sqrt(dot(n, w, w));
    k++;
    if (!(b[k - 1] > 1e-10 * fabs(a[0]))) break;
    /* the next one */
    double *next = w;
    w = before, before = v, v = next;
    multiply_by(n, 1 / b[k - 1], v);
  }
  return largest_of(k, a, b);
}
