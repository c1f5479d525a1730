/* Opens the files that a scenario asks for, and gives each moment to those it concerns. */
#include "outputs.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/folder/folder.h"
#include "app/folder/write_groups.h"
#include "compare.h"
#include "fields.h"
#include "quantities.h"
#include "reactions.h"
#include "writers.h"

/* Files are begun, written and closed in this order. */
static const writer_ops *const writers[] = {
    &probes_writer, &energy_writer, &steps_writer,   &comparison_writer,
    &states_writer, &fields_writer, &history_writer, &reactions_writer,
};
enum { NWRITER = sizeof writers / sizeof *writers };

const char *outputs_file(int i) { return i < NWRITER ? writers[i]->file : NULL; }

struct outputs {
  const scenario *scenario;
  const corot_model *model;
  void *writer[NWRITER]; /* NULL: not begun */
  probes *probes;
  double *probed;        /* [probes_ncolumn] at the last moment */
  double (*nodal)[3];    /* [2 nnode] of the last moment: displacement, */
  double (*velocity)[3]; /* [nnode] and velocity, in its second half */
  ledger ledger;         /* of the last moment */
  history *history;
  quantities *quantities;
  steps_count steps;
  observed seen;          /* all but its history and its jumps */
  double energy_at_start; /* [J] */
  long count;             /* moments written */
};

/* The first error is told. */
corot_status outputs_close(outputs *o) {
  corot_status status = COROT_OK;
  if (o->quantities) quantities_close(o->quantities);
  for (int i = 0; i < NWRITER; i++) {
    corot_status closed = o->writer[i] ? writers[i]->close(o->writer[i]) : COROT_OK;
    o->writer[i] = NULL;
    if (status == COROT_OK) status = closed;
  }
  return status;
}

void outputs_destroy(outputs *o) {
  if (!o) return;
  outputs_close(o);
  history_destroy(o->history);
  quantities_destroy(o->quantities);
  probes_destroy(o->probes);
  free(o->probed);
  free(o->nodal);
  free(o);
}

static corot_status allocate(outputs *o) {
  size_t nnode = (size_t)corot_model_mesh(o->model)->nnode;
  COROT_TRY(probes_create(o->scenario, o->model, &o->probes));
  o->nodal = calloc(2 * nnode, sizeof *o->nodal);
  o->probed = calloc((size_t)probes_ncolumn(o->probes) + 1, sizeof *o->probed);
  if (!o->nodal || !o->probed) return corot_fail(COROT_ENOMEM, "the probes: out of memory");
  o->velocity = o->nodal + nnode;
  COROT_TRY(quantities_create(o->scenario, o->probes, &o->quantities));
  return history_create(o->probes, corot_model_ndof(o->model), &o->history);
}

static writer_source source_of(outputs *o, const char *dir, pack *from) {
  return (writer_source){.dir = dir,
                         .scenario = o->scenario,
                         .model = o->model,
                         .probes = o->probes,
                         .history = o->history,
                         .steps = &o->steps,
                         .from = from};
}

static bool is_wanted(const outputs *o, const writer_ops *ops) {
  return !ops->wanted || ops->wanted(o->scenario);
}

static corot_status open_writers(outputs *o, const char *dir, writer_use use) {
  const writer_source source = source_of(o, dir, NULL);
  for (int i = 0; i < NWRITER; i++)
    if (writers[i]->use == use && is_wanted(o, writers[i]))
      COROT_TRY(writers[i]->open(&source, &o->writer[i]));
  return COROT_OK;
}

/* --- Checkpoints --- */

static void exchange_ledger(pack *p, ledger *row) {
  double *const number[] = {&row->t,           &row->kinetic,       &row->elastic,
                            &row->dissipated,  &row->external_work, &row->balance,
                            &row->frame_energy};
  for (size_t i = 0; i < sizeof number / sizeof *number; i++) corot_pack_double(p, number[i]);
  corot_pack_doubles(p, row->momentum, 3);
  corot_pack_doubles(p, row->angular_momentum, 3);
}

static void exchange_deformation(pack *p, corot_deformation *d) {
  double *const number[] = {&d->strained, &d->stretch_min, &d->stretch_max,
                            &d->turned,   &d->turn_max,    &d->det_min};
  for (size_t i = 0; i < sizeof number / sizeof *number; i++) corot_pack_double(p, number[i]);
  corot_pack_int(p, &d->det_tet);
  corot_pack_int(p, &d->ninverted);
}

static void exchange_seen(pack *p, observed *s) {
  corot_pack_double(p, &s->displacement);
  exchange_deformation(p, &s->strained);
  exchange_deformation(p, &s->turned);
  exchange_deformation(p, &s->inverted);
  corot_pack_double(p, &s->t_strained);
  corot_pack_double(p, &s->t_turned);
  corot_pack_double(p, &s->t_inverted);
}

/* All but the writers. */
static void exchange(pack *p, outputs *o) {
  size_t nnode = (size_t)corot_model_mesh(o->model)->nnode;
  probes_exchange(p, o->probes);
  corot_pack_doubles(p, o->probed, (size_t)probes_ncolumn(o->probes));
  corot_pack_doubles(p, &o->nodal[0][0], 6 * nnode);
  exchange_ledger(p, &o->ledger);
  history_exchange(p, o->history);
  quantities_exchange(p, o->quantities);
  exchange_seen(p, &o->seen);
  corot_pack_double(p, &o->energy_at_start);
  corot_pack_long(p, &o->count);
}

corot_status outputs_pack(outputs *o, pack *p) {
  exchange(p, o);
  for (int i = 0; i < NWRITER; i++) {
    const writer_ops *ops = writers[i];
    void *writer = o->writer[i];
    if (writer && ops->pack) COROT_TRY(ops->pack(writer, p));
    if (writer && ops->table) COROT_TRY(table_pack(ops->table(writer), p));
  }
  return corot_pack_status(p);
}

static corot_status synchronise(const writer_ops *ops, void *writer) {
  return ops->table ? table_synchronise(ops->table(writer)) : ops->synchronise(writer);
}

static corot_status cut(const writer_ops *ops, void *writer) {
  return ops->table ? table_cut(ops->table(writer)) : ops->cut(writer);
}

corot_status outputs_synchronise(outputs *o) {
  for (int i = 0; i < NWRITER; i++)
    if (o->writer[i]) COROT_TRY(synchronise(writers[i], o->writer[i]));
  return COROT_OK;
}

static corot_status resume_all(outputs *o, const char *dir, pack *p) {
  COROT_TRY(allocate(o));
  exchange(p, o);
  COROT_TRY(corot_pack_status(p));
  const writer_source source = source_of(o, dir, p);
  for (int i = 0; i < NWRITER; i++)
    if (writers[i]->use != WRITER_OF_STATICS && is_wanted(o, writers[i]))
      COROT_TRY(writers[i]->open(&source, &o->writer[i]));
  return COROT_OK;
}

corot_status outputs_cut(outputs *o, const char *dir) {
  for (int i = 0; i < NWRITER; i++)
    if (o->writer[i]) COROT_TRY(cut(writers[i], o->writer[i]));
  if (o->scenario->write_fields)
    COROT_TRY(groups_write(dir, o->scenario->resolved, corot_model_mesh(o->model)));
  return folder_clean_ends(dir);
}

/* --- The files --- */

static corot_status open_all(outputs *o, const char *dir) {
  COROT_TRY(allocate(o));
  COROT_TRY(folder_make(dir));
  COROT_TRY(folder_clean(dir));
  return open_writers(o, dir, WRITER_COMMON);
}

/* With the files of a checkpoint, or new ones (NULL). */
static corot_status create(const scenario *s, const corot_model *model, const char *dir, pack *p,
                           outputs **out) {
  outputs *o = calloc(1, sizeof *o);
  if (!o) return corot_fail(COROT_ENOMEM, "%s: out of memory", dir);
  o->scenario = s;
  o->model = model;
  o->seen.strained.det_tet = -1;
  corot_status status = p ? resume_all(o, dir, p) : open_all(o, dir);
  if (status != COROT_OK) {
    outputs_destroy(o);
    return status;
  }
  *out = o;
  return COROT_OK;
}

corot_status outputs_open(const scenario *s, const corot_model *model, const char *dir,
                          outputs **out) {
  return create(s, model, dir, NULL, out);
}

corot_status outputs_resume(const scenario *s, const corot_model *model, const char *dir, pack *p,
                            outputs **out) {
  return create(s, model, dir, p, out);
}

corot_status outputs_open_run(outputs *o, const char *dir) {
  return open_writers(o, dir, WRITER_OF_RUN);
}

corot_status outputs_open_statics(outputs *o, const char *dir) {
  return open_writers(o, dir, WRITER_OF_STATICS);
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

/* Of the moment whose displacement is in o->nodal. */
static corot_status evaluate_probes(outputs *o, corot_state *state, const instant *now,
                                    const ledger *row) {
  return probes_evaluate(o->probes,
                         &(probe_moment){.t = now->t,
                                         .state = state,
                                         .u = now->u,
                                         .v = now->v,
                                         .displacement = (const double(*)[3])o->nodal,
                                         .ledger = row,
                                         .still = now->still},
                         o->probed);
}

/* Of the moment whose probes have been evaluated; velocity NULL: none that goes with t. */
static corot_status record(outputs *o, const instant *now, const ledger *row,
                           const double (*velocity)[3]) {
  quantities_row(o->quantities, row, o->probed, velocity);
  return history_add(o->history, row, o->probed, now->u, now->v);
}

corot_status outputs_history(outputs *o, corot_state *state, const instant *now,
                             const corot_energies *e) {
  ledger row = make_ledger(o, now, e);
  bool wanted = quantities_wanted(o->quantities);
  corot_nodal(o->model, now->t, now->u, now->v, o->nodal, NULL);
  if (wanted) corot_nodal_motion(o->model, state, now->t, now->v, NULL, o->velocity, NULL);
  COROT_TRY(evaluate_probes(o, state, now, &row));
  return record(o, now, &row, wanted ? (const double(*)[3])o->velocity : NULL);
}

/* In more of the body or, if in all of it, further. */
static bool is_more_strained(const corot_deformation *a, const corot_deformation *b) {
  if (a->strained != b->strained) return a->strained > b->strained;
  return a->stretch_max - a->stretch_min > b->stretch_max - b->stretch_min;
}

/* Keeps the worst of the deformations so far. */
static void observe_deformation(const outputs *o, corot_state *state, double t, const double *u,
                                observed *s) {
  bool first = s->strained.det_tet < 0,
       turns = corot_strain_find(o->scenario->model.strain)->linear;
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
    const double *u = o->nodal[n];
    largest = fmax(largest, u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
  }
  o->seen.displacement = fmax(o->seen.displacement, sqrt(largest));
}

/* Hands a moment to one of the operations of all writers that have it. */
static corot_status evaluate_all(outputs *o, const moment *now) {
  for (int i = 0; i < NWRITER; i++) {
    const writer_ops *ops = writers[i];
    if (o->writer[i] && ops->evaluate) COROT_TRY(ops->evaluate(o->writer[i], now));
  }
  return COROT_OK;
}

static corot_status write_all(outputs *o, const moment *now) {
  for (int i = 0; i < NWRITER; i++) {
    const writer_ops *ops = writers[i];
    if (o->writer[i] && ops->moment) COROT_TRY(ops->moment(o->writer[i], now));
  }
  return COROT_OK;
}

corot_status outputs_write(outputs *o, corot_state *state, const instant *now, bool last) {
  ledger row;
  const moment all = {.t = now->t,
                      .number = o->count,
                      .last = last,
                      .still = now->still,
                      .state = state,
                      .u = now->u,
                      .v = now->v,
                      .displacement = (const double(*)[3])o->nodal,
                      .velocity = (const double(*)[3])o->velocity,
                      .ledger = &o->ledger,
                      .probed = o->probed};
  /* whatever the body's state may not allow, before a file is touched */
  COROT_TRY(take_energies(o, state, now, &row));
  COROT_TRY(evaluate_all(o, &all));
  corot_nodal(o->model, now->t, now->u, now->v, o->nodal, o->velocity);
  if (now->still) memset(o->velocity, 0, corot_model_mesh(o->model)->nnode * sizeof *o->velocity);
  COROT_TRY(evaluate_probes(o, state, now, &row));
  o->ledger = row;
  o->count++;
  observe(o, state, now);

  /* the files */
  if (o->count == 1 || now->still) {
    const double(*velocity)[3] = now->still ? NULL : (const double(*)[3])o->velocity;
    COROT_TRY(record(o, now, &row, velocity));
  }
  return write_all(o, &all);
}

corot_status outputs_step(outputs *o, const step_row *row) {
  if (row->events & EVENT_KINK) quantities_break(o->quantities);
  for (int i = 0; i < NWRITER; i++) {
    const writer_ops *ops = writers[i];
    if (o->writer[i] && ops->step) COROT_TRY(ops->step(o->writer[i], row));
  }
  return COROT_OK;
}

json_t *outputs_reactions(const outputs *o) {
  for (int i = 0; i < NWRITER; i++)
    if (writers[i] == &reactions_writer && o->writer[i]) return reactions_last(o->writer[i]);
  return NULL;
}

steps_count outputs_steps(const outputs *o) { return o->steps; }

long outputs_count(const outputs *o) { return o->count; }

ledger outputs_ledger(const outputs *o) { return o->ledger; }

json_t *outputs_quantities(const outputs *o) { return quantities_json(o->quantities); }

void outputs_tell(const outputs *o) { quantities_tell(o->quantities); }

int outputs_unanswered(const outputs *o) { return quantities_unanswered(o->quantities); }

corot_status outputs_warn(const outputs *o, warnings *w) {
  return quantities_warn(o->quantities, w);
}

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

json_t *outputs_probes(const outputs *o) {
  return probes_json(o->probes, o->probed, (const double(*)[3])o->velocity);
}

const probes *outputs_recorded(const outputs *o) { return o->probes; }
