/* solve.json. */
#include "goal_json.h"

#include <math.h>

#include "app/text/json_text.h"

static json_t *text_or_null(const char *text) {
  return text && *text ? json_text_string(text) : json_null();
}

static json_t *attempt_json(const goal_search *s, const attempt *a) {
  const attempts *all = &s->attempts;
  const attempt_def *def = &a->def;
  bool still = all->still;
  const char *id = a->looked && all->manifest ? all->manifest->run[a->at].id : NULL;
  return json_pack(
      "{s:o, s:i, s:i, s:i, s:b, s:b, s:o, s:o, s:o, s:o, s:i, s:i, s:o, s:s, s:o, s:o}", "label",
      json_text_string(a->label), "order", def->order, "refine", def->refine, "passes", def->npass,
      "tight_algebra", def->tight_algebra, "green", def->green, "method",
      still ? json_null() : json_string(def->method), "rtol",
      still ? json_null() : json_text_real(def->rtol), "until",
      still ? json_null() : json_text_real(def->until), "value", json_text_real(a->value), "tets",
      a->tets, "dofs", a->dofs, "cpu_s", json_text_real(a->cpu), "status",
      a->done ? "done" : "failed", "reason", text_or_null(a->reason), "id", text_or_null(id));
}

static json_t *attempts_json(const goal_search *s) {
  json_t *list = json_array();
  for (int i = 0; i < s->attempts.n; i++)
    list = json_text_push(list, attempt_json(s, &s->attempts.all[i]));
  return list;
}

static json_t *levels_json(const goal_search *s) {
  json_t *list = json_array();
  for (int i = 0; i < s->nlevel; i++) {
    const attempt *a = goal_attempt(s, s->level[i]);
    list = json_text_push(
        list, json_pack("{s:o, s:i, s:i, s:o, s:o}", "label", json_text_string(a->label), "tets",
                        a->tets, "dofs", a->dofs, "value", json_text_real(a->value), "cpu_s",
                        json_text_real(a->cpu)));
  }
  return list;
}

static json_t *parts_json(const goal_result *r) {
  return json_pack("{s:o, s:o, s:o, s:f, s:o}", "space", json_text_real(r->space), "time",
                   json_text_real(r->time), "algebra", json_text_real(r->algebra), "frames", 0.0,
                   "model", json_text_real(r->model));
}

static json_t *half_json(const goal_request *request, const goal_result *r) {
  json_t *half =
      json_pack("{s:o, s:o, s:o, s:f, s:o}", "space", json_text_real(r->half_space), "time",
                json_text_real(r->half_time), "algebra", json_text_real(r->half_algebra), "frames",
                0.0, "tail", json_text_real(r->half_tail));
  if (request->exact_model) half = json_text_with(half, "model", json_text_real(r->half_model));
  return half;
}

/* --- By which attempts a part is known --- */

static json_t *push_label(json_t *list, const goal_search *s, int i) {
  return i < 0 ? list : json_text_push(list, json_text_string(goal_attempt(s, i)->label));
}

/* Two attempts that differ in one thing; none of them where either was not made. */
static json_t *pair_json(const goal_search *s, int i, int of) {
  json_t *list = json_array();
  return i < 0 ? list : push_label(push_label(list, s, i), s, of);
}

/* The last three meshes; the first alone is compared with four-node tets. */
static json_t *space_json(const goal_search *s) {
  json_t *list = json_array();
  if (s->nlevel == 1) list = push_label(list, s, s->coarse);
  for (int i = s->nlevel > 3 ? s->nlevel - 3 : 0; i < s->nlevel; i++)
    list = push_label(list, s, s->level[i]);
  return list;
}

/* Two tolerances on ten-node tets; methods and tolerances on four-node ones. */
static json_t *time_json(const goal_search *s) {
  json_t *list = json_array();
  if (s->attempts.still) return list;
  if (s->nlevel > 0) list = push_label(push_label(list, s, s->timed), s, s->check);
  for (int i = 0; i < s->attempts.n; i++) {
    const attempt_def *def = &s->attempts.all[i].def;
    if (def->order == 1 && !def->tight_algebra && !def->green) list = push_label(list, s, i);
  }
  return list;
}

static json_t *measured_json(const goal_search *s) {
  json_t *tail = pair_json(s, s->tail > 0 ? s->coarse : -1, s->nlevel > 0 ? s->level[0] : -1);
  return json_pack("{s:o, s:o, s:o, s:o, s:o}", "space", space_json(s), "time", time_json(s),
                   "algebra", pair_json(s, s->algebra, s->algebra_of), "model",
                   pair_json(s, s->model, s->model_of), "tail", tail);
}

json_t *goal_json(const goal_search *s) {
  const goal_request *q = s->request;
  const goal_result *r = s->result;
  double cpu = attempts_cpu(&s->attempts);
  double last = s->nlevel > 0 ? goal_attempt(s, s->level[s->nlevel - 1])->cpu : NAN;
  json_t *json =
      json_pack("{s:o, s:s, s:b, s:s, s:o, s:o, s:o, s:o, s:f, s:b, s:b, s:b, s:o, s:o}", "title",
                json_text_string(s->attempts.scenario->title), "scenario",
                s->attempts.scenario->path, "static", q->still, "goal", q->text, "unit",
                text_or_null(s->attempts.unit), "value", json_text_real(r->value), "low",
                json_text_real(r->low), "high", json_text_real(r->high), "within", q->within,
                "within_abs", q->absolute, "met", r->met, "asymptotic", r->asymptotic, "why_not",
                text_or_null(r->asymptotic ? NULL : r->why_not), "order", json_text_real(r->order));
  json = json_text_with(json, "parts", parts_json(r));
  json = json_text_with(json, "half", half_json(q, r));
  json = json_text_with(json, "limit", json_text_real(r->limit));
  json = json_text_with(json, "allowed", json_text_real(goal_allowed(q, r->value)));
  json = json_text_with(json, "measured", measured_json(s));
  json = json_text_with(json, "model_counts", json_boolean(q->exact_model));
  json = json_text_with(json, "obstacle", text_or_null(r->met ? NULL : r->obstacle));
  json = json_text_with(json, "advice", text_or_null(r->advice));
  json = json_text_with(json, "levels", levels_json(s));
  json = json_text_with(json, "attempts", attempts_json(s));
  json = json_text_with(json, "cpu_s", json_text_real(cpu));
  return json_text_with(json, "overhead", json_text_real(cpu / last));
}
