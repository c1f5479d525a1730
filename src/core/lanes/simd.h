/* Vectors of doubles, one lane a tet. The only header with compiler extensions.

   In memory tets stand in blocks of W. The kernels, the loops over them, are compiled once for each
   instruction set (COROT_KERNELS, see core/CMakeLists.txt) with as many LANES as its registers
   have: vectors that are taken apart wait in memory, and cost several times as much. A block then
   has PARTS, and vd is a part of a block_vd. Other files see whole blocks.

   There a function marked COROT_CLONES is compiled once for each instruction set and the best one
   the processor has is taken at load time; what it calls must be COROT_INLINE to be compiled with
   it. Clang refuses 64-byte arguments between clones, so there the build's own -march decides; so
   it does where it names AVX2 or more, and under AddressSanitizer, where the clones would take
   minutes to compile, and ThreadSanitizer, which does not survive the choice. */
#ifndef COROT_CORE_LANES_SIMD_H
#define COROT_CORE_LANES_SIMD_H

#include <math.h>
#include <string.h>

#if !defined(COROT_KERNELS) || defined(__AVX512F__)
#define COROT_LANES 8
#elif defined(__AVX2__)
#define COROT_LANES 4
#else
#define COROT_LANES 2
#endif
enum { W = 8, LANES = COROT_LANES, PARTS = W / LANES };

typedef double vd __attribute__((vector_size(8 * COROT_LANES)));
typedef long long vi __attribute__((vector_size(8 * COROT_LANES))); /* a comparison's mask: 0 or -1
                                                                       a lane */
typedef double block_vd __attribute__((vector_size(64)));
typedef double vd4 __attribute__((vector_size(32)));
typedef double vd2 __attribute__((vector_size(16)));

#define COROT_INLINE static inline __attribute__((always_inline))

/* Of static functions only: the name that chooses among the clones is exported, hidden or not. */
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && defined(__linux__) && \
    !defined(__AVX2__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && \
    !defined(COROT_KERNELS)
#define COROT_CLONES __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define COROT_CLONES
#endif

/* Of an array of blocks, part `at` % PARTS of block `at` / PARTS. */
COROT_INLINE vd vd_at(const block_vd *x, int at) { return ((const vd *)x)[at]; }
COROT_INLINE void vd_put(block_vd *x, int at, vd a) { ((vd *)x)[at] = a; }

COROT_INLINE vd vd_all(double x) {
#if COROT_LANES == 8
  return (vd){x, x, x, x, x, x, x, x};
#elif COROT_LANES == 4
  return (vd){x, x, x, x};
#else
  return (vd){x, x};
#endif
}

/* mask ? a : b */
COROT_INLINE vd vd_select(vi mask, vd a, vd b) { return (vd)((mask & (vi)a) | (~mask & (vi)b)); }

COROT_INLINE vd vd_max(vd a, vd b) { return vd_select(a > b, a, b); }

COROT_INLINE vd vd_sqrt(vd a) {
  for (int l = 0; l < LANES; l++) a[l] = sqrt(a[l]);
  return a;
}

COROT_INLINE vd vd_load(const double *x) {
  typedef double vd_anywhere __attribute__((vector_size(sizeof(vd)), aligned(8), may_alias));
  return *(const vd_anywhere *)x;
}

/* x [LANES] += a */
COROT_INLINE void vd_add_to(double *x, vd a) {
  typedef double vd_anywhere __attribute__((vector_size(sizeof(vd)), aligned(8), may_alias));
  *(vd_anywhere *)x += a;
}

COROT_INLINE vd2 vd2_load(const double *x) {
  vd2 a;
  memcpy(&a, x, sizeof a);
  return a;
}

COROT_INLINE vd4 vd4_load(const double *x) {
  vd4 a;
  memcpy(&a, x, sizeof a);
  return a;
}

/* Of four numbers of single precision. */
COROT_INLINE vd4 vd4_widen(const float *x) {
  typedef float vf4 __attribute__((vector_size(16)));
  vf4 a;
  memcpy(&a, x, sizeof a);
  return __builtin_convertvector(a, vd4);
}

/* For each width:
   vi_any        whether a lane is set; halves are folded onto each other, so that a few
                 instructions do
   vd_sum        of the lanes
   vd_gather3    rows x[a] of four (three used) for all lanes become three vectors
   vd_transpose  rows to columns: out[l][k] = in[k][l]; in [LANES] */
#if COROT_LANES == 8

COROT_INLINE int vi_any(vi mask) {
  typedef long long vi4 __attribute__((vector_size(32)));
  typedef long long vi2 __attribute__((vector_size(16)));
  vi4 four = __builtin_shufflevector(mask, mask, 0, 1, 2, 3) |
             __builtin_shufflevector(mask, mask, 4, 5, 6, 7);
  vi2 two = __builtin_shufflevector(four, four, 0, 1) | __builtin_shufflevector(four, four, 2, 3);
  return (two[0] | two[1]) != 0;
}

COROT_INLINE double vd_sum(vd a) {
  return ((a[0] + a[4]) + (a[2] + a[6])) + ((a[1] + a[5]) + (a[3] + a[7]));
}

COROT_INLINE vd vd_join(vd4 low, vd4 high) {
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}

COROT_INLINE void vd_gather3(const double (*x)[4], const int *a, vd out[3]) {
  vd r[4];
  for (int k = 0; k < 4; k++) r[k] = vd_join(vd4_load(x[a[k]]), vd4_load(x[a[k + 4]]));
  vd xz01 = __builtin_shufflevector(r[0], r[1], 0, 8, 2, 10, 4, 12, 6, 14);
  vd xz23 = __builtin_shufflevector(r[2], r[3], 0, 8, 2, 10, 4, 12, 6, 14);
  vd y01 = __builtin_shufflevector(r[0], r[1], 1, 9, 3, 11, 5, 13, 7, 15);
  vd y23 = __builtin_shufflevector(r[2], r[3], 1, 9, 3, 11, 5, 13, 7, 15);
  out[0] = __builtin_shufflevector(xz01, xz23, 0, 1, 8, 9, 4, 5, 12, 13);
  out[1] = __builtin_shufflevector(y01, y23, 0, 1, 8, 9, 4, 5, 12, 13);
  out[2] = __builtin_shufflevector(xz01, xz23, 2, 3, 10, 11, 6, 7, 14, 15);
}

COROT_INLINE void vd_transpose(const vd *in, vd out[8]) {
  vd a[8], b[8];
  for (int k = 0; k < 8; k += 2) { /* pairs of lanes */
    a[k] = __builtin_shufflevector(in[k], in[k + 1], 0, 8, 2, 10, 4, 12, 6, 14);
    a[k + 1] = __builtin_shufflevector(in[k], in[k + 1], 1, 9, 3, 11, 5, 13, 7, 15);
  }
  for (int k = 0; k < 8; k += 4)
    for (int o = 0; o < 2; o++) { /* quads */
      b[k + o] = __builtin_shufflevector(a[k + o], a[k + 2 + o], 0, 1, 8, 9, 4, 5, 12, 13);
      b[k + 2 + o] = __builtin_shufflevector(a[k + o], a[k + 2 + o], 2, 3, 10, 11, 6, 7, 14, 15);
    }
  for (int o = 0; o < 4; o++) { /* halves */
    out[o] = __builtin_shufflevector(b[o], b[4 + o], 0, 1, 2, 3, 8, 9, 10, 11);
    out[4 + o] = __builtin_shufflevector(b[o], b[4 + o], 4, 5, 6, 7, 12, 13, 14, 15);
  }
}

#elif COROT_LANES == 4

COROT_INLINE int vi_any(vi mask) {
  typedef long long vi2 __attribute__((vector_size(16)));
  vi2 two = __builtin_shufflevector(mask, mask, 0, 1) | __builtin_shufflevector(mask, mask, 2, 3);
  return (two[0] | two[1]) != 0;
}

COROT_INLINE double vd_sum(vd a) { return (a[0] + a[2]) + (a[1] + a[3]); }

COROT_INLINE void vd_gather3(const double (*x)[4], const int *a, vd out[3]) {
  vd r[4];
  for (int k = 0; k < 4; k++) r[k] = vd4_load(x[a[k]]);
  vd xz01 = __builtin_shufflevector(r[0], r[1], 0, 4, 2, 6);
  vd xz23 = __builtin_shufflevector(r[2], r[3], 0, 4, 2, 6);
  vd y01 = __builtin_shufflevector(r[0], r[1], 1, 5, 3, 7);
  vd y23 = __builtin_shufflevector(r[2], r[3], 1, 5, 3, 7);
  out[0] = __builtin_shufflevector(xz01, xz23, 0, 1, 4, 5);
  out[1] = __builtin_shufflevector(y01, y23, 0, 1, 4, 5);
  out[2] = __builtin_shufflevector(xz01, xz23, 2, 3, 6, 7);
}

COROT_INLINE void vd_transpose(const vd *in, vd out[4]) {
  vd a[4];
  for (int k = 0; k < 4; k += 2) { /* pairs of lanes */
    a[k] = __builtin_shufflevector(in[k], in[k + 1], 0, 4, 2, 6);
    a[k + 1] = __builtin_shufflevector(in[k], in[k + 1], 1, 5, 3, 7);
  }
  for (int o = 0; o < 2; o++) { /* halves */
    out[o] = __builtin_shufflevector(a[o], a[2 + o], 0, 1, 4, 5);
    out[2 + o] = __builtin_shufflevector(a[o], a[2 + o], 2, 3, 6, 7);
  }
}

#else

COROT_INLINE int vi_any(vi mask) { return (mask[0] | mask[1]) != 0; }

COROT_INLINE double vd_sum(vd a) { return a[0] + a[1]; }

COROT_INLINE void vd_gather3(const double (*x)[4], const int *a, vd out[3]) {
  vd first = vd2_load(x[a[0]]), second = vd2_load(x[a[1]]);
  out[0] = __builtin_shufflevector(first, second, 0, 2);
  out[1] = __builtin_shufflevector(first, second, 1, 3);
  out[2] = (vd){x[a[0]][2], x[a[1]][2]};
}

COROT_INLINE void vd_transpose(const vd *in, vd out[2]) {
  out[0] = __builtin_shufflevector(in[0], in[1], 0, 2);
  out[1] = __builtin_shufflevector(in[0], in[1], 1, 3);
}

#endif

#endif
