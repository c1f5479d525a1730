/* Making a body of elements, and the memory of its evaluations. */
#include "solid.h"

#include <stdlib.h>

/* Averages of the dilatation, if some material has more lambda than is left to the tets. */
static corot_status average(solid *body, int nmaterial) {
  double *averaged = calloc((size_t)nmaterial + 1, sizeof *averaged);
  bool any = false;
  if (!averaged) return corot_fail(COROT_ENOMEM, "no memory for %d materials", nmaterial);
  for (int k = 0; k < nmaterial; k++) {
    averaged[k] = body->material[k].lambda - body->material[k].lambda_local;
    any |= averaged[k] > 0;
  }
  corot_status status = COROT_OK;
  if (any)
    status = corot_dilatation_create(body->mesh->nnode, &body->tets, averaged, &body->dilatation);
  free(averaged);
  return status;
}

corot_status corot_solid_fill(solid *body, int nmaterial, const int *of_tet, int together,
                              double volume, const pattern *more) {
  bool warp = strain_measures[body->strain].frame == FRAME_WARP;
  COROT_TRY(corot_tets_create(body->mesh, nmaterial, of_tet, together, warp, &body->tets));
  for (int k = 0; volume != 1 && k < body->tets.nblock; k++) body->tets.block[k].volume *= volume;
  COROT_TRY(average(body, nmaterial));
  return corot_pattern_create(body->mesh->nnode, &body->tets, &body->dilatation, more,
                              &body->pattern);
}

void corot_solid_clear(solid *body) {
  corot_tets_clear(&body->tets);
  corot_dilatation_clear(&body->dilatation);
  corot_pattern_clear(&body->pattern);
}

size_t corot_solid_bytes(const solid *body) {
  const tets *t = &body->tets;
  const pattern *p = &body->pattern;
  size_t bytes = t->nblock * (sizeof *t->block + W * sizeof *t->number);
  bytes += corot_dilatation_bytes(&body->dilatation, t);
  if (t->rest_basis) bytes += t->nblock * sizeof *t->rest_basis;
  return bytes +
         (2 * (size_t)p->nnode + 2 + p->nblock + p->nchunk + 1 + p->first[p->nnode]) * sizeof(int) +
         t->nblock * sizeof *p->place;
}

static corot_status allocate_averages(const solid *body, solid_state *s) {
  int nnode = body->mesh->nnode, nblock = body->tets.nblock, npool = body->dilatation.npool;
  if (!npool) return COROT_OK;
  s->dilatation = corot_vector_calloc(nblock, sizeof *s->dilatation);
  s->dilatation_change = corot_vector_calloc(nblock, sizeof *s->dilatation_change);
  s->slope = corot_vector_calloc(nblock, sizeof *s->slope);
  s->pool = malloc(npool * sizeof *s->pool);
  s->gathered = calloc(nnode, sizeof *s->gathered);
  if (!s->dilatation || !s->dilatation_change || !s->slope || !s->pool || !s->gathered)
    return corot_fail(COROT_ENOMEM, "no memory for a state of %d averages", npool);
  return COROT_OK;
}

corot_status corot_solid_state_fill(const solid *body, solid_state *s) {
  int nblock = body->tets.nblock;
  s->inverted = -1;
  s->R = corot_vector_calloc(nblock, sizeof *s->R);
  s->new_R = corot_vector_calloc(nblock, sizeof *s->new_R);
  s->now_R = corot_vector_calloc(nblock, sizeof *s->now_R);
  s->spin = corot_vector_calloc(nblock, sizeof *s->spin);
  s->force = corot_vector_calloc(body->pattern.window, sizeof *s->force);
  if (!s->R || !s->new_R || !s->now_R || !s->spin || !s->force)
    return corot_fail(COROT_ENOMEM, "no memory for a state of %d nodes", body->mesh->nnode);
  for (int k = 0; k < nblock; k++) s->R[k] = mat3_identity();
  s->frames = (frame_source){COROT_FRAMES_EXACT, s->R, s->spin, 0};
  return allocate_averages(body, s);
}

void corot_solid_state_clear(solid_state *s) {
  free(s->R);
  free(s->spin);
  free(s->now_R);
  free(s->new_R);
  free(s->dilatation);
  free(s->dilatation_change);
  free(s->pool);
  free(s->slope);
  free(s->gathered);
  free(s->force);
}

size_t corot_solid_state_bytes(const solid *body, const solid_state *s) {
  size_t nblock = (size_t)body->tets.nblock, npool = (size_t)body->dilatation.npool;
  size_t bytes =
      nblock * (3 * sizeof *s->R + sizeof *s->spin) + body->pattern.window * sizeof *s->force;
  if (npool)
    bytes += nblock * (2 * sizeof *s->dilatation + sizeof *s->slope) + npool * sizeof *s->pool +
             body->mesh->nnode * sizeof *s->gathered;
  return bytes;
}
