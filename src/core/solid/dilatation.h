/* Dilatation averaged, against the locking of nearly incompressible tets.

   Where each tet's dilatation theta_e = tr(e_p) is its own, a mesh of tets has more constraints
   than unknowns as lambda grows. Averaged over the tets around a node,

     theta_a = sum_e V_e theta_e / sum_e V_e,      V_a = sum_e V_e / 4

   there is one for three unknowns (Bonet & Burton 1998). The nodes are the corners, of ten-node
   tets too: then the pressure is as that of Taylor and Hood. Averaged over the points of each such
   tet instead, there is one for a tet, which is stable for quadratic displacements. Of a material's
   lambda the part `local` stays with the tets, and the energy of the pressure term is

     sum_e V_e local/2 theta_e^2 + sum_a V_a (lambda - local)/2 theta_a^2
       = sum_e V_e lambda/2 theta_e thetabar_e

   with the mean thetabar_e = s theta_e + (1 - s) sum_{a at e} theta_a / 4, s = local / lambda,
   which takes the place of theta_e in the stress. Materials do not mix: a node where several meet
   has an average of each, for pressure may jump between them. */
#ifndef COROT_CORE_SOLID_DILATATION_H
#define COROT_CORE_SOLID_DILATATION_H

#include <stdbool.h>

#include "core/element/tets.h"

/* So many pools, one after the other, are a batch: batches of one colour share no node of a ring,
   so that threads may add what these give to a matrix at the same time, colour by colour. */
enum { BATCH = 32, MOST_COLOURS = 64 };

/* A pool is what is averaged: the tets of one material around a corner, or one tet. */
typedef struct dilatation {
  int npool;       /* 0: every dilatation is its tet's own */
  int per;         /* pools that an element is in: 4 or 1 */
  int (*pool)[W];  /* [elements.nblock][per] */
  double *volume;  /* [npool] of its tets [m^3] */
  double *lambda;  /* [npool] what is averaged of it [Pa] */
  int *tet_first;  /* [npool + 1] each pool's part of `tet` */
  int *tet;        /* [per ntet] W times block plus lane, ascending */
  int *ring_first; /* [npool + 1] each pool's part of `ring` */
  int *ring;       /* the nodes of its tets, ascending; none where lambda is zero */
  int ncolour;
  int first[MOST_COLOURS + 2]; /* each colour's part of `batch`; first[ncolour]: those for which
                                  there was none, which come one by one */
  int *batch;                  /* [first[ncolour + 1]] */
} dilatation;

/* The pools of a batch end before this. */
static inline int batch_end(const dilatation *d, int batch) {
  return (batch + 1) * BATCH < d->npool ? (batch + 1) * BATCH : d->npool;
}

/* The pools of the lanes' corner k of block b, or of the lanes' elements. */
static inline const int *pools_at(const dilatation *d, int b, int k) {
  return d->pool[b * d->per + k];
}

/* averaged [material]: lambda - local [Pa]; at the corners or, `by_element`, over each element. */
corot_status corot_dilatation_create(const corot_mesh *mesh, const element_set *t, bool by_element,
                                     const double *averaged, dilatation *out);
void corot_dilatation_clear(dilatation *d);
size_t corot_dilatation_bytes(const dilatation *d, const element_set *t);

#endif
