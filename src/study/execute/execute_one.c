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
#include "pool.h"

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
  const char **argv = calloc(2 * (size_t)run->nset + 12, sizeof *argv);
  corot_status status = dir && messages && argv ? COROT_OK : no_memory();
  if (status == COROT_OK) {
    int n = 0;
    argv[n++] = "corot";
    argv[n++] = e->o->command ? e->o->command : "run";
    argv[n++] = e->m->base;
    argv[n++] = "--quiet";
    argv[n++] = "--lean";  /* what a cell costs is the cost of its answer */
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
  e->nfailed += record.state == RUN_FAILED;
  if (record.state != RUN_DONE && !pool_signal() && !t->again) execution_tell(e, t, reason);
  run_record_free(&record);
  return status;
}

corot_status execution_wait(execution *e) {
  int i, ended;
  COROT_TRY(pool_wait(&i, &ended));
  e->finished++;
  execution_show(e);
  return conclude(e, i, ended);
}
