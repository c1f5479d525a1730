/* Loops over the tets, all of them or those of one chunk. Each takes the nodal fields it reads,
   writes where it says, and returns the number of the first inverted tet, or -1; after an inversion
   the output means nothing. Frames are those of state->frames. */
#ifndef COROT_CORE_SOLID_KERNEL_H
#define COROT_CORE_SOLID_KERNEL_H

#include "kernel_names.h"
#include "solid.h"

/* Before the loops below, and without effect where dilatations are not averaged: the means that
   stand in for the dilatation of u, of the frames in use; for a measure with its own frames, index
   `strain`; and their change in the direction du. */
void corot_kernel_dilatation(const solid *body, solid_state *state, nodal_field u);
void corot_kernel_internal_dilatation(const solid *body, solid_state *state, nodal_field u,
                                      int strain);
void corot_kernel_dilatation_change(const solid *body, solid_state *state, nodal_field u,
                                    nodal_field du, bool exact);

/* state->force = -(internal force for u and, unless v is NULL, viscous force). */
int corot_kernel_force(const solid *body, solid_state *state, nodal_field u, nodal_field v,
                       int chunk);

/* state->force = the change of that for the directions du and dv; `exact`: with that of the frames.
 */
int corot_kernel_derivative(const solid *body, solid_state *state, nodal_field u, nodal_field v,
                            nodal_field du, nodal_field dv, bool exact, int chunk);

/* Elastic energy and, unless v is NULL, the power of the viscous forces. */
int corot_kernel_energy(const solid *body, const solid_state *state, nodal_field u, nodal_field v,
                        double *elastic, double *power);

/* R [tets.nblock] = the measure's own frames. */
int corot_kernel_frames(const solid *body, nodal_field u, block_mat3 *R);

/* spin [tets.nblock] = the angular velocity of the measure's own frames for the velocity v:
   dR/dt = [spin]x R. */
int corot_kernel_spin(const solid *body, nodal_field u, nodal_field v, block_vec3 *spin);

/* state->force = -(the internal force of a measure, index `strain`, with its own frames and with
   the material's coefficients times the factors given). */
int corot_kernel_internal(const solid *body, solid_state *state, nodal_field u, int strain,
                          double lambda_part, double mu_part, int chunk);

/* Adds the element matrices to K and D, either of which may be NULL, and completes the columns of
   the nodes that are ready then. */
int corot_kernel_tangent(const solid *body, solid_state *state, nodal_field u,
                         corot_tangent tangent, int chunk, double (*K)[9], double (*D)[9]);

/* Once the element matrices are: adds to K what the averages of the dilatation add. */
void corot_kernel_dilatation_tangent(const solid *body, solid_state *state, double (*K)[9]);

/* --- shared by the loops --------------------------------------------------------------------- */

/* The parts of blocks that a chunk starts with, and ends before. */
COROT_INLINE int chunk_start(int chunk) { return chunk * CHUNK * PARTS; }

COROT_INLINE int chunk_end(const solid *body, int chunk) {
  return chunk < body->tets.nblock / CHUNK ? chunk_start(chunk + 1) : body->tets.nblock * PARTS;
}

/* Gradient of a nodal field. */
COROT_INLINE mat3 gradient(tet_lanes block, nodal_field x) {
  mat3 G;
  vd x0[3], xa[3];
  gather_node(block, 0, x, x0);
  for (int a = 0; a < 3; a++) {
    gather_node(block, a + 1, x, xa);
    EACH_IJ {
      vd part = (xa[i] - x0[i]) * gradient_of(block, a + 1, j);
      G.m[i][j] = a == 0 ? part : G.m[i][j] + part;
    }
  }
  return G;
}

/* F = I + grad u. */
COROT_INLINE mat3 deformation(tet_lanes block, nodal_field u) {
  return mat3_add_identity(gradient(block, u), vd_all(1));
}

/* What the warping frame of part b starts from, in `room` if need be; NULL for other rules. */
COROT_INLINE const mat3 *rest_basis_of(frame_rule rule, const solid *body, int b, mat3 *room) {
  return rule == FRAME_WARP ? mat3_in(body->tets.rest_basis, b, room) : NULL;
}

/* The frame in use of part b, and the lanes whose F is not that of a deformation. Cauchy strain is
   linear in F, so there nothing can invert. */
COROT_INLINE mat3 frame_in_use(const strain_measure *s, const solid *body, const frame_source *from,
                               int b, mat3 F, vi *inverted) {
  if (strain_is_linear(s)) return mat3_identity();
  vi bad;
  mat3 R, room;
  if (from->kind == COROT_FRAMES_EXACT || s->frame == FRAME_IDENTITY) {
    R = frame_of(s->frame, F, rest_basis_of(s->frame, body, b, &room), &bad);
  } else {
    bad = ~(mat3_det(F, mat3_cofactor(F)) > vd_all(0));
    R = mat3_at(from->R, b);
    if (from->kind == COROT_FRAMES_EXTRAPOLATED)
      R = rotate_by(vec3_at(from->spin, b), from->age, R);
  }
  *inverted |= bad;
  return R;
}

/* What every loop starts from: the tets of part b displaced by u. */
typedef struct element {
  tet_lanes block;
  const material *mat;
  mat3 F, R;
  vi inverted;
} element;

COROT_INLINE element element_at(const strain_measure *s, const solid *body,
                                const frame_source *from, nodal_field u, int b) {
  element e = {.block = tets_at(&body->tets, b)};
  e.mat = &body->material[e.block.in->material];
  e.F = deformation(e.block, u);
  e.R = frame_in_use(s, body, from, b, e.F, &e.inverted);
  return e;
}

/* Nodal forces A g_a of part b into the buffer; A is -V P. */
COROT_INLINE void store_forces(const solid *body, solid_state *state, int b, mat3 A) {
  tet_lanes block = tets_at(&body->tets, b);
  block_vd(*force)[3] = state->force[b / PARTS % body->pattern.window];
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
COROT_INLINE int first_inverted(const solid *body, int b, vi inverted) {
  for (int l = 0; l < LANES; l++)
    if (inverted[l]) return body->tets.number[b * LANES + l];
  return -1;
}

#endif
