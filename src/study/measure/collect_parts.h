/* Inside of collecting a study. */
#ifndef COROT_STUDY_MEASURE_COLLECT_PARTS_H
#define COROT_STUDY_MEASURE_COLLECT_PARTS_H

#include "builds.h"
#include "collect.h"
#include "errors.h"
#include "study/execute/store.h"

typedef struct costs {
  double cpu, cpu_min, cpu_max, wall, wall_min, wall_max; /* [s] */
  double steps, rhs, factorisations, solves;
  int repeats;
} costs;

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

/* Errors by name: an object. */
json_t *errors_json(const yardstick *y, const errors *e);

/* The names of those that are not rated: a list. */
json_t *errors_unrated(const yardstick *y, const errors *e, const errors *floor);

/* How large the cost of that name is. */
double cost_named(const costs *c, const char *name);
bool is_cost(const char *name);

/* Reads costs from the result and the timings of a run. */
corot_status costs_read(const char *dir, const study_run *run, const json_t *result,
                        builds *made_by, costs *out);

json_t *costs_json(const costs *c);

/* The measure of that name; -1: there is none. */
int measure_named(const char *name);

/* Fits and rankings of rows [n], as lists. NULL: no memory. */
typedef struct table_rows {
  int n;
  const table_row *row;
  const table_reference *reference;
  int measure;
  const char *cost;
} table_rows;

/* The approximations that a run makes beside that of time, a list of words by kind: "" none of that
   kind. The caller's. */
json_t *approximations_of(const json_t *result);

/* Those that a row has in common with its reference, in words; and a sentence for all rows. */
json_t *cell_shared(const table_rows *t, const table_row *r);
json_t *table_shared(const table_rows *t);

json_t *collect_fits(const table_rows *t);
json_t *collect_rankings(const table_rows *t);

/* What trajectories are measured with: the last of each is kept for the next. */
typedef struct measuring {
  const manifest *m;
  const char *dir;
  bool looked;  /* the runs' files have been verified already */
  int ndamaged; /* runs whose files are not those that they left */
  yardstick *yardstick;
  scenario *scenario; /* the yardstick's */
  char *key;          /* what the yardstick depends on */
  int reference;      /* whose trajectory is kept; -1: none's */
  trajectory kept;
  builds builds; /* of the runs that are done */
} measuring;

/* The errors of a run that is done against another. COROT_EINVAL, COROT_EFORMAT, COROT_EIO: there
   are none, and the message says why. */
corot_status measure_run(measuring *g, const study_run *run, const json_t *result, int reference,
                         errors *e, drift *d);

/* Makes the yardstick that of a reference, and reads the states of its first run. */
corot_status measure_hold(measuring *g, int reference);
corot_status measure_states(measuring *g, int reference, trajectory *out);

/* What there is of a run, verified once. */
corot_status measure_look(measuring *g, const study_run *run, run_record *record);

void measuring_free(measuring *g);

/* What references of neighbouring mesh.refine say of the meshes: a list, the caller's. */
corot_status collect_space(measuring *g, const table_reference *reference, json_t **out);

#endif
