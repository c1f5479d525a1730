/* The least of what the machine has, what its control group may have, and RLIMIT_AS. */
#include "memory_limit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <unistd.h>

static double physical_memory(void) {
#ifdef _SC_PHYS_PAGES
  long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGESIZE);
  if (pages > 0 && size > 0) return (double)pages * (double)size;
#endif
  return INFINITY;
}

/* In a container its own group is at the root; "max" is no number. */
static double group_memory(void) {
  static const char *const files[] = {"/sys/fs/cgroup/memory.max",
                                      "/sys/fs/cgroup/memory/memory.limit_in_bytes"};
  for (int k = 0; k < 2; k++) {
    char text[32] = "";
    FILE *f = fopen(files[k], "r");
    if (!f) continue;
    if (!fgets(text, sizeof text, f)) text[0] = '\0';
    fclose(f);
    unsigned long long bytes = strtoull(text, NULL, 10);
    if (bytes > 0) return (double)bytes;
  }
  return INFINITY;
}

corot_memory_limit corot_memory_limits(void) {
  corot_memory_limit m = {.machine = physical_memory(), .what = "this machine"};
  double group = group_memory();
  struct rlimit limit;
  if (group < m.machine) m.machine = group, m.what = "the control group of the process";
  m.process = m.machine;
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY &&
      (double)limit.rlim_cur < m.process)
    m.process = (double)limit.rlim_cur, m.what = "RLIMIT_AS (ulimit -v)";
  return m;
}
