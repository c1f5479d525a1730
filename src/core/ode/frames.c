/* Held and extrapolated frames: their update, and how far they have drifted since. */
#include "core/solid/kernel.h"
#include "core/system/levels.h"

/* Largest and mean angle between two sets of frames: |A - B| = sqrt(8) sin of half the angle, which
   keeps its digits where the angle is small. */
static void compare(const corot_model *m, const mat3 *A, const mat3 *B,
                    corot_frames_change *change) {
  double sum = 0;
  for (int b = 0; b < m->tets.nblock; b++)
    for (int l = 0; l < m->tets.block[b].ntet; l++) {
      double square = 0;
      EACH_IJ {
        double d = A[b].m[i][j][l] - B[b].m[i][j][l];
        square += d * d;
      }
      double angle = 2 * asin(fmin(1, sqrt(square / 8)));
      sum += angle;
      if (angle > change->angle_max) {
        change->angle_max = angle;
        change->angle_tet = m->tets.number[b * W + l];
      }
    }
  change->angle_mean = sum / m->mesh->ntet;
}

/* Elastic energy with the frames R in place of those in use. */
static corot_status energy_with(const corot_model *m, corot_state *s, mat3 *R, double *energy) {
  corot_frames frames = s->frames;
  mat3 *held = s->R;
  double power;
  s->frames = COROT_FRAMES_HELD;
  s->R = R;
  corot_kernel_dilatation(m, s);
  int tet = corot_kernel_energy(m, s, false, energy, &power);
  s->frames = frames;
  s->R = held;
  return corot_state_check(s, tet);
}

/* s->new_R becomes the frames of u; the change is from those in use at t to them. */
static corot_status find_new(const corot_model *m, corot_state *s, double t, const double *u,
                             corot_frames_change *change) {
  corot_frames_change c = {0};
  double before, after;
  corot_state_displace(m, s, t, u);
  COROT_TRY(corot_state_check(s, corot_kernel_frames(m, s, s->new_R)));
  if (!change) return COROT_OK;
  mat3 *now = s->R;
  if (s->frames == COROT_FRAMES_EXTRAPOLATED) {
    now = s->now_R;
    for (int b = 0; b < m->tets.nblock; b++) now[b] = rotate_by(s->spin[b], s->elapsed, s->R[b]);
  }
  compare(m, now, s->new_R, &c);
  COROT_TRY(energy_with(m, s, now, &before));
  COROT_TRY(energy_with(m, s, s->new_R, &after));
  c.energy = after - before;
  *change = c;
  return COROT_OK;
}

corot_status corot_frames_drift(const corot_model *m, corot_state *s, double t, const double *u,
                                corot_frames_change *drift) {
  if (!m->levels) return find_new(m, s, t, u, drift);
  corot_state_displace(m, s, t, u);
  return corot_levels_frames_drift(m, s, t, drift);
}

corot_status corot_frames_update(const corot_model *m, corot_state *s, double t, const double *u,
                                 corot_frames_change *change) {
  if (m->levels) {
    corot_state_displace(m, s, t, u);
    return corot_levels_frames_update(m, s, t, change);
  }
  COROT_TRY(find_new(m, s, t, u, change));
  mat3 *old = s->R;
  s->R = s->new_R;
  s->new_R = old;
  s->t_update = t;
  memset(s->spin, 0, m->tets.nblock * sizeof *s->spin);
  return COROT_OK;
}

corot_status corot_frames_spin(const corot_model *m, corot_state *s, double t, const double *u,
                               const double *v, double *spin_max) {
  double square = 0;
  corot_state_displace(m, s, t, u);
  corot_model_velocity(m, s->phase, t, v, s->v[0], 4);
  if (m->levels) return corot_levels_frames_spin(m, s, t, spin_max);
  COROT_TRY(corot_state_check(s, corot_kernel_spin(m, s, s->spin)));
  for (int b = 0; b < m->tets.nblock; b++) {
    vd w2 = vec3_dot(s->spin[b], s->spin[b]);
    for (int l = 0; l < W; l++) square = fmax(square, w2[l]);
  }
  if (spin_max) *spin_max = sqrt(square);
  return COROT_OK;
}
