/* Loops over tets in frames that are handed down to them by the tets of another body, the leader,
   and over the leader's, whose frames the stresses turn: see system.h. What they return is as in
   core/solid/kernel.h. */
#ifndef COROT_CORE_SYSTEM_KERNEL_HANDED_H
#define COROT_CORE_SYSTEM_KERNEL_HANDED_H

#include "core/solid/kernel.h"

/* What there is of the leader over a body's tets. */
typedef struct from_leader {
  int npoint;                   /* of the leader's tets: one, or as many as the body's */
  const int *above;             /* [the body's tets.nblock] as in system.h */
  const block_mat3 *R, *dR;     /* the frames, and their change */
  block_vec3 *moment, *dmoment; /* what turns them, and its change: added to */
} from_leader;

/* R [points] = the leader's frames over each tet. */
void corot_kernel_hand_down(const solid *body, const from_leader *lead, int chunk, block_mat3 *R);

/* As corot_kernel_force, and the moments += V vee(R'F sigma) of the elastic stress. */
int corot_kernel_handed_force(const solid *body, solid_state *state, const from_leader *lead,
                              nodal_field u, nodal_field v, int chunk);

/* The changes of both for du, dv and dR, which is zero where the frames do not follow; and the
   moments. */
int corot_kernel_handed_derivative(const solid *body, solid_state *state, const from_leader *lead,
                                   nodal_field u, nodal_field v, nodal_field du, nodal_field dv,
                                   int chunk);

/* Of the leader, with the polar frames R: state->force = -(the force by which they turn). */
int corot_kernel_turning_force(const solid *leader, solid_state *state, const from_leader *lead,
                               nodal_field u, int chunk);

/* Its change for du, dR and dmoment. */
int corot_kernel_turning_derivative(const solid *leader, solid_state *state,
                                    const from_leader *lead, nodal_field u, nodal_field du,
                                    int chunk);

/* dR [points] = the change of the leader's frames R for du. */
void corot_kernel_frames_change(const solid *leader, const block_mat3 *R, nodal_field u,
                                nodal_field du, int chunk, block_mat3 *dR);

#endif
