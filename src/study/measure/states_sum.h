/* Sums of trajectories of one solid, of meshes that hold one another's nodes. */
#ifndef COROT_STUDY_MEASURE_STATES_SUM_H
#define COROT_STUDY_MEASURE_STATES_SUM_H

#include <stdbool.h>

#include "app/folder/states.h"

/* Whether two output times of trajectories that end at `end` are the same. */
bool states_same_time(double s, double t, double end);

/* Where each degree of freedom of `like` stands in `other`: at [n], the caller's to free.
   COROT_EINVAL: one stands nowhere. */
corot_status states_places(const trajectory *like, const trajectory *other, int **at);

/* The sum of factor[k] times term[k] [nterm] at the places and times of `like`, which all of the
   terms must have: the caller's to states_free. COROT_EINVAL: they have not. */
corot_status states_sum(const trajectory *like, int nterm, const double *factor,
                        const trajectory *const *term, trajectory *out);

/* Drops all records but the last. */
void states_keep_last(trajectory *t);

#endif
