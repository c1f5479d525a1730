/* The state of an integrator as a part of more. */
#ifndef COROT_APP_RUN_INTEGRATION_H
#define COROT_APP_RUN_INTEGRATION_H

#include <corot/checkpoint.h>

#include "core/base/pack.h"

/* Writes it, which is a new beginning of the integrator, or restores it. Failures as of
   corot_integrator_save and corot_integrator_restore, and p's own. */
corot_status integration_exchange(pack *p, corot_integrator *integrator);

#endif
