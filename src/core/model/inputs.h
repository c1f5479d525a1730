/* Inside of the inputs of corot/inputs.h, and what the functions of a model make of them. An
   instant without inputs costs a test. */
#ifndef COROT_CORE_MODEL_INPUTS_H
#define COROT_CORE_MODEL_INPUTS_H

#include <corot/inputs.h>

#include "model.h"

/* A straight line in time. */
typedef struct ramp {
  double t, value, slope;
} ramp;

struct corot_inputs {
  const corot_model *model;
  size_t bytes; /* with all they hold */

  bool forced;                     /* there is a force: */
  double t_force;                  /* at this time [s] */
  double (*force)[3], (*slope)[3]; /* [nnode] that, and its change [N], [N/s] */
  ramp *load;                      /* [nload] factors */

  /* How often they have changed: */
  long loads; /* forces and factors of loads */
};

static inline double ramp_at(ramp r, double t) { return r.value + (t - r.t) * r.slope; }

/* The factor of load k at an instant. */
double corot_inputs_load(const instant *now, int k);

/* f [ndof], or f [nnode] on all components, += the force. */
void corot_inputs_add_force(const corot_model *m, const instant *now, double *f);
void corot_inputs_add_nodal_force(const corot_model *m, const instant *now, double (*f)[3]);

/* COROT_EINVAL: an entry of x [n][3], the `what` of a `row`, is not finite. */
corot_status corot_inputs_check(const char *what, const char *row, int n, const double (*x)[3]);

#endif
