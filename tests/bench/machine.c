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

static volatile double sink; /* so that no loop is dropped */

static COROT_CLONES void triad(size_t n, vd *a, const vd *b, const vd *c, double s) {
  for (size_t i = 0; i < n; i++) a[i] = b[i] + s * c[i];
}

/* A multiple of eight vectors, in as many chains of additions. */
static COROT_CLONES double total(size_t n, const vd *a) {
  vd sum[8] = {{0}};
  for (size_t i = 0; i < n; i += 8)
    for (int k = 0; k < 8; k++) sum[k] += a[i + k];
  for (int k = 1; k < 8; k++) sum[0] += sum[k];
  return vd_sum(sum[0]);
}

double machine_bandwidth(size_t bytes) {
  size_t n = (bytes / (3 * sizeof(vd)) + 1 + 7) / 8 * 8, size = n * sizeof(vd);
  vd *a = aligned_alloc(sizeof(vd), 3 * size), *b = a + n, *c = b + n;
  if (!a) return 0;
  memset(a, 0, 3 * size);
  int nsweep = (int)(2e6 / size) + 1; /* at least some 0.1 ms */
  double best = 0;
  for (int k = 0; k < 24; k++) {
    double start = cpu_clock();
    for (int i = 0; i < nsweep; i++)
      if (k % 2)
        sink = total(3 * n, a);
      else
        triad(n, a, b, c, 1e-3 * i);
    double rate = (double)nsweep * 3 * size / (cpu_clock() - start);
    if (rate > best) best = rate;
  }
  free(a);
  return best;
}

/* Fused multiply-adds in independent chains: few enough to stay in registers, many enough to keep
   every unit busy. How many that is depends on the instruction set, and so does the width of the
   vectors: wider ones than it has are taken apart, and wait in memory. So all are tried. */
enum { ROUNDS = 10000 };

#define CHAINS(nlane, n)                                             \
  static COROT_CLONES double chains_##nlane##_##n(double factor) {   \
    typedef double vector __attribute__((vector_size(8 * (nlane)))); \
    vector x[n], sum = {0};                                          \
    for (int k = 0; k < (n); k++) x[k] = sum + k;                    \
    for (int i = 0; i < ROUNDS; i++)                                 \
      for (int k = 0; k < (n); k++) x[k] = x[k] * factor + factor;   \
    for (int k = 0; k < (n); k++) sum += x[k];                       \
    return sum[0] + sum[(nlane)-1];                                  \
  }
#define EACH_CHAINS(row) row(2, 6) row(2, 12) row(4, 6) row(4, 12) row(8, 6) row(8, 12) row(8, 24)
EACH_CHAINS(CHAINS)

static double peak = 0; /* until it is measured */

void machine_set_peak(double flops) { peak = flops; }

double machine_peak(void) {
#define ROW(nlane, n) {(nlane) * (n), chains_##nlane##_##n},
  static const struct {
    int width; /* multiply-adds a round */
    double (*run)(double factor);
  } loop[] = {EACH_CHAINS(ROW)};
#undef ROW
  if (peak > 0) return peak;
  double best = 0;
  for (int repeat = 0; repeat < 20; repeat++)
    for (size_t k = 0; k < sizeof loop / sizeof *loop; k++) {
      double start = cpu_clock();
      sink = loop[k].run(0.5);
      double rate = 2.0 * loop[k].width * ROUNDS / (cpu_clock() - start);
      if (rate > best) best = rate;
    }
  return peak = best;
}
