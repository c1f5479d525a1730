/* Statics: the equilibrium of a scenario under its full loads, with everything about it written to
   the folder that a run would leave. */
#ifndef COROT_APP_RUN_STATIC_H
#define COROT_APP_RUN_STATIC_H

#include "run_options.h"

/* The loads are those of time.end; the time of a row is the load factor times time.end, where the
   supports stand. external_work in energy.csv is by the trapezoidal rule over the load steps, so
   balance says how coarse these are. Files, messages and exit codes are those of run_scenario; 3
   also if nothing holds the body; 4: there is no equilibrium within reach, or it is unstable. */
int static_scenario(const scenario *s, const run_options *options);

/* u [n] = the equilibrium under the loads as they are at t, also if it is unstable, where the path
   of the load leads to one. Failures as of corot_statics_create and corot_statics_step. */
corot_status static_find(const scenario *s, const corot_refinement *refinement,
                         const corot_model *model, double t, double *u);

/* u [n] = the equilibrium under the loads as they are at t = 0, where a run begins if the scenario
   says `start: equilibrium`. Mesh, refinement and model are
   those of scenario_build. COROT_EINTEGRATE, COROT_ESINGULAR: there is none. */
corot_status static_start(const scenario *s, const corot_refinement *refinement,
                          const corot_model *model, double *u);

#endif
