/* The polar factor of a single matrix, for callers that have no lanes. */
#include "polar.h"

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

corot_status corot_polar_2d(const double J[4], double R[4]) {
  double det = J[0] * J[3] - J[1] * J[2], sign = det > 0 ? 1 : -1;
  if (!(fabs(det) > 0)) return corot_fail(COROT_RETRY, "polar: the matrix is singular");
  double a[4] = {J[0] + sign * J[3], J[1] - sign * J[2], J[2] - sign * J[1], J[3] + sign * J[0]};
  double first = hypot(a[0], a[2]), second = hypot(a[1], a[3]);
  R[0] = a[0] / first, R[2] = a[2] / first;
  R[1] = a[1] / second, R[3] = a[3] / second;
  return COROT_OK;
}
