/* The Newton matrix I - gamma J of y = (u, v) in full, 2n x 2n, as a sparse matrix of SUNDIALS: what
   the pencil stands for and never forms. */
#ifndef FULL_SYSTEM_H
#define FULL_SYSTEM_H

#include <sunmatrix/sunmatrix_sparse.h>

#include "bar.h"

typedef struct full_system {
  const corot_model *model;
  corot_state *state;
  corot_csc *csc;
  double (*K)[9], (*D)[9];
  double *k, *d; /* [csc->nnz] */
} full_system;

static inline full_system full_create(const bar *b) {
  full_system f = {.model = b->model, .state = b->state};
  assert_ok(corot_csc_create(b->model, COROT_FULL, &f.csc));
  int nblock = corot_model_nblock(b->model);
  f.K = malloc(2 * nblock * sizeof *f.K);
  f.D = f.K + nblock;
  f.k = malloc(2 * f.csc->nnz * sizeof *f.k);
  f.d = f.k + f.csc->nnz;
  return f;
}

static inline void full_destroy(full_system *f) {
  corot_csc_destroy(f->csc);
  free(f->K), free(f->k);
}

static inline int full_nnz(const full_system *f) { return 2 * (f->csc->n + f->csc->nnz); }

/* A = identity - gamma J at y, J = [0, 1; -M^-1 K, -M^-1 D]; J itself for identity 0, gamma -1. */
static inline corot_status full_fill(const full_system *f, double t, const double *y,
                                     double identity_part, double gamma, SUNMatrix A) {
  int n = f->csc->n;
  const double *mass = corot_model_mass(f->model);
  COROT_TRY(corot_jacobian(f->model, f->state, t, y, y + n, COROT_TANGENT_HELD, f->K, f->D));
  corot_csc_combine(f->model, f->csc, 0, 0, NULL, 1, (const double(*)[9])f->K, f->k);
  corot_csc_combine(f->model, f->csc, 0, 1, (const double(*)[9])f->D, 0, NULL, f->d);
  sunindextype *start = SM_INDEXPTRS_S(A), *row = SM_INDEXVALS_S(A), nnz = 0;
  double *value = SM_DATA_S(A);
  for (int column = 0; column < 2 * n; column++) {
    bool right = column >= n;
    int j = right ? column - n : column;
    start[column] = nnz;
    row[nnz] = j;
    value[nnz++] = right ? -gamma : identity_part;
    for (int p = f->csc->colptr[j]; p < f->csc->colptr[j + 1]; p++) {
      int i = f->csc->row[p];
      row[nnz] = n + i;
      value[nnz++] = gamma * (right ? f->d : f->k)[p] / mass[i] + (right && i == j) * identity_part;
    }
  }
  start[2 * n] = nnz;
  return COROT_OK;
}

#endif
