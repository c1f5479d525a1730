/* Vectors of eight doubles, one lane a tet. The only header with compiler extensions.

   A function marked COROT_CLONES is compiled once for each instruction set and the best one the
   processor has is taken at load time; what it calls must be COROT_INLINE to be compiled with it.
   Clang refuses 64-byte arguments between clones, so there the build's own -march decides; so it
   does where it names AVX2 or more, and under AddressSanitizer, where the clones would take minutes
   to compile. */
#ifndef COROT_CORE_LANES_SIMD_H
#define COROT_CORE_LANES_SIMD_H

#include <math.h>
#include <string.h>

enum { W = 8 }; /* lanes */

typedef double vd __attribute__((vector_size(64)));
typedef double vd4 __attribute__((vector_size(32)));
typedef long long vi __attribute__((vector_size(64))); /* a comparison's mask: 0 or -1 a lane */

#define COROT_INLINE static inline __attribute__((always_inline))

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && defined(__linux__) && \
    !defined(__AVX2__) && !defined(__SANITIZE_ADDRESS__)
#define COROT_CLONES __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))

/* The one whose clones are taken. */
static inline const char *simd_instruction_set(void) {
  if (__builtin_cpu_supports("x86-64-v4")) return "x86-64-v4";
  return __builtin_cpu_supports("x86-64-v3") ? "x86-64-v3" : "x86-64";
}
#else
#define COROT_CLONES
static inline const char *simd_instruction_set(void) {
#if defined(__AVX512F__)
  return "as built, AVX-512";
#elif defined(__AVX2__)
  return "as built, AVX2";
#else
  return "as built";
#endif
}
#endif

COROT_INLINE vd vd_all(double x) { return (vd){x, x, x, x, x, x, x, x}; }

/* mask ? a : b */
COROT_INLINE vd vd_select(vi mask, vd a, vd b) { return (vd)((mask & (vi)a) | (~mask & (vi)b)); }

COROT_INLINE vd vd_max(vd a, vd b) { return vd_select(a > b, a, b); }

COROT_INLINE vd vd_sqrt(vd a) {
  for (int l = 0; l < W; l++) a[l] = sqrt(a[l]);
  return a;
}

/* Halves are folded onto each other, so that a few instructions do. */
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

/* x [8] += a */
COROT_INLINE void vd_add_to(double *x, vd a) {
  typedef double vd_anywhere __attribute__((vector_size(64), aligned(8), may_alias));
  *(vd_anywhere *)x += a;
}

COROT_INLINE vd vd_load(const double *x) {
  typedef double vd_anywhere __attribute__((vector_size(64), aligned(8), may_alias));
  return *(const vd_anywhere *)x;
}

COROT_INLINE vd4 vd4_load(const double *x) {
  vd4 a;
  memcpy(&a, x, sizeof a);
  return a;
}

COROT_INLINE vd vd_join(vd4 low, vd4 high) {
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}

/* Rows x[a] of four (three used) for eight lanes become three vectors. */
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

/* Rows to columns: out[l][k] = in[k][l]; in [W]. */
COROT_INLINE void vd_transpose(const vd *in, vd out[W]) {
  vd a[W], b[W];
  for (int k = 0; k < W; k += 2) { /* pairs of lanes */
    a[k] = __builtin_shufflevector(in[k], in[k + 1], 0, 8, 2, 10, 4, 12, 6, 14);
    a[k + 1] = __builtin_shufflevector(in[k], in[k + 1], 1, 9, 3, 11, 5, 13, 7, 15);
  }
  for (int k = 0; k < W; k += 4)
    for (int o = 0; o < 2; o++) { /* quads */
      b[k + o] = __builtin_shufflevector(a[k + o], a[k + 2 + o], 0, 1, 8, 9, 4, 5, 12, 13);
      b[k + 2 + o] = __builtin_shufflevector(a[k + o], a[k + 2 + o], 2, 3, 10, 11, 6, 7, 14, 15);
    }
  for (int o = 0; o < 4; o++) { /* halves */
    out[o] = __builtin_shufflevector(b[o], b[4 + o], 0, 1, 2, 3, 8, 9, 10, 11);
    out[4 + o] = __builtin_shufflevector(b[o], b[4 + o], 4, 5, 6, 7, 12, 13, 14, 15);
  }
}

#endif
