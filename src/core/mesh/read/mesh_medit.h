/* What the readers of MEDIT's two formats share: the same lists, as text and as binary numbers. */
#ifndef COROT_CORE_MESH_READ_MESH_MEDIT_H
#define COROT_CORE_MESH_READ_MESH_MEDIT_H

#include "mesh_read.h"

typedef struct corot_medit {
  corot_reader r;
  corot_draft d;
  bool has_nodes, has_tets;
  int place[4][10]; /* of a simplex by its dimension: where the k-th node of the file goes */
} corot_medit;

/* A list of elements. */
typedef struct corot_medit_list {
  const char *name;
  int code;       /* of binary files; 0: it has none */
  int dim, nnode; /* nnode 0: solids that are not supported */
  corot_draft_kind kind;
} corot_medit_list;

/* NULL: there is no such list. */
const corot_medit_list *corot_medit_list_of(int code);

/* The nodes of a simplex stand as ours do, until the file says otherwise. */
void corot_medit_begin(corot_medit *m, const corot_reading *how);

/* What stands behind the keyword. */
corot_status corot_medit_dimension(corot_medit *m);
corot_status corot_medit_nodes(corot_medit *m);
corot_status corot_medit_elements(corot_medit *m, const corot_medit_list *l);

/* TrianglesP2Ordering or TetrahedraP2Ordering: for each node of a simplex of that dimension its
   barycentric coordinates, of which one is 2, or two are 1. */
corot_status corot_medit_ordering(corot_medit *m, int dim);

/* BezierBasis: whether nodes of second order are control points, which are refused. */
corot_status corot_medit_basis(corot_medit *m);

/* The mesh, once all lists have been read. */
corot_status corot_medit_finish(corot_medit *m, corot_mesh **mesh);

#endif
