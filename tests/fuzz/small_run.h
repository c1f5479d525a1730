/* A run of one tet, and its equilibrium, with every file that a run can leave. */
#ifndef FUZZ_SMALL_RUN_H
#define FUZZ_SMALL_RUN_H

#include <stdbool.h>

/* Writes the mesh to the scratch folder: call this once, before the following. */
void small_mesh(void);

/* Runs it (`still`: finds its equilibrium) in SCRATCH/NAME. Its result.json then lists no files, so
   that files may be replaced, and has `hash` for that of the run unless it is NULL. */
void small_run(const char *name, const char *method, bool still, const char *hash);

#endif
