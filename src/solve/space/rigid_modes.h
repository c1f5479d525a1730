/* The rigid motions that nothing holds, as fields that are orthonormal in the mass, and how they
   are taken out of displacements and forces. */
#ifndef COROT_SOLVE_SPACE_RIGID_MODES_H
#define COROT_SOLVE_SPACE_RIGID_MODES_H

#include "solve/statics/rigid.h"

/* Of the square of the model's frequency: how stiffly what nothing holds is tied to where it is. It
   is far below the square of any frequency of a body that is no thinner than a hundredth of its
   length; the rigid motions themselves are taken out of forces and displacement. */
#define SPACE_TIE 1e-5

typedef struct rigid_modes {
  const corot_model *model;
  corot_rigid rigid; /* of which the fields are Z, of each part Z' M Z = 1 */
  bool any;          /* some part is not held; else there is no more than this */
  double *image;     /* [6][ndof] M Z */
  double *sum;       /* [npart] scratch */
} rigid_modes;

/* Of the body where its nodes are now, x [nnode]. What is half made is released by clear. */
corot_status corot_rigid_modes_create(const corot_model *model, const double (*x)[3],
                                      rigid_modes *m);
void corot_rigid_modes_clear(rigid_modes *m);

/* Nothing if there are none. u [ndof] -= Z Z' M u: a displacement without rigid motions. f [ndof]
   -= M Z Z' f: forces less those of inertia by which they would accelerate the parts as rigid ones.
 */
void corot_rigid_modes_leave(rigid_modes *m, double *u);
void corot_rigid_modes_balance(rigid_modes *m, double *f);

#endif
