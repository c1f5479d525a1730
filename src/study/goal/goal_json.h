/* What was found, as solve.json has it: see goal.h. */
#ifndef COROT_STUDY_GOAL_GOAL_JSON_H
#define COROT_STUDY_GOAL_GOAL_JSON_H

#include <jansson.h>

#include "goal_search.h"

/* The caller's; NULL: no memory. */
json_t *goal_json(const goal_search *s);

#endif
