/* The instant of an evaluation. Where a load or a motion changes its law, at a kink, `side` says
   which law is meant. */
#ifndef COROT_CORE_MODEL_INSTANT_H
#define COROT_CORE_MODEL_INSTANT_H

#include <stdbool.h>

typedef struct instant {
  double t;           /* of the supports [s] */
  double load_t;      /* of the loads [s] */
  double load_factor; /* times this */
  double side; /* by the law in force just after this time [s]; NaN: just after each one's own */
  bool moving; /* else nothing has a velocity */
  struct corot_inputs *inputs; /* NULL: none */
} instant;

#endif
