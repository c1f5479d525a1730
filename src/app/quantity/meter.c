/* Cubics from step to step, and what each quantity takes of them. */
#include "meter.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "cubic.h"
#include "turning.h"

/* The steps next to one take part in its slopes unless they are shorter by more than this: the
   slope of a short one is mostly the error of its ends. */
#define LEAST_NEIGHBOUR 0.05

/* Times of a run that differ by less, in parts of its length, are the same but for rounding. */
#define SAME_TIME 1e-9

enum { POINTS = 4 };

typedef struct place {
  double value, t;
} place;

/* One quantity on its way. */
typedef struct track {
  quantity q;
  double to;    /* end of the window [s], finite */
  double slack; /* by which times may be off [s] */
  int n, next;  /* points of the piece that are kept; the first whose step is not done yet */
  double t[POINTS], x[POINTS], rate[POINTS];
  bool seen;         /* something of the window */
  double begin, end; /* what has been seen of it [s] */
  double hole;       /* where the column was no number; NaN: nowhere */
  place at, low, high;
  double integral;
  turning turning;
} track;

struct meter {
  int n;
  double t; /* of the last row [s] */
  track track[];
};

corot_status meter_create(int n, const quantity *q, double end, meter **out) {
  meter *m = calloc(1, sizeof *m + (size_t)n * sizeof *m->track);
  if (!m) return corot_fail(COROT_ENOMEM, "quantities: out of memory");
  m->n = n;
  m->t = NAN;
  for (int i = 0; i < n; i++) {
    m->track[i] = (track){
        .q = q[i], .to = isfinite(q[i].to) ? q[i].to : end, .slack = SAME_TIME * end, .hole = NAN};
    if (!isfinite(q[i].from)) m->track[i].q.from = end; /* the value at the end */
  }
  *out = m;
  return COROT_OK;
}

void meter_destroy(meter *m) { free(m); }

int meter_count(const meter *m) { return m->n; }

/* --- One step --- */

static void see(track *k, double x, double t) {
  if (!k->seen) {
    k->seen = true;
    k->begin = k->end = t;
    k->low = k->high = (place){x, t};
    k->turning = turning_begin(x, t);
    return;
  }
  if (x < k->low.value) k->low = (place){x, t};
  if (x > k->high.value) k->high = (place){x, t};
  turning_follow(&k->turning, k->high.value - k->low.value, x, t);
}

static double sized(const track *k, double x) { return k->q.magnitude ? fabs(x) : x; }

/* The part of it from s = a to b. */
static void take_part(track *k, const cubic *p, double a, double b) {
  double s[CUBIC_CUTS];
  int n = cubic_cuts(p, a, b, k->q.magnitude, s);
  for (int i = 0; i < n; i++) see(k, sized(k, cubic_at(p, s[i])), cubic_time(p, s[i]));
  for (int i = 0; i + 1 < n; i++) k->integral += sized(k, cubic_integral(p, s[i], s[i + 1]));
  k->end = fmax(k->end, cubic_time(p, b));
}

static void take_cubic(track *k, const cubic *p) {
  double from = k->q.from, to = k->to, t1 = p->t1;
  if (k->q.operation == QUANTITY_AT) {
    if (k->seen || !(p->t0 <= to && to <= t1)) return;
    k->at = (place){sized(k, cubic_at(p, p->h > 0 ? (to - p->t0) / p->h : 0)), to};
    k->seen = true;
    k->begin = k->end = to;
  } else if (p->h > 0 && t1 > from && p->t0 < to) {
    take_part(k, p, fmax(0, (from - p->t0) / p->h), fmin(1, (to - p->t0) / p->h));
  } else if (p->h == 0 && t1 >= from && p->t0 <= to) {
    see(k, sized(k, p->x0), p->t0);
  }
}

/* Which of the points about step i its slopes are made from: those from *first on, so many. */
static int neighbours(const track *k, int i, int *first) {
  double least = LEAST_NEIGHBOUR * (k->t[i + 1] - k->t[i]);
  int low = i, high = i + 1;
  while (low > 0 && k->t[low] - k->t[low - 1] >= least) low--;
  while (high + 1 < k->n && k->t[high + 1] - k->t[high] >= least) high++;
  *first = low;
  return high - low + 1;
}

/* The step from point i of the piece to the next. */
static void take_step(track *k, int i) {
  int first, n = neighbours(k, i, &first);
  const double *t = k->t + first, *x = k->x + first;
  double slope[2];
  for (int side = 0; side < 2; side++) {
    double rate = k->rate[i + side];
    slope[side] = rate == rate ? rate : cubic_slope(n, t, x, i + side - first);
  }
  cubic p = cubic_between(k->t[i], k->x[i], slope[0], k->t[i + 1], k->x[i + 1], slope[1]);
  take_cubic(k, &p);
}

/* --- Points --- */

/* Ends a piece: what has waited for more points is done with those that there are. */
static void end_piece(track *k) {
  if (k->n == 1 && k->next == 0) {
    cubic point = cubic_between(k->t[0], k->x[0], 0, k->t[0], k->x[0], 0);
    take_cubic(k, &point);
  }
  for (; k->next + 1 < k->n; k->next++) take_step(k, k->next);
}

static void begin_piece(track *k, double t, double x, double rate) {
  k->n = 1;
  k->next = 0;
  k->t[0] = t, k->x[0] = x, k->rate[0] = rate;
}

/* The oldest makes room. */
static void drop_point(track *k) {
  for (int i = 0; i + 1 < k->n; i++)
    k->t[i] = k->t[i + 1], k->x[i] = k->x[i + 1], k->rate[i] = k->rate[i + 1];
  k->n--;
  k->next--;
}

static bool has_rates(const track *k, int i) {
  return k->rate[i] == k->rate[i] && k->rate[i + 1] == k->rate[i + 1];
}

/* A step with its slopes is done at once, one without waits for the point after it. */
static void add_point(track *k, double t, double x, double rate) {
  if (k->n > 0 && !(t > k->t[k->n - 1])) {
    end_piece(k);
    k->n = 0;
  }
  if (k->n == 0) {
    begin_piece(k, t, x, rate);
    return;
  }
  if (k->n == POINTS) drop_point(k);
  k->t[k->n] = t, k->x[k->n] = x, k->rate[k->n] = rate;
  k->n++;
  while (k->next + 1 < k->n && (has_rates(k, k->next) || (k->n == POINTS && k->next + 2 < POINTS)))
    take_step(k, k->next++);
}

void meter_row(meter *m, double t, const double *value, const double *rate) {
  m->t = t;
  for (int i = 0; i < m->n; i++) {
    track *k = &m->track[i];
    double x = value[k->q.column];
    if (!isfinite(x)) {
      bool within = t >= k->q.from - k->slack && t <= k->to + k->slack;
      if (within && isnan(k->hole)) k->hole = t;
      end_piece(k);
      k->n = 0;
      continue;
    }
    add_point(k, t, x, rate ? rate[k->q.column] : NAN);
  }
}

/* The last point begins the new piece, too. */
void meter_break(meter *m) {
  for (int i = 0; i < m->n; i++) {
    track *k = &m->track[i];
    if (k->n < 2) continue;
    end_piece(k);
    int last = k->n - 1;
    begin_piece(k, k->t[last], k->x[last], NAN);
  }
}

/* A run may end before its end by rounding. */
static void reach_end(track *k) {
  if (k->n == 0) return;
  double t = k->t[k->n - 1];
  if (t < k->to && t >= k->to - k->slack && k->q.operation == QUANTITY_AT && !k->seen) {
    k->seen = true;
    k->at = (place){sized(k, k->x[k->n - 1]), t};
    k->begin = k->end = k->to;
  }
}

void meter_close(meter *m) {
  for (int i = 0; i < m->n; i++) {
    end_piece(&m->track[i]);
    reach_end(&m->track[i]);
  }
}

/* --- Checkpoints --- */

static void exchange_place(pack *p, place *x) {
  corot_pack_double(p, &x->value);
  corot_pack_double(p, &x->t);
}

static void exchange_track(pack *p, track *k) {
  corot_pack_int(p, &k->n);
  corot_pack_int(p, &k->next);
  corot_pack_doubles(p, k->t, POINTS);
  corot_pack_doubles(p, k->x, POINTS);
  corot_pack_doubles(p, k->rate, POINTS);
  corot_pack_bool(p, &k->seen);
  corot_pack_double(p, &k->begin);
  corot_pack_double(p, &k->end);
  corot_pack_double(p, &k->hole);
  exchange_place(p, &k->at);
  exchange_place(p, &k->low);
  exchange_place(p, &k->high);
  corot_pack_double(p, &k->integral);
  turning_exchange(p, &k->turning);
}

void meter_exchange(pack *p, meter *m) {
  corot_pack_same(p, (uint64_t)m->n, "the number of quantities");
  corot_pack_double(p, &m->t);
  for (int i = 0; i < m->n; i++) exchange_track(p, &m->track[i]);
}

/* --- What has come of it --- */

/* Turns that a period has at least: three are two ways, there and back. */
#define PERIOD_TURNS 3

/* The ways between turns are together at least this part of the span: those of noise about a signal
   that only rises are not. */
#define PERIOD_WAYS 0.1

static bool oscillates(const track *k) {
  const turning *n = &k->turning;
  return n->count >= PERIOD_TURNS && n->weight > PERIOD_WAYS * (k->high.value - k->low.value);
}

static double number(const track *k) {
  switch (k->q.operation) {
    case QUANTITY_AT:
      return k->at.value;
    case QUANTITY_MAX:
      return k->q.when ? k->high.t : k->high.value;
    case QUANTITY_MIN:
      return k->q.when ? k->low.t : k->low.value;
    case QUANTITY_MEAN:
      return k->integral / (k->to - k->q.from);
    case QUANTITY_INTEGRAL:
      return k->integral;
    case QUANTITY_AMPLITUDE:
      return (k->high.value - k->low.value) / 2;
    default:
      return oscillates(k) ? 2 * turning_mean(&k->turning) : NAN;
  }
}

static double moment(const track *k) {
  if (k->q.operation == QUANTITY_AT) return k->at.t;
  if (k->q.when) return NAN;
  if (k->q.operation == QUANTITY_MAX) return k->high.t;
  return k->q.operation == QUANTITY_MIN ? k->low.t : NAN;
}

static void explain(const meter *m, const track *k, size_t size, char *why) {
  if (k->hole == k->hole)
    snprintf(why, size, "the column has no value at t = %g s", k->hole);
  else if (!(m->t >= k->to - k->slack))
    snprintf(why, size, "the answer ends at t = %g s, and does not reach %g s", m->t, k->to);
  else if (k->seen && k->q.operation == QUANTITY_PERIOD)
    snprintf(why, size, "it does not oscillate: it turns %ld time%s, and three turns make a period",
             k->turning.count, k->turning.count == 1 ? "" : "s");
  else
    snprintf(why, size, "the column has no value there");
}

quantity_value meter_value(const meter *m, int i) {
  const track *k = &m->track[i];
  bool whole = k->seen && k->end >= k->to - k->slack && k->begin <= k->q.from + k->slack;
  quantity_value v = {.reached = m->t >= k->to - k->slack, .value = NAN, .t = NAN};
  if (whole && isnan(k->hole)) v.value = k->q.absolute ? fabs(number(k)) : number(k);
  v.known = isfinite(v.value);
  if (v.known)
    v.t = moment(k);
  else
    explain(m, k, sizeof v.why, v.why);
  return v;
}
