/* Loops over the tets, all of them or those of one chunk. Each reads the nodal fields in the state,
   writes where it says, and returns the number of the first inverted tet, or -1; after an inversion
   the output means nothing. */
#ifndef COROT_CORE_SOLID_KERNEL_H
#define COROT_CORE_SOLID_KERNEL_H

#include "core/ode/state.h"
#include "kernel_names.h"

/* A kernel of element forces. */
typedef int force_kernel(const corot_model *m, corot_state *state, bool option, int chunk);

/* s->r += the forces that the kernel finds, on free degrees of freedom. */
corot_status corot_sum_forces(const corot_model *m, corot_state *s, double t, force_kernel *kernel,
                              bool option);

/* f [nnode] = these forces on all nodes; the fourth column is not set. */
corot_status corot_nodal_forces(const corot_model *m, corot_state *s, force_kernel *kernel,
                                bool option, double (*f)[4]);

/* Before the loops below, and without effect where dilatations are not averaged: the means that
   stand in for the dilatation of state->u, of the frames in use; for a measure with its own frames,
   index `strain`; and their change in the direction state->du. */
void corot_kernel_dilatation(const corot_model *m, corot_state *state);
void corot_kernel_internal_dilatation(const corot_model *m, corot_state *state, int strain);
void corot_kernel_dilatation_change(const corot_model *m, corot_state *state, bool exact);

/* state->force = -(internal + viscous force) for state->u and, if `damped`, state->v. */
int corot_kernel_force(const corot_model *m, corot_state *state, bool damped, int chunk);

/* state->force = the change of that for the directions state->du and state->dv; `exact`: with that
   of the frames. */
int corot_kernel_derivative(const corot_model *m, corot_state *state, bool exact, int chunk);

/* Elastic energy and, if `damped`, the power of the viscous forces. */
int corot_kernel_energy(const corot_model *m, corot_state *state, bool damped, double *elastic,
                        double *power);

/* R [tets.nblock] = the measure's own frames. */
int corot_kernel_frames(const corot_model *m, corot_state *state, block_mat3 *R);

/* spin [tets.nblock] = the angular velocity of the measure's own frames for the velocity
   state->v: dR/dt = [spin]x R. */
int corot_kernel_spin(const corot_model *m, corot_state *state, block_vec3 *spin);

/* state->force = -(the internal force of a measure, index `strain`, with its own frames and with
   the material's coefficients times the factors given). */
int corot_kernel_internal(const corot_model *m, corot_state *state, int strain, double lambda_part,
                          double mu_part, int chunk);

/* Adds the element matrices to K and D, either of which may be NULL, and completes the columns of
   the nodes that are ready then. */
int corot_kernel_tangent(const corot_model *m, corot_state *state, corot_tangent tangent, int chunk,
                         double (*K)[9], double (*D)[9]);

/* Once the element matrices are: adds to K what the averages of the dilatation add. */
void corot_kernel_dilatation_tangent(const corot_model *m, corot_state *state, double (*K)[9]);

/* Of a hierarchical model whose framer has its frames in now_R: the force as corot_kernel_force,
   and the framer's moment += V vee(R'F sigma) of the elastic stress. */
int corot_kernel_handed_force(const corot_model *m, corot_state *state, bool damped, int chunk);

/* The changes of both for state->du, state->dv and the framer's dR; and the moment. */
int corot_kernel_handed_derivative(const corot_model *m, corot_state *state, bool damped,
                                   int chunk);

/* state->R = the framer's frames over each tet. */
void corot_kernel_hand_down(const corot_model *m, corot_state *state);

/* Of the framer, whose polar frames have been handed down: state->force = -(the force by which they
   turn), from the moments. */
int corot_kernel_turning_force(const corot_model *m, corot_state *state, bool unused, int chunk);

/* Its change for state->du, state->dR and state->dmoment. */
int corot_kernel_turning_derivative(const corot_model *m, corot_state *state, bool unused,
                                    int chunk);

/* state->dR = the change of the frames state->now_R for state->du. */
void corot_kernel_frames_change(const corot_model *m, corot_state *state);

/* --- shared by the loops --------------------------------------------------------------------- */

/* The parts of blocks that a chunk starts with, and ends before. */
COROT_INLINE int chunk_start(int chunk) { return chunk * CHUNK * PARTS; }

COROT_INLINE int chunk_end(const corot_model *m, int chunk) {
  return chunk < m->tets.nblock / CHUNK ? chunk_start(chunk + 1) : m->tets.nblock * PARTS;
}

/* Gradient of a nodal field. */
COROT_INLINE mat3 gradient(tet_lanes block, const double (*x)[4]) {
  mat3 G;
  vd x0[3], xa[3];
  gather_node(block, 0, x, x0);
  for (int a = 0; a < 3; a++) {
    gather_node(block, a + 1, x, xa);
    EACH_IJ {
      vd term = (xa[i] - x0[i]) * gradient_of(block, a + 1, j);
      G.m[i][j] = a == 0 ? term : G.m[i][j] + term;
    }
  }
  return G;
}

/* F = I + grad u. */
COROT_INLINE mat3 deformation(tet_lanes block, const double (*u)[4]) {
  return mat3_add_identity(gradient(block, u), vd_all(1));
}

/* What the warping frame of part b starts from, in `room` if need be; NULL for other rules. */
COROT_INLINE const mat3 *rest_basis_of(frame_rule rule, const corot_model *m, int b, mat3 *room) {
  return rule == FRAME_WARP ? mat3_in(m->tets.rest_basis, b, room) : NULL;
}

/* The frame in use, and the lanes whose F is not that of a deformation. Cauchy
   strain is linear in F, so there nothing can invert. */
COROT_INLINE mat3 frame_in_use(const strain_measure *s, const corot_model *m,
                               const corot_state *state, int b, mat3 F, vi *inverted) {
  if (strain_is_linear(s)) return mat3_identity();
  vi bad;
  mat3 R, room;
  if (state->frames == COROT_FRAMES_EXACT || s->frame == FRAME_IDENTITY) {
    R = frame_of(s->frame, F, rest_basis_of(s->frame, m, b, &room), &bad);
  } else {
    bad = ~(mat3_det(F, mat3_cofactor(F)) > vd_all(0));
    R = mat3_at(state->R, b);
    if (state->frames == COROT_FRAMES_EXTRAPOLATED)
      R = rotate_by(vec3_at(state->spin, b), state->elapsed, R);
  }
  *inverted |= bad;
  return R;
}

/* What every loop starts from: the tets of part b in the state's displacement. */
typedef struct element {
  tet_lanes block;
  const material *mat;
  mat3 F, R;
  vi inverted;
} element;

COROT_INLINE element element_at(const strain_measure *s, const corot_model *m,
                                const corot_state *state, int b) {
  element e = {.block = tets_at(&m->tets, b)};
  e.mat = &m->material[e.block.in->material];
  e.F = deformation(e.block, (const double(*)[4])state->u);
  e.R = frame_in_use(s, m, state, b, e.F, &e.inverted);
  return e;
}

/* Nodal forces A g_a of part b into the buffer; A is -V P. */
COROT_INLINE void store_forces(const corot_model *m, corot_state *state, int b, mat3 A) {
  tet_lanes block = tets_at(&m->tets, b);
  block_vd(*force)[3] = state->force[b / PARTS % m->pattern.window];
  for (int i = 0; i < 3; i++) {
    vd rest = vd_all(0);
    for (int a = 1; a < 4; a++) {
      vd f = A.m[i][0] * gradient_of(block, a, 0) + A.m[i][1] * gradient_of(block, a, 1) +
             A.m[i][2] * gradient_of(block, a, 2);
      vd_put(&force[a][i], b % PARTS, f);
      rest -= f;
    }
    vd_put(&force[0][i], b % PARTS, rest);
  }
}

/* The mesh's number of the first inverted tet of part b; -1 if there is none. */
COROT_INLINE int first_inverted(const corot_model *m, int b, vi inverted) {
  for (int l = 0; l < LANES; l++)
    if (inverted[l]) return m->tets.number[b * LANES + l];
  return -1;
}

#endif
