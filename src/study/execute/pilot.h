/* What references would cost by other methods: the beginning of one of them, by each. */
#ifndef COROT_STUDY_EXECUTE_PILOT_H
#define COROT_STUDY_EXECUTE_PILOT_H

#include "execute_options.h"
#include "study/plan/manifest.h"

/* Runs a fiftieth of the time of the reference of most work by each method [n], ten seconds at
   most, side by side in DIR/pilot/METHOD. Stores the CPU time of the whole by each [s], NaN where
   nothing came of it, and that work. *signal_number: 0, or what ended it early. */
corot_status pilot_methods(const manifest *m, const execute_options *o, int n,
                           const char *const *method, double *cost, double *work,
                           int *signal_number);

/* "0.31 s", "2:05 min", "3:10 h"; of NaN "?". */
void describe_duration(double s, size_t size, char *text);

#endif
