/* Held frames of a hierarchical model: those of its parts, which change together. */
#include "levels.h"

typedef struct part {
  const corot_model *model;
  corot_state *state;
  const level_fields *fields;
} part;

/* The parts with frames of their own; the framer comes last. Returns how many there are. */
static int list_parts(const corot_model *m, const corot_state *s, part parts[3]) {
  const levels *l = m->levels;
  const levels_state *ls = s->levels;
  parts[0] = (part){l->coarse, ls->coarse, &ls->on_coarse};
  parts[1] = (part){l->linear, ls->linear, &ls->on_coarse};
  parts[2] = (part){l->framer, ls->framer, &ls->on_framer};
  return l->framer == l->linear ? 2 : 3;
}

static corot_status energy_with(const corot_model *m, corot_state *s, double t, corot_frames frames,
                                double *energy) {
  corot_frames before = s->levels->frames;
  double power;
  corot_levels_use(s->levels, frames);
  corot_status status = corot_levels_energy(m, s, t, false, energy, &power);
  corot_levels_use(s->levels, before);
  return status;
}

/* The angles are the framer's, the largest one named by the first descendant of its tet. */
corot_status corot_levels_frames_drift(const corot_model *m, corot_state *s, double t,
                                       corot_frames_change *drift) {
  const levels *l = m->levels;
  corot_frames old = s->levels->frames;
  if (old == COROT_FRAMES_EXACT) old = COROT_FRAMES_HELD;
  part parts[3];
  int n = list_parts(m, s, parts);
  corot_frames_change change = {0};
  double before, after;

  COROT_TRY(energy_with(m, s, t, COROT_FRAMES_EXACT, &after)); /* coarsens the displacement */
  for (int k = 0; k < n; k++)
    COROT_TRY(corot_frames_drift(parts[k].model, parts[k].state, t, parts[k].fields->u, &change));
  COROT_TRY(energy_with(m, s, t, old, &before));
  if (!drift) return COROT_OK;
  change.angle_tet <<= 3 * (l->nlevel - l->frame_level);
  change.energy = after - before;
  *drift = change;
  return COROT_OK;
}

corot_status corot_levels_frames_update(const corot_model *m, corot_state *s, double t,
                                        corot_frames_change *change) {
  part parts[3];
  int n = list_parts(m, s, parts);
  COROT_TRY(corot_levels_frames_drift(m, s, t, change)); /* nothing fails after this */
  for (int k = 0; k < n; k++)
    COROT_TRY(corot_frames_update(parts[k].model, parts[k].state, t, parts[k].fields->u, NULL));
  return COROT_OK;
}

corot_status corot_levels_frames_spin(const corot_model *m, corot_state *s, double t,
                                      double *spin_max) {
  levels_state *ls = s->levels;
  part parts[3];
  int n = list_parts(m, s, parts);
  const level_fields *c = &ls->on_coarse, *f = &ls->on_framer;
  corot_levels_coarsen(m->levels, (const double(*)[4])s->u, c->u, f->u);
  corot_levels_coarsen(m->levels, (const double(*)[4])s->v, c->v, f->v);
  for (int k = 0; k < n; k++)
    COROT_TRY(corot_frames_spin(parts[k].model, parts[k].state, t, parts[k].fields->u,
                                parts[k].fields->v, spin_max));
  return COROT_OK;
}
