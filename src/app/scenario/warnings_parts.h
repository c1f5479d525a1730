/* Inside of the warnings. */
#ifndef COROT_APP_SCENARIO_WARNINGS_PARTS_H
#define COROT_APP_SCENARIO_WARNINGS_PARTS_H

#include "warnings.h"

/* Adds INTEGRATOR if a multistep method is to move a body that is free or undamped. */
corot_status warnings_find_integrator(const scenario *s, const corot_model *model, warnings *w);

/* What rounding moves a body by in a step, in its lengths: below, the answers of explicit and
   implicit Runge-Kutta methods for a clamped bar cease to get closer to each other. */
#define LEAST_TOLERANCE 1e-15

/* The absolute tolerance of displacements in use; 0: of a constant step [m]. */
double warnings_atol(const scenario *s, const corot_model *model);

/* Adds RTOL if the tolerance of a step with this largest displacement is below that [m]. */
corot_status warnings_find_rtol(const scenario *s, const corot_model *model, double displacement,
                                warnings *w);

/* Whether no material has any damping. */
bool warnings_undamped(const scenario *s);

#endif
