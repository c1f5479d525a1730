/* The memory of a system's evaluations: of each term, and of the fields on each map. */
#include <stdlib.h>

#include "core/mesh/mesh.h"
#include "system.h"

static corot_status allocate_fields(int n, map_fields *f) {
  COROT_TRY(COROT_ALLOC(f->u, n));
  COROT_TRY(COROT_ALLOC(f->v, n));
  COROT_TRY(COROT_ALLOC(f->du, n));
  COROT_TRY(COROT_ALLOC(f->dv, n));
  return COROT_ALLOC(f->sum, n);
}

static corot_status allocate_lead(const solid *leader, handing *lead) {
  int npoint = points_of(&leader->elements);
  lead->dR = corot_vector_calloc(npoint, sizeof *lead->dR);
  lead->moment = corot_vector_calloc(npoint, sizeof *lead->moment);
  lead->dmoment = corot_vector_calloc(npoint, sizeof *lead->dmoment);
  if (lead->dR && lead->moment && lead->dmoment) return COROT_OK;
  return corot_fail(COROT_ENOMEM, "no memory for the frames of %d tets", leader->mesh->ntet);
}

/* Blocks of the largest matrix that is added to the first term's; 0: there is none. */
static int most_blocks(const solid_system *y) {
  int most = 0;
  for (int k = 0; k < y->nterm; k++)
    if (y->term[k].place && y->term[k].body.pattern.nblock > most)
      most = y->term[k].body.pattern.nblock;
  return most;
}

corot_status corot_system_state_create(const solid_system *y, system_state *s) {
  *s = (system_state){.frames = COROT_FRAMES_EXACT, .inverted = -1};
  for (int k = 0; k < y->nterm; k++) COROT_TRY(corot_solid_state_fill(&y->term[k].body, &s->of[k]));
  for (int k = 0; k < y->nmap; k++) COROT_TRY(allocate_fields(y->map[k].map.nnode, &s->on[k]));
  if (y->nmap > 0) COROT_TRY(COROT_ALLOC(s->nodal, y->term[0].body.mesh->nnode));
  if (y->leader >= 0) COROT_TRY(allocate_lead(&y->term[y->leader].body, &s->lead));
  int nblock = most_blocks(y);
  if (nblock == 0) return COROT_OK;
  COROT_TRY(COROT_ALLOC(s->K, nblock));
  return COROT_ALLOC(s->D, nblock);
}

corot_status corot_system_state_share(const solid_system *y, team *by, system_state *s) {
  solid_ranges made[TERMS] = {0};
  corot_status status = COROT_OK;
  for (int k = 0; k < y->nterm && !status; k++)
    status = corot_solid_share(&y->term[k].body, corot_team_size(by), &s->of[k], &made[k]);
  for (int k = 0; k < y->nterm; k++) { /* the new ones, or the old ones, go */
    solid_ranges before = status ? made[k] : s->of[k].ranges;
    if (!status) s->of[k].ranges = made[k], s->of[k].team = by;
    corot_ranges_clear(&before);
  }
  if (!status) s->team = by;
  return status;
}

void corot_system_state_clear(system_state *s) {
  for (int k = 0; k < TERMS; k++) corot_solid_state_clear(&s->of[k]);
  for (int k = 0; k < MAPS; k++) {
    free(s->on[k].u);
    free(s->on[k].v);
    free(s->on[k].du);
    free(s->on[k].dv);
    free(s->on[k].sum);
  }
  free(s->nodal);
  free(s->lead.dR);
  free(s->lead.moment);
  free(s->lead.dmoment);
  free(s->K);
  free(s->D);
}

size_t corot_system_state_bytes(const solid_system *y, const system_state *s) {
  size_t bytes = 2 * (size_t)most_blocks(y) * sizeof *s->K;
  for (int k = 0; k < y->nterm; k++) bytes += corot_solid_state_bytes(&y->term[k].body, &s->of[k]);
  for (int k = 0; k < y->nmap; k++) bytes += 5 * (size_t)y->map[k].map.nnode * sizeof *s->nodal;
  if (y->nmap > 0) bytes += y->term[0].body.mesh->nnode * sizeof *s->nodal;
  if (y->leader >= 0)
    bytes += points_of(&y->term[y->leader].body.elements) *
             (sizeof *s->lead.dR + sizeof *s->lead.moment + sizeof *s->lead.dmoment);
  return bytes;
}
