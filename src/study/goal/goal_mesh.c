/* Ever finer meshes, and how far motion on them has to be integrated. */
#include <math.h>
#include <stdlib.h>

#include "app/folder/read_csv.h"
#include "goal_mark.h"
#include "goal_search.h"
#include "study/execute/store.h"

#define DOFS_MOST 3e6

/* --- The window of an early extreme --- */

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
  char *folder = store_path(s->attempts.options.dir, &s->attempts.manifest->run[a->at], "");
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

/* --- The next mesh --- */

/* A level of the mesh in use, with s->npass and s->refine. */
static int plan_level(goal_search *s) {
  attempt_def def = {.order = 2,
                     .refine = s->refine,
                     .npass = s->npass,
                     .method = s->method,
                     .rtol = s->rtol,
                     .until = s->window};
  return attempts_plan(&s->attempts, def);
}

/* What a mesh of so many times the unknowns costs; a factor's work grows faster than they do. */
static double cost_of(const goal_search *s, double growth) {
  const attempt *last = goal_attempt(s, s->level[s->nlevel - 1]);
  double part = last->def.until > s->window ? s->window / last->def.until : 1;
  double start = fmin(0.05, last->cpu); /* of the program, whatever the mesh */
  return start + (last->cpu - start) * (s->request->still ? 1 : part) * pow(growth, 1.25);
}

/* Whether the extreme is inside of the window; else the window is given up. */
static bool is_inside(goal_search *s, int i) {
  const quantity *q = s->request->quantity;
  double when = q->when ? goal_value(s, i) : goal_attempt(s, i)->when;
  if (s->window >= s->until || when < s->window * (1 - 1e-6)) return true;
  s->window = s->until;
  return false;
}

corot_status goal_refine(goal_search *s, bool *made) {
  *made = false;
  const attempt *last = goal_attempt(s, s->level[s->nlevel - 1]);
  if (s->nlevel == GOAL_LEVELS) {
    snprintf(s->result->obstacle, sizeof s->result->obstacle, "%d meshes were not enough",
             GOAL_LEVELS);
    return COROT_OK;
  }

  /* where: everywhere, or where the estimator says */
  goal_marking marking;
  COROT_TRY(goal_mark(s, &marking));
  if (last->dofs * marking.growth > DOFS_MOST) {
    snprintf(s->result->obstacle, sizeof s->result->obstacle,
             "the next mesh would have some %.2g unknowns", last->dofs * marking.growth);
    return COROT_OK;
  }
  if (!goal_affords(s, cost_of(s, marking.growth))) return COROT_OK;
  s->npass += marking.local;
  s->refine += !marking.local;

  /* its run */
  int level = plan_level(s);
  if (level < 0) return COROT_OK;
  COROT_TRY(attempts_make(&s->attempts));
  if (s->attempts.signal_number) return COROT_OK;
  if (goal_attempt(s, level)->done && !is_inside(s, level)) {
    level = plan_level(s);
    if (level >= 0) COROT_TRY(attempts_make(&s->attempts));
    if (level < 0 || s->attempts.signal_number) return COROT_OK;
  }
  const attempt *next = goal_attempt(s, level);
  if (isnan(next->value)) {
    snprintf(s->result->obstacle, sizeof s->result->obstacle, "%.100s: %.300s", next->label,
             next->reason);
    return COROT_OK;
  }
  s->level[s->nlevel++] = level;
  *made = true;
  return COROT_OK;
}
