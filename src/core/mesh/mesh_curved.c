/* The map of a ten-node tet: X(l) = sum_a l_a (2 l_a - 1) x_a + sum_ab 4 l_a l_b x_ab. */
#include "mesh.h"

const int corot_tet_edge[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};

void corot_curved_slopes(const double (*x)[3], const int v[4], const int mid[6], const double at[4],
                         double slope[4][3]) {
  const double *origin = x[v[0]];
  for (int a = 0; a < 4; a++)
    for (int i = 0; i < 3; i++) slope[a][i] = (4 * at[a] - 1) * (x[v[a]][i] - origin[i]);
  for (int k = 0; k < 6; k++) {
    int a = corot_tet_edge[k][0], b = corot_tet_edge[k][1];
    for (int i = 0; i < 3; i++) {
      double middle = x[mid[k]][i] - origin[i];
      slope[a][i] += 4 * at[b] * middle;
      slope[b][i] += 4 * at[a] * middle;
    }
  }
}

double corot_curved_determinant(const double (*x)[3], const int v[4], const int mid[6],
                                const double at[4]) {
  double s[4][3], a[3], b[3], c[3];
  corot_curved_slopes(x, v, mid, at, s);
  for (int i = 0; i < 3; i++) {
    a[i] = s[1][i] - s[0][i];
    b[i] = s[2][i] - s[0][i];
    c[i] = s[3][i] - s[0][i];
  }
  return (a[1] * b[2] - a[2] * b[1]) * c[0] + (a[2] * b[0] - a[0] * b[2]) * c[1] +
         (a[0] * b[1] - a[1] * b[0]) * c[2];
}

/* The determinant is a cubic, of which five points are enough (Zienkiewicz and Taylor, The finite
   element method, vol. 1): the centre with the weight -4/5 and four with 9/20 each. */
double corot_curved_volume(const double (*x)[3], const int v[4], const int mid[6]) {
  const double centre[4] = {0.25, 0.25, 0.25, 0.25};
  double sum = -0.8 * corot_curved_determinant(x, v, mid, centre);
  for (int k = 0; k < 4; k++) {
    double at[4] = {1.0 / 6, 1.0 / 6, 1.0 / 6, 1.0 / 6};
    at[k] = 0.5;
    sum += 0.45 * corot_curved_determinant(x, v, mid, at);
  }
  return sum / 6;
}
