/* From the first attempt to the answer. */
#include "goal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/text/json_text.h"
#include "app/text/no_memory.h"
#include "goal_json.h"
#include "goal_search.h"
#include "study/plan/json_file.h"

/* --- Strategy --- */

static bool is_over(const goal_search *s) {
  return s->attempts.signal_number != 0 || *s->result->obstacle != '\0';
}

/* The end of the quantity's window: what comes later need not be integrated. */
static double end_of(const goal_request *r, const scenario *s) {
  double to = r->quantity->to;
  return r->still || !isfinite(to) || !(to > 0) ? s->t_end : fmin(to, s->t_end);
}

/* Of an equilibrium: the same on four-node tets, to begin with. */
static corot_status begin_still(goal_search *s) {
  attempt_def def = {.order = 1, .refine = s->attempts.scenario->refine, .method = "", .until = 0};
  s->method = "";
  s->coarse = attempts_plan(&s->attempts, def);
  COROT_TRY(attempts_make(&s->attempts));
  if (!s->attempts.signal_number) goal_is_sensible(s, s->coarse);
  return COROT_OK;
}

/* A value of zero leaves nothing to be relative to. */
static void look_at_size(goal_search *s) {
  const attempt *a = goal_attempt(s, s->level[s->nlevel - 1]);
  goal_result *r = s->result;
  if (s->request->absolute || !(fabs(a->value) <= 1e-9 * a->largest)) return;
  snprintf(
      r->obstacle, sizeof r->obstacle,
      "%.200s is zero, beside values of %.3g: no error is a fraction of it; --within-abs takes "
      "one in its unit",
      s->request->text, a->largest);
  r->senseless = true;
}

static corot_status make_base(goal_search *s) {
  goal_plan_base(s);
  COROT_TRY(attempts_make(&s->attempts));
  if (s->attempts.signal_number) return COROT_OK;
  const attempt *base = goal_attempt(s, s->level[0]);
  if (isnan(base->value)) {
    s->nlevel = 0;
    snprintf(s->result->obstacle, sizeof s->result->obstacle, "%.100s: %.300s", base->label,
             base->reason);
    return COROT_OK;
  }
  look_at_size(s);
  if (is_over(s)) return COROT_OK;
  COROT_TRY(goal_choose_window(s));
  COROT_TRY(goal_look_through_window(s));
  goal_plan_check(s);
  goal_plan_model(s);
  COROT_TRY(attempts_make(&s->attempts));
  if (s->attempts.signal_number) return COROT_OK;
  COROT_TRY(goal_settle_time(s));
  if (s->attempts.signal_number) return COROT_OK;
  goal_plan_algebra(s);
  return attempts_make(&s->attempts);
}

static corot_status refine(goal_search *s) {
  for (bool made = true; made && !s->result->met && !is_over(s);) {
    COROT_TRY(goal_refine(s, &made));
    if (s->attempts.signal_number) break;
    COROT_TRY(goal_find_tail(s));
    goal_sum_up(s);
    if (!made || s->nlevel != 2) continue;
    COROT_TRY(goal_settle_time_again(s));
    if (s->attempts.signal_number) break;
    goal_sum_up(s);
  }
  return COROT_OK;
}

static corot_status search(goal_search *s) {
  COROT_TRY(s->request->still ? begin_still(s) : goal_choose_time(s));
  if (is_over(s) || !goal_affords(s, goal_attempt(s, s->coarse)->cpu)) return COROT_OK;
  COROT_TRY(make_base(s));
  if (s->attempts.signal_number || s->nlevel == 0) return COROT_OK;
  goal_sum_up(s);
  return is_over(s) ? COROT_OK : refine(s);
}

/* --- All of it --- */

static goal_search begin(const goal_request *r, const scenario *s, goal_result *result) {
  *result = (goal_result){.value = NAN,
                          .low = NAN,
                          .high = NAN,
                          .order = NAN,
                          .limit = NAN,
                          .space = NAN,
                          .time = r->still ? 0 : NAN,
                          .algebra = NAN,
                          .model = NAN,
                          .why_not = "there is no value"};
  return (goal_search){.request = r,
                       .result = result,
                       .until = end_of(r, s),
                       .window = end_of(r, s),
                       .coarse = -1,
                       .timed = -1,
                       .check = -1,
                       .algebra = -1,
                       .model = -1,
                       .refine = s->refine};
}

corot_status goal_solve(const goal_request *r, const scenario *s, int nset, const char *const *set,
                        const execute_options *execute, goal_result *result, json_t **out,
                        int *signal_number) {
  goal_search search_of = begin(r, s, result);
  char column[QUANTITY_TEXT];
  snprintf(column, sizeof column, "%.*s", (int)r->quantity->column_length,
           r->quantity->text + r->quantity->column_at);
  search_of.attempts = (attempts){.scenario = s,
                                  .quantity = r->quantity,
                                  .name = r->name,
                                  .column = column,
                                  .still = r->still,
                                  .nset = nset,
                                  .set = set,
                                  .cpu_limit = r->cpu_limit,
                                  .options = *execute};
  COROT_TRY(attempts_begin(&search_of.attempts));
  corot_status status = search(&search_of);
  *signal_number = search_of.attempts.signal_number;
  json_t *made = NULL;
  if (status == COROT_OK && !*signal_number) {
    made = goal_json(&search_of);
    status = made ? json_file_write(execute->dir, "solve.json", made) : no_memory();
  }
  attempts_end(&search_of.attempts);
  if (status != COROT_OK) {
    json_decref(made);
    return status;
  }
  *out = made;
  return COROT_OK;
}
