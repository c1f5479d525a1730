/* What the files of octasection share. */
#ifndef COROT_CORE_MESH_REFINE_MESH_REFINE_H
#define COROT_CORE_MESH_REFINE_MESH_REFINE_H

#include "core/mesh/mesh.h"

/* The edges of a mesh. The middle of edge i of a mesh of order 1 is node nnode + i of the refined
   one; a mesh of order 2 has it already. */
typedef struct corot_edges {
  int n;
  int (*end)[2]; /* [n] nodes, the lower first, in ascending order */
  int (*tet)[6]; /* [ntet] the edges of each tet: 01 02 03 12 13 23 */
  int *middle;   /* [n] the node on it; order 1: NULL */
  int nnode;     /* of the mesh */
} corot_edges;

/* The node in the middle of an edge. */
static inline int corot_edge_middle(const corot_edges *edges, int i) {
  return edges->middle ? edges->middle[i] : edges->nnode + i;
}

/* Fills `edges`, which corot_edges_clear empties. COROT_EINVAL: so many tets that their sides
   cannot be counted. */
corot_status corot_edges_list(const corot_mesh *mesh, corot_edges *edges);
void corot_edges_clear(corot_edges *edges);

/* Where the edges in the order of corot_mesh.mid are among those of corot_edges.tet. */
extern const int corot_edge_of_mid[6];

/* x [n] = the middles of the straight edges. */
void corot_edges_place(const corot_mesh *mesh, const corot_edges *edges, double (*x)[3]);

/* Moves the middles of the edges of `fine`, whose corners are the nodes of `mesh` of order 2, from
   the straight edges to where the shape functions of `mesh` have them; x [nnode + their number]. */
corot_status corot_edges_bend(const corot_mesh *mesh, const corot_mesh *fine,
                              const corot_edges *fine_edges, double (*x)[3]);

/* The edge between two nodes, which must be one. */
int corot_edges_find(const corot_edges *edges, int a, int b);

/* Whether a tet's node numbers are an odd permutation of ascending ones, which decides where the
   consistent diagonal is. */
bool corot_tet_is_odd(const int v[4]);

/* Cuts triangles into four each, which wind as they do. *fine [4 * ntri] is the caller's to free.
 */
corot_status corot_refine_triangles(const corot_edges *edges, int ntri, const int (*tri)[3],
                                    int (**fine)[3]);

/* Gives `fine`, the refined `mesh` without groups, all groups of `mesh`. `skin` [nskin] is the
   boundary of `mesh`. */
corot_status corot_refine_groups(const corot_mesh *mesh, const corot_edges *edges, int nskin,
                                 const int (*skin)[3], corot_mesh *fine);

/* The same for `fine` with the tets and triangles of `mesh`, but order 2. */
corot_status corot_raise_groups(const corot_mesh *mesh, const corot_edges *edges, int nskin,
                                const int (*skin)[3], corot_mesh *fine);

/* Gives a group of a mesh of order 2 the nodes on edges that it would inherit if its corners,
   triangles and tets were those of a coarser mesh. */
corot_status corot_group_add_middles(const corot_mesh *mesh, int nskin, const int (*skin)[3],
                                     corot_group *group);

/* Makes the zeroed `to` a mesh of order 2 without groups, of the tets of `mesh` with the middles of
   their edges. */
corot_status corot_raise(const corot_mesh *mesh, const corot_edges *edges, corot_mesh *to);

#endif
