/* What an error budget claims of each part, and how far that is to be trusted. */
#include "budget_claims.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/text/no_memory.h"
#include "study/measure/states_sum.h"

/* --- What references are known by --- */

/* The larger of both, or (`sum`) the sum, into a; where one of them is not known, b is. */
static corot_status merge_errors(errors *a, const errors *b, bool sum) {
  if (b->n == 0) return COROT_OK;
  if (a->n == 0) {
    a->of = calloc((size_t)b->n, sizeof *a->of);
    if (!a->of) return no_memory();
    a->n = b->n;
  }
  for (int i = 0; i < a->n; i++) {
    error_pair *p = &a->of[i];
    const error_pair *q = &b->of[i];
    p->max = sum ? p->max + q->max : fmax(p->max, q->max);
    p->end = sum ? p->end + q->end : fmax(p->end, q->end);
  }
  return COROT_OK;
}

static int last_tight(const budgeting *b) { return b->ntight > 0 ? b->tight[b->ntight - 1] : -1; }

/* Two independent methods at the finest tolerance. */
static corot_status check_of_time(const budgeting *b, errors *out) {
  int k = b->ntight - 1;
  if (k < 0) return *out = (errors){0}, COROT_OK;
  return budget_distance(b, budget_states(b, b->check[k]), budget_states(b, b->tight[k]), out);
}

/* How well the algebra's tightest run is known: by one of ten times its tolerances. */
static corot_status check_of_algebra(const budgeting *b, errors *out) {
  int place = b->place[BUDGET_ALGEBRA];
  *out = (errors){0};
  if (place < 0) return COROT_OK;
  return budget_distance(b, budget_states(b, b->algebra_check),
                         budget_states(b, budget_chain_run(b, place)), out);
}

/* How well the chain's runs after the part of time are known: by the check of their tolerance, and
   by what finer ones have shown. */
static corot_status check_of_chain(const budgeting *b, errors *out) {
  *out = (errors){0};
  if (b->ntight == 0) return COROT_OK;
  const trajectory *first = budget_states(b, b->tight[0]);
  errors finer;
  COROT_TRY(budget_distance(b, budget_states(b, b->check[0]), first, out));
  if (b->ntight == 1) return COROT_OK;
  corot_status status = budget_distance(b, first, budget_states(b, last_tight(b)), &finer);
  if (status == COROT_OK) status = merge_errors(out, &finer, false);
  errors_free(&finer);
  return status;
}

/* The check that stands for a part. Before the part of time both neighbours take the same steps. */
static corot_status find_check(const budgeting *b, int place, errors *out) {
  int time = b->place[BUDGET_TIME];
  if (place == time) return check_of_time(b, out);
  if (b->options->still || place < time || place == b->place[BUDGET_ALGEBRA])
    return check_of_algebra(b, out);
  return check_of_chain(b, out);
}

/* No relative error is known better than by the rounding of the states. */
static corot_status known_of_part(const budgeting *b, int place, errors *out) {
  static const double rounding = 1e-14;
  COROT_TRY(find_check(b, place, out));
  for (int i = 0; i < ERROR_PROBES && i < out->n; i++) {
    out->of[i].max = fmax(out->of[i].max, rounding);
    out->of[i].end = fmax(out->of[i].end, rounding);
  }
  return COROT_OK;
}

/* --- Parts and total --- */

/* A third level of looser steps is known as well as these are. */
static corot_status claim_space(const budgeting *b, claim *c) {
  const trajectory *middle = c->after;
  int time = b->place[BUDGET_TIME];
  errors loose = {0};
  if (b->third_is_loose)
    COROT_TRY(budget_distance(b, budget_states(b, budget_before_run(b, time)),
                              budget_states(b, last_tight(b)), &loose));
  corot_status status = merge_errors(&c->known, &loose, true);
  errors_free(&loose);
  COROT_TRY(status);
  const trajectory *finest = budget_states(b, b->third_run);
  return b->plan.by_order ? claim_by_order(b->yardstick, middle, finest, c)
                          : claim_by_levels(b->yardstick, middle, finest, c);
}

static corot_status claim_part(const budgeting *b, int place, claim *c) {
  *c = (claim){.before = budget_states(b, budget_before_run(b, place)),
               .after = budget_states(b, budget_chain_run(b, place))};
  COROT_TRY(known_of_part(b, place, &c->known));
  if (place == b->place[BUDGET_TIME]) c->after = budget_states(b, last_tight(b));
  if (place == b->place[BUDGET_SPACE]) return claim_space(b, c);
  return budget_distance(b, c->before, c->after, &c->error);
}

/* The run as given, and what every part has taken away; where one is missing, the first run against
   the last. */
static corot_status claim_total(const budgeting *b, budget_claims *all) {
  claim *c = &all->total;
  const trajectory *term[1 + 2 * BUDGET_KINDS];
  double factor[1 + 2 * BUDGET_KINDS];
  int n = 1, last = b->plan.npart - 1;
  bool whole = true;
  *c = (claim){.before = budget_states(b, 0), .after = budget_states(b, budget_chain_run(b, last))};
  COROT_TRY(known_of_part(b, last, &c->known));
  /* the sum: the first run, and the change that each part makes */
  term[0] = c->before;
  factor[0] = 1;
  for (int i = 0; i <= last; i++) {
    const claim *part = &all->part[i];
    whole &= part->before && part->after;
    c->is_open |= part->is_open;
    term[n] = part->after;
    factor[n++] = 1;
    term[n] = part->before;
    factor[n++] = -1;
  }
  /* against the first run */
  c->is_open |= !whole;
  if (whole) {
    COROT_TRY(states_sum(c->before, n, factor, term, &c->made));
    c->after = &c->made;
  }
  return budget_distance(b, c->before, c->after, &c->error);
}

static corot_status make_claims(const budgeting *b, budget_claims *all) {
  for (int i = 0; i < b->plan.npart; i++) COROT_TRY(claim_part(b, i, &all->part[i]));
  COROT_TRY(claim_total(b, all));
  COROT_TRY(check_of_chain(b, &all->chain));
  return check_of_time(b, &all->check);
}

corot_status budget_claims_make(const budgeting *b, budget_claims *out) {
  *out = (budget_claims){0};
  corot_status status = make_claims(b, out);
  if (status != COROT_OK) budget_claims_free(out);
  return status;
}

void budget_claims_free(budget_claims *c) {
  for (int i = 0; i < BUDGET_KINDS; i++) claim_free(&c->part[i]);
  claim_free(&c->total);
  errors_free(&c->check);
  errors_free(&c->chain);
}
