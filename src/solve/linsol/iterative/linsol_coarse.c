/* The matrix of level 0 in columns. */
#include "linsol_coarse.h"

#include <stdlib.h>
#include <string.h>

#include "linsol_multilevel.h"

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

static corot_status make_lower(const corot_csc *csc, const node_matrix *A,
                               const galerkin_level *level, corot_csc **out) {
  int n = 0, *first = malloc((level->n + 1) * sizeof *first);
  if (!first) return corot_fail(COROT_ENOMEM, "no memory for %d nodes of level 0", level->n);
  for (int i = 0; i < level->n; i++) {
    first[i] = n;
    while (n < csc->n && A->slot[n] / 3 == i) n++;
  }
  first[level->n] = n;
  corot_status status = corot_bottom_allocate(n, out);
  if (!status)
    status = corot_bottom_allocate_entries(list_entries(level, A->slot, first, *out), *out);
  if (!status) list_entries(level, A->slot, first, *out);
  if (!status) memcpy((*out)->node, csc->node, n * sizeof *(*out)->node);
  free(first);
  return status;
}

/* From so many unknowns on (a factor of them takes a second or more), a V-cycle. */
enum { MANY = 30000 };

static corot_status make_amg(const linsol_plan *plan, coarse_level *c) {
  c->value = malloc(c->csc->nnz * sizeof *c->value);
  if (!c->value) return corot_fail(COROT_ENOMEM, "no memory for %d entries", c->csc->nnz);
  COROT_TRY(corot_nodes_create(c->csc, false, &c->A));
  return corot_amg.create(c->csc, &c->A, plan, &c->amg);
}

corot_status corot_coarse_create(const corot_csc *csc, const node_matrix *A,
                                 const galerkin_level *level, const linsol_plan *plan,
                                 coarse_level *c) {
  *c = (coarse_level){.level = level, .slot = A->slot};
  COROT_TRY(make_lower(csc, A, level, &c->csc));
  if (c->csc->n > (plan->most_direct > 0 ? plan->most_direct : MANY)) return make_amg(plan, c);
  corot_csc *lower = c->csc;
  c->csc = NULL;
  return corot_bottom_create(lower, &c->bottom);
}

void corot_coarse_clear(coarse_level *c) {
  corot_bottom_clear(&c->bottom);
  if (c->amg) corot_amg.destroy(c->amg);
  corot_nodes_clear(&c->A);
  corot_csc_destroy(c->csc);
  free(c->value);
}

static corot_status factor(coarse_level *c) {
  int at;
  if (!c->amg) return corot_bottom_factor(&c->bottom, c->level->value);
  for (int p = 0; p < c->csc->nnz; p++) c->value[p] = c->level->value[c->csc->source[p]];
  corot_nodes_load(&c->A, c->csc, c->value);
  if (!corot_nodes_jacobi(&c->A, &at)) return corot_nodes_indefinite(&c->A, c->csc, at);
  return corot_amg.factor(c->amg);
}

corot_status corot_coarse_factor(coarse_level *c) {
  corot_status status = factor(c);
  return status ? corot_fail(status, "pcg, level 0: %s", corot_error()) : COROT_OK;
}

/* Held components of v are zero, and stay so. */
static corot_status cycle(coarse_level *c, double *v) {
  corot_nodes_scale(&c->A, v);
  COROT_TRY(corot_amg.apply(c->amg, v, v));
  corot_nodes_unscale_transposed(&c->A, v);
  return COROT_OK;
}

static void clear_held(const coarse_level *c, double *v) {
  for (int i = 0; i < c->csc->n; i++) c->value[i] = v[c->slot[i]];
  memset(v, 0, 3 * (size_t)c->level->n * sizeof *v);
  for (int i = 0; i < c->csc->n; i++) v[c->slot[i]] = c->value[i];
}

corot_status corot_coarse_solve(coarse_level *c, double (*v)[3]) {
  double *at = v[0], *x = c->bottom.x;
  if (c->amg) {
    clear_held(c, at);
    return cycle(c, at);
  }
  int n = c->bottom.s.csc->n;
  for (int i = 0; i < n; i++) x[i] = at[c->slot[i]];
  COROT_TRY(corot_bottom_solve(&c->bottom));
  memset(v, 0, c->level->n * sizeof *v);
  for (int i = 0; i < n; i++) at[c->slot[i]] = x[i];
  return COROT_OK;
}
