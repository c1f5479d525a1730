/* Clocks, in seconds. */
#ifndef COROT_APP_RUN_RUN_CLOCK_H
#define COROT_APP_RUN_RUN_CLOCK_H

#include <time.h>

#include "core/base/clock.h"

static inline double wall_clock(void) { return corot_wall_clock(); }

static inline double cpu_clock(void) {
  struct timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

#endif
