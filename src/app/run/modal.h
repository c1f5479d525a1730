/* Modes of a scenario's body about rest or an equilibrium, with everything about them written to a
   folder: modes.csv, a frame of the fields for each (write_vtu.h), result.json. */
#ifndef COROT_APP_RUN_MODAL_H
#define COROT_APP_RUN_MODAL_H

#include "run_options.h"

/* As many modes as options->nmode says. Messages and exit codes are those of run_scenario; 4: there
   is no equilibrium, or the search for modes did not converge. */
int modal_scenario(const scenario *s, const run_options *options);

#endif
