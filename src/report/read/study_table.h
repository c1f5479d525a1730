/* What a study found: its table.json, checked and taken apart. */
#ifndef COROT_REPORT_READ_STUDY_TABLE_H
#define COROT_REPORT_READ_STUDY_TABLE_H

#include <corot/base.h>
#include <jansson.h>
#include <stdbool.h>

/* Errors below this many times the reference's own are not rated. */
#define STUDY_FLOOR_FACTOR 10.0

typedef enum study_cost {
  STUDY_CPU,  /* [s] */
  STUDY_WALL, /* [s] */
  STUDY_STEPS,
  STUDY_RHS,
  STUDY_FACTORISATIONS,
  STUDY_SOLVES,
  STUDY_COSTS
} study_cost;

/* For each cost its word on the command line and in table.json, and its label with the unit. */
extern const char *const study_cost_word[STUDY_COSTS], *const study_cost_label[STUDY_COSTS];

typedef enum study_status { STUDY_DONE, STUDY_FAILED, STUDY_MISSING } study_status;

/* NAN stands for what is not known. */
typedef struct study_cell {
  const char *id, *reason; /* of a failure; "" else */
  const char *key;         /* what its tolerance is, "integrator.rtol"; "" else */
  int series;
  study_status status;
  double tolerance;
  double cost[STUDY_COSTS], low[STUDY_COSTS], high[STUDY_COSTS]; /* median and extremes */
  const double *error;   /* [nerror] signed where they are against a known value */
  const double *at_most; /* [nerror] what such a one is at most, if it is not rated */
  const bool *unrated;   /* [nerror] too near the reference's own error, or the known value's */
} study_cell;

typedef struct study_table {
  json_t *root; /* owns all text */
  const char *title;
  int nseries, nerror, ncell;
  const char **series, **error_name; /* [nseries], [nerror] */
  double *floor;    /* [nerror] the highest of any reference, or of a known value; NAN: none */
  bool *known;      /* [nerror] against a known value */
  study_cell *cell; /* [ncell] by series, in it by falling tolerance */
  double *errors;   /* what the cells' `error` and `at_most` point into */
  bool *unrated;
  study_cost cost; /* by which the study compares, and the index of its measure of error */
  int measure;
} study_table;

/* Reads DIR/table.json. COROT_EIO: there is none; COROT_EFORMAT: it is not what a study writes. */
corot_status study_table_read(const char *dir, study_table *table);

void study_table_free(study_table *table);

/* Errors of that kind below this are not rated; NAN: all are. */
double study_floor(const study_table *table, int error);

/* Whether the cell has a point in a diagram of that error. */
bool study_cell_rated(const study_cell *cell, int error);

/* What an error's name stands for, with its unit. */
void study_error_label(const char *name, size_t size, char *label);

/* "without a point: 2 failed, 1 missing" of the cells that have none; "" where all have. */
void study_left_out(const study_table *table, int error, size_t size, char *note);

#endif
