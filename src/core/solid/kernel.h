/* Loops over the tets of one chunk. Each takes the nodal fields it reads, writes where it says, and
   returns the number of the first inverted tet, or -1; after an inversion the output means nothing.
   Frames are those of state->frames. Chunks may be worked on at the same time, but for those that
   share a window of element forces. */
#ifndef COROT_CORE_SOLID_KERNEL_H
#define COROT_CORE_SOLID_KERNEL_H

#include "kernel_names.h"
#include "solid.h"

/* theta [points] = each point's own dilatation for u, of the frames in use; for a measure with its
   own frames, index `strain`; and the change in the direction du. An inverted tet is left to the
   loop that comes after. */
void corot_kernel_dilatation(const solid *body, const solid_state *state, nodal_field u, int chunk,
                             block_vd *theta);
void corot_kernel_internal_dilatation(const solid *body, nodal_field u, int strain, int chunk,
                                      block_vd *theta);
void corot_kernel_dilatation_change(const solid *body, const solid_state *state, nodal_field u,
                                    nodal_field du, bool exact, int chunk, block_vd *change);

/* Of the pools from `first` on, pool [npool] = the mean of theta; and for a chunk, theta becomes
   the mean that stands in for it. */
void corot_kernel_pool(const solid *body, const block_vd *theta, int first, int end, double *pool);
void corot_kernel_unpool(const solid *body, const double *pool, int chunk, block_vd *theta);

/* state->force = -(internal force for u and, unless v is NULL, viscous force). */
int corot_kernel_force(const solid *body, solid_state *state, nodal_field u, nodal_field v,
                       int chunk);

/* state->force = the change of that for the directions du and dv; `exact`: with that of the frames.
 */
int corot_kernel_derivative(const solid *body, solid_state *state, nodal_field u, nodal_field v,
                            nodal_field du, nodal_field dv, bool exact, int chunk);

/* Elastic energy and, unless v is NULL, the power of the viscous forces. */
int corot_kernel_energy(const solid *body, const solid_state *state, nodal_field u, nodal_field v,
                        int chunk, double *elastic, double *power);

/* R [points] = the measure's own frames. */
int corot_kernel_frames(const solid *body, nodal_field u, int chunk, block_mat3 *R);

/* spin [points] = the angular velocity of the measure's own frames for the velocity v:
   dR/dt = [spin]x R. */
int corot_kernel_spin(const solid *body, nodal_field u, nodal_field v, int chunk, block_vec3 *spin);

/* state->force = -(the internal force of a measure, index `strain`, with its own frames and with
   the material's coefficients times the factors given). */
int corot_kernel_internal(const solid *body, solid_state *state, nodal_field u, int strain,
                          double lambda_part, double mu_part, int chunk);

/* Adds the element matrices to K and D, either of which may be NULL, or sets them aside where the
   ranges of the state say so. */
int corot_kernel_tangent(const solid *body, solid_state *state, nodal_field u,
                         corot_tangent tangent, int chunk, double (*K)[9], double (*D)[9]);

/* The diagonal blocks of n nodes, once all others of their rows and columns are there. */
void corot_kernel_diagonals(const solid *body, const int *node, int n, double (*A)[9]);

/* Once the element matrices are: adds to K what the averages of the dilatation add, of the pools of
   a batch. `gathered` [nnode] is zero, and is left so. */
void corot_kernel_dilatation_tangent(const solid *body, const solid_state *state, int batch,
                                     double (*gathered)[3], double (*K)[9]);

/* --- shared by the loops --------------------------------------------------------------------- */

/* The parts of blocks that a chunk starts with, and ends before. */
COROT_INLINE int chunk_start(int chunk) { return chunk * CHUNK * PARTS; }

COROT_INLINE int chunk_end(const solid *body, int chunk) {
  return chunk < body->elements.nblock / CHUNK ? chunk_start(chunk + 1)
                                               : body->elements.nblock * PARTS;
}

/* A loop over the elements of `set`, with their kind as a constant where it is compiled. */
#define OF_KIND(set, loop, ...)                                            \
  ((set)->kind->number == TET10 ? loop(&element_kinds[TET10], __VA_ARGS__) \
                                : loop(&element_kinds[TET4], __VA_ARGS__))
_Static_assert(NKIND == 2, "each kind has its loops");

#define EACH_POINT(kind, q) for (int q = 0; q < (kind)->npoint; q++)

/* What a nodal field has at the nodes of LANES elements beyond their node 0. */
typedef struct differences {
  vd of[KIND_NODES][3]; /* [node]; 0: nothing */
} differences;

COROT_INLINE differences differences_of(point_lanes at, nodal_field x) {
  differences d;
  vd x0[3], xa[3];
  gather_node(at, 0, x, x0);
  for (int a = 1; a < at.kind->nnode; a++) {
    gather_node(at, a, x, xa);
    for (int i = 0; i < 3; i++) d.of[a][i] = xa[i] - x0[i];
  }
  return d;
}

/* Gradient of a nodal field at a point. */
COROT_INLINE mat3 gradient(point_lanes at, const differences *x) {
  mat3 G;
  for (int a = 1; a < at.kind->nnode; a++) EACH_IJ {
      vd part = x->of[a][i] * slope_of(at, a, j);
      G.m[i][j] = a == 1 ? part : G.m[i][j] + part;
    }
  return G;
}

/* F = I + grad u. */
COROT_INLINE mat3 deformation(point_lanes at, const differences *u) {
  return mat3_add_identity(gradient(at, u), vd_all(1));
}

/* What the warping frames of a part start from, in `room` if need be; NULL for other rules. */
COROT_INLINE const mat3 *rest_basis_of(frame_rule rule, point_lanes at, mat3 *room) {
  const block_mat3 *all = at.set->rest_basis;
  return rule == FRAME_WARP ? mat3_in(all, at.block * PARTS + at.part, room) : NULL;
}

/* The frame in use at a point, and the lanes whose F is not that of a deformation. Cauchy strain is
   linear in F, so there nothing can invert. */
COROT_INLINE mat3 frame_in_use(const strain_measure *s, const frame_source *from, point_lanes at,
                               mat3 F, vi *inverted) {
  if (strain_is_linear(s)) return mat3_identity();
  vi bad;
  mat3 R, room;
  if (from->kind == COROT_FRAMES_EXACT || s->frame == FRAME_IDENTITY) {
    R = frame_of(s->frame, F, rest_basis_of(s->frame, at, &room), &bad);
  } else {
    bad = ~(mat3_det(F, mat3_cofactor(F)) > vd_all(0));
    R = mat3_at(from->R, index_of(at));
    if (from->kind == COROT_FRAMES_EXTRAPOLATED)
      R = rotate_by(vec3_at(from->spin, index_of(at)), from->age, R);
  }
  *inverted |= bad;
  return R;
}

/* What every loop starts from: a point of the elements displaced by u. */
typedef struct element {
  point_lanes at;
  const material *mat;
  mat3 F, R;
  vi inverted;
} element;

COROT_INLINE element element_at(const strain_measure *s, const solid *body,
                                const frame_source *from, const differences *u, point_lanes at) {
  element e = {.at = at};
  e.mat = &body->material[material_of(at)];
  e.F = deformation(at, u);
  e.R = frame_in_use(s, from, at, e.F, &e.inverted);
  return e;
}

/* Forces on the nodes of LANES elements, [node]; that on node 0 is minus their sum. */
typedef struct node_forces {
  vd on[KIND_NODES][3];
} node_forces;

/* A g_a of a point, to those of the points before it; A is -w P. */
COROT_INLINE void add_forces(point_lanes at, mat3 A, node_forces *f) {
  for (int i = 0; i < 3; i++)
    for (int a = 1; a < at.kind->nnode; a++) {
      vd part = A.m[i][0] * slope_of(at, a, 0) + A.m[i][1] * slope_of(at, a, 1) +
                A.m[i][2] * slope_of(at, a, 2);
      f->on[a][i] = at.q == 0 ? part : f->on[a][i] + part;
    }
}

/* Into the buffer. */
COROT_INLINE void store_forces(const solid *body, solid_state *state, point_lanes at,
                               const node_forces *f) {
  block_vd(*force)[3] = state->force + at.block % body->pattern.window * at.kind->nnode;
  for (int i = 0; i < 3; i++) {
    vd rest = vd_all(0);
    for (int a = 1; a < at.kind->nnode; a++) {
      vd_put(&force[a][i], at.part, f->on[a][i]);
      rest -= f->on[a][i];
    }
    vd_put(&force[0][i], at.part, rest);
  }
}

/* The mesh's number of the first inverted tet of part b; -1 if there is none. */
COROT_INLINE int first_inverted(const solid *body, int b, vi inverted) {
  for (int l = 0; l < LANES; l++)
    if (inverted[l]) return body->elements.number[b * LANES + l];
  return -1;
}

#endif
