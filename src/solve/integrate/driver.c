/* SUNDIALS' callbacks on a model, and the words of a failure. */
#include "driver.h"

#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <string.h>

#include "solve/pencil/wall_clock.h"
#include "solve/sundials/vector.h"

/* --- Callbacks ------------------------------------------------------------------------------- */

corot_status corot_driver_refuse_trial(driver *d, corot_status status, const char *why) {
  if (!status) return status;
  if (why != d->refusal) snprintf(d->refusal, sizeof d->refusal, "%s", why);
  d->refused = d->self->nst;
  if (sun_is_fatal(status)) d->fatal = status;
  return status;
}

int corot_driver_answer(driver *d, corot_status status) {
  return sun_callback_code(corot_driver_refuse_trial(d, status, corot_error()));
}

static int solver_setup(SUNLinearSolver LS, SUNMatrix A) {
  (void)A;
  driver *d = LS->content;
  return corot_driver_answer(d, corot_pencil_factor(d->self->pencil));
}

static int answer_solved(driver *d, corot_status status) {
  return sun_solve_code(corot_driver_refuse_trial(d, status, corot_error()));
}

/* After a set-up that failed ARKODE may go on as if there had been one: it is to make one. */
static corot_status no_factor(void) { return corot_fail(COROT_RETRY, "there is no factor"); }

static int solver_solve(SUNLinearSolver LS, SUNMatrix A, N_Vector x, N_Vector b, sunrealtype tol) {
  (void)A, (void)tol;
  driver *d = LS->content;
  if (!d->self->pencil->factored) return answer_solved(d, no_factor());
  return answer_solved(
      d, corot_pencil_newton(d->self->pencil, N_VGetArrayPointer(b), N_VGetArrayPointer(x)));
}

int corot_driver_solve_dae(SUNLinearSolver LS, SUNMatrix A, N_Vector x, N_Vector b,
                           sunrealtype tol) {
  (void)A, (void)tol;
  driver *d = LS->content;
  return answer_solved(
      d, corot_pencil_newton_dae(d->self->pencil, N_VGetArrayPointer(b), N_VGetArrayPointer(x)));
}

int corot_driver_linsys(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix A, sunbooleantype jok,
                        sunbooleantype *jcur, sunrealtype gamma, void *user_data, N_Vector tmp1,
                        N_Vector tmp2, N_Vector tmp3) {
  (void)fy, (void)A, (void)tmp1, (void)tmp2, (void)tmp3;
  driver *d = user_data;
  return corot_driver_answer(d, corot_pencil_linsys(d->self->pencil, t, y, jok, jcur, gamma));
}

int corot_driver_linsys_ark(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix A, SUNMatrix M,
                            sunbooleantype jok, sunbooleantype *jcur, sunrealtype gamma,
                            void *user_data, N_Vector tmp1, N_Vector tmp2, N_Vector tmp3) {
  (void)M;
  return corot_driver_linsys(t, y, fy, A, jok, jcur, gamma, user_data, tmp1, tmp2, tmp3);
}

int corot_driver_rhs(sunrealtype t, N_Vector y, N_Vector ydot, void *user_data) {
  driver *d = user_data;
  corot_integrator *self = d->self;
  double start = clock_wall();
  corot_sun_data model = {.model = self->model, .state = self->state, .mass = self->mass};
  corot_status status = corot_rate(&model, t, y, ydot);
  self->force_s += clock_wall() - start;
  return corot_driver_answer(d, status);
}

int corot_driver_residual(sunrealtype t, N_Vector y, N_Vector yp, N_Vector F, void *user_data) {
  driver *d = user_data;
  corot_integrator *self = d->self;
  double start = clock_wall();
  corot_sun_data model = {.model = self->model, .state = self->state, .mass = self->mass};
  corot_status status = corot_defect(&model, t, y, yp, F);
  self->force_s += clock_wall() - start;
  return corot_driver_answer(d, status);
}

int corot_driver_work_rate(sunrealtype t, N_Vector y, N_Vector rate, void *user_data) {
  driver *d = user_data;
  corot_integrator *self = d->self;
  double start = clock_wall();
  const double *u = N_VGetArrayPointer(y);
  corot_energies *e = &self->energies;
  corot_status status =
      corot_energy(self->model, self->state, t, u, u + corot_model_ndof(self->model), e);
  self->t_energies = status ? NAN : t;
  if (!status) {
    N_VGetArrayPointer(rate)[0] = e->power_dissipated;
    N_VGetArrayPointer(rate)[1] = e->power_external - e->power_supports + e->power_carried;
  }
  self->work_s += clock_wall() - start;
  return corot_driver_answer(d, status);
}

int corot_driver_weights(N_Vector y, N_Vector weight, void *user_data) {
  driver *d = user_data;
  const corot_integrator_def *def = &d->self->def;
  tolerance tol = {def->rtol, def->atol_displacement, def->atol_velocity};
  corot_status status =
      corot_weigh(d->self->model, &tol, N_VGetArrayPointer(y), N_VGetArrayPointer(weight));
  return corot_driver_answer(d, status);
}

/* --- Opening and closing --------------------------------------------------------------------- */

/* The pencil's, but that failures are noted in the driver. */
static SUNLinearSolver make_solver(driver *d) {
  SUNLinearSolver LS = corot_sun_linsol(d->self->pencil, d->ctx);
  if (!LS) return NULL;
  LS->content = d;
  LS->ops->setup = solver_setup;
  LS->ops->solve = solver_solve;
  return LS;
}

corot_status corot_driver_open(driver *d, corot_integrator *self, const double *u,
                               const double *v) {
  int n = corot_model_ndof(self->model);
  d->self = self;
  if (sun_context_create(&d->ctx)) return corot_fail(COROT_ENOMEM, "no memory for SUNDIALS");
  d->y = N_VNew_Serial(2 * (sunindextype)n, d->ctx);
  if (self->pencil) {
    d->A = corot_sun_matrix(self->pencil, d->ctx);
    d->LS = make_solver(d);
  }
  if (!d->y || (self->pencil && !(d->A && d->LS)))
    return corot_fail(COROT_ENOMEM, "no memory for %s on %d unknowns", self->ops->kind.name, 2 * n);
  corot_vector_quicken(d->y);
  memcpy(N_VGetArrayPointer(d->y), u, n * sizeof *u);
  memcpy(N_VGetArrayPointer(d->y) + n, v, n * sizeof *v);
  return COROT_OK;
}

void corot_driver_close(driver *d) {
  if (d->LS) SUNLinSolFree(d->LS);
  if (d->A) SUNMatDestroy(d->A);
  if (d->y) N_VDestroy(d->y);
  if (d->ctx) SUNContext_Free(&d->ctx);
}

/* --- Failure --------------------------------------------------------------------------------- */

void corot_driver_on_error(SUN_ERROR_HANDLER_ARGUMENTS) {
  SUN_ERROR_HANDLER_UNUSED;
  char *message = data;
  snprintf(message, SUN_MESSAGE, "%s", SUN_ERROR_TEXT);
  for (char *p = message; *p; p++)
    if (*p == '\n') *p = ' ';
}

/* What a failure of SUNDIALS comes to. */
static corot_status meaning(const driver *d) {
  if (d->fatal) return d->fatal;
  return sun_says_no_memory(d->message) ? COROT_ENOMEM : COROT_EINTEGRATE;
}

corot_status corot_driver_refuse(const driver *d, const char *what) {
  if (d->fatal) return corot_driver_give_up(d, what);
  /* where SUNDIALS gives no reason, it did not get its memory */
  corot_status status = d->message[0] ? meaning(d) : COROT_ENOMEM;
  return corot_fail(status, "%s: %s: %s", d->self->ops->kind.name, what,
                    status == COROT_ENOMEM ? "out of memory" : d->message);
}

/* Whether a trial of the last few steps met a state that cannot be evaluated. */
static bool recently_refused(const driver *d) {
  return d->refusal[0] && d->self->nst - d->refused <= 3;
}

corot_status corot_driver_give_up(const driver *d, const char *why) {
  bool refused = recently_refused(d);
  char limit[48] = "";
  if (d->self->def.min_step > 0)
    snprintf(limit, sizeof limit, "; min_step = %g s", d->self->def.min_step);
  return corot_fail(meaning(d), "%s: cannot get past t = %.9g: %s%s%s%s%s", d->self->ops->kind.name,
                    d->self->t, refused ? d->refusal : "", refused ? " (" : "",
                    *why ? why : "the error test failed too often, or the step became too short",
                    limit, refused ? ")" : "");
}

void corot_driver_watch(driver *d, double h, bool stopped) {
  d->longest = fmax(d->longest, h);
  d->collapsed = !(h > 0) || (!stopped && recently_refused(d) && h < 1e-9 * d->longest);
}

corot_status corot_driver_check(driver *d) {
  d->fatal = COROT_OK;
  if (!d->collapsed) return COROT_OK;
  snprintf(d->message, sizeof d->message, "steps have shrunk to %.2g s", d->self->hlast);
  return corot_driver_give_up(d, d->message);
}
