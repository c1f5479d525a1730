/* Where a signal turns, but for what is less than a tenth of the way it has gone so far: found as
   the signal goes by, in little memory. */
#ifndef COROT_APP_QUANTITY_TURNING_H
#define COROT_APP_QUANTITY_TURNING_H

#include "core/base/pack.h"

typedef struct turning {
  int direction;           /* 1, -1; 0: it has not moved yet */
  double value, t;         /* the furthest point since the last turn */
  double last, t_last;     /* the last turn, or the start */
  long count;              /* turns */
  double weight, weighted; /* sum of the ways between turns; of these times their durations */
} turning;

/* Of a signal that begins with `value` at t. */
turning turning_begin(double value, double t);

/* Its next point; `span` is from its smallest value so far to its largest. */
void turning_follow(turning *n, double span, double value, double t);

/* Writes or reads all of it. */
void turning_exchange(pack *p, turning *n);

/* The mean time between turns, weighted by how far the signal goes between them; 0: it has gone
   nowhere between turns. */
double turning_mean(const turning *n);

#endif
