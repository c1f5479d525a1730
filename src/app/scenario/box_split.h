/* The names of the ways to cut a box into tets. */
#ifndef COROT_APP_SCENARIO_BOX_SPLIT_H
#define COROT_APP_SCENARIO_BOX_SPLIT_H

#include <corot/mesh.h>
#include <stdbool.h>

/* False where there is none of that name. */
bool box_split_find(const char *name, corot_box_split *split);

#endif
