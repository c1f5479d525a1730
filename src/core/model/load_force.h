#ifndef COROT_CORE_MODEL_LOAD_FORCE_H
#define COROT_CORE_MODEL_LOAD_FORCE_H

#include <corot/ode.h>

#include "core/base/sisters.h"

/* f [n] = the loads on the body displaced by u at t [N], whose power is that of corot_energies:
   with COROT_COUPLING_ONE_WAY those of level 0. A feedback, which may fail, is among them; nothing
   else looks at the velocity v. */
COROT_SISTERS corot_status corot_force_of_loads(const corot_model *model, corot_state *state,
                                                double t, const double *u, const double *v,
                                                double *f);

/* corot_energies.carried alone, at the cost of no tet. */
COROT_SISTERS double corot_carried(const corot_model *model, corot_state *state, double t,
                                   const double *u, const double *v);

#endif
