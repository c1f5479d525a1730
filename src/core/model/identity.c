/* The checksum of a model. Lists are summed with their lengths, so that what moves from the end of
   one to the beginning of the next shows. */
#include "identity.h"

#include <string.h>

#include "core/base/pack.h"
#include "core/mesh/mesh.h"
#include "model.h"

/* An array [n], or nothing where x is NULL. */
static void add(uint64_t *sum, const void *x, size_t n, size_t size) {
  uint64_t length = x ? n : UINT64_MAX;
  *sum = corot_checksum(*sum, &length, sizeof length);
  if (x) *sum = corot_checksum(*sum, x, n * size);
}

#define ADD(sum, x, n) add(sum, x, n, sizeof *(x))

static void add_int(uint64_t *sum, int64_t x) { *sum = corot_checksum(*sum, &x, sizeof x); }

static void add_mesh(uint64_t *sum, const corot_mesh *mesh) {
  ADD(sum, mesh->x, (size_t)mesh->nnode);
  ADD(sum, mesh->tet, (size_t)mesh->ntet);
  ADD(sum, mesh->mid, (size_t)mesh->ntet);
}

/* How the terms of a hierarchy see the fields. */
static void add_maps(uint64_t *sum, const solid_system *y) {
  for (int k = 0; k < y->nmap; k++) {
    const coarsening *map = &y->map[k].map;
    ADD(sum, map->point, (size_t)map->nnode * map->npoint);
    ADD(sum, map->weight, (size_t)map->npoint);
    ADD(sum, &map->volume, (size_t)1);
    add_mesh(sum, y->map[k].mesh);
  }
}

/* What the tets are made of, in which order, and under which measure. */
static void add_system(uint64_t *sum, const corot_model *m) {
  const int all[] = {m->system.nterm, m->system.leader, m->system.turning};
  ADD(sum, m->system.name, strlen(m->system.name));
  ADD(sum, all, sizeof all / sizeof *all);
  add_maps(sum, &m->system);
  ADD(sum, m->material, (size_t)m->nmaterial);
  add_int(sum, W);
  for (int k = 0; k < m->system.nterm; k++) {
    const term *t = &m->system.term[k];
    const int kind[] = {t->body.strain,    t->sign,           t->map,   t->level,
                        t->frames_from,    t->from,           t->below, t->body.damped,
                        t->body.objective, t->body.by_element};
    ADD(sum, kind, sizeof kind / sizeof *kind);
    ADD(sum, t->body.elements.block, (size_t)t->body.elements.nblock);
    ADD(sum, t->body.elements.number, (size_t)t->body.elements.nblock * W);
  }
}

static void add_mass(uint64_t *sum, const corot_model *m) {
  size_t ndof = m->ndof, nblock = solid_of(m)->pattern.nblock;
  ADD(sum, m->dof, (size_t)m->mesh->nnode);
  ADD(sum, m->mass, ndof);
  ADD(sum, m->mass_damping, ndof);
  ADD(sum, m->mass_pair, nblock);
  ADD(sum, m->damping_pair, nblock);
}

static void add_amplitude(uint64_t *sum, const amplitude *a) {
  const double sine[] = {(double)a->curve, a->frequency, a->phase, a->offset};
  ADD(sum, sine, sizeof sine / sizeof *sine);
  ADD(sum, a->time, (size_t)a->n);
  ADD(sum, a->value, (size_t)a->n);
}

static void add_load(uint64_t *sum, const load *l, int ndof) {
  ADD(sum, l->force, (size_t)ndof);
  for (int k = 0; k < l->nheld; k++) {
    add_int(sum, 3 * (int64_t)l->held[k].node + l->held[k].component);
    ADD(sum, &l->held[k].force, (size_t)1);
  }
  ADD(sum, l->face, (size_t)l->nface);
  ADD(sum, &l->pressure, (size_t)1);
  add_amplitude(sum, &l->amplitude);
}

static void add_motion(uint64_t *sum, const motion *a) {
  ADD(sum, a->node, (size_t)a->nnode);
  ADD(sum, a->center, (size_t)3);
  ADD(sum, a->axis, (size_t)3);
  add_int(sum, a->turns);
  ADD(sum, a->span, (size_t)a->nspan);
  for (int k = 0; k < a->nlaw; k++) {
    ADD(sum, &a->law[k].angle, (size_t)1);
    ADD(sum, a->law[k].direction, (size_t)3);
    add_amplitude(sum, &a->law[k].amplitude);
  }
}

uint64_t corot_model_identity(const corot_model *m) {
  uint64_t sum = COROT_CHECKSUM;
  add_mesh(&sum, m->mesh);
  add_system(&sum, m);
  add_mass(&sum, m);
  add_int(&sum, m->nload);
  for (int k = 0; k < m->nload; k++) add_load(&sum, &m->load[k], m->ndof);
  add_int(&sum, m->nmotion);
  for (int k = 0; k < m->nmotion; k++) add_motion(&sum, &m->motion[k]);
  return sum;
}
