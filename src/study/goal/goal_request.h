/* What is asked of a search for a quantity, and what it answers. */
#ifndef COROT_STUDY_GOAL_GOAL_REQUEST_H
#define COROT_STUDY_GOAL_GOAL_REQUEST_H

#include "app/scenario/scenario.h"

typedef struct goal_request {
  const quantity *quantity;
  const char *text, *name; /* as it is printed; of its key in the scenario */
  double within;           /* relative to the value, or in its unit: */
  bool absolute;
  bool still;       /* of the equilibrium */
  bool exact_model; /* the strain measure counts, against green */
  double cpu_limit; /* [s] of all attempts together */
} goal_request;

typedef struct goal_result {
  double value, low, high; /* NaN: there is none */
  bool met, asymptotic;
  int exit_code;       /* of a first attempt that failed; 0: none did, or it is not known */
  bool senseless;      /* what was asked for makes no sense, as obstacle says */
  const char *why_not; /* asymptotic */
  double order, limit; /* observed, extrapolated; NaN: not known */

  double space, time, algebra, model; /* estimates; NaN: not known */
  double half_space, half_time, half_algebra, half_tail, half_model;
  char obstacle[512]; /* "": none */
  char advice[320];   /* "" */
} goal_result;

#endif
