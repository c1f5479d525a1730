/* How the tets of a coarser level see a field on the finest one: the linear map L from the nodes of
   the finest level to those of a part (levels.h).

   By values, the part's nodes are the first ones of the finest level, and L reads their values.

   By means, each of the part's tets has four nodes of its own, with the values of the affine field
   that has the mean gradient of the field over the tet. By Gauss's theorem it follows from the
   means u_f over the four faces, grad = -3 sum u_f (x) grad lambda_f (Crouzeix & Raviart 1973), and
   its value at node j is sum u_f - 3 u_j, u_j that of the face opposite to it. The mean over a face
   is that of its n^2 triangles, n = 2^(levels between), each the mean of its corners. Of a field
   that is affine on the tet, w are its own values there. */
#ifndef COROT_CORE_COARSENING_H
#define COROT_CORE_COARSENING_H

#include <corot/mesh.h>
#include <stddef.h>

typedef struct coarsening {
  int nnode; /* of the part */
  int ntet;  /* of the part, by means; 0: by values */
  int nface;
  int (*face)[4]; /* [ntet] the face opposite to each node */
  int npoint;     /* nodes of the finest level on a face */
  int *point;     /* [nface][npoint] */
  double *weight; /* [npoint] they sum to one */
} coarsening;

void corot_coarsening_by_values(int nnode, coarsening *c);

/* For the tets of `level` < nlevel. COROT_EINVAL: the refinement lacks the middle of an edge. */
corot_status corot_coarsening_by_means(const corot_refinement *r, int level, const int (*tet)[4],
                                       coarsening *c);

void corot_coarsening_clear(coarsening *c);

size_t corot_coarsening_bytes(const coarsening *c);

/* w [nnode][3] = L u; `mean` [nface] is for scratch. */
void corot_coarsen(const coarsening *c, const double (*u)[4], double (*mean)[4], double *w);

/* f += L' g for g [nnode][3]. */
void corot_coarsen_transposed(const coarsening *c, const double *g, double (*mean)[4],
                              double (*f)[4]);

#endif
