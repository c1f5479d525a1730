#include "machine.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/run/run_clock.h"
#include "core/lanes/widths.h"
#include "machine_loops.h"

const char *machine_cpu(void) {
  static char name[128] = "unknown";
  char line[512];
  FILE *f = fopen("/proc/cpuinfo", "r");
  if (!f) return name;
  while (fgets(line, sizeof line, f)) {
    char *value = strchr(line, ':');
    if (strncmp(line, "model name", 10) != 0 || !value) continue;
    snprintf(name, sizeof name, "%.*s", (int)strcspn(value + 2, "\n"), value + 2);
    break;
  }
  fclose(f);
  return name;
}

static volatile double sink; /* so that no loop is dropped */

typedef struct loops {
  __typeof__(machine_triad) *triad;
  __typeof__(machine_total) *total;
  __typeof__(machine_chains) *chains;
} loops;

#ifdef COROT_MANY_KERNELS
#define BUILD(suffix)                                                               \
  extern __typeof__(machine_triad) machine_triad##suffix;                           \
  extern __typeof__(machine_total) machine_total##suffix;                           \
  extern __typeof__(machine_chains) machine_chains##suffix;                         \
  static const loops loops##suffix = {machine_triad##suffix, machine_total##suffix, \
                                      machine_chains##suffix};
BUILD(_v1)
BUILD(_v3)
BUILD(_v4)

/* Of the build of the kernels that is in use. */
static loops loops_in_use(void) {
  int lanes = corot_lanes_in_use();
  if (lanes == 8) return loops_v4;
  return lanes == 4 ? loops_v3 : loops_v1;
}
#else
static loops loops_in_use(void) { return (loops){machine_triad, machine_total, machine_chains}; }
#endif

double machine_bandwidth(size_t bytes) {
  size_t n = (bytes / (3 * 8) / 64 + 1) * 64, size = n * sizeof(double);
  double *a = aligned_alloc(64, 3 * size), *b = a + n, *c = b + n;
  if (!a) return 0;
  memset(a, 0, 3 * size);
  loops use = loops_in_use();
  int nsweep = (int)(2e6 / size) + 1; /* at least some 0.1 ms */
  double best = 0;
  for (int k = 0; k < 24; k++) {
    double start = cpu_clock();
    for (int i = 0; i < nsweep; i++)
      if (k % 2)
        sink = use.total(3 * n, a);
      else
        use.triad(n, a, b, c, 1e-3 * i);
    double rate = (double)nsweep * 3 * size / (cpu_clock() - start);
    if (rate > best) best = rate;
  }
  free(a);
  return best;
}

static double peak = 0; /* until it is measured */

void machine_set_peak(double flops) { peak = flops; }

double machine_peak(void) {
  if (peak > 0) return peak;
  loops use = loops_in_use();
  double best = 0, result;
  for (int repeat = 0; repeat < 40; repeat++)
    for (int k = 0; k < MACHINE_CHAINS; k++) {
      double start = cpu_clock();
      double rate = use.chains(k, 0.5, &result) / (cpu_clock() - start);
      sink = result;
      if (rate > best) best = rate;
    }
  return peak = best;
}
