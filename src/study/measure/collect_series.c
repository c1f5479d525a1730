/* What is said of whole series: how errors follow tolerances, and which is the cheapest. */
#include "collect_series.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/text/json_text.h"
#include "collect_shared.h"
#include "fit.h"

static const char *key_of(const table_row *r) {
  return r->cell->tolerance_key ? r->cell->tolerance_key : "";
}

/* Rows come sorted by series; those of one with one kind of tolerance are fitted together. */
static bool go_together(const table_row *a, const table_row *b) {
  return strcmp(a->cell->series, b->cell->series) == 0 && strcmp(key_of(a), key_of(b)) == 0;
}

/* --- Fits --- */

static bool is_of_mesh(const char *key) { return key && strcmp(key, "mesh.refine") == 0; }

/* Whether nobody knows how much of its error the mesh makes: the reference has the same. */
static bool hides_mesh(const table_rows *t, const table_row *r) {
  return r->measured && !row_is_of_known(t, r) && cell_shares_mesh(t, r);
}

static bool is_point(const table_rows *t, const table_row *r) {
  double error = row_has_error(t, r) ? row_error(t, r) : 0;
  if (is_of_mesh(r->cell->tolerance_key) && hides_mesh(t, r)) return false;
  return r->cell->tolerance > 0 && error > 0 && isfinite(error) && row_is_rated(t, r);
}

static json_t *fit_json(const table_row *r, const power_fit *f) {
  char words[64];
  const char *key = r->cell->tolerance_key;
  fit_verdict(f, key && strstr(key, "tol"), sizeof words, words);
  if (is_of_mesh(key) && f->n == 2)
    snprintf(words, sizeof words, "order %.2f, by two meshes", f->exponent);
  return json_pack("{s:s, s:s?, s:o, s:o, s:o, s:i, s:s}", "series", r->cell->series,
                   "tolerance_key", key, "exponent", json_text_real(f->exponent), "constant",
                   json_text_real(f->constant), "residual", json_text_real(f->residual), "points",
                   f->n, "verdict", words);
}

json_t *collect_fits(const table_rows *t) {
  double *tolerance = calloc(2 * (size_t)t->n + 1, sizeof *tolerance);
  double *error = tolerance ? tolerance + t->n : NULL;
  json_t *list = tolerance ? json_array() : NULL;
  for (int i = 0, next; list && i < t->n; i = next) {
    int n = 0;
    for (next = i; next < t->n && go_together(&t->row[i], &t->row[next]); next++) {
      if (!is_point(t, &t->row[next])) continue;
      tolerance[n] = t->row[next].cell->tolerance;
      error[n++] = row_error(t, &t->row[next]);
    }
    if (!t->row[i].cell->tolerance_key) continue;
    power_fit f = fit_power(n, tolerance, error);
    list = json_text_push(list, fit_json(&t->row[i], &f));
  }
  free(tolerance);
  return list;
}

/* --- Rankings --- */

/* What the error is at most, as far as what it is held against is known. */
static double bound(const table_rows *t, const table_row *r) {
  if (!row_has_error(t, r) || (t->total && hides_mesh(t, r))) return INFINITY;
  return row_error(t, r) + row_floor(t, r);
}

/* The cheapest row of a series with an error of at most `target`; NULL: there is none. */
static const table_row *cheapest(const table_rows *t, int first, int end, double target) {
  const table_row *best = NULL;
  for (int i = first; i < end; i++) {
    const table_row *r = &t->row[i];
    double cost = cost_named(&r->cost, t->cost);
    if (!(bound(t, r) <= target) || isnan(cost)) continue;
    if (!best || cost < cost_named(&best->cost, t->cost)) best = r;
  }
  return best;
}

typedef struct ranked {
  const table_row *row;
  double cost;
} ranked;

static int by_cost(const void *first, const void *second) {
  const ranked *a = first, *b = second;
  if (a->cost != b->cost) return a->cost < b->cost ? -1 : 1;
  return strcmp(a->row->cell->series, b->row->cell->series);
}

static json_t *ranking(const table_rows *t, double target, ranked *best) {
  size_t n = 0;
  for (int i = 0, next; i < t->n; i = next) {
    for (next = i + 1; next < t->n; next++)
      if (strcmp(t->row[i].cell->series, t->row[next].cell->series) != 0) break;
    const table_row *r = cheapest(t, i, next, target);
    if (r) best[n++] = (ranked){r, cost_named(&r->cost, t->cost)};
  }
  if (n == 0) return json_null();
  qsort(best, n, sizeof *best, by_cost);
  json_t *list = json_array();
  for (size_t i = 0; i < n; i++) {
    const study_cell *c = best[i].row->cell;
    list = json_text_push(
        list, json_pack("{s:s, s:s, s:o, s:o, s:s?}", "series", c->series, "id",
                        best[i].row->run->id, "cost", json_text_real(best[i].cost), "tolerance",
                        json_text_real(c->tolerance), "tolerance_key", c->tolerance_key));
  }
  return json_pack("{s:f, s:o}", "error", target, "best", list);
}

json_t *collect_rankings(const table_rows *t) {
  static const double target[] = {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9};
  ranked *best = calloc((size_t)t->n + 1, sizeof *best);
  json_t *list = best ? json_array() : NULL;
  for (size_t i = 0; list && i < sizeof target / sizeof *target; i++) {
    json_t *entry = ranking(t, target[i], best);
    if (!json_is_null(entry)) list = json_text_push(list, entry);
  }
  free(best);
  return list;
}
