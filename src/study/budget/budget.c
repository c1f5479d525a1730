/* The error budget as JSON: the runs of budget_runs.c, by the claims of budget_claims.c. */
#include "budget.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/config/config.h"
#include "app/folder/hash.h"
#include "app/text/json_text.h"
#include "app/text/no_memory.h"
#include "budget_claims.h"
#include "budget_quantities.h"
#include "budget_text.h"
#include "report/read/lookup.h"
#include "study/measure/states_sum.h"
#include "study/plan/json_file.h"

/* --- Parts --- */

static void set_real(json_t *object, const char *prefix, const char *key, double value) {
  char name[64];
  snprintf(name, sizeof name, "%s%s", prefix, key);
  json_object_set_new(object, name, json_text_real(value));
}

static void set_bound(json_t *object, const char *prefix, claim_bound b) {
  char name[64];
  snprintf(name, sizeof name, "%sbound", prefix);
  json_object_set_new(object, name, json_string(claim_words[b.kind]));
  set_real(object, prefix, "low", b.low);
  set_real(object, prefix, "high", b.high);
  set_real(object, prefix, "floor", b.floor);
}

/* The displacement of the last time, of the second less the first. */
static double change(const trajectory *first, const trajectory *second, int i) {
  int k = first->count - 1;
  return states_u(second, second->count - 1)[i] - states_u(first, k)[i];
}

/* A chain's run may be of a finer mesh: only claims at the places of the scenario's are signed. */
static json_t *signed_change(const budgeting *b, const trajectory *before, const trajectory *after,
                             int probe) {
  const yardstick *y = b->yardstick;
  const double *first = states_u(before, before->count - 1);
  const double *second = states_u(after, after->count - 1);
  json_t *list = json_array();
  for (int c = 0; c < 3; c++)
    json_array_append_new(list, json_text_real(yardstick_probe(y, probe, c, second) -
                                               yardstick_probe(y, probe, c, first)));
  return list;
}

static json_t *probes_json(const budgeting *b, const claim *c, const errors *bare,
                           const trajectory *after) {
  json_t *all = json_object();
  const yardstick *y = b->yardstick;
  for (int i = 0; i < y->nprobe && c->error.n > 0; i++) {
    error_pair of = c->error.of[ERROR_PROBES + i];
    json_t *probe =
        json_pack("{s:o, s:o}", "max", json_text_real(of.max), "end", json_text_real(of.end));
    set_bound(probe, "", claim_bounds(c, ERROR_PROBES + i, false));
    if (bare->n > 0) {
      set_real(probe, "", "difference", bare->of[ERROR_PROBES + i].max);
      set_real(probe, "", "difference_end", bare->of[ERROR_PROBES + i].end);
    }
    if (after) json_object_set_new(probe, "signed", signed_change(b, c->before, after, i));
    all = json_text_with(all, y->probe_def[i]->name, probe);
  }
  return all;
}

static json_t *settings_text(const budget_part *part) {
  char text[BUDGET_SETTINGS * BUDGET_SETTING_SIZE] = "";
  for (int k = 0; k < part->nset; k++) {
    if (k) strcat(text, ", ");
    strcat(text, part->set[k]);
  }
  return json_text_string(text);
}

static error_pair displacement_of(const errors *e) {
  return e->n > 0 ? e->of[ERROR_DISPLACEMENT] : (error_pair){NAN, NAN};
}

/* What an error `alone` is worth: the errors of time and algebra are in both of its runs. */
static const char *alone_bound(const budgeting *b, const budget_claims *all, int place,
                               double alone) {
  int time = b->place[BUDGET_TIME], algebra = b->place[BUDGET_ALGEBRA];
  double noise = 0;
  if (isnan(alone)) return claim_words[CLAIM_MISSING];
  if (place == time) {
    noise = displacement_of(&all->chain).max;
  } else if (place == algebra) {
    noise = displacement_of(&all->part[place].known).max;
  } else {
    if (time >= 0) noise = displacement_of(&all->part[time].error).max;
    if (algebra >= 0) noise = fmax(noise, displacement_of(&all->part[algebra].error).max);
  }
  if (!(alone >= ERROR_FLOOR * noise)) return "doubtful";
  return claim_words[place == b->place[BUDGET_SPACE] ? CLAIM_AT_LEAST : CLAIM_ABOUT];
}

/* The part's product with the total, and the total's with itself, at the end. */
static corot_status share_of(const budgeting *b, const budget_claims *all, const trajectory *before,
                             const trajectory *after, double *share) {
  const claim *total = &all->total;
  int n = total->before ? total->before->n : 0;
  *share = NAN;
  if (!before || !after || total->after != &total->made) return COROT_OK;
  double *d = calloc(2 * (size_t)n + 1, sizeof *d);
  if (!d) return no_memory();
  for (int i = 0; i < n; i++) {
    d[i] = change(before, after, i);
    d[n + i] = change(total->before, total->after, i);
  }
  double square = yardstick_product(b->yardstick, d + n, d + n);
  if (square > 0) *share = yardstick_product(b->yardstick, d, d + n) / square;
  free(d);
  return COROT_OK;
}

/* The settings that take a part away, and the run that shows what they cost: for time, the last
   that was tried. */
static const budget_part *settings_of(const budgeting *b, int i, int *run) {
  bool finer = i == b->place[BUDGET_TIME] && b->ntight > 1;
  *run = finer ? b->tight[b->ntight - 1] : budget_alone_run(b, i);
  return finer ? &b->finer[b->ntight - 2][0] : &b->plan.part[i];
}

/* By what the error of a mesh was found; NULL of other parts. */
static const char *space_way(const claim *c) {
  if (!c->is_space) return NULL;
  return c->by_order ? "order" : "refinement";
}

/* Of space, where there is something to be told, with the way it was found. */
static void part_verdict(const budgeting *b, const claim *c, size_t size, char *text) {
  claim_kind kind = claim_bounds(c, ERROR_DISPLACEMENT, false).kind;
  bool told = c->is_space && kind != CLAIM_MISSING && kind != CLAIM_AT_MOST;
  int used = told ? snprintf(text, size, "by %s: ", space_way(c)) : 0;
  claim_verdict(c, b->left_out, size - (size_t)used, text + used);
}

static json_t *pack_part(const budgeting *b, const budget_claims *all, int i, const errors *bare,
                         const errors *alone, const trajectory *after, double share) {
  int run;
  const budget_part *part = settings_of(b, i, &run);
  const claim *c = &all->part[i];
  error_pair error = displacement_of(&c->error), single = displacement_of(alone),
             difference = displacement_of(bare);
  char verdict[512];
  part_verdict(b, c, sizeof verdict, verdict);
  /* what it is and how large */
  json_t *json = json_pack(
      "{s:s, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:s}", "part", budget_names[part->kind], "pair",
      settings_text(part), "error", json_text_real(error.max), "end", json_text_real(error.end),
      "alone", json_text_real(single.max), "alone_end", json_text_real(single.end), "probes",
      probes_json(b, c, bare, after), "cost", json_text_real(b->run[run].cpu / b->run[0].cpu),
      "advice", budget_remedy(&b->plan, part->kind, b->options->still));
  if (!json) return NULL;
  /* how sure that is, and what stands behind it */
  set_bound(json, "", claim_bounds(c, ERROR_DISPLACEMENT, false));
  set_bound(json, "end_", claim_bounds(c, ERROR_DISPLACEMENT, true));
  set_real(json, "", "difference", difference.max);
  set_real(json, "", "difference_end", difference.end);
  set_real(json, "", "share", share);
  set_real(json, "", "order", c->nlevel == 3 && !c->by_order ? c->convergence.order : NAN);
  json_object_set_new(json, "levels", c->is_space ? json_integer(c->nlevel) : json_null());
  json_object_set_new(json, "by", space_way(c) ? json_string(space_way(c)) : json_null());
  json_object_set_new(json, "alone_bound", json_string(alone_bound(b, all, i, single.max)));
  json_object_set_new(json, "verdict", json_string(verdict));
  return json;
}

/* `after` at the places of the scenario's own mesh. */
static corot_status restrict_to(const claim *c, trajectory *own, const trajectory **after) {
  static const double one = 1;
  *after = c->before && c->after ? c->after : NULL;
  if (!*after || c->after->n == c->before->n) return COROT_OK;
  COROT_TRY(states_sum(c->before, 1, &one, after, own));
  *after = own;
  return COROT_OK;
}

static corot_status part_json(const budgeting *b, const budget_claims *all, int i, json_t **out) {
  const trajectory *after = NULL;
  trajectory own = {0};
  errors bare = {0}, alone = {0};
  double share = NAN;
  corot_status status = restrict_to(&all->part[i], &own, &after);
  if (status == COROT_OK)
    status = budget_distance(b, budget_states(b, budget_before_run(b, i)),
                             budget_states(b, budget_chain_run(b, i)), &bare);
  if (status == COROT_OK)
    status =
        budget_distance(b, budget_states(b, 0), budget_states(b, budget_alone_run(b, i)), &alone);
  if (status == COROT_OK) status = share_of(b, all, all->part[i].before, after, &share);
  *out = status == COROT_OK ? pack_part(b, all, i, &bare, &alone, after, share) : NULL;
  if (status == COROT_OK && !*out) status = no_memory();
  errors_free(&bare);
  errors_free(&alone);
  states_free(&own);
  return status;
}

/* --- The whole --- */

static json_t *runs_json(const budgeting *b) {
  json_t *list = json_array();
  for (int i = 0; i < b->nrun; i++) {
    const budget_run *run = &b->run[i];
    list = json_text_push(list, json_pack("{s:s, s:s, s:s, s:o, s:b}", "run", run->label, "id",
                                          b->manifest->run[run->at].id, "status", run->status,
                                          "cpu", json_text_real(run->cpu), "spare", run->spare));
  }
  return list;
}

static json_t *missing_json(const json_t *parts) {
  json_t *list = json_array();
  for (size_t i = 0; i < json_array_size(parts); i++) {
    const json_t *part = json_array_get(parts, i);
    if (strcmp(lookup_text(part, "bound"), claim_words[CLAIM_MISSING]) == 0)
      json_array_append(list, json_object_get(part, "part"));
  }
  return list;
}

/* The total is as uncertain as all parts together. */
static claim_bound total_bound(const budgeting *b, const budget_claims *all) {
  claim_bound total = claim_bounds(&all->total, ERROR_DISPLACEMENT, false);
  if (total.kind == CLAIM_MISSING || total.kind == CLAIM_AT_MOST) return total;
  bool open = false;
  total.low = total.high = total.value;
  for (int i = 0; i < b->plan.npart; i++) {
    claim_bound part = claim_bounds(&all->part[i], ERROR_DISPLACEMENT, false);
    open |= part.kind == CLAIM_AT_LEAST || part.kind == CLAIM_MISSING;
    if (part.kind == CLAIM_ABOUT) total.low -= part.value - part.low;
    total.high += part.high - part.value;
  }
  total.low = fmax(0, total.low);
  if (open) total.kind = CLAIM_AT_LEAST;
  return total;
}

static double sum_of(const json_t *parts) {
  double sum = 0;
  for (size_t i = 0; i < json_array_size(parts); i++)
    sum += lookup_number(json_array_get(parts, i), "error");
  return sum;
}

/* The tolerance at which the last check of time was made. */
static double check_rtol(const budgeting *b) {
  double rtol = budget_tight_rtol(b->scenario);
  budget_part ignored[2];
  for (int k = 1; k < b->ntight; k++)
    rtol = budget_plan_tighten(b->scenario, k, &ignored[0], &ignored[1]);
  return b->ntight > 0 ? rtol : NAN;
}

/* The run that it is of. */
static corot_status set_owner(const budgeting *b, json_t *json) {
  char solution[HASH_SIZE], mesh[HASH_SIZE];
  COROT_TRY(hash_solution(b->scenario->resolved, solution));
  hash_mesh(b->yardstick->mesh, mesh);
  json_t *of = json_pack("{s:s, s:s}", "solution", solution, "mesh", mesh);
  return json_object_set_new(json, "hashes", of) ? no_memory() : COROT_OK;
}

static corot_status totals(const budgeting *b, const budget_claims *all, json_t *parts,
                           json_t **out) {
  error_pair total = displacement_of(&all->total.error);
  double sum = sum_of(parts);
  errors none = {0};
  json_t *missing = missing_json(parts), *verdict = budget_verdict(parts, total.max);
  json_t *json = json_pack(
      "{s:o, s:s, s:s, s:b, s:O, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:b, s:o, s:O?, s:o?, s:o}",
      "title", json_text_string(b->scenario->title), "scenario", b->scenario->path, "measure",
      b->options->still
          ? "displacement in the mass norm, relative to its size"
          : "displacement in the mass norm, relative to its largest; largest over time",
      "static", b->options->still, "parts", parts, "total", json_text_real(total.max), "total_end",
      json_text_real(total.end), "total_probes",
      probes_json(b, &all->total, &none,
                  all->total.after == &all->total.made ? all->total.after : NULL),
      "sum", json_text_real(sum), "interaction", json_text_real(total.max - sum), "check",
      json_text_real(displacement_of(&all->check).max), "check_rtol", json_text_real(check_rtol(b)),
      "complete", json_array_size(missing) == 0, "missing", missing, "first", verdict, "verdict",
      verdict, "runs", runs_json(b));
  /* which builds made the runs, and whose budget this is */
  if (!json) return no_memory();
  json = json_text_with(json, "builds", json_incref(b->builds.list));
  json = json_text_with(json, "mixed", builds_sentence(b->builds.list));
  if (!json) return no_memory();
  if (set_owner(b, json) != COROT_OK) {
    json_decref(json);
    return COROT_ENOMEM;
  }
  /* how sure the totals are */
  set_bound(json, "total_", total_bound(b, all));
  set_bound(json, "total_end_", claim_bounds(&all->total, ERROR_DISPLACEMENT, true));
  *out = json;
  return COROT_OK;
}

static corot_status rate(budgeting *b, json_t **out) {
  budget_claims all;
  COROT_TRY(budget_claims_make(b, &all));
  json_t *parts = json_array();
  corot_status status = COROT_OK;
  for (int i = 0; i < b->plan.npart && status == COROT_OK; i++) {
    json_t *part;
    status = part_json(b, &all, i, &part);
    if (status == COROT_OK && json_array_append_new(parts, part)) status = no_memory();
  }
  builds_sort(&b->builds);
  json_t *quantities = NULL;
  if (status == COROT_OK) status = budget_quantities(b, &quantities);
  if (status == COROT_OK) status = totals(b, &all, parts, out);
  if (status == COROT_OK && json_object_set(*out, "quantities", quantities)) status = no_memory();
  json_decref(quantities);
  json_decref(parts);
  budget_claims_free(&all);
  return status;
}

static void release(budgeting *b) {
  for (int i = 0; i < b->nrun; i++) {
    states_free(&b->run[i].states);
    free(b->run[i].quantity);
  }
  builds_free(&b->builds);
  yardstick_destroy(b->yardstick);
  manifest_destroy(b->manifest);
  free(b);
}

/* Of the tets of a scenario's mesh; what is wrong with a file its runs will say. */
static int order_of(const scenario *s) {
  corot_mesh *mesh = NULL;
  corot_mesh_report *report = NULL;
  int order = s->order > 0 ? s->order : 1;
  if (s->order > 0 || !s->mesh_file) return order;
  if (scenario_read_mesh(s, &mesh, &report) == COROT_OK) order = corot_mesh_order(mesh);
  corot_mesh_report_destroy(report);
  corot_mesh_destroy(mesh);
  return order;
}

/* Octasections come before mesh.marks, whose numbers would be of other tets then. */
static corot_status check_marks(const scenario *s, int order, const budget_options *options) {
  bool octasects = order == 2 || options->levels != 2;
  if (!s->marks || options->skip[BUDGET_SPACE] || !octasects) return COROT_OK;
  return config_fail(
      config_find(s->source->root, "mesh.marks"),
      "these numbers are of one mesh, and the budget would refine it: write what they "
      "make of it by corot mesh refine --marks, and give that as mesh.file; or "
      "--skip space, of four-node tets --levels 2");
}

corot_status budget_make(const scenario *s, int nset, const char *const *set,
                         const budget_options *options, const execute_options *execute,
                         json_t **out, int *signal_number) {
  int order = order_of(s);
  COROT_TRY(check_marks(s, order, options));
  budgeting *b = calloc(1, sizeof *b);
  if (!b) return no_memory();
  b->scenario = s;
  b->options = options;
  b->builds = builds_begin();
  if (options->still)
    budget_plan_make_static(s, order, &b->plan);
  else
    budget_plan_make(s, order, &b->plan);
  for (int k = 0; k < BUDGET_KINDS; k++)
    if (options->skip[k]) budget_plan_skip(&b->plan, (budget_kind)k);
  if (b->plan.npart == 0) {
    release(b);
    return corot_fail(COROT_EINVAL, "nothing is left of the budget");
  }
  json_t *made = NULL;
  corot_status status = budget_runs_make(b, nset, set, execute, signal_number);
  if (status == COROT_OK && !*signal_number) status = rate(b, &made);
  if (status == COROT_OK && made) status = json_file_write(execute->dir, "budget.json", made);
  release(b);
  if (status != COROT_OK) {
    json_decref(made);
    return status;
  }
  *out = made;
  return COROT_OK;
}
