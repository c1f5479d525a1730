/* The report of a quantity that was found within an error: solve.json, see study/goal/goal.h. What
   is absent or null is left out. */
#ifndef COROT_REPORT_STUDY_REPORT_GOAL_H
#define COROT_REPORT_STUDY_REPORT_GOAL_H

#include <corot/base.h>

/* The report of DIR/solve.json. */
corot_status report_goal(const char *dir, const char *path);

#endif
