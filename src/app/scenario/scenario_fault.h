/* What the core refuses, told with its place in the scenario and in the scenario's words. */
#ifndef COROT_APP_SCENARIO_SCENARIO_FAULT_H
#define COROT_APP_SCENARIO_SCENARIO_FAULT_H

#include "scenario.h"

/* The status of a call that was given the scenario's definitions; where it is COROT_EINVAL, or any
   other that is about what they say, COROT_EFORMAT with a message of the place instead. Call this
   right after it. With the mesh (else NULL) names of groups are suggested. */
corot_status scenario_told(const scenario *s, const corot_mesh *mesh, corot_status status);

/* COROT_EFORMAT: no such group, or which may have been meant. */
corot_status scenario_unknown_group(const struct config_node *node, const corot_mesh *mesh);

/* The same where groups are made, of which more may follow. */
corot_status scenario_unknown_other(const scenario *s, const struct config_node *node,
                                    const corot_mesh *mesh);

#endif
