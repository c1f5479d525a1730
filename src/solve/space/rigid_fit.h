/* Displacements less the rigid motion that a part has by itself. */
#ifndef COROT_SOLVE_SPACE_RIGID_FIT_H
#define COROT_SOLVE_SPACE_RIGID_FIT_H

#include "solve/statics/rigid.h"

/* d [nnode], the displacement of all nodes, loses in each part the rigid motion that fits best: of
   a part that is not held that of all its nodes, by their mass; of one that is, where supports
   move, that of the nodes that are held in all components. COROT_ENOMEM. */
corot_status corot_fit_out(const corot_model *model, const corot_rigid *rigid, double (*d)[3]);

#endif
