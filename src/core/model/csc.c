/* The block pattern as compressed sparse columns, and products with block matrices. */
#include <stdlib.h>

#include <limits.h>

#include "core/base/sized.h"
#include "model.h"

int corot_model_nblock(const corot_model *m) { return solid_of(m)->pattern.nblock; }

void corot_block_multiply(const corot_model *m, const double (*A)[9], const double *x, double *y) {
  const pattern *p = &solid_of(m)->pattern;
  for (int i = 0; i < m->ndof; i++) y[i] = 0;
  for (int j = 0; j < p->nnode; j++) {
    const int *dj = m->dof[j];
    double xj[3], yj[3] = {0, 0, 0};
    for (int c = 0; c < 3; c++) xj[c] = dj[c] >= 0 ? x[dj[c]] : 0;
    for (int k = p->colptr[j]; k < p->colptr[j + 1]; k++) {
      const double *a = A[k];
      const int *di = m->dof[p->row[k]];
      for (int r = 0; r < 3; r++) {
        if (di[r] < 0) continue;
        y[di[r]] += a[3 * r] * xj[0] + a[3 * r + 1] * xj[1] + a[3 * r + 2] * xj[2];
        if (k == p->colptr[j]) continue; /* the diagonal block counts once */
        for (int c = 0; c < 3; c++) yj[c] += a[3 * r + c] * x[di[r]];
      }
    }
    for (int c = 0; c < 3; c++)
      if (dj[c] >= 0) y[dj[c]] += yj[c];
  }
}

/* The column of each block [nblock]. Those of a whole column j, rows ascending, are the transposed
   ones of row j left of the diagonal, then those of the lower triangle. */
static corot_status list_columns(const pattern *p, int **column) {
  *column = malloc(p->nblock * sizeof **column);
  if (!*column) return corot_fail(COROT_ENOMEM, "no memory for a matrix of %d blocks", p->nblock);
  for (int j = 0; j < p->nnode; j++)
    for (int k = p->colptr[j]; k < p->colptr[j + 1]; k++) (*column)[k] = j;
  return COROT_OK;
}

/* The entries of one column, or only their number if `csc` has no room yet; of_block [nblock] is
   asked for a full matrix only. */
static int fill_column(const corot_model *m, const int *of_block, corot_triangle triangle, int j,
                       int c, corot_csc *csc, int nnz) {
  const pattern *p = &solid_of(m)->pattern;
  int column = m->dof[j][c];
  if (triangle == COROT_FULL)
    for (int k = p->left_first[j]; k < p->left_first[j + 1]; k++)
      for (int r = 0; r < 3; r++) {
        int i = m->dof[of_block[p->left[k]]][r];
        if (i < 0) continue;
        if (csc->row) csc->row[nnz] = i, csc->source[nnz] = 9 * p->left[k] + 3 * c + r;
        nnz++;
      }
  for (int k = p->colptr[j]; k < p->colptr[j + 1]; k++)
    for (int r = 0; r < 3; r++) {
      int i = m->dof[p->row[k]][r];
      if (i < 0 || (triangle == COROT_LOWER && i < column)) continue;
      if (csc->row) {
        csc->row[nnz] = i, csc->source[nnz] = 9 * k + 3 * r + c;
        if (i == column) csc->diagonal[column] = nnz;
      }
      nnz++;
    }
  return nnz;
}

static corot_status fill(const corot_model *m, corot_triangle triangle, const int *of_block,
                         corot_csc *csc) {
  csc->n = m->ndof;
  csc->colptr = malloc((csc->n + 1) * sizeof *csc->colptr);
  csc->diagonal = malloc(csc->n * sizeof *csc->diagonal);
  csc->node = malloc(csc->n * sizeof *csc->node);
  if (!csc->colptr || !csc->diagonal || !csc->node)
    return corot_fail(COROT_ENOMEM, "no memory for a matrix of %d columns", csc->n);
  for (int pass = 0; pass < 2; pass++) { /* count, then write */
    int nnz = 0;
    for (int j = 0; j < solid_of(m)->pattern.nnode; j++)
      for (int c = 0; c < 3; c++) {
        if (m->dof[j][c] < 0) continue;
        csc->colptr[m->dof[j][c]] = nnz;
        csc->node[m->dof[j][c]] = j;
        nnz = fill_column(m, of_block, triangle, j, c, csc, nnz);
        if (nnz > INT_MAX - 9 * solid_of(m)->pattern.nnode)
          return corot_fail(COROT_EINVAL, "the matrix exceeds 32-bit counts at node %d", j);
      }
    csc->nnz = csc->colptr[csc->n] = nnz;
    if (pass == 1) break;
    csc->row = malloc(nnz * sizeof *csc->row);
    csc->source = malloc(nnz * sizeof *csc->source);
    if (!csc->row || !csc->source)
      return corot_fail(COROT_ENOMEM, "no memory for a matrix of %d entries", nnz);
  }
  return COROT_OK;
}

corot_status corot_csc_create(const corot_model *m, corot_triangle triangle, corot_csc **csc) {
  COROT_TRY(COROT_GIVEN_AS(m, "model"));
  COROT_TRY(COROT_GIVEN(csc));
  int *of_block = NULL;
  corot_csc *made = calloc(1, sizeof *made);
  corot_status status = COROT_OK;
  if (!made) status = corot_fail(COROT_ENOMEM, "no memory for a matrix");
  if (!status && triangle == COROT_FULL) status = list_columns(&solid_of(m)->pattern, &of_block);
  if (!status) status = fill(m, triangle, of_block, made);
  free(of_block);
  if (status) {
    corot_csc_destroy(made);
    return status;
  }
  *csc = made;
  return COROT_OK;
}

void corot_csc_destroy(corot_csc *csc) {
  if (!csc) return;
  free(csc->colptr);
  free(csc->row);
  free(csc->source);
  free(csc->diagonal);
  free(csc->node);
  free(csc);
}

void corot_csc_combine(const corot_model *m, const corot_csc *csc, double a, double b,
                       const double (*D)[9], double c, const double (*K)[9], double *value) {
  corot_csc_combine_columns(m, csc, a, b, D, c, K, 0, csc->n, value);
}

void corot_csc_combine_columns(const corot_model *m, const corot_csc *csc, double a, double b,
                               const double (*D)[9], double c, const double (*K)[9], int from,
                               int end, double *value) {
  const double *d = D ? D[0] : NULL, *k = K ? K[0] : NULL;
  const int *source = csc->source;
  int first = csc->colptr[from], last = csc->colptr[end];
  if (d && k) {
    for (int p = first; p < last; p++) value[p] = b * d[source[p]] + c * k[source[p]];
  } else {
    const double *only = d ? d : k, factor = d ? b : c;
    for (int p = first; p < last; p++) value[p] = only ? factor * only[source[p]] : 0;
  }
  if (!m->mass_pair) {
    for (int i = from; i < end; i++) value[csc->diagonal[i]] += a * m->mass[i];
    return;
  }
  for (int p = first; p < last; p++) /* of a block, the mass is on the diagonal: 0, 4, 8 */
    if (source[p] % 9 % 4 == 0) value[p] += a * m->mass_pair[source[p] / 9];
}
