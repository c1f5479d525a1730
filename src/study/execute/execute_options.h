/* How the runs of a study are carried out. */
#ifndef COROT_STUDY_EXECUTE_EXECUTE_OPTIONS_H
#define COROT_STUDY_EXECUTE_EXECUTE_OPTIONS_H

#include <stdbool.h>

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

#endif
