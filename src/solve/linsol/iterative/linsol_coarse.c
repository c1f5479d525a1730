/* The matrix of level 0 in columns. */
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

corot_status corot_coarse_create(const corot_csc *csc, const node_matrix *A,
                                 const galerkin_level *level, coarse_level *c) {
  *c = (coarse_level){.level = level, .slot = A->slot};
  corot_csc *lower = NULL;
  corot_status status = make_lower(csc, A, level, &lower);
  if (!status) return corot_bottom_create(lower, &c->bottom);
  corot_csc_destroy(lower);
  return status;
}

void corot_coarse_clear(coarse_level *c) { corot_bottom_clear(&c->bottom); }

corot_status corot_coarse_factor(coarse_level *c) {
  corot_status status = corot_bottom_factor(&c->bottom, c->level->value);
  return status ? corot_fail(status, "pcg, level 0: %s", corot_error()) : COROT_OK;
}

corot_status corot_coarse_solve(coarse_level *c, double (*v)[3]) {
  double *at = v[0], *x = c->bottom.x;
  int n = c->bottom.s.csc->n;
  for (int i = 0; i < n; i++) x[i] = at[c->slot[i]];
  COROT_TRY(corot_bottom_solve(&c->bottom));
  memset(v, 0, c->level->n * sizeof *v);
  for (int i = 0; i < n; i++) at[c->slot[i]] = x[i];
  return COROT_OK;
}
