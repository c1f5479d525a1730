/* What the writers of mesh files share. */
#ifndef COROT_CORE_MESH_WRITE_MESH_WRITE_H
#define COROT_CORE_MESH_WRITE_MESH_WRITE_H

#include <stdio.h>

#include "core/mesh/refine/mesh_refine.h"

typedef struct corot_writing {
  const corot_mesh *mesh;
  FILE *file;
  corot_edges edges;         /* at order 2 */
  corot_mesh_report *report; /* of groups that the format cannot hold; NULL: nobody asks */

  /* What write_numbers_* share: the number of each tet, node and face; 0: none. */
  int *tet_number, *node_number, *face_number; /* [ntet] [nnode] [4 ntet] by place among `face` */
  corot_face *face;                            /* [4 ntet] sorted */
} corot_writing;

/* The nodes of a triangle: 3, or 6 at order 2, those on the edges 01 12 20 last. */
int corot_writing_triangle(const corot_writing *w, const int tri[3], int v[6]);

/* The nodes of tet e: 4, or 10 at order 2 in the order of corot_mesh.mid. */
int corot_writing_tet(const corot_writing *w, int e, int v[10]);

/* The nodes of a group that are of none of its triangles and tets: *n of them are moved to the
   front of `loose` [nnode]; `mark` [nnode] is zero before and after. */
int corot_writing_loose(const corot_writing *w, const corot_group *g, char *mark, int *loose);

/* Adds to the report, if there is one. COROT_ENOMEM. */
corot_status corot_writing_lose(corot_writing *w, int count, const char *format, ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 3, 4)))
#endif
    ;

/* The formats. What has several files is written by several functions, in this order. */
corot_status corot_write_gmsh_2(corot_writing *w);
corot_status corot_write_gmsh_4(corot_writing *w);
corot_status corot_write_vtk(corot_writing *w);
corot_status corot_write_vtu(corot_writing *w);
corot_status corot_write_inp(corot_writing *w);
corot_status corot_write_medit(corot_writing *w);
corot_status corot_write_tetgen_node(corot_writing *w);
corot_status corot_write_tetgen_ele(corot_writing *w);
corot_status corot_write_tetgen_face(corot_writing *w);

#endif
