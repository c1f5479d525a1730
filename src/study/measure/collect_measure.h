/* Trajectories from the folders of runs, measured against each other. */
#ifndef COROT_STUDY_MEASURE_COLLECT_MEASURE_H
#define COROT_STUDY_MEASURE_COLLECT_MEASURE_H

#include "errors.h"
#include "study/execute/builds.h"
#include "study/execute/store.h"

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

#endif
