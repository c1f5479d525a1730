/* What a run has cost. */
#ifndef COROT_STUDY_MEASURE_COLLECT_COSTS_H
#define COROT_STUDY_MEASURE_COLLECT_COSTS_H

#include "study/execute/builds.h"
#include "study/execute/store.h"

typedef struct costs {
  double cpu, cpu_min, cpu_max, wall, wall_min, wall_max; /* [s] */
  double steps, rhs, factorisations, solves;
  int repeats;
} costs;

/* How large the cost of that name is. */
double cost_named(const costs *c, const char *name);
bool is_cost(const char *name);

/* Reads costs from the result and the timings of a run. */
corot_status costs_read(const char *dir, const study_run *run, const json_t *result,
                        builds *made_by, costs *out);

json_t *costs_json(const costs *c);

#endif
