/* Charts of a report: the data, which the page's script draws. */
#ifndef COROT_REPORT_PAGE_FIGURE_H
#define COROT_REPORT_PAGE_FIGURE_H

#include <stdbool.h>
#include <stdio.h>

typedef enum figure_style {
  FIGURE_LINE,   /* a line without marks */
  FIGURE_STEPS,  /* each value holds back to the point before */
  FIGURE_POINTS, /* marks without a line */
  FIGURE_MARKED, /* both */
} figure_style;

typedef struct figure_series {
  const char *name;
  figure_style style;
  int n;
  const double *x, *y;     /* [n] */
  const char *const *note; /* [n] shown with a point; NULL: none */
} figure_series;

typedef struct figure {
  const char *id, *title, *caption; /* the caption may be NULL */
  const char *x_label, *y_label;    /* with their units */
  bool x_log, y_log;
  bool time;  /* figures over time are zoomed together */
  bool tall;  /* of more than the usual height */
  bool whole; /* y counts: no ticks between whole numbers */
  int nseries;
  const figure_series *series;
  double floor;           /* NAN: none */
  const double *interval; /* [2] a band between two values of y; NULL: none */
  const char *interval_label;
} figure;

/* Writes HTML with the data in it. Errors are left in the stream. */
void figure_write(const figure *f, FILE *out);

/* The data alone, as JSON. */
void figure_json(const figure *f, FILE *out);

#endif
