/* How the runs of a study are carried out. */
#ifndef COROT_STUDY_EXECUTE_EXECUTE_OPTIONS_H
#define COROT_STUDY_EXECUTE_EXECUTE_OPTIONS_H

#include <stdbool.h>

typedef struct execute_options {
  const char *dir;
  int njob;          /* runs at once */
  int shard, nshard; /* this one of so many parts of the runs, 1 to nshard */
  bool force;        /* files of others in the folder are replaced */
  bool retry_failed; /* those that failed before, too */
  double timeout;    /* for each run [s]; 0: none */
  bool progress;     /* on stderr: a line that is written over itself on a terminal, elsewhere one
                        every half minute */
  bool pilot;        /* the cheapest cell first and alone, and an estimate by it, on stderr */
  double reference_unit; /* time over work of a reference, as a pilot has it [s]; 0: not known */
  void (*tick)(void *context); /* called some time after a run has ended, seldom; may be NULL */
  void *context;
  bool quiet;            /* nothing on stderr but errors */
  bool expects_failures; /* of runs: they are no errors then, and not told */
  bool tells_builds;     /* says on stderr how many runs another build has made, unless quiet */
} execute_options;

/* All of it, on all processors, with progress. */
execute_options execute_defaults(void);

#endif
