/* Held frames: those of the terms that have their own, which change together. */
#include "core/solid/kernel.h"
#include "system.h"

static bool has_own(const solid_system *y, int k) { return y->term[k].frames_from < 0; }

/* The term whose angles are told: the leader; without one, the only term. */
static int judged(const solid_system *y) { return y->leader < 0 ? 0 : y->leader; }

/* new_R of each term = the frames of u. */
static corot_status find_new(const solid_system *y, system_state *s, const term_fields *all) {
  for (int k = 0; k < y->nterm; k++) {
    if (!has_own(y, k)) continue;
    term_fields f = corot_system_seen(y, s, k, all);
    solid_state *of = &s->of[k];
    COROT_TRY(corot_system_told(y, s, k, corot_solid_frames(&y->term[k].body, of, f.u, of->new_R)));
  }
  return COROT_OK;
}

/* The held frames of each term as they are now: turned on, if they are extrapolated. */
static void give_old(const solid_system *y, system_state *s) {
  for (int k = 0; k < y->nterm; k++) {
    solid_state *of = &s->of[k];
    if (!has_own(y, k)) continue;
    of->frames.kind = s->frames == COROT_FRAMES_EXTRAPOLATED ? s->frames : COROT_FRAMES_HELD;
    if (s->frames != COROT_FRAMES_EXTRAPOLATED) continue;
    for (int b = 0; b < points_of(&y->term[k].body.elements); b++)
      of->now_R[b] = rotate_by(of->spin[b], of->frames.age, of->R[b]);
    of->frames = (frame_source){.kind = COROT_FRAMES_HELD, .R = of->now_R};
  }
}

static void give_new(const solid_system *y, system_state *s) {
  for (int k = 0; k < y->nterm; k++)
    if (has_own(y, k))
      s->of[k].frames = (frame_source){.kind = COROT_FRAMES_HELD, .R = s->of[k].new_R};
}

/* The change from the old frames to the new ones, both of which are there. */
static corot_status measure(const solid_system *y, system_state *s, const term_fields *all,
                            corot_frames_change *change) {
  const term *t = &y->term[judged(y)];
  const solid_state *of = &s->of[judged(y)];
  corot_frames_change c = {0};
  double before, after, power;
  give_old(y, s);
  corot_solid_compare_frames(&t->body, &s->of[judged(y)], of->frames.R, of->new_R, &c);
  c.angle_tet *= t->below;
  COROT_TRY(corot_system_sum_energy(y, s, all, &before, &power));
  give_new(y, s);
  COROT_TRY(corot_system_sum_energy(y, s, all, &after, &power));
  c.energy = after - before;
  *change = c;
  return COROT_OK;
}

corot_status corot_system_drift(const solid_system *y, system_state *s, double age, nodal_field u,
                                corot_frames_change *change) {
  const term_fields all = {.u = u};
  corot_system_begin(y, s, age, &all);
  COROT_TRY(find_new(y, s, &all));
  return change ? measure(y, s, &all, change) : COROT_OK;
}

corot_status corot_system_update_frames(const solid_system *y, system_state *s, double age,
                                        nodal_field u, corot_frames_change *change) {
  COROT_TRY(corot_system_drift(y, s, age, u, change)); /* nothing fails after this */
  for (int k = 0; k < y->nterm; k++) {
    solid_state *of = &s->of[k];
    if (!has_own(y, k)) continue;
    mat3 *old = of->R;
    of->R = of->new_R;
    of->new_R = old;
    memset(of->spin, 0, points_of(&y->term[k].body.elements) * sizeof *of->spin);
  }
  return COROT_OK;
}

corot_status corot_system_spin(const solid_system *y, system_state *s, double age, nodal_field u,
                               nodal_field v, double *spin_max) {
  const term_fields all = {.u = u, .v = v};
  double largest;
  corot_system_begin(y, s, age, &all);
  for (int k = 0; k < y->nterm; k++) {
    if (!has_own(y, k)) continue;
    term_fields f = corot_system_seen(y, s, k, &all);
    corot_status status = corot_solid_spin(&y->term[k].body, &s->of[k], f.u, f.v, &largest);
    COROT_TRY(corot_system_told(y, s, k, status));
    if (k == judged(y)) *spin_max = largest;
  }
  return COROT_OK;
}
