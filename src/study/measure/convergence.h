/* What three levels of a quantity say about its error, the spacing halved from one to the next.

   With d1 the difference of the first two levels and d2 that of the last two, and an error that
   shrinks by 2^-p a level, d2 = d1 2^-p: the order p = log2(d1 / d2) is observed, the error of the
   first level is d1 / (1 - 2^-p), and d2 / (2^p - 1) of it remains at the third (Richardson's
   extrapolation; P. J. Roache, Verification and Validation in Computational Science and
   Engineering, 1998, chapter 5).

   That is believed only where the levels look as if it were true; elsewhere the error is at least
   what the levels have shown, and nobody knows how much more. */
#ifndef COROT_STUDY_MEASURE_CONVERGENCE_H
#define COROT_STUDY_MEASURE_CONVERGENCE_H

#include <stdbool.h>

/* The displacements of linear tets converge at order 2 where all is smooth, at 1 to 1.5 near the
   corners of a support, and seem to at 0.5 or less as long as the tets are too stiff. */
#define CONVERGENCE_LOWEST 0.5
#define CONVERGENCE_HIGHEST 2.5

/* Those of ten-node tets converge at order 3 where all is smooth, and at nodes at up to 4; near the
   corners of a support at the same 1 to 1.5. */
#define CONVERGENCE_HIGHEST_2 4.5

/* The remainder after the third level may be so many times what is extrapolated: as where an order
   of 1.8 is observed and that of a corner, 1, is what remains. */
#define CONVERGENCE_SAFETY 3.0

typedef struct convergence {
  double order; /* log2(d1 / d2); NaN: there is none */
  double
      remainder; /* 1 / (2^order - 1): what the third level leaves, over d2; 0 if not asymptotic */
  bool asymptotic;
  const char *why; /* not, in words; static */
} convergence;

/* d1, d2 >= 0; cosine: of the angle between the two differences: below 0 they alternate; known:
   what each is uncertain by. Where they point in different directions, but not against one another,
   the remainder holds for its size. */
convergence convergence_observe(double d1, double d2, double cosine, double known);

/* The same of meshes of that order (corot_mesh_order). */
convergence convergence_observe_of(int mesh_order, double d1, double d2, double cosine,
                                   double known);

#endif
