/* The rows that are kept of many steps. */
#include "steps_kept.h"

bool thin_keeps(long number, unsigned events) {
  long every = 1;
  while (number / every > THIN_FROM) every *= 10;
  return number % every == 0 ||
         (events & (EVENT_KINK | EVENT_RESTART | EVENT_FAILED | EVENT_REJECTED)) != 0;
}

const char *thin_rule(const steps_count *count) {
  if (count->rows == count->steps) return "every step";
  return "every step up to 10000, every 10th up to 100000, every 100th up to 1000000 and so on, "
         "and "
         "kinks, restarts, failures, refused steps and the last one always";
}
