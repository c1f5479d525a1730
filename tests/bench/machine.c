#include "machine.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/run/run_clock.h"
#include "core/lanes/simd.h"

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

static COROT_CLONES void triad(size_t n, vd *a, const vd *b, const vd *c, double s) {
  for (size_t i = 0; i < n; i++) a[i] = b[i] + s * c[i];
}

double machine_bandwidth(size_t bytes) {
  size_t n = bytes / (3 * sizeof(vd)) + 1, size = n * sizeof(vd);
  vd *a = aligned_alloc(sizeof(vd), 3 * size), *b = a + n, *c = b + n;
  if (!a) return 0;
  memset(a, 0, 3 * size);
  int nsweep = (int)(2e6 / size) + 1; /* at least some 0.1 ms */
  double best = 0;
  for (int k = 0; k < 12; k++) {
    double start = cpu_clock();
    for (int i = 0; i < nsweep; i++) triad(n, a, b, c, 1e-3 * i);
    double rate = (double)nsweep * 3 * size / (cpu_clock() - start);
    if (rate > best) best = rate;
  }
  free(a);
  return best;
}

/* Fused multiply-adds in n independent chains: few enough to stay in registers, many enough to keep
   every unit busy. How many that is depends on the instruction set. */
enum { MOST_CHAINS = 12, ROUNDS = 10000 };

COROT_INLINE double chains(int n, double factor) {
  vd x[MOST_CHAINS], sum = vd_all(0);
  for (int k = 0; k < n; k++) x[k] = vd_all(k);
  for (int i = 0; i < ROUNDS; i++)
    for (int k = 0; k < n; k++) x[k] = x[k] * factor + factor;
  for (int k = 0; k < n; k++) sum += x[k];
  return vd_sum(sum);
}

static COROT_CLONES double three_chains(double factor) { return chains(3, factor); }
static COROT_CLONES double six_chains(double factor) { return chains(6, factor); }
static COROT_CLONES double twelve_chains(double factor) { return chains(MOST_CHAINS, factor); }

static volatile double sink; /* so that the loops are not dropped */

double machine_peak(void) {
  static const struct {
    int n;
    double (*run)(double factor);
  } loop[] = {{3, three_chains}, {6, six_chains}, {MOST_CHAINS, twelve_chains}};
  static double best = 0;
  if (best > 0) return best;
  for (int repeat = 0; repeat < 20; repeat++)
    for (int k = 0; k < 3; k++) {
      double start = cpu_clock();
      sink = loop[k].run(0.5);
      double rate = 2.0 * W * loop[k].n * ROUNDS / (cpu_clock() - start);
      if (rate > best) best = rate;
    }
  return best;
}
