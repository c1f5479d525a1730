/* Who touches whom: the symmetric 3x3-block pattern of K and D, where each element matrix goes in
   it, and where each node finds the element forces it sums. */
#ifndef COROT_CORE_SOLID_PATTERN_H
#define COROT_CORE_SOLID_PATTERN_H

#include "dilatation.h"

/* The kernels work through the blocks of tets in chunks of so many. When a chunk is done, the nodes
   that have no tet in later ones are summed up while what they need is in the cache. */
enum { CHUNK = 32 };

/* The blocks of the lower triangle by columns, rows ascending: the first of each column is its
   diagonal. */
typedef struct pattern {
  int nnode;
  int nblock;
  int *colptr;     /* [nnode + 1] */
  int *row;        /* [nblock] */
  int (*place)[W]; /* [elements.nblock][kind->npair] the block that each pair of nodes of each
                      element is added to */
  int nchunk;
  int *left_first; /* [nnode + 1] each node's part of `left` */
  int *left; /* [nblock - nnode] the blocks of a row left of its diagonal, columns ascending */
  /* A node's forces are summed up, and its row and column of a matrix completed, as soon as it has
     no tet in later chunks: by chunk c those of the nodes turn[due[c]] to turn[due[c + 1] - 1]. */
  int *due;   /* [nchunk + 1] */
  int *turn;  /* [nnode] */
  int window; /* so many blocks back reach the tets of the nodes that a chunk completes */
  int *first; /* [nnode + 1] each node's part of `slot` */
  int *slot; /* [kind->nnode ntet] element forces of a node, in the order of the elements: where the
                x component stands in the buffer [window][kind->nnode][3][W], which block b uses at
                b modulo window; y and z W further */
} pattern;

/* Nodes that share a tet, or an average of the dilatation; and the pairs of `more` (or NULL), a
   pattern of the nodes below more->nnode. */
corot_status corot_pattern_create(int nnode, const element_set *t, const dilatation *d,
                                  const pattern *more, pattern *out);
void corot_pattern_clear(pattern *p);

/* The block of row i and column j <= i, which is in the pattern. */
int corot_pattern_find(const pattern *p, int i, int j);

#endif
