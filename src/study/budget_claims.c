/* What an error budget claims of each part, and how far that is to be trusted. */
#include <app/no_memory.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "budget_parts.h"
#include "states_sum.h"

const char *const claim_words[CLAIM_KINDS] = {
    [CLAIM_MISSING] = "missing",   [CLAIM_UNCHECKED] = "unchecked", [CLAIM_ABOUT] = "about",
    [CLAIM_AT_LEAST] = "at least", [CLAIM_AT_MOST] = "at most",
};

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

/* --- The mesh --- */

/* Of two differences of levels: their mean squares over time in the norm of the mass, and the
   smallest cosine of an angle between them, that of the whole or of a probe that moves. */
typedef struct level_pair {
  double d1, d2, cosine, scale;
} level_pair;

static void probe_products(const budgeting *b, const trajectory *first, const trajectory *second,
                           int probe, double product[3]) {
  const yardstick *y = b->yardstick;
  const int *dof = corot_model_dof(y->model)[y->probe[probe]];
  product[0] = product[1] = product[2] = 0;
  for (int k = 0; k < first->count; k++)
    for (int c = 0; c < 3; c++) {
      if (dof[c] < 0) continue;
      double x = states_u(first, k)[dof[c]], z = states_u(second, k)[dof[c]];
      product[0] += x * x;
      product[1] += z * z;
      product[2] += x * z;
    }
}

static double cosine_of(const double product[3]) {
  double size = sqrt(product[0] * product[1]);
  return size > 0 ? product[2] / size : 1;
}

static level_pair compare_levels(const budgeting *b, const trajectory *first,
                                 const trajectory *second, const trajectory *finest) {
  yardstick *y = b->yardstick;
  double product[3] = {0, 0, 0}, size = 0, widest = 0;
  for (int k = 0; k < first->count; k++) {
    const double *x = states_u(first, k), *z = states_u(second, k), *u = states_u(finest, k);
    product[0] += yardstick_product(y, x, x);
    product[1] += yardstick_product(y, z, z);
    product[2] += yardstick_product(y, x, z);
    size = fmax(size, yardstick_product(y, u, u));
  }
  level_pair p = {.d1 = sqrt(product[0] / first->count),
                  .d2 = sqrt(product[1] / first->count),
                  .cosine = cosine_of(product),
                  .scale = sqrt(size)};
  for (int i = 0; i < y->nprobe; i++) {
    probe_products(b, first, second, i, product);
    widest = fmax(widest, product[1]);
  }
  for (int i = 0; i < y->nprobe; i++) {
    probe_products(b, first, second, i, product);
    if (product[1] > 0.01 * widest) p.cosine = fmin(p.cosine, cosine_of(product));
  }
  return p;
}

/* The order of three levels, and what they tend to, as far as they do. */
static corot_status extrapolate(const budgeting *b, budget_claim *c, const trajectory *middle,
                                const trajectory *finest) {
  const double factor[] = {1, -1};
  const trajectory *of_first[] = {middle, c->before}, *of_second[] = {finest, middle};
  trajectory first = {0}, second = {0};
  corot_status status = states_sum(c->before, 2, factor, of_first, &first);
  if (status == COROT_OK) status = states_sum(c->before, 2, factor, of_second, &second);
  if (status == COROT_OK) {
    const trajectory *levels[] = {finest, middle};
    level_pair p;
    trajectory coarse = {0};
    status = states_sum(c->before, 1, factor, levels, &coarse);
    if (status == COROT_OK) {
      p = compare_levels(b, &first, &second, &coarse);
      double known = c->known.n > 0 ? c->known.of[ERROR_DISPLACEMENT].max * p.scale : 0;
      c->convergence = convergence_observe(p.d1, p.d2, p.cosine, known);
    }
    states_free(&coarse);
    double r = c->convergence.remainder, weight[] = {1 + r, -r};
    if (status == COROT_OK) status = states_sum(c->before, 2, weight, levels, &c->made);
    if (status == COROT_OK) c->after = &c->made;
  }
  states_free(&first);
  states_free(&second);
  return status;
}

static corot_status claim_space(const budgeting *b, budget_claim *c) {
  c->is_space = true;
  const trajectory *middle = c->after, *finest = budget_states(b, b->third_run);
  c->nlevel = finest ? 3 : 2;
  if (c->before && middle && finest) {
    /* a third level of looser steps is known as well as these are */
    errors loose = {0};
    int time = b->place[BUDGET_TIME];
    if (b->third_is_loose)
      COROT_TRY(budget_distance(b, budget_states(b, budget_before_run(b, time)),
                                budget_states(b, last_tight(b)), &loose));
    corot_status status = merge_errors(&c->known, &loose, true);
    errors_free(&loose);
    COROT_TRY(status);
    COROT_TRY(extrapolate(b, c, middle, finest));
  }
  c->is_open = !c->convergence.asymptotic;
  return budget_distance(b, c->before, finest ? finest : middle, &c->shown);
}

/* --- Parts and total --- */

static corot_status claim_part(const budgeting *b, int place, budget_claim *c) {
  *c = (budget_claim){.before = budget_states(b, budget_before_run(b, place)),
                      .after = budget_states(b, budget_chain_run(b, place))};
  COROT_TRY(known_of_part(b, place, &c->known));
  if (place == b->place[BUDGET_TIME]) c->after = budget_states(b, last_tight(b));
  if (place == b->place[BUDGET_SPACE]) COROT_TRY(claim_space(b, c));
  return budget_distance(b, c->before, c->after, &c->error);
}

/* The run as given, and what every part has taken away; where one is missing, the first run against
   the last. */
static corot_status claim_total(const budgeting *b, budget_claims *all) {
  budget_claim *c = &all->total;
  const trajectory *term[1 + 2 * BUDGET_KINDS];
  double factor[1 + 2 * BUDGET_KINDS];
  int n = 1, last = b->plan.npart - 1;
  bool whole = true;
  *c = (budget_claim){.before = budget_states(b, 0),
                      .after = budget_states(b, budget_chain_run(b, last))};
  COROT_TRY(known_of_part(b, last, &c->known));
  term[0] = c->before;
  factor[0] = 1;
  for (int i = 0; i <= last; i++) {
    const budget_claim *part = &all->part[i];
    whole &= part->before && part->after;
    c->is_open |= part->is_open;
    term[n] = part->after;
    factor[n++] = 1;
    term[n] = part->before;
    factor[n++] = -1;
  }
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

static void free_claim(budget_claim *c) {
  errors_free(&c->error);
  errors_free(&c->shown);
  errors_free(&c->known);
  states_free(&c->made);
}

void budget_claims_free(budget_claims *c) {
  for (int i = 0; i < BUDGET_KINDS; i++) free_claim(&c->part[i]);
  free_claim(&c->total);
  errors_free(&c->check);
  errors_free(&c->chain);
}

/* --- Bounds --- */

static double value_of(const errors *e, int i, bool end) {
  if (e->n == 0) return NAN;
  return end ? e->of[i].end : e->of[i].max;
}

claim_bound budget_claim_bound(const budget_claim *c, int i, bool end) {
  double value = value_of(&c->error, i, end), known = value_of(&c->known, i, end);
  claim_bound b = {CLAIM_ABOUT, value, NAN, NAN, ERROR_FLOOR * known};
  if (isnan(value)) return b.kind = CLAIM_MISSING, b;
  double least = c->is_space ? fmin(value, value_of(&c->shown, i, end)) : value;
  if (!isnan(known) && !is_rated(&c->error.of[i], &c->known.of[i], end)) {
    b.kind = CLAIM_AT_MOST;
    b.low = 0;
    b.high = fmax(b.floor, value + known);
  } else if (c->is_open) {
    b.kind = CLAIM_AT_LEAST;
    b.low = least - (isnan(known) ? 0 : known);
  } else if (isnan(known)) {
    b.kind = CLAIM_UNCHECKED;
  } else {
    b.low = least - known;
    b.high = least + CONVERGENCE_SAFETY * (value - least) + known;
  }
  return b;
}
