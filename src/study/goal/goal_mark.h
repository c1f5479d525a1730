/* Where the next mesh is to be finer. */
#ifndef COROT_STUDY_GOAL_GOAL_MARK_H
#define COROT_STUDY_GOAL_GOAL_MARK_H

#include "goal_search.h"

typedef struct goal_marking {
  bool local; /* DIR/marks/N.txt is written, N = s->npass + 1; else it is to be finer everywhere */
  double growth; /* so many times the unknowns, about */
} goal_marking;

/* By the estimator at the last level, at the time of the extreme or of the end. */
corot_status goal_mark(goal_search *s, goal_marking *out);

#endif
