/* What the files of octasection share. */
#ifndef COROT_CORE_MESH_REFINE_MESH_REFINE_H
#define COROT_CORE_MESH_REFINE_MESH_REFINE_H

#include "core/mesh/mesh.h"

/* The edges of a mesh. The middle of edge i is node nnode + i of the refined mesh. */
typedef struct corot_edges {
  int n;
  int (*end)[2]; /* [n] nodes, the lower first, in ascending order */
  int (*tet)[6]; /* [ntet] the edges of each tet: 01 02 03 12 13 23 */
} corot_edges;

/* Fills `edges`, which corot_edges_clear empties. */
corot_status corot_edges_list(const corot_mesh *mesh, corot_edges *edges);
void corot_edges_clear(corot_edges *edges);

/* Where the edges in the order of corot_mesh.mid are among those of corot_edges.tet. */
extern const int corot_edge_of_mid[6];

/* x [n] = the middles of the straight edges. */
void corot_edges_place(const corot_mesh *mesh, const corot_edges *edges, double (*x)[3]);

/* The edge between two nodes, which must be one. */
int corot_edges_find(const corot_edges *edges, int a, int b);

/* Whether a tet's node numbers are an odd permutation of ascending ones, which decides where the
   consistent diagonal is. */
bool corot_tet_is_odd(const int v[4]);

/* Cuts triangles of `mesh` into four each, which wind as they do. *fine [4 * ntri] is the caller's
   to free. */
corot_status corot_refine_triangles(const corot_mesh *mesh, const corot_edges *edges, int ntri,
                                    const int (*tri)[3], int (**fine)[3]);

/* Gives `fine`, the refined `mesh` without groups, all groups of `mesh`. `skin` [nskin] is the
   boundary of `mesh`. */
corot_status corot_refine_groups(const corot_mesh *mesh, const corot_edges *edges, int nskin,
                                 const int (*skin)[3], corot_mesh *fine);

/* The same for `fine` with the tets and triangles of `mesh`, but order 2. */
corot_status corot_raise_groups(const corot_mesh *mesh, const corot_edges *edges, int nskin,
                                const int (*skin)[3], corot_mesh *fine);

/* Makes the zeroed `to` a mesh of order 2 without groups, of the tets of `mesh` with the middles of
   their edges. */
corot_status corot_raise(const corot_mesh *mesh, const corot_edges *edges, corot_mesh *to);

#endif
