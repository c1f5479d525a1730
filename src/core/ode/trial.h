/* Evaluations at states that an iteration tries: they may overflow, which is a reason for a shorter
   step. corot_residual() and corot_rhs() refuse them as the caller's mistake. */
#ifndef COROT_CORE_ODE_TRIAL_H
#define COROT_CORE_ODE_TRIAL_H

#include <corot/ode.h>

#include "core/base/sisters.h"

/* As corot_residual() and corot_rhs(), but COROT_RETRY for what is not a number. */
COROT_SISTERS corot_status corot_residual_trial(const corot_model *model, corot_state *state,
                                                double t, const double *u, const double *v,
                                                double *r);
COROT_SISTERS corot_status corot_rhs_trial(const corot_model *model, corot_state *state, double t,
                                           const double *y, double *ydot);

#endif
