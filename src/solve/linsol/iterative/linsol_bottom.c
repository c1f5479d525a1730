/* A matrix in columns, factorised by the direct solver that is there. */
#include "linsol_bottom.h"

#include <stdlib.h>
#include <string.h>

corot_status corot_bottom_allocate(int n, corot_csc **out) {
  corot_csc *csc = *out = calloc(1, sizeof *csc);
  if (!csc) return corot_fail(COROT_ENOMEM, "no memory for a matrix");
  csc->n = n;
  csc->colptr = calloc(n + 1, sizeof *csc->colptr);
  csc->diagonal = malloc((n + 1) * sizeof *csc->diagonal);
  csc->node = malloc((n + 1) * sizeof *csc->node);
  if (csc->colptr && csc->diagonal && csc->node) return COROT_OK;
  return corot_fail(COROT_ENOMEM, "no memory for a matrix of %d columns", n);
}

corot_status corot_bottom_allocate_entries(int nnz, corot_csc *csc) {
  csc->row = malloc((nnz + 1) * sizeof *csc->row);
  csc->source = malloc((nnz + 1) * sizeof *csc->source);
  if (csc->row && csc->source) return COROT_OK;
  return corot_fail(COROT_ENOMEM, "no memory for a matrix of %d entries", nnz);
}

/* Both triangles, rows ascending. */
static corot_status make_full(const corot_csc *lower, corot_csc **out) {
  int n = lower->n;
  COROT_TRY(corot_bottom_allocate(n, out));
  corot_csc *full = *out;
  COROT_TRY(corot_bottom_allocate_entries(2 * lower->nnz - n, full));
  int *next = full->diagonal; /* for now: where each column's next entry goes */
  for (int p = 0; p < lower->nnz; p++) full->colptr[lower->row[p] + 1]++; /* with the diagonal */
  for (int j = 0; j < n; j++) {
    next[j] = full->colptr[j];
    full->colptr[j + 1] += full->colptr[j] + lower->colptr[j + 1] - lower->colptr[j] - 1;
  }
  for (int j = 0; j < n; j++) { /* the upper part of column j is there, from the rows before */
    int diagonal = next[j];
    for (int p = lower->colptr[j]; p < lower->colptr[j + 1]; p++) {
      int i = lower->row[p], at = diagonal + (p - lower->colptr[j]);
      full->row[at] = i, full->source[at] = lower->source[p];
      if (i == j) continue;
      full->row[next[i]] = j, full->source[next[i]++] = lower->source[p];
    }
    full->diagonal[j] = diagonal;
  }
  full->nnz = full->colptr[n];
  memcpy(full->node, lower->node, n * sizeof *full->node);
  return COROT_OK;
}

static corot_status make_solver(const linsol_plan *plan, linsol *s) {
  s->ops = plan->ops;
  s->name = plan->name;
  if (s->ops->triangle == COROT_FULL) {
    corot_csc *full = NULL;
    corot_status status = make_full(s->csc, &full);
    corot_csc_destroy(s->csc);
    s->csc = full;
    COROT_TRY(status);
  }
  s->value = malloc(s->csc->nnz * sizeof *s->value);
  if (!s->value) return corot_fail(COROT_ENOMEM, "no memory for %d entries", s->csc->nnz);
  return s->ops->create(s->csc, plan, &s->solver);
}

static corot_status make_direct(bottom *b) {
  linsol_plan plan = {0};
  corot_linear_def how = corot_linear_defaults();
  how.solver = corot_linsol_direct;
  COROT_TRY(corot_linsol_choose(&how, b->s.csc, &plan));
  corot_status status = make_solver(&plan, &b->s);
  corot_linsol_plan_clear(&plan);
  return status;
}

corot_status corot_bottom_create(corot_csc *lower, bottom *b) {
  *b = (bottom){.s = {.csc = lower}};
  if (lower->n == 0) return COROT_OK;
  b->x = malloc(lower->n * sizeof *b->x);
  if (!b->x) return corot_fail(COROT_ENOMEM, "no memory for %d unknowns", lower->n);
  return make_direct(b);
}

void corot_bottom_clear(bottom *b) {
  corot_linsol_clear(&b->s);
  free(b->x);
}

/* Of the solvers, some do not object to a matrix that is indefinite: these can count. What follows
   from the values alone does not depend on the factors before. */
corot_status corot_bottom_factor(bottom *b, const double *value) {
  linsol *s = &b->s;
  int negative;
  bool fresh;
  if (!s->solver) return COROT_OK;
  for (int p = 0; p < s->csc->nnz; p++) s->value[p] = value[s->csc->source[p]];
  COROT_TRY(corot_linsol_count_negative(s, s->value, &negative));
  if (negative > 0)
    return corot_fail(COROT_RETRY, "the matrix is not positive definite (%d negative pivots)",
                      negative);
  if (s->ops->forget) s->ops->forget(s->solver);
  return s->ops->factor(s->solver, s->value, &fresh);
}

corot_status corot_bottom_solve(bottom *b) {
  return b->s.solver ? b->s.ops->solve(b->s.solver, b->x) : COROT_OK;
}
