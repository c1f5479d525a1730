/* The charts of an equilibrium's report. A figure that has nothing to show is left out. */
#ifndef COROT_REPORT_RUN_STATIC_FIGURES_H
#define COROT_REPORT_RUN_STATIC_FIGURES_H

#include <stdio.h>

#include "report/read/run_folder.h"

/* The load factor over each probe's displacement. */
corot_status static_figures_probes(const run_folder *run, FILE *out);

/* The force of each group's supports over the load factor. */
corot_status static_figures_reactions(const run_folder *run, FILE *out);

/* The residual of each Newton iteration of each load step, and the length of the steps. */
corot_status static_figures_steps(const run_folder *run, FILE *out);

#endif
