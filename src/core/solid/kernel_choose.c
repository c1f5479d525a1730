/* Each kernel calls the one that was compiled for this processor; where there is one build alone,
   its kernels have these names already. */
#include "kernel_choose.h"

#include "kernel.h"

#ifdef COROT_MANY_KERNELS
CHOOSE(int, corot_kernel_force,
       (const solid *body, solid_state *state, nodal_field u, nodal_field v, int chunk),
       (body, state, u, v, chunk))
CHOOSE(int, corot_kernel_derivative,
       (const solid *body, solid_state *state, nodal_field u, nodal_field v, nodal_field du,
        nodal_field dv, bool exact, int chunk),
       (body, state, u, v, du, dv, exact, chunk))
CHOOSE(int, corot_kernel_energy,
       (const solid *body, const solid_state *state, nodal_field u, nodal_field v, int chunk,
        double *elastic, double *power),
       (body, state, u, v, chunk, elastic, power))
CHOOSE(int, corot_kernel_frames, (const solid *body, nodal_field u, int chunk, block_mat3 *R),
       (body, u, chunk, R))
CHOOSE(int, corot_kernel_spin,
       (const solid *body, nodal_field u, nodal_field v, int chunk, block_vec3 *spin),
       (body, u, v, chunk, spin))
CHOOSE(int, corot_kernel_internal,
       (const solid *body, solid_state *state, nodal_field u, int strain, double lambda_part,
        double mu_part, int chunk),
       (body, state, u, strain, lambda_part, mu_part, chunk))
CHOOSE(void, corot_kernel_diagonals, (const solid *body, const int *node, int n, double (*A)[9]),
       (body, node, n, A))
CHOOSE(int, corot_kernel_tangent,
       (const solid *body, solid_state *state, nodal_field u, corot_tangent tangent, int chunk,
        double (*K)[9], double (*D)[9]),
       (body, state, u, tangent, chunk, K, D))
#endif
