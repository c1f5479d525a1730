/* result.json of a run that ended before, or without, its books: no statistics, probes, energies.
 */
#ifndef COROT_APP_RUN_RESULT_BRIEF_H
#define COROT_APP_RUN_RESULT_BRIEF_H

#include "app/scenario/warnings.h"
#include "result.h"

typedef struct brief_result {
  const char *status, *reason;
  int exit_code;
  run_failure failure;
  double t_reached;         /* [s] */
  const warnings *warnings; /* NULL: none */
} brief_result;

/* The text of it; the caller's to free. Without a scenario (NULL), what it says is null. */
corot_status result_brief(const scenario *s, const brief_result *what, char **text);

/* The text for stop_prepare(). */
corot_status result_for_stop(const scenario *s, char **text);

#endif
