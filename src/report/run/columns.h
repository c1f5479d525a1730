/* The columns of a run's table that one figure shows. */
#ifndef COROT_REPORT_RUN_COLUMNS_H
#define COROT_REPORT_RUN_COLUMNS_H

#include "report/page/figure.h"
#include "report/read/run_folder.h"

enum { COLUMNS_MOST = 16 };

typedef struct columns {
  const csv *table;
  double *t, *y[COLUMNS_MOST]; /* [table->nrow] */
  figure_series series[COLUMNS_MOST];
  int n;
} columns;

/* Reads t; of statics, the load factor in its place. */
corot_status columns_begin(const run_folder *run, const csv *table, columns *c);

/* Adds a column over t under another name, if there is such a column. */
corot_status columns_add(columns *c, int column, const char *name, figure_style style);

/* Takes back the column added last where there is nothing to see in it. */
void columns_drop_if_zero(columns *c);

/* The unit of a column "PROBE.COMPONENT" as result.json tells it; "": it does not. */
const char *columns_unit(const run_folder *run, const char *name);

/* The first column from `from` on whose name ends in `ending`, as ".ux", and which has two more
   behind it; -1: there is none. */
int columns_find_triple(const csv *table, const char *ending, int from);

/* Writes `f` with these series, if reading them went well, as `status` says, and there are any;
   hands on the status. Over t, unless f has a label of x. */
corot_status columns_write(const run_folder *run, figure f, const columns *c, corot_status status,
                           FILE *out);

void columns_free(columns *c);

#endif
