/* In frames from above the stress is P = R sigma(sym(R'F) - I) for every measure. Elastic and
   viscous stress are added in the frame, where the moments take the elastic one. */
#include "kernel_handed.h"

/* Where the leader, with the same tets in the same lanes, has what is over a point. */
COROT_INLINE int index_above(const from_leader *lead, point_lanes at) {
  if (lead->npoint == at.kind->npoint) return index_of(at);
  return at.block * PARTS + at.part;
}

/* Of matrices of the leader's tets that over a point. */
COROT_INLINE mat3 above_point(const from_leader *lead, const block_mat3 *of_leader,
                              point_lanes at) {
  if (!lead->above) return mat3_at(of_leader, index_above(lead, at));
  int tet = lead->above[at.block];
  const block_mat3 *A = &of_leader[tet / W];
  mat3 B;
  EACH_IJ B.m[i][j] = vd_all(A->m[i][j][tet % W]);
  return B;
}

/* Adds a vector of each lane's point to that of the leader's tet over it. */
COROT_INLINE void add_up(const from_leader *lead, vec3 a, point_lanes at, block_vec3 *of_leader) {
  if (!lead->above) {
    int k = index_above(lead, at);
    vec3 before = vec3_at(of_leader, k); /* of the tet's other points */
    for (int c = 0; c < 3 && at.q > 0 && lead->npoint == 1; c++) a.v[c] += before.v[c];
    vec3_put(of_leader, k, a);
    return;
  }
  int tet = lead->above[at.block];
  double(*sum)[W] = (double(*)[W])of_leader[tet / W].v;
  for (int c = 0; c < 3; c++)
    for (int k = 0; k < LANES; k++) sum[c][tet % W] += a.v[c][k];
}

/* Coefficients times a tet's volume. */
typedef struct coefficients {
  vd lambda, mu, damping_lambda, damping_mu;
} coefficients;

COROT_INLINE coefficients coefficients_of(const solid *body, point_lanes at) {
  const material *mat = &body->material[material_of(at)];
  vd V = weight_of(at);
  return (coefficients){V * mat->lambda, V * mat->mu, V * mat->damping_lambda, V * mat->damping_mu};
}

/* Cauchy strain is linear in F: there nothing can invert. */
COROT_INLINE vi inverted_in(const solid *body, mat3 F) {
  if (strain_is_linear(&strain_measures[body->strain])) return (vi){0};
  return ~(mat3_det(F, mat3_cofactor(F)) > vd_all(0));
}

COROT_INLINE int handed_force_loop(const element_kind *kind, const solid *body, solid_state *state,
                                   const from_leader *lead, nodal_field u, nodal_field v,
                                   int chunk) {
  for (int b = chunk_start(chunk); b < chunk_end(body, chunk); b++) {
    point_lanes here = point_at(kind, &body->elements, b, 0);
    differences of_u = differences_of(here, u), of_v;
    if (v) of_v = differences_of(here, v);
    node_forces f;
    vi inverted = {0};
    EACH_POINT (kind, q) {
      point_lanes at = point_at(kind, &body->elements, b, q);
      coefficients k = coefficients_of(body, at);
      mat3 F = deformation(at, &of_u);
      mat3 R = above_point(lead, lead->R, at);
      inverted |= inverted_in(body, F);

      /* the elastic stress in the frame, and what it turns the frame by */
      mat3 e = mat3_add_identity(mat3_sym_tmul(R, F), vd_all(-1));
      mat3 sigma = hooke(k.lambda, k.mu, e);
      add_up(lead, mat3_vee(mat3_mul(mat3_tmul(R, F), sigma)), at, lead->moment);
      if (v) {
        mat3 V = gradient(at, &of_v);
        mat3 rate = mat3_sym_tmul(R, V);
        sigma = mat3_add(sigma, hooke(k.damping_lambda, k.damping_mu, rate));
      }
      add_forces(at, mat3_scale(vd_all(-1), mat3_mul(R, sigma)), &f);
    }
    if (vi_any(inverted)) return first_inverted(body, b, inverted);
    store_forces(body, state, here, &f);
  }
  return -1;
}

int corot_kernel_handed_force(const solid *body, solid_state *state, const from_leader *lead,
                              nodal_field u, nodal_field v, int chunk) {
  return OF_KIND(&body->elements, handed_force_loop, body, state, lead, u, v, chunk);
}

void corot_kernel_hand_down(const solid *body, const from_leader *lead, int chunk, block_mat3 *R) {
  const element_kind *kind = body->elements.kind;
  for (int b = chunk_start(chunk); b < chunk_end(body, chunk); b++)
    EACH_POINT (kind, q) {
      point_lanes at = point_at(kind, &body->elements, b, q);
      mat3_put(R, index_of(at), above_point(lead, lead->R, at));
    }
}

/* dR is zero where the frames do not follow. */
COROT_INLINE int handed_derivative_loop(const element_kind *kind, const solid *body,
                                        solid_state *state, const from_leader *lead, nodal_field u,
                                        nodal_field v, nodal_field du, nodal_field dv, int chunk) {
  for (int b = chunk_start(chunk); b < chunk_end(body, chunk); b++) {
    point_lanes here = point_at(kind, &body->elements, b, 0);
    differences of_u = differences_of(here, u), of_du = differences_of(here, du), of_v, of_dv;
    if (v) of_v = differences_of(here, v), of_dv = differences_of(here, dv);
    node_forces f;
    vi inverted = {0};
    EACH_POINT (kind, q) {
      point_lanes at = point_at(kind, &body->elements, b, q);
      coefficients k = coefficients_of(body, at);
      mat3 F = deformation(at, &of_u);
      mat3 R = above_point(lead, lead->R, at), dR = above_point(lead, lead->dR, at);
      mat3 dF = gradient(at, &of_du);
      inverted |= inverted_in(body, F);

      /* changes of strain and stress in the frame, and of the moment */
      mat3 de = mat3_add(mat3_sym_tmul(dR, F), mat3_sym_tmul(R, dF));
      mat3 e = mat3_add_identity(mat3_sym_tmul(R, F), vd_all(-1));
      mat3 sigma = hooke(k.lambda, k.mu, e), dsigma = hooke(k.lambda, k.mu, de);
      mat3 A = mat3_tmul(R, F), dA = mat3_add(mat3_tmul(dR, F), mat3_tmul(R, dF));
      vec3 dmoment = mat3_vee(mat3_add(mat3_mul(dA, sigma), mat3_mul(A, dsigma)));
      add_up(lead, mat3_vee(mat3_mul(A, sigma)), at, lead->moment);
      add_up(lead, dmoment, at, lead->dmoment);
      if (v) {
        mat3 V = gradient(at, &of_v);
        mat3 dV = gradient(at, &of_dv);
        mat3 rate = mat3_sym_tmul(R, V);
        mat3 drate = mat3_add(mat3_sym_tmul(dR, V), mat3_sym_tmul(R, dV));
        sigma = mat3_add(sigma, hooke(k.damping_lambda, k.damping_mu, rate));
        dsigma = mat3_add(dsigma, hooke(k.damping_lambda, k.damping_mu, drate));
      }
      mat3 dP = mat3_add(mat3_mul(dR, sigma), mat3_mul(R, dsigma));
      add_forces(at, mat3_scale(vd_all(-1), dP), &f);
    }
    if (vi_any(inverted)) return first_inverted(body, b, inverted);
    store_forces(body, state, here, &f);
  }
  return -1;
}

int corot_kernel_handed_derivative(const solid *body, solid_state *state, const from_leader *lead,
                                   nodal_field u, nodal_field v, nodal_field du, nodal_field dv,
                                   int chunk) {
  return OF_KIND(&body->elements, handed_derivative_loop, body, state, lead, u, v, du, dv, chunk);
}

/* The frame's rotation for a unit of moment: z = G^-1 moment, the stress -V P = -R [z]x. */
COROT_INLINE int turning_force_loop(const element_kind *kind, const solid *leader,
                                    solid_state *state, const from_leader *lead, nodal_field u,
                                    int chunk) {
  for (int b = chunk_start(chunk); b < chunk_end(leader, chunk); b++) {
    point_lanes here = point_at(kind, &leader->elements, b, 0);
    differences of_u = differences_of(here, u);
    node_forces f;
    EACH_POINT (kind, q) {
      point_lanes at = point_at(kind, &leader->elements, b, q);
      mat3 F = deformation(at, &of_u), R = mat3_at(lead->R, index_of(at));
      vec3 z =
          mat3_apply(polar_inverse_g(mat3_sym_tmul(R, F)), vec3_at(lead->moment, index_of(at)));
      add_forces(at, mat3_scale(vd_all(-1), mat3_mul(R, mat3_skew(z))), &f);
    }
    store_forces(leader, state, here, &f);
  }
  return -1;
}

int corot_kernel_turning_force(const solid *leader, solid_state *state, const from_leader *lead,
                               nodal_field u, int chunk) {
  return OF_KIND(&leader->elements, turning_force_loop, leader, state, lead, u, chunk);
}

/* G dz = dmoment - dG z */
COROT_INLINE int turning_derivative_loop(const element_kind *kind, const solid *leader,
                                         solid_state *state, const from_leader *lead, nodal_field u,
                                         nodal_field du, int chunk) {
  for (int b = chunk_start(chunk); b < chunk_end(leader, chunk); b++) {
    point_lanes here = point_at(kind, &leader->elements, b, 0);
    differences of_u = differences_of(here, u), of_du = differences_of(here, du);
    node_forces f;
    EACH_POINT (kind, q) {
      point_lanes at = point_at(kind, &leader->elements, b, q);
      mat3 F = deformation(at, &of_u), R = mat3_at(lead->R, index_of(at));
      mat3 dF = gradient(at, &of_du), dR = mat3_at(lead->dR, index_of(at));
      mat3 dS = mat3_add(mat3_sym_tmul(dR, F), mat3_sym_tmul(R, dF));
      mat3 Ginv = polar_inverse_g(mat3_sym_tmul(R, F));
      vec3 z = mat3_apply(Ginv, vec3_at(lead->moment, index_of(at)));
      vec3 dz =
          mat3_apply(Ginv, vec3_less(vec3_at(lead->dmoment, index_of(at)), apply_g_change(dS, z)));
      mat3 dP = mat3_add(mat3_mul(dR, mat3_skew(z)), mat3_mul(R, mat3_skew(dz)));
      add_forces(at, mat3_scale(vd_all(-1), dP), &f);
    }
    store_forces(leader, state, here, &f);
  }
  return -1;
}

int corot_kernel_turning_derivative(const solid *leader, solid_state *state,
                                    const from_leader *lead, nodal_field u, nodal_field du,
                                    int chunk) {
  return OF_KIND(&leader->elements, turning_derivative_loop, leader, state, lead, u, du, chunk);
}

COROT_INLINE void frames_change_loop(const element_kind *kind, frame_rule rule, const solid *leader,
                                     const block_mat3 *R, nodal_field u, nodal_field du, int chunk,
                                     block_mat3 *dR) {
  for (int b = chunk_start(chunk); b < chunk_end(leader, chunk); b++) {
    point_lanes here = point_at(kind, &leader->elements, b, 0);
    differences of_u = differences_of(here, u), of_du = differences_of(here, du);
    EACH_POINT (kind, q) {
      point_lanes at = point_at(kind, &leader->elements, b, q);
      mat3 room;
      const mat3 *Q0 = rest_basis_of(rule, at, &room);
      mat3 F = deformation(at, &of_u);
      mat3 dF = gradient(at, &of_du);
      mat3_put(dR, index_of(at), frame_derivative(rule, F, Q0, mat3_at(R, index_of(at)), dF));
    }
  }
}

void corot_kernel_frames_change(const solid *leader, const block_mat3 *R, nodal_field u,
                                nodal_field du, int chunk, block_mat3 *dR) {
  OF_KIND(&leader->elements, frames_change_loop, strain_measures[leader->strain].frame, leader, R,
          u, du, chunk, dR);
}
