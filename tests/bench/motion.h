/* 40 s of the bar's motion (corot-bench run --help), seen at its corner. */
#ifndef BENCH_MOTION_H
#define BENCH_MOTION_H

#include <corot/integrate.h>

/* Every 0.1 s. */
enum { NOUTPUT = 401 };

/* A model, and what its runs write to. */
typedef struct motion {
  corot_model *model;
  corot_state *state;
  double *zero, *u; /* [n] */
  int probe;        /* degree of freedom: x of the corner */
} motion;

/* Takes the model, in case of failure, too. Whatever comes of it is to be destroyed. */
corot_status motion_create(corot_model *model, motion *m);

void motion_destroy(motion *m);

/* From rest by an integrator; ux[k] is the corner's at 0.1 k [m]. */
corot_status motion_run(motion *m, const corot_integrator_def *def, double ux[NOUTPUT],
                        corot_statistics *counts);

#endif
