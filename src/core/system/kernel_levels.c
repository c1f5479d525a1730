/* Loops of a hierarchical model: the finest tets in frames from above, where the stress is
   P = R sigma(sym(R'F) - I) for every measure, and what the turning of these frames adds. */
#include "core/solid/kernel.h"
#include "levels.h"

/* Of matrices of the framer's tets, that over part b. */
COROT_INLINE mat3 above_block(const levels *l, const block_mat3 *of_framer, int b) {
  if (!l->above) return mat3_at(of_framer, b);
  int above = l->above[b / PARTS];
  const block_mat3 *A = &of_framer[above / W];
  mat3 B;
  EACH_IJ B.m[i][j] = vd_all(A->m[i][j][above % W]);
  return B;
}

/* Adds a vector of each tet of part b to that of the framer's tet over it. */
COROT_INLINE void add_up(const levels *l, vec3 a, int b, block_vec3 *of_framer) {
  if (!l->above) {
    vec3_put(of_framer, b, a);
    return;
  }
  double(*sum)[W] = (double(*)[W])of_framer[l->above[b / PARTS] / W].v;
  for (int c = 0; c < 3; c++)
    for (int k = 0; k < LANES; k++) sum[c][l->above[b / PARTS] % W] += a.v[c][k];
}

/* lambda tr(e) I + 2 mu e */
COROT_INLINE mat3 linear_stress(vd lambda, vd mu, mat3 e) {
  return mat3_add_identity(mat3_scale(2 * mu, e), lambda * mat3_trace(e));
}

/* Coefficients times a tet's volume. */
typedef struct coefficients {
  vd lambda, mu, damping_lambda, damping_mu;
} coefficients;

COROT_INLINE coefficients coefficients_of(const corot_model *m, tet_lanes block) {
  const material *mat = &m->material[block.in->material];
  vd V = volume_of(block);
  return (coefficients){V * mat->lambda, V * mat->mu, V * mat->damping_lambda, V * mat->damping_mu};
}

/* Cauchy strain is linear in F: there nothing can invert. */
COROT_INLINE vi inverted_in(const corot_model *m, mat3 F) {
  if (strain_is_linear(&strain_measures[m->strain])) return (vi){0};
  return ~(mat3_det(F, mat3_cofactor(F)) > vd_all(0));
}

COROT_INLINE int handed_force_loop(const corot_model *m, corot_state *state, bool damped,
                                   int chunk) {
  const levels *l = m->levels;
  corot_state *framer = state->levels->framer;
  for (int b = chunk_start(chunk); b < chunk_end(m, chunk); b++) {
    tet_lanes block = tets_at(&m->tets, b);
    coefficients k = coefficients_of(m, block);
    mat3 F = deformation(block, (const double(*)[4])state->u);
    mat3 R = above_block(l, framer->now_R, b);
    vi inverted = inverted_in(m, F);
    if (vi_any(inverted)) return first_inverted(m, b, inverted);

    mat3 e = mat3_add_identity(mat3_sym_tmul(R, F), vd_all(-1));
    mat3 sigma = linear_stress(k.lambda, k.mu, e);
    add_up(l, mat3_vee(mat3_mul(mat3_tmul(R, F), sigma)), b, framer->moment);
    if (damped) {
      mat3 V = gradient(block, (const double(*)[4])state->v);
      mat3 rate = mat3_sym_tmul(R, V);
      sigma = mat3_add(sigma, linear_stress(k.damping_lambda, k.damping_mu, rate));
    }
    store_forces(m, state, b, mat3_scale(vd_all(-1), mat3_mul(R, sigma)));
  }
  return -1;
}

int corot_kernel_handed_force(const corot_model *m, corot_state *state, bool damped, int chunk) {
  return handed_force_loop(m, state, damped, chunk);
}

void corot_kernel_hand_down(const corot_model *m, corot_state *state) {
  for (int b = 0; b < m->tets.nblock * PARTS; b++)
    mat3_put(state->R, b, above_block(m->levels, state->levels->framer->now_R, b));
}

/* dR is zero where the frames do not follow. */
COROT_INLINE int handed_derivative_loop(const corot_model *m, corot_state *state, bool damped,
                                        int chunk) {
  const levels *l = m->levels;
  corot_state *framer = state->levels->framer;
  for (int b = chunk_start(chunk); b < chunk_end(m, chunk); b++) {
    tet_lanes block = tets_at(&m->tets, b);
    coefficients k = coefficients_of(m, block);
    mat3 F = deformation(block, (const double(*)[4])state->u);
    mat3 R = above_block(l, framer->now_R, b), dR = above_block(l, framer->dR, b);
    mat3 dF = gradient(block, (const double(*)[4])state->du);
    vi inverted = inverted_in(m, F);
    if (vi_any(inverted)) return first_inverted(m, b, inverted);

    mat3 de = mat3_add(mat3_sym_tmul(dR, F), mat3_sym_tmul(R, dF));
    mat3 e = mat3_add_identity(mat3_sym_tmul(R, F), vd_all(-1));
    mat3 sigma = linear_stress(k.lambda, k.mu, e), dsigma = linear_stress(k.lambda, k.mu, de);
    mat3 A = mat3_tmul(R, F), dA = mat3_add(mat3_tmul(dR, F), mat3_tmul(R, dF));
    vec3 dmoment = mat3_vee(mat3_add(mat3_mul(dA, sigma), mat3_mul(A, dsigma)));
    add_up(l, mat3_vee(mat3_mul(A, sigma)), b, framer->moment);
    add_up(l, dmoment, b, framer->dmoment);
    if (damped) {
      mat3 V = gradient(block, (const double(*)[4])state->v);
      mat3 dV = gradient(block, (const double(*)[4])state->dv);
      mat3 rate = mat3_sym_tmul(R, V);
      mat3 drate = mat3_add(mat3_sym_tmul(dR, V), mat3_sym_tmul(R, dV));
      sigma = mat3_add(sigma, linear_stress(k.damping_lambda, k.damping_mu, rate));
      dsigma = mat3_add(dsigma, linear_stress(k.damping_lambda, k.damping_mu, drate));
    }
    mat3 dP = mat3_add(mat3_mul(dR, sigma), mat3_mul(R, dsigma));
    store_forces(m, state, b, mat3_scale(vd_all(-1), dP));
  }
  return -1;
}

int corot_kernel_handed_derivative(const corot_model *m, corot_state *state, bool damped,
                                   int chunk) {
  return handed_derivative_loop(m, state, damped, chunk);
}

/* The frame's rotation for a unit of moment: z = G^-1 moment, the stress -V P = -R [z]x. */
COROT_INLINE int turning_force_loop(const corot_model *m, corot_state *state, int chunk) {
  for (int b = chunk_start(chunk); b < chunk_end(m, chunk); b++) {
    mat3 F = deformation(tets_at(&m->tets, b), (const double(*)[4])state->u),
         R = mat3_at(state->now_R, b);
    vec3 z = mat3_apply(polar_inverse_g(mat3_sym_tmul(R, F)), vec3_at(state->moment, b));
    store_forces(m, state, b, mat3_scale(vd_all(-1), mat3_mul(R, mat3_skew(z))));
  }
  return -1;
}

int corot_kernel_turning_force(const corot_model *m, corot_state *state, bool unused, int chunk) {
  (void)unused;
  return turning_force_loop(m, state, chunk);
}

/* G dz = dmoment - dG z */
COROT_INLINE int turning_derivative_loop(const corot_model *m, corot_state *state, int chunk) {
  for (int b = chunk_start(chunk); b < chunk_end(m, chunk); b++) {
    tet_lanes block = tets_at(&m->tets, b);
    mat3 F = deformation(block, (const double(*)[4])state->u), R = mat3_at(state->now_R, b);
    mat3 dF = gradient(block, (const double(*)[4])state->du), dR = mat3_at(state->dR, b);
    mat3 dS = mat3_add(mat3_sym_tmul(dR, F), mat3_sym_tmul(R, dF));
    mat3 Ginv = polar_inverse_g(mat3_sym_tmul(R, F));
    vec3 z = mat3_apply(Ginv, vec3_at(state->moment, b));
    vec3 dz = mat3_apply(Ginv, vec3_less(vec3_at(state->dmoment, b), apply_g_change(dS, z)));
    mat3 dP = mat3_add(mat3_mul(dR, mat3_skew(z)), mat3_mul(R, mat3_skew(dz)));
    store_forces(m, state, b, mat3_scale(vd_all(-1), dP));
  }
  return -1;
}

int corot_kernel_turning_derivative(const corot_model *m, corot_state *state, bool unused,
                                    int chunk) {
  (void)unused;
  return turning_derivative_loop(m, state, chunk);
}

COROT_INLINE void frames_change_loop(frame_rule rule, const corot_model *m, corot_state *state) {
  for (int b = 0; b < m->tets.nblock * PARTS; b++) {
    tet_lanes block = tets_at(&m->tets, b);
    mat3 room;
    const mat3 *Q0 = rest_basis_of(rule, m, b, &room);
    mat3 F = deformation(block, (const double(*)[4])state->u);
    mat3 dF = gradient(block, (const double(*)[4])state->du);
    mat3_put(state->dR, b, frame_derivative(rule, F, Q0, mat3_at(state->now_R, b), dF));
  }
}

void corot_kernel_frames_change(const corot_model *m, corot_state *state) {
  frames_change_loop(strain_measures[m->strain].frame, m, state);
}
