/* Asks how much room is left, and how much the BLAS would take, before its first call. */
#define _GNU_SOURCE /* RTLD_DEFAULT, MAP_ANONYMOUS */
#include "blas_room.h"

#include <dlfcn.h>
#include <stdbool.h>
#include <stddef.h>
#include <sys/mman.h>
#include <sys/resource.h>

/* OpenBLAS 0.3 on x86-64 takes 128 MiB a thread, and a page or so to align it. */
enum { BUFFER_MB = 130 };

typedef void triangular_solve(const char *side, const char *uplo, const char *trans,
                              const char *diag, const int *m, const int *n, const double *alpha,
                              const double *a, const int *lda, double *b, const int *ldb);

static bool is_limited(void) {
  struct rlimit limit;
  return getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
}

static bool has_room(void) {
  size_t size = (size_t)BUFFER_MB << 20;
  void *room = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (room == MAP_FAILED) return false;
  munmap(room, size);
  return true;
}

/* The least for which OpenBLAS takes its buffer: 1 b = 1. Whatever BLAS this is linked to has it;
   where it is not visible, the first factorisation comes soon enough. */
static void take_buffer(void) {
  union {
    void *object;
    triangular_solve *function;
  } found = {dlsym(RTLD_DEFAULT, "dtrsm_")};
  const int one = 1;
  const double a = 1;
  double b = 1;
  if (found.object) found.function("L", "L", "N", "N", &one, &one, &a, &a, &one, &b, &one);
}

corot_status corot_blas_room(void) {
  static bool taken; /* a second thread that comes at the same time only looks again */
  if (taken || !is_limited()) return COROT_OK;
  if (!has_room())
    return corot_fail(COROT_ENOMEM, "no memory for the BLAS: it needs %d MB of address space",
                      BUFFER_MB);
  take_buffer();
  taken = true;
  return COROT_OK;
}
