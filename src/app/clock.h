/* Clocks, in seconds. */
#ifndef COROT_APP_CLOCK_H
#define COROT_APP_CLOCK_H

#include <time.h>

static inline double clock_of(clockid_t which) {
  struct timespec now;
  clock_gettime(which, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static inline double wall_clock(void) { return clock_of(CLOCK_MONOTONIC); }
static inline double cpu_clock(void) { return clock_of(CLOCK_PROCESS_CPUTIME_ID); }

#endif
