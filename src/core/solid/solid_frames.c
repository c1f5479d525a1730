/* The frames of a body: those of the measure's rule, those in use, and how far two sets differ. */
#include "kernel.h"

corot_status corot_solid_frames(const solid *body, solid_state *s, nodal_field u, block_mat3 *R) {
  return corot_solid_check(s, corot_kernel_frames(body, u, R));
}

corot_status corot_solid_frames_in_use(const solid *body, solid_state *s, nodal_field u,
                                       block_mat3 *R) {
  const frame_source *f = &s->frames;
  if (f->kind == COROT_FRAMES_EXACT) return corot_solid_frames(body, s, u, R);
  for (int k = 0; k < points_of(&body->elements); k++)
    R[k] = f->kind == COROT_FRAMES_EXTRAPOLATED ? rotate_by(f->spin[k], f->age, f->R[k]) : f->R[k];
  return COROT_OK;
}

corot_status corot_solid_spin(const solid *body, solid_state *s, nodal_field u, nodal_field v,
                              double *spin_max) {
  double square = 0;
  COROT_TRY(corot_solid_check(s, corot_kernel_spin(body, u, v, s->spin)));
  for (int k = 0; k < points_of(&body->elements); k++) {
    vd w2 = vec3_dot(s->spin[k], s->spin[k]);
    for (int l = 0; l < W; l++) square = fmax(square, w2[l]);
  }
  *spin_max = sqrt(square);
  return COROT_OK;
}

/* |A - B| = sqrt(8) sin of half the angle, which keeps its digits where the angle is small. */
void corot_solid_compare_frames(const solid *body, const block_mat3 *A, const block_mat3 *B,
                                corot_frames_change *change) {
  int npoint = body->elements.kind->npoint;
  double sum = 0;
  for (int k = 0; k < points_of(&body->elements); k++)
    for (int l = 0; l < body->elements.block[k / npoint].n; l++) {
      double square = 0;
      EACH_IJ {
        double d = A[k].m[i][j][l] - B[k].m[i][j][l];
        square += d * d;
      }
      double angle = 2 * asin(fmin(1, sqrt(square / 8)));
      sum += angle;
      if (angle > change->angle_max) {
        change->angle_max = angle;
        change->angle_tet = body->elements.number[k / npoint * W + l];
      }
    }
  change->angle_mean = sum / ((double)body->mesh->ntet * npoint);
}
