/* What the commands that carry out a scenario share: their options. */
#ifndef COROT_APP_COMMAND_COMMAND_SCENARIO_H
#define COROT_APP_COMMAND_COMMAND_SCENARIO_H

#include "app/run/run.h"

/* Writes a folder and returns an exit code; run_scenario is one. */
typedef int scenario_action(const scenario *s, const run_options *options);

/* Without -o, the folder is out/MODELSUFFIX.

   "PROGRAM MODEL.yaml [-o DIR] [--set KEY=VALUE]... [--force] [--quiet]
   [--json]". */
int command_scenario(const char *program, const char *suffix, const char *help, scenario_action *go,
                     int argc, char **argv);

#endif
