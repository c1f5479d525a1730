/* Claims of single numbers, made as those of the displacement are. */
#include "budget_quantities.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/text/json_text.h"
#include "app/text/no_memory.h"
#include "report/read/lookup.h"

/* --- One quantity, k --- */

/* No number is known better than by the rounding of what it is made from, as of states. */
#define ROUNDING 1e-14

static double value_of(const budgeting *b, int run, int k) {
  return run >= 0 && b->run[run].quantity ? b->run[run].quantity[k] : NAN;
}

static double distance(const budgeting *b, int first, int second, int k) {
  return fabs(value_of(b, first, k) - value_of(b, second, k));
}

static int last_tight(const budgeting *b) { return b->ntight > 0 ? b->tight[b->ntight - 1] : -1; }

static int last_check(const budgeting *b) { return b->ntight > 0 ? b->check[b->ntight - 1] : -1; }

/* How well the chain's runs after the part of time are known. */
static double known_of_chain(const budgeting *b, int k) {
  if (b->ntight == 0) return NAN;
  double known = distance(b, b->check[0], b->tight[0], k);
  return b->ntight == 1 ? known : fmax(known, distance(b, b->tight[0], last_tight(b), k));
}

/* What the reference of a part is known by; NaN: nobody knows. */
static double known_of_part(const budgeting *b, int place, int k) {
  int time = b->place[BUDGET_TIME], algebra = b->place[BUDGET_ALGEBRA];
  if (place == time) return distance(b, last_check(b), last_tight(b), k);
  if (!b->options->still && place > time && place != algebra) return known_of_chain(b, k);
  if (algebra < 0) return NAN;
  return distance(b, b->algebra_check, budget_chain_run(b, algebra), k);
}

/* The part's claim, in the quantity's own unit, and what it changes; NaN: a run failed. */
static corot_status claim_part(const budgeting *b, int place, int k, claim *c, double *change) {
  bool space = place == b->place[BUDGET_SPACE];
  int after = place == b->place[BUDGET_TIME] ? last_tight(b) : budget_chain_run(b, place);
  double q[] = {value_of(b, budget_before_run(b, place), k), value_of(b, after, k),
                space ? value_of(b, b->third_run, k) : NAN};
  double known = known_of_part(b, place, k), limit = NAN;
  *change = NAN;
  if (isnan(q[0]) || isnan(q[1])) return COROT_OK;
  if (space && b->third_is_loose && b->place[BUDGET_TIME] >= 0)
    known += distance(b, budget_before_run(b, b->place[BUDGET_TIME]), last_tight(b), k);
  if (known == known) known = fmax(known, ROUNDING * fabs(q[0]));
  int nlevel = !space ? 0 : isnan(q[2]) ? 2 : 3;
  COROT_TRY(claim_of_numbers(corot_mesh_order(b->yardstick->mesh), nlevel, q, known, c, &limit));
  *change = limit - q[0];
  return COROT_OK;
}

static json_t *part_json(const budgeting *b, int place, const claim *c, double change) {
  claim_bound bound = claim_bounds(c, ERROR_DISPLACEMENT, false);
  char verdict[512];
  claim_verdict(c, b->left_out, sizeof verdict, verdict);
  return json_pack("{s:s, s:o, s:o, s:s, s:o, s:o, s:o, s:o, s:s}", "part",
                   budget_names[b->plan.part[place].kind], "change", json_text_real(change),
                   "error", json_text_real(bound.value), "bound", claim_words[bound.kind], "low",
                   json_text_real(bound.low), "high", json_text_real(bound.high), "floor",
                   json_text_real(bound.floor), "order",
                   json_text_real(c->nlevel == 3 ? c->convergence.order : NAN), "verdict", verdict);
}

static corot_status quantity_json(const budgeting *b, int k, json_t **out) {
  claim c[BUDGET_KINDS] = {{0}};
  double change[BUDGET_KINDS], value = value_of(b, 0, k), reference = value;
  corot_status status = COROT_OK;
  for (int i = 0; i < b->plan.npart && status == COROT_OK; i++) {
    status = claim_part(b, i, k, &c[i], &change[i]);
    reference += change[i];
  }
  /* relative to what all of it leads to */
  json_t *parts = json_array();
  for (int i = 0; i < b->plan.npart && status == COROT_OK; i++) {
    claim_scale(&c[i], fabs(isnan(reference) ? value : reference));
    parts = json_text_push(parts, part_json(b, i, &c[i], change[i]));
  }
  for (int i = 0; i < b->plan.npart; i++) claim_free(&c[i]);
  char text[QUANTITY_TEXT];
  quantity_print(&b->scenario->quantity[k].quantity, text);
  *out = json_pack("{s:s, s:o, s:o, s:o}", "of", text, "value", json_text_real(value), "reference",
                   json_text_real(reference), "parts", parts);
  if (status == COROT_OK && !*out) status = no_memory();
  return status;
}

corot_status budget_quantities(const budgeting *b, json_t **out) {
  json_t *all = json_object();
  corot_status status = COROT_OK;
  for (int k = 0; k < b->scenario->nquantity && status == COROT_OK; k++) {
    json_t *one = NULL;
    status = quantity_json(b, k, &one);
    all = json_text_with(all, b->scenario->quantity[k].name, one);
  }
  if (status == COROT_OK && !all) status = no_memory();
  if (status == COROT_OK)
    *out = all;
  else
    json_decref(all);
  return status;
}

/* --- In words --- */

static void print_number(double x, const char *format, FILE *out) {
  if (isfinite(x))
    fprintf(out, format, x);
  else
    fputs("?", out);
}

void budget_quantities_print(const json_t *budget, FILE *out) {
  json_t *all = json_object_get(budget, "quantities");
  const char *name;
  json_t *q;
  json_object_foreach(all, name, q) {
    fprintf(out, "\n%s, %s: ", name, lookup_text(q, "of"));
    print_number(lookup_number(q, "value"), "%.6g", out);
    fputs(" as given, ", out);
    print_number(lookup_number(q, "reference"), "%.6g", out);
    fputs(" without all parts\n", out);
    const json_t *parts = json_object_get(q, "parts");
    for (size_t i = 0; i < json_array_size(parts); i++) {
      const json_t *part = json_array_get(parts, i);
      fprintf(out, "%-18s  ", lookup_text(part, "part"));
      print_number(lookup_number(part, "change"), "%+10.2e", out);
      fputs("  ", out);
      print_number(lookup_number(part, "error"), "%8.1e", out);
      fprintf(out, "  %s\n", lookup_text(part, "verdict"));
    }
  }
}
