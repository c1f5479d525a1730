/* Attempts as variants of the scenario. */
#define _XOPEN_SOURCE 700 /* realpath */
#include "goal_attempts.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "app/text/no_memory.h"
#include "app/text/say.h"
#include "study/execute/store.h"
#include "study/execute/variants.h"
#include "study/measure/collect_quantities.h"

corot_status attempts_begin(attempts *a) {
  a->all = calloc(ATTEMPT_MOST, sizeof *a->all);
  return a->all ? COROT_OK : no_memory();
}

void attempts_end(attempts *a) {
  free(a->all);
  manifest_destroy(a->manifest);
}

double attempts_cpu(const attempts *a) {
  double sum = 0;
  for (int i = 0; i < a->n; i++)
    if (isfinite(a->all[i].cpu)) sum += a->all[i].cpu;
  return sum;
}

char *attempts_folder(const attempts *a, int i) {
  return store_path(a->options.dir, &a->manifest->run[a->all[i].at], "");
}

char *attempts_marks(const attempts *a, int npass) {
  size_t size = strlen(a->options.dir) + 32;
  char *path = malloc(size);
  if (path) snprintf(path, size, "%s/marks/%d.txt", a->options.dir, npass);
  return path;
}

/* --- Settings --- */

static void __attribute__((format(printf, 2, 3))) add(attempt *a, const char *format, ...) {
  va_list values;
  va_start(values, format);
  vsnprintf(a->set[a->nset++], ATTEMPT_SETTING_SIZE, format, values);
  va_end(values);
}

/* All that is no choice of the user's but an approximation, whose error would have to be found: the
   frames of each evaluation, without a hierarchy. */
static void set_model(const scenario *s, const attempt_def *def, attempt *a) {
  const corot_strain_kind *strain = corot_strain_find(s->model.strain);
  bool hierarchy = s->model.hierarchy != NULL;
  if (hierarchy) add(a, "hierarchy=null");
  if ((strain->frames || hierarchy) && s->frames.frames != COROT_FRAMES_EXACT)
    add(a, "frames={policy: exact}");
  if (hierarchy || (def->green && s->model.viscosity == COROT_OBJECTIVE))
    add(a, "viscosity=corotated");
  if (def->green) add(a, "strain=green");
}

static corot_status set_mesh(const attempts *all, const attempt_def *def, attempt *a) {
  const scenario *s = all->scenario;
  add(a, "mesh.order=%d", def->order);
  if (def->refine > 0 || s->refine > 0) add(a, "mesh.refine=%d", def->refine);
  if (def->order == 2 && s->model.mass == COROT_MASS_LUMPED) add(a, "mass=consistent");
  if (def->npass == 0) return COROT_OK;
  /* the place of the file is written down as it is found from anywhere */
  char *path = attempts_marks(all, def->npass), *absolute = path ? realpath(path, NULL) : NULL;
  bool fits = absolute && strlen(absolute) + 16 < ATTEMPT_SETTING_SIZE;
  if (fits) add(a, "mesh.marks=%s", absolute);
  free(absolute);
  free(path);
  return fits ? COROT_OK : corot_fail(COROT_EIO, "%s: too long a name", all->options.dir);
}

static void set_time(const scenario *s, const attempt_def *def, attempt *a) {
  bool same = s->integrator.step == 0 && strcmp(s->integrator.method, def->method) == 0;
  if (same) {
    add(a, "integrator.rtol=%.3g", def->rtol);
    if (s->integrator.atol_displacement > 0) add(a, "integrator.atol.displacement=auto");
    if (s->integrator.atol_velocity > 0) add(a, "integrator.atol.velocity=auto");
  } else {
    add(a, "integrator={method: %s, rtol: %.3g}", def->method, def->rtol);
  }
  if (def->tight_algebra) add(a, "integrator.jacobian.convergence=1e-4");
  if (def->until < s->t_end) add(a, "time.end=%.17g", def->until);
}

/* A window that ends later than the run. */
static void set_window(const attempts *all, attempt *a) {
  quantity q = *all->quantity;
  char text[QUANTITY_TEXT];
  if (!(q.to > a->def.until) || isinf(q.to)) return;
  q.to = a->def.until;
  quantity_print(&q, text);
  add(a, "quantities.%s=%s", all->name, text);
}

static corot_status set_all(const attempts *all, attempt *a) {
  const scenario *s = all->scenario;
  const attempt_def *def = &a->def;
  set_model(s, def, a);
  COROT_TRY(set_mesh(all, def, a));
  if (!all->still) {
    set_time(s, def, a);
    set_window(all, a);
  }
  if (all->still && def->tight_algebra) add(a, "statics.tolerance=1e-13");
  if (def->tight_algebra) add(a, "linear_solver.tolerance=1e-13");
  if (s->write_fields) add(a, "output.fields=none");
  if (!s->write_states) add(a, "output.states=binary");
  return COROT_OK;
}

static void name(const attempts *all, attempt *a) {
  const attempt_def *def = &a->def;
  int used = snprintf(a->label, sizeof a->label, "order %d", def->order);
  char *at = a->label;
  size_t size = sizeof a->label;
  if (def->refine > 0)
    used += snprintf(at + used, size - (size_t)used, ", refined %d", def->refine);
  if (def->npass > 0) used += snprintf(at + used, size - (size_t)used, ", local %d", def->npass);
  if (!all->still)
    used += snprintf(at + used, size - (size_t)used, ", %s %.1g", def->method, def->rtol);
  if (!all->still && def->until < all->scenario->t_end)
    used += snprintf(at + used, size - (size_t)used, ", to %.4g s", def->until);
  if (def->tight_algebra) used += snprintf(at + used, size - (size_t)used, ", algebra tight");
  if (def->green) snprintf(at + used, size - (size_t)used, ", green");
}

static bool is_same(const attempt_def *a, const attempt_def *b, bool still) {
  bool mesh = a->order == b->order && a->refine == b->refine && a->npass == b->npass;
  bool time =
      still || (strcmp(a->method, b->method) == 0 && a->rtol == b->rtol && a->until == b->until);
  return mesh && time && a->tight_algebra == b->tight_algebra && a->green == b->green;
}

int attempts_plan(attempts *a, attempt_def def) {
  for (int i = 0; i < a->n; i++)
    if (is_same(&a->all[i].def, &def, a->still)) return i;
  if (a->n == ATTEMPT_MOST) return -1;
  attempt *new = &a->all[a->n];
  *new = (attempt){.def = def, .value = NAN, .when = NAN, .largest = NAN, .swing = NAN, .cpu = NAN};
  name(a, new);
  return a->n++;
}

/* --- What came of them --- */

static double number_of(const json_t *object, const char *key) {
  const json_t *value = json_object_get(object, key);
  return json_is_number(value) ? json_number_value(value) : NAN;
}

/* The largest absolute value of a column and of its neighbours of the same probe, as result.json
   has their extremes. */
static double largest_of(json_t *result, const char *column) {
  const char *dot = strrchr(column, '.'), *key;
  size_t length = dot ? (size_t)(dot - column) + 1 : strlen(column) + 1;
  json_t *of;
  double largest = NAN;
  json_object_foreach(json_object_get(result, "extremes"), key, of) {
    if (strncmp(key, column, length) != 0) continue;
    largest = fmax(largest, fabs(number_of(json_object_get(of, "min"), "value")));
    largest = fmax(largest, fabs(number_of(json_object_get(of, "max"), "value")));
  }
  return largest;
}

static double extreme_of(const json_t *result, const char *column) {
  const json_t *of = json_object_get(json_object_get(result, "extremes"), column);
  return number_of(json_object_get(of, "max"), "value");
}

static void read_result(attempts *all, json_t *result, attempt *a) {
  const json_t *mesh = json_object_get(result, "mesh");
  const json_t *found = json_object_get(json_object_get(result, "quantities"), all->name);
  const char *why = json_string_value(json_object_get(found, "reason"));
  const char *unit = json_string_value(json_object_get(found, "unit"));
  a->done = true;
  a->tets = (int)json_integer_value(json_object_get(mesh, "tets"));
  a->dofs = (int)json_integer_value(json_object_get(mesh, "dofs"));
  a->cpu = number_of(json_object_get(result, "timings"), "cpu");
  const json_t *counts = json_object_get(result, "statistics");
  a->work = number_of(counts, "nfe") + fmax(0, number_of(counts, "nsolve"));
  a->swing = extreme_of(result, "kinetic") / extreme_of(result, "elastic");
  a->value = quantity_found(result, all->name);
  a->when = number_of(found, "t");
  a->largest = largest_of(result, all->column);
  if (why) snprintf(a->reason, sizeof a->reason, "%s", why);
  if (unit) snprintf(all->unit, sizeof all->unit, "%s", unit);
}

static corot_status look(attempts *all, attempt *a) {
  run_record record;
  COROT_TRY(store_look(all->options.dir, &all->manifest->run[a->at], &record));
  a->looked = true;
  if (record.state == RUN_DONE)
    read_result(all, record.result, a);
  else
    snprintf(a->reason, sizeof a->reason, "%s", record.reason ? record.reason : "");
  a->exit_code = record.exit_code;
  bool again = record.timed_out; /* with more time it may come to an end */
  run_record_free(&record);
  return again ? store_clear(all->options.dir, &all->manifest->run[a->at]) : COROT_OK;
}

static void tell(const attempts *all, const attempt *a) {
  if (all->options.quiet) return;
  if (isnan(a->value))
    say("%s: %s\n", a->label, a->reason);
  else
    say("%s: %d tets, %.6g %s (%.2g s)\n", a->label, a->tets, a->value, all->unit, a->cpu);
}

/* Processes inherit the limit, each for itself; what this one has used counts for it alone. */
static void limit_cpu(const attempts *a, struct rlimit *before) {
  struct rusage own;
  getrlimit(RLIMIT_CPU, before);
  getrusage(RUSAGE_SELF, &own);
  double left = fmax(0, a->cpu_limit - attempts_cpu(a)) + (double)own.ru_utime.tv_sec + 2;
  struct rlimit limit = *before;
  if (left < 1e9 && (limit.rlim_cur == RLIM_INFINITY || left < (double)limit.rlim_cur))
    limit.rlim_cur = (rlim_t)ceil(left);
  setrlimit(RLIMIT_CPU, &limit);
}

corot_status attempts_make(attempts *a) {
  variant list[ATTEMPT_MOST];
  const char *set[ATTEMPT_MOST][ATTEMPT_SETTINGS];
  int at[ATTEMPT_MOST];
  for (int i = 0; i < a->n; i++) {
    attempt *one = &a->all[i];
    if (one->nset == 0) COROT_TRY(set_all(a, one));
    for (int k = 0; k < one->nset; k++) set[i][k] = one->set[k];
    list[i] = (variant){.label = one->label, .nset = one->nset, .set = set[i]};
  }
  variants v = {.what = a->still ? "Goal of the equilibrium" : "Goal",
                .scenario = a->scenario,
                .still = a->still,
                .nset = a->nset,
                .set = a->set,
                .nvariant = a->n,
                .variant = list};
  execute_options options = a->options;
  options.expects_failures = true;
  options.progress = false;
  options.tells_builds = !a->manifest;
  manifest *m = NULL;
  struct rlimit before;
  limit_cpu(a, &before);
  corot_status status = variants_execute(&v, &options, &m, at, &a->signal_number);
  setrlimit(RLIMIT_CPU, &before);
  COROT_TRY(status);
  manifest_destroy(a->manifest);
  a->manifest = m;
  for (int i = 0; i < a->n && !a->signal_number; i++) {
    a->all[i].at = at[i];
    if (a->all[i].looked) continue;
    COROT_TRY(look(a, &a->all[i]));
    tell(a, &a->all[i]);
  }
  return COROT_OK;
}
