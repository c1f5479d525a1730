/* The choice of methods by cost, kept in study.json so that a study goes on as it began. */
#include "reference_methods.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "app/folder/folder.h"
#include "app/text/json_text.h"
#include "app/text/no_memory.h"
#include "study/execute/pilot.h"
#include "study/execute/store.h"
#include "study/plan/plan.h"

enum { CVODE, ARKODE, ERK, NMETHOD };
static const char *const methods[NMETHOD] = {"cvode", "arkode", "erk"};

#define WORTH_S 10 /* below, nothing is gained */

static const char *find_method(const json_t *word) {
  const char *text = json_string_value(word);
  for (int i = 0; text && i < NMETHOD; i++)
    if (strcmp(text, methods[i]) == 0) return methods[i];
  return NULL;
}

static bool is_open(const study *s) {
  return s->referred && !s->still && s->reference_is_open && !s->pilot;
}

/* Whether there is a study.json; what is not known is taken for one, and found out by who reads it.
 */
static corot_status find_manifest(const char *dir, bool *is_there) {
  struct stat info;
  char *path = folder_path(dir, "study.json");
  if (!path) return no_memory();
  *is_there = lstat(path, &info) == 0 || (errno != ENOENT && errno != ENOTDIR);
  free(path);
  return COROT_OK;
}

static void take_over(study *s, const manifest *before) {
  json_t *pilot = json_object_get(before->root, "pilot");
  const json_t *chosen = json_object_get(pilot, "methods");
  const char *first = find_method(json_array_get(chosen, 0));
  const char *second = find_method(json_array_get(chosen, 1));
  if (!first || !second || strcmp(before->title, s->title) != 0) return;
  s->reference_method[0] = first;
  s->reference_method[1] = second;
  s->pilot = json_incref(pilot);
}

corot_status reference_methods_recall(study *s, const char *dir) {
  manifest *before = NULL;
  bool is_there = false;
  if (!is_open(s)) return COROT_OK;
  COROT_TRY(find_manifest(dir, &is_there));
  if (!is_there) return COROT_OK;
  corot_status status = manifest_read(dir, &before);
  if (status == COROT_EFORMAT) return COROT_OK; /* a new one takes its place */
  if (status == COROT_OK) take_over(s, before);
  manifest_destroy(before);
  return status;
}

/* Whether all references are there already. */
static corot_status look(const manifest *m, const char *dir, bool *done) {
  *done = true;
  for (int i = 0; i < 2 * m->nreference && *done; i++) {
    run_record record;
    COROT_TRY(store_look(dir, &m->run[m->reference[i / 2].run[i % 2]], &record));
    *done = record.state == RUN_DONE;
    run_record_free(&record);
  }
  return COROT_OK;
}

void reference_methods_take(const double cost[3], const char *taken[2]) {
  int dear = cost[ARKODE] > cost[CVODE] ? ARKODE : CVODE, other = ARKODE + CVODE - dear;
  bool gains = isfinite(cost[ERK]) && cost[dear] >= WORTH_S && cost[ERK] < 0.5 * cost[dear];
  taken[0] = gains ? methods[other] : methods[CVODE];
  taken[1] = gains ? methods[ERK] : methods[ARKODE];
}

static void tell(const study *s, const double cost[NMETHOD]) {
  char time[NMETHOD][32];
  for (int i = 0; i < NMETHOD; i++) describe_duration(cost[i], sizeof time[i], time[i]);
  fprintf(stderr,
          "pilot: a reference takes about %s by %s, %s by %s, %s by %s: %s and %s are taken\n",
          time[0], methods[0], time[1], methods[1], time[2], methods[2], s->reference_method[0],
          s->reference_method[1]);
}

static corot_status plan_anew(study *s, const char *dir, manifest **m) {
  manifest *made = NULL;
  COROT_TRY(plan_study(s, &made));
  corot_status status = manifest_write(made, dir);
  if (status == COROT_OK) {
    manifest_destroy(*m);
    *m = made;
  } else {
    manifest_destroy(made);
  }
  return status;
}

/* The mean of what both will cost, over their work. */
static double unit_of(const study *s, const double cost[NMETHOD], double work) {
  double sum = 0;
  for (int k = 0; k < 2; k++)
    for (int i = 0; i < NMETHOD; i++)
      if (strcmp(s->reference_method[k], methods[i]) == 0) sum += cost[i] / 2;
  return isfinite(sum) ? sum / work : 0;
}

corot_status reference_methods_choose(study *s, execute_options *o, manifest **m,
                                      int *signal_number) {
  bool done = true;
  double cost[NMETHOD], work;
  *signal_number = 0;
  if (!is_open(s) || o->nshard > 1) return COROT_OK;
  COROT_TRY(look(*m, o->dir, &done));
  if (done) return COROT_OK;
  COROT_TRY(pilot_methods(*m, o, NMETHOD, methods, cost, &work, signal_number));
  if (*signal_number) return COROT_OK;
  reference_methods_take(cost, s->reference_method);
  if (!o->quiet) tell(s, cost);
  o->reference_unit = unit_of(s, cost, work);
  json_t *costs = json_object();
  for (int i = 0; i < NMETHOD; i++)
    costs = json_text_with(costs, methods[i], json_text_real(cost[i]));
  s->pilot = json_pack("{s:[s, s], s:o}", "methods", s->reference_method[0], s->reference_method[1],
                       "cost", costs);
  return s->pilot ? plan_anew(s, o->dir, m) : no_memory();
}
