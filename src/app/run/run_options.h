/* Where a run or a search for an equilibrium writes to, and what it says meanwhile. */
#ifndef COROT_APP_RUN_RUN_OPTIONS_H
#define COROT_APP_RUN_RUN_OPTIONS_H

#include <stdbool.h>

#include "app/scenario/scenario.h"

/* What modes are about: where a run starts; rest; or the equilibrium of corot static. */
typedef enum modes_about {
  MODES_ABOUT_START,
  MODES_ABOUT_REST,
  MODES_ABOUT_EQUILIBRIUM
} modes_about;

typedef struct run_options {
  const char *dir; /* made if need be; files of an earlier run in it are replaced */
  bool force;      /* files of others, too, where they have the names of a run's */
  bool resume;     /* go on from a checkpoint there, if there is one; of runs alone */
  bool progress;   /* a line on stderr while it runs, if that is a terminal */
  bool quiet;      /* nothing on stderr but the reason of a failure */
  bool json;       /* result.json on stdout, too */
  int nmode;       /* of corot modes */
  modes_about about;
  bool lean; /* leave out what costs time and is only asked for by `auto`: the space error */
} run_options;

#endif
