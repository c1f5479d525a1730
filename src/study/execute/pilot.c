/* Short runs by several methods, and what they tell of long ones. */
#include "pilot.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "app/folder/folder.h"
#include "app/text/no_memory.h"
#include "pool.h"
#include "study/plan/json_file.h"

enum { MOST_S = 10 };
#define PART 0.02 /* of the time */

void describe_duration(double s, size_t size, char *text) {
  if (!(s >= 0 && isfinite(s)))
    snprintf(text, size, "?");
  else if (s < 60)
    snprintf(text, size, "%.2g s", s);
  else if (s < 3600)
    snprintf(text, size, "%.0f:%02.0f min", floor(s / 60), floor(fmod(s, 60)));
  else
    snprintf(text, size, "%.0f:%02.0f h", floor(s / 3600), floor(fmod(s / 60, 60)));
}

static const study_run *largest_reference(const manifest *m) {
  const study_run *run = &m->run[m->reference[0].run[0]];
  for (int i = 1; i < m->nreference; i++)
    if (m->run[m->reference[i].run[0]].work > run->work) run = &m->run[m->reference[i].run[0]];
  return run;
}

/* "DIR/pilot/METHOD", "DIR/pilot/METHOD.txt". */
static char *place(const char *dir, const char *method, const char *ending) {
  char name[64];
  snprintf(name, sizeof name, "pilot/%s%s", method, ending);
  return folder_path(dir, name);
}

static corot_status start(const manifest *m, const execute_options *o, const study_run *run, int i,
                          const char *method) {
  char set[2][96];
  char *dir = place(o->dir, method, ""), *messages = place(o->dir, method, ".txt");
  const char **argv = calloc(2 * (size_t)run->nset + 16, sizeof *argv);
  corot_status status = dir && messages && argv ? COROT_OK : no_memory();
  snprintf(set[0], sizeof set[0], "integrator.method=%s", method);
  snprintf(set[1], sizeof set[1], "time={end: %.17g, output: %.17g}", PART * run->t_end,
           PART * run->t_end);
  if (status == COROT_OK) {
    int n = 0;
    const char *const head[] = {"corot", "run", m->base, "--quiet", "--force", "--output", dir};
    for (int k = 0; k < 7; k++) argv[n++] = head[k];
    for (int k = 0; k < run->nset; k++) argv[n++] = "--set", argv[n++] = run->set[k];
    for (int k = 0; k < 2; k++) argv[n++] = "--set", argv[n++] = set[k];
    argv[n++] = "--set";
    argv[n++] = "output={fields: none, states: none, history: false}";
    argv[n++] = "--set";
    argv[n++] = "quantities={}"; /* their times may lie beyond the piece */
    status = pool_start(i, argv, messages, MOST_S);
  }
  free(argv);
  free(messages);
  free(dir);
  return status;
}

/* Of the whole run, by how far the piece came: infinite where it came nowhere, NaN where it has
   left no word. */
static double read_cost(const char *dir, const char *method, double t_end) {
  char name[64];
  snprintf(name, sizeof name, "pilot/%s/result.json", method);
  char *path = folder_path(dir, name);
  json_t *result = NULL;
  double cost = NAN;
  if (path && json_file_read(path, &result) == COROT_OK) {
    const json_t *cpu = json_object_get(json_object_get(result, "timings"), "cpu");
    double reached = json_number_value(json_object_get(result, "t_reached"));
    if (json_is_number(cpu))
      cost = reached > 0 ? json_number_value(cpu) * t_end / reached : INFINITY;
  }
  json_decref(result);
  free(path);
  return cost;
}

static corot_status run_each(const manifest *m, const execute_options *o, const study_run *run,
                             int n, const char *const *method) {
  int job, ended;
  corot_status status = COROT_OK;
  for (int i = 0; i < n && status == COROT_OK && !pool_signal(); i++) {
    if (pool_is_full()) status = pool_wait(&job, &ended);
    if (status == COROT_OK) status = start(m, o, run, i, method[i]);
  }
  while (status == COROT_OK && !pool_is_empty()) status = pool_wait(&job, &ended);
  return status;
}

corot_status pilot_methods(const manifest *m, const execute_options *o, int n,
                           const char *const *method, double *cost, double *work,
                           int *signal_number) {
  const study_run *run = largest_reference(m);
  char *folder = folder_path(o->dir, "pilot");
  corot_status status = folder ? folder_make(folder) : COROT_ENOMEM;
  free(folder);
  if (status == COROT_OK) status = pool_open(o->njob);
  if (status != COROT_OK) return status;
  status = run_each(m, o, run, n, method);
  *signal_number = pool_signal();
  pool_close();
  for (int i = 0; i < n; i++) cost[i] = read_cost(o->dir, method[i], run->t_end);
  *work = run->work;
  return status;
}
