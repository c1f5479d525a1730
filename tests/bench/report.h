/* How measurements are shown: a table, or one JSON object a line. */
#ifndef BENCH_REPORT_H
#define BENCH_REPORT_H

#include <jansson.h>

#include "cost.h"
#include "timing.h"

/* Which machine, and how it was measured. */
void report_machine(bool json);

typedef struct row {
  const char *bench;
  const char *strain, *solver; /* either may be NULL */
  int ntet, n;
  timing time; /* of one call */
  cost least;
} row;

/* Seconds that this takes at least, by memory or arithmetic, on this machine now. */
double report_floor(const cost *least);

/* Above a block of rows of one size. */
void report_heading(bool json, int ntet, int n);

/* One row, with the floor measured now at the size of its own data. */
void report_row(bool json, const row *r);

/* After the rows: fails if the time of one lay below its floor. */
corot_status report_check(void);

/* One object on one line, which is given up; NULL stands for lack of memory. */
void report_object(json_t *object);

#endif
