/* How to integrate: a method and a tolerance that leave the error to the mesh. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "goal_search.h"

#define LOWEST_RTOL 1e-9

/* Two methods, the scenario's own and another, at a tolerance and at a tenth of it. */
typedef struct trial {
  const char *method[2];
  bool stages[2];
  int at[2][2]; /* attempts: [method][tolerance] */
} trial;

static const char *own_method(const scenario *s) {
  return corot_integrator_controls_error(s->integrator.method) ? s->integrator.method : "cvode";
}

static trial begin(const scenario *s) {
  trial t = {.method = {own_method(s), "arkode"}, .at = {{-1, -1}, {-1, -1}}};
  if (strcmp(t.method[0], t.method[1]) == 0) t.method[1] = "cvode";
  for (int i = 0; i < 2; i++) t.stages[i] = corot_method_traits(t.method[i])->stages;
  return t;
}

static int plan(goal_search *s, const char *method, double rtol) {
  attempt_def def = {.order = 1,
                     .refine = s->attempts.scenario->refine,
                     .method = method,
                     .rtol = rtol,
                     .until = s->until};
  return attempts_plan(&s->attempts, def);
}

/* The method that is the better reference: a Runge-Kutta method, whose error is in proportion to
   the tolerance. */
static int better_of(const trial *t) { return t->stages[0] ? 0 : 1; }

/* Both at the tolerance, the better one at a tenth of it. */
static void plan_most(goal_search *s, trial *t, double rtol) {
  int better = better_of(t);
  for (int i = 0; i < 2; i++) t->at[i][0] = plan(s, t->method[i], rtol);
  t->at[better][1] = plan(s, t->method[better], rtol / 10);
  t->at[!better][1] = -1;
}

/* The other one at a tenth, too, with which more is known. */
static void plan_last(goal_search *s, trial *t, double rtol) {
  int other = !better_of(t);
  t->at[other][1] = plan(s, t->method[other], rtol / 10);
}

/* What the two methods at a tenth of the tolerance say of those at the whole. */
static void judge(const goal_search *s, const trial *t, double off[2]) {
  int better = better_of(t);
  double reference = goal_value(s, t->at[better][1]), other = goal_value(s, t->at[!better][1]);
  double loose = goal_value(s, t->at[better][0]);
  if (isnan(reference)) reference = other;
  double known = fmin(fabs(other - reference), fabs(loose - reference));
  for (int i = 0; i < 2; i++) off[i] = fabs(goal_value(s, t->at[i][0]) - reference) + known;
}

/* Of methods that are good enough, the one with fewer solutions of a linear system. */
static bool accept(goal_search *s, const trial *t, double rtol) {
  double off[2], least = INFINITY;
  judge(s, t, off);
  for (int i = 0; i < 2; i++) {
    const attempt *a = goal_attempt(s, t->at[i][0]);
    if (!(off[i] <= GOAL_TIME_SHARE * goal_allowed(s->request, a->value))) continue;
    if (!(a->work < least)) continue;
    least = a->work;
    s->method = t->method[i];
    s->rtol = rtol;
    s->coarse = t->at[i][0];
    s->coarse_off = off[i] / fabs(a->value);
  }
  return isfinite(least);
}

/* The first attempt of all: whether there is anything to be looked for. */
static corot_status make_first(goal_search *s, const trial *t, double rtol, bool *go_on) {
  int first = plan(s, t->method[0], rtol);
  COROT_TRY(attempts_make(&s->attempts));
  s->coarse = first;
  *go_on = !s->attempts.signal_number && goal_is_sensible(s, first);
  return COROT_OK;
}

/* No tolerance was small enough: the smallest is taken, by the better method. */
static void settle(goal_search *s, const trial *t, double rtol) {
  double off[2];
  judge(s, t, off);
  int i = off[1] < off[0] || isnan(off[0]) ? 1 : 0;
  s->method = t->method[i];
  s->rtol = rtol;
  s->coarse = t->at[i][0];
  s->coarse_off = off[i] / fabs(goal_value(s, s->coarse));
}

corot_status goal_choose_time(goal_search *s) {
  trial t = begin(s->attempts.scenario);
  double rtol = s->request->absolute ? 1e-3 : fmin(1e-3, s->request->within);
  bool go_on;
  COROT_TRY(make_first(s, &t, rtol, &go_on));
  while (go_on) {
    plan_most(s, &t, rtol);
    COROT_TRY(attempts_make(&s->attempts));
    if (s->attempts.signal_number || accept(s, &t, rtol)) return COROT_OK;
    plan_last(s, &t, rtol);
    COROT_TRY(attempts_make(&s->attempts));
    if (s->attempts.signal_number || accept(s, &t, rtol)) return COROT_OK;
    double last = goal_attempt(s, t.at[0][1])->cpu + goal_attempt(s, t.at[1][1])->cpu;
    go_on = rtol > LOWEST_RTOL * 1.01 && goal_affords(s, 2.5 * last);
    if (!go_on) settle(s, &t, rtol);
    rtol /= 10;
  }
  return COROT_OK;
}

/* --- On ten-node tets --- */

static int plan_base(goal_search *s, double rtol, double until) {
  attempt_def def = {.order = 2,
                     .refine = s->attempts.scenario->refine,
                     .method = s->method,
                     .rtol = rtol,
                     .until = until};
  return attempts_plan(&s->attempts, def);
}

void goal_plan_base(goal_search *s) {
  s->level[0] = s->full = plan_base(s, s->rtol, s->until);
  s->nlevel = 1;
}

/* An attempt as far as the window. */
static attempt_def windowed(const goal_search *s, int i) {
  attempt_def def = goal_attempt(s, i)->def;
  if (s->window < s->until) def.until = s->window;
  return def;
}

/* By what the error of time of attempt `timed` is judged: a Runge-Kutta method's falls with the
   tolerance, and shows in ten times as much; that of a multistep method may rise and fall, and
   shows beside a Runge-Kutta method. */
static void plan_check(goal_search *s, int timed) {
  bool stages = corot_method_traits(s->method)->stages;
  attempt_def def = windowed(s, timed);
  def.method = stages ? s->method : "arkode";
  if (stages) def.rtol = fmin(10 * s->rtol, 0.1);
  s->timed = timed;
  s->check = attempts_plan(&s->attempts, def);
}

void goal_plan_check(goal_search *s) {
  if (!s->request->still) plan_check(s, s->level[0]);
}

attempt_def goal_base_def(const goal_search *s) { return windowed(s, s->level[0]); }

/* Half-width by the check alone. */
static double find_time(goal_search *s) {
  goal_result *r = s->result;
  double value = goal_value(s, s->timed), coarse = s->coarse_off * fabs(value);
  double changed = fabs(value - goal_value(s, s->check));
  bool stages = corot_method_traits(s->method)->stages;
  if (isnan(changed)) changed = GOAL_UNCHECKED * coarse; /* the check has failed */
  r->time = fmax(stages ? changed / 10 : changed, coarse);
  r->half_time = 1.25 * fmax(stages ? changed / 2 : changed, coarse);
  return stages ? changed / 2 : changed;
}

/* All meshes by the method and the tolerance in use, of which there is the attempt on the last one.
 */
static void plan_again(goal_search *s, int last) {
  for (int i = 0; i + 1 < s->nlevel; i++) {
    attempt_def def = windowed(s, s->level[i]);
    def.method = s->method, def.rtol = s->rtol;
    s->level[i] = attempts_plan(&s->attempts, def);
  }
  s->level[s->nlevel - 1] = s->timed = last;
}

/* The check of a multistep method is the better one, and has ten times its tolerance for a check.
 */
static void tighten(goal_search *s) {
  int before = s->timed, check = s->check;
  if (corot_method_traits(s->method)->stages) {
    attempt_def def = windowed(s, before);
    s->rtol = def.rtol /= 10;
    plan_again(s, attempts_plan(&s->attempts, def));
    s->check = before;
  } else {
    s->method = "arkode";
    plan_again(s, check);
    plan_check(s, check);
  }
}

static bool all_have_values(const goal_search *s) {
  bool all = true;
  for (int i = 0; i < s->nlevel; i++) all = all && !isnan(goal_value(s, s->level[i]));
  return all;
}

/* On the last mesh, of which a check has been made. Where a smaller tolerance comes to nothing, the
   one before it stays. */
corot_status goal_settle_time(goal_search *s) {
  while (!s->request->still) {
    double value = goal_value(s, s->timed), half = find_time(s);
    bool enough = half <= 1.25 * GOAL_TIME_SHARE * goal_allowed(s->request, value);
    if (enough || isnan(value) || s->rtol <= LOWEST_RTOL) break;
    if (!goal_affords(s, (1 + s->nlevel) * goal_attempt(s, s->timed)->cpu)) break;
    goal_search before = *s;
    tighten(s);
    COROT_TRY(attempts_make(&s->attempts));
    if (s->attempts.signal_number) break;
    if (s->nlevel > 1 && !all_have_values(s)) {
      before.attempts = s->attempts;
      *s = before;
      break;
    }
  }
  return COROT_OK;
}

/* Finer meshes carry waves that coarser ones do not, and whose error of time is another; it would
   show in the value. */
corot_status goal_settle_time_again(goal_search *s) {
  goal_result *r = s->result;
  if (s->request->still || s->nlevel != 2) return COROT_OK;
  double changed = fabs(goal_value(s, s->level[1]) - goal_value(s, s->level[0]));
  bool quiet = goal_attempt(s, s->full)->swing <= GOAL_QUIET;
  if (r->met && (quiet || changed <= GOAL_SAME * goal_allowed(s->request, r->value)))
    return COROT_OK;
  double first = r->time, first_half = r->half_time, rtol = s->rtol;
  const char *method = s->method;
  plan_check(s, s->level[1]);
  COROT_TRY(attempts_make(&s->attempts));
  if (s->attempts.signal_number) return COROT_OK;
  COROT_TRY(goal_settle_time(s));
  if (s->attempts.signal_number) return COROT_OK;
  if (s->rtol == rtol && s->method == method) { /* the worse of both meshes */
    r->time = fmax(r->time, first);
    r->half_time = fmax(r->half_time, first_half);
    return COROT_OK;
  }
  goal_plan_algebra(s);
  return attempts_make(&s->attempts);
}
