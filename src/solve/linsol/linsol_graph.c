/* The graph from the pattern of the matrix, and what a factor would cost in an order of it. */
#include "linsol_graph.h"

#include <stdlib.h>
#include <string.h>

static void number_nodes(const corot_csc *csc, node_graph *g) {
  for (int i = 0; i < csc->n; i++) {
    if (i == 0 || csc->node[i] != csc->node[i - 1]) g->first[g->n++] = i;
    g->rank[i] = g->n - 1;
  }
  g->first[g->n] = csc->n;
}

/* The nodes after j that it shares a tet with: its first unknown sees them all. */
static int list_later(const corot_csc *csc, const node_graph *g, int j, int *row) {
  int column = g->first[j], last = j, n = 0;
  for (int p = csc->colptr[column]; p < csc->colptr[column + 1]; p++)
    if (g->rank[csc->row[p]] > last) row[n++] = last = g->rank[csc->row[p]];
  return n;
}

/* From j upwards, each node has got its earlier neighbours by the time its later ones follow. */
static void list_neighbours(const corot_csc *csc, node_graph *g) {
  int *later = g->work, *next = g->work + g->n;
  memset(next, 0, g->n * sizeof *next);
  for (int j = 0; j < g->n; j++) {
    int n = list_later(csc, g, j, later);
    next[j] += n;
    for (int k = 0; k < n; k++) next[later[k]]++;
  }
  g->colptr[0] = 0;
  for (int j = 0; j < g->n; j++) {
    g->colptr[j + 1] = g->colptr[j] + next[j];
    next[j] = g->colptr[j];
  }
  for (int j = 0; j < g->n; j++) {
    int n = list_later(csc, g, j, later);
    for (int k = 0; k < n; k++) {
      g->row[next[j]++] = later[k];
      g->row[next[later[k]]++] = j;
    }
  }
}

corot_status corot_graph_create(const corot_csc *csc, node_graph *g) {
  *g = (node_graph){0};
  g->first = malloc((csc->n + 1) * sizeof *g->first);
  g->rank = malloc(csc->n * sizeof *g->rank);
  g->colptr = malloc((csc->n + 1) * sizeof *g->colptr);
  g->row = malloc(2 * (size_t)csc->nnz * sizeof *g->row);
  g->work = malloc(4 * (size_t)csc->n * sizeof *g->work);
  if (!g->first || !g->rank || !g->colptr || !g->row || !g->work)
    return corot_fail(COROT_ENOMEM, "no memory for the graph of %d unknowns", csc->n);
  number_nodes(csc, g);
  list_neighbours(csc, g);
  return COROT_OK;
}

void corot_graph_clear(node_graph *g) {
  free(g->first), free(g->rank), free(g->colptr), free(g->row), free(g->work);
  *g = (node_graph){0};
}

/* Row by row of the factor: from each neighbour that comes earlier, its entries lie along the path
   up the elimination tree (Liu 1990). */
graph_fill corot_graph_fill(node_graph *g, const int *order) {
  int *place = g->work, *parent = place + g->n, *seen = parent + g->n, *height = seen + g->n;
  for (int i = 0; i < g->n; i++) place[order[i]] = i, parent[i] = seen[i] = -1, height[i] = 0;
  for (int i = 0; i < g->n; i++) {
    int node = order[i], ndof = g->first[node + 1] - g->first[node];
    seen[i] = i;
    for (int p = g->colptr[node]; p < g->colptr[node + 1]; p++)
      for (int k = place[g->row[p]]; k < i && seen[k] != i; k = parent[k]) {
        if (parent[k] < 0) parent[k] = i;
        height[k] += ndof;
        seen[k] = i;
      }
  }
  graph_fill fill = {0};
  for (int i = 0; i < g->n; i++)
    for (int c = g->first[order[i] + 1] - g->first[order[i]]; c > 0; c--) {
      double column = height[i] + c;
      fill.nnz += column;
      fill.flops += column * column;
    }
  return fill;
}

/* The last node that a search in breadth finds, and how far away it is. */
static int farthest(node_graph *g, int from, int *distance) {
  int *queue = g->work, *level = g->work + g->n, nqueue = 1;
  for (int i = 0; i < g->n; i++) level[i] = -1;
  queue[0] = from, level[from] = 0;
  for (int k = 0; k < nqueue; k++)
    for (int p = g->colptr[queue[k]]; p < g->colptr[queue[k] + 1]; p++)
      if (level[g->row[p]] < 0) {
        level[g->row[p]] = level[queue[k]] + 1;
        queue[nqueue++] = g->row[p];
      }
  *distance = level[queue[nqueue - 1]];
  return queue[nqueue - 1];
}

int corot_graph_length(node_graph *g) {
  int length, end = farthest(g, 0, &length);
  farthest(g, end, &length);
  return length;
}
