#include "solve/driver.h"

#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <string.h>

#include "solve/clock.h"
#include "solve/vector.h"

corot_status corot_driver_open(driver *d, corot_integrator *self, const double *u,
                               const double *v) {
  int n = corot_model_ndof(self->model);
  d->self = self;
  if (sun_context_create(&d->ctx)) return corot_fail(COROT_ENOMEM, "no memory for SUNDIALS");
  d->y = N_VNew_Serial(2 * (sunindextype)n, d->ctx);
  if (self->pencil) {
    d->A = corot_sun_matrix(self->pencil, d->ctx);
    d->LS = corot_sun_linsol(self->pencil, d->ctx);
  }
  if (!d->y || (self->pencil && !(d->A && d->LS)))
    return corot_fail(COROT_ENOMEM, "no memory for %s on %d unknowns", self->ops->name, 2 * n);
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

int corot_driver_refuse_trial(driver *d, int status, const char *why) {
  snprintf(d->refusal, sizeof d->refusal, "%s", why);
  d->refused = d->self->nst;
  return status;
}

int corot_driver_rhs(sunrealtype t, N_Vector y, N_Vector ydot, void *user_data) {
  driver *d = user_data;
  corot_integrator *self = d->self;
  double start = clock_wall();
  corot_sun_data model = {self->model, self->state, self->mass};
  int status = corot_sun_rhs(t, y, ydot, &model);
  self->force_s += clock_wall() - start;
  return status ? corot_driver_refuse_trial(d, status, corot_error()) : 0;
}

int corot_driver_residual(sunrealtype t, N_Vector y, N_Vector yp, N_Vector F, void *user_data) {
  driver *d = user_data;
  corot_integrator *self = d->self;
  double start = clock_wall();
  corot_sun_data model = {self->model, self->state, self->mass};
  int status = corot_sun_residual(t, y, yp, F, &model);
  self->force_s += clock_wall() - start;
  return status ? corot_driver_refuse_trial(d, status, corot_error()) : 0;
}

int corot_driver_work_rate(sunrealtype t, N_Vector y, N_Vector rate, void *user_data) {
  corot_integrator *self = ((driver *)user_data)->self;
  double start = clock_wall();
  const double *u = N_VGetArrayPointer(y);
  corot_energies *e = &self->energies;
  int status = corot_energy(self->model, self->state, t, u, u + corot_model_ndof(self->model), e);
  self->t_energies = status ? NAN : t;
  if (!status) {
    N_VGetArrayPointer(rate)[0] = e->power_dissipated;
    N_VGetArrayPointer(rate)[1] = e->power_external;
  }
  self->work_s += clock_wall() - start;
  return status;
}

/* Largest length of a node's vector in x [n], infinity if one is not a number. */
static double largest_vector(const corot_model *model, const double *x) {
  int nnode = corot_model_mesh(model)->nnode;
  const int(*dof)[3] = corot_model_dof(model);
  double largest = 0;
  for (int n = 0; n < nnode; n++) {
    double square = 0;
    for (int c = 0; c < 3; c++)
      if (dof[n][c] >= 0) square += x[dof[n][c]] * x[dof[n][c]];
    if (!(square < INFINITY)) return INFINITY;
    largest = fmax(largest, square);
  }
  return sqrt(largest);
}

int corot_driver_weights(N_Vector y, N_Vector weight, void *user_data) {
  driver *d = user_data;
  corot_integrator *self = d->self;
  const corot_integrator_def *def = &self->def;
  int n = corot_model_ndof(self->model);
  const double *u = N_VGetArrayPointer(y);
  double *w = N_VGetArrayPointer(weight);
  double wu = 1 / (def->rtol * largest_vector(self->model, u) + def->atol_displacement);
  double wv = 1 / (def->rtol * largest_vector(self->model, u + n) + def->atol_velocity);
  if (!(wu > 0 && wv > 0))
    return corot_driver_refuse_trial(d, -1, "the motion exceeds double precision");
  for (int i = 0; i < n; i++) w[i] = wu, w[n + i] = wv;
  return 0;
}

void corot_driver_on_error(SUN_ERROR_HANDLER_ARGUMENTS) {
  SUN_ERROR_HANDLER_UNUSED;
  char *message = data;
  snprintf(message, SUN_MESSAGE, "%s", SUN_ERROR_TEXT);
  for (char *p = message; *p; p++)
    if (*p == '\n') *p = ' ';
}

corot_status corot_driver_refuse(const driver *d, const char *what) {
  return corot_fail(COROT_EINTEGRATE, "%s: %s: %s", d->self->ops->name, what,
                    d->message[0] ? d->message : "out of memory");
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
  return corot_fail(COROT_EINTEGRATE, "%s: cannot get past t = %.9g: %s%s%s%s%s",
                    d->self->ops->name, d->self->t, refused ? d->refusal : "", refused ? " (" : "",
                    *why ? why : "the error test failed too often, or the step became too short",
                    limit, refused ? ")" : "");
}

void corot_driver_watch(driver *d, double h, bool stopped) {
  d->longest = fmax(d->longest, h);
  d->collapsed = !(h > 0) || (!stopped && recently_refused(d) && h < 1e-9 * d->longest);
}

corot_status corot_driver_check(driver *d) {
  if (!d->collapsed) return COROT_OK;
  snprintf(d->message, sizeof d->message, "steps have shrunk to %.2g s", d->self->hlast);
  return corot_driver_give_up(d, d->message);
}
