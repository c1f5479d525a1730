/* Which steps have a row in steps.csv: of a million steps a reader looks at no more than some
   thousands. Steps are numbered from 1.

     1 to 10^4            each
     10^4 to 10^5         each tenth
     10^5 to 10^6         each hundredth, and so on: 9000 rows for each factor of ten
     kinks, restarts of the integrator, failures, refused steps, checkpoints, and the last step
                          always */
#ifndef COROT_APP_RUN_STEPS_KEPT_H
#define COROT_APP_RUN_STEPS_KEPT_H

#include "app/folder/write_csv.h"

enum { THIN_FROM = 10000 };

/* What a table of steps has; all zero to begin with. */
typedef struct steps_count {
  long steps, rows;
  bool all; /* output.steps: all */
} steps_count;

/* Whether step `number` has a row, not counting that it may be the last. */
bool thin_keeps(long number, unsigned events);

/* Writes or reads a step. */
void step_row_exchange(pack *p, step_row *row);

/* The rule in words; static. */
const char *thin_rule(const steps_count *count);

#endif
