/* Where a scenario stops being stable as one of its numbers grows: the interval of held frames, the
   length of a constant step. */
#ifndef COROT_STUDY_MEASURE_LIMIT_H
#define COROT_STUDY_MEASURE_LIMIT_H

#include <corot/base.h>
#include <stdbool.h>

/* One value that was tried. */
typedef struct limit_trial {
  double value;
  bool stable;
  double quantity;  /* by which that was judged; NaN: by none, or it has no value */
  char reason[256]; /* where it is not stable: why */
} limit_trial;

/* Tries the values of some trials [n], and fills in the rest of each. A failure ends the search. */
typedef corot_status limit_try(void *context, int n, limit_trial *trial);

enum { LIMIT_SCAN_MOST = 64, LIMIT_TRIAL_MOST = 128 };

typedef struct limit_def {
  double from, to;  /* 0 < from < to */
  int nscan;        /* values tried first, in equal ratios from `from` to `to`; 2 to
                       LIMIT_SCAN_MOST */
  double precision; /* the limit is known when `unstable` / `stable` - 1 is at most this; > 0 */
} limit_def;

typedef struct limit_result {
  int ntrial;
  limit_trial trial[LIMIT_TRIAL_MOST]; /* by value */
  double stable;   /* the largest value below which all that were tried are stable; 0: none */
  double unstable; /* the smallest that is not; INFINITY: all are stable */
  int nreturn;     /* stable values above an unstable one: the limit is not the only one */
} limit_result;

/* Scans the range, then bisects (in ratios) between the first unstable value and the one below it.
   COROT_EINVAL: a definition without sense. */
corot_status limit_find(const limit_def *def, limit_try *try, void *context, limit_result *result);

#endif
