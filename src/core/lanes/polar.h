/* Rotations of tets: the polar factor and its derivative, and the warping frame.

   Polar factor of F = R S. Newton's iteration for it, X <- (g X + X^-T / g) / 2 from X = F, is
   written on the cofactors, X^-T = cof(X) / det(X), so no inverse is formed and no QR step is
   needed (Higham 1986; Higham & Schreiber 1990, the paper's (4.16)). The scale
   g^4 = |cof X|^2 / (det^2 |X|^2) brings all singular values near one at once; it may be crude, so
   its root is taken from the exponent bits, and near a rotation it is left out.

   R depends on its own F alone: a lane stops by its own test and is not touched again, whatever
   its neighbours need. It is right to rounding: after the first step every singular value is
   1 + d with d >= 0, a step takes d to d^2/2, and a lane stops with the step that starts from
   |X|^2 - 3 = sum (2d + d^2) < 1e-8. */
#ifndef COROT_CORE_LANES_POLAR_H
#define COROT_CORE_LANES_POLAR_H

#include <corot/base.h>

#include "mat3.h"

enum { POLAR_MAX_ITERATIONS = 40 };

/* (a / b)^(1/4) within 7 % for positive normal numbers: a quarter of the difference of the
   logarithms, read off the bits. */
COROT_INLINE vd fourth_root_of_ratio(vd a, vd b) {
  typedef unsigned long long vu __attribute__((vector_size(sizeof(vd))));
  vu bits = ((vu)a >> 2) - ((vu)b >> 2) + (1023ull << 52);
  return (vd)bits;
}

/* R for lanes with det F > 0; identity elsewhere, where *inverted is set (also for NaN). The sign
   of the determinant is kept by the iteration: where the last iterate's is not positive, that of F
   was lost in rounding. */
COROT_INLINE mat3 polar(mat3 F, vi *inverted) {
  mat3 X = F;
  vd det = vd_all(0);
  vi refused = {0}, done = {0};
  for (int k = 0; k < POLAR_MAX_ITERATIONS; k++) {
    mat3 C = mat3_cofactor(X);
    det = mat3_det(X, C);
    if (k == 0) done = refused = ~(det > vd_all(0));
    vd norm = mat3_dot(X, X), half_g = vd_all(0.5);
    vi far = (norm - 3) * (norm - 3) + (det - 1) * (det - 1) > 0.04;
    if (vi_any(far)) {
      vd g = fourth_root_of_ratio(mat3_dot(C, C), det * det * norm);
      half_g = vd_select(far, 0.5 * g, half_g);
    }
    mat3 Y = mat3_sum(half_g, X, 0.25 / (half_g * det), C);
    X = vi_any(done) ? mat3_select(done, X, Y) : Y; /* mostly the latter, which saves a third */
    if (k > 0) {
      done |= norm - 3 < 1e-8;
      if (!vi_any(~done)) break;
    }
  }
  *inverted = refused | ~done | ~(det > vd_all(0));
  if (!vi_any(*inverted)) return X;
  return mat3_select(*inverted, mat3_identity(), X);
}

/* G^-1 for G = tr(S) I - S: a rotation rate w of the frame, dR = R [w]x, solves
   G w = vee(R' dF). G is positive definite while the two smallest singular values have a positive
   sum. */
COROT_INLINE mat3 polar_inverse_g(mat3 S) {
  vd trace = mat3_trace(S);
  mat3 G;
  EACH_IJ G.m[i][j] = i == j ? trace - S.m[i][i] : -0.5 * (S.m[i][j] + S.m[j][i]);
  mat3 C = mat3_cofactor(G);
  return mat3_scale(1.0 / mat3_det(G, C), C);
}

/* exp([w t]x) R, by the quaternion of half the angle. The series are exact to rounding up to an
   angle of pi; beyond, dividing by the norm keeps the result a rotation. */
COROT_INLINE mat3 rotate_by(vec3 w, double t, mat3 R) {
  vec3 q;
  for (int i = 0; i < 3; i++) q.v[i] = 0.5 * t * w.v[i];
  vd y = vec3_dot(q, q), c = vd_all(1), s = vd_all(1);
  for (int k = 20; k > 0; k -= 2) { /* cos and sin(x)/x of x^2 = y by Horner's rule */
    c = 1 - c * y / (double)(k * (k - 1));
    s = 1 - s * y / (double)(k * (k + 1));
  }
  vd two = 2 / (c * c + s * s * y);
  for (int i = 0; i < 3; i++) q.v[i] *= s;
  mat3 X = mat3_skew(q), E = mat3_scale(two * c, X);
  E = mat3_add(E, mat3_scale(two, mat3_mul(X, X)));
  return mat3_add(R, mat3_mul(E, R));
}

/* Right-handed Gram-Schmidt on the columns of A: A = Q T, T upper triangular. The paper's edges
   d_1, d_2 of a tet are F D_1, F D_2, and an upper triangular factor on the right does not change
   Q, so the warping frame is gram_schmidt(F Q0) Q0' with Q0 = gram_schmidt of the rest edges. */
COROT_INLINE mat3 gram_schmidt(mat3 A) {
  vec3 q[3];
  for (int i = 0; i < 3; i++) q[0].v[i] = A.m[i][0], q[1].v[i] = A.m[i][1];
  for (int c = 0; c < 2; c++) {
    if (c == 1) {
      vd d = vec3_dot(q[0], q[1]);
      for (int i = 0; i < 3; i++) q[1].v[i] -= d * q[0].v[i];
    }
    vd n = vd_sqrt(vec3_dot(q[c], q[c]));
    for (int i = 0; i < 3; i++) q[c].v[i] /= n;
  }
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    q[2].v[i] = q[0].v[j] * q[1].v[k] - q[0].v[k] * q[1].v[j];
  }
  mat3 Q;
  EACH_IJ Q.m[i][j] = q[j].v[i];
  return Q;
}

/* dQ for a change dA: Q' dQ is skew with the strict lower part of Q' dA T^-1. */
COROT_INLINE mat3 gram_schmidt_derivative(mat3 Q, mat3 A, mat3 dA) {
  mat3 T = mat3_tmul(Q, A), B = mat3_tmul(Q, dA);
  vd l10 = B.m[1][0] / T.m[0][0], l20 = B.m[2][0] / T.m[0][0];
  vd l21 = (B.m[2][1] - l20 * T.m[0][1]) / T.m[1][1];
  vec3 w = {{l21, -l20, l10}};
  return mat3_mul(Q, mat3_skew(w));
}

/* Polar factor of one matrix, row-major [9]. COROT_RETRY if det F <= 0, or F is not finite.
   Any scale of F that double precision holds will do. */
corot_status corot_polar(const double F[9], double R[9]);

/* Polar factor of a 2x2 matrix, row-major: the columns of J + sign(det J) cof(J), normalised. The
   paper's (4.15) prints +J_12 where the cofactor is -J_12. COROT_RETRY if J is singular. */
corot_status corot_polar_2d(const double J[4], double R[4]);

#endif
