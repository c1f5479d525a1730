/* Wall time for the phases of a run. */
#ifndef COROT_SOLVE_CLOCK_H
#define COROT_SOLVE_CLOCK_H

#include <time.h>

static inline double clock_wall(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

#endif
