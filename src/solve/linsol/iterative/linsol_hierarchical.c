/* Preconditioner in the hierarchical basis: block Jacobi above, a direct solve on level 0. */
#include <stdlib.h>
#include <string.h>

#include "core/lanes/simd.h"
#include "linsol_coarse.h"
#include "linsol_multilevel.h"

typedef struct basis {
  const corot_csc *csc;
  const node_matrix *A;
  galerkin levels;
  coarse_level coarse;
  double (*inverse)[9]; /* [nodes not of level 0] of their blocks of D */
  double (*v)[3];       /* [nodes + 1] the last stands for all that are wholly held */
} basis;

static void basis_destroy(void *self) {
  basis *b = self;
  if (!b) return;
  corot_galerkin_clear(&b->levels);
  corot_coarse_clear(&b->coarse);
  free(b->inverse);
  free(b->v);
  free(b);
}

static corot_status fill(const linsol_plan *plan, basis *b) {
  COROT_TRY(corot_galerkin_create(b->csc, b->A, plan->def.refinement, &b->levels));
  size_t n = b->A->n, later = n - b->levels.level[0].n;
  b->inverse = malloc((later + 1) * sizeof *b->inverse);
  b->v = malloc((n + 1) * sizeof *b->v);
  if (!b->inverse || !b->v)
    return corot_fail(COROT_ENOMEM, "no memory for the hierarchical basis of %zu nodes", n);
  return corot_coarse_create(b->csc, b->A, &b->levels.level[0], plan, &b->coarse);
}

static corot_status basis_create(const corot_csc *csc, const node_matrix *A,
                                 const linsol_plan *plan, void **self) {
  basis *b = calloc(1, sizeof *b);
  if (!b) return corot_fail(COROT_ENOMEM, "no memory for a hierarchical basis");
  b->csc = csc, b->A = A;
  corot_status status = fill(plan, b);
  if (status) {
    basis_destroy(b);
    return status;
  }
  *self = b;
  return COROT_OK;
}

static corot_status basis_factor(void *self) {
  basis *b = self;
  const galerkin *g = &b->levels;
  int n0 = g->level[0].n;
  corot_galerkin_load(&b->levels);
  for (int l = 1; l <= g->nlevel; l++) {
    int first = g->level[l - 1].n, at = corot_galerkin_invert(g, l, first, b->inverse + first - n0);
    if (at >= 0) return corot_nodes_indefinite(b->A, b->csc, at);
  }
  return corot_coarse_factor(&b->coarse);
}

static void clear_held(int held, double v[3]) {
  for (int c = 0; c < 3; c++)
    if (held >> c & 1) v[c] = 0;
}

/* v = D^-1 T' v but for level 0: a node's children have higher numbers. */
static COROT_CLONES void descend(const galerkin *g, const double (*inverse)[9], double (*v)[3]) {
  int first = g->level[0].n;
  for (int i = g->n - 1; i >= first; i--) {
    double *own = v[i], *p = v[g->parent[i - first][0]], *q = v[g->parent[i - first][1]];
    const double *B = inverse[i - first];
    if (g->held[i]) clear_held(g->held[i], own);
    double a = own[0], b = own[1], c = own[2];
    p[0] += a / 2, p[1] += b / 2, p[2] += c / 2;
    q[0] += a / 2, q[1] += b / 2, q[2] += c / 2;
    for (int k = 0; k < 3; k++) own[k] = B[k] * a + B[3 + k] * b + B[6 + k] * c;
  }
}

/* v = T v */
static COROT_CLONES void ascend(const galerkin *g, double (*v)[3]) {
  int first = g->level[0].n;
  for (int i = first; i < g->n; i++) {
    double *own = v[i];
    const double *p = v[g->parent[i - first][0]], *q = v[g->parent[i - first][1]];
    for (int k = 0; k < 3; k++) own[k] += (p[k] + q[k]) / 2;
    if (g->held[i]) clear_held(g->held[i], own);
  }
}

static corot_status basis_apply(void *self, const double *r, double *z) {
  basis *b = self;
  int n = b->levels.n;
  memcpy(b->v, r, n * sizeof *b->v);
  descend(&b->levels, (const double(*)[9])b->inverse, b->v);
  COROT_TRY(corot_coarse_solve(&b->coarse, b->v));
  memset(b->v[n], 0, sizeof *b->v);
  ascend(&b->levels, b->v);
  memcpy(z, b->v, n * sizeof *b->v);
  return COROT_OK;
}

const multilevel_ops corot_hierarchical_basis = {
    .name = "hierarchical",
    .refined = true,
    .create = basis_create,
    .factor = basis_factor,
    .apply = basis_apply,
    .destroy = basis_destroy,
};
