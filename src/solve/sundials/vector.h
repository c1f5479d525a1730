/* SUNDIALS' serial vector with its loops compiled for the processor at hand, and shared out. */
#ifndef COROT_SOLVE_SUNDIALS_VECTOR_H
#define COROT_SOLVE_SUNDIALS_VECTOR_H

#include <sundials/sundials_nvector.h>

#include "core/base/sisters.h"
#include "core/base/team.h"

/* Replaces operations of a serial vector by faster ones that mean the same; its clones have them as
   well. The library's own are compiled for the plainest processor, and sum one number after the
   other: on the paper's bar they are a third of a run, these a tenth. */
COROT_SISTERS void corot_vector_quicken(N_Vector x);

/* From now on, on the calling thread, a team shares out the operations of such vectors, whoever's
   they are; NULL: nobody does. Returns who did before. Sums are the same for any team. */
COROT_SISTERS team *corot_vector_share(team *by);

#endif
