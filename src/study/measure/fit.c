/* A line through logarithms, and whether it is worth its name. */
#include "fit.h"

#include <math.h>
#include <stdio.h>

power_fit fit_power(int n, const double *tolerance, const double *error) {
  power_fit f = {.n = n, .exponent = NAN, .constant = NAN, .residual = NAN};
  double mean_x = 0, mean_y = 0, xx = 0, xy = 0, square = 0;
  for (int i = 0; i < n; i++) {
    mean_x += log10(tolerance[i]) / n;
    mean_y += log10(error[i]) / n;
  }
  for (int i = 0; i < n; i++) {
    double x = log10(tolerance[i]) - mean_x;
    xx += x * x;
    xy += x * (log10(error[i]) - mean_y);
  }
  if (n < 2 || !(xx > 0)) return f;
  f.exponent = xy / xx;
  f.constant = pow(10, mean_y - f.exponent * mean_x);
  for (int i = 0; i < n; i++) {
    double off = log10(error[i]) - mean_y - f.exponent * (log10(tolerance[i]) - mean_x);
    square += off * off;
  }
  f.residual = sqrt(square / n);
  return f;
}

void fit_verdict(const power_fit *f, bool is_tolerance, size_t size, char *words) {
  if (f->n < 3 || isnan(f->exponent)) {
    snprintf(words, size, "too few points to say: %d", f->n);
    return;
  }
  const char *how = f->residual > 0.3 ? ", irregular" : ""; /* by a factor of two */
  if (!is_tolerance)
    snprintf(words, size, "order %.2f%s", f->exponent, how);
  else if (fabs(f->exponent - 1) <= 0.2)
    snprintf(words, size, "proportional%s", how);
  else if (f->exponent <= 0.2)
    snprintf(words, size, "does not follow the tolerance%s", how);
  else
    snprintf(words, size, "falls %s than the tolerance%s", f->exponent < 1 ? "slower" : "faster",
             how);
}
