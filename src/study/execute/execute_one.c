/* One run of a study, from the start of its process to what is booked of it. */
#include "execute_one.h"

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/folder/folder.h"
#include "app/run/run_clock.h"
#include "app/text/no_memory.h"
#include "app/text/say.h"
#include "reached.h"
#include "run_names.h"

enum { LINE_S = 30 }; /* between lines that stay */

/* --- What is left --- */

/* Wall time over work; NaN: not known. */
static double unit_of(const execution *e, bool is_cell) {
  const tally *t = &e->tally[is_cell], *other = &e->tally[!is_cell];
  if (t->work > 0) return t->wall / t->work;
  if (!is_cell && e->o->reference_unit > 0) return e->o->reference_unit;
  return other->work > 0 ? other->wall / other->work : NAN;
}

/* By how far it has come or, as long as that cannot be seen, by its work; NaN: that was too low. */
static double left_of_run(const execution *e, const task *t) {
  double reached = run_reached(e->o->dir, t->run), since = wall_clock() - t->started;
  if (reached > 0.02) return since * (1 - reached) / reached;
  double left = unit_of(e, t->is_cell) * t->run->work - since;
  return left > 0 ? left : NAN;
}

double execution_left(const execution *e) {
  double sum = 0, longest = 0;
  for (int kind = 0; kind < 2; kind++)
    if (e->tally[kind].waiting > 0) sum += unit_of(e, kind == 1) * e->tally[kind].waiting;
  for (int i = 0; i < e->nrunning; i++) {
    double left = left_of_run(e, &e->task[e->running[i]]);
    sum += left; /* NaN stays */
    longest = fmax(longest, left);
  }
  return sum / e->o->njob > longest ? sum / e->o->njob : sum == sum ? longest : NAN;
}

/* --- Progress --- */

void execution_begin(execution *e, const char *what, int due) {
  e->what = what;
  e->due = due;
  e->finished = 0;
  e->shown = wall_clock();
}

/* "; running: NAME 45 %, ...", all too many left out. */
static void show_running(const execution *e) {
  enum { MOST = 4 };
  char name[RUN_NAME];
  for (int i = 0; i < e->nrunning && i < MOST; i++) {
    const task *t = &e->task[e->running[i]];
    double reached = run_reached(e->o->dir, t->run);
    run_name(e->m, (int)(t->run - e->m->run), name);
    fprintf(stderr, "%s%s", i ? ", " : "; running: ", name);
    if (isfinite(reached)) fprintf(stderr, " %.0f %%", floor(100 * reached));
  }
  if (e->nrunning > MOST) fputs(", ...", stderr);
}

static void show_line(const execution *e) {
  double left = execution_left(e);
  fprintf(stderr, "%s: %d of %d", e->what, e->finished, e->due);
  if (e->nfailed > 0) fprintf(stderr, ", %d failed", e->nfailed);
  if (isfinite(left))
    fprintf(stderr, ", %.0f:%02.0f min left", floor(left / 60), floor(fmod(left, 60)));
  if (e->lines) show_running(e);
}

void execution_show(execution *e) {
  if ((!e->progress && !e->lines) || e->finished == e->due) return;
  double now = wall_clock();
  if (now - e->shown < (e->lines ? LINE_S : 0.2)) return;
  e->shown = now;
  if (e->progress) fputs("\r\033[K", stderr);
  show_line(e);
  if (e->lines) fputc('\n', stderr);
  fflush(stderr);
}

void execution_clear(const execution *e) {
  if (e->progress) fputs("\r\033[K", stderr);
}

void execution_tell(execution *e, const task *t, const char *reason) {
  enum { MOST = 8 };
  if (e->ntold >= MOST || e->o->expects_failures) return;
  execution_clear(e);
  say("%s/runs/%s: %s\n", e->o->dir, t->run->id, reason);
  if (++e->ntold == MOST) fputs("(further failures are recorded, but not shown)\n", stderr);
}

/* --- One run --- */

corot_status execution_start(execution *e, int i, const char *folder, const char *more) {
  const study_run *run = e->task[i].run;
  char *dir = store_path(e->o->dir, run, folder);
  char *messages = store_path(e->o->dir, run, "messages.txt");
  const char **argv = calloc(2 * (size_t)run->nset + 13, sizeof *argv);
  corot_status status = dir && messages && argv ? COROT_OK : no_memory();
  if (status == COROT_OK) {
    int n = 0;
    argv[n++] = "corot";
    argv[n++] = e->m->still ? "static" : "run";
    argv[n++] = e->m->base;
    argv[n++] = "--quiet";
    argv[n++] = "--lean";  /* what a cell costs is the cost of its answer */
    argv[n++] = "--force"; /* the folder is the study's, whatever an earlier attempt has left */
    /* an attempt that was cut goes on; one that is timed begins */
    if (!e->m->still && !*folder) argv[n++] = "--resume";
    argv[n++] = "--output";
    argv[n++] = dir;
    for (int k = 0; k < run->nset; k++) {
      argv[n++] = "--set";
      argv[n++] = run->set[k];
    }
    if (more) argv[n++] = "--set", argv[n++] = more;
    status = pool_start(i, argv, messages, e->o->timeout);
  }
  if (status == COROT_OK) {
    e->task[i].started = wall_clock();
    e->running[e->nrunning++] = i;
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

static void add_up(execution *e, const task *t, const json_t *result) {
  const json_t *wall = json_object_get(json_object_get(result, "timings"), "wall");
  tally *sum = &e->tally[t->is_cell];
  if (!json_is_number(wall)) return;
  sum->wall += json_number_value(wall);
  sum->work += t->run->work;
}

/* Books a run that has ended, by what its folder says. */
static corot_status conclude(execution *e, int i, int ended) {
  task *t = &e->task[i];
  /* what it said */
  char *messages = store_path(e->o->dir, t->run, "messages.txt");
  if (!messages) return no_memory();
  char reason[1200];
  read_messages(messages, sizeof reason, reason);
  free(messages);

  /* what its folder says; a run without a result failed, or was lost */
  run_record record;
  COROT_TRY(store_look(e->o->dir, t->run, &record));
  corot_status status = COROT_OK;
  if (record.state == RUN_FAILED) snprintf(reason, sizeof reason, "%s", record.reason);
  if (record.state == RUN_MISSING) {
    explain(ended, e->o->timeout, sizeof reason, reason);
    status = store_fail(e->o->dir, t->run, ended, reason);
    if (!store_failure(ended).retry) record.state = RUN_FAILED;
  }
  /* what that means for the task and the totals */
  t->state = record.state;
  t->lost = record.state == RUN_MISSING;
  t->again = t->lost && ended != 0 && e->nretry < MOST_RETRIES && !pool_signal();
  e->nnew += record.state == RUN_DONE;
  if (record.state == RUN_DONE) add_up(e, t, record.result);
  e->nfailed += record.state == RUN_FAILED;
  if (record.state != RUN_DONE && !pool_signal() && !t->again) execution_tell(e, t, reason);
  run_record_free(&record);
  return status;
}

/* Seldom enough to take less than a hundredth of the time. */
static void tick(execution *e) {
  double now = wall_clock();
  if (!e->o->tick || now - e->ticked < fmax(10, 100 * e->tick_s)) return;
  e->o->tick(e->o->context);
  e->ticked = wall_clock();
  e->tick_s = e->ticked - now;
}

static void stop_running(execution *e, int i) {
  int at = 0;
  while (at < e->nrunning && e->running[at] != i) at++;
  if (at < e->nrunning) e->running[at] = e->running[--e->nrunning];
}

corot_status execution_wait(execution *e) {
  int i = -1, ended;
  while (i < 0) {
    COROT_TRY(pool_wait_for(e->lines ? LINE_S : 1, &i, &ended));
    if (i < 0) execution_show(e);
  }
  stop_running(e, i);
  e->finished++;
  COROT_TRY(conclude(e, i, ended));
  execution_show(e);
  tick(e);
  return COROT_OK;
}
