/* Why a run is not ok, and whether trying again can help: "failure" in result.json. */
#ifndef COROT_APP_RUN_FAILURE_H
#define COROT_APP_RUN_FAILURE_H

#include <jansson.h>
#include <stdbool.h>

typedef struct run_failure {
  const char *kind; /* "integrator", "scenario", "memory", "io", "interrupted"; a study adds "crash"
                       and "timeout". NULL: it is ok */
  bool retry;       /* whether the same run may end otherwise another time */
} run_failure;

/* {"kind", "retry"}, or null where it is ok; NULL: no memory. */
json_t *run_failure_json(run_failure failure);

#endif
