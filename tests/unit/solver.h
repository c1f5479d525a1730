/* Linear solvers by name, for tests. */
#ifndef SOLVER_H
#define SOLVER_H

#include <corot/solve.h>

#define SOLVER_TO(name, tolerance) \
  (&(corot_linear_def){name, "auto", "auto", "auto", tolerance, COROT_ROLE_DYNAMIC, NULL, NULL})
#define SOLVER(name) SOLVER_TO(name, 1e-10)

#endif
