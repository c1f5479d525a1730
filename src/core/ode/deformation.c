/* How far a state is from small strains and turns: what the laws of small strains are judged by. */
#include "core/solid/kernel.h"
#include "state.h"

/* The principal stretches of the lanes that are strained beyond the limit. */
COROT_INLINE void note_stretches(point_lanes at, mat3 C, vi within, double limit,
                                 corot_deformation *d) {
  eigen3 e = eigen_of(C);
  for (int l = 0; l < at.set->block[at.block].n; l++) {
    if (!within[l]) continue;
    double least = INFINITY, most = 0;
    for (int i = 0; i < 3; i++) {
      double stretch = sqrt(fmax(e.value[i][l], 0));
      least = fmin(least, stretch), most = fmax(most, stretch);
    }
    if (!(least < 1 - limit || most > 1 + limit)) continue;
    d->strained += weight_of(at)[l];
    d->stretch_min = fmin(d->stretch_min, least);
    d->stretch_max = fmax(d->stretch_max, most);
  }
}

/* The turns of the lanes beyond the limit: cos(angle) = (tr R - 1) / 2. */
COROT_INLINE void note_turns(point_lanes at, mat3 F, vi upright, double limit,
                             corot_deformation *d) {
  vi bad;
  vd trace = mat3_trace(polar(F, &bad));
  for (int l = 0; l < at.set->block[at.block].n; l++) {
    double angle = acos(fmax(-1, fmin(1, 0.5 * (trace[l] - 1))));
    if (!upright[l] || bad[l] || !(angle > limit)) continue;
    d->turned += weight_of(at)[l];
    d->turn_max = fmax(d->turn_max, angle);
  }
}

/* `inverted`: at some point so far. */
COROT_INLINE void note_determinants(point_lanes at, vd det, vi *inverted, corot_deformation *d) {
  *inverted |= ~(det > vd_all(0));
  for (int l = 0; l < at.set->block[at.block].n; l++) {
    if (!(det[l] >= d->det_min)) d->det_min = det[l], d->det_tet = at.set->number[at.block * W + l];
  }
}

/* A stretch is off one by more than the limit only where |E| exceeds its value at 1 - limit, the
   smallest of those, so most tets need no eigenvalues. A turn by `angle` alone takes F from the
   identity by |F - I| = 2 sqrt(2) sin(angle/2), which is far enough above the angle that the small
   strains, to which turns are of interest, do not hide one. */
COROT_INLINE void deformation_loop(const element_kind *kind, const solid *body, nodal_field u,
                                   double strain_limit, double turn_limit, corot_deformation *d) {
  double least = strain_limit - 0.5 * strain_limit * strain_limit;
  for (int b = 0; b < body->elements.nblock; b++) {
    differences of_u = differences_of(point_at(kind, &body->elements, b, 0), u);
    vi inverted = {0};
    EACH_POINT (kind, q) {
      point_lanes at = point_at(kind, &body->elements, b, q);
      mat3 F = deformation(at, &of_u), C = mat3_gram(F);
      vd det = mat3_det(F, mat3_cofactor(F));
      mat3 twice_e = mat3_add_identity(C, vd_all(-1)), H = mat3_add_identity(F, vd_all(-1));
      vi upright = det > vd_all(0);
      vi strained = upright & (mat3_dot(twice_e, twice_e) > vd_all(4 * least * least));
      vi turned = upright & (mat3_dot(H, H) > vd_all(turn_limit * turn_limit));
      note_determinants(at, det, &inverted, d);
      if (vi_any(strained)) note_stretches(at, C, strained, strain_limit, d);
      if (vi_any(turned)) note_turns(at, F, turned, turn_limit, d);
    }
    for (int l = 0; l < body->elements.block[b].n; l++) d->ninverted += inverted[l] != 0;
  }
}

static COROT_CLONES void measure_deformation(const solid *body, nodal_field u, double strain_limit,
                                             double turn_limit, corot_deformation *d) {
  OF_KIND(&body->elements, deformation_loop, body, u, strain_limit, turn_limit, d);
}

void corot_deformation_measure(const corot_model *m, corot_state *s, double t, const double *u,
                               double strain_limit, double turn_limit, corot_deformation *out) {
  corot_deformation d = {.stretch_min = 1, .stretch_max = 1, .det_min = INFINITY, .det_tet = -1};
  const instant now = corot_state_at(s, t);
  const solid *body = body_of(m, s);
  measure_deformation(body, corot_state_displace(m, s, &now, u), strain_limit, turn_limit, &d);
  double volume = 0;
  for (int b = 0; b < body->elements.nblock; b++)
    for (int l = 0; l < body->elements.block[b].n; l++) volume += volume_at(&body->elements, b, l);
  d.strained /= volume;
  d.turned /= volume;
  *out = d;
}
