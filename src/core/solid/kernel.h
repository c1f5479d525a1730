/* Loops over the tets, all of them or those of one chunk. Each takes the nodal fields it reads,
   writes where it says, and returns the number of the first inverted tet, or -1; after an inversion
   the output means nothing. Frames are those of state->frames. */
#ifndef COROT_CORE_SOLID_KERNEL_H
#define COROT_CORE_SOLID_KERNEL_H

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
int corot_kernel_frames(const solid *body, nodal_field u, mat3 *R);

/* spin [tets.nblock] = the angular velocity of the measure's own frames for the velocity v:
   dR/dt = [spin]x R. */
int corot_kernel_spin(const solid *body, nodal_field u, nodal_field v, vec3 *spin);

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

/* The blocks of a chunk end before this one. */
COROT_INLINE int chunk_end(const solid *body, int chunk) {
  return chunk < body->tets.nblock / CHUNK ? (chunk + 1) * CHUNK : body->tets.nblock;
}

/* Gradient of a nodal field. */
COROT_INLINE mat3 gradient(const tet_block *block, nodal_field x) {
  mat3 G;
  vd x0[3], xa[3];
  vd_gather3(x, block->node[0], x0);
  for (int a = 0; a < 3; a++) {
    vd_gather3(x, block->node[a + 1], xa);
    EACH_IJ {
      vd part = (xa[i] - x0[i]) * block->g.m[a][j];
      G.m[i][j] = a == 0 ? part : G.m[i][j] + part;
    }
  }
  return G;
}

/* F = I + grad u. */
COROT_INLINE mat3 deformation(const tet_block *block, nodal_field u) {
  return mat3_add_identity(gradient(block, u), vd_all(1));
}

/* The frame in use of block b, and the lanes whose F is not that of a deformation. Cauchy strain is
   linear in F, so there nothing can invert. */
COROT_INLINE mat3 frame_in_use(const strain_measure *s, const solid *body, const frame_source *from,
                               int b, mat3 F, vi *inverted) {
  if (strain_is_linear(s)) return mat3_identity();
  const mat3 *Q0 = s->frame == FRAME_WARP ? &body->tets.rest_basis[b] : NULL;
  vi bad;
  mat3 R;
  if (from->kind == COROT_FRAMES_EXACT || s->frame == FRAME_IDENTITY) {
    R = frame_of(s->frame, F, Q0, &bad);
  } else {
    bad = ~(mat3_det(F, mat3_cofactor(F)) > vd_all(0));
    R = from->R[b];
    if (from->kind == COROT_FRAMES_EXTRAPOLATED) R = rotate_by(from->spin[b], from->age, R);
  }
  *inverted |= bad;
  return R;
}

/* What every loop starts from: the tets of block b displaced by u. */
typedef struct element {
  const tet_block *block;
  const material *mat;
  mat3 F, R;
  vi inverted;
} element;

COROT_INLINE element element_at(const strain_measure *s, const solid *body,
                                const frame_source *from, nodal_field u, int b) {
  element e = {.block = &body->tets.block[b]};
  e.mat = &body->material[e.block->material];
  e.F = deformation(e.block, u);
  e.R = frame_in_use(s, body, from, b, e.F, &e.inverted);
  return e;
}

/* Nodal forces A g_a of block b into the buffer; A is -V P. */
COROT_INLINE void store_forces(const solid *body, solid_state *state, int b, mat3 A) {
  const mat3 *g = &body->tets.block[b].g;
  vd(*force)[3] = state->force[b % body->pattern.window];
  for (int i = 0; i < 3; i++) {
    vd rest = vd_all(0);
    for (int a = 1; a < 4; a++) {
      vd f = A.m[i][0] * g->m[a - 1][0] + A.m[i][1] * g->m[a - 1][1] + A.m[i][2] * g->m[a - 1][2];
      force[a][i] = f;
      rest -= f;
    }
    force[0][i] = rest;
  }
}

/* The mesh's number of the first inverted tet of block b; -1 if there is none. */
COROT_INLINE int first_inverted(const solid *body, int b, vi inverted) {
  for (int l = 0; l < W; l++)
    if (inverted[l]) return body->tets.number[b * W + l];
  return -1;
}

#endif
