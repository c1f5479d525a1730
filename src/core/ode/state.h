/* Inside of a state: everything an evaluation writes to. */
#ifndef COROT_CORE_ODE_STATE_H
#define COROT_CORE_ODE_STATE_H

#include <corot/ode.h>

#include "core/model/model.h"

struct levels_state;

struct corot_state {
  int nnode, nblock, window, ndof; /* of the model */
  corot_frames frames;
  int inverted;       /* tet number in the mesh, or -1 */
  double phase;       /* loads and motions follow the law in force just after it; NaN: t */
  bool still;         /* nothing has a velocity, and the loads are those */
  double load_time;   /* of this time, not of the evaluation's */
  double load_factor; /* times this */
  double t_update;    /* when the held frames were found */
  double elapsed;     /* since then, in the present evaluation */
  block_mat3 *R;      /* [nblock] the held frames */
  block_vec3 *spin;   /* [nblock] their angular velocity, for extrapolation [rad/s] */
  block_mat3 *now_R;  /* [nblock] extrapolated frames, to compare with */
  block_mat3 *new_R;  /* [nblock] those of an update, until it is known to succeed */
  double (*u)[4];     /* [nnode] displacement of all nodes, padded for the gather */
  double (*v)[4];     /* [nnode] velocity */
  double (*du)[4];    /* [nnode] directions of a derivative */
  double (*dv)[4];
  block_vd *dilatation; /* [nblock] means in place of tr(e_p); NULL, as the next, where there are
                     none: see dilatation.h */
  block_vd *dilatation_change; /* [nblock] the same of a derivative */
  double *pool;                /* [npool] */
  block_vd (*slope)[4][3];     /* [nblock][local node] V times d tr(e_p) / du */
  double (*gathered)[3];       /* [nnode] zero between uses */
  int npool;
  block_vd (*force)[4][3]; /* [window][local node][component] element forces, see pattern.h */
  double *r;               /* [ndof] */

  struct levels_state *levels; /* of a hierarchical model, whose R are the frames handed down; else
                                  NULL; see levels.h */
  block_mat3 *dR;              /* [nblock] of a part that hands down its frames, their change; */
  block_vec3 *moment;          /* [nblock] what turns them, from all descendants [J]; */
  block_vec3 *dmoment;         /* [nblock] its change; else NULL */
};

/* Room for dR, moment and dmoment. */
corot_status corot_state_allow_turning(const corot_model *m, corot_state *s);

/* Before an evaluation: all nodes' displacement at t, and the age of the held frames. */
void corot_state_displace(const corot_model *m, corot_state *s, double t, const double *u);

/* Remembers the tet a kernel returned; COROT_RETRY if there is one. */
corot_status corot_state_check(corot_state *s, int tet);

#endif
