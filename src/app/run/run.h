/* A run: a scenario integrated from 0 to its end, and everything about it written to a folder. */
#ifndef COROT_APP_RUN_RUN_H
#define COROT_APP_RUN_RUN_H

#include "app/scenario/scenario.h"

typedef struct run_options {
  const char *dir; /* made if need be; files of an earlier run in it are replaced */
  bool force;      /* files of others, too, where they have the names of a run's */
  bool progress;   /* a line on stderr while it runs, if that is a terminal */
  bool quiet;      /* nothing on stderr but the reason of a failure */
  bool json;       /* result.json on stdout, too */
} run_options;

/* Runs the scenario and writes its files: probes.csv, energy.csv, history.csv, steps.csv,
   compare.csv (write_csv.h), states.bin (states.h), fields (write_vtu.h) and result.json. Messages
   go to stderr. A run that fails or is interrupted writes what it had, up to the time it reached.

   The answer is the exit code of the program: 0 ok; 3 bad scenario or mesh; 4 the integrator gave
   up; 5 the system refused memory, reading or writing, or the folder is another's
   (folder_owner.h); 128 + signal: interrupted. */
int run_scenario(const scenario *s, const run_options *options);

/* Asks the run to stop after the step it is in. For a signal handler: it is safe there. A request
   made before the run begins counts; the run that heeds it forgets it. */
void run_interrupt(int signal_number);

#endif
