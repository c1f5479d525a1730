/* What the drivers of SUNDIALS' integrators share: y = (u, v), its right-hand side, error weights
   and work integrands as callbacks, and the words in which a failure is told. */
#ifndef COROT_SOLVE_INTEGRATE_DRIVER_H
#define COROT_SOLVE_INTEGRATE_DRIVER_H

#include "integrator.h"
#include "solve/sundials/sun_status.h"

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
  char refusal[256];         /* why the model was not evaluated, or a system not solved, at last */
  long refused;              /* steps taken by then */
  corot_status fatal;        /* of this step, if no shorter one helps */
  char message[SUN_MESSAGE]; /* SUNDIALS' own words on its last failure */
} driver;

/* Context, y = (u, v), matrix and linear solver (of y' = f; corot_driver_solve_dae is the other's
   operation). What is half made is released by close. */
corot_status corot_driver_open(driver *d, corot_integrator *self, const double *u, const double *v);
void corot_driver_close(driver *d);

/* ydot = (v, M^-1 r); the right-hand side of CVODE and ARKODE. user_data: the driver. */
int corot_driver_rhs(sunrealtype t, N_Vector y, N_Vector ydot, void *user_data);

/* F = (u' - v, M v' - r); the residual of IDA. user_data: the driver. */
int corot_driver_residual(sunrealtype t, N_Vector y, N_Vector yp, N_Vector F, void *user_data);

/* corot_sun_linsys and corot_sun_linsys_ark; user_data: the driver. */
int corot_driver_linsys(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix A, sunbooleantype jok,
                        sunbooleantype *jcur, sunrealtype gamma, void *user_data, N_Vector tmp1,
                        N_Vector tmp2, N_Vector tmp3);
int corot_driver_linsys_ark(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix A, SUNMatrix M,
                            sunbooleantype jok, sunbooleantype *jcur, sunrealtype gamma,
                            void *user_data, N_Vector tmp1, N_Vector tmp2, N_Vector tmp3);

/* The linear solver's solve for the residual form of IDA. */
int corot_driver_solve_dae(SUNLinearSolver LS, SUNMatrix A, N_Vector x, N_Vector b,
                           sunrealtype tol);

/* One weight for all displacements and one for all velocities, by the length of the longest vector
   of a node: unlike componentwise sizes it does not change when the whole problem is turned, so
   neither do the steps. */
int corot_driver_weights(N_Vector y, N_Vector weight, void *user_data);

/* rate = dissipated and external power [2]; of what the supports put in, the change of what they
   carry (corot_energies.carried) is left out. */
int corot_driver_work_rate(sunrealtype t, N_Vector y, N_Vector rate, void *user_data);

/* An error handler: keeps SUNDIALS' words, on one line. `data`: char [SUN_MESSAGE]. */
void corot_driver_on_error(SUN_ERROR_HANDLER_ARGUMENTS);

/* Notes that a trial failed with `status`, if it did, for the reason `why`, and whether a shorter
   step may help; returns `status`. */
corot_status corot_driver_refuse_trial(driver *d, corot_status status, const char *why);

/* The same of corot_error(), with the code that SUNDIALS expects of a callback. */
int corot_driver_answer(driver *d, corot_status status);

/* SUNDIALS objects to `what`, a set-up or a query, or lacks memory for it: COROT_EINTEGRATE,
   COROT_ENOMEM, or the status of a callback that no shorter step helps. */
corot_status corot_driver_refuse(const driver *d, const char *what);

/* No way past self->t; the model's reason, if it is to blame, and `why`. COROT_EINTEGRATE, or the
   status of a callback that no shorter step helps. */
corot_status corot_driver_give_up(const driver *d, const char *why);

/* Call this after each step of length h: where the model cannot be evaluated beyond some time
   (an element inverts), SUNDIALS takes ever shorter steps towards it without end; this marks it. */
void corot_driver_watch(driver *d, double h, bool stopped);

/* Call this before each step. COROT_EINTEGRATE: the step was marked so. */
corot_status corot_driver_check(driver *d);

#endif
