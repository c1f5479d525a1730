/* From elements to nodes: the kernels chunk by chunk, and the sums of their forces. */
#include <math.h>

#include "kernel.h"

corot_status corot_solid_check(solid_state *s, int tet) {
  s->inverted = tet;
  if (tet < 0) return COROT_OK;
  return corot_fail(COROT_RETRY, "tet %d is inverted", tet);
}

corot_status corot_solid_collect(const solid *body, solid_state *s, int tet, int chunk,
                                 force_sum *sum) {
  const double *force = (const double *)s->force;
  const int *begin = body->pattern.first, *slot = body->pattern.slot, *due = body->pattern.due;
  double *r = sum->r, check = 0;
  COROT_TRY(corot_solid_check(s, tet));
  for (int at = due[chunk]; at < due[chunk + 1]; at++) {
    int n = body->pattern.turn[at];
    if (n < sum->from) continue;
    double f[3] = {0, 0, 0};
    for (int k = begin[n]; k < begin[n + 1]; k++)
      for (int c = 0; c < 3; c++) f[c] += force[slot[k] + c * W];
    for (int c = 0; c < 3; c++) {
      int i = sum->row ? sum->row[n][c] : 4 * n + c;
      if (i >= 0) check += r[i] += sum->sign * f[c];
    }
  }
  sum->check += check;
  return COROT_OK;
}

corot_status corot_force_sum_check(const force_sum *sum) {
  if (isfinite(sum->check)) return COROT_OK;
  return corot_fail(COROT_RETRY, "the forces exceed double precision");
}

corot_status corot_solid_force(const solid *body, solid_state *s, nodal_field u, nodal_field v,
                               force_sum *sum) {
  corot_kernel_dilatation(body, s, u);
  for (int c = 0; c < body->pattern.nchunk; c++)
    COROT_TRY(corot_solid_collect(body, s, corot_kernel_force(body, s, u, v, c), c, sum));
  return corot_force_sum_check(sum);
}

corot_status corot_solid_derivative(const solid *body, solid_state *s, nodal_field u, nodal_field v,
                                    nodal_field du, nodal_field dv, bool exact, force_sum *sum) {
  corot_kernel_dilatation(body, s, u);
  corot_kernel_dilatation_change(body, s, u, du, exact);
  for (int c = 0; c < body->pattern.nchunk; c++) {
    int tet = corot_kernel_derivative(body, s, u, v, du, dv, exact, c);
    COROT_TRY(corot_solid_collect(body, s, tet, c, sum));
  }
  return corot_force_sum_check(sum);
}

corot_status corot_solid_matrices(const solid *body, solid_state *s, nodal_field u,
                                  corot_tangent tangent, double (*K)[9], double (*D)[9]) {
  corot_kernel_dilatation(body, s, u);
  for (int c = 0; c < body->pattern.nchunk; c++)
    COROT_TRY(corot_solid_check(s, corot_kernel_tangent(body, s, u, tangent, c, K, D)));
  if (K) corot_kernel_dilatation_tangent(body, s, K);
  return COROT_OK;
}

corot_status corot_solid_energy(const solid *body, solid_state *s, nodal_field u, nodal_field v,
                                double *elastic, double *power) {
  corot_kernel_dilatation(body, s, u);
  return corot_solid_check(s, corot_kernel_energy(body, s, u, v, elastic, power));
}

corot_status corot_solid_internal(const solid *body, solid_state *s, nodal_field u, int strain,
                                  double lambda_part, double mu_part, force_sum *sum) {
  corot_kernel_internal_dilatation(body, s, u, strain);
  for (int c = 0; c < body->pattern.nchunk; c++) {
    int tet = corot_kernel_internal(body, s, u, strain, lambda_part, mu_part, c);
    COROT_TRY(corot_solid_collect(body, s, tet, c, sum));
  }
  return COROT_OK;
}
