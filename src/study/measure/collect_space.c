/* The error of the meshes of a study that varies mesh.refine: its references are exact in time, so
   those of neighbouring levels say what the meshes do (convergence.h). */
#include "collect_space.h"

#include <math.h>
#include <stdlib.h>

#include "app/text/json_text.h"
#include "app/text/no_memory.h"
#include "claim.h"

enum { NLEVEL = 3 };

static const json_t *refine_of(const table_reference *t) {
  const json_t *refine = json_object_get(t->reference->settings, "mesh.refine");
  return json_is_integer(refine) ? refine : NULL;
}

/* Whether two references differ in mesh.refine alone, the second so many octasections on. */
static bool is_level(const table_reference *first, const table_reference *second,
                     int octasections) {
  const json_t *a = refine_of(first), *b = refine_of(second);
  if (!a || !b || first->reference->rtol != second->reference->rtol) return false;
  if (json_integer_value(b) - json_integer_value(a) != octasections) return false;
  json_t *copy = json_copy((json_t *)second->reference->settings);
  json_object_set(copy, "mesh.refine", (json_t *)a);
  bool same = json_equal(copy, first->reference->settings);
  json_decref(copy);
  return same;
}

/* The reference of that level over reference i; -1: there is none that is known. */
static int find_level(const table_reference *t, int n, int i, int octasections) {
  for (int k = 0; k < n; k++)
    if (t[k].known && is_level(&t[i], &t[k], octasections)) return k;
  return -1;
}

/* `of`: what it is about. */
static json_t *space_json(const table_reference *t, int index, const char *of, const claim *c) {
  claim_bound b = claim_bounds(c, ERROR_DISPLACEMENT, false);
  char verdict[512];
  claim_verdict(c, "no cell has it", sizeof verdict, verdict);
  return json_pack(
      "{s:s, s:i, s:I, s:i, s:o, s:s, s:o, s:o, s:o, s:o, s:s}", "measure", of, "reference", index,
      "refine", json_integer_value(refine_of(t)), "levels", c->nlevel, "error",
      json_text_real(b.value), "bound", claim_words[b.kind], "low", json_text_real(b.low), "high",
      json_text_real(b.high), "floor", json_text_real(b.floor), "order",
      json_text_real(c->nlevel == NLEVEL ? c->convergence.order : NAN), "verdict", verdict);
}

/* The same levels of quantity k, relative to what they tend to. */
static corot_status measure_quantity(measuring *g, const table_reference *t,
                                     const int level[NLEVEL], int k, json_t *list) {
  double q[NLEVEL];
  int nlevel = level[2] >= 0 ? 3 : 2;
  for (int i = 0; i < nlevel; i++) q[i] = t[level[i]].quantity[k];
  double floor = t[level[0]].quantity_floor[k];
  for (int i = 0; i < nlevel; i++)
    if (!isfinite(q[i]) || !isfinite(floor)) return COROT_OK; /* there is nothing to compare */
  claim c = {0};
  double limit;
  corot_status status = claim_of_numbers(corot_mesh_order(g->yardstick->mesh), nlevel, q,
                                         floor * fabs(q[0]), &c, &limit);
  if (status == COROT_OK) claim_scale(&c, fabs(limit));
  if (status == COROT_OK &&
      json_array_append_new(list, space_json(&t[level[0]], level[0], g->m->quantity[k].text, &c)))
    status = no_memory();
  claim_free(&c);
  return status;
}

/* Of reference i, against the next one or two levels. */
static corot_status measure_levels(measuring *g, const table_reference *t, const int level[NLEVEL],
                                   json_t *list) {
  trajectory states[NLEVEL] = {{0}};
  claim c = {0};
  corot_status status = measure_hold(g, level[0]);
  for (int k = 0; k < NLEVEL && status == COROT_OK; k++)
    if (level[k] >= 0) status = measure_states(g, level[k], &states[k]);
  if (status == COROT_OK) {
    c.before = &states[0];
    status = errors_copy(&t[level[0]].floor, &c.known);
  }
  if (status == COROT_OK)
    status = claim_by_levels(g->yardstick, &states[1], level[2] >= 0 ? &states[2] : NULL, &c);
  if (status == COROT_OK &&
      json_array_append_new(list, space_json(&t[level[0]], level[0], error_words[0], &c)))
    status = no_memory();
  for (int k = 0; k < g->m->nquantity && status == COROT_OK; k++)
    status = measure_quantity(g, t, level, k, list);
  claim_free(&c);
  for (int k = 0; k < NLEVEL; k++) states_free(&states[k]);
  return status;
}

corot_status collect_space(measuring *g, const table_reference *reference, json_t **out) {
  int n = g->m->nreference;
  json_t *list = json_array();
  corot_status status = list ? COROT_OK : no_memory();
  for (int i = 0; i < n && status == COROT_OK; i++) {
    int level[NLEVEL] = {i, find_level(reference, n, i, 1), find_level(reference, n, i, 2)};
    if (reference[i].known && level[1] >= 0) status = measure_levels(g, reference, level, list);
    if (status != COROT_ENOMEM) status = COROT_OK; /* what cannot be measured is left out */
  }
  if (status == COROT_OK)
    *out = list;
  else
    json_decref(list);
  return status;
}
