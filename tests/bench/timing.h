/* Repeated measurement of one piece of work. */
#ifndef BENCH_TIMING_H
#define BENCH_TIMING_H

#include <corot/base.h>

/* Seconds a call, of process CPU time: what other programs do meanwhile counts for little. */
typedef struct timing {
  double median, min;
  double spread; /* distance of the quartiles */
} timing;

typedef corot_status piece_of_work(void *data);

/* Calls `work` in batches of at least 0.2 ms, until 40 batches or half a second are spent, but 3
   batches at least where that does not take two seconds; one more, to warm up, does not count. */
corot_status timing_of(piece_of_work *work, void *data, timing *out);

/* Sorts `sample` [n]. */
timing timing_summary(int n, double *sample);

#endif
