/* Tets cut in halves across their longest edges until no neighbour is left with a node on an edge
   (Rivara, Algorithms for refining triangular grids suitable for adaptive and multigrid techniques,
   Int. J. Numer. Meth. Eng. 20, 1984; in three dimensions Rivara and Levin, A 3-D refinement
   algorithm suitable for adaptive and multi-grid techniques, Comm. Appl. Numer. Meth. 8, 1992). */
#ifndef COROT_CORE_MESH_REFINE_BISECTION_H
#define COROT_CORE_MESH_REFINE_BISECTION_H

#include "mesh_refine.h"

/* What is cut stays, with its two parts, so that all edges and tets that ever were are trees. */
typedef struct cut_edge {
  int end[2];     /* nodes, ascending */
  int middle;     /* the node on it; -1: none */
  int half;       /* it is cut into edges half, with end[0], and half + 1; -1: it is not */
  int median;     /* the first edge from its middle to a corner opposite; -1: none */
  int next;       /* the next of the edges that are medians to the same middle; -1: none */
  int place;      /* 6 t + k: the first tet t of which it is, or was, edge k; -1: none */
  double length2; /* squared, rounded [m^2] */
} cut_edge;

typedef struct cut_tet {
  int v[4];    /* corners */
  int edge[6]; /* 01 02 03 12 13 23 */
  int next[6]; /* the next place of each edge; -1: none */
  int root;    /* the tet of the mesh from which it comes */
  int child;   /* it is cut into tets child and child + 1; -1: it is not */
  int depth;   /* how often its root has been cut on the way to it */
  bool waits;  /* for being cut */
} cut_tet;

typedef struct int_list {
  int n, room;
  int *at; /* [n] */
} int_list;

corot_status corot_int_list_push(int_list *list, int i);

typedef struct bisection {
  const corot_mesh *mesh;
  int nnode, node_room;
  double (*x)[3]; /* [nnode] those of the mesh first */
  int nedge, edge_room;
  cut_edge *edge;
  double (
      *s)[3]; /* [nedge] order 2: how far the node on an edge is off its middle [m]; else NULL */
  int ntet, tet_room;
  cut_tet *tet;  /* [ntet] those of the mesh first */
  char *marked;  /* [mesh->ntet] */
  int_list wait; /* the tets to be cut next */
} bisection;

/* Fills the zeroed `b`; `edges` are those of the mesh, and the first of `b`, in the same order. On
   failure, too, corot_bisection_clear empties it. */
corot_status corot_bisection_begin(const corot_mesh *mesh, const corot_edges *edges, int nmark,
                                   const int *mark, bisection *b);

/* Cuts until each part of a marked tet has been cut three times, and nothing is left to match. */
corot_status corot_bisection_run(bisection *b);

void corot_bisection_clear(bisection *b);

/* Of two edges at most one is longer: of equal length is the one with the lower of the higher ends,
   then with the lower of the lower ends. */
bool corot_bisection_longer(const bisection *b, int e, int f);

/* The half of a cut edge with one of its ends; the edge from its middle to a corner opposite, -1
   where there is none. */
int corot_bisection_half(const bisection *b, int e, int end);
int corot_bisection_median(const bisection *b, int e, int corner);

/* Gives `fine`, the result without groups, all groups of the mesh; parent [fine->ntet] ascending.
 */
corot_status corot_bisection_groups(const bisection *b, const corot_edges *edges, const int *parent,
                                    corot_mesh *fine);

#endif
