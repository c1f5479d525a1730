/* What differs in ARKODE between SUNDIALS 6.4 and 7.x; of all else see sun_compat.h. */
#ifndef COROT_SOLVE_SUNDIALS_SUN_ARK_H
#define COROT_SOLVE_SUNDIALS_SUN_ARK_H

#include <stdio.h> /* which the next ones need */

#include <arkode/arkode_arkstep.h>
#include <arkode/arkode_erkstep.h>

#include "sun_compat.h"

#define SUN_VERSION (100 * SUNDIALS_VERSION_MAJOR + SUNDIALS_VERSION_MINOR)

/* SUN_ARK(Evolve), SUN_ERK(Evolve): what all steppers have. From 7.1 on its name is ARKodeEvolve,
   and the names of each stepper's own, ARKStepEvolve and ERKStepEvolve, are deprecated. What one
   stepper only has, such as its tables, keeps its name. */
#if SUN_VERSION >= 701
#define SUN_ARK(name) ARKode##name
#define SUN_ERK(name) ARKode##name
#else
#define SUN_ARK(name) ARKStep##name
#define SUN_ERK(name) ERKStep##name
#endif

/* Evaluations of the implicit right-hand side of ARKStep, and of the one of ERKStep. */
#if SUN_VERSION >= 703
static inline int sun_ark_nfe(void *ark, long *nfe) { return ARKodeGetNumRhsEvals(ark, 1, nfe); }
static inline int sun_erk_nfe(void *erk, long *nfe) { return ARKodeGetNumRhsEvals(erk, 0, nfe); }
#else
static inline int sun_ark_nfe(void *ark, long *nfe) {
  long explicit_part;
  return ARKStepGetNumRhsEvals(ark, &explicit_part, nfe);
}
static inline int sun_erk_nfe(void *erk, long *nfe) { return ERKStepGetNumRhsEvals(erk, nfe); }
#endif

/* Lets a PI controller with SUNDIALS' own coefficients choose the steps, the error as it is
   estimated, without a bias. From 7.1 on that is an object, which ARKODE uses and does not own:
   sun_ark_release takes it (NULL: there is none) after ARKODE's memory. */
#if SUN_VERSION >= 701
#include <sunadaptcontroller/sunadaptcontroller_soderlind.h>

static inline int sun_ark_control(void *ark, SUNContext ctx, void **controller) {
  SUNAdaptController C = SUNAdaptController_PI(ctx);
  *controller = C;
  return !C || SUNAdaptController_SetErrorBias(C, 1) || ARKodeSetAdaptController(ark, C);
}

static inline void sun_ark_release(void *controller) {
  if (controller) SUNAdaptController_Destroy(controller);
}
#else
static inline int sun_ark_control(void *ark, SUNContext ctx, void **controller) {
  (void)ctx;
  *controller = NULL;
  return ARKStepSetAdaptivityMethod(ark, ARK_ADAPT_PI, SUNTRUE, SUNFALSE, NULL) ||
         ARKStepSetErrorBias(ark, 1);
}

static inline void sun_ark_release(void *controller) { (void)controller; }
#endif

#endif
