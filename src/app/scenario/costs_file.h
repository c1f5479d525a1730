/* What linear solvers cost on this machine, as `corot tune` has measured it: costs.json in the
   folder corot of the user's configuration. Every scenario that leaves a solver open is read with
   it. */
#ifndef COROT_APP_SCENARIO_COSTS_FILE_H
#define COROT_APP_SCENARIO_COSTS_FILE_H

#include <corot/solve.h>
#include <stdbool.h>

/* $XDG_CONFIG_HOME/corot/costs.json, or ~/.config/corot/costs.json: the caller's to free. *path
   NULL: the environment names neither folder. COROT_ENOMEM. */
corot_status costs_file_path(char **path);

/* *found: there is such a file; if not, *costs is left alone. COROT_EFORMAT: it is not what
   costs_file_write writes; COROT_EIO. */
corot_status costs_file_read(corot_linear_costs *costs, bool *found);

/* Replaces the file of that path as a whole, in a folder that is made if need be. COROT_EIO. */
corot_status costs_file_write(const char *path, const corot_linear_costs *costs);

#endif
