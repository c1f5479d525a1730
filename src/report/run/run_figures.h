/* The charts of a run: probes, steps, energies, forces compared. */
#ifndef COROT_REPORT_RUN_RUN_FIGURES_H
#define COROT_REPORT_RUN_RUN_FIGURES_H

#include <stdio.h>

#include "report/read/run_folder.h"

/* Each writes what there is; nothing where there is nothing. */
corot_status run_figures_probes(const run_folder *run, FILE *out);

/* Those of them that are no displacements, over time or load factor. */
corot_status run_figures_quantities(const run_folder *run, FILE *out);
corot_status run_figures_steps(const run_folder *run, FILE *out);
corot_status run_figures_energy(const run_folder *run, FILE *out);
corot_status run_figures_compare(const run_folder *run, FILE *out);

#endif
