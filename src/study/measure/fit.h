/* How the error follows the tolerance: error = constant * tolerance^exponent, by least squares on
   logarithms. */
#ifndef COROT_STUDY_MEASURE_FIT_H
#define COROT_STUDY_MEASURE_FIT_H

#include <stdbool.h>
#include <stddef.h>

typedef struct power_fit {
  int n; /* points; below two there is no fit, and the rest is NaN */
  double exponent, constant;
  double residual; /* root of the mean square of log10(error) about the line */
} power_fit;

/* tolerance, error: [n] positive. */
power_fit fit_power(int n, const double *tolerance, const double *error);

/* What that means, in words: of a tolerance that is to be proportional to the error, or of a step
   (or interval, ...), whose exponent is an order. */
void fit_verdict(const power_fit *f, bool is_tolerance, size_t size, char *words);

#endif
