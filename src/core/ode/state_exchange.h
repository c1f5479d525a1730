/* What a state knows beyond its evaluations, as bytes. */
#ifndef COROT_CORE_ODE_STATE_EXCHANGE_H
#define COROT_CORE_ODE_STATE_EXCHANGE_H

#include <corot/ode.h>

#include "core/base/pack.h"

/* Writes or reads: held and extrapolated frames and when they were found, the side of kinks,
   whether it stands still and under which loads, and what its inputs say (corot_inputs_exchange). A
   reader needs a state of a model of the same identity (core/model/identity.h), with inputs where
   the writer's had some; where it fails, the state may have changed in part. */
COROT_SISTERS void corot_state_exchange(pack *p, corot_state *state);

#endif
