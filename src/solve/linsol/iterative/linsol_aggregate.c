/* Aggregates in three passes over the nodes, and the graph that is left. */
#include "linsol_aggregate.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { FREE = -1 };

static bool all_free(const graph_rows *g, const int *aggregate, int i) {
  if (aggregate[i] != FREE) return false;
  for (int k = g->rowptr[i]; k < g->rowptr[i + 1]; k++)
    if (aggregate[g->col[k]] != FREE) return false;
  return true;
}

static bool lonely(const graph_rows *g, int i) { return g->rowptr[i] == g->rowptr[i + 1]; }

/* i with those of its neighbours that are free. */
static void join(const graph_rows *g, int i, int number, int *aggregate) {
  aggregate[i] = number;
  for (int k = g->rowptr[i]; k < g->rowptr[i + 1]; k++)
    if (aggregate[g->col[k]] == FREE) aggregate[g->col[k]] = number;
}

/* The aggregate of the first pass that most neighbours of i are in, the first of equals; FREE:
   there is none. votes [count] is zero before and after. */
static int most_common(const graph_rows *g, const int *first_pass, int i, int *votes) {
  int best = FREE;
  for (int k = g->rowptr[i]; k < g->rowptr[i + 1]; k++) {
    int a = first_pass[g->col[k]];
    if (a == FREE) continue;
    votes[a]++;
    if (best == FREE || votes[a] > votes[best] || (votes[a] == votes[best] && a < best)) best = a;
  }
  for (int k = g->rowptr[i]; k < g->rowptr[i + 1]; k++)
    if (first_pass[g->col[k]] != FREE) votes[first_pass[g->col[k]]] = 0;
  return best;
}

corot_status corot_aggregate(const graph_rows *g, int *aggregate, int *count) {
  size_t n = (size_t)g->n;
  int *first_pass = malloc((n + 1) * sizeof *first_pass), *votes = calloc(n + 1, sizeof *votes);
  bool enough = first_pass && votes;
  int number = 0;
  for (int i = 0; i < g->n; i++) aggregate[i] = FREE;
  /* whole neighbourhoods */
  for (int i = 0; i < g->n && enough; i++)
    if (!lonely(g, i) && all_free(g, aggregate, i)) join(g, i, number++, aggregate);
  /* what is left beside one of these belongs to it */
  if (enough) {
    memcpy(first_pass, aggregate, n * sizeof *first_pass);
    for (int i = 0; i < g->n; i++)
      if (aggregate[i] == FREE) aggregate[i] = most_common(g, first_pass, i, votes);
    /* and what is left then, to each other */
    for (int i = 0; i < g->n; i++)
      if (!lonely(g, i) && aggregate[i] == FREE) join(g, i, number++, aggregate);
    *count = number;
  }
  free(first_pass), free(votes);
  return enough ? COROT_OK : corot_fail(COROT_ENOMEM, "no memory for aggregates of %zu nodes", n);
}

void corot_aggregate_sort(int n, const int *aggregate, int count, int *first, int *node) {
  memset(first, 0, ((size_t)count + 1) * sizeof *first);
  for (int i = 0; i < n; i++)
    if (aggregate[i] >= 0) first[aggregate[i] + 1]++;
  for (int a = 0; a < count; a++) first[a + 1] += first[a];
  for (int i = 0; i < n; i++)
    if (aggregate[i] >= 0) node[first[aggregate[i]]++] = i;
  for (int a = count; a > 0; a--) first[a] = first[a - 1];
  first[0] = 0;
}

static int compare(const void *a, const void *b) {
  int x = *(const int *)a, y = *(const int *)b;
  return (x > y) - (x < y);
}

/* Counts only if col is NULL. */
static int list_neighbours(const graph_rows *g, const int *aggregate, int count, const int *first,
                           const int *node, int *mark, int *rowptr, int *col) {
  int total = 0;
  for (int a = 0; a < count; a++) mark[a] = -1;
  for (int a = 0; a < count; a++) {
    rowptr[a] = total;
    mark[a] = a;
    for (int p = first[a]; p < first[a + 1]; p++)
      for (int k = g->rowptr[node[p]]; k < g->rowptr[node[p] + 1]; k++) {
        int b = aggregate[g->col[k]];
        if (b < 0 || mark[b] == a) continue;
        mark[b] = a;
        if (col) col[total] = b;
        total++;
      }
    if (col) qsort(col + rowptr[a], (size_t)(total - rowptr[a]), sizeof *col, compare);
  }
  return rowptr[count] = total;
}

corot_status corot_aggregate_graph(const graph_rows *g, const int *aggregate, int count,
                                   int **rowptr, int **col) {
  size_t n = (size_t)g->n, m = (size_t)count;
  int *first = calloc(m + 2, sizeof *first), *node = malloc((n + 1) * sizeof *node);
  int *mark = malloc((m + 1) * sizeof *mark);
  *rowptr = calloc(m + 1, sizeof **rowptr), *col = NULL;
  if (first && node && mark && *rowptr) {
    corot_aggregate_sort(g->n, aggregate, count, first, node);
    int total = list_neighbours(g, aggregate, count, first, node, mark, *rowptr, NULL);
    *col = malloc(((size_t)total + 1) * sizeof **col);
    if (*col) list_neighbours(g, aggregate, count, first, node, mark, *rowptr, *col);
  }
  free(first), free(node), free(mark);
  if (*col) return COROT_OK;
  return corot_fail(COROT_ENOMEM, "no memory for a graph of %d aggregates", count);
}
