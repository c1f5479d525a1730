/* The graph of the nodes of a matrix: an order of magnitude smaller than that of its unknowns, and
   the unknowns of a node belong side by side in any order anyway. */
#ifndef COROT_SOLVE_LINSOL_LINSOL_GRAPH_H
#define COROT_SOLVE_LINSOL_LINSOL_GRAPH_H

#include <corot/ode.h>

typedef struct node_graph {
  int n;             /* nodes that have a free component */
  int *first;        /* [n + 1] the unknowns of each */
  int *rank;         /* [unknowns] the node of each */
  int *colptr, *row; /* [n + 1], [colptr[n]] the nodes that each shares a tet with, ascending */
  int *work;         /* [4 n] */
} node_graph;

/* `csc`: a lower triangle. What is half made is released by clear. */
corot_status corot_graph_create(const corot_csc *csc, node_graph *g);
void corot_graph_clear(node_graph *g);

/* order [n]: the nodes in an order of little fill, by "amd" or "metis". */
corot_status corot_graph_order(const node_graph *g, const char *ordering, int *order);

/* Of Cholesky's factor of the matrix in that order of the nodes: entries, and multiplications to
   find them. */
typedef struct graph_fill {
  double nnz, flops;
} graph_fill;

graph_fill corot_graph_fill(node_graph *g, const int *order);

/* Edges of the shortest path between two nodes that lie far apart. */
int corot_graph_length(node_graph *g);

#endif
