/* How far motion on finer meshes has to be integrated, where an extreme comes early. */
#include <math.h>
#include <stdlib.h>

#include "app/folder/read_csv.h"
#include "app/quantity/meter.h"
#include "goal_search.h"

static bool is_extreme(const quantity *q) {
  return q->operation == QUANTITY_MAX || q->operation == QUANTITY_MIN;
}

/* What a run's table has of the quantity's column: n rows, its largest value being the extreme that
   is asked for. */
typedef struct record {
  int n;
  double *t, *x; /* [n] */
} record;

static void forget(record *r) {
  free(r->t);
  free(r->x);
}

static corot_status read_column(const goal_search *s, const csv *table, int column, record *out) {
  const quantity *q = s->request->quantity;
  double sign = q->operation == QUANTITY_MIN ? -1 : 1;
  COROT_TRY(csv_column(table, "t", &out->t));
  COROT_TRY(csv_numbers(table, column, &out->x));
  out->n = table->nrow;
  for (int i = 0; i < out->n; i++) out->x[i] = sign * (q->magnitude ? fabs(out->x[i]) : out->x[i]);
  return COROT_OK;
}

/* Of the table that has the column; without rows where none has. The caller's to forget(), on
   failure, too. */
static corot_status read_record(const goal_search *s, int i, record *out) {
  static const char *const name[] = {"probes.csv", "energy.csv"};
  const attempt *a = goal_attempt(s, i);
  *out = (record){0};
  if (!a->done) return COROT_OK;
  char *folder = attempts_folder(&s->attempts, i);
  corot_status status = folder ? COROT_OK : COROT_ENOMEM;
  for (int k = 0; k < 2 && status == COROT_OK && out->n == 0; k++) {
    csv table;
    status = csv_read_if_there(folder, name[k], &table);
    if (status != COROT_OK) break;
    int column = csv_find(&table, s->attempts.column);
    if (column >= 0) status = read_column(s, &table, column, out);
    csv_free(&table);
  }
  free(folder);
  return status;
}

/* The extreme of what comes after the window over that within it; NaN: not known. */
static corot_status later_extreme(const goal_search *s, int i, double *out) {
  record r;
  corot_status status = read_record(s, i, &r);
  double within = -INFINITY, later = -INFINITY;
  for (int k = 0; status == COROT_OK && k < r.n; k++) {
    double *of = r.t[k] <= s->window ? &within : &later;
    if (r.t[k] >= s->request->quantity->from && r.x[k] > *of) *of = r.x[k];
  }
  bool known = within != 0 && isfinite(within) && isfinite(later);
  *out = known ? 1 + (later - within) / fabs(within) : NAN;
  forget(&r);
  return status;
}

/* The time of the first extreme that comes close to the largest: later ones like it, of a body that
   swings on, say nothing new. NaN: not known. */
static corot_status first_extreme(const goal_search *s, int i, double *when) {
  const quantity *q = s->request->quantity;
  record r;
  corot_status status = read_record(s, i, &r);
  double most = -INFINITY, to = fmin(q->to, s->until);
  int first = -1;
  for (int k = 0; status == COROT_OK && k < r.n; k++)
    if (r.t[k] >= q->from && r.t[k] <= to) most = fmax(most, r.x[k]);
  double close = GOAL_LIKE * goal_allowed(s->request, most);
  for (int k = r.n - 1; status == COROT_OK && k >= 0; k--)
    if (r.t[k] >= q->from && r.t[k] <= to && r.x[k] >= most - close) first = k;
  while (first >= 0 && first + 1 < r.n && r.x[first + 1] > r.x[first]) first++;
  *when = first >= 0 ? r.t[first] : NAN;
  forget(&r);
  return status;
}

/* --- Seen again, as far as a time --- */

/* A piece of the column's curve ends where a step ended for an event, such as a kink of a load. */
static corot_status break_between(const csv *steps, double from, double to, meter *m) {
  int event = csv_find(steps, "event");
  double *t;
  COROT_TRY(csv_column(steps, "t", &t));
  for (int k = 0; event >= 0 && k < steps->nrow; k++)
    if (t[k] >= from && t[k] < to && *steps->cell[k * steps->ncolumn + event]) meter_break(m);
  free(t);
  return COROT_OK;
}

/* t, x [n]: the column at the ends of the steps. */
static corot_status meter_window(const goal_search *s, double to, const csv *steps, int n,
                                 const double *t, const double *x, quantity_value *out) {
  quantity q = *s->request->quantity;
  q.to = to;
  q.column = 0;
  meter *m = NULL;
  COROT_TRY(meter_create(1, &q, s->until, &m));
  corot_status status = COROT_OK;
  for (int k = 0; k < n && status == COROT_OK; k++) {
    meter_row(m, t[k], &x[k], NULL);
    if (k + 1 < n) status = break_between(steps, t[k], t[k + 1], m);
  }
  meter_close(m);
  *out = meter_value(m, 0);
  meter_destroy(m);
  return status;
}

static corot_status meter_history(const goal_search *s, double to, const csv *history,
                                  const csv *steps, quantity_value *out) {
  int column = csv_find(history, s->attempts.column);
  if (column < 0) return COROT_OK;
  double *t, *x = NULL;
  COROT_TRY(csv_column(history, "t", &t));
  corot_status status = csv_numbers(history, column, &x);
  if (status == COROT_OK) status = meter_window(s, to, steps, history->nrow, t, x, out);
  free(t);
  free(x);
  return status;
}

/* What attempt i has of the quantity up to a time; unknown where its folder does not tell. */
static corot_status see_again(const goal_search *s, int i, double to, quantity_value *out) {
  csv history = {0}, steps = {0};
  *out = (quantity_value){.known = false};
  if (!goal_attempt(s, i)->done) return COROT_OK;
  char *folder = attempts_folder(&s->attempts, i);
  if (!folder) return COROT_ENOMEM;
  corot_status status = csv_read_if_there(folder, "history.csv", &history);
  if (status == COROT_OK) status = csv_read_if_there(folder, "steps.csv", &steps);
  if (status == COROT_OK && history.ncolumn > 0 && steps.ncolumn > 0)
    status = meter_history(s, to, &history, &steps, out);
  csv_free(&history);
  csv_free(&steps);
  free(folder);
  return status;
}

/* --- The window --- */

corot_status goal_choose_window(goal_search *s) {
  const quantity *q = s->request->quantity;
  s->window = s->until;
  if (s->request->still || !is_extreme(q)) return COROT_OK;
  double when = goal_value(s, s->full);
  if (!q->when) COROT_TRY(first_extreme(s, s->full, &when));
  double past = 1.05 * when + 0.02 * s->until;
  if (past <= 0.7 * s->until) s->window = past;
  return COROT_OK;
}

/* What comes of a run's steps beside what it found itself, which has slopes to go by: steps that
   are short enough for the whole are so for the window. */
static corot_status is_resolved(const goal_search *s, const attempt *full, bool *out) {
  quantity_value whole;
  COROT_TRY(see_again(s, s->full, s->until, &whole));
  double off = fabs(whole.value - full->value);
  double resolved = s->request->quantity->when
                        ? 1e-6 * s->until
                        : GOAL_RESOLVED * goal_allowed(s->request, full->value);
  *out = whole.known && off <= resolved;
  return COROT_OK;
}

/* The first mesh's run goes further: its value is that within the window, as of those to come. */
static corot_status look_through(goal_search *s, bool *known) {
  attempt *full = goal_attempt(s, s->full);
  quantity_value seen;
  COROT_TRY(is_resolved(s, full, known));
  if (!*known) return COROT_OK;
  COROT_TRY(see_again(s, s->full, s->window, &seen));
  *known = seen.known;
  if (!*known) return COROT_OK;
  s->whole = *full;
  full->value = seen.value;
  full->when = seen.t;
  return COROT_OK;
}

corot_status goal_look_through_window(goal_search *s) {
  const attempt *full = goal_attempt(s, s->full);
  double when = s->request->quantity->when ? full->value : full->when;
  bool known;
  if (s->request->still || s->window >= s->until || when < s->window) return COROT_OK;
  COROT_TRY(look_through(s, &known));
  if (!known) s->level[0] = attempts_plan(&s->attempts, goal_base_def(s));
  return COROT_OK;
}

bool goal_keeps_window(goal_search *s, int i) {
  const quantity *q = s->request->quantity;
  double when = q->when ? goal_value(s, i) : goal_attempt(s, i)->when;
  if (s->window >= s->until || when < s->window * (1 - 1e-6)) return true;
  s->window = s->until;
  if (s->whole.done) *goal_attempt(s, s->full) = s->whole;
  return false;
}

/* How a later extreme compares with the early one has changed from four-node to ten-node tets; from
   these to the last mesh it changes in proportion to the value, twice that to be safe. */
corot_status goal_find_tail(goal_search *s) {
  double before, now;
  s->tail = 0;
  if (s->window >= s->until || s->nlevel < 2) return COROT_OK;
  COROT_TRY(later_extreme(s, s->coarse, &before));
  COROT_TRY(later_extreme(s, s->full, &now));
  double base = goal_value(s, s->level[0]), last = goal_value(s, s->level[s->nlevel - 1]);
  double moved = fabs((last - base) / (base - goal_value(s, s->coarse)));
  double later = now + 2 * fabs(now - before) * fmin(1, moved);
  if (later <= 1) return COROT_OK;
  s->tail = isfinite(later) ? later - 1 : INFINITY;
  return COROT_OK;
}
