/* Where a run or a search for an equilibrium writes to, and what it says meanwhile. */
#ifndef COROT_APP_RUN_RUN_OPTIONS_H
#define COROT_APP_RUN_RUN_OPTIONS_H

#include <stdbool.h>

#include "app/scenario/scenario.h"

typedef struct run_options {
  const char *dir; /* made if need be; files of an earlier run in it are replaced */
  bool force;      /* files of others, too, where they have the names of a run's */
  bool progress;   /* a line on stderr while it runs, if that is a terminal */
  bool quiet;      /* nothing on stderr but the reason of a failure */
  bool json;       /* result.json on stdout, too */
  bool lean;       /* leave out what costs time and is only asked for by `auto`: the space error */
} run_options;

#endif
