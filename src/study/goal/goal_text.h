/* The answer in a line, and what stands behind it. */
#ifndef COROT_STUDY_GOAL_GOAL_TEXT_H
#define COROT_STUDY_GOAL_GOAL_TEXT_H

#include <jansson.h>
#include <stdio.h>

/* Of solve.json (goal.h). */
void goal_print(const json_t *solved, FILE *out);

#endif
