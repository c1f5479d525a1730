/* What a run has cost. */
#include "collect_costs.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/text/json_text.h"

static const struct {
  const char *name;
  size_t offset;
} named[] = {
    {"cpu", offsetof(costs, cpu)},           {"cpu_min", offsetof(costs, cpu_min)},
    {"cpu_max", offsetof(costs, cpu_max)},   {"wall", offsetof(costs, wall)},
    {"wall_min", offsetof(costs, wall_min)}, {"wall_max", offsetof(costs, wall_max)},
    {"steps", offsetof(costs, steps)},       {"rhs", offsetof(costs, rhs)},
    {"solves", offsetof(costs, solves)},     {"factorisations", offsetof(costs, factorisations)},
};
enum { NNAMED = sizeof named / sizeof *named };

static double at_offset(const costs *c, size_t offset) {
  double value;
  memcpy(&value, (const char *)c + offset, sizeof value);
  return value;
}

double cost_named(const costs *c, const char *name) {
  for (int i = 0; i < NNAMED; i++)
    if (strcmp(named[i].name, name) == 0) return at_offset(c, named[i].offset);
  return NAN;
}

bool is_cost(const char *name) {
  for (int i = 0; i < NNAMED; i++)
    if (strcmp(named[i].name, name) == 0) return true;
  return false;
}

json_t *costs_json(const costs *c) {
  json_t *json = json_object();
  for (int i = 0; i < NNAMED; i++) {
    double value = at_offset(c, named[i].offset);
    bool count = i >= 6;
    json = json_text_with(
        json, named[i].name,
        count && isfinite(value) ? json_integer((json_int_t)value) : json_text_real(value));
  }
  return json_text_with(json, "repeats", json_integer(c->repeats));
}

static int by_value(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Sorts x [n]. */
static void spread(int n, double *x, double *least, double *median, double *most) {
  qsort(x, (size_t)n, sizeof *x, by_value);
  *least = x[0];
  *most = x[n - 1];
  *median = (x[(n - 1) / 2] + x[n / 2]) / 2;
}

static double number_at(const json_t *object, const char *key) {
  const json_t *value = json_object_get(object, key);
  return json_is_number(value) ? json_number_value(value) : NAN;
}

corot_status costs_read(const char *dir, const study_run *run, const json_t *result,
                        builds *made_by, costs *out) {
  const json_t *count = json_object_get(result, "statistics");
  const json_t *time = json_object_get(result, "timings");
  const char *steps = json_object_get(count, "nst") ? "nst" : "nstep"; /* of the load */
  costs c = {.steps = number_at(count, steps),
             .rhs = number_at(count, "nfe"),
             .factorisations = number_at(count, "nfactor"),
             .solves = number_at(count, "nsolve")};
  timings t = {0};
  COROT_TRY(timings_read(dir, run, &t));
  c.repeats = t.n;
  for (int i = 0; i < t.n; i++) builds_add_timed(made_by, run, result, t.provenance[i]);
  if (t.n > 0) {
    spread(t.n, t.cpu, &c.cpu_min, &c.cpu, &c.cpu_max);
    spread(t.n, t.wall, &c.wall_min, &c.wall, &c.wall_max);
  } else {
    c.cpu = c.cpu_min = c.cpu_max = number_at(time, "cpu");
    c.wall = c.wall_min = c.wall_max = number_at(time, "wall");
  }
  timings_free(&t);
  *out = c;
  return COROT_OK;
}
