#include "timing.h"

#include <stdlib.h>

#include "app/run/run_clock.h"

static int ascending(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

timing timing_summary(int n, double *sample) {
  qsort(sample, n, sizeof *sample, ascending);
  return (timing){.median = n % 2 ? sample[n / 2] : 0.5 * (sample[n / 2 - 1] + sample[n / 2]),
                  .min = sample[0],
                  .spread = sample[3 * n / 4] - sample[n / 4]};
}

static corot_status batch(piece_of_work *work, void *data, int ncall, double *seconds) {
  double start = cpu_clock();
  for (int i = 0; i < ncall; i++) COROT_TRY(work(data));
  *seconds = cpu_clock() - start;
  return COROT_OK;
}

corot_status timing_of(piece_of_work *work, void *data, timing *out) {
  enum { FEWEST = 3, MOST = 40 };
  const double shortest = 2e-4, budget = 0.5, patience = 2;
  double sample[MOST], seconds;
  int ncall = 1, n = 0;
  COROT_TRY(batch(work, data, ncall, &seconds));
  while (seconds < shortest) {
    ncall *= 2;
    COROT_TRY(batch(work, data, ncall, &seconds));
  }
  for (double spent = 0; (n < FEWEST && spent < patience) || (n < MOST && spent < budget); n++) {
    COROT_TRY(batch(work, data, ncall, &seconds));
    spent += seconds;
    sample[n] = seconds / ncall;
  }
  *out = timing_summary(n, sample);
  return COROT_OK;
}
