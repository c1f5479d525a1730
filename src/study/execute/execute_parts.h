/* Inside of carrying out a study. */
#ifndef COROT_STUDY_EXECUTE_EXECUTE_PARTS_H
#define COROT_STUDY_EXECUTE_EXECUTE_PARTS_H

#include <signal.h>

#include "execute.h"
#include "store.h"

typedef struct task {
  const study_run *run;
  bool is_cell; /* else a reference */
  run_state state;
  bool due;   /* to be run now */
  bool lost;  /* has been run, without a result or a reason of its own */
  bool again; /* lost, and to be run once more now */
} task;

typedef struct execution {
  const manifest *m;
  const execute_options *o;
  int ntask;
  task *task; /* [ntask] the runs of this shard */
  int nnew, nfailed, ntold, nretry;
  int signal_number;
  bool progress;
  const char *what; /* is going on */
  int due, finished;
  double started; /* wall clock [s] */
} execution;

/* A line on the terminal for a phase of so many runs. */
void execution_begin(execution *e, const char *what, int due);
void execution_show(const execution *e);

/* Starts task i, which writes to a folder in that of its run; `more` (or NULL) is a further
   override. */
corot_status execution_start(execution *e, int i, const char *folder, const char *more);

/* The timed repetitions that are missing, one at a time. */
corot_status execution_time(execution *e);

#endif
