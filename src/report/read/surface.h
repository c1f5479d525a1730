/* The surface of a tetrahedral mesh: the faces that one tet alone has. */
#ifndef COROT_REPORT_READ_SURFACE_H
#define COROT_REPORT_READ_SURFACE_H

#include <corot/base.h>

typedef struct surface {
  int ntri, nnode;
  int (*corner)[3]; /* [ntri] numbers among the surface's nodes, winding outward */
  int (*middle)[3]; /* [ntri] of the same, those on the edges 01 12 20 of a triangle of order 2;
                       NULL: of order 1 */
  int *tet;         /* [ntri] whose face it is */
  int *node;        /* [nnode] of the mesh, ascending */
  int *stands; /* [nodes of the mesh] of a surface that was thinned: which of its nodes stands for
                  each, -1 inside; NULL: it was not */
} surface;

corot_status surface_create(int nnode, int ntet, const int (*tet)[4], surface *s);

/* The same of ten-node tets, whose nodes on edges are `mid`; NULL: of order 1. */
corot_status surface_create_of_order(int nnode, int ntet, const int (*tet)[4], const int (*mid)[6],
                                     surface *s);

/* Leaves at most so many triangles (more only if it could not be otherwise): nodes that are close
   to each other and look the same way are one, and triangles stay of which no two corners are one.
   x: of the mesh's nodes. Of order 2 the edges are straight then. COROT_ENOMEM: the surface is as
   it was. */
corot_status surface_thin(surface *s, const double (*x)[3], int nnode, int most);

void surface_free(surface *s);

#endif
