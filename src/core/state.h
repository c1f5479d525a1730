/* Inside of a state: everything an evaluation writes to. */
#ifndef COROT_CORE_STATE_H
#define COROT_CORE_STATE_H

#include <corot/ode.h>

#include "core/model.h"

struct corot_state {
  int nnode, nblock, window, ndof; /* of the model */
  corot_frames frames;
  int inverted;    /* tet number in the mesh, or -1 */
  mat3 *R;         /* [nblock] the held frames */
  mat3 *new_R;     /* [nblock] those of an update, until it is known to succeed */
  double (*u)[4];  /* [nnode] displacement of all nodes, padded for the gather */
  double (*v)[4];  /* [nnode] velocity */
  double (*du)[4]; /* [nnode] directions of a derivative */
  double (*dv)[4];
  vd (*force)[4][3]; /* [window][local node][component] element forces, see pattern.h */
  double *r;         /* [ndof] */
};

#endif
