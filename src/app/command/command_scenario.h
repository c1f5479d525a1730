/* What the commands that carry out a scenario share: their options. */
#ifndef COROT_APP_COMMAND_COMMAND_SCENARIO_H
#define COROT_APP_COMMAND_COMMAND_SCENARIO_H

#include <getopt.h>

#include "app/run/run.h"

/* Writes a folder and returns an exit code; run_scenario is one. */
typedef int scenario_action(const scenario *s, const run_options *options);

/* A command with more options than those of command_scenario. */
typedef struct scenario_command {
  const char *program, *suffix, *help;
  scenario_action *go;
  const char *letters;       /* getopt's string of short options */
  int nmore;                 /* at most MOST_MORE */
  const struct option *more; /* [nmore], each with a letter for its answer */
  /* Puts the value of one of these into the options: -1, or the exit code of a usage error. */
  int (*take)(const char *program, int answer, const char *value, run_options *o);
} scenario_command;

enum { MOST_MORE = 4 };

int command_scenario_with(const scenario_command *command, run_options options, int argc,
                          char **argv);

/* Without -o, the folder is out/MODELSUFFIX.

   "PROGRAM MODEL.yaml [-o DIR] [--set KEY=VALUE]... [--force] [--quiet]
   [--json] [--lean]". */
int command_scenario(const char *program, const char *suffix, const char *help, scenario_action *go,
                     int argc, char **argv);

#endif
