/* Stress, energy and frames of the tets, LANES at a time. */
#include <stdlib.h>

#include "kernel.h"

/* The viscous stress times a factor. */
COROT_INLINE mat3 viscous_stress(const strain_measure *s, bool objective, const material *mat,
                                 vd factor, mat3 F, mat3 R, mat3 V) {
  vd lambda = factor * mat->damping_lambda, mu = factor * mat->damping_mu;
  if (s->frame == FRAME_POLAR && objective) return stress_objective(s, lambda, mu, F, R, V);
  return stress_viscous(s, lambda, mu, F, R, V);
}

COROT_INLINE int force_loop(const strain_measure *s, const corot_model *m, corot_state *state,
                            bool damped, bool averaged, int chunk) {
  for (int b = chunk_start(chunk); b < chunk_end(m, chunk); b++) {
    element e = element_at(s, m, state, b);
    vd minus = -volume_of(e.block);
    vd lambda = minus * e.mat->lambda, mu = minus * e.mat->mu;
    mat3 A = averaged ? stress_at_pressure(s, lambda * vd_at(state->dilatation, b), mu, e.F, e.R)
                      : stress(s, lambda, mu, e.F, e.R);
    if (damped) {
      mat3 V = gradient(e.block, (const double(*)[4])state->v);
      A = mat3_add(A, viscous_stress(s, m->objective, e.mat, minus, e.F, e.R, V));
    }
    store_forces(m, state, b, A);
    if (vi_any(e.inverted)) return first_inverted(m, b, e.inverted);
  }
  return -1;
}

/* The hot loop is compiled for each measure, so that its branches on the measure fall away; with
   averages, which take their own time, once for all. */
int corot_kernel_force(const corot_model *m, corot_state *state, bool damped, int chunk) {
  if (m->dilatation.npool)
    return force_loop(&strain_measures[m->strain], m, state, damped, true, chunk);
#define FORCE_OF(index, ...) \
  case index:                \
    return force_loop(&strain_measures[index], m, state, damped, false, chunk);
  switch (m->strain) { STRAIN_MEASURES(FORCE_OF) }
#undef FORCE_OF
  abort(); /* no model has another */
}

COROT_INLINE int energy_loop(const strain_measure *s, const corot_model *m, corot_state *state,
                             bool damped, double *elastic, double *power) {
  double sum_elastic = 0, sum_power = 0;
  for (int b = 0; b < m->tets.nblock * PARTS; b++) {
    element e = element_at(s, m, state, b);
    if (vi_any(e.inverted)) return first_inverted(m, b, e.inverted);
    vd lambda = vd_all(e.mat->lambda), mu = vd_all(e.mat->mu);
    const vd *average = m->dilatation.npool ? (const vd *)state->dilatation + b : NULL;
    sum_elastic += vd_sum(volume_of(e.block) * strain_energy(s, lambda, mu, e.F, e.R, average));
    if (!damped) continue;
    mat3 V = gradient(e.block, (const double(*)[4])state->v);
    mat3 P = viscous_stress(s, m->objective, e.mat, vd_all(1), e.F, e.R, V);
    sum_power += vd_sum(volume_of(e.block) * mat3_dot(P, V));
  }
  *elastic = sum_elastic;
  *power = sum_power;
  return -1;
}

int corot_kernel_energy(const corot_model *m, corot_state *state, bool damped, double *elastic,
                        double *power) {
  return energy_loop(&strain_measures[m->strain], m, state, damped, elastic, power);
}

COROT_INLINE int frames_loop(const strain_measure *s, const corot_model *m, corot_state *state,
                             block_mat3 *R) {
  for (int b = 0; b < m->tets.nblock * PARTS; b++) {
    vi inverted = {0};
    mat3 F = deformation(tets_at(&m->tets, b), (const double(*)[4])state->u);
    mat3 room;
    const mat3 *Q0 = rest_basis_of(s->frame, m, b, &room);
    mat3_put(R, b, frame_of(s->frame, F, Q0, &inverted));
    if (s->frame != FRAME_IDENTITY && vi_any(inverted)) return first_inverted(m, b, inverted);
  }
  return -1;
}

int corot_kernel_frames(const corot_model *m, corot_state *state, block_mat3 *R) {
  return frames_loop(&strain_measures[m->strain], m, state, R);
}

COROT_INLINE int spin_loop(const strain_measure *s, const corot_model *m, corot_state *state,
                           block_vec3 *spin) {
  for (int b = 0; b < m->tets.nblock * PARTS; b++) {
    tet_lanes block = tets_at(&m->tets, b);
    mat3 room;
    const mat3 *Q0 = rest_basis_of(s->frame, m, b, &room);
    vi inverted = {0};
    mat3 F = deformation(block, (const double(*)[4])state->u);
    mat3 V = gradient(block, (const double(*)[4])state->v);
    mat3 R = frame_of(s->frame, F, Q0, &inverted);
    if (s->frame != FRAME_IDENTITY && vi_any(inverted)) return first_inverted(m, b, inverted);
    mat3 dR = frame_derivative(s->frame, F, Q0, R, V);
    vec3_put(spin, b, mat3_vee(mat3_scale(vd_all(0.5), mat3_mul(dR, mat3_transpose(R)))));
  }
  return -1;
}

int corot_kernel_spin(const corot_model *m, corot_state *state, block_vec3 *spin) {
  return spin_loop(&strain_measures[m->strain], m, state, spin);
}

/* The rest basis of part b, where the model keeps none. */
COROT_INLINE mat3 rest_basis_anew(const corot_model *m, int b) {
  block_mat3 whole = corot_tets_rest_basis(m->mesh, m->tets.number + b / PARTS * W);
  return mat3_at(&whole, b % PARTS);
}

COROT_INLINE int internal_loop(const strain_measure *s, const corot_model *m, corot_state *state,
                               double lambda_part, double mu_part, int chunk) {
  for (int b = chunk_start(chunk); b < chunk_end(m, chunk); b++) {
    tet_lanes block = tets_at(&m->tets, b);
    const material *mat = &m->material[block.in->material];
    mat3 Q0 = mat3_identity();
    if (s->frame == FRAME_WARP) Q0 = rest_basis_anew(m, b);
    vi inverted = {0};
    mat3 F = deformation(block, (const double(*)[4])state->u);
    mat3 R = frame_of(s->frame, F, &Q0, &inverted);
    if (!strain_is_linear(s) && vi_any(inverted)) return first_inverted(m, b, inverted);
    vd lambda = -volume_of(block) * (lambda_part * mat->lambda),
       mu = -volume_of(block) * (mu_part * mat->mu);
    mat3 A = m->dilatation.npool
                 ? stress_at_pressure(s, lambda * vd_at(state->dilatation, b), mu, F, R)
                 : stress(s, lambda, mu, F, R);
    store_forces(m, state, b, A);
  }
  return -1;
}

int corot_kernel_internal(const corot_model *m, corot_state *state, int strain, double lambda_part,
                          double mu_part, int chunk) {
  return internal_loop(&strain_measures[strain], m, state, lambda_part, mu_part, chunk);
}
