/* Compares the kernels that OpenBLAS has chosen with what the processor can do; and holds its
   threads. */
#define _GNU_SOURCE /* RTLD_DEFAULT */
#include "blas_core.h"

#include <dlfcn.h>
#include <stddef.h>
#include <stdlib.h>
#include <strings.h>

/* What it falls back on, on x86-64. */
#define FALLBACK "Prescott"

static const char *core_in_use(void) {
  union {
    void *object;
    const char *(*function)(void);
  } found = {dlsym(RTLD_DEFAULT, "openblas_get_corename")};
  return found.object ? found.function() : NULL;
}

/* Names that every OpenBLAS since 0.3.0 knows. */
static const char *best_core(void) {
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl"))
    return "SkylakeX";
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return "Haswell";
#endif
  return NULL;
}

const char *corot_blas_better_core(void) {
  if (getenv("OPENBLAS_CORETYPE")) return NULL;
  const char *core = core_in_use();
  return core && strcasecmp(core, FALLBACK) == 0 ? best_core() : NULL;
}

void corot_blas_keep_to_one_thread(void) {
  static const char *const said[] = {"OPENBLAS_NUM_THREADS", "GOTO_NUM_THREADS", "OMP_NUM_THREADS"};
  union {
    void *object;
    void (*function)(int n);
  } found = {dlsym(RTLD_DEFAULT, "openblas_set_num_threads")};
  for (size_t i = 0; i < sizeof said / sizeof *said; i++)
    if (getenv(said[i])) return;
  if (found.object) found.function(1);
}
