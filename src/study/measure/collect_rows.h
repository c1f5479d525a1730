/* What is found out about the cells and references of a study: the lines of its table. */
#ifndef COROT_STUDY_MEASURE_COLLECT_ROWS_H
#define COROT_STUDY_MEASURE_COLLECT_ROWS_H

#include "collect_costs.h"
#include "collect_quantities.h"
#include "errors.h"

/* One line of the table. */
typedef struct table_row {
  const study_cell *cell;
  const study_run *run;
  run_state state;
  bool damaged; /* its files are not those that it left */
  char *reason; /* of a failure, or of that */
  char *note;   /* why there are no errors; NULL: none */
  costs cost;
  bool measured;
  errors error;
  drift drift;
  double *quantity;             /* [nquantity] values; NULL: the run is not done */
  quantity_error *off;          /* [nquantity + 1] the last is the total; NULL: it is not done */
  json_t *error_json, *unrated; /* of what is measured, by name */
  json_t *at_most;              /* what errors against known values are at most, if not rated */
  json_t *approximations;       /* that the run makes; NULL: it is not done */
  json_t *warnings;             /* the codes of the run's own, each once: a list */
} table_row;

typedef struct table_reference {
  const study_reference *reference;
  run_state state; /* of both runs */
  char *reason;    /* of a failure */
  char *note;      /* why there is no floor */
  bool known;      /* the floor is */
  errors floor;
  double *quantity;       /* [nquantity] of the first run; NULL: it is not done */
  double *quantity_floor; /* [nquantity] where the floor is known */
  json_t *floor_json;
  json_t *approximations; /* that its runs make; NULL: they are not done */
} table_reference;

/* All of them, by one measure and one cost. */
typedef struct table_rows {
  int n;
  const table_row *row;
  const table_reference *reference;
  int measure; /* a norm (errors.h), or ERROR_PROBES and the number of a quantity, of which the
                  total is the last */
  const char *cost;
  bool still; /* rows are of equilibria */
  bool total; /* errors are those of the mesh, too: but for rows on their reference's mesh */
} table_rows;

/* Whether a row has an error by the measure of the table; and whether that is against a known
   value, and so of all there is, not of what a reference does otherwise. */
bool row_has_error(const table_rows *t, const table_row *r);
bool row_is_of_known(const table_rows *t, const table_row *r);

/* The size of a row's error by the measure of the table, and its floor; of rows that have one. */
double row_error(const table_rows *t, const table_row *r);
double row_floor(const table_rows *t, const table_row *r);

/* Whether it is rated; false where it is not known. */
bool row_is_rated(const table_rows *t, const table_row *r);

#endif
