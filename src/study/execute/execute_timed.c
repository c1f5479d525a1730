/* Repetitions for the clock: alone on the machine, without output that grows with the mesh. */
#include "execute_timed.h"

#include <stdlib.h>

#include "app/text/no_memory.h"
#include "pool.h"
#include "study/plan/json_file.h"

/* Enters the repetition that has just ended; false: it left no times. */
static corot_status enter_times(execution *e, const study_run *run, timings *t, bool *found) {
  char *path = store_path(e->o->dir, run, "timed/result.json");
  if (!path) return no_memory();
  json_t *result = NULL;
  corot_status status = json_file_read(path, &result);
  free(path);
  if (status == COROT_ENOMEM) return status;
  const json_t *times = json_object_get(result, "timings");
  const json_t *c = json_object_get(times, "cpu"), *w = json_object_get(times, "wall");
  *found = json_is_number(c) && json_is_number(w);
  status = COROT_OK;
  if (*found)
    status = timings_add(e->o->dir, run, t, json_number_value(c), json_number_value(w),
                         json_object_get(result, "provenance"));
  json_decref(result);
  return status;
}

static corot_status repeat_once(execution *e, int i, timings *t) {
  int same, ended;
  bool found = false;
  COROT_TRY(execution_start(e, i, "timed", "output={fields: none, states: none}"));
  COROT_TRY(pool_wait(&same, &ended));
  e->nrunning = 0;
  if (ended == 0) COROT_TRY(enter_times(e, e->task[i].run, t, &found));
  if (found) return COROT_OK;
  if (store_is_timeout(ended) || pool_signal()) return COROT_OK;
  return corot_fail(
      COROT_EIO,
      "%s/runs/%s/timed: the repetition for the clock has failed (%d), though the run "
      "was well; the same command tries it again",
      e->o->dir, e->task[i].run->id, ended);
}

/* Every run once, then every run again: what slows the machine for a while is spread over all. */
static corot_status repeat_all(execution *e, timings *all) {
  int due = 0;
  for (int i = 0; i < e->ntask; i++) {
    task *t = &e->task[i];
    t->due = t->is_cell && t->state == RUN_DONE;
    if (!t->due) continue;
    COROT_TRY(timings_read(e->o->dir, t->run, &all[i]));
    due += all[i].n < e->m->repeat ? e->m->repeat - all[i].n : 0;
  }
  execution_begin(e, "timed runs", due);
  for (int k = 0; k < e->m->repeat; k++)
    for (int i = 0; i < e->ntask && !pool_signal(); i++) {
      if (!e->task[i].due || all[i].n > k) continue;
      execution_show(e);
      COROT_TRY(repeat_once(e, i, &all[i]));
      e->finished++;
    }
  return COROT_OK;
}

corot_status execution_time(execution *e) {
  if (e->m->repeat == 0) return COROT_OK;
  timings *all = calloc((size_t)e->ntask + 1, sizeof *all);
  if (!all) return no_memory();
  corot_status status = repeat_all(e, all);
  for (int i = 0; i < e->ntask; i++) timings_free(&all[i]);
  free(all);
  return status;
}
