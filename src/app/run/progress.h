/* A line on the terminal that says how far a run has come. */
#ifndef COROT_APP_RUN_PROGRESS_H
#define COROT_APP_RUN_PROGRESS_H

#include <corot/integrate.h>

typedef struct progress {
  bool on;
  double from, end;      /* where it began, or went on; its end [s] */
  double started, shown; /* wall clock [s] */
} progress;

/* Shows nothing unless it is `wanted` and stderr is a terminal. */
progress progress_start(bool wanted, double end);

/* At most five times a second. */
void progress_show(progress *p, const corot_step *step);

/* Takes the line away. */
void progress_clear(progress *p);

#endif
