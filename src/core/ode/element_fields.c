/* What a run shows of a state: nodal vectors, and tensors of the tets. */
#include "core/solid/kernel.h"
#include "shown.h"
#include "state.h"

void corot_nodal(const corot_model *m, double t, const double *u, const double *v,
                 double (*displacement)[3], double (*velocity)[3]) {
  const instant now = {.t = t, .side = NAN, .moving = true};
  if (displacement) corot_model_displacement(m, &now, u, displacement[0], 3);
  if (velocity) corot_model_velocity(m, &now, v, velocity[0], 3);
}

/* Means over the points, weighted by their volumes; the frame is the rotation nearest to that of
   the frames. */
COROT_INLINE shown mean_of(const element_kind *kind, const shown *point, const vd *weight) {
  shown all = point[0];
  vd before = weight[0], volume;
  for (int q = 1; q < kind->npoint; q++, before = volume) {
    volume = before + weight[q];
    vd part = weight[q] / volume, rest = 1 - part;
    all.R = mat3_sum(rest, all.R, part, point[q].R);
    all.e = mat3_sum(rest, all.e, part, point[q].e);
    all.stress = mat3_sum(rest, all.stress, part, point[q].stress);
    all.mises = rest * all.mises + part * point[q].mises;
    all.det = rest * all.det + part * point[q].det;
    all.energy = rest * all.energy + part * point[q].energy;
  }
  vi bad;
  if (kind->npoint > 1) all.R = polar(all.R, &bad);
  return all;
}

COROT_INLINE void store_mean(const corot_element_fields *f, int tet, int l, const shown *s,
                             const eigen3 *principal, double volume) {
  if (f->frame) mat3_store(s->R, l, f->frame[tet]);
  if (f->strain) store_symmetric(s->e, l, f->strain[tet]);
  if (f->stress) store_symmetric(s->stress, l, f->stress[tet]);
  if (f->principal) store_eigenvalues(principal, l, f->principal[tet]);
  if (f->von_mises) f->von_mises[tet] = s->mises[l];
  if (f->det) f->det[tet] = s->det[l];
  if (f->energy) f->energy[tet] = volume * s->energy[l];
  if (f->volume) f->volume[tet] = volume;
}

/* The point next to a corner of the mesh: points are numbered as the corners in ascending order. */
COROT_INLINE int point_next_to(const element_kind *kind, const int tet[4], int corner) {
  int rank = 0;
  for (int k = 0; k < 4; k++) rank += tet[k] < tet[corner];
  return kind->npoint == 1 ? 0 : rank;
}

COROT_INLINE void store_point(const corot_element_fields *f, int tet, int corner, int l,
                              const shown *s, const eigen3 *principal) {
  if (f->frame_at) mat3_store(s->R, l, f->frame_at[tet][corner]);
  if (f->strain_at) store_symmetric(s->e, l, f->strain_at[tet][corner]);
  if (f->stress_at) store_symmetric(s->stress, l, f->stress_at[tet][corner]);
  if (f->principal_at) store_eigenvalues(principal, l, f->principal_at[tet][corner]);
  if (f->von_mises_at) f->von_mises_at[tet][corner] = s->mises[l];
  if (f->det_at) f->det_at[tet][corner] = s->det[l];
}

COROT_INLINE shown show_point(const solid *body, const solid_state *s, point_lanes at,
                              const differences *of_u, vi *inverted) {
  const strain_measure *measure = &strain_measures[body->strain];
  const material *mat = &body->material[material_of(at)];
  mat3 F = deformation(at, of_u);
  mat3 R = frame_in_use(measure, &s->frames, at, F, inverted);
  const vd *average = body->dilatation.npool ? &s->dilatation[index_of(at)] : NULL;
  return show(measure, vd_all(mat->lambda), vd_all(mat->mu), average, F, R);
}

/* Unlike the loops in kernel.h it goes on after an inversion: the other tets are still worth
   seeing. */
COROT_INLINE int elements_loop(const element_kind *kind, const solid *body, const solid_state *s,
                               nodal_field u, const corot_element_fields *fields) {
  int first = -1;
  for (int b = 0; b < body->elements.nblock; b++) {
    differences of_u = differences_of(point_at(kind, &body->elements, b, 0), u);
    vi inverted = {0};
    shown point[KIND_POINTS];
    vd weight[KIND_POINTS];
    eigen3 principal[KIND_POINTS], of_mean = {0};
    EACH_POINT (kind, q) {
      point_lanes at = point_at(kind, &body->elements, b, q);
      point[q] = show_point(body, s, at, &of_u, &inverted);
      weight[q] = weight_of(at);
      if (fields->principal_at) principal[q] = eigen_of(point[q].stress);
    }
    shown mean = mean_of(kind, point, weight);
    if (fields->principal) of_mean = eigen_of(mean.stress);
    for (int l = 0; l < body->elements.block[b].n; l++) {
      int tet = body->elements.number[b * W + l];
      store_mean(fields, tet, l, &mean, &of_mean, volume_at(&body->elements, b, l));
      for (int k = 0; k < 4; k++) {
        int q = point_next_to(kind, body->mesh->tet[tet], k);
        store_point(fields, tet, k, l, &point[q], &principal[q]);
      }
    }
    if (first < 0) first = first_inverted(body, b, inverted);
  }
  return first;
}

static COROT_CLONES int show_elements(const solid *body, const solid_state *s, nodal_field u,
                                      const corot_element_fields *fields) {
  return OF_KIND(&body->elements, elements_loop, body, s, u, fields);
}

corot_status corot_show_begin(const corot_model *m, corot_state *s, double t, const double *u,
                              nodal_field *all_u) {
  const instant now = corot_state_at(s, t);
  *all_u = corot_state_displace(m, s, &now, u);
  corot_status above = corot_system_settle(system_of(m, s), &s->system, age_of(s, t), *all_u);
  if (above && above != COROT_RETRY) return above;
  corot_solid_average(body_of(m, s), &s->system.of[0], *all_u);
  return above;
}

corot_status corot_show_end(const corot_model *m, corot_state *s, int first, corot_status above) {
  corot_status status = corot_solid_check(&s->system.of[0], first);
  return status ? corot_system_told(system_of(m, s), &s->system, 0, status) : above;
}

corot_status corot_elements(const corot_model *m, corot_state *s, double t, const double *u,
                            const corot_element_fields *fields) {
  COROT_TRY(corot_state_check(m, s, "corot_elements"));
  COROT_TRY(COROT_GIVEN(u));
  COROT_TRY(COROT_GIVEN(fields));
  nodal_field all_u;
  corot_status above = corot_show_begin(m, s, t, u, &all_u);
  if (above && above != COROT_RETRY) return above;
  return corot_show_end(m, s, show_elements(body_of(m, s), &s->system.of[0], all_u, fields), above);
}
