/* Carries out what is missing of a study. */
#ifndef COROT_STUDY_EXECUTE_EXECUTE_H
#define COROT_STUDY_EXECUTE_EXECUTE_H

#include "execute_options.h"
#include "study/plan/manifest.h"

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
