/* Writes each step as it comes, and keeps the extremes. */
#include "history.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/quantity/turning.h"
#include "app/text/json_text.h"

/* Signals: of each probe its columns and, of a vector, the length; then these of the energies. */
enum { KINETIC, ELASTIC, DISSIPATED, WORK, BALANCE, FRAMES, OF_ENERGY };

static const char *const energy_words[OF_ENERGY] = {"kinetic",       "elastic", "dissipated",
                                                    "external_work", "balance", "frame_energy"};

typedef struct signal_seen {
  extreme min, max;
  probe_where at_min, at_max; /* of a probe that is an extreme itself */
  turning turning;
} signal_seen;

struct history {
  const probes *probes;
  int nsignal, ndof;   /* signals of the probes; degrees of freedom */
  table *table;        /* NULL: it is not written */
  signal_seen *signal; /* [nsignal + OF_ENERGY] the probes', then the energies' */
  long count;
  double balance, dissipated; /* at the last moment */
  double t_elastic, *u, *v;   /* [ndof] at the largest elastic energy */
};

static int signals_of(probe_facts probe) { return probe.ncolumn + (probe.length ? 1 : 0); }

static const signal_seen *energy_signal(const history *h, int which) {
  return &h->signal[h->nsignal + which];
}

corot_status history_close(history *h) {
  corot_status status = table_close(h->table);
  h->table = NULL;
  return status;
}

void history_destroy(history *h) {
  if (!h) return;
  history_close(h);
  free(h->signal);
  free(h->u);
  free(h->v);
  free(h);
}

corot_status history_create(const probes *p, int ndof, history **out) {
  history *h = calloc(1, sizeof *h);
  if (!h) return corot_fail(COROT_ENOMEM, "the history: out of memory");
  h->probes = p;
  h->ndof = ndof;
  for (int i = 0; i < probes_n(p); i++) h->nsignal += signals_of(probes_known(p, i));
  h->signal = calloc((size_t)h->nsignal + OF_ENERGY, sizeof *h->signal);
  h->u = calloc((size_t)ndof + 1, sizeof *h->u);
  h->v = calloc((size_t)ndof + 1, sizeof *h->v);
  if (!h->signal || !h->u || !h->v) {
    history_destroy(h);
    return corot_fail(COROT_ENOMEM, "the history: out of memory");
  }
  *out = h;
  return COROT_OK;
}

corot_status history_open(history *h, const char *dir, pack *from) {
  if (from) return table_resume(dir, "history.csv", from, &h->table);
  return history_table_open(dir, probes_ncolumn(h->probes), probes_columns(h->probes), &h->table);
}

/* --- One moment --- */

static void see(signal_seen *s, bool first, double value, double t, const probe_where *where) {
  if (where && (first || value < s->min.value)) s->at_min = *where;
  if (where && (first || value > s->max.value)) s->at_max = *where;
  if (first) {
    s->min = s->max = (extreme){value, t};
    s->turning = turning_begin(value, t);
    return;
  }
  if (value < s->min.value) s->min = (extreme){value, t};
  if (value > s->max.value) s->max = (extreme){value, t};
  turning_follow(&s->turning, s->max.value - s->min.value, value, t);
}

/* Of three components. */
static double length_of(const double *x) { return sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]); }

corot_status history_add(history *h, const ledger *now, const double *value, const double *u,
                         const double *v) {
  bool first = h->count++ == 0;
  signal_seen *s = h->signal;
  for (int i = 0; i < probes_n(h->probes); i++) {
    probe_facts probe = probes_known(h->probes, i);
    for (int c = 0; c < probe.ncolumn; c++) {
      const probe_where where = probes_where(h->probes, i, c);
      see(s++, first, value[probe.first + c], now->t, &where);
    }
    if (probe.length) see(s++, first, length_of(value + probe.first), now->t, NULL);
  }
  const double energy[OF_ENERGY] = {now->kinetic,       now->elastic, now->dissipated,
                                    now->external_work, now->balance, now->frame_energy};
  if (first || now->elastic > s[ELASTIC].max.value) {
    memcpy(h->u, u, (size_t)h->ndof * sizeof *u);
    memcpy(h->v, v, (size_t)h->ndof * sizeof *v);
    h->t_elastic = now->t;
  }
  for (int k = 0; k < OF_ENERGY; k++) see(&s[k], first, energy[k], now->t, NULL);
  h->balance = now->balance;
  h->dissipated = now->dissipated;
  return h->table ? history_row(h->table, now, probes_ncolumn(h->probes), value) : COROT_OK;
}

/* --- Checkpoints --- */

static void exchange_extreme(pack *p, extreme *e) {
  corot_pack_double(p, &e->value);
  corot_pack_double(p, &e->t);
}

static void exchange_signal(pack *p, signal_seen *s) {
  exchange_extreme(p, &s->min);
  exchange_extreme(p, &s->max);
  probe_where_exchange(p, &s->at_min);
  probe_where_exchange(p, &s->at_max);
  turning_exchange(p, &s->turning);
}

void history_exchange(pack *p, history *h) {
  corot_pack_same(p, (uint64_t)h->nsignal, "the number of signals");
  for (int i = 0; i < h->nsignal + OF_ENERGY; i++) exchange_signal(p, &h->signal[i]);
  corot_pack_long(p, &h->count);
  corot_pack_double(p, &h->balance);
  corot_pack_double(p, &h->dissipated);
  corot_pack_double(p, &h->t_elastic);
  corot_pack_doubles(p, h->u, (size_t)h->ndof);
  corot_pack_doubles(p, h->v, (size_t)h->ndof);
}

table *history_table(const history *h) { return h->table; }

/* --- What is known in the end --- */

static json_t *extreme_json(extreme e, const probe_where *where) {
  json_t *j = json_pack("{s:o, s:o}", "value", json_text_real(e.value), "t", json_text_real(e.t));
  return where->known ? json_text_with(j, "at", probe_where_json(where)) : j;
}

static json_t *with_extremes(json_t *all, const char *name, const signal_seen *s) {
  return json_text_with(all, name,
                        json_pack("{s:o, s:o}", "min", extreme_json(s->min, &s->at_min), "max",
                                  extreme_json(s->max, &s->at_max)));
}

json_t *history_extremes(const history *h) {
  json_t *all = h->count > 0 ? json_object() : NULL;
  const signal_seen *s = h->signal;
  for (int i = 0; i < probes_n(h->probes); i++) {
    probe_facts probe = probes_known(h->probes, i);
    char length[256];
    snprintf(length, sizeof length, "%.240s.%s", probe.name, probe.length ? probe.length : "");
    for (int c = 0; c < probe.ncolumn; c++)
      all = with_extremes(all, probes_columns(h->probes)[probe.first + c], s++);
    if (probe.length) all = with_extremes(all, length, s++);
  }
  for (int k = 0; k < OF_ENERGY; k++) all = with_extremes(all, energy_words[k], s++);
  return all;
}

static double range(const signal_seen *s) { return s->max.value - s->min.value; }

/* The component of a displacement that goes furthest; NULL if no probe has one. */
static const signal_seen *widest(const history *h) {
  const signal_seen *best = NULL, *s = h->signal;
  for (int i = 0; i < probes_n(h->probes); i++) {
    probe_facts probe = probes_known(h->probes, i);
    for (int c = 0; probe.moves && c < probe.ncolumn; c++)
      if (!best || range(&s[c]) > range(best)) best = &s[c];
    s += signals_of(probe);
  }
  return best;
}

/* Two periods have four turns; the kinetic energy has twice as many. */
static void find_period(const history *h, history_facts *f) {
  const signal_seen *s = widest(h);
  double turns = s ? 2 : 4;
  f->swing = s ? range(s) : NAN;
  const turning *n = s ? &s->turning : &energy_signal(h, KINETIC)->turning;
  f->period = n->count >= 2 * turns ? turns * turning_mean(n) : 0;
}

history_facts history_known(const history *h) {
  history_facts f = {
      .count = h->count,
      .balance_min = energy_signal(h, BALANCE)->min,
      .balance_max = energy_signal(h, BALANCE)->max,
      .balance = h->balance,
      .dissipated = h->dissipated,
      .kinetic = energy_signal(h, KINETIC)->max.value,
      .t_elastic = h->t_elastic,
      .u = h->u,
      .v = h->v,
  };
  find_period(h, &f);
  for (int k = KINETIC; k <= WORK; k++) {
    const signal_seen *s = energy_signal(h, k);
    f.energy = fmax(f.energy, fmax(fabs(s->min.value), fabs(s->max.value)));
  }
  return f;
}
