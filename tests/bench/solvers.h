/* The linear solvers on the matrix of an implicit step. */
#ifndef BENCH_SOLVERS_H
#define BENCH_SOLVERS_H

#include "solid.h"
#include "solve/linsol/linsol.h"

/* A solver with its matrix and a right-hand side. */
typedef struct problem {
  linsol s;
  double *x, *b; /* [n] */
} problem;

/* S = a M + b D + c K; s->K and s->D are set. What is half made is released by clear. */
corot_status problem_create(const specimen *s, const corot_linear_def *def, double a, double b,
                            double c, problem *p);
void problem_clear(problem *p);

/* For timing_of. */
corot_status problem_factor(void *data);
corot_status problem_solve(void *data);

/* Reports factor, refactor and solve of each solver that is built in; s->K and s->D are set. KLU
   is left out beyond 12 000 unknowns, where it takes minutes. */
corot_status solvers_measure(bool json, const specimen *s);

#endif
