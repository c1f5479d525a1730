/* Charts as SVG files: lines with markers on linear or logarithmic axes, for print and for dark
   screens. Text stays text. Series are told apart by marker and dashes as well as by colour. */
#ifndef COROT_REPORT_CHART_CHART_H
#define COROT_REPORT_CHART_CHART_H

#include <stdbool.h>
#include <stdio.h>

typedef struct chart_axis {
  const char *label; /* with its unit */
  bool log;
} chart_axis;

typedef struct chart_series {
  const char *name;
  int npoint;
  const double *x, *y;          /* [npoint], joined in this order */
  const double *x_low, *x_high; /* [npoint] ends of the bar at each point; NULL: no bars */
} chart_series;

typedef struct chart {
  const char *title, *note; /* the note stands under the title; either may be NULL */
  chart_axis x, y;
  int nseries;
  const chart_series *series;
  double floor; /* the band up to this y says: no point in here means anything;
                   NAN: none */
  const char *floor_label;
} chart;

/* Points that have no place on the axes: not finite, or not positive where the axis is
   logarithmic. They are left out, the line is broken there, and the chart says how many. */
int chart_skipped(const chart *c);

/* Stands at the beginning of what chart_write() writes, to know it by. */
#define CHART_MARK "<!-- written by corot -->"

/* Writes the SVG. Errors are left in the stream. */
void chart_write(const chart *c, FILE *out);

#endif
