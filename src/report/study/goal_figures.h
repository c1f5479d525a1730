/* The chart and the table of a quantity's values on ever finer meshes. */
#ifndef COROT_REPORT_STUDY_GOAL_FIGURES_H
#define COROT_REPORT_STUDY_GOAL_FIGURES_H

#include <corot/base.h>
#include <jansson.h>
#include <stdio.h>

/* Nothing where no mesh has a value. */
corot_status goal_figures_meshes(const json_t *solved, FILE *out);

#endif
