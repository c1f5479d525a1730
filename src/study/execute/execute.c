/* Starts what is missing, several at a time, and then what has to be tried again. */
#include "execute.h"

#include <math.h>
#include <stdlib.h>
#include <unistd.h>

#include "app/run/run_clock.h"
#include "app/text/no_memory.h"
#include "builds.h"
#include "execute_one.h"
#include "execute_timed.h"
#include "pilot.h"
#include "pool.h"
#include "run_names.h"

execute_options execute_defaults(void) {
  long processors = sysconf(_SC_NPROCESSORS_ONLN);
  int njob = processors < 1 ? 1 : processors > POOL_MAX ? POOL_MAX : (int)processors;
  return (execute_options){
      .njob = njob, .shard = 1, .nshard = 1, .progress = true, .tells_builds = true};
}

/* --- What there is to do --- */

/* Whether each run belongs to a cell [nrun]; the others are references. */
static bool *find_cells(const manifest *m) {
  bool *is_cell = calloc((size_t)m->nrun + 1, sizeof *is_cell);
  for (int i = 0; is_cell && i < m->ncell; i++) is_cell[m->cell[i].run] = true;
  return is_cell;
}

/* Cells come first: what they cost is known before their errors are, and what is wrong with a study
   shows in them. */
static corot_status list_tasks(execution *e) {
  const manifest *m = e->m;
  bool *is_cell = find_cells(m);
  e->task = calloc((size_t)m->nrun + 1, sizeof *e->task);
  if (!is_cell || !e->task) {
    free(is_cell);
    return no_memory();
  }
  int count = 0;
  for (int others = 0; others < 2; others++)
    for (int i = 0; i < m->nrun; i++)
      if (is_cell[i] == (others == 0) && count++ % e->o->nshard == e->o->shard - 1)
        e->task[e->ntask++] = (task){.run = &m->run[i], .is_cell = is_cell[i]};
  free(is_cell);
  return COROT_OK;
}

/* --- The runs, side by side --- */

static bool is_due(const execution *e, const task *t) {
  return t->state == RUN_MISSING || (t->state == RUN_FAILED && e->o->retry_failed);
}

/* *made_by takes up those of the runs that are done. */
static corot_status look_at_each(execution *e, builds *made_by) {
  for (int i = 0; i < e->ntask; i++) {
    run_record record;
    COROT_TRY(store_verify(e->o->dir, e->task[i].run, &record));
    e->task[i].state = record.state;
    if (record.state == RUN_DONE)
      builds_add(made_by, e->task[i].run, record.result, !e->task[i].is_cell);
    e->task[i].due = is_due(e, &e->task[i]);
    if (record.state == RUN_FAILED && !e->task[i].due) {
      e->nfailed++;
      execution_tell(e, &e->task[i], record.reason);
    }
    run_record_free(&record);
  }
  return COROT_OK;
}

static corot_status look_all(execution *e) {
  builds made_by = builds_begin();
  corot_status status = look_at_each(e, &made_by);
  if (status == COROT_OK && e->o->tells_builds && !e->o->quiet)
    status = builds_tell(e->o->dir, made_by.list);
  builds_free(&made_by);
  return status;
}

static corot_status start(execution *e, int i) {
  task *t = &e->task[i];
  t->due = false;
  e->tally[t->is_cell].waiting -= t->run->work;
  COROT_TRY(store_clear(e->o->dir, t->run));
  COROT_TRY(execution_start(e, i, "", NULL));
  execution_show(e);
  return COROT_OK;
}

static void tell_estimate(const execution *e, const task *pilot) {
  double unit = e->tally[1].wall / e->tally[1].work, reference = e->o->reference_unit;
  double cells = unit * e->tally[1].waiting;
  double others = (reference > 0 ? reference : unit) * e->tally[0].waiting;
  char name[RUN_NAME], time[4][32];
  run_name(e->m, (int)(pilot->run - e->m->run), name);
  describe_duration(e->tally[1].wall, sizeof time[0], time[0]);
  describe_duration(cells, sizeof time[1], time[1]);
  describe_duration(others, sizeof time[2], time[2]);
  describe_duration(execution_left(e), sizeof time[3], time[3]);
  execution_clear(e);
  fprintf(stderr, "pilot: %s took %s; the other cells are about %s of work", name, time[0],
          time[1]);
  if (others > 0) fprintf(stderr, ", their references %s", time[2]);
  fprintf(stderr, ": some %s with %d at once\n", time[3], e->o->njob);
}

/* The cell of the least work goes first, where others follow. */
static corot_status run_pilot(execution *e, int due) {
  int pilot = -1;
  for (int i = 0; i < e->ntask; i++)
    if (e->task[i].due && e->task[i].is_cell &&
        (pilot < 0 || e->task[i].run->work < e->task[pilot].run->work))
      pilot = i;
  if (!e->o->pilot || pilot < 0 || due < 3) return COROT_OK;
  COROT_TRY(start(e, pilot));
  COROT_TRY(execution_wait(e));
  if (e->task[pilot].state == RUN_DONE && !e->o->quiet && !pool_signal())
    tell_estimate(e, &e->task[pilot]);
  return COROT_OK;
}

static corot_status run_all(execution *e) {
  int due = 0;
  for (int i = 0; i < e->ntask; i++) {
    due += e->task[i].due;
    if (e->task[i].due) e->tally[e->task[i].is_cell].waiting += e->task[i].run->work;
  }
  execution_begin(e, "runs", due);
  COROT_TRY(run_pilot(e, due));
  for (int i = 0; i < e->ntask && !pool_signal(); i++) {
    if (!e->task[i].due) continue;
    if (pool_is_full()) COROT_TRY(execution_wait(e));
    if (pool_signal()) break;
    COROT_TRY(start(e, i));
  }
  while (!pool_is_empty()) COROT_TRY(execution_wait(e));
  return COROT_OK;
}

/* What was lost for want of memory or disk is tried again with the machine to itself. */
static corot_status retry_lost(execution *e) {
  while (e->nretry++ < MOST_RETRIES) {
    int due = 0;
    for (int i = 0; i < e->ntask; i++) due += e->task[i].again;
    if (due == 0) break;
    execution_begin(e, "runs once more", due);
    for (int i = 0; i < e->ntask && !pool_signal(); i++) {
      if (!e->task[i].again) continue;
      execution_show(e);
      COROT_TRY(store_clear(e->o->dir, e->task[i].run));
      COROT_TRY(execution_start(e, i, "", NULL));
      COROT_TRY(execution_wait(e));
    }
  }
  return COROT_OK;
}

/* --- All of it --- */

static void add_up(const execution *e, execute_totals *totals) {
  *totals = (execute_totals){.nrun = e->ntask, .nnew = e->nnew};
  for (int i = 0; i < e->ntask; i++) {
    totals->ndone += e->task[i].state == RUN_DONE;
    totals->nfailed += e->task[i].state == RUN_FAILED;
    totals->nlost += e->task[i].lost;
  }
}

static corot_status execute(execution *e) {
  COROT_TRY(list_tasks(e));
  COROT_TRY(look_all(e));
  COROT_TRY(pool_open(e->o->njob));
  corot_status status = run_all(e);
  if (status == COROT_OK) status = retry_lost(e);
  if (status == COROT_OK && !pool_signal()) status = execution_time(e);
  execution_clear(e);
  e->signal_number = pool_signal();
  pool_close();
  return status;
}

corot_status execute_study(const manifest *m, const execute_options *o, execute_totals *totals,
                           int *signal_number) {
  execution e = {.m = m, .o = o, .ticked = wall_clock()};
  e.progress = o->progress && !o->quiet && isatty(STDERR_FILENO);
  e.lines = o->progress && !o->quiet && !e.progress;
  names_link(m, o->dir);
  corot_status status = execute(&e);
  if (status == COROT_OK) {
    add_up(&e, totals);
    *signal_number = e.signal_number;
  }
  free(e.task);
  return status;
}

corot_status execute_dry(const manifest *m, const execute_options *o, FILE *out) {
  static const char *const word[] = {"missing", "done", "failed"};
  execution e = {.m = m, .o = o};
  corot_status status = list_tasks(&e);
  for (int i = 0; i < e.ntask && status == COROT_OK; i++) {
    const task *t = &e.task[i];
    run_record record;
    status = store_look(o->dir, t->run, &record);
    if (status != COROT_OK) break;
    fprintf(out, "%s  %-7s  %-9s", t->run->id, word[record.state],
            t->is_cell ? "cell" : "reference");
    for (int k = 0; k < t->run->nset; k++) fprintf(out, "  %s", t->run->set[k]);
    fputc('\n', out);
    run_record_free(&record);
  }
  free(e.task);
  return status;
}
