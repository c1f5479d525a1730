/* CLOCK_MONOTONIC does go back: in guests that are moved or restored, and under tools that set the
   time of a process. */
#include "clock.h"

#include <time.h>

double corot_wall_clock(void) {
  static _Thread_local double latest, lost;
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  double now = (double)t.tv_sec + 1e-9 * (double)t.tv_nsec + lost;
  if (now < latest) {
    lost += latest - now;
    now = latest;
  }
  return latest = now;
}
