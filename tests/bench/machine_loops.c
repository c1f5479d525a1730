/* What a machine can do at best, compiled once for each instruction set as the kernels are, with
   COROT_KERNELS behind the names. */
#include "machine_loops.h"

void machine_triad(size_t n, double *a, const double *b, const double *c, double s) {
  vd *x = (vd *)a;
  const vd *y = (const vd *)b, *z = (const vd *)c;
  for (size_t i = 0; i < n / LANES; i++) x[i] = y[i] + s * z[i];
}

double machine_total(size_t n, const double *a) {
  const vd *x = (const vd *)a;
  vd sum[8] = {{0}};
  for (size_t i = 0; i < n / LANES; i += 8)
    for (int k = 0; k < 8; k++) sum[k] += x[i + k];
  for (int k = 1; k < 8; k++) sum[0] += sum[k];
  return vd_sum(sum[0]);
}

/* Few enough chains to stay in registers, many enough to keep every unit busy. */
enum { ROUNDS = 10000 };

#define CHAINS(n)                                                  \
  static double chains_##n(double factor) {                        \
    vd x[n], sum = {0};                                            \
    for (int k = 0; k < (n); k++) x[k] = sum + k;                  \
    for (int i = 0; i < ROUNDS; i++)                               \
      for (int k = 0; k < (n); k++) x[k] = x[k] * factor + factor; \
    for (int k = 0; k < (n); k++) sum += x[k];                     \
    return vd_sum(sum);                                            \
  }
CHAINS(8)
CHAINS(10)
CHAINS(12)
CHAINS(24)

double machine_chains(int k, double factor, double *result) {
  static const struct {
    int n;
    double (*run)(double factor);
  } loop[MACHINE_CHAINS] = {{8, chains_8}, {10, chains_10}, {12, chains_12}, {24, chains_24}};
  *result = loop[k].run(factor);
  return 2.0 * LANES * loop[k].n * ROUNDS;
}
