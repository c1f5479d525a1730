/* What the parts of a hierarchical model need in a run. */
#include <stdlib.h>

#include "core/mesh/mesh.h"
#include "levels.h"

static corot_status allocate_fields(int n, level_fields *f) {
  double *x = calloc(5 * (size_t)n, sizeof *x);
  if (!x) return corot_fail(COROT_ENOMEM, "no memory for the %d nodes of a level", n / 3);
  *f = (level_fields){x, x + n, x + 2 * n, x + 3 * n, x + 4 * n};
  return COROT_OK;
}

/* Arrays and their bytes. */
static corot_status allocate(const corot_model *m, levels_state *ls) {
  const levels *l = m->levels;
  size_t n = l->coarse->ndof, nf = l->framer == l->linear ? 0 : l->framer->ndof;
  size_t nblock = l->place ? l->coarse->pattern.nblock : 0, nnode = m->mesh->nnode;
  COROT_TRY(allocate_fields((int)n, &ls->on_coarse));
  ls->on_framer = ls->on_coarse;
  if (nf) COROT_TRY(allocate_fields((int)nf, &ls->on_framer));
  ls->r = calloc(n, sizeof *ls->r);
  ls->nodal = calloc(nnode, sizeof *ls->nodal);
  size_t nkept = l->coupling == COROT_COUPLING_ONE_WAY ? m->body_ndof : 0;
  COROT_TRY(COROT_ALLOC(ls->kept, nkept));
  if (nblock) ls->K = malloc(2 * nblock * sizeof *ls->K);
  if (!ls->r || !ls->nodal || (nblock && !ls->K))
    return corot_fail(COROT_ENOMEM, "no memory for the forces on %zu nodes", nnode);
  if (nblock) ls->D = ls->K + nblock;
  ls->bytes = (6 * n + 5 * nf + nkept) * sizeof *ls->r + nnode * sizeof *ls->nodal +
              2 * nblock * sizeof *ls->K;
  return COROT_OK;
}

static corot_status fill(const corot_model *m, levels_state *ls) {
  const levels *l = m->levels;
  COROT_TRY(corot_state_create(l->coarse, &ls->coarse));
  COROT_TRY(corot_state_create(l->linear, &ls->linear));
  if (l->framer == l->linear)
    ls->framer = ls->linear;
  else
    COROT_TRY(corot_state_create(l->framer, &ls->framer));
  COROT_TRY(corot_state_allow_turning(l->framer, ls->framer));
  return allocate(m, ls);
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
  if (ls->on_framer.u != ls->on_coarse.u) free(ls->on_framer.u);
  if (ls->framer != ls->linear) corot_state_destroy(ls->framer);
  corot_state_destroy(ls->linear);
  corot_state_destroy(ls->coarse);
  free(ls->on_coarse.u);
  free(ls->r);
  free(ls->nodal);
  free(ls->kept);
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
