/* The direct solvers on the matrix of an implicit step. */
#ifndef BENCH_SOLVERS_H
#define BENCH_SOLVERS_H

#include "solid.h"

/* Reports factor, refactor and solve of each solver that is built in; s->K and s->D are set. KLU
   is left out beyond 12 000 unknowns, where it takes minutes. */
corot_status solvers_measure(bool json, const solid *s);

#endif
