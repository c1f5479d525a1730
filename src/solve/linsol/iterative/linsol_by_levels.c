/* Counting sorts: of the unknowns by their nodes, of the entries by rows, then by columns. */
#include "linsol_by_levels.h"

#include <stdlib.h>
#include <string.h>

static corot_status allocate(const corot_csc *csc, ordered_csc *o) {
  size_t n = csc->n, nnz = csc->nnz;
  corot_csc *to = o->csc = calloc(1, sizeof *o->csc);
  o->unknown = malloc((n + 1) * sizeof *o->unknown);
  o->entry = malloc((nnz + 1) * sizeof *o->entry);
  o->value = malloc((nnz + 1) * sizeof *o->value);
  if (to) {
    to->n = csc->n, to->nnz = csc->nnz;
    to->colptr = calloc(n + 2, sizeof *to->colptr);
    to->row = malloc((nnz + 1) * sizeof *to->row);
    to->source = malloc((nnz + 1) * sizeof *to->source);
    to->diagonal = malloc((n + 1) * sizeof *to->diagonal);
    to->node = malloc((n + 1) * sizeof *to->node);
  }
  bool all = to && to->colptr && to->row && to->source && to->diagonal && to->node;
  if (all && o->unknown && o->entry && o->value) return COROT_OK;
  return corot_fail(COROT_ENOMEM, "no memory for a matrix of %d columns", csc->n);
}

/* place [n] = where each unknown comes; first [nodes + 1] is scratch of zeros. */
static void order_unknowns(const corot_csc *csc, const corot_refinement *r, int *first, int *place,
                           ordered_csc *o) {
  int nnode = r->nnode[r->nlevel], n = 0;
  for (int i = 0; i < csc->n; i++) first[csc->node[i]]++; /* for now: how many a node has */
  for (int k = 0; k < nnode; k++) {
    int count = first[r->node[k]];
    first[r->node[k]] = n;
    n += count;
  }
  for (int i = 0; i < csc->n; i++) {
    place[i] = first[csc->node[i]]++;
    o->unknown[place[i]] = i;
    o->csc->node[place[i]] = csc->node[i];
  }
}

/* An entry above the diagonal stands for the one that mirrors it. */
static void ends_of(const int *place, int row, int column, int *low, int *high) {
  int a = place[row], b = place[column];
  *low = a < b ? a : b, *high = a < b ? b : a;
}

/* next[k + 1] counts the entries of k, and becomes where the next of them goes. */
static void sum_up(int n, int *next) {
  for (int k = 0; k < n; k++) next[k + 1] += next[k];
}

/* by_row [nnz], next [n + 2] of zeros and column [nnz] are scratch. */
static void order_entries(const corot_csc *csc, const int *place, int *by_row, int *next,
                          int *column, ordered_csc *o) {
  corot_csc *to = o->csc;
  int low, high;
  /* by rows */
  for (int j = 0; j < csc->n; j++)
    for (int p = csc->colptr[j]; p < csc->colptr[j + 1]; p++) {
      column[p] = j;
      ends_of(place, csc->row[p], j, &low, &high);
      next[high + 1]++, to->colptr[low + 1]++;
    }
  sum_up(csc->n, next), sum_up(csc->n, to->colptr);
  for (int p = 0; p < csc->nnz; p++) {
    ends_of(place, csc->row[p], column[p], &low, &high);
    by_row[next[high]++] = p;
  }
  /* then by columns, in which rows ascend as they come */
  memcpy(next, to->colptr, (csc->n + 1) * sizeof *next);
  for (int k = 0; k < csc->nnz; k++) {
    int p = by_row[k];
    ends_of(place, csc->row[p], column[p], &low, &high);
    int at = next[low]++;
    to->row[at] = high, to->source[at] = csc->source[p], o->entry[at] = p;
    if (low == high) to->diagonal[low] = at;
  }
}

corot_status corot_order_create(const corot_csc *csc, const corot_refinement *r, ordered_csc *o) {
  *o = (ordered_csc){0};
  if (!r || !r->node) return COROT_OK;
  COROT_TRY(allocate(csc, o));
  int *first = calloc(r->nnode[r->nlevel] + 1, sizeof *first);
  int *place = malloc((csc->n + 1) * sizeof *place), *next = calloc(csc->n + 2, sizeof *next);
  int *by_row = malloc((csc->nnz + 1) * sizeof *by_row);
  int *column = malloc((csc->nnz + 1) * sizeof *column);
  bool enough = first && place && next && by_row && column;
  if (enough) {
    order_unknowns(csc, r, first, place, o);
    order_entries(csc, place, by_row, next, column, o);
  }
  free(first), free(place), free(next), free(by_row), free(column);
  return enough ? COROT_OK
                : corot_fail(COROT_ENOMEM, "no memory for the order of %d columns", csc->n);
}

void corot_order_clear(ordered_csc *o) {
  corot_csc_destroy(o->csc);
  free(o->unknown), free(o->entry), free(o->value);
  *o = (ordered_csc){0};
}

const double *corot_order_values(const ordered_csc *o, const double *value) {
  if (!o->csc) return value;
  for (int p = 0; p < o->csc->nnz; p++) o->value[p] = value[o->entry[p]];
  return o->value;
}
