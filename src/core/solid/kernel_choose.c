/* Each kernel calls the one that was compiled for this processor; where there is one build alone,
   its kernels have these names already. */
#include "core/lanes/widths.h"
#include "kernel.h"

#ifdef COROT_MANY_KERNELS
#define CHOOSE(result, name, parameters, arguments)                \
  extern __typeof__(name) name##_v1, name##_v3, name##_v4;         \
  result name parameters {                                         \
    int lanes = corot_lanes_in_use();                              \
    if (lanes == 8) return name##_v4 arguments;                    \
    return lanes == 4 ? name##_v3 arguments : name##_v1 arguments; \
  }

#define CHOOSE_FORCE(name)                                                              \
  CHOOSE(int, name, (const corot_model *m, corot_state *state, bool option, int chunk), \
         (m, state, option, chunk))

CHOOSE_FORCE(corot_kernel_force)
CHOOSE_FORCE(corot_kernel_derivative)
CHOOSE_FORCE(corot_kernel_handed_force)
CHOOSE_FORCE(corot_kernel_handed_derivative)
CHOOSE_FORCE(corot_kernel_turning_force)
CHOOSE_FORCE(corot_kernel_turning_derivative)
CHOOSE(int, corot_kernel_energy,
       (const corot_model *m, corot_state *state, bool damped, double *elastic, double *power),
       (m, state, damped, elastic, power))
CHOOSE(int, corot_kernel_frames, (const corot_model *m, corot_state *state, block_mat3 *R),
       (m, state, R))
CHOOSE(int, corot_kernel_spin, (const corot_model *m, corot_state *state, block_vec3 *spin),
       (m, state, spin))
CHOOSE(int, corot_kernel_internal,
       (const corot_model *m, corot_state *state, int strain, double lambda_part, double mu_part,
        int chunk),
       (m, state, strain, lambda_part, mu_part, chunk))
CHOOSE(int, corot_kernel_tangent,
       (const corot_model *m, corot_state *state, corot_tangent tangent, int chunk, double (*K)[9],
        double (*D)[9]),
       (m, state, tangent, chunk, K, D))
CHOOSE(void, corot_kernel_hand_down, (const corot_model *m, corot_state *state), (m, state))
CHOOSE(void, corot_kernel_frames_change, (const corot_model *m, corot_state *state), (m, state))
#endif
