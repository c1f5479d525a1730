/* result.json of modes. Beside what it has in common with that of a run:

     t_reached   the time that supports and loads are of [s]
     modes       {about: "rest" | "equilibrium", t, count, rigid, zero_below [1/s^2], shift [1/s^2],
                 asymmetry, linear_solver, list: [{mode, frequency [Hz], growth [1/s],
                 eigenvalue [1/s^2], effective_mass [kg], residual}, ...]}: see corot/modes.h; null
                 where there are none */
#ifndef COROT_APP_RUN_RESULT_MODES_H
#define COROT_APP_RUN_RESULT_MODES_H

#include "result.h"

typedef struct modes_summary {
  const char *status, *reason; /* as in run_summary */
  int exit_code;
  run_failure failure;
  const corot_model *model;
  const corot_modes *modes;
  const char *about;                                      /* "rest", "equilibrium" */
  double t;                                               /* [s] */
  double setup_s, equilibrium_s, output_s, wall_s, cpu_s; /* [s] */
  hashes hashes;
  const warnings *warnings;
} modes_summary;

/* The caller's to json_decref. */
corot_status result_modes_make(const scenario *s, const modes_summary *run, json_t **out);

#endif
