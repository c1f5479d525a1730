/* What the parts of a hierarchical model need in a run. */
#include <stdlib.h>

#include "core/levels.h"

static corot_status fill(const corot_model *m, levels_state *ls) {
  const levels *l = m->levels;
  COROT_TRY(corot_state_create(l->coarse, &ls->coarse));
  COROT_TRY(corot_state_create(l->linear, &ls->linear));
  if (l->framer == l->linear)
    ls->framer = ls->linear;
  else
    COROT_TRY(corot_state_create(l->framer, &ls->framer));
  COROT_TRY(corot_state_allow_turning(l->framer, ls->framer));

  int n = l->framer->ndof, nblock = l->coarse->pattern.nblock;
  ls->nnode = l->framer->mesh->nnode;
  ls->u = calloc(6 * (size_t)n, sizeof *ls->u);
  ls->K = malloc(2 * (size_t)nblock * sizeof *ls->K);
  if (!ls->u || !ls->K)
    return corot_fail(COROT_ENOMEM, "no memory for the %d nodes of level %d", ls->nnode,
                      l->frame_level);
  ls->v = ls->u + n, ls->du = ls->v + n, ls->dv = ls->du + n, ls->r = ls->dv + n;
  ls->sum = ls->r + n;
  ls->D = ls->K + nblock;
  ls->bytes = 6 * (size_t)n * sizeof *ls->u + 2 * (size_t)nblock * sizeof *ls->K;
  return COROT_OK;
}

corot_status corot_levels_state_create(const corot_model *m, levels_state **state) {
  levels_state *ls = calloc(1, sizeof *ls);
  if (!ls) return corot_fail(COROT_ENOMEM, "no memory for the state of a hierarchy");
  corot_status status = fill(m, ls);
  if (status) {
    corot_levels_state_destroy(ls);
    return status;
  }
  *state = ls;
  return COROT_OK;
}

void corot_levels_state_destroy(levels_state *ls) {
  if (!ls) return;
  if (ls->framer != ls->linear) corot_state_destroy(ls->framer);
  corot_state_destroy(ls->linear);
  corot_state_destroy(ls->coarse);
  free(ls->u);
  free(ls->K);
  free(ls);
}

size_t corot_levels_state_bytes(const levels_state *ls) {
  size_t bytes = sizeof *ls + corot_state_bytes(ls->coarse) + corot_state_bytes(ls->linear);
  if (ls->framer != ls->linear) bytes += corot_state_bytes(ls->framer);
  return bytes + ls->bytes;
}

void corot_levels_use(levels_state *ls, corot_frames frames) {
  ls->frames = ls->coarse->frames = ls->linear->frames = ls->framer->frames = frames;
}

void corot_levels_stand_still(levels_state *ls) {
  corot_state_stand_still(ls->coarse, 0, 0);
  corot_state_stand_still(ls->linear, 0, 0);
  corot_state_stand_still(ls->framer, 0, 0);
}
