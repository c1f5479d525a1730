/* What solve.json (see study/goal/goal.h) answers, in a line: for a page, and for a terminal. */
#ifndef COROT_REPORT_STUDY_GOAL_ANSWER_H
#define COROT_REPORT_STUDY_GOAL_ANSWER_H

#include <jansson.h>
#include <stddef.h>

enum { GOAL_AMOUNT_SIZE = 96, GOAL_ANSWER_SIZE = 800 };

/* "max(corner.ux) = 0.34341 m, between 0.34252 and 0.34431 (+- 0.26 %; 2 % asked)"; `plus_minus` is
   how that sign is written. */
void goal_answer(const json_t *solved, const char *plus_minus, char text[GOAL_ANSWER_SIZE]);

/* An error as it was asked for: in per cent of the value, or in the unit; "?" where it is not
   known. */
void goal_amount(const json_t *solved, double error, char text[GOAL_AMOUNT_SIZE]);

/* What was asked for, "2 %" or "0.01 m". */
void goal_asked(const json_t *solved, char text[GOAL_AMOUNT_SIZE]);

#endif
