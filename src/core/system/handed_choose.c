/* The loops over handed down frames call those that were compiled for this processor, as in
   core/solid/kernel_choose.c. */
#include "core/solid/kernel_choose.h"
#include "kernel_handed.h"

#ifdef COROT_MANY_KERNELS
CHOOSE(void, corot_kernel_hand_down,
       (const solid *body, const from_leader *lead, int chunk, block_mat3 *R),
       (body, lead, chunk, R))
CHOOSE(int, corot_kernel_handed_force,
       (const solid *body, solid_state *state, const from_leader *lead, nodal_field u,
        nodal_field v, int chunk),
       (body, state, lead, u, v, chunk))
CHOOSE(int, corot_kernel_handed_derivative,
       (const solid *body, solid_state *state, const from_leader *lead, nodal_field u,
        nodal_field v, nodal_field du, nodal_field dv, int chunk),
       (body, state, lead, u, v, du, dv, chunk))
CHOOSE(int, corot_kernel_turning_force,
       (const solid *leader, solid_state *state, const from_leader *lead, nodal_field u, int chunk),
       (leader, state, lead, u, chunk))
CHOOSE(int, corot_kernel_turning_derivative,
       (const solid *leader, solid_state *state, const from_leader *lead, nodal_field u,
        nodal_field du, int chunk),
       (leader, state, lead, u, du, chunk))
CHOOSE(void, corot_kernel_frames_change,
       (const solid *leader, const block_mat3 *R, nodal_field u, nodal_field du, int chunk,
        block_mat3 *dR),
       (leader, R, u, du, chunk, dR))
#endif
