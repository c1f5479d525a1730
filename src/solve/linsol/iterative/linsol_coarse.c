/* The matrix of level 0 in columns, factorised by the direct solver that is there. */
#include "linsol_coarse.h"

#include <stdlib.h>
#include <string.h>

/* The lower triangle of the free unknowns, those of node i being first[i] to first[i + 1] - 1.
   Counts only if there is no room yet. */
static int list_entries(const galerkin_level *level, const int *slot, const int *first,
                        corot_csc *csc) {
  int nnz = 0;
  for (int j = 0; j < csc->n; j++) {
    int node = slot[j] / 3, c = slot[j] % 3;
    csc->colptr[j] = csc->diagonal[j] = nnz;
    for (int k = level->colptr[node] - 1; k < level->colptr[node + 1]; k++) {
      bool own = k < level->colptr[node];
      int other = own ? node : level->row[k], block = own ? node : level->n + k;
      for (int i = own ? j : first[other]; i < first[other + 1]; i++, nnz++)
        if (csc->row) csc->row[nnz] = i, csc->source[nnz] = 9 * block + 3 * c + slot[i] % 3;
    }
  }
  return csc->colptr[csc->n] = csc->nnz = nnz;
}

static corot_status allocate(int n, corot_csc **out) {
  corot_csc *csc = *out = calloc(1, sizeof *csc);
  if (!csc) return corot_fail(COROT_ENOMEM, "no memory for a matrix");
  csc->n = n;
  csc->colptr = calloc(n + 1, sizeof *csc->colptr);
  csc->diagonal = malloc((n + 1) * sizeof *csc->diagonal);
  csc->node = malloc((n + 1) * sizeof *csc->node);
  if (csc->colptr && csc->diagonal && csc->node) return COROT_OK;
  return corot_fail(COROT_ENOMEM, "no memory for a matrix of %d columns", n);
}

static corot_status allocate_entries(int nnz, corot_csc *csc) {
  csc->row = malloc((nnz + 1) * sizeof *csc->row);
  csc->source = malloc((nnz + 1) * sizeof *csc->source);
  if (csc->row && csc->source) return COROT_OK;
  return corot_fail(COROT_ENOMEM, "no memory for a matrix of %d entries", nnz);
}

static corot_status make_lower(const corot_csc *csc, const node_matrix *A,
                               const galerkin_level *level, corot_csc **out) {
  int n = 0, *first = malloc((level->n + 1) * sizeof *first);
  if (!first) return corot_fail(COROT_ENOMEM, "no memory for %d nodes of level 0", level->n);
  for (int i = 0; i < level->n; i++) {
    first[i] = n;
    while (n < csc->n && A->slot[n] / 3 == i) n++;
  }
  first[level->n] = n;
  corot_status status = allocate(n, out);
  if (!status) status = allocate_entries(list_entries(level, A->slot, first, *out), *out);
  if (!status) list_entries(level, A->slot, first, *out);
  if (!status) memcpy((*out)->node, csc->node, n * sizeof *(*out)->node);
  free(first);
  return status;
}

/* Both triangles, rows ascending. */
static corot_status make_full(const corot_csc *lower, corot_csc **out) {
  int n = lower->n;
  COROT_TRY(allocate(n, out));
  corot_csc *full = *out;
  COROT_TRY(allocate_entries(2 * lower->nnz - n, full));
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

static corot_status make_direct(coarse_level *c) {
  linsol_plan plan = {0};
  corot_linear_def how = corot_linear_defaults();
  how.solver = corot_linsol_direct;
  COROT_TRY(corot_linsol_choose(&how, c->s.csc, &plan));
  corot_status status = make_solver(&plan, &c->s);
  corot_linsol_plan_clear(&plan);
  return status;
}

corot_status corot_coarse_create(const corot_csc *csc, const node_matrix *A,
                                 const galerkin_level *level, coarse_level *c) {
  *c = (coarse_level){.level = level, .slot = A->slot};
  COROT_TRY(make_lower(csc, A, level, &c->s.csc));
  if (c->s.csc->n == 0) return COROT_OK;
  c->x = malloc(c->s.csc->n * sizeof *c->x);
  if (!c->x) return corot_fail(COROT_ENOMEM, "no memory for %d unknowns", c->s.csc->n);
  return make_direct(c);
}

void corot_coarse_clear(coarse_level *c) {
  corot_linsol_clear(&c->s);
  free(c->x);
}

/* Of the solvers, some do not object to a matrix that is indefinite: these can count. What follows
   from the values alone does not depend on the factors before. */
static corot_status factor(coarse_level *c) {
  linsol *s = &c->s;
  int negative;
  bool fresh;
  for (int p = 0; p < s->csc->nnz; p++) s->value[p] = c->level->value[s->csc->source[p]];
  COROT_TRY(corot_linsol_count_negative(s, s->value, &negative));
  if (negative > 0)
    return corot_fail(COROT_RETRY, "the matrix is not positive definite (%d negative pivots)",
                      negative);
  if (s->ops->forget) s->ops->forget(s->solver);
  return s->ops->factor(s->solver, s->value, &fresh);
}

corot_status corot_coarse_factor(coarse_level *c) {
  corot_status status = c->s.solver ? factor(c) : COROT_OK;
  return status ? corot_fail(status, "pcg, level 0: %s", corot_error()) : COROT_OK;
}

corot_status corot_coarse_solve(coarse_level *c, double (*v)[3]) {
  double *at = v[0];
  int n = c->s.csc->n;
  for (int i = 0; i < n; i++) c->x[i] = at[c->slot[i]];
  if (c->s.solver) COROT_TRY(c->s.ops->solve(c->s.solver, c->x));
  memset(v, 0, c->level->n * sizeof *v);
  for (int i = 0; i < n; i++) at[c->slot[i]] = c->x[i];
  return COROT_OK;
}
