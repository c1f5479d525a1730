/* CHOLMOD: sparse Cholesky, by dense blocks where the factor is large enough for them to pay. A
   pivot that is not positive is an answer, not an accident: the matrix is indefinite. */
#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <suitesparse/cholmod.h>

#include "blas_room.h"
#include "linsol.h"

typedef struct cholesky {
  const corot_csc *pattern;
  cholmod_common common;
  cholmod_sparse A; /* view of the pattern; its values are the caller's */
  cholmod_factor *L;
  bool factored;
  cholmod_dense *b, *x, *y, *e; /* right-hand side, solution, and cholmod's workspace */
} cholesky;

static corot_status not_positive(const cholesky *c) {
  int dof = ((const int *)c->L->Perm)[c->L->minor];
  return corot_fail(
      COROT_RETRY, "cholmod: the matrix is not positive definite (degree of freedom %d of node %d)",
      dof, c->pattern->node[dof]);
}

static corot_status failure(const cholesky *c, const char *phase) {
  int status = c->common.status;
  if (status == CHOLMOD_NOT_POSDEF) return not_positive(c);
  if (status == CHOLMOD_OUT_OF_MEMORY)
    return corot_fail(COROT_ENOMEM, "cholmod: %s: out of memory", phase);
  return corot_fail(COROT_EINVAL, "cholmod: %s failed (status %d)", phase, status);
}

static void cholesky_destroy(void *solver) {
  cholesky *c = solver;
  if (!c) return;
  cholmod_free_factor(&c->L, &c->common);
  cholmod_free_dense(&c->b, &c->common);
  cholmod_free_dense(&c->x, &c->common);
  cholmod_free_dense(&c->y, &c->common);
  cholmod_free_dense(&c->e, &c->common);
  cholmod_finish(&c->common);
  free(c);
}

static cholmod_dense *vector(cholesky *c, size_t n) {
  return cholmod_allocate_dense(n, 1, n, CHOLMOD_REAL, &c->common);
}

/* Analysis, and all the room a solve needs: cholmod before version 4 crashes if it finds none. */
static bool analyze(cholesky *c, int *order) {
  size_t n = c->A.nrow;
  return (c->L = cholmod_analyze_p(&c->A, order, NULL, 0, &c->common)) && (c->b = vector(c, n)) &&
         (c->x = vector(c, n)) && (c->y = vector(c, n)) && (c->e = vector(c, c->L->maxesize));
}

/* Supernodes of fewer columns than these are merged, whatever that fills (the first), or while it
   fills little. Of three columns a node, today's BLAS gains from some more than cholmod's own
   limits of 4, 16 and 48 allow: a factorisation takes 15 to 25 % less time, a solution as much. */
static void merge_supernodes(cholmod_common *common) {
  static const size_t columns[] = {24, 48, 128};
  for (int i = 0; i < 3; i++) common->nrelax[i] = columns[i];
}

static corot_status cholesky_create(const corot_csc *pattern, const linsol_plan *plan,
                                    void **solver) {
  if (strcmp(plan->def.factor, "supernodal") == 0) COROT_TRY(corot_blas_room());
  cholesky *c = calloc(1, sizeof *c);
  if (!c) return corot_fail(COROT_ENOMEM, "no memory for cholmod");
  c->pattern = pattern;
  cholmod_start(&c->common);
  c->common.nmethods = 1;
  c->common.method[0].ordering = CHOLMOD_GIVEN;
  c->common.supernodal =
      strcmp(plan->def.factor, "supernodal") == 0 ? CHOLMOD_SUPERNODAL : CHOLMOD_SIMPLICIAL;
  merge_supernodes(&c->common);
  c->common.print = 0;
  c->common.error_handler = NULL;
  c->common.final_ll = 1; /* L L', so that a negative pivot stops it */
  c->common.quick_return_if_not_posdef = 1;
  c->A = (cholmod_sparse){.nrow = pattern->n,
                          .ncol = pattern->n,
                          .nzmax = pattern->nnz,
                          .p = pattern->colptr,
                          .i = pattern->row,
                          .stype = -1, /* lower triangle */
                          .itype = CHOLMOD_INT,
                          .xtype = CHOLMOD_PATTERN,
                          .dtype = CHOLMOD_DOUBLE,
                          .sorted = 1,
                          .packed = 1};
  if (!analyze(c, plan->order)) {
    corot_status status = failure(c, "analysis");
    cholesky_destroy(c);
    return status;
  }
  c->A.xtype = CHOLMOD_REAL;
  *solver = c;
  return COROT_OK;
}

/* Where the diagonal of L is smallest, or not a number. */
static int smallest_pivot(const cholmod_factor *L) {
  const int *first = L->is_super ? L->super : NULL, *at = L->is_super ? L->px : L->p;
  const int *rows = L->pi;
  const double *x = L->x;
  double smallest = INFINITY;
  int where = 0;
  for (int j = 0, s = 0; j < (int)L->n && !isnan(smallest); j++) {
    if (first && j == first[s + 1]) s++;
    double pivot = first ? x[at[s] + (j - first[s]) * (rows[s + 1] - rows[s] + 1)] : x[at[j]];
    if (!(pivot >= smallest)) smallest = pivot, where = j;
  }
  return ((const int *)L->Perm)[where];
}

static corot_status cholesky_factor(void *solver, const double *value, bool *fresh) {
  cholesky *c = solver;
  *fresh = true;
  c->A.x = (double *)value; /* cholmod does not write to it */
  cholmod_factorize(&c->A, c->L, &c->common);
  c->factored = false;
  if (c->common.status != CHOLMOD_OK) return failure(c, "factorisation");
  double ratio = cholmod_rcond(c->L, &c->common);
  c->factored = ratio >= (double)c->A.nrow * DBL_EPSILON;
  if (c->factored) return COROT_OK;
  return corot_linsol_singular(c->pattern, "cholmod", smallest_pivot(c->L), ratio);
}

static corot_status cholesky_solve(void *solver, double *x) {
  cholesky *c = solver;
  if (!c->factored) return corot_fail(COROT_EINVAL, "cholmod: solve: there is no factor");
  memcpy(c->b->x, x, c->b->nrow * sizeof *x);
  if (!cholmod_solve2(CHOLMOD_A, c->L, c->b, NULL, &c->x, NULL, &c->y, &c->e, &c->common))
    return failure(c, "solve");
  memcpy(x, c->x->x, c->b->nrow * sizeof *x);
  return COROT_OK;
}

static const linsol_variant variants[] = {
    {.name = "cholmod simplicial, amd", .factor = "simplicial", .ordering = "amd"},
    {.name = "cholmod simplicial, metis", .factor = "simplicial", .ordering = "metis"},
    {.name = "cholmod supernodal, amd", .factor = "supernodal", .ordering = "amd"},
    {.name = "cholmod supernodal, metis", .factor = "supernodal", .ordering = "metis"},
    {.name = NULL},
};

const linsol_ops corot_linsol_cholmod = {
    .name = "cholmod",
    .variants = variants,
    .triangle = COROT_LOWER,
    .create = cholesky_create,
    .factor = cholesky_factor,
    .solve = cholesky_solve,
    .destroy = cholesky_destroy,
};
