/* Starts what is missing, several at a time, and books what becomes of it. */
#include "execute.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/folder/folder.h"
#include "app/run/run_clock.h"
#include "app/text/no_memory.h"
#include "app/text/say.h"
#include "execute_parts.h"
#include "pool.h"
#include "study/measure/builds.h"
#include "study/plan/json_file.h"

execute_options execute_defaults(void) {
  long processors = sysconf(_SC_NPROCESSORS_ONLN);
  int njob = processors < 1 ? 1 : processors > POOL_MAX ? POOL_MAX : (int)processors;
  return (execute_options){
      .njob = njob, .shard = 1, .nshard = 1, .progress = true, .tells_builds = true};
}

enum { MOST_RETRIES = 2 }; /* of one run, before the next call of the program */

/* --- What there is to do --- */

/* Whether each run belongs to a cell [nrun]; the others are references. */
static bool *find_cells(const manifest *m) {
  bool *is_cell = calloc((size_t)m->nrun + 1, sizeof *is_cell);
  for (int i = 0; is_cell && i < m->ncell; i++) is_cell[m->cell[i].run] = true;
  return is_cell;
}

/* References come first, as they take longest. */
static corot_status list_tasks(execution *e) {
  const manifest *m = e->m;
  bool *is_cell = find_cells(m);
  e->task = calloc((size_t)m->nrun + 1, sizeof *e->task);
  if (!is_cell || !e->task) {
    free(is_cell);
    return no_memory();
  }
  int count = 0;
  for (int cells = 0; cells < 2; cells++)
    for (int i = 0; i < m->nrun; i++)
      if (is_cell[i] == (cells == 1) && count++ % e->o->nshard == e->o->shard - 1)
        e->task[e->ntask++] = (task){.run = &m->run[i], .is_cell = is_cell[i]};
  free(is_cell);
  return COROT_OK;
}

/* --- Progress --- */

void execution_begin(execution *e, const char *what, int due) {
  e->what = what;
  e->due = due;
  e->finished = 0;
  e->started = wall_clock();
}

void execution_show(const execution *e) {
  if (!e->progress) return;
  fprintf(stderr, "\r\033[K%s: %d of %d", e->what, e->finished, e->due);
  if (e->nfailed > 0) fprintf(stderr, ", %d failed", e->nfailed);
  if (e->finished > 0) {
    double left = (wall_clock() - e->started) * (e->due - e->finished) / e->finished;
    fprintf(stderr, ", %.0f:%02.0f min left", floor(left / 60), floor(fmod(left, 60)));
  }
  fflush(stderr);
}

static void clear_progress(const execution *e) {
  if (e->progress) fputs("\r\033[K", stderr);
}

/* A failure in words, but for all too many. */
static void tell_failure(execution *e, const task *t, const char *reason) {
  enum { MOST = 8 };
  if (e->ntold >= MOST || e->o->expects_failures) return;
  clear_progress(e);
  say("%s/runs/%s: %s\n", e->o->dir, t->run->id, reason);
  if (++e->ntold == MOST) fputs("(further failures are recorded, but not shown)\n", stderr);
}

/* --- One run --- */

corot_status execution_start(execution *e, int i, const char *folder, const char *more) {
  const study_run *run = e->task[i].run;
  char *dir = store_path(e->o->dir, run, folder);
  char *messages = store_path(e->o->dir, run, "messages.txt");
  const char **argv = calloc(2 * (size_t)run->nset + 11, sizeof *argv);
  corot_status status = dir && messages && argv ? COROT_OK : no_memory();
  if (status == COROT_OK) {
    int n = 0;
    argv[n++] = "corot";
    argv[n++] = e->o->command ? e->o->command : "run";
    argv[n++] = e->m->base;
    argv[n++] = "--quiet";
    argv[n++] = "--force"; /* the folder is the study's, whatever an earlier attempt has left */
    argv[n++] = "--output";
    argv[n++] = dir;
    for (int k = 0; k < run->nset; k++) {
      argv[n++] = "--set";
      argv[n++] = run->set[k];
    }
    if (more) argv[n++] = "--set", argv[n++] = more;
    status = pool_start(i, argv, messages, e->o->timeout);
  }
  free(argv);
  free(messages);
  free(dir);
  return status;
}

/* The beginning of what a run said, without the last line break; the file is gone if it said
   nothing. */
static void read_messages(const char *path, size_t size, char *text) {
  text[0] = '\0';
  FILE *file = file_check_regular(path) == COROT_OK ? fopen(path, "re") : NULL;
  if (!file) return;
  size_t length = fread(text, 1, size - 1, file);
  fclose(file);
  while (length > 0 && text[length - 1] == '\n') length--;
  text[length] = '\0';
  if (length == 0) unlink(path);
}

/* Why a run has left no result. */
static void explain(int ended, double timeout, size_t size, char *reason) {
  char said[1024];
  snprintf(said, sizeof said, "%.*s", (int)sizeof said - 1, reason);
  if (abs(ended) % 128 == SIGXCPU && store_is_timeout(ended))
    snprintf(reason, size, "it has used up its limit of CPU time");
  else if (store_is_timeout(ended))
    snprintf(reason, size, "not over after the %g s that each run has", timeout);
  else if (ended < 0)
    snprintf(reason, size, "killed by signal %d (%s)%s%s", -ended, strsignal(-ended),
             *said ? ": " : "", said);
  else if (ended == 0)
    snprintf(reason, size,
             "its result is not that of the run that was asked for: have scenario "
             "or mesh changed since the study began?");
  else if (!*said)
    snprintf(reason, size, "exit code %d", ended);
}

/* Books a run that has ended, by what its folder says. */
static corot_status conclude(execution *e, int i, int ended) {
  task *t = &e->task[i];
  char *messages = store_path(e->o->dir, t->run, "messages.txt");
  if (!messages) return no_memory();
  char reason[1200];
  read_messages(messages, sizeof reason, reason);
  free(messages);

  run_record record;
  COROT_TRY(store_look(e->o->dir, t->run, &record));
  corot_status status = COROT_OK;
  if (record.state == RUN_FAILED) snprintf(reason, sizeof reason, "%s", record.reason);
  if (record.state == RUN_MISSING) {
    explain(ended, e->o->timeout, sizeof reason, reason);
    status = store_fail(e->o->dir, t->run, ended, reason);
    if (!store_failure(ended).retry) record.state = RUN_FAILED;
  }
  t->state = record.state;
  t->lost = record.state == RUN_MISSING;
  t->again = t->lost && ended != 0 && e->nretry < MOST_RETRIES && !pool_signal();
  e->nnew += record.state == RUN_DONE;
  e->nfailed += record.state == RUN_FAILED;
  if (record.state != RUN_DONE && !pool_signal() && !t->again) tell_failure(e, t, reason);
  run_record_free(&record);
  return status;
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
      tell_failure(e, &e->task[i], record.reason);
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

static corot_status wait_one(execution *e) {
  int i, ended;
  COROT_TRY(pool_wait(&i, &ended));
  e->finished++;
  execution_show(e);
  return conclude(e, i, ended);
}

static corot_status run_all(execution *e) {
  int due = 0;
  for (int i = 0; i < e->ntask; i++) due += e->task[i].due;
  execution_begin(e, "runs", due);
  for (int i = 0; i < e->ntask && !pool_signal(); i++) {
    if (!e->task[i].due) continue;
    if (pool_is_full()) COROT_TRY(wait_one(e));
    if (pool_signal()) break;
    COROT_TRY(store_clear(e->o->dir, e->task[i].run));
    COROT_TRY(execution_start(e, i, "", NULL));
    execution_show(e);
  }
  while (!pool_is_empty()) COROT_TRY(wait_one(e));
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
      COROT_TRY(wait_one(e));
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
  clear_progress(e);
  e->signal_number = pool_signal();
  pool_close();
  return status;
}

corot_status execute_study(const manifest *m, const execute_options *o, execute_totals *totals,
                           int *signal_number) {
  execution e = {.m = m, .o = o};
  e.progress = o->progress && !o->quiet && isatty(STDERR_FILENO);
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
