/* Evaluates quantities while a run goes on, from what its columns are at the end of each step.

   Between two ends of steps a column is taken for a cubic polynomial (cubic.h): with the slopes
   there, where they are given, else with those of the cubic through the four points about the step,
   of three at either end of a piece. What comes of it is of fourth order in the length of the
   steps, wherever the column is smooth: values at a time, extremes, means, integrals, amplitudes.
   The time of an extreme, and a period, are of third order, of second next to the ends of a piece
   without slopes. Where a row has the time of the row before, or meter_break() says so, the column
   need not go on smoothly: a new piece begins, and no polynomial reaches across.

   No memory but what was taken in the beginning. */
#ifndef COROT_APP_QUANTITY_METER_H
#define COROT_APP_QUANTITY_METER_H

#include "core/base/pack.h"
#include "quantity.h"

typedef struct meter meter;

/* For n resolved quantities, whose texts must outlive it, of a run that is to end at `end` [s]. */
corot_status meter_create(int n, const quantity *q, double end, meter **out);

/* One row: the columns' values at t, which is not before that of the last row; and their
   derivatives by time, NaN for those that are not known, NULL: for none. */
void meter_row(meter *m, double t, const double *value, const double *rate);

/* The columns may bend or jump at the time of the last row. */
void meter_break(meter *m);

/* After the last row. */
void meter_close(meter *m);

int meter_count(const meter *m);

typedef struct quantity_value {
  bool known;
  bool reached; /* the answer goes as far as the window */
  double value;
  double t;      /* when that was, of an extreme or a value at a time [s]; NaN: at no time */
  char why[200]; /* it is not known, a sentence without its point */
} quantity_value;

/* Quantity i, once the meter is closed. */
quantity_value meter_value(const meter *m, int i);

/* Writes or reads what has been seen so far, of a meter of the same quantities. */
void meter_exchange(pack *p, meter *m);

/* Takes NULL. */
void meter_destroy(meter *m);

#endif
