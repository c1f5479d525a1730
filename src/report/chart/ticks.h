/* Where an axis has its ticks, and what stands beside them. */
#ifndef COROT_REPORT_CHART_TICKS_H
#define COROT_REPORT_CHART_TICKS_H

#include <stdbool.h>

enum { TICKS_MAX = 96 };

typedef struct tick {
  double at;
  char label[24]; /* what follows a '^' is raised; empty: a minor tick */
} tick;

/* The range of an axis: finite, low < high, and on a logarithmic one both positive. */
typedef struct axis_range {
  double low, high;
  bool log;
} axis_range;

/* The range that holds the finite numbers of x [n], on a logarithmic axis those above zero, and a
   little more on either side; something of use where there are no such numbers, or only one. */
axis_range axis_range_of(int n, const double *x, bool log);

/* Whether a number has a place on such an axis at all. */
bool axis_takes(bool log, double x);

/* 0 at the low end, 1 at the high end. */
double axis_place(const axis_range *range, double x);

/* Linear: multiples of 1, 2 or 5 times a power of ten, at most `most` (>= 2) of them labelled.
   Logarithmic: decades, all or every 2nd, 3rd, ... of them labelled, and between them minor ticks
   at 2 to 9, or at the other decades; within one decade 1, 2 and 5 are labelled; ranges too narrow
   for that have linear ticks. Returns how many, ascending. */
int axis_ticks(const axis_range *range, int most, tick ticks[TICKS_MAX]);

#endif
