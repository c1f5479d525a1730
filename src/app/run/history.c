/* Writes each step as it comes, and keeps the extremes. */
#include "history.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/text/json_text.h"

/* Four signals for each probe, and these of the energies. */
enum { UX, UY, UZ, MAGNITUDE, OF_PROBE };
enum { KINETIC, ELASTIC, DISSIPATED, WORK, BALANCE, FRAMES, OF_ENERGY };

static const char *const component_words[OF_PROBE] = {"ux", "uy", "uz", "u"};
static const char *const energy_words[OF_ENERGY] = {"kinetic",       "elastic", "dissipated",
                                                    "external_work", "balance", "frame_energy"};

/* Where a signal turns, but for what is less than a tenth of the way it has gone so far. */
typedef struct turning {
  int direction;           /* 1, -1; 0: it has not moved yet */
  double value, t;         /* the furthest point since the last turn */
  double last, t_last;     /* the last turn, or the start */
  long count;              /* turns */
  double weight, weighted; /* sum of the ways between turns; of these times their durations */
} turning;

typedef struct signal_seen {
  extreme min, max;
  turning turning;
} signal_seen;

struct history {
  int nprobe, ndof;
  const probe_def *probe;
  table *table;        /* NULL: it is not written */
  signal_seen *signal; /* [OF_PROBE nprobe + OF_ENERGY] the probes', then the energies' */
  long count;
  double balance, dissipated; /* at the last moment */
  double t_elastic, *u, *v;   /* [ndof] at the largest elastic energy */
};

static int nsignal(const history *h) { return OF_PROBE * h->nprobe + OF_ENERGY; }

static const signal_seen *energy_signal(const history *h, int which) {
  return &h->signal[OF_PROBE * h->nprobe + which];
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

corot_status history_create(const scenario *s, int ndof, history **out) {
  history *h = calloc(1, sizeof *h);
  if (!h) return corot_fail(COROT_ENOMEM, "the history: out of memory");
  h->nprobe = s->nprobe;
  h->probe = s->probe;
  h->ndof = ndof;
  h->signal = calloc((size_t)nsignal(h), sizeof *h->signal);
  h->u = calloc((size_t)ndof + 1, sizeof *h->u);
  h->v = calloc((size_t)ndof + 1, sizeof *h->v);
  if (!h->signal || !h->u || !h->v) {
    history_destroy(h);
    return corot_fail(COROT_ENOMEM, "the history: out of memory");
  }
  *out = h;
  return COROT_OK;
}

corot_status history_open(history *h, const char *dir) {
  const char **name = malloc(((size_t)h->nprobe + 1) * sizeof *name);
  if (!name) return corot_fail(COROT_ENOMEM, "the history: out of memory");
  for (int i = 0; i < h->nprobe; i++) name[i] = h->probe[i].name;
  corot_status status = history_table_open(dir, h->nprobe, name, &h->table);
  free(name);
  return status;
}

/* --- One moment --- */

static void take_turn(turning *n) {
  double way = fabs(n->value - n->last);
  if (n->count++ > 0) { /* the first way begins at the start, which need not be a turn */
    n->weight += way;
    n->weighted += way * (n->t - n->t_last);
  }
  n->last = n->value;
  n->t_last = n->t;
}

static void follow(turning *n, double span, double value, double t) {
  double ahead = n->direction * (value - n->value);
  if (n->direction == 0) {
    n->direction = (value > n->last) - (value < n->last);
    ahead = 0;
  } else if (ahead < 0) {
    if (!(-ahead > 0.1 * span)) return;
    take_turn(n);
    n->direction = -n->direction;
  }
  n->value = value;
  n->t = t;
}

static void see(signal_seen *s, bool first, double value, double t) {
  if (first) {
    s->min = s->max = (extreme){value, t};
    s->turning = (turning){.value = value, .t = t, .last = value, .t_last = t};
    return;
  }
  if (value < s->min.value) s->min = (extreme){value, t};
  if (value > s->max.value) s->max = (extreme){value, t};
  follow(&s->turning, s->max.value - s->min.value, value, t);
}

corot_status history_add(history *h, const ledger *now, const int *node,
                         const double (*displacement)[3], const double *u, const double *v) {
  bool first = h->count++ == 0;
  signal_seen *s = h->signal;
  for (int i = 0; i < h->nprobe; i++, s += OF_PROBE) {
    const double *d = displacement[node[i]];
    for (int c = 0; c < 3; c++) see(&s[UX + c], first, d[c], now->t);
    see(&s[MAGNITUDE], first, sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), now->t);
  }
  const double energy[OF_ENERGY] = {now->kinetic,       now->elastic, now->dissipated,
                                    now->external_work, now->balance, now->frame_energy};
  if (first || now->elastic > s[ELASTIC].max.value) {
    memcpy(h->u, u, (size_t)h->ndof * sizeof *u);
    memcpy(h->v, v, (size_t)h->ndof * sizeof *v);
    h->t_elastic = now->t;
  }
  for (int k = 0; k < OF_ENERGY; k++) see(&s[k], first, energy[k], now->t);
  h->balance = now->balance;
  h->dissipated = now->dissipated;
  return h->table ? history_row(h->table, now, h->nprobe, node, displacement) : COROT_OK;
}

/* --- What is known in the end --- */

static json_t *extreme_json(extreme e) {
  return json_pack("{s:o, s:o}", "value", json_text_real(e.value), "t", json_text_real(e.t));
}

static json_t *with_extremes(json_t *all, const char *name, const signal_seen *s) {
  return json_text_with(
      all, name, json_pack("{s:o, s:o}", "min", extreme_json(s->min), "max", extreme_json(s->max)));
}

json_t *history_extremes(const history *h) {
  json_t *all = h->count > 0 ? json_object() : NULL;
  const signal_seen *s = h->signal;
  for (int i = 0; i < h->nprobe; i++)
    for (int k = 0; k < OF_PROBE; k++) {
      char name[256];
      snprintf(name, sizeof name, "%.240s.%s", h->probe[i].name, component_words[k]);
      all = with_extremes(all, name, s++);
    }
  for (int k = 0; k < OF_ENERGY; k++) all = with_extremes(all, energy_words[k], s++);
  return all;
}

static double range(const signal_seen *s) { return s->max.value - s->min.value; }

/* The component that goes furthest; NULL if there are no probes. */
static const signal_seen *widest(const history *h) {
  const signal_seen *best = NULL;
  for (int k = 0; k < OF_PROBE * h->nprobe; k++) {
    const signal_seen *s = &h->signal[k];
    if (k % OF_PROBE != MAGNITUDE && (!best || range(s) > range(best))) best = s;
  }
  return best;
}

/* Two periods have four turns; the kinetic energy has twice as many. */
static void find_period(const history *h, history_facts *f) {
  const signal_seen *s = widest(h);
  double turns = s ? 2 : 4;
  f->swing = s ? range(s) : NAN;
  const turning *n = s ? &s->turning : &energy_signal(h, KINETIC)->turning;
  f->period = n->count >= 2 * turns && n->weight > 0 ? turns * n->weighted / n->weight : 0;
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
