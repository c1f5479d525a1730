/* Opens the files that a scenario asks for, and gives each moment to those it concerns. */
#include "outputs.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/folder/folder.h"
#include "app/folder/states.h"
#include "app/folder/write_groups.h"
#include "app/folder/write_vtu.h"
#include "compare.h"

struct outputs {
  const scenario *scenario;
  const corot_model *model;
  table *probes, *energy, *steps;
  comparison *comparison;  /* NULL: none is asked for */
  vtu *fields;             /* NULL: none are asked for */
  state_writer *states;    /* the same */
  int *node;               /* [nprobe] */
  const char **probe_name; /* [nprobe] */
  double (*nodal)[3];      /* [2 nnode] where there are no fields: displacement, velocity */
  vtu_fields value;        /* of the last moment; displacement and velocity in any case */
  ledger ledger;           /* of the last moment */
  history *history;
  observed seen;          /* all but its history and its jumps */
  double energy_at_start; /* [J] */
  long count;             /* moments written */
};

corot_status outputs_close(outputs *o) {
  corot_status probes = table_close(o->probes), energy = table_close(o->energy);
  corot_status steps = table_close(o->steps), compared = comparison_close(o->comparison);
  corot_status fields = o->fields ? vtu_finish(o->fields) : COROT_OK;
  corot_status binary = states_close(o->states);
  corot_status past = o->history ? history_close(o->history) : COROT_OK;
  o->probes = o->energy = o->steps = NULL;
  o->comparison = NULL;
  o->states = NULL;
  return probes != COROT_OK     ? probes
         : energy != COROT_OK   ? energy
         : steps != COROT_OK    ? steps
         : compared != COROT_OK ? compared
         : binary != COROT_OK   ? binary
         : past != COROT_OK     ? past
                                : fields;
}

void outputs_destroy(outputs *o) {
  if (!o) return;
  outputs_close(o);
  vtu_destroy(o->fields);
  history_destroy(o->history);
  free(o->node);
  free(o->probe_name);
  free(o->nodal);
  free(o);
}

/* material [ntet]: the entry of the scenario's list that fills each tet. */
static void number_materials(const scenario *s, const corot_mesh *mesh, int *material) {
  for (int i = 0; i < s->nmaterial; i++)
    if (!s->material[i].group)
      for (int e = 0; e < mesh->ntet; e++) material[e] = i;
  for (int i = 0; i < s->nmaterial; i++) {
    const char *name = s->material[i].group;
    const corot_group *group = name ? corot_mesh_find_group(mesh, name) : NULL;
    for (int k = 0; group && k < group->ntet; k++) material[group->tet[k]] = i;
  }
}

static corot_status open_fields(outputs *o, const char *dir) {
  const corot_mesh *mesh = corot_model_mesh(o->model);
  int *material = calloc((size_t)mesh->ntet, sizeof *material);
  if (!material) return corot_fail(COROT_ENOMEM, "%s/fields: out of memory", dir);
  number_materials(o->scenario, mesh, material);
  corot_status status = vtu_create(dir, mesh, material, &o->fields);
  free(material);
  COROT_TRY(status);
  o->value = vtu_arrays(o->fields);
  return groups_write(dir, o->scenario->resolved, mesh);
}

/* Where no fields are written the probes still need the nodes. */
static corot_status open_nodal(outputs *o) {
  size_t nnode = (size_t)corot_model_mesh(o->model)->nnode;
  o->nodal = malloc(2 * nnode * sizeof *o->nodal);
  if (!o->nodal) return corot_fail(COROT_ENOMEM, "the probes: out of memory");
  o->value = (vtu_fields){.displacement = o->nodal, .velocity = o->nodal + nnode};
  return COROT_OK;
}

static corot_status find_probes(outputs *o) {
  const scenario *s = o->scenario;
  const corot_mesh *mesh = corot_model_mesh(o->model);
  o->node = malloc(((size_t)s->nprobe + 1) * sizeof *o->node);
  o->probe_name = malloc(((size_t)s->nprobe + 1) * sizeof *o->probe_name);
  if (!o->node || !o->probe_name) return corot_fail(COROT_ENOMEM, "the probes: out of memory");
  for (int i = 0; i < s->nprobe; i++) {
    const probe_def *p = &s->probe[i];
    o->probe_name[i] = p->name;
    o->node[i] = p->node >= 0 ? p->node : corot_mesh_nearest(mesh, p->point);
    if (o->node[i] >= mesh->nnode)
      return corot_fail(COROT_EINVAL, "probe %s: node %d; the mesh's nodes are 0 to %d", p->name,
                        p->node, mesh->nnode - 1);
  }
  return COROT_OK;
}

static corot_status open_all(outputs *o, const char *dir) {
  COROT_TRY(find_probes(o));
  COROT_TRY(folder_make(dir));
  COROT_TRY(folder_clean(dir));
  COROT_TRY(probes_open(dir, o->scenario->nprobe, o->probe_name, &o->probes));
  COROT_TRY(energy_open(dir, &o->energy));
  COROT_TRY(steps_open(dir, &o->steps));
  COROT_TRY(history_create(o->scenario, corot_model_ndof(o->model), &o->history));
  if (o->scenario->ncompare > 0)
    COROT_TRY(comparison_open(dir, o->model, o->scenario->ncompare, o->scenario->compare,
                              &o->comparison));
  if (o->scenario->write_states) COROT_TRY(states_create(dir, o->model, &o->states));
  return o->scenario->write_fields ? open_fields(o, dir) : open_nodal(o);
}

corot_status outputs_open(const scenario *s, const corot_model *model, const char *dir,
                          outputs **out) {
  outputs *o = calloc(1, sizeof *o);
  if (!o) return corot_fail(COROT_ENOMEM, "%s: out of memory", dir);
  o->scenario = s;
  o->model = model;
  o->seen.strained.det_tet = -1;
  corot_status status = open_all(o, dir);
  if (status != COROT_OK) {
    outputs_destroy(o);
    return status;
  }
  *out = o;
  return COROT_OK;
}

corot_status outputs_open_history(outputs *o, const char *dir) {
  return o->scenario->write_history ? history_open(o->history, dir) : COROT_OK;
}

static ledger make_ledger(outputs *o, const instant *now, const corot_energies *e) {
  double start = o->count > 0 ? o->energy_at_start : e->kinetic + e->elastic;
  ledger row = {
      .t = now->t,
      .kinetic = e->kinetic,
      .elastic = e->elastic,
      .dissipated = now->dissipated,
      .external_work = now->external_work,
      .balance = e->kinetic + e->elastic + now->dissipated - now->external_work -
                 now->frame_energy - start,
      .frame_energy = now->frame_energy,
  };
  memcpy(row.momentum, e->momentum, sizeof row.momentum);
  memcpy(row.angular_momentum, e->angular_momentum, sizeof row.angular_momentum);
  if (o->count == 0) o->energy_at_start = start;
  return row;
}

static corot_status take_energies(outputs *o, corot_state *state, const instant *now, ledger *row) {
  corot_energies e;
  COROT_TRY(corot_energy(o->model, state, now->t, now->u, now->v, &e));
  *row = make_ledger(o, now, &e);
  return COROT_OK;
}

static corot_status add_history(outputs *o, const instant *now, const ledger *row) {
  return history_add(o->history, row, o->node, (const double(*)[3])o->value.displacement, now->u);
}

corot_status outputs_history(outputs *o, const instant *now, const corot_energies *e) {
  ledger row = make_ledger(o, now, e);
  corot_nodal(o->model, now->t, now->u, now->v, o->value.displacement, NULL);
  return add_history(o, now, &row);
}

/* In more of the body or, if in all of it, further. */
static bool is_more_strained(const corot_deformation *a, const corot_deformation *b) {
  if (a->strained != b->strained) return a->strained > b->strained;
  return a->stretch_max - a->stretch_min > b->stretch_max - b->stretch_min;
}

/* Keeps the worst of the deformations so far. */
static void observe_deformation(const outputs *o, corot_state *state, double t, const double *u,
                                observed *s) {
  bool first = s->strained.det_tet < 0, turns = corot_strain_find(o->scenario->strain)->linear;
  corot_deformation d;
  corot_deformation_measure(o->model, state, t, u, STRAIN_LIMIT, turns ? TURN_LIMIT : INFINITY, &d);
  if (first || is_more_strained(&d, &s->strained)) s->strained = d, s->t_strained = t;
  if (first || d.turn_max > s->turned.turn_max) s->turned = d, s->t_turned = t;
  if (first || d.det_min < s->inverted.det_min) s->inverted = d, s->t_inverted = t;
}

static void observe(outputs *o, corot_state *state, const instant *now) {
  double largest = 0;
  observe_deformation(o, state, now->t, now->u, &o->seen);
  for (int n = 0; n < corot_model_mesh(o->model)->nnode; n++) {
    const double *u = o->value.displacement[n];
    largest = fmax(largest, u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
  }
  o->seen.displacement = fmax(o->seen.displacement, sqrt(largest));
}

static corot_status take_fields(outputs *o, corot_state *state, const instant *now) {
  corot_element_fields fields = {
      .frame = o->value.frame,
      .strain = o->value.strain,
      .von_mises = o->value.von_mises,
      .det = o->value.det,
  };
  return corot_elements(o->model, state, now->t, now->u, &fields);
}

corot_status outputs_write(outputs *o, corot_state *state, const instant *now, bool last) {
  int every = o->scenario->field_every > 0 ? o->scenario->field_every : 1;
  bool frame = o->fields && (last || o->count % every == 0);
  ledger row;
  COROT_TRY(take_energies(o, state, now, &row));
  if (frame) COROT_TRY(take_fields(o, state, now));
  corot_nodal(o->model, now->t, now->u, now->v, o->value.displacement, o->value.velocity);
  if (now->still)
    memset(o->value.velocity, 0, corot_model_mesh(o->model)->nnode * sizeof *o->value.velocity);

  o->ledger = row;
  o->count++;
  observe(o, state, now);
  if (o->count == 1 || now->still) COROT_TRY(add_history(o, now, &row));
  COROT_TRY(probes_row(o->probes, now->t, o->scenario->nprobe, o->node,
                       (const double(*)[3])o->value.displacement));
  COROT_TRY(energy_row(o->energy, &row));
  if (o->comparison) COROT_TRY(comparison_row(o->comparison, state, now->t, now->u));
  if (o->states) COROT_TRY(states_add(o->states, now->t, now->u, now->v));
  return frame ? vtu_write(o->fields, now->t) : COROT_OK;
}

corot_status outputs_step(outputs *o, const step_row *row) { return steps_add(o->steps, row); }

long outputs_count(const outputs *o) { return o->count; }

ledger outputs_ledger(const outputs *o) { return o->ledger; }

json_t *outputs_extremes(const outputs *o) { return history_extremes(o->history); }

/* Whether what swings is the motion, not what tolerance or rounding make of a body that is still or
   follows its load: beyond the absolute tolerance or, without a probe, in energy. */
static bool is_swinging(const outputs *o, const history_facts *h) {
  const corot_integrator_def *d = &o->scenario->integrator;
  double least = d->step > 0 ? 100 * d->newton_tolerance : 0.01 * d->rtol;
  least *= corot_model_length(o->model);
  if (d->step == 0 && d->atol_displacement > 0) least = d->atol_displacement;
  return h->swing == h->swing ? h->swing > least : h->kinetic > 0.01 * h->energy;
}

corot_status outputs_observed(const outputs *o, corot_state *state, observed *out) {
  observed seen = o->seen;
  *out = (observed){0};
  if (o->count == 0) return COROT_OK;
  seen.history = history_known(o->history);
  if (!is_swinging(o, &seen.history)) seen.history.period = 0;
  observe_deformation(o, state, seen.history.t_elastic, seen.history.u, &seen);
  COROT_TRY(
      corot_stress_jumps(o->model, state, seen.history.t_elastic, seen.history.u, &seen.jumps));
  *out = seen;
  return COROT_OK;
}

int outputs_nprobe(const outputs *o) { return o->scenario->nprobe; }

const char *outputs_probe(const outputs *o, int i, int *node, double u[3], double v[3]) {
  *node = o->node[i];
  memcpy(u, o->value.displacement[*node], 3 * sizeof *u);
  memcpy(v, o->value.velocity[*node], 3 * sizeof *v);
  return o->probe_name[i];
}
