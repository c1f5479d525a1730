/* What is shown of a point of the body, a point a lane. */
#ifndef COROT_CORE_ODE_SHOWN_H
#define COROT_CORE_ODE_SHOWN_H

#include "core/element/strain.h"
#include "state.h"

/* Frame; shear-term strain; stress on the deformed body, in fixed axes; energy per rest volume. */
typedef struct shown {
  mat3 R, e, stress;
  vd mises, det, energy;
} shown;

/* Where the components of a symmetric tensor stand: xx yy zz xy yz xz. */
static const int shown_ij[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}};

COROT_INLINE mat3 sym(mat3 A) {
  mat3 S;
  EACH_IJ S.m[i][j] = 0.5 * (A.m[i][j] + A.m[j][i]);
  return S;
}

/* sqrt(3/2 dev:dev) of symmetric S. */
COROT_INLINE vd von_mises_of(mat3 S) {
  vd mean = mat3_trace(S) / 3, square = vd_all(0);
  EACH_IJ {
    vd a = S.m[i][j] - (i == j ? mean : vd_all(0));
    square += a * a;
  }
  for (int l = 0; l < W; l++) square[l] = sqrt(1.5 * square[l]);
  return square;
}

/* `average` takes the place of the dilatation; NULL: it is the point's own. */
COROT_INLINE shown show(const strain_measure *measure, vd lambda, vd mu, const vd *average, mat3 F,
                        mat3 R) {
  shown s = {.R = R, .e = strain_of(measure->shear, F, R)};
  mat3 P = average ? stress_at_pressure(measure, lambda * *average, mu, F, R)
                   : stress(measure, lambda, mu, F, R);
  s.det = mat3_det(F, mat3_cofactor(F));
  s.stress =
      sym(strain_is_linear(measure) ? P : mat3_scale(1.0 / s.det, mat3_mul(P, mat3_transpose(F))));
  s.mises = von_mises_of(s.stress);
  s.energy = strain_energy(measure, lambda, mu, F, R, average);
  return s;
}

COROT_INLINE void store_symmetric(mat3 A, int lane, double *a) {
  for (int k = 0; k < 6; k++) a[k] = A.m[shown_ij[k][0]][shown_ij[k][1]][lane];
}

/* Eigenvalues of symmetric A in a lane, the largest first. */
COROT_INLINE void store_eigenvalues(const eigen3 *e, int lane, double a[3]) {
  double x = e->value[0][lane], y = e->value[1][lane], z = e->value[2][lane];
  a[0] = fmax(x, fmax(y, z));
  a[2] = fmin(x, fmin(y, z));
  a[1] = fmax(fmin(x, y), fmin(fmax(x, y), z));
}

/* What both kinds of fields start from: frames and averages of u, which is put on all nodes.
   COROT_RETRY: a tet that hands down its frame is inverted; the others can be shown all the same.
 */
corot_status corot_show_begin(const corot_model *m, corot_state *s, double t, const double *u,
                              nodal_field *all_u);

/* The status of the fields: `first` is the first inverted tet of those that were shown, or -1;
   `above` what the beginning said. */
corot_status corot_show_end(const corot_model *m, corot_state *s, int first, corot_status above);

#endif
