/* SUNDIALS before 6.6.1 has a defect: after a stop time has been reached by a call whose tout
   equals it, the next call returns at once without advancing. advance() takes single steps, and its
   tout always lies beyond the stop time.

   The interpolant is our own: u by Hermite's polynomial of degree 5 through u, v and the
   acceleration at both ends, v its derivative; of an implicit method, without what is too fast for
   the step in these slopes (rk_stages.c). That of ARKODE does not know that v = du/dt, and is only
   of degree order - 1. */
#include "runge_kutta.h"

#include <float.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/model/load_force.h"
#include "solve/sundials/sun_ark.h"

corot_status corot_rk_open(runge_kutta *m, corot_integrator *self, const rk_api *api, int order,
                           const double *u, const double *v) {
  m->api = api;
  m->order = order;
  m->npoint = corot_lobatto_points(order);
  m->t_stop = NAN;
  m->fresh = true;
  driver *d = &m->driver;
  COROT_TRY(corot_driver_open(d, self, u, v));
  N_Vector *const like_y[] = {&m->start.y, &m->start.rate, &m->end.y,    &m->end.rate, &m->error,
                              &m->weight,  &m->slope[0],   &m->slope[1], &m->load};
  bool short_of_memory = !(m->power = N_VNew_Serial(2, d->ctx));
  for (size_t k = 0; k < sizeof like_y / sizeof *like_y; k++)
    short_of_memory = !(*like_y[k] = N_VClone(d->y)) || short_of_memory;
  if (short_of_memory)
    return corot_fail(COROT_ENOMEM, "no memory for %s on %d unknowns", self->ops->kind.name,
                      2 * corot_model_ndof(self->model));
  m->end.t = self->t;
  N_VScale(1, d->y, m->end.y);
  return COROT_OK;
}

void corot_rk_close(void *method) {
  runge_kutta *m = method;
  if (m->memory) m->api->release(&m->memory);
  sun_ark_release(m->controller);
  corot_explicit_limit_destroy(m->limit);
  corot_rk_release_stages(&m->stages);
  N_Vector const vectors[] = {m->start.y, m->start.rate, m->end.y,    m->end.rate, m->error,
                              m->weight,  m->power,      m->slope[0], m->slope[1], m->load};
  for (size_t k = 0; k < sizeof vectors / sizeof *vectors; k++)
    if (vectors[k]) N_VDestroy(vectors[k]);
  corot_driver_close(&m->driver);
  free(m);
}

/* --- A step ---------------------------------------------------------------------------------- */

static corot_status reset(runge_kutta *m, double h) {
  driver *d = &m->driver;
  m->t_stop = NAN;
  m->stale = false;
  m->fresh = true;
  m->begin = h;
  if (m->api->reset(m->memory, d->self->t, d->y) || m->api->set_first_step(m->memory, h))
    return corot_driver_refuse(d, "restart");
  return COROT_OK;
}

/* *h = the step that error control would take next; 0: it is not known yet. */
static corot_status usual_step(const runge_kutta *m, double *h) {
  *h = m->begin;
  if (m->begin > 0 || m->driver.self->nst == 0) return COROT_OK;
  if (m->api->next_step(m->memory, h)) return corot_driver_refuse(&m->driver, "statistics");
  return COROT_OK;
}

/* After a change of r. Of the past no more than the rate at the start goes into the next step: if
   it is what it was there is nothing to begin. */
static corot_status begin_afresh(runge_kutta *m) {
  driver *d = &m->driver;
  double h = m->first_step, usual;
  COROT_TRY(usual_step(m, &usual));
  m->nfe++;
  if (corot_driver_rhs(m->start.t, m->start.y, m->error, d))
    return corot_driver_give_up(d, "in the state reached");
  N_VLinearSum(1, m->error, -1, m->start.rate, m->start.rate);
  bool same = !m->fresh && usual * N_VWrmsNorm(m->start.rate, m->weight) < 1e-6;
  N_VScale(1, m->error, m->start.rate);
  m->start.rate_known = true;
  if (h == 0) {
    h = usual;
    if (!m->resolved || !same) COROT_TRY(corot_rk_first_step(m, &h));
    if (same && h == usual) {
      m->stale = false;
      return COROT_OK;
    }
  }
  m->first_step = 0;
  return reset(m, h);
}

/* One attempt; *flag is SUNDIALS' answer. */
static corot_status attempt(runge_kutta *m, double t_stop, double *t, int *flag) {
  driver *d = &m->driver;
  if (t_stop != m->t_stop && m->api->set_stop_time(m->memory, t_stop))
    return corot_driver_refuse(d, "stop time");
  m->t_stop = t_stop;
  d->message[0] = 0;
  double beyond = t_stop + (t_stop - d->self->t);
  *flag = m->api->advance(m->memory, beyond, d->y, t, ARK_ONE_STEP);
  if (*flag == ARK_TSTOP_RETURN) {
    *t = t_stop;
    m->t_stop = NAN; /* reaching it disarms it */
  }
  return COROT_OK;
}

/* Whether ARKODE took a state that cannot be evaluated for the end, where a shorter step helps: all
   of an explicit method's stages, and the end of the step of any. */
static bool too_long(const driver *d, int flag) {
  bool refused =
      flag == ARK_UNREC_RHSFUNC_ERR || flag == ARK_REPTD_RHSFUNC_ERR || flag == ARK_RHSFUNC_FAIL;
  return refused && !d->fatal && d->refusal[0] && d->refused == d->self->nst;
}

static corot_status advance(runge_kutta *m, double t_stop, double *t) {
  driver *d = &m->driver;
  double t_now = d->self->t, h = 0, least = 100 * DBL_EPSILON * fabs(t_now);
  int flag = ARK_SUCCESS;
  for (;;) {
    COROT_TRY(attempt(m, t_stop, t, &flag));
    if (!too_long(d, flag)) break;
    if (h == 0 && m->api->next_step(m->memory, &h)) return corot_driver_refuse(d, "statistics");
    h = fmin(h, t_stop - t_now) / 4;
    if (!(h > least && h > 1e-9 * d->longest && h >= d->self->def.min_step)) break;
    N_VScale(1, m->start.y, d->y);
    COROT_TRY(reset(m, h));
  }
  if (flag < 0) {
    N_VScale(1, m->start.y, d->y);
    /* ARKODE allocates its stages in the first step, and says only that its set-up failed. */
    if (flag == ARK_MEM_FAIL)
      return corot_fail(COROT_ENOMEM, "%s: no memory for the stages of a step",
                        d->self->ops->kind.name);
    return corot_driver_give_up(d, d->message);
  }
  corot_driver_watch(d, *t - t_now, *t == t_stop);
  return COROT_OK;
}

/* (v, M^-1 r) at an end: ARKODE has it at that of its last step, but shows it only through an
   interpolant of degree 2 or more, and evaluates r for one above 3. */
static corot_status find_rate(runge_kutta *m, rk_end *e, bool of_last_step) {
  driver *d = &m->driver;
  if (e->rate_known) return COROT_OK;
  if (of_last_step && m->order > 2) {
    if (m->api->interpolate(m->memory, e->t, 1, e->rate))
      return corot_driver_refuse(d, "interpolant");
  } else {
    m->nfe++;
    if (corot_driver_rhs(e->t, e->y, e->rate, d))
      return corot_driver_give_up(d, "in the state reached");
  }
  e->rate_known = true;
  return COROT_OK;
}

/* --- Inside a step --------------------------------------------------------------------------- */

void corot_rk_interpolate(const runge_kutta *m, double s, double *u, double *v) {
  const corot_integrator *self = m->driver.self;
  int n = corot_model_ndof(self->model);
  double h = m->end.t - m->start.t, r = 1 - s;
  const double *u0 = N_VGetArrayPointer(m->start.y), *u1 = N_VGetArrayPointer(m->end.y);
  const double *v0 = N_VGetArrayPointer(m->slope[0]), *a0 = v0 + n;
  const double *v1 = N_VGetArrayPointer(m->slope[1]), *a1 = v1 + n;

  /* of u1 - u0, h v, h^2 a, and their derivatives by s */
  double p = s * s * s * (10 - 15 * s + 6 * s * s), dp = 30 * s * s * r * r;
  double q0 = s * r * r * r * (1 + 3 * s), dq0 = r * r * (1 - 3 * s) * (1 + 5 * s);
  double q1 = -r * s * s * s * (1 + 3 * r), dq1 = s * s * (1 - 3 * r) * (1 + 5 * r);
  double k0 = s * s * r * r * r / 2, dk0 = s * r * r * (2 - 5 * s) / 2;
  double k1 = r * r * s * s * s / 2, dk1 = -r * s * s * (2 - 5 * r) / 2;
  for (int i = 0; u && i < n; i++)
    u[i] = u0[i] + p * (u1[i] - u0[i]) + h * (q0 * v0[i] + q1 * v1[i]) +
           h * h * (k0 * a0[i] + k1 * a1[i]);
  if (v && m->order <= 3) { /* cubic through v and a: (u1 - u0) / h has the error of u, over h */
    double w0 = r * r * (1 + 2 * s), w1 = s * s * (1 + 2 * r), b0 = s * r * r, b1 = -s * s * r;
    for (int i = 0; i < n; i++) v[i] = w0 * v0[i] + w1 * v1[i] + h * (b0 * a0[i] + b1 * a1[i]);
    return;
  }
  for (int i = 0; v && i < n; i++)
    v[i] = dp * (u1[i] - u0[i]) / h + dq0 * v0[i] + dq1 * v1[i] + h * (dk0 * a0[i] + dk1 * a1[i]);
}

/* The slopes at both ends as they stand, and whether they will do. */
static corot_status find_slopes(runge_kutta *m) {
  size_t n = corot_model_ndof(m->driver.self->model);
  for (int k = 0; k < 2; k++) {
    const rk_end *e = k ? &m->end : &m->start;
    double *slope = N_VGetArrayPointer(m->slope[k]);
    memcpy(slope, N_VGetArrayPointer(e->y) + n, n * sizeof *slope);
    memcpy(slope + n, N_VGetArrayPointer(e->rate) + n, n * sizeof *slope);
  }
  m->resolved = true;
  return m->stages.n ? corot_rk_resolves(m, &m->resolved) : COROT_OK;
}

/* Power of the state y at t; where that cannot be evaluated, at the end of the step. The energies
   that come with it are kept as those of their time if y is the solution there: a stage at the end
   of the step is not, nor the interpolant with other slopes. */
static corot_status find_power(runge_kutta *m, double t, N_Vector y, double *power) {
  driver *d = &m->driver;
  m->nfeQ++;
  if (corot_driver_work_rate(t, y, m->power, d) &&
      (d->fatal || corot_driver_work_rate(m->end.t, m->end.y, m->power, d)))
    return corot_driver_give_up(d, corot_error());
  if (y != m->start.y && y != m->end.y) d->self->t_energies = NAN;
  memcpy(power, N_VGetArrayPointer(m->power), 2 * sizeof *power);
  return COROT_OK;
}

static corot_status find_power_at(runge_kutta *m, rk_end *e, double *power) {
  if (!e->power_known) COROT_TRY(find_power(m, e->t, e->y, e->power));
  e->power_known = true;
  memcpy(power, e->power, sizeof e->power);
  return COROT_OK;
}

/* The interpolant, and the powers at Lobatto's points of it. Where nothing is cleared from its
   slopes its ends are those of the step. */
static corot_status look_inside(runge_kutta *m) {
  double *u = N_VGetArrayPointer(m->error), h = m->end.t - m->start.t;
  const lobatto_point *rule = corot_lobatto(m->npoint);
  if (!m->resolved) COROT_TRY(corot_rk_clear_slopes(m));
  for (int k = 0; k < m->npoint; k++) {
    bool at_end = k == 0 || k == m->npoint - 1;
    if (at_end && m->resolved) {
      COROT_TRY(find_power_at(m, k ? &m->end : &m->start, m->powers[k]));
      continue;
    }
    corot_rk_interpolate(m, rule[k].x, u, u + corot_model_ndof(m->driver.self->model));
    COROT_TRY(find_power(m, m->start.t + rule[k].x * h, m->error, m->powers[k]));
  }
  m->inside_known = true;
  return COROT_OK;
}

/* work += the power of a stage, times weight. */
static corot_status add_stage(runge_kutta *m, double t, N_Vector z, double weight, double *work) {
  double power[2];
  COROT_TRY(find_power(m, t, z, power));
  for (int c = 0; c < 2; c++) work[c] += weight * power[c];
  return COROT_OK;
}

/* The work integrals as components of the solution: the table's weights times the powers of its
   stages. Of constant forces that is their work to rounding, however stiff the body. */
static corot_status add_stages(runge_kutta *m, double *work) {
  rk_stages *s = &m->stages;
  double h = m->end.t - m->start.t;
  if (s->b_start != 0) COROT_TRY(add_stage(m, m->start.t, s->start, h * s->b_start, work));
  for (int k = 0; k < s->n; k++)
    if (s->b[k] != 0)
      COROT_TRY(add_stage(m, m->start.t + s->c[k] * h, corot_rk_stage(s, k), h * s->b[k], work));
  return COROT_OK;
}

/* How much more the supports carry in the state (u, v) at t than at the start of the step: with the
   powers, their work. */
static double carried_on(const runge_kutta *m, double t, const double *u, const double *v) {
  const corot_integrator *self = m->driver.self;
  const double *u0 = N_VGetArrayPointer(m->start.y);
  int n = corot_model_ndof(self->model);
  return corot_carried(self->model, self->state, t, u, v) -
         corot_carried(self->model, self->state, m->start.t, u0, u0 + n);
}

static double carried_in_step(const runge_kutta *m) {
  const double *u1 = N_VGetArrayPointer(m->end.y);
  return carried_on(m, m->end.t, u1, u1 + corot_model_ndof(m->driver.self->model));
}

/* Where the step resolves all that moves, the work is that along the interpolant, by Lobatto's
   rule, whose order is the method's or above; else that of the stages. */
static corot_status measure_work(runge_kutta *m) {
  double work[2] = {m->work_end[0], m->work_end[1]}, h = m->end.t - m->start.t;
  COROT_TRY(find_slopes(m));
  m->inside_known = false;
  bool rates = m->stages.n && (!m->resolved || m->order <= 2);
  if (rates) corot_rk_find_rates(m);
  if (m->resolved) {
    COROT_TRY(look_inside(m));
    for (int k = 0; k < m->npoint; k++)
      for (int c = 0; c < 2; c++)
        work[c] += corot_lobatto(m->npoint)[k].weight * h * m->powers[k][c];
  } else {
    COROT_TRY(add_stages(m, work));
  }
  work[1] += carried_in_step(m);
  if (rates) N_VScale(1, corot_rk_stage(&m->stages, m->stages.n - 1), m->stages.start);
  memcpy(m->work_start, m->work_end, sizeof work);
  memcpy(m->work_end, work, sizeof work);
  return COROT_OK;
}

corot_status corot_rk_at(corot_integrator *self, double t, double *u, double *v) {
  runge_kutta *m = self->method;
  int n = corot_model_ndof(self->model);
  if (t < m->end.t) {
    if (!m->inside_known) COROT_TRY(look_inside(m));
    corot_rk_interpolate(m, (t - m->start.t) / (m->end.t - m->start.t), u, v);
    return COROT_OK;
  }
  const double *y = N_VGetArrayPointer(m->end.y);
  if (u) memcpy(u, y, n * sizeof *u);
  if (v) memcpy(v, y + n, n * sizeof *v);
  return COROT_OK;
}

/* The work along the interpolant; what it lacks at the end of the step is spread over it. */
static void work_inside(runge_kutta *m, double part, double *work) {
  const lobatto_point *rule = corot_lobatto(m->npoint);
  double h = m->end.t - m->start.t, x[LOBATTO_MOST], *u = N_VGetArrayPointer(m->error);
  double *v = u + corot_model_ndof(m->driver.self->model);
  for (int k = 0; k < m->npoint; k++) x[k] = rule[k].x;
  corot_rk_interpolate(m, part, u, v);
  double carried[2][2] = {{0, carried_on(m, m->start.t + part * h, u, v)}, /* there, at the end */
                          {0, carried_in_step(m)}};
  for (int c = 0; c < 2; c++) {
    double all = carried[1][c], sum = carried[0][c];
    for (int k = 0; k < m->npoint; k++) {
      all += h * rule[k].weight * m->powers[k][c];
      sum += h * corot_lagrange_integral(m->npoint, x, k, 0, part) * m->powers[k][c];
    }
    work[c] = m->work_start[c] + sum + part * (m->work_end[c] - m->work_start[c] - all);
  }
}

corot_status corot_rk_work(corot_integrator *self, double t, double *dissipated, double *external) {
  runge_kutta *m = self->method;
  double work[2] = {m->work_end[0], m->work_end[1]};
  if (t < m->end.t) {
    if (!m->inside_known) COROT_TRY(look_inside(m));
    work_inside(m, (t - m->start.t) / (m->end.t - m->start.t), work);
  }
  *dissipated = work[0];
  *external = work[1];
  return COROT_OK;
}

/* --- The operations -------------------------------------------------------------------------- */

/* From m->start to m->end. */
static corot_status cross(runge_kutta *m, double t_stop) {
  driver *d = &m->driver;
  double h = m->first_step; /* not known before the first step */
  if (h == 0) COROT_TRY(usual_step(m, &h));
  t_stop = corot_integrator_sight(d->self, h, t_stop);
  if (m->stale) COROT_TRY(begin_afresh(m));
  COROT_TRY(find_rate(m, &m->start, false));
  COROT_TRY(advance(m, t_stop, &m->end.t));
  m->begin = 0;
  N_VScale(1, d->y, m->end.y);
  m->end.rate_known = m->end.power_known = false;
  if (m->api->local_errors(m->memory, m->error) || m->api->error_weights(m->memory, m->weight))
    return corot_driver_refuse(d, "statistics");
  return find_rate(m, &m->end, true);
}

/* The force [n] of the loads at the end of the last step. */
static corot_status note_loads(runge_kutta *m, double *force) {
  driver *d = &m->driver;
  const double *y = N_VGetArrayPointer(m->end.y), *v = y + corot_model_ndof(d->self->model);
  corot_status status = corot_force_of_loads(d->self->model, d->self->state, m->end.t, y, v, force);
  if (corot_driver_answer(d, status)) return corot_driver_give_up(d, "in the state reached");
  return COROT_OK;
}

corot_status corot_rk_step(corot_integrator *self, double t_stop, corot_step *step) {
  runge_kutta *m = self->method;
  driver *d = &m->driver;
  COROT_TRY(corot_driver_check(d));
  if (m->limit && corot_driver_answer(d, corot_explicit_limit_follow(m->limit, self->t,
                                                                     N_VGetArrayPointer(d->y))) < 0)
    return corot_driver_give_up(d, "the stable step");
  rk_end before = m->start;
  m->start = m->end;
  m->start.t = self->t; /* which may have moved on by rounding */
  m->end = before;
  corot_status status = cross(m, t_stop);
  double error = status ? 0 : N_VWrmsNorm(m->error, m->weight);
  if (!status) status = measure_work(m);
  long nni = 0;
  if (!status && m->api->nni && m->api->nni(m->memory, &nni))
    status = corot_driver_refuse(d, "statistics");
  if (!status && self->seen.inputs) status = note_loads(m, N_VGetArrayPointer(m->load));
  m->fresh = status != COROT_OK;
  if (status) { /* of the step before only its end is left */
    m->end = m->start;
    m->start = before;
    N_VScale(1, m->end.y, d->y);
    m->stale = true;
    self->before = self->t;
    return status;
  }
  *step =
      (corot_step){.t = m->end.t, .order = m->order, .error = error, .newton = (int)(nni - m->nni)};
  m->nni = nni;
  return COROT_OK;
}

/* A method of one step has no history to lose but its interpolant: all it needs is r anew, which
   it gets before the next step. */
corot_status corot_rk_changed(corot_integrator *self, corot_history history) {
  runge_kutta *m = self->method;
  if (self->nst == 0) return COROT_OK;
  m->stale = true;
  m->end.rate_known = m->end.power_known = false;
  if (history != COROT_HISTORY_RESTART || self->before == self->t) return COROT_OK;
  m->first_step = self->def.first_step;
  m->nrestart++;
  m->driver.collapsed = false;
  self->before = self->t;
  return COROT_OK;
}

/* The first stage goes by the rate at the end of the last step: where this is as it was, to a
   hundredth of the tolerance in a step, there is nothing to begin. */
corot_status corot_rk_loaded(corot_integrator *self, corot_history history) {
  runge_kutta *m = self->method;
  int n = corot_model_ndof(self->model);
  double *old = N_VGetArrayPointer(m->load), *now = old + n;
  double *du = N_VGetArrayPointer(m->error), *dv = du + n, usual = 0;
  if (self->nst == 0 || m->stale || self->before == self->t || history == COROT_HISTORY_RESTART)
    return corot_rk_changed(self, history);
  COROT_TRY(note_loads(m, now));
  for (int i = 0; i < n; i++) du[i] = 0, dv[i] = now[i] - old[i];
  COROT_TRY(corot_mass_solve(self->mass, dv, dv));
  memcpy(old, now, n * sizeof *old);
  if (m->api->next_step(m->memory, &usual)) return corot_driver_refuse(&m->driver, "statistics");
  if (!(usual * N_VWrmsNorm(m->error, m->weight) < 0.01)) return corot_rk_changed(self, history);
  m->end.power_known = false;
  return COROT_OK;
}

/* The shorter step that a kink may ask for goes by the factor there is. */
corot_status corot_rk_settle(corot_integrator *self) {
  runge_kutta *m = self->method;
  if (!m->stale) return COROT_OK;
  rk_end before = m->start;
  m->start = m->end;
  m->start.t = self->t;
  corot_status status = begin_afresh(m);
  m->end = m->start;
  m->start = before;
  return status;
}

void corot_rk_exchange(corot_integrator *self, pack *p) {
  runge_kutta *m = self->method;
  double h = 0;
  if (!p->reading && !p->status) p->status = usual_step(m, &h);
  corot_pack_double(p, &h);
  corot_pack_doubles(p, m->work_end, 2);
  corot_pack_double(p, &m->driver.longest);
  corot_pack_bool(p, &m->resolved);
  if (m->limit) corot_explicit_limit_exchange(p, m->limit);
  if (!p->reading || p->status || !(h > 0)) return;
  m->begin = h;
  if (m->api->set_first_step(m->memory, h)) p->status = corot_driver_refuse(&m->driver, "set-up");
}

void corot_rk_statistics(const corot_integrator *self, corot_statistics *s) {
  const runge_kutta *m = self->method;
  const struct {
    rk_count *get;
    long *count;
  } counts[] = {{m->api->nfe, &s->nfe},
                {m->api->netf, &s->netf},
                {m->api->nsetups, &s->nsetups},
                {m->api->nni, &s->nni},
                {m->api->ncfn, &s->ncfn}};
  for (size_t k = 0; k < sizeof counts / sizeof *counts; k++)
    if (counts[k].get && counts[k].get(m->memory, counts[k].count)) *counts[k].count = 0;
  s->nfe += m->nfe;
  s->nfeQ = m->nfeQ;
  s->nrestart = m->nrestart;
}
