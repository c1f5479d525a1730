/* The search for a quantity with an error: what it knows at any time. */
#ifndef COROT_STUDY_GOAL_GOAL_SEARCH_H
#define COROT_STUDY_GOAL_GOAL_SEARCH_H

#include "goal_attempts.h"
#include "goal_request.h"
#include "goal_rule.h"

enum { GOAL_LEVELS = 12 };

/* A part may take so much of what is allowed; the mesh gets the rest. */
#define GOAL_TIME_SHARE 0.2

/* The error of time may be so many times what four-node tets show, where nothing else is known. */
#define GOAL_UNCHECKED 5.0

/* Motion with so much less kinetic than elastic energy is nearly a row of equilibria, whose shapes
   say where a mesh must be finer. */
#define GOAL_QUIET 0.1

/* Extremes that differ by so much of what is allowed are alike. */
#define GOAL_LIKE 0.2

/* Values of two meshes that differ by so much of what is allowed are as good as the same. */
#define GOAL_SAME 0.1

/* What is read out of a run's steps may differ by so much of what is allowed from what the run
 * found.
 */
#define GOAL_RESOLVED 0.01

/* Errors of time and algebra are much the same on all meshes: so much of them is not. */
#define GOAL_NOISE 0.2

typedef struct goal_search {
  const goal_request *request;
  attempts attempts;

  /* time, of motion; of an equilibrium the part of time is zero */
  const char *method;
  double rtol;
  double until;      /* what the quantity needs to be seen [s] */
  double window;     /* finer meshes are integrated so far: `until`, or past the extreme */
  double coarse_off; /* half-width of time on four-node tets, over the value */

  int coarse;              /* attempt of four-node tets as given, by that method */
  int nlevel;              /* of meshes */
  int level[GOAL_LEVELS];  /* attempts */
  int full;                /* an attempt of the first level that goes to `until` */
  attempt whole;           /* the same with its own value, where it has that within the window */
  int refine, npass;       /* of the last */
  int timed, check;        /* whose error of time is known, and by what it is judged; -1: none */
  int algebra, algebra_of; /* an attempt with tight algebra, and the same without; -1: none */
  int model, model_of;     /* an attempt by green, and the same by the scenario's measure */
  double tail;             /* half-width, over the value: of what is not seen in the window */
  goal_result *result;
} goal_search;

static inline attempt *goal_attempt(const goal_search *s, int i) {
  return i >= 0 ? &s->attempts.all[i] : NULL;
}
double goal_value(const goal_search *s, int i); /* of attempt i; NaN: none */

/* What is allowed for the error of a value of that size. */
double goal_allowed(const goal_request *r, double value);

/* Whether attempts that take so long may still be made [s]; else result->obstacle says so. */
bool goal_affords(goal_search *s, double cpu);

/* Whether an attempt has a value that an error may be asked of; else result says why not. */
bool goal_is_sensible(goal_search *s, int i);

/* Chooses method and tolerance on four-node tets, where runs are cheap: s->method, rtol, coarse,
   coarse_off. Where there is no value: result->obstacle. */
corot_status goal_choose_time(goal_search *s);

/* The first mesh of ten-node tets; by what its error of time is judged, as far as the window; and
   better methods and tolerances, once both are there, until that error is small. */
void goal_plan_base(goal_search *s);
void goal_plan_check(goal_search *s);
corot_status goal_settle_time(goal_search *s);

/* The same on the second mesh, before a third is made, or where waves have passed for settled. */
corot_status goal_settle_time_again(goal_search *s);

/* Where the extreme is early enough: s->window. */
corot_status goal_choose_window(goal_search *s);

/* The first mesh's value within it: out of the run that went further, else by one to be made. */
corot_status goal_look_through_window(goal_search *s);
corot_status goal_find_tail(goal_search *s);

/* Whether attempt i has its extreme inside of the window; else the window is given up. */
bool goal_keeps_window(goal_search *s, int i);

/* The next mesh: *made: there is one. */
corot_status goal_refine(goal_search *s, bool *made);

/* The first level's run, as far as the window. */
attempt_def goal_base_def(const goal_search *s);

/* What algebra and strain measure do, on a mesh where that is cheap. */
void goal_plan_algebra(goal_search *s);
void goal_plan_model(goal_search *s);

/* Sums up what is known by now in s->result. */
void goal_sum_up(goal_search *s);

#endif
