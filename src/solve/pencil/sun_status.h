/* Where a corot_status becomes the code that SUNDIALS expects: every function of ours that SUNDIALS
   calls returns by way of one of the two functions below.

   What the integrators make of a code (6.4.1 to 7.x):

     right-hand side, residual,     CVODE, IDA, ARKODE: > 0 again with a shorter step, < 0 the end.
     work rates (quadratures)       ERKStep, and ARKStep in the right-hand side at the end of a
   step, take > 0 for the end, too: runge_kutta.c shortens the step there linear system, Jacobian,
   the same; KINSOL takes any but 0 for the end set-up of the linear solver its solve CVODE, IDA,
   ARKODE look for SUNLS_* by value: CONV_FAIL and some more are the shorter step; MEM_FAIL and
   PACKAGE_FAIL_UNREC are the end; what is not on their lists (-1 is not) IS A SUCCESS, and the
   unsolved right-hand side is taken for the solution. KINSOL goes by the sign error weights any but
   0 is the end system function of KINSOL      > 0 half the step, five times at most; the end at the
   first call; < 0 the end product and preconditioner     SUNLinSol_PCG: by the sign,
   SUNLS_ATIMES_FAIL_* and of conjugate gradients         SUNLS_PSOLVE_FAIL_*

   A shorter step helps against an inverted element, and against a matrix that is indefinite or
   singular, or that conjugate gradients do not solve: it brings S closer to M. Nothing of that kind
   helps where memory ran out or a call makes no sense. */
#ifndef COROT_SOLVE_PENCIL_SUN_STATUS_H
#define COROT_SOLVE_PENCIL_SUN_STATUS_H

#include <corot/base.h>
#include <stdbool.h>
#include <string.h>

#include "sun_compat.h"

/* Whether no shorter step helps. */
static inline bool sun_is_fatal(corot_status status) {
  return status < 0 && status != COROT_ESINGULAR;
}

/* For every callback but the solve of a linear solver: the sign is what counts. */
static inline int sun_callback_code(corot_status status) {
  return sun_is_fatal(status) ? (int)status : status != COROT_OK;
}

/* For the solve of a linear solver. */
static inline int sun_solve_code(corot_status status) {
  if (status == COROT_ENOMEM) return SUN_SOLVE_NO_MEMORY;
  return sun_is_fatal(status) ? SUN_SOLVE_FATAL : status ? SUNLS_CONV_FAIL : 0;
}

/* Whether SUNDIALS' own words on a failure mean want of memory: its packages have different numbers
   for that, and the same words. An integrator is there whenever it is asked for something: where
   ARKODE calls it NULL, it is the copy of a table that it could not allocate. */
static inline bool sun_says_no_memory(const char *message) {
  return strstr(message, "memory request failed") || strstr(message, "_mem = NULL illegal");
}

#endif
