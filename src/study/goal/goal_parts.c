/* The parts of the error, and what they come to. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "app/run/exit_code.h"
#include "goal_search.h"

double goal_value(const goal_search *s, int i) { return i >= 0 ? s->attempts.all[i].value : NAN; }

double goal_allowed(const goal_request *r, double value) {
  return r->absolute ? r->within : r->within * fabs(value);
}

bool goal_affords(goal_search *s, double cpu) {
  double spent = attempts_cpu(&s->attempts), limit = s->request->cpu_limit;
  if (spent + cpu <= limit) return true;
  snprintf(s->result->obstacle, sizeof s->result->obstacle,
           "the limit of %g s of CPU: %.3g s are spent, and the next attempt needs about %.3g s "
           "(--cpu-limit)",
           limit, spent, cpu);
  return false;
}

bool goal_is_sensible(goal_search *s, int i) {
  const attempt *a = goal_attempt(s, i);
  goal_result *r = s->result;
  if (!a->done) {
    snprintf(r->obstacle, sizeof r->obstacle, "the first attempt, %.100s: %.300s", a->label,
             a->reason);
    if (s->request->still && a->exit_code == EXIT_INTEGRATOR)
      snprintf(r->advice, sizeof r->advice,
               "under these loads there is no equilibrium to be found: smaller loads have one, and "
               "without --static the motion has an answer");
    r->exit_code = a->exit_code;
    return false;
  }
  if (isnan(a->value)) {
    snprintf(r->obstacle, sizeof r->obstacle, "%.200s has no value: %.250s", s->request->text,
             a->reason);
    r->senseless = true;
    return false;
  }
  if (a->largest == 0 && !s->request->absolute) {
    snprintf(r->obstacle, sizeof r->obstacle,
             "%.200s is zero at all times, and so is its error: a goal wants something that moves",
             s->attempts.column);
    r->senseless = true;
    return false;
  }
  return true;
}

/* --- Algebra, and the measure --- */

/* Where runs are cheap: of motion, four-node tets, at the tolerance in use. */
void goal_plan_algebra(goal_search *s) {
  attempt_def def = goal_attempt(s, s->request->still ? s->level[0] : s->coarse)->def;
  if (!s->request->still) def.rtol = s->rtol;
  s->algebra_of = attempts_plan(&s->attempts, def);
  def.tight_algebra = true;
  s->algebra = attempts_plan(&s->attempts, def);
}

/* On the first mesh of ten-node tets, as far as the window: four-node ones, which are too stiff,
   are strained too little to tell. */
void goal_plan_model(goal_search *s) {
  if (corot_strain_find(s->attempts.scenario->model.strain)->exact) return;
  attempt_def def = goal_base_def(s);
  def.green = true;
  s->model_of = s->level[0];
  s->model = attempts_plan(&s->attempts, def);
}

/* Scaled from the mesh where it was measured to the value. */
static double scaled(double difference, double of, double value) {
  return of != 0 ? fabs(difference) * fmax(1, fabs(value / of)) : fabs(difference);
}

static void sum_algebra(const goal_search *s, double value) {
  goal_result *r = s->result;
  r->algebra = r->half_algebra = 0;
  if (s->algebra < 0) return;
  double of = goal_value(s, s->algebra_of), tight = goal_value(s, s->algebra);
  r->algebra = isnan(tight) ? NAN : scaled(tight - of, of, value);
  /* what is seen of it goes with the steps, which tolerances of the algebra change, too */
  r->half_algebra = isnan(tight) ? 0 : fmax(0, 2 * r->algebra - r->half_time);
}

static void sum_model(const goal_search *s) {
  goal_result *r = s->result;
  r->model = r->half_model = 0;
  if (corot_strain_find(s->attempts.scenario->model.strain)->exact) return;
  r->model = scaled(goal_value(s, s->model) - goal_value(s, s->model_of),
                    goal_value(s, s->model_of), goal_value(s, s->level[s->nlevel - 1]));
  if (s->request->exact_model) r->half_model = isnan(r->model) ? INFINITY : 1.25 * r->model;
}

/* --- All of them --- */

static goal_error judge_mesh(const goal_search *s, double noise) {
  goal_level level[GOAL_LEVELS];
  for (int i = 0; i < s->nlevel; i++) {
    const attempt *a = goal_attempt(s, s->level[i]);
    level[i] = (goal_level){a->value, pow(a->dofs, -1.0 / 3)};
  }
  return goal_judge(s->nlevel, level, goal_value(s, s->coarse), noise, s->npass > 0);
}

/* Waves and shocks: a peak that is overshot on every mesh does not settle, however near two meshes
   are to one another. */
static void doubt_waves(const goal_search *s, double value, goal_error *mesh) {
  if (s->request->still || s->nlevel != 2 || mesh->settled) return;
  if (goal_attempt(s, s->full)->swing <= GOAL_QUIET) return;
  double coarse = fabs(value - goal_value(s, s->coarse));
  double changed = fabs(value - goal_value(s, s->level[0]));
  if (changed > 0.05 * fabs(value))
    mesh->half = fmax(mesh->half, 2 * (fmin(coarse, 3 * changed) + changed));
}

static void advise(const goal_search *s, const goal_error *mesh) {
  goal_result *r = s->result;
  const quantity *q = s->request->quantity;
  bool at_end = q->operation == QUANTITY_AT && !s->request->still;
  if (r->half_time > r->half_space && at_end)
    snprintf(
        r->advice, sizeof r->advice,
        "the error of time grows with the time: max(%.60s), amplitude(%.60s), period(%.60s) or "
        "an earlier moment would be well posed",
        s->attempts.column, s->attempts.column, s->attempts.column);
  else if (mesh->diverging)
    snprintf(
        r->advice, sizeof r->advice,
        "there may be no such value, as of a stress at a re-entrant corner or a displacement "
        "under a force on a node: the mean over a group, or a point away from it, is well posed");
  else if (s->nlevel >= 3 && mesh->order < 1.2)
    snprintf(
        r->advice, sizeof r->advice,
        "it converges at order %.2g, as at a re-entrant corner or the edge of a support: a mesh "
        "that is finer there, or a value away from it, takes less",
        mesh->order);
}

void goal_sum_up(goal_search *s) {
  goal_result *r = s->result;
  double value = goal_value(s, s->level[s->nlevel - 1]);
  sum_algebra(s, value);
  sum_model(s);
  double noise = fmax(GOAL_NOISE * (r->half_time + r->half_algebra), 1e-9 * fabs(value));
  goal_error mesh = judge_mesh(s, noise);
  doubt_waves(s, value, &mesh);
  r->space = fabs(mesh.estimate);
  r->half_space = mesh.half;
  r->half_tail = s->tail * fabs(value);
  r->order = mesh.order;
  r->limit = value + mesh.estimate;
  r->asymptotic = mesh.asymptotic;
  r->why_not = mesh.why;
  double half = r->half_space + r->half_time + r->half_algebra + r->half_tail + r->half_model;
  r->value = value;
  r->low = value - half;
  r->high = value + half;
  r->met = s->nlevel >= 2 && half <= goal_allowed(s->request, value);
  *r->advice = '\0';
  if (!r->met) advise(s, &mesh);
}
