/* The frames of a body: those of the measure's rule, those in use, and how far two sets differ. */
#include "kernel.h"

/* What the loops below take. */
typedef struct frames_work {
  const solid *body;
  nodal_field u, v;
  block_mat3 *R;
  block_vec3 *spin;
  const block_mat3 *A, *B; /* to compare */
} frames_work;

static int find_chunk(const void *of, solid_state *s, int chunk) {
  const frames_work *w = of;
  (void)s;
  return corot_kernel_frames(w->body, w->u, chunk, w->R);
}

corot_status corot_solid_frames(const solid *body, solid_state *s, nodal_field u, block_mat3 *R) {
  const frames_work w = {.body = body, .u = u, .R = R};
  return corot_solid_each(body, s, find_chunk, &w);
}

/* The points of the blocks of a chunk. */
static int first_point(const solid *body, int chunk) {
  return chunk_start(chunk) * body->elements.kind->npoint;
}

static int end_point(const solid *body, int chunk) {
  return chunk_end(body, chunk) * body->elements.kind->npoint;
}

static int turn_chunk(const void *of, solid_state *s, int chunk) {
  const frames_work *w = of;
  const frame_source *f = &s->frames;
  for (int k = first_point(w->body, chunk); k < end_point(w->body, chunk); k++)
    w->R[k] =
        f->kind == COROT_FRAMES_EXTRAPOLATED ? rotate_by(f->spin[k], f->age, f->R[k]) : f->R[k];
  return -1;
}

corot_status corot_solid_frames_in_use(const solid *body, solid_state *s, nodal_field u,
                                       block_mat3 *R) {
  const frames_work w = {.body = body, .R = R};
  if (s->frames.kind == COROT_FRAMES_EXACT) return corot_solid_frames(body, s, u, R);
  return corot_solid_each(body, s, turn_chunk, &w);
}

static int spin_chunk(const void *of, solid_state *s, int chunk) {
  const frames_work *w = of;
  double *largest = s->chunk_sum[chunk];
  int tet = corot_kernel_spin(w->body, w->u, w->v, chunk, w->spin);
  *largest = 0;
  for (int k = first_point(w->body, chunk); k < end_point(w->body, chunk) && tet < 0; k++) {
    vd w2 = vec3_dot(w->spin[k], w->spin[k]);
    for (int l = 0; l < W; l++) *largest = fmax(*largest, w2[l]);
  }
  return tet;
}

corot_status corot_solid_spin(const solid *body, solid_state *s, nodal_field u, nodal_field v,
                              double *spin_max) {
  const frames_work w = {.body = body, .u = u, .v = v, .spin = s->spin};
  double square = 0;
  COROT_TRY(corot_solid_each(body, s, spin_chunk, &w));
  for (int c = 0; c < body->pattern.nchunk; c++) square = fmax(square, s->chunk_sum[c][0]);
  *spin_max = sqrt(square);
  return COROT_OK;
}

/* |A - B| = sqrt(8) sin of half the angle, which keeps its digits where the angle is small. */
static double angle_between(const block_mat3 *A, const block_mat3 *B, int lane) {
  double square = 0;
  EACH_IJ {
    double d = A->m[i][j][lane] - B->m[i][j][lane];
    square += d * d;
  }
  return 2 * asin(fmin(1, sqrt(square / 8)));
}

static int compare_chunk(const void *of, solid_state *s, int chunk) {
  const frames_work *w = of;
  int npoint = w->body->elements.kind->npoint;
  chunk_angles *a = &s->chunk_angles[chunk];
  *a = (chunk_angles){0};
  for (int k = first_point(w->body, chunk); k < end_point(w->body, chunk); k++)
    for (int l = 0; l < w->body->elements.block[k / npoint].n; l++) {
      double angle = angle_between(&w->A[k], &w->B[k], l);
      a->sum += angle;
      if (angle > a->most) a->most = angle, a->element = k / npoint * W + l;
    }
  return -1;
}

void corot_solid_compare_frames(const solid *body, solid_state *s, const block_mat3 *A,
                                const block_mat3 *B, corot_frames_change *change) {
  const frames_work w = {.body = body, .A = A, .B = B};
  double sum = 0;
  corot_solid_each(body, s, compare_chunk, &w);
  for (int c = 0; c < body->pattern.nchunk; c++) {
    const chunk_angles *a = &s->chunk_angles[c];
    sum += a->sum;
    if (a->most <= change->angle_max) continue;
    change->angle_max = a->most;
    change->angle_tet = body->elements.number[a->element];
  }
  change->angle_mean = sum / ((double)body->mesh->ntet * body->elements.kind->npoint);
}
