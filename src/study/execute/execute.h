/* Carries out what is missing of a study. */
#ifndef COROT_STUDY_EXECUTE_EXECUTE_H
#define COROT_STUDY_EXECUTE_EXECUTE_H

#include "study/plan/manifest.h"

typedef struct execute_options {
  const char *dir;
  const char *command;   /* of the program that makes a run; NULL: run */
  int njob;              /* runs at once */
  int shard, nshard;     /* this one of so many parts of the runs, 1 to nshard */
  bool force;            /* files of others in the folder are replaced */
  bool retry_failed;     /* those that failed before, too */
  double timeout;        /* for each run [s]; 0: none */
  bool progress;         /* a line on stderr, if that is a terminal */
  bool quiet;            /* nothing on stderr but errors */
  bool expects_failures; /* of runs: they are no errors then, and not told */
  bool tells_builds;     /* says on stderr how many runs another build has made, unless quiet */
} execute_options;

/* All of it, on all processors, with progress. */
execute_options execute_defaults(void);

typedef struct execute_totals {
  int nrun;    /* in this shard */
  int ndone;   /* of them, at the end */
  int nfailed; /* for a reason of their own, which is recorded */
  int nlost;   /* stopped from outside, for want of disk or memory, or by a crash: tried again */
  int nnew;    /* of those done: now */
} execute_totals;

/* Runs first, side by side; then, one at a time, timed repetitions of those that belong to cells.
   Ends early, with what it has, when a signal asks for it: see *signal_number (0: none did). */
corot_status execute_study(const manifest *m, const execute_options *o, execute_totals *totals,
                           int *signal_number);

/* Prints what would be run, and where. */
corot_status execute_dry(const manifest *m, const execute_options *o, FILE *out);

#endif
