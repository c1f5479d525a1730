/* The tets as the kernels see them: blocks of W, each of one material, structure of arrays. */
#ifndef COROT_CORE_ELEMENT_TETS_H
#define COROT_CORE_ELEMENT_TETS_H

#include <corot/mesh.h>

#include "core/lanes/mat3.h"

/* The nodes of a tet are in ascending order here, whatever the mesh says: then local node a > b
   means global node a > b, and the lower triangle of an element matrix is part of the lower
   triangle of the whole. Lanes beyond a material's last tet repeat it with volume zero. */
typedef struct tet_block {
  block_mat3 g;    /* row a-1: rest gradient of the shape function of node a = 1, 2, 3 [1/m];
                      that of node 0 is minus their sum */
  block_vd volume; /* rest volume [m^3] */
  int node[4][W];  /* [local node][lane] */
  int material;
  int ntet; /* lanes in use, the first ones */
} tet_block;

typedef struct tets {
  int nblock;
  tet_block *block;       /* [nblock] aligned to a vector */
  int *number;            /* [nblock * W] the tet's number in the mesh; repeated in padding lanes */
  block_mat3 *rest_basis; /* [nblock] Gram-Schmidt of the rest edges 0-1 and 0-2 in the mesh's own
                       node order, on request; else NULL */
} tets;

/* LANES tets of a block: what a loop takes at a time. */
typedef struct tet_lanes {
  const tet_block *in;
  int part;
} tet_lanes;

/* Part b % PARTS of block b / PARTS: loops count parts. */
COROT_INLINE tet_lanes tets_at(const tets *t, int b) {
  return (tet_lanes){&t->block[b / PARTS], b % PARTS};
}

COROT_INLINE vd volume_of(tet_lanes t) { return vd_at(&t.in->volume, t.part); }

/* Component c of the rest gradient of node a = 1, 2, 3. */
COROT_INLINE vd gradient_of(tet_lanes t, int a, int c) {
  return vd_at(&t.in->g.m[a - 1][c], t.part);
}

/* Rows x of node a. */
COROT_INLINE void gather_node(tet_lanes t, int a, const double (*x)[4], vd out[3]) {
  vd_gather3(x, t.in->node[a] + t.part * LANES, out);
}

/* `material` [ntet] says what each tet is made of, 0 <= material < nmaterial. From the mesh's first
   tet on, each `together` of the same material follow one another: if that is a multiple of W, no
   block has tets of two such groups. */
corot_status corot_tets_create(const corot_mesh *mesh, int nmaterial, const int *material,
                               int together, int with_rest_basis, tets *out);
void corot_tets_clear(tets *t);

/* The rest basis of one block. */
block_mat3 corot_tets_rest_basis(const corot_mesh *mesh, const int *number);

/* Zeroed memory aligned for vectors, freed by free(). NULL if there is none. */
void *corot_vector_calloc(size_t count, size_t size);

#endif
