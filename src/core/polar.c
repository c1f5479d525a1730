#include "core/polar.h"

corot_status corot_polar(const double F[9], double R[9]) {
  double largest = 0;
  for (int k = 0; k < 9; k++) largest = fmax(largest, fabs(F[k]));
  double scaled[9];
  for (int k = 0; k < 9; k++) scaled[k] = largest > 0 ? F[k] / largest : 0;

  vi inverted;
  mat3 X = polar(mat3_load(scaled), &inverted);
  if (inverted[0]) return corot_fail(COROT_RETRY, "polar: det F is not positive");
  mat3_store(X, 0, R);
  return COROT_OK;
}
