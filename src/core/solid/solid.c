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
    status = corot_dilatation_create(body->mesh, &body->elements, body->by_element, averaged,
                                     &body->dilatation);
  free(averaged);
  return status;
}

corot_status corot_solid_fill(solid *body, int nmaterial, const int *of_tet, int together,
                              double volume, const pattern *more) {
  body->together = together;
  bool warp = strain_measures[body->strain].frame == FRAME_WARP;
  const corot_mesh *order_of = body->order_of ? body->order_of : body->mesh;
  COROT_TRY(corot_tets_create_ordered(body->mesh, order_of, nmaterial, of_tet, together, warp,
                                      &body->elements));
  for (int k = 0; volume != 1 && k < points_of(&body->elements); k++)
    body->elements.weight[k] *= volume;
  COROT_TRY(average(body, nmaterial));
  return corot_pattern_create(body->mesh->nnode, &body->elements, &body->dilatation, more,
                              &body->pattern);
}

void corot_solid_clear(solid *body) {
  corot_tets_clear(&body->elements);
  corot_dilatation_clear(&body->dilatation);
  corot_pattern_clear(&body->pattern);
}

size_t corot_solid_bytes(const solid *body) {
  const element_set *t = &body->elements;
  const pattern *p = &body->pattern;
  size_t bytes =
      t->nblock * (sizeof *t->block + W * sizeof *t->number) +
      (size_t)t->nblock * t->kind->nnode * sizeof *t->node +
      (size_t)points_of(t) * (sizeof *t->weight + (t->kind->nnode - 1) * sizeof *t->slope);
  bytes += corot_dilatation_bytes(&body->dilatation, t);
  if (t->role) bytes += (size_t)t->nblock * t->kind->nnode * sizeof *t->role;
  if (t->rest_basis) bytes += t->nblock * sizeof *t->rest_basis;
  return bytes +
         (3 * (size_t)p->nnode + 3 + 2 * p->nblock + p->nchunk + 1 + p->first[p->nnode]) *
             sizeof(int) +
         (size_t)t->nblock * t->kind->npair * sizeof *p->place;
}

static corot_status allocate_averages(const solid *body, solid_state *s) {
  int npoint = points_of(&body->elements), npool = body->dilatation.npool;
  if (!npool) return COROT_OK;
  s->dilatation = corot_vector_calloc(npoint, sizeof *s->dilatation);
  s->dilatation_change = corot_vector_calloc(npoint, sizeof *s->dilatation_change);
  s->slope = corot_vector_calloc((size_t)npoint * body->elements.kind->nnode, sizeof *s->slope);
  s->pool = malloc(npool * sizeof *s->pool);
  if (!s->dilatation || !s->dilatation_change || !s->slope || !s->pool)
    return corot_fail(COROT_ENOMEM, "no memory for a state of %d averages", npool);
  return COROT_OK;
}

corot_status corot_solid_state_fill(const solid *body, solid_state *s) {
  int npoint = points_of(&body->elements), nnode = body->elements.kind->nnode;
  s->inverted = -1;
  s->R = corot_vector_calloc(npoint, sizeof *s->R);
  s->new_R = corot_vector_calloc(npoint, sizeof *s->new_R);
  s->now_R = corot_vector_calloc(npoint, sizeof *s->now_R);
  s->spin = corot_vector_calloc(npoint, sizeof *s->spin);
  s->force = corot_vector_calloc((size_t)body->pattern.window * nnode, sizeof *s->force);
  if (!s->R || !s->new_R || !s->now_R || !s->spin || !s->force)
    return corot_fail(COROT_ENOMEM, "no memory for a state of %d nodes", body->mesh->nnode);
  s->chunk_sum = calloc(body->pattern.nchunk, sizeof *s->chunk_sum);
  s->chunk_angles = calloc(body->pattern.nchunk, sizeof *s->chunk_angles);
  if (!s->chunk_sum || !s->chunk_angles)
    return corot_fail(COROT_ENOMEM, "no memory for %d chunks", body->pattern.nchunk);
  for (int k = 0; k < npoint; k++) s->R[k] = mat3_identity();
  s->frames = (frame_source){COROT_FRAMES_EXACT, s->R, s->spin, 0};
  COROT_TRY(corot_solid_share(body, 1, s, &s->ranges));
  return allocate_averages(body, s);
}

corot_status corot_solid_share(const solid *body, int n, const solid_state *s, solid_ranges *r) {
  return corot_ranges_create(body->mesh, &body->elements, &body->pattern, n, body->together,
                             body->damped, body->dilatation.npool > 0, s->force, r);
}

void corot_solid_state_clear(solid_state *s) {
  corot_ranges_clear(&s->ranges);
  free(s->chunk_sum);
  free(s->chunk_angles);
  free(s->R);
  free(s->spin);
  free(s->now_R);
  free(s->new_R);
  free(s->dilatation);
  free(s->dilatation_change);
  free(s->pool);
  free(s->slope);
  free(s->force);
}

size_t corot_solid_state_bytes(const solid *body, const solid_state *s) {
  size_t npoint = (size_t)points_of(&body->elements), npool = (size_t)body->dilatation.npool;
  size_t nnode = (size_t)body->elements.kind->nnode;
  size_t bytes = npoint * (3 * sizeof *s->R + sizeof *s->spin) +
                 body->pattern.window * nnode * sizeof *s->force +
                 body->pattern.nchunk * (sizeof *s->chunk_sum + sizeof *s->chunk_angles) +
                 corot_ranges_bytes(&s->ranges, &body->elements, &body->pattern);
  if (npool)
    bytes +=
        npoint * (2 * sizeof *s->dilatation + nnode * sizeof *s->slope) + npool * sizeof *s->pool;
  return bytes;
}
