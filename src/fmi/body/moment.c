/* Fills the ledger that probes may ask for, and asks them. */
#include "moment.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/text/no_memory.h"

corot_status sight_create(const body *b, sight *s) {
  *s = (sight){.body = b};
  s->displacement = calloc((size_t)b->mesh->nnode + 1, sizeof *s->displacement);
  s->value = calloc((size_t)probes_ncolumn(b->probes) + 1, sizeof *s->value);
  if (s->displacement && s->value) return COROT_OK;
  sight_clear(s);
  return no_memory();
}

void sight_clear(sight *s) {
  free(s->displacement);
  free(s->value);
  *s = (sight){0};
}

static corot_status find_ledger(const sight *s, corot_state *state, moment *now, ledger *row) {
  corot_energies e;
  COROT_TRY(corot_energy(s->body->model, state, now->t, now->u, now->v, &e));
  if (isnan(now->energy_at_start)) now->energy_at_start = e.kinetic + e.elastic;
  *row = (ledger){
      .t = now->t,
      .kinetic = e.kinetic,
      .elastic = e.elastic,
      .dissipated = now->dissipated,
      .external_work = now->external_work,
      .balance = e.kinetic + e.elastic + now->dissipated - now->external_work - now->frame_energy -
                 now->energy_at_start,
      .frame_energy = now->frame_energy,
  };
  memcpy(row->momentum, e.momentum, sizeof row->momentum);
  memcpy(row->angular_momentum, e.angular_momentum, sizeof row->angular_momentum);
  return COROT_OK;
}

corot_status sight_look(sight *s, corot_state *state, moment *now) {
  ledger row = {0};
  if (body_wants_ledger(s->body)) COROT_TRY(find_ledger(s, state, now, &row));
  corot_nodal(s->body->model, now->t, now->u, now->v, s->displacement, NULL);
  return probes_evaluate(s->body->probes,
                         &(probe_moment){.t = now->t,
                                         .state = state,
                                         .u = now->u,
                                         .v = now->v,
                                         .displacement = (const double(*)[3])s->displacement,
                                         .ledger = &row},
                         s->value);
}
