/* Carries out one run of a study: starts its process, books what becomes of it, and shows how far
   all of them have got. */
#ifndef COROT_STUDY_EXECUTE_EXECUTE_ONE_H
#define COROT_STUDY_EXECUTE_EXECUTE_ONE_H

#include "execute_options.h"
#include "pool.h"
#include "store.h"
#include "study/plan/manifest.h"

enum { MOST_RETRIES = 2 }; /* of one run, before the next call of the program */

typedef struct task {
  const study_run *run;
  bool is_cell; /* else a reference */
  run_state state;
  bool due;       /* to be run now */
  bool lost;      /* has been run, without a result or a reason of its own */
  bool again;     /* lost, and to be run once more now */
  double started; /* wall clock [s] */
} task;

/* Of cells, or of references: runs that are over, and work that waits. */
typedef struct tally {
  double wall, work; /* [s] of those done */
  double waiting;    /* work of those due that have not begun */
} tally;

typedef struct execution {
  const manifest *m;
  const execute_options *o;
  int ntask;
  task *task; /* [ntask] the runs of this shard */
  int nnew, nfailed, ntold, nretry;
  int signal_number;
  bool progress, lines; /* on a terminal; elsewhere */
  const char *what;     /* is going on */
  int due, finished;
  double shown, ticked, tick_s; /* wall clock [s]; how long that took */
  tally tally[2];               /* of references, of cells */
  int nrunning, running[POOL_MAX];
} execution;

/* A line that says how far a phase of so many runs is, at once on a terminal, and elsewhere when it
   is time. */
void execution_begin(execution *e, const char *what, int due);
void execution_show(execution *e);
void execution_clear(const execution *e); /* takes the line away */

/* How long what is due will take, by what runs have cost so far [s]; NaN: nothing is known. */
double execution_left(const execution *e);

/* Tells stderr why a run has failed, unless failures are expected or all too many. */
void execution_tell(execution *e, const task *t, const char *reason);

/* Starts task i, which writes to a folder in that of its run; `more` (or NULL) is a further
   override. */
corot_status execution_start(execution *e, int i, const char *folder, const char *more);

/* Waits for the next of the runs that have been started, and books it by what its folder says. */
corot_status execution_wait(execution *e);

#endif
