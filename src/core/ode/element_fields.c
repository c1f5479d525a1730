/* What a run shows of a state: nodal vectors, and tensors of the tets. */
#include "core/solid/kernel.h"
#include "state.h"

void corot_nodal(const corot_model *m, double t, const double *u, const double *v,
                 double (*displacement)[3], double (*velocity)[3]) {
  const instant now = {.t = t, .side = NAN, .moving = true};
  if (displacement) corot_model_displacement(m, &now, u, displacement[0], 3);
  if (velocity) corot_model_velocity(m, &now, v, velocity[0], 3);
}

/* sqrt(3/2 dev:dev) of sym(A). */
COROT_INLINE vd von_mises_of(mat3 A) {
  vd mean = mat3_trace(A) / 3, square = vd_all(0);
  EACH_IJ {
    vd a = 0.5 * (A.m[i][j] + A.m[j][i]) - (i == j ? mean : vd_all(0));
    square += a * a;
  }
  for (int l = 0; l < W; l++) square[l] = sqrt(1.5 * square[l]);
  return square;
}

COROT_INLINE void store_lane(const corot_element_fields *f, int tet, int l, mat3 R, mat3 e,
                             vd mises, vd det) {
  static const int ij[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}};
  if (f->frame) mat3_store(R, l, f->frame[tet]);
  if (f->strain)
    for (int k = 0; k < 6; k++) f->strain[tet][k] = e.m[ij[k][0]][ij[k][1]][l];
  if (f->von_mises) f->von_mises[tet] = mises[l];
  if (f->det) f->det[tet] = det[l];
}

/* At the first point of each element. Unlike the loops in kernel.h it goes on after an inversion:
 * the other tets are still worth seeing. */
static COROT_CLONES int elements_loop(const solid *body, const solid_state *s, nodal_field u,
                                      const corot_element_fields *fields) {
  const strain_measure *measure = &strain_measures[body->strain];
  bool linear = strain_is_linear(measure);
  int first = -1;
  for (int b = 0; b < body->elements.nblock; b++) {
    point_lanes at = point_of(body, b, 0);
    const material *mat = &body->material[material_of(at)];
    vi inverted = {0};
    mat3 F = deformation(at, u);
    mat3 R = frame_in_use(measure, &s->frames, at, F, &inverted);
    vd lambda = vd_all(mat->lambda), mu = vd_all(mat->mu);
    mat3 P = body->dilatation.npool
                 ? stress_at_pressure(measure, lambda * s->dilatation[index_of(at)], mu, F, R)
                 : stress(measure, lambda, mu, F, R);
    /* from P to the stress on the deformed body */
    vd det = mat3_det(F, mat3_cofactor(F));
    mat3 cauchy = linear ? P : mat3_scale(1.0 / det, mat3_mul(P, mat3_transpose(F)));
    vd mises = von_mises_of(cauchy);
    mat3 e = strain_of(measure->shear, F, R);
    for (int l = 0; l < body->elements.block[b].n; l++)
      store_lane(fields, body->elements.number[b * W + l], l, R, e, mises, det);
    if (first < 0) first = first_inverted(body, b, inverted);
  }
  return first;
}

corot_status corot_elements(const corot_model *m, corot_state *s, double t, const double *u,
                            const corot_element_fields *fields) {
  const instant now = corot_state_at(s, t);
  const solid *body = solid_of(m);
  solid_state *of = &s->system.of[0];
  nodal_field all_u = corot_state_displace(m, s, &now, u);
  corot_status above = corot_system_settle(&m->system, &s->system, age_of(s, t), all_u);
  if (above && above != COROT_RETRY) return above;
  corot_kernel_dilatation(body, of, all_u);
  corot_status status = corot_solid_check(of, elements_loop(body, of, all_u, fields));
  return status ? corot_system_told(&m->system, &s->system, 0, status) : above;
}
