/* Claims: what three levels of a mesh tend to, between which bounds an error is, and in words. */
#include "claim.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "states_sum.h"

const char *const claim_words[CLAIM_KINDS] = {
    [CLAIM_MISSING] = "missing",   [CLAIM_UNCHECKED] = "unchecked", [CLAIM_ABOUT] = "about",
    [CLAIM_AT_LEAST] = "at least", [CLAIM_AT_MOST] = "at most",
};

corot_status claim_distance(yardstick *y, const trajectory *run, const trajectory *reference,
                            errors *out) {
  *out = (errors){0};
  if (!run || !reference) return COROT_OK;
  return errors_measure(y, run, reference, out);
}

/* --- The mesh --- */

/* Of two differences of levels: their mean squares over time in the norm of the mass, and the
   smallest cosine of an angle between them, that of the whole or of a probe that moves. */
typedef struct level_pair {
  double d1, d2, cosine, scale;
} level_pair;

static void probe_products(const yardstick *y, const trajectory *first, const trajectory *second,
                           int probe, double product[3]) {
  product[0] = product[1] = product[2] = 0;
  for (int k = 0; k < first->count; k++)
    for (int c = 0; c < 3; c++) {
      double x = yardstick_probe(y, probe, c, states_u(first, k));
      double z = yardstick_probe(y, probe, c, states_u(second, k));
      product[0] += x * x;
      product[1] += z * z;
      product[2] += x * z;
    }
}

static double cosine_of(const double product[3]) {
  double size = sqrt(product[0] * product[1]);
  return size > 0 ? product[2] / size : 1;
}

static level_pair compare_levels(yardstick *y, const trajectory *first, const trajectory *second,
                                 const trajectory *finest) {
  double product[3] = {0, 0, 0}, size = 0, widest = 0;
  /* the differences of the whole body */
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
  /* and at the probes that move by a tenth of the one that moves most */
  for (int i = 0; i < y->nprobe; i++) {
    probe_products(y, first, second, i, product);
    widest = fmax(widest, product[1]);
  }
  for (int i = 0; i < y->nprobe; i++) {
    probe_products(y, first, second, i, product);
    if (product[1] > 0.01 * widest) p.cosine = fmin(p.cosine, cosine_of(product));
  }
  return p;
}

/* The order of three levels, and what they tend to, as far as they do. */
static corot_status extrapolate(yardstick *y, claim *c, const trajectory *middle,
                                const trajectory *finest) {
  static const double factor[] = {1, -1};
  static const int nterm[] = {2, 2, 1};
  const trajectory *const term[3][2] = {{middle, c->before}, {finest, middle}, {finest}};
  trajectory sum[3] = {{0}}; /* both differences, and the finest, at the places of the coarsest */
  corot_status status = COROT_OK;
  for (int k = 0; k < 3 && status == COROT_OK; k++)
    status = states_sum(c->before, nterm[k], factor, term[k], &sum[k]);
  if (status == COROT_OK) {
    level_pair p = compare_levels(y, &sum[0], &sum[1], &sum[2]);
    double known = c->known.n > 0 ? c->known.of[ERROR_DISPLACEMENT].max * p.scale : 0;
    c->convergence = convergence_observe_of(corot_mesh_order(y->mesh), p.d1, p.d2, p.cosine, known);
    double r = c->convergence.remainder, weight[] = {1, r};
    const trajectory *const limit[] = {&sum[2], &sum[1]};
    status = states_sum(c->before, 2, weight, limit, &c->made);
  }
  if (status == COROT_OK) c->after = &c->made;
  for (int k = 0; k < 3; k++) states_free(&sum[k]);
  return status;
}

corot_status claim_by_levels(yardstick *y, const trajectory *middle, const trajectory *finest,
                             claim *c) {
  c->is_space = true;
  c->nlevel = finest ? 3 : 2;
  c->after = middle;
  if (c->before && middle && finest) COROT_TRY(extrapolate(y, c, middle, finest));
  c->is_open = !c->convergence.asymptotic;
  COROT_TRY(claim_distance(y, c->before, finest ? finest : middle, &c->shown));
  return claim_distance(y, c->before, c->after, &c->error);
}

/* What the octasection of ten-node tets changed, at the places of the four-node ones. */
static corot_status find_rest(yardstick *y, const trajectory *raised, const trajectory *finer,
                              claim *c) {
  static const double one = 1;
  trajectory own = {0};
  COROT_TRY(states_sum(c->before, 1, &one, &raised, &own));
  corot_status status = claim_distance(y, &own, finer, &c->rest);
  states_free(&own);
  return status;
}

corot_status claim_by_order(yardstick *y, const trajectory *raised, const trajectory *finer,
                            claim *c) {
  c->is_space = c->by_order = c->is_open = true;
  c->nlevel = finer ? 3 : 2;
  c->after = finer ? finer : raised;
  COROT_TRY(claim_distance(y, c->before, c->after, &c->shown));
  COROT_TRY(claim_distance(y, c->before, c->after, &c->error));
  if (!c->before || !raised || !finer) return COROT_OK;
  COROT_TRY(find_rest(y, raised, finer, c));
  c->is_open = !(2 * c->rest.of[ERROR_DISPLACEMENT].max <= c->error.of[ERROR_DISPLACEMENT].max);
  return COROT_OK;
}

/* --- One number --- */

static corot_status one_error(double value, errors *out) {
  if (isnan(value)) return COROT_OK;
  out->of = calloc(1, sizeof *out->of);
  if (!out->of) return corot_fail(COROT_ENOMEM, "out of memory");
  out->n = 1;
  out->of[0] = (error_pair){value, value};
  return COROT_OK;
}

corot_status claim_of_numbers(int mesh_order, int nlevel, const double *q, double known, claim *c,
                              double *limit) {
  double first = q[1] - q[0], last = q[nlevel == 3 ? 2 : 1], tends_to = last;
  c->is_space = nlevel > 0;
  c->nlevel = nlevel;
  if (nlevel == 3) {
    double second = q[2] - q[1], cosine = first * second < 0 ? -1 : 1;
    c->convergence = convergence_observe_of(mesh_order, fabs(first), fabs(second), cosine,
                                            isnan(known) ? 0 : known);
    tends_to += c->convergence.remainder * second;
  }
  c->is_open = c->is_space && !c->convergence.asymptotic;
  COROT_TRY(one_error(known, &c->known));
  COROT_TRY(one_error(fabs(last - q[0]), &c->shown));
  COROT_TRY(one_error(fabs(tends_to - q[0]), &c->error));
  *limit = tends_to;
  return COROT_OK;
}

void claim_scale(claim *c, double size) {
  errors *const all[] = {&c->known, &c->shown, &c->error};
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < all[i]->n; k++) {
      error_pair *e = &all[i]->of[k];
      *e = (error_pair){error_relative(e->max, size), error_relative(e->end, size)};
    }
}

/* --- Bounds --- */

static double value_of(const errors *e, int i, bool end) {
  if (e->n == 0) return NAN;
  return end ? e->of[i].end : e->of[i].max;
}

claim_bound claim_bounds(const claim *c, int i, bool end) {
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
    double rest = c->rest.n > 0 ? value_of(&c->rest, i, end) : 0;
    b.low = fmax(0, least - rest - known);
    b.high = least + CONVERGENCE_SAFETY * (value - least) + rest + known;
  }
  return b;
}

/* --- In words --- */

static void verdict_by_order(const claim *c, claim_bound b, const char *left_out, size_t size,
                             char *text) {
  if (b.kind == CLAIM_UNCHECKED)
    snprintf(text, size, "%.1e against finer tets of ten nodes, which nobody has checked", b.value);
  else if (b.kind == CLAIM_ABOUT)
    snprintf(text, size, "against finer tets of ten nodes, between %.1e and %.1e", b.low, b.high);
  else if (c->nlevel == 3)
    snprintf(text, size, "at least %.1e; tets of ten nodes still change by %.1e when refined",
             b.low, value_of(&c->rest, ERROR_DISPLACEMENT, false));
  else
    snprintf(text, size,
             "at least %.1e; tets of ten nodes show it, and finer ones to check them were "
             "left out (%s)",
             b.low, left_out);
}

static void verdict_of_space(const claim *c, claim_bound b, const char *left_out, size_t size,
                             char *text) {
  if (c->by_order)
    verdict_by_order(c, b, left_out, size, text);
  else if (b.kind == CLAIM_UNCHECKED)
    snprintf(text, size, "%.1e by three levels of observed order %.2f, which nobody has checked",
             b.value, c->convergence.order);
  else if (b.kind == CLAIM_ABOUT)
    snprintf(text, size, "three levels, observed order %.2f: between %.1e and %.1e",
             c->convergence.order, b.low, b.high);
  else if (c->nlevel == 3)
    snprintf(text, size, "not asymptotic: at least %.1e; %s", b.low, c->convergence.why);
  else
    snprintf(text, size, "at least %.1e: two levels show no order; the third was left out (%s)",
             b.low, left_out);
}

void claim_verdict(const claim *c, const char *left_out, size_t size, char *text) {
  claim_bound b = claim_bounds(c, ERROR_DISPLACEMENT, false);
  if (b.kind == CLAIM_MISSING)
    snprintf(text, size, "not known, as a run failed");
  else if (b.kind == CLAIM_AT_MOST)
    snprintf(text, size, "below its floor: at most %.1e, as its reference is known to %.1e only",
             b.high, b.floor / ERROR_FLOOR);
  else if (c->is_space)
    verdict_of_space(c, b, left_out, size, text);
  else if (b.kind == CLAIM_UNCHECKED)
    snprintf(text, size, "%.1e, against a reference that nobody has checked", b.value);
  else
    snprintf(text, size, "known to %.1e", b.floor / ERROR_FLOOR);
}

void claim_free(claim *c) {
  errors_free(&c->error);
  errors_free(&c->shown);
  errors_free(&c->known);
  errors_free(&c->rest);
  states_free(&c->made);
}
