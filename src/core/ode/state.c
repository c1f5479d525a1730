/* Memory of a state, and what enters it: frames, displacement, velocity. */
#include "state.h"

#include <stdlib.h>

#include "core/system/levels.h"

static corot_status allocate_averages(const corot_model *m, corot_state *s) {
  int nnode = m->mesh->nnode, nblock = m->tets.nblock, npool = m->dilatation.npool;
  if (!npool) return COROT_OK;
  s->dilatation = corot_vector_calloc(nblock, sizeof *s->dilatation);
  s->dilatation_change = corot_vector_calloc(nblock, sizeof *s->dilatation_change);
  s->slope = corot_vector_calloc(nblock, sizeof *s->slope);
  s->pool = malloc(npool * sizeof *s->pool);
  s->gathered = calloc(nnode, sizeof *s->gathered);
  if (!s->dilatation || !s->dilatation_change || !s->slope || !s->pool || !s->gathered)
    return corot_fail(COROT_ENOMEM, "no memory for a state of %d averages", npool);
  s->npool = npool;
  return COROT_OK;
}

static corot_status allocate(const corot_model *m, corot_state *s) {
  int nnode = m->mesh->nnode, nblock = m->tets.nblock;
  s->u = corot_vector_calloc(nnode, sizeof *s->u);
  s->v = corot_vector_calloc(nnode, sizeof *s->v);
  s->du = corot_vector_calloc(nnode, sizeof *s->du);
  s->dv = corot_vector_calloc(nnode, sizeof *s->dv);
  s->R = corot_vector_calloc(nblock, sizeof *s->R);
  s->new_R = corot_vector_calloc(nblock, sizeof *s->new_R);
  s->now_R = corot_vector_calloc(nblock, sizeof *s->now_R);
  s->spin = corot_vector_calloc(nblock, sizeof *s->spin);
  s->force = corot_vector_calloc(m->pattern.window, sizeof *s->force);
  s->r = calloc(m->ndof, sizeof *s->r);
  if (!s->u || !s->v || !s->du || !s->dv || !s->R || !s->new_R || !s->now_R || !s->spin ||
      !s->force || !s->r)
    return corot_fail(COROT_ENOMEM, "no memory for a state of %d nodes", nnode);
  for (int b = 0; b < nblock; b++) s->R[b] = mat3_identity();
  if (!m->levels) return COROT_OK;
  s->frames = COROT_FRAMES_HELD;
  return corot_levels_state_create(m, &s->levels);
}

corot_status corot_state_allow_turning(const corot_model *m, corot_state *s) {
  int nblock = m->tets.nblock;
  s->dR = corot_vector_calloc(nblock, sizeof *s->dR);
  s->moment = corot_vector_calloc(nblock, sizeof *s->moment);
  s->dmoment = corot_vector_calloc(nblock, sizeof *s->dmoment);
  if (!s->dR || !s->moment || !s->dmoment)
    return corot_fail(COROT_ENOMEM, "no memory for the frames of %d nodes", m->mesh->nnode);
  return COROT_OK;
}

corot_status corot_state_create(const corot_model *m, corot_state **state) {
  corot_state *s = calloc(1, sizeof *s);
  if (!s) return corot_fail(COROT_ENOMEM, "no memory for a state");
  s->inverted = -1;
  s->phase = NAN;
  corot_status status = allocate(m, s);
  if (!status) status = allocate_averages(m, s);
  if (status) {
    corot_state_destroy(s);
    return status;
  }
  s->nnode = m->mesh->nnode;
  s->nblock = m->tets.nblock;
  s->window = m->pattern.window;
  s->ndof = m->ndof;
  *state = s;
  return COROT_OK;
}

void corot_state_destroy(corot_state *s) {
  if (!s) return;
  free(s->u);
  free(s->v);
  free(s->du);
  free(s->dv);
  free(s->R);
  free(s->new_R);
  free(s->now_R);
  free(s->spin);
  free(s->dilatation);
  free(s->dilatation_change);
  free(s->slope);
  free(s->pool);
  free(s->gathered);
  free(s->force);
  free(s->r);
  free(s->dR);
  free(s->moment);
  free(s->dmoment);
  corot_levels_state_destroy(s->levels);
  free(s);
}

size_t corot_state_bytes(const corot_state *s) {
  size_t bytes = sizeof *s + 4 * s->nnode * sizeof *s->u + s->ndof * sizeof *s->r +
                 s->nblock * (3 * sizeof *s->R + sizeof *s->spin) + s->window * sizeof *s->force;
  if (s->npool)
    bytes += s->nblock * (2 * sizeof *s->dilatation + sizeof *s->slope) +
             s->npool * sizeof *s->pool + s->nnode * sizeof *s->gathered;
  if (s->dR) bytes += s->nblock * (sizeof *s->dR + sizeof *s->moment + sizeof *s->dmoment);
  return bytes + (s->levels ? corot_levels_state_bytes(s->levels) : 0);
}

void corot_state_use(corot_state *s, corot_frames frames) {
  if (s->levels)
    corot_levels_use(s->levels, frames);
  else
    s->frames = frames;
}

corot_frames corot_state_frames(const corot_state *s) {
  return s->levels ? s->levels->frames : s->frames;
}

int corot_state_inverted(const corot_state *s) { return s->inverted; }
void corot_state_enter(corot_state *s, double t) { s->phase = t; }

void corot_state_stand_still(corot_state *s, double t, double factor) {
  if (s->levels) corot_levels_stand_still(s->levels);
  s->still = true;
  s->load_time = t;
  s->load_factor = factor;
}

void corot_state_displace(const corot_model *m, corot_state *s, double t, const double *u) {
  s->elapsed = t - s->t_update;
  corot_model_displacement(m, s->phase, t, u, s->u[0], 4);
}

corot_status corot_state_check(corot_state *s, int tet) {
  s->inverted = tet;
  if (tet < 0) return COROT_OK;
  return corot_fail(COROT_RETRY, "tet %d is inverted", tet);
}
