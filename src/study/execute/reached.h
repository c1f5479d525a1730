/* How far a run has come that is not over. */
#ifndef COROT_STUDY_EXECUTE_REACHED_H
#define COROT_STUDY_EXECUTE_REACHED_H

#include "study/plan/manifest.h"

/* The part of its time that stands in its tables: by the last row of probes.csv, which has a row
   for each output time. NaN: not known. */
double run_reached(const char *dir, const study_run *run);

/* Whether a process is at work in its folder, as far as can be told from outside. */
bool run_is_alive(const char *dir, const study_run *run);

#endif
