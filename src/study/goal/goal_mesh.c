/* Ever finer meshes. */
#include <math.h>
#include <stdio.h>

#include "goal_mark.h"
#include "goal_search.h"

#define DOFS_MOST 3e6

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
  if (goal_attempt(s, level)->done && !goal_keeps_window(s, level)) {
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
