/* What the drivers of SUNDIALS' integrators share: y = (u, v), its right-hand side, error weights
   and work integrands as callbacks, and the words in which a failure is told. */
#ifndef COROT_SOLVE_DRIVER_H
#define COROT_SOLVE_DRIVER_H

#include "solve/integrator.h"
#include "solve/sun_compat.h"

enum { SUN_MESSAGE = 512 };

/* Failures of the error test in one step. Each divides it by three or more; SUNDIALS' own choice of
   7 is not enough where a stiff body meets a new load at the end of a step of a million periods. */
enum { DRIVER_MOST_FAILURES = 40 };

/* First member of each driver, and the user_data of its callbacks. */
typedef struct driver {
  corot_integrator *self;
  SUNContext ctx;
  N_Vector y; /* [2n] solution at self->t */
  SUNMatrix A;
  SUNLinearSolver LS;
  double longest;            /* step so far [s] */
  bool collapsed;            /* the last step shows that there is no way on */
  char refusal[128];         /* why the model could not be evaluated in the last such trial */
  long refused;              /* steps taken by then */
  char message[SUN_MESSAGE]; /* SUNDIALS' own words on its last failure */
} driver;

/* Context, y = (u, v), matrix and linear solver. What is half made is released by close. */
corot_status corot_driver_open(driver *d, corot_integrator *self, const double *u, const double *v);
void corot_driver_close(driver *d);

/* ydot = (v, M^-1 r); the right-hand side of CVODE and ARKODE. user_data: the driver. */
int corot_driver_rhs(sunrealtype t, N_Vector y, N_Vector ydot, void *user_data);

/* F = (u' - v, M v' - r); the residual of IDA. user_data: the driver. */
int corot_driver_residual(sunrealtype t, N_Vector y, N_Vector yp, N_Vector F, void *user_data);

/* One weight for all displacements and one for all velocities, by the length of the longest vector
   of a node: unlike componentwise sizes it does not change when the whole problem is turned, so
   neither do the steps. */
int corot_driver_weights(N_Vector y, N_Vector weight, void *user_data);

/* rate = dissipated and external power [2]. */
int corot_driver_work_rate(sunrealtype t, N_Vector y, N_Vector rate, void *user_data);

/* An error handler: keeps SUNDIALS' words, on one line. `data`: char [SUN_MESSAGE]. */
void corot_driver_on_error(SUN_ERROR_HANDLER_ARGUMENTS);

/* Notes that a trial state could not be evaluated, and why; returns `status`. */
int corot_driver_refuse_trial(driver *d, int status, const char *why);

/* COROT_EINTEGRATE: SUNDIALS objects to `what`, a set-up or a query. */
corot_status corot_driver_refuse(const driver *d, const char *what);

/* COROT_EINTEGRATE: no way past self->t; the model's reason, if it is to blame, and `why`. */
corot_status corot_driver_give_up(const driver *d, const char *why);

/* To be called after each step of length h: where the model cannot be evaluated beyond some time
   (an element inverts), SUNDIALS takes ever shorter steps towards it without end; this marks it. */
void corot_driver_watch(driver *d, double h, bool stopped);

/* COROT_EINTEGRATE if it was marked. To be called before each step. */
corot_status corot_driver_check(driver *d);

#endif
