/* Eigenvalues and eigenvectors of symmetric 3x3 matrices, one a lane, by Jacobi's rotations.

   Every lane goes through the same number of sweeps. The last ones at least square what is left off
   the diagonal: of a million random matrices some have 1e-5 of it after three, none more than
   rounding after four. */
#ifndef COROT_CORE_LANES_EIGEN_H
#define COROT_CORE_LANES_EIGEN_H

#include "mat3.h"

enum { EIGEN_SWEEPS = 5 };

typedef struct eigen3 {
  vd value[3];
  mat3 vector; /* its columns */
} eigen3;

/* Turns coordinates p and q of A, and columns p and q of Q, by the angle of at most pi/4 that makes
   A_pq zero; r is the third coordinate. */
COROT_INLINE void jacobi_rotation(mat3 *A, mat3 *Q, int p, int q) {
  int r = 3 - p - q;
  vd o = vd_all(0), one = vd_all(1), apq = A->m[p][q];
  vi none = apq == o;
  vd cotangent =
      (A->m[q][q] - A->m[p][p]) / (2 * vd_select(none, one, apq)); /* of twice the angle */
  vd size = vd_select(cotangent < o, -cotangent, cotangent);
  vd t = 1 / (size + vd_sqrt(size * size + 1));
  t = vd_select(none, o, vd_select(cotangent < o, -t, t));
  vd c = 1 / vd_sqrt(1 + t * t), s = t * c;

  A->m[p][p] -= t * apq, A->m[q][q] += t * apq;
  A->m[p][q] = A->m[q][p] = o;
  vd arp = A->m[r][p], arq = A->m[r][q];
  A->m[r][p] = A->m[p][r] = c * arp - s * arq;
  A->m[r][q] = A->m[q][r] = s * arp + c * arq;
  for (int i = 0; i < 3; i++) {
    vd x = Q->m[i][p], y = Q->m[i][q];
    Q->m[i][p] = c * x - s * y;
    Q->m[i][q] = s * x + c * y;
  }
}

/* A is symmetric. */
COROT_INLINE eigen3 eigen_of(mat3 A) {
  eigen3 e = {.vector = mat3_identity()};
  for (int sweep = 0; sweep < EIGEN_SWEEPS; sweep++) {
    jacobi_rotation(&A, &e.vector, 0, 1);
    jacobi_rotation(&A, &e.vector, 0, 2);
    jacobi_rotation(&A, &e.vector, 1, 2);
  }
  for (int i = 0; i < 3; i++) e.value[i] = A.m[i][i];
  return e;
}

/* The largest eigenvalue of a symmetric A. */
COROT_INLINE vd largest_eigenvalue(mat3 A) {
  eigen3 e = eigen_of(A);
  return vd_max(e.value[0], vd_max(e.value[1], e.value[2]));
}

/* A symmetric A without its negative eigenvalues; A itself, bit by bit, where it has none. */
COROT_INLINE mat3 positive_part(mat3 A) {
  eigen3 e = eigen_of(A);
  vd o = vd_all(0);
  mat3 B = mat3_scale(o, mat3_identity());
  for (int k = 0; k < 3; k++) {
    vec3 x, y;
    for (int i = 0; i < 3; i++) {
      x.v[i] = e.vector.m[i][k];
      y.v[i] = vd_max(e.value[k], o) * x.v[i];
    }
    B = mat3_add_outer(B, y, x);
  }
  vi negative = (e.value[0] < o) | (e.value[1] < o) | (e.value[2] < o);
  return mat3_select(negative, B, A);
}

#endif
