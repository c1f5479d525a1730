/* The elements of a mesh as the kernels see them: blocks of W, each of one material, structure of
   arrays. */
#ifndef COROT_CORE_ELEMENT_TETS_H
#define COROT_CORE_ELEMENT_TETS_H

#include <corot/mesh.h>

#include "core/lanes/mat3.h"
#include "element.h"

typedef struct element_block {
  int material;
  int n; /* lanes in use, the first ones */
} element_block;

/* The nodes of an element are in ascending order here, whatever the mesh says: then local node a >
   b means global node a > b, and the lower triangle of an element matrix is part of the lower
   triangle of the whole. The points of integration belong to the corners in ascending order: where
   there are four, point q is the one near corner q. Lanes beyond a material's last element repeat
   it with weights of zero. */
typedef struct element_set {
  const element_kind *kind;
  int nblock;
  element_block *block;     /* [nblock] */
  int (*node)[W];           /* [nblock][kind->nnode] */
  unsigned char (*role)[W]; /* [nblock][kind->nnode] which of the kind's nodes each is, the corners
                               ascending; NULL: node a is the kind's node a */
  block_vd (*slope)[3];     /* [nblock][kind->npoint][kind->nnode - 1] rest gradients of the shape
                               functions of nodes 1, 2, ... [1/m]; that of node 0 is minus their sum */
  block_vd *weight;         /* [nblock][kind->npoint] rest volume that a point stands for [m^3] */
  int *number;              /* [nblock * W] the number in the mesh; repeated in padding lanes */
  block_mat3 *rest_basis;   /* [nblock] Gram-Schmidt of the rest edges 0-1 and 0-2 in the mesh's own
                               node order, on request; else NULL */
} element_set;

/* The lanes' node a of block b. */
static inline const int *nodes_at(const element_set *e, int b, int a) {
  return e->node[b * e->kind->nnode + a];
}

/* Which of the kind's nodes that is in a lane. */
static inline int role_at(const element_set *e, int b, int a, int lane) {
  return e->role ? e->role[b * e->kind->nnode + a][lane] : a;
}

/* How many points there are, of blocks. */
static inline int points_of(const element_set *e) { return e->nblock * e->kind->npoint; }

/* Rest volume of one element of block b [m^3]. */
static inline double volume_at(const element_set *e, int b, int lane) {
  double sum = 0;
  for (int q = 0; q < e->kind->npoint; q++) sum += e->weight[b * e->kind->npoint + q][lane];
  return sum;
}

/* --- A point of LANES elements of a block: what a loop takes at a time --- */

typedef struct point_lanes {
  const element_kind *kind;
  const element_set *set;
  int block, part; /* part of the block */
  int q;           /* point */
} point_lanes;

/* Part b % PARTS of block b / PARTS: loops count parts. */
COROT_INLINE point_lanes point_at(const element_kind *kind, const element_set *e, int b, int q) {
  return (point_lanes){kind, e, b / PARTS, b % PARTS, q};
}

/* Where it stands in arrays [nblock][npoint], in parts. */
COROT_INLINE int index_of(point_lanes p) {
  return (p.block * p.kind->npoint + p.q) * PARTS + p.part;
}

COROT_INLINE int material_of(point_lanes p) { return p.set->block[p.block].material; }

COROT_INLINE vd weight_of(point_lanes p) { return vd_at(p.set->weight, index_of(p)); }

/* Component c of the rest gradient of node a = 1, 2, ... */
COROT_INLINE vd slope_of(point_lanes p, int a, int c) {
  int at = (p.block * p.kind->npoint + p.q) * (p.kind->nnode - 1) + a - 1;
  return vd_at(&p.set->slope[at][c], p.part);
}

/* Rows x of node a. */
COROT_INLINE void gather_node(point_lanes p, int a, const double (*x)[4], vd out[3]) {
  vd_gather3(x, p.set->node[p.block * p.kind->nnode + a] + p.part * LANES, out);
}

/* `material` [ntet] says what each tet is made of, 0 <= material < nmaterial. From the mesh's first
   tet on, each `together` of the same material follow one another: if that is a multiple of W, no
   block has tets of two such groups. */
corot_status corot_tets_create(const corot_mesh *mesh, int nmaterial, const int *material,
                               int together, int with_rest_basis, element_set *out);

/* The same, where the tets stand in the order that those of another mesh, of as many, would have.
 */
corot_status corot_tets_create_ordered(const corot_mesh *mesh, const corot_mesh *order_of,
                                       int nmaterial, const int *material, int together,
                                       int with_rest_basis, element_set *out);
void corot_tets_clear(element_set *e);

/* The nodes of a tet of the mesh by their roles: its corners ascending, then, if it has any, the
   middles of their edges. */
void corot_tets_nodes(const corot_mesh *mesh, int tet, int node[KIND_NODES]);

/* The mass of one element of block b, of that density [kg/m^3]: between each two of its nodes, the
   same in each component, and lumped. Curved elements are integrated numerically. */
void corot_element_mass(const corot_mesh *mesh, const element_set *e, int b, int lane,
                        double density, double mass[KIND_NODES][KIND_NODES]);
void corot_element_lumped(const corot_mesh *mesh, const element_set *e, int b, int lane,
                          double density, double mass[KIND_NODES]);

/* The rest basis of one block. */
block_mat3 corot_tets_rest_basis(const corot_mesh *mesh, const int *number);

/* Zeroed memory aligned for vectors, freed by free(). NULL if there is none. */
void *corot_vector_calloc(size_t count, size_t size);

#endif
