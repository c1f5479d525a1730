/* The deformation gradient of tets at their points of integration, from the nodes' displacements:
   of one tet in four-node tets, where it is the same everywhere; in ten-node tets at the four
   points whose barycentric coordinates are (5 + 3 sqrt 5) / 20 once and (5 - sqrt 5) / 20 three
   times, point k the one next to corner k. */
#ifndef COROT_REPORT_RUN_GRADIENTS_H
#define COROT_REPORT_RUN_GRADIENTS_H

#include "report/read/fields_file.h"

typedef struct gradients {
  const fields *f;
  int npoint;           /* of a tet: 1 or 4 */
  int ntet;             /* tets that are looked at */
  const int *tet;       /* [ntet] their numbers */
  double (*inverse)[9]; /* [ntet][npoint] of the Jacobian at rest */
} gradients;

/* `f` and `tet` must outlive it. COROT_ENOMEM. */
corot_status gradients_create(const fields *f, int ntet, const int *tet, gradients *g);
void gradients_free(gradients *g);

/* F = I + du/dX of the i-th tet at point q. */
void gradients_at(const gradients *g, const double (*u)[3], int i, int q, double F[9]);

/* The linear function with these values at the four points has corner[k] at corner k. Such a
   function p has p_k = (a - b) c_k + b sum c at the points, and the same sum there as at the
   corners. */
void gradients_to_corners(const double at[4], double corner[4]);

#endif
