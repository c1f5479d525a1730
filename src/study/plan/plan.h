/* From what a study file says to runs with an identity each. */
#ifndef COROT_STUDY_PLAN_PLAN_H
#define COROT_STUDY_PLAN_PLAN_H

#include "manifest.h"

/* The work of a run is tets^1.5, as of factors and solves, times steps: t_end / step, or t_end /
   rtol^(1/3) where errors are controlled, as by a method of order 2; one step of an equilibrium. A
   tet of ten nodes counts as six. It tells runs of a study from each other, and is a guess. */

/* Reads the scenario of every cell and of its references, and each mesh once. Cells whose scenario
   and mesh are the same share a run. COROT_EFORMAT: the message names the place in the study file
   or in the base. */
corot_status plan_study(const study *s, manifest **out);

#endif
