/* What the mesh does to frequencies: four-node tets are too stiff, and swing too fast. */
#ifndef COROT_APP_RUN_MODES_SPACE_H
#define COROT_APP_RUN_MODES_SPACE_H

#include "app/scenario/warnings.h"

/* A warning where the first mode about rest that is no rigid motion would swing slower on ten-node
   tets by more than 5 %, by one linear solve (corot/space.h): what its inertia displaces there,
   against the mode. Nothing is asked of ten-node tets, of hierarchies, and where
   output.space_error is false. COROT_ENOMEM. */
corot_status modes_space_warn(const scenario *s, const corot_model *model, const corot_modes *modes,
                              warnings *w);

#endif
