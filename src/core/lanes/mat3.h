/* 3x3 algebra by value, a matrix a lane; m[i][j] is row i, column j. */
#ifndef COROT_CORE_LANES_MAT3_H
#define COROT_CORE_LANES_MAT3_H

#include "simd.h"

typedef struct vec3 {
  vd v[3];
} vec3;

typedef struct mat3 {
  vd m[3][3];
} mat3;

/* As they stand in memory: of a block of tets. */
#if COROT_LANES == 8
typedef vec3 block_vec3;
typedef mat3 block_mat3;
#else
typedef struct block_vec3 {
  block_vd v[3];
} block_vec3;

typedef struct block_mat3 {
  block_vd m[3][3];
} block_mat3;
#endif

#define EACH_IJ               \
  for (int i = 0; i < 3; i++) \
    for (int j = 0; j < 3; j++)

/* Of an array of blocks, part `at` % PARTS of block `at` / PARTS. */
COROT_INLINE mat3 mat3_at(const block_mat3 *A, int at) {
  mat3 part;
  EACH_IJ part.m[i][j] = vd_at(&A[at / PARTS].m[i][j], at % PARTS);
  return part;
}

COROT_INLINE void mat3_put(block_mat3 *A, int at, mat3 part) {
  EACH_IJ vd_put(&A[at / PARTS].m[i][j], at % PARTS, part.m[i][j]);
}

/* The same where it stands, if it stands alone; else in `room`. */
COROT_INLINE const mat3 *mat3_in(const block_mat3 *A, int at, mat3 *room) {
#if COROT_LANES == 8
  (void)room;
  return &A[at];
#else
  *room = mat3_at(A, at);
  return room;
#endif
}

COROT_INLINE vec3 vec3_at(const block_vec3 *a, int at) {
  vec3 part;
  for (int i = 0; i < 3; i++) part.v[i] = vd_at(&a[at / PARTS].v[i], at % PARTS);
  return part;
}

COROT_INLINE void vec3_put(block_vec3 *a, int at, vec3 part) {
  for (int i = 0; i < 3; i++) vd_put(&a[at / PARTS].v[i], at % PARTS, part.v[i]);
}

COROT_INLINE mat3 mat3_identity(void) {
  mat3 A;
  EACH_IJ A.m[i][j] = vd_all(i == j);
  return A;
}

COROT_INLINE mat3 mat3_scale(vd a, mat3 A) {
  EACH_IJ A.m[i][j] *= a;
  return A;
}

/* a A + b B */
COROT_INLINE mat3 mat3_sum(vd a, mat3 A, vd b, mat3 B) {
  EACH_IJ A.m[i][j] = a * A.m[i][j] + b * B.m[i][j];
  return A;
}

COROT_INLINE mat3 mat3_add(mat3 A, mat3 B) {
  EACH_IJ A.m[i][j] += B.m[i][j];
  return A;
}

/* A + a I */
COROT_INLINE mat3 mat3_add_identity(mat3 A, vd a) {
  for (int i = 0; i < 3; i++) A.m[i][i] += a;
  return A;
}

COROT_INLINE mat3 mat3_transpose(mat3 A) {
  mat3 T;
  EACH_IJ T.m[i][j] = A.m[j][i];
  return T;
}

COROT_INLINE mat3 mat3_mul(mat3 A, mat3 B) {
  mat3 C;
  EACH_IJ C.m[i][j] = A.m[i][0] * B.m[0][j] + A.m[i][1] * B.m[1][j] + A.m[i][2] * B.m[2][j];
  return C;
}

/* A' B */
COROT_INLINE mat3 mat3_tmul(mat3 A, mat3 B) {
  mat3 C;
  EACH_IJ C.m[i][j] = A.m[0][i] * B.m[0][j] + A.m[1][i] * B.m[1][j] + A.m[2][i] * B.m[2][j];
  return C;
}

/* sym(A' B) */
COROT_INLINE mat3 mat3_sym_tmul(mat3 A, mat3 B) {
  mat3 C = mat3_tmul(A, B), S;
  EACH_IJ S.m[i][j] = i == j ? C.m[i][i] : 0.5 * (C.m[i][j] + C.m[j][i]);
  return S;
}

/* A' A */
COROT_INLINE mat3 mat3_gram(mat3 A) {
  mat3 C;
  for (int i = 0; i < 3; i++)
    for (int j = i; j < 3; j++)
      C.m[i][j] = C.m[j][i] = A.m[0][i] * A.m[0][j] + A.m[1][i] * A.m[1][j] + A.m[2][i] * A.m[2][j];
  return C;
}

COROT_INLINE vd mat3_trace(mat3 A) { return A.m[0][0] + A.m[1][1] + A.m[2][2]; }

/* A : B = tr(A' B) */
COROT_INLINE vd mat3_dot(mat3 A, mat3 B) {
  vd row[3]; /* three short chains of additions, not one long one */
  for (int i = 0; i < 3; i++)
    row[i] = A.m[i][0] * B.m[i][0] + A.m[i][1] * B.m[i][1] + A.m[i][2] * B.m[i][2];
  return row[0] + row[1] + row[2];
}

/* cof A = det(A) A^-T */
COROT_INLINE mat3 mat3_cofactor(mat3 A) {
  mat3 C;
  for (int i = 0; i < 3; i++) {
    int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    for (int j = 0; j < 3; j++) {
      int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      C.m[i][j] = A.m[i1][j1] * A.m[i2][j2] - A.m[i1][j2] * A.m[i2][j1];
    }
  }
  return C;
}

/* det A from A and its cofactors */
COROT_INLINE vd mat3_det(mat3 A, mat3 C) {
  return A.m[0][0] * C.m[0][0] + A.m[0][1] * C.m[0][1] + A.m[0][2] * C.m[0][2];
}

COROT_INLINE mat3 mat3_select(vi mask, mat3 A, mat3 B) {
  EACH_IJ A.m[i][j] = vd_select(mask, A.m[i][j], B.m[i][j]);
  return A;
}

/* [a]x: skew(a) b = a x b */
COROT_INLINE mat3 mat3_skew(vec3 a) {
  vd o = vd_all(0);
  return (mat3){{{o, -a.v[2], a.v[1]}, {a.v[2], o, -a.v[0]}, {-a.v[1], a.v[0], o}}};
}

/* Twice the axial vector of the skew part: vee([a]x) = 2a. */
COROT_INLINE vec3 mat3_vee(mat3 A) {
  return (vec3){{A.m[2][1] - A.m[1][2], A.m[0][2] - A.m[2][0], A.m[1][0] - A.m[0][1]}};
}

COROT_INLINE vec3 mat3_apply(mat3 A, vec3 x) {
  vec3 y;
  for (int i = 0; i < 3; i++) y.v[i] = A.m[i][0] * x.v[0] + A.m[i][1] * x.v[1] + A.m[i][2] * x.v[2];
  return y;
}

COROT_INLINE vd vec3_dot(vec3 a, vec3 b) {
  return a.v[0] * b.v[0] + a.v[1] * b.v[1] + a.v[2] * b.v[2];
}

/* A + a b' */
COROT_INLINE mat3 mat3_add_outer(mat3 A, vec3 a, vec3 b) {
  EACH_IJ A.m[i][j] += a.v[i] * b.v[j];
  return A;
}

/* One matrix in all lanes, and one lane's matrix; row-major [9]. */
COROT_INLINE mat3 mat3_load(const double *a) {
  mat3 A;
  EACH_IJ A.m[i][j] = vd_all(a[3 * i + j]);
  return A;
}

COROT_INLINE void mat3_store(mat3 A, int lane, double *a) {
  EACH_IJ a[3 * i + j] = A.m[i][j][lane];
}

#endif
