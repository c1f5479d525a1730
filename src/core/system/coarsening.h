/* How the tets of a coarser level see a field on the finest one: the linear map L from the nodes of
   the finest level to those of a term (system.h), and its mesh. The finest level may be that of
   ten-node tets (corot_refinement_raise).

   By values: the nodes of a level are the first ones of the finest, and L reads their values.

   By means: L takes the mean over each face of the level's tets, that is, of the n^2 triangles into
   which the finest level cuts it, each the mean of its corners, or, of ten-node tets, of the
   middles of its edges. By Gauss's theorem the mean gradient over a tet follows from those over its
   faces, and it is the gradient of the affine field that has these values at the centroids of the
   faces (Crouzeix & Raviart 1973). So the part's nodes are these centroids, and its tets the tets
   between the four of each, with a 27th of the volume. */
#ifndef COROT_CORE_SYSTEM_COARSENING_H
#define COROT_CORE_SYSTEM_COARSENING_H

#include <corot/mesh.h>
#include <stddef.h>

typedef struct coarsening {
  int nnode;      /* of the part */
  double volume;  /* of the level's tets, that of the part's being one */
  int npoint;     /* by means: nodes of the finest level on a face that have part; else 0 */
  int *point;     /* [nnode][npoint] */
  double *weight; /* [npoint] they sum to one */
} coarsening;

/* L, and the mesh of `level`, tet by tet; `fine` is the finest one. By means, level < nlevel, and
   COROT_EINVAL if the refinement lacks the middle of an edge. */
corot_status corot_coarsening_by_values(const corot_mesh *fine, const corot_refinement *r,
                                        int level, coarsening *c, corot_mesh **mesh);
corot_status corot_coarsening_by_means(const corot_mesh *fine, const corot_refinement *r, int level,
                                       coarsening *c, corot_mesh **mesh);

void corot_coarsening_clear(coarsening *c);

size_t corot_coarsening_bytes(const coarsening *c);

/* w [nnode] = L u */
void corot_coarsen(const coarsening *c, const double (*u)[4], double (*w)[4]);

/* f += L' g for g [nnode]. */
void corot_coarsen_transposed(const coarsening *c, const double (*g)[4], double (*f)[4]);

#endif
