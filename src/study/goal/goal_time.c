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

/* By what the error of time is judged there: a Runge-Kutta method's falls with the tolerance, and
   shows in ten times as much; that of a multistep method may rise and fall, and shows beside a
   Runge-Kutta method. */
void goal_plan_check(goal_search *s) {
  if (s->request->still) return;
  bool stages = corot_method_traits(s->method)->stages;
  attempt_def def = goal_base_def(s);
  def.method = stages ? s->method : "arkode";
  if (stages) def.rtol = fmin(10 * s->rtol, 0.1);
  s->check = attempts_plan(&s->attempts, def);
}

/* Half-width by the check alone. */
static double find_time(goal_search *s) {
  goal_result *r = s->result;
  double value = goal_value(s, s->level[0]), coarse = s->coarse_off * fabs(value);
  double changed = fabs(value - goal_value(s, s->check));
  bool stages = corot_method_traits(s->method)->stages;
  if (isnan(changed)) changed = GOAL_UNCHECKED * coarse; /* the check has failed */
  r->time = fmax(stages ? changed / 10 : changed, coarse);
  r->half_time = 1.25 * fmax(stages ? changed / 2 : changed, coarse);
  return stages ? changed / 2 : changed;
}

/* The check of a multistep method is the better one, and has ten times its tolerance for a check.
 */
static void tighten(goal_search *s) {
  if (corot_method_traits(s->method)->stages) {
    s->rtol /= 10;
    s->check = s->level[0];
    s->level[0] = plan_base(s, s->rtol, s->window);
  } else {
    s->method = "arkode";
    s->level[0] = s->check;
    goal_plan_check(s);
  }
}

corot_status goal_settle_time(goal_search *s) {
  while (!s->request->still) {
    double value = goal_value(s, s->level[0]), half = find_time(s);
    bool enough = half <= 1.25 * GOAL_TIME_SHARE * goal_allowed(s->request, value);
    if (enough || isnan(value) || s->rtol <= LOWEST_RTOL) break;
    if (!goal_affords(s, 2 * goal_attempt(s, s->level[0])->cpu)) break;
    tighten(s);
    COROT_TRY(attempts_make(&s->attempts));
    if (s->attempts.signal_number) break;
  }
  return COROT_OK;
}
