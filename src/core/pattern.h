/* Who touches whom: the symmetric 3x3-block pattern of K and D, where each element matrix goes in
   it, and where each node finds the element forces it sums. */
#ifndef COROT_CORE_PATTERN_H
#define COROT_CORE_PATTERN_H

#include "core/tets.h"

/* Pairs (a, b), a >= b, of local nodes in the order of an element matrix's lower triangle. */
enum { NPAIR = 10 };
static const int pair_row[NPAIR] = {0, 1, 2, 3, 1, 2, 3, 2, 3, 3};
static const int pair_col[NPAIR] = {0, 0, 0, 0, 1, 1, 1, 2, 2, 3};

/* The blocks of the lower triangle by columns, rows ascending: the first of each column is its
   diagonal. */
typedef struct pattern {
  int nnode;
  int nblock;
  int *colptr;            /* [nnode + 1] */
  int *row;               /* [nblock] */
  int (*place)[NPAIR][W]; /* [tets.nblock] the block each pair of each tet is added to */
  int *first;             /* [nnode + 1] each node's part of `slot` */
  int *slot;              /* [4 ntet] element forces of a node, ascending: where the x component
                             stands in the buffer [tets.nblock][4][3][W]; y and z W further */
} pattern;

corot_status pattern_create(int nnode, const tets *t, pattern *out);
void pattern_clear(pattern *p);

#endif
