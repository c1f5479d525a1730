/* Aggregates of the nodes of a graph: each node of a group and its neighbours, as Vanek, Mandel and
   Brezina (Computing 56, 1996) join them. The graph alone decides, not the values of a matrix, so
   that aggregates serve all matrices of one pattern. */
#ifndef COROT_SOLVE_LINSOL_ITERATIVE_LINSOL_AGGREGATE_H
#define COROT_SOLVE_LINSOL_ITERATIVE_LINSOL_AGGREGATE_H

#include <corot/base.h>

/* Neighbours of each node, ascending, without itself. */
typedef struct graph_rows {
  int n;
  const int *rowptr, *col;
} graph_rows;

/* aggregate [g->n]: the aggregate of each node, or -1 of one without neighbours; *count of them.
   COROT_ENOMEM. */
corot_status corot_aggregate(const graph_rows *g, int *aggregate, int *count);

/* The nodes by their aggregates, ascending: first [count + 1], node [n], those of a from first[a]
 * on. */
void corot_aggregate_sort(int n, const int *aggregate, int count, int *first, int *node);

/* The graph of the aggregates, neighbours where nodes of theirs are: *rowptr [count + 1] and *col
   are the caller's to free, whatever is returned. COROT_ENOMEM. */
corot_status corot_aggregate_graph(const graph_rows *g, const int *aggregate, int count,
                                   int **rowptr, int **col);

#endif
