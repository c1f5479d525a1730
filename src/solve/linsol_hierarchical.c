#include "solve/linsol_hierarchical.h"

#include <stdlib.h>
#include <string.h>

#include "core/simd.h"

corot_status corot_hierarchical_create(const corot_csc *csc, const node_matrix *A,
                                       const corot_refinement *refinement, hierarchical *h) {
  *h = (hierarchical){.A = A, .csc = csc};
  COROT_TRY(corot_galerkin_create(csc, A, refinement, &h->levels));
  size_t n = A->n, later = n - h->levels.level[0].n;
  h->inverse = malloc((later + 1) * sizeof *h->inverse);
  h->v = malloc((n + 1) * sizeof *h->v);
  if (!h->inverse || !h->v)
    return corot_fail(COROT_ENOMEM, "no memory for the hierarchical basis of %zu nodes", n);
  return corot_coarse_create(csc, A, &h->levels.level[0], &h->coarse);
}

void corot_hierarchical_clear(hierarchical *h) {
  corot_galerkin_clear(&h->levels);
  corot_coarse_clear(&h->coarse);
  free(h->inverse), free(h->v);
}

/* --- factors --- */

static corot_status invert_blocks(hierarchical *h) {
  const galerkin *g = &h->levels;
  int i = g->level[0].n;
  double(*inverse)[9] = h->inverse;
  for (int l = 1; l <= g->nlevel; l++)
    for (; i < g->level[l].n; i++, inverse++) {
      double D[9];
      memcpy(D, g->level[l].value + 9 * (size_t)i, sizeof D);
      for (int c = 0; c < 3; c++)
        if (g->held[i] >> c & 1) D[4 * c] = 1;
      if (!corot_nodes_invert(D, *inverse)) return corot_nodes_indefinite(h->A, h->csc, i);
    }
  return COROT_OK;
}

corot_status corot_hierarchical_factor(hierarchical *h) {
  corot_galerkin_load(&h->levels);
  COROT_TRY(invert_blocks(h));
  return corot_coarse_factor(&h->coarse);
}

/* --- products --- */

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

corot_status corot_hierarchical_apply(hierarchical *h, const double *r, double *z) {
  int n = h->levels.n;
  memcpy(h->v, r, n * sizeof *h->v);
  memset(h->v[n], 0, sizeof *h->v);
  descend(&h->levels, (const double(*)[9])h->inverse, h->v);
  COROT_TRY(corot_coarse_solve(&h->coarse, h->v));
  memset(h->v[n], 0, sizeof *h->v);
  ascend(&h->levels, h->v);
  memcpy(z, h->v, n * sizeof *h->v);
  return COROT_OK;
}
