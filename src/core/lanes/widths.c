/* Asks the processor which build of the kernels it can take. */
#include "widths.h"

#ifdef COROT_MANY_KERNELS

/* Clang 14 does not know the levels by name. */
static int has_v4(void) {
#ifdef __clang__
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
         __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512vl");
#else
  return __builtin_cpu_supports("x86-64-v4") != 0;
#endif
}

static int has_v3(void) {
#ifdef __clang__
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi") &&
         __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("fma");
#else
  return __builtin_cpu_supports("x86-64-v3") != 0;
#endif
}

static int limit = 8;

void corot_lanes_limit(int most) { limit = most ? most : 8; }

int corot_lanes_in_use(void) {
  if (limit >= 8 && has_v4()) return 8;
  return limit >= 4 && has_v3() ? 4 : 2;
}

const char *corot_lanes_instruction_set(void) {
  int lanes = corot_lanes_in_use();
  if (lanes == 8) return "x86-64-v4";
  return lanes == 4 ? "x86-64-v3" : "x86-64";
}

#else

void corot_lanes_limit(int most) { (void)most; }

#if defined(__AVX512F__)
int corot_lanes_in_use(void) { return 8; }
const char *corot_lanes_instruction_set(void) { return "as built, AVX-512"; }
#elif defined(__AVX2__)
int corot_lanes_in_use(void) { return 4; }
const char *corot_lanes_instruction_set(void) { return "as built, AVX2"; }
#else
int corot_lanes_in_use(void) { return 2; }
const char *corot_lanes_instruction_set(void) { return "as built"; }
#endif

#endif
