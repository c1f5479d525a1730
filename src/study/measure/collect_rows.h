/* What is found out about the cells and references of a study: the lines of its table. */
#ifndef COROT_STUDY_MEASURE_COLLECT_ROWS_H
#define COROT_STUDY_MEASURE_COLLECT_ROWS_H

#include "collect_costs.h"
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
  json_t *error_json, *unrated; /* of what is measured, by name */
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
  json_t *floor_json;
  json_t *approximations; /* that its runs make; NULL: they are not done */
} table_reference;

/* All of them, by one measure and one cost. */
typedef struct table_rows {
  int n;
  const table_row *row;
  const table_reference *reference;
  int measure;
  const char *cost;
  bool still; /* rows are of equilibria */
  bool total; /* errors are those of the mesh, too: but for rows on their reference's mesh */
} table_rows;

#endif
