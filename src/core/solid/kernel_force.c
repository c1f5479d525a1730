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

COROT_INLINE int force_loop(const element_kind *kind, const strain_measure *s, const solid *body,
                            solid_state *state, nodal_field u, nodal_field v, bool averaged,
                            int chunk) {
  for (int b = chunk_start(chunk); b < chunk_end(body, chunk); b++) {
    point_lanes here = point_at(kind, &body->elements, b, 0);
    differences of_u = differences_of(here, u), of_v;
    if (v) of_v = differences_of(here, v);
    node_forces f;
    vi inverted = {0};
    EACH_POINT (kind, q) {
      element e = element_at(s, body, &state->frames, &of_u, point_at(kind, &body->elements, b, q));
      vd minus = -weight_of(e.at);
      vd lambda = minus * e.mat->lambda, mu = minus * e.mat->mu;
      mat3 A = averaged ? stress_at_pressure(s, lambda * vd_at(state->dilatation, index_of(e.at)),
                                             mu, e.F, e.R)
                        : stress(s, lambda, mu, e.F, e.R);
      if (v) {
        mat3 V = gradient(e.at, &of_v);
        A = mat3_add(A, viscous_stress(s, body->objective, e.mat, minus, e.F, e.R, V));
      }
      add_forces(e.at, A, &f);
      inverted |= e.inverted;
    }
    if (vi_any(inverted)) return first_inverted(body, b, inverted);
    store_forces(body, state, here, &f);
  }
  return -1;
}

/* The hot loop is compiled for each measure, so that its branches on the measure fall away; with
   averages, which take their own time, once for all. */
int corot_kernel_force(const solid *body, solid_state *state, nodal_field u, nodal_field v,
                       int chunk) {
  if (body->dilatation.npool)
    return OF_KIND(&body->elements, force_loop, &strain_measures[body->strain], body, state, u, v,
                   true, chunk);
#define FORCE_OF(index, ...)                                                                       \
  case index:                                                                                      \
    return OF_KIND(&body->elements, force_loop, &strain_measures[index], body, state, u, v, false, \
                   chunk);
  switch (body->strain) { STRAIN_MEASURES(FORCE_OF) }
#undef FORCE_OF
  abort(); /* no model has another */
}

COROT_INLINE int energy_loop(const element_kind *kind, const strain_measure *s, const solid *body,
                             const solid_state *state, nodal_field u, nodal_field v, int chunk,
                             double *elastic, double *power) {
  double sum_elastic = 0, sum_power = 0;
  for (int b = chunk_start(chunk); b < chunk_end(body, chunk); b++) {
    point_lanes here = point_at(kind, &body->elements, b, 0);
    differences of_u = differences_of(here, u), of_v;
    if (v) of_v = differences_of(here, v);
    vi inverted = {0};
    EACH_POINT (kind, q) {
      element e = element_at(s, body, &state->frames, &of_u, point_at(kind, &body->elements, b, q));
      inverted |= e.inverted;
      if (q == kind->npoint - 1 && vi_any(inverted)) return first_inverted(body, b, inverted);
      vd lambda = vd_all(e.mat->lambda), mu = vd_all(e.mat->mu);
      const vd *average =
          body->dilatation.npool ? (const vd *)state->dilatation + index_of(e.at) : NULL;
      sum_elastic += vd_sum(weight_of(e.at) * strain_energy(s, lambda, mu, e.F, e.R, average));
      if (!v) continue;
      mat3 V = gradient(e.at, &of_v);
      mat3 P = viscous_stress(s, body->objective, e.mat, vd_all(1), e.F, e.R, V);
      sum_power += vd_sum(weight_of(e.at) * mat3_dot(P, V));
    }
  }
  *elastic = sum_elastic;
  *power = sum_power;
  return -1;
}

int corot_kernel_energy(const solid *body, const solid_state *state, nodal_field u, nodal_field v,
                        int chunk, double *elastic, double *power) {
  return OF_KIND(&body->elements, energy_loop, &strain_measures[body->strain], body, state, u, v,
                 chunk, elastic, power);
}

COROT_INLINE int frames_loop(const element_kind *kind, const strain_measure *s, const solid *body,
                             nodal_field u, int chunk, block_mat3 *R) {
  for (int b = chunk_start(chunk); b < chunk_end(body, chunk); b++) {
    differences of_u = differences_of(point_at(kind, &body->elements, b, 0), u);
    vi inverted = {0};
    EACH_POINT (kind, q) {
      point_lanes at = point_at(kind, &body->elements, b, q);
      mat3 F = deformation(at, &of_u);
      mat3 room;
      const mat3 *Q0 = rest_basis_of(s->frame, at, &room);
      vi bad;
      mat3_put(R, index_of(at), frame_of(s->frame, F, Q0, &bad));
      inverted |= bad;
    }
    if (s->frame != FRAME_IDENTITY && vi_any(inverted)) return first_inverted(body, b, inverted);
  }
  return -1;
}

int corot_kernel_frames(const solid *body, nodal_field u, int chunk, block_mat3 *R) {
  return OF_KIND(&body->elements, frames_loop, &strain_measures[body->strain], body, u, chunk, R);
}

COROT_INLINE int spin_loop(const element_kind *kind, const strain_measure *s, const solid *body,
                           nodal_field u, nodal_field v, int chunk, block_vec3 *spin) {
  for (int b = chunk_start(chunk); b < chunk_end(body, chunk); b++) {
    point_lanes here = point_at(kind, &body->elements, b, 0);
    differences of_u = differences_of(here, u), of_v = differences_of(here, v);
    vi inverted = {0};
    EACH_POINT (kind, q) {
      point_lanes at = point_at(kind, &body->elements, b, q);
      mat3 room;
      const mat3 *Q0 = rest_basis_of(s->frame, at, &room);
      mat3 F = deformation(at, &of_u);
      mat3 V = gradient(at, &of_v);
      vi bad;
      mat3 R = frame_of(s->frame, F, Q0, &bad);
      inverted |= bad;
      mat3 dR = frame_derivative(s->frame, F, Q0, R, V);
      vec3_put(spin, index_of(at),
               mat3_vee(mat3_scale(vd_all(0.5), mat3_mul(dR, mat3_transpose(R)))));
    }
    if (s->frame != FRAME_IDENTITY && vi_any(inverted)) return first_inverted(body, b, inverted);
  }
  return -1;
}

int corot_kernel_spin(const solid *body, nodal_field u, nodal_field v, int chunk,
                      block_vec3 *spin) {
  return OF_KIND(&body->elements, spin_loop, &strain_measures[body->strain], body, u, v, chunk,
                 spin);
}

/* The rest basis of part b, where the model keeps none. */
COROT_INLINE mat3 rest_basis_anew(const solid *body, int b) {
  block_mat3 whole = corot_tets_rest_basis(body->mesh, body->elements.number + b / PARTS * W);
  return mat3_at(&whole, b % PARTS);
}

COROT_INLINE int internal_loop(const element_kind *kind, const strain_measure *s, const solid *body,
                               solid_state *state, nodal_field u, double lambda_part,
                               double mu_part, int chunk) {
  for (int b = chunk_start(chunk); b < chunk_end(body, chunk); b++) {
    point_lanes here = point_at(kind, &body->elements, b, 0);
    differences of_u = differences_of(here, u);
    node_forces f;
    mat3 Q0 = mat3_identity();
    if (s->frame == FRAME_WARP) Q0 = rest_basis_anew(body, b);
    vi inverted = {0};
    EACH_POINT (kind, q) {
      point_lanes at = point_at(kind, &body->elements, b, q);
      const material *mat = &body->material[material_of(at)];
      mat3 F = deformation(at, &of_u);
      vi bad;
      mat3 R = frame_of(s->frame, F, &Q0, &bad);
      inverted |= bad;
      vd lambda = -weight_of(at) * (lambda_part * mat->lambda),
         mu = -weight_of(at) * (mu_part * mat->mu);
      mat3 A =
          body->dilatation.npool
              ? stress_at_pressure(s, lambda * vd_at(state->dilatation, index_of(at)), mu, F, R)
              : stress(s, lambda, mu, F, R);
      add_forces(at, A, &f);
    }
    if (!strain_is_linear(s) && vi_any(inverted)) return first_inverted(body, b, inverted);
    store_forces(body, state, here, &f);
  }
  return -1;
}

int corot_kernel_internal(const solid *body, solid_state *state, nodal_field u, int strain,
                          double lambda_part, double mu_part, int chunk) {
  return OF_KIND(&body->elements, internal_loop, &strain_measures[strain], body, state, u,
                 lambda_part, mu_part, chunk);
}
