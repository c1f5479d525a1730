/* SUNDIALS before 6.6.1 has a defect: after a stop time has been reached by a call whose tout
   equals it, the next call returns at once without advancing. advance() takes single steps, and its
   tout always lies beyond the stop time. */
#include "multistep.h"

#include <float.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdlib.h>
#include <string.h>

corot_status corot_multistep_open(multistep *m, corot_integrator *self, const multistep_api *api,
                                  const double *u, const double *v) {
  m->api = api;
  m->t_stop = NAN;
  m->t_last = self->t;
  COROT_TRY(corot_driver_open(&m->driver, self, u, v));
  m->work = N_VNew_Serial(2, m->driver.ctx);
  m->error = N_VClone(m->driver.y);
  m->weight = N_VClone(m->driver.y);
  m->scratch = N_VClone(m->driver.y);
  if (!m->work || !m->error || !m->weight || !m->scratch)
    return corot_fail(COROT_ENOMEM, "no memory for %s on %d unknowns", self->ops->kind.name,
                      2 * corot_model_ndof(self->model));
  N_VConst(0, m->work);
  return corot_multistep_open_ledger(m);
}

void corot_multistep_close(multistep *m) {
  N_Vector const vectors[] = {m->rate, m->error, m->weight, m->scratch, m->work};
  for (int k = 0; k < 5; k++)
    if (vectors[k]) N_VDestroy(vectors[k]);
  corot_multistep_close_ledger(&m->ledger);
  corot_driver_close(&m->driver);
  free(m);
}

/* Counts since the last start are added to `s`. False: SUNDIALS does not tell. */
static bool add_counts(const multistep *m, corot_statistics *s) {
  const struct {
    multistep_count *get;
    long *sum;
  } counts[] = {{m->api->nfe, &s->nfe}, {m->api->nsetups, &s->nsetups}, {m->api->netf, &s->netf},
                {m->api->nni, &s->nni}, {m->api->ncfn, &s->ncfn},       {m->api->nfeQ, &s->nfeQ}};
  bool told = true;
  for (size_t k = 0; k < sizeof counts / sizeof *counts; k++) {
    long count = 0;
    told = counts[k].get(m->memory, &count) == 0 && told;
    *counts[k].sum += count;
  }
  return told;
}

/* Begins again at order 1, with a first step of h; 0: as SUNDIALS chooses. */
static corot_status begin_again(multistep *m, double h) {
  corot_integrator *self = m->driver.self;
  if (!add_counts(m, &m->before)) return corot_driver_refuse(&m->driver, "statistics");
  m->nni = 0;
  m->ledger.broken = true;
  m->t_stop = NAN;
  m->t_last = self->t;
  m->driver.collapsed = false;
  self->before = self->t;
  if (m->api->restart(m) || m->api->restart_work(m->memory, m->work) ||
      m->api->set_first_step(m->memory, h))
    return corot_driver_refuse(&m->driver, "restart");
  return COROT_OK;
}

/* Sets *t_stop to where the next step must stop. */
static corot_status look_ahead(multistep *m, double *t_stop) {
  const corot_integrator *self = m->driver.self;
  double h = 0; /* not known after a start */
  if (self->before < self->t && m->api->next_step(m->memory, &h))
    return corot_driver_refuse(&m->driver, "statistics");
  double sight = corot_integrator_sight(self, h, *t_stop);
  bool sets_out = corot_sets_out(self->t, h, sight, *t_stop);
  *t_stop = sight;
  if (!sets_out) return COROT_OK;
  m->before.nrestart++;
  return begin_again(m, self->def.first_step);
}

static corot_status advance(multistep *m, double t_stop, double *t) {
  driver *d = &m->driver;
  COROT_TRY(look_ahead(m, &t_stop));
  if (t_stop != m->t_stop && m->api->set_stop_time(m->memory, t_stop))
    return corot_driver_refuse(d, "stop time");
  m->t_stop = t_stop;
  double beyond = t_stop + (t_stop - d->self->t);
  d->message[0] = 0;
  int flag = m->api->advance(m, beyond, t);
  if (flag < 0) return corot_driver_give_up(d, d->message);
  if (flag == m->api->stopped) {
    *t = t_stop;
    m->t_stop = NAN; /* reaching it disarms it */
  }
  corot_driver_watch(d, *t - d->self->t, *t == t_stop);
  return COROT_OK;
}

corot_status corot_multistep_step(corot_integrator *self, double t_stop, corot_step *step) {
  multistep *m = self->method;
  const multistep_api *api = m->api;
  double t;
  long nni = 0;
  COROT_TRY(corot_driver_check(&m->driver));
  COROT_TRY(advance(m, t_stop, &t));
  if (api->nni(m->memory, &nni) || api->last_order(m->memory, &step->order) ||
      api->local_errors(m->memory, m->error) || api->error_weights(m->memory, m->weight))
    return corot_driver_refuse(&m->driver, "statistics");
  step->error = N_VWrmsNorm(m->error, m->weight);
  m->ledger.t_start = m->t_last;
  step->t = m->t_last = t;
  COROT_TRY(corot_multistep_measure_work(m, step->order));
  step->newton = (int)(nni - m->nni);
  m->nni = nni;
  return COROT_OK;
}

corot_status corot_multistep_at(corot_integrator *self, double t, double *u, double *v) {
  multistep *m = self->method;
  int n = corot_model_ndof(self->model);
  N_Vector y = m->driver.y;
  if (t < m->t_last) {
    y = m->error;
    if (m->api->interpolate(m->memory, t, 0, y))
      return corot_driver_refuse(&m->driver, "interpolant");
  }
  if (u) memcpy(u, N_VGetArrayPointer(y), n * sizeof *u);
  if (v) memcpy(v, N_VGetArrayPointer(y) + n, n * sizeof *v);
  return COROT_OK;
}

/* m->error = the jump of the derivative, from the interpolant's to the new right-hand side's. */
static corot_status derivative_jump(multistep *m) {
  N_Vector now = m->error, old = m->scratch;
  m->before.nfe++;
  driver *d = &m->driver;
  if (corot_driver_rhs(d->self->t, d->y, now, d))
    return corot_driver_give_up(d, "after a change of r");
  if (m->api->interpolate(m->memory, m->t_last, 1, old) ||
      m->api->error_weights(m->memory, m->weight))
    return corot_driver_refuse(d, "interpolant");
  N_VLinearSum(1, now, -1, old, now);
  return COROT_OK;
}

/* The same where only the loads have jumped: no tet is asked. */
static corot_status load_jump(multistep *m) {
  const corot_integrator *self = m->driver.self;
  int n = corot_model_ndof(self->model);
  double *du = N_VGetArrayPointer(m->error), *dv = du + n;
  COROT_TRY(corot_multistep_reload(m, dv));
  COROT_TRY(corot_mass_solve(self->mass, dv, dv));
  memset(du, 0, n * sizeof *du);
  if (m->api->error_weights(m->memory, m->weight))
    return corot_driver_refuse(&m->driver, "error weights");
  return COROT_OK;
}

/* Whether the next step turns the jump in m->error into less than half the tolerance; if not, *h is
   a first step that does. */
static corot_status is_felt(multistep *m, bool *felt, double *h) {
  const corot_integrator *self = m->driver.self;
  double h_last = 0, h_next = 0;
  if (m->api->last_step(m->memory, &h_last) || m->api->next_step(m->memory, &h_next))
    return corot_driver_refuse(&m->driver, "statistics");
  return corot_sun_felt(self->pencil, m->error, m->weight, self->t, h_last, h_next, felt, h);
}

/* A jump that is not felt is left to error control; otherwise the method begins again. Where it has
   not taken a step since it began, it forgets only what it knew of r. */
corot_status corot_multistep_changed(corot_integrator *self, corot_history history) {
  multistep *m = self->method;
  double h = self->def.first_step;
  bool felt = true;
  if (history == COROT_HISTORY_KEEP && !self->seen.inputs) return COROT_OK;
  m->ledger.broken = true;
  if (history == COROT_HISTORY_KEEP) return COROT_OK;
  if (self->before == self->t) return begin_again(m, h);
  if (history == COROT_HISTORY_AUTO) {
    COROT_TRY(derivative_jump(m));
    COROT_TRY(is_felt(m, &felt, &h));
  }
  if (!felt) return COROT_OK;
  m->before.nrestart++;
  return begin_again(m, h);
}

corot_status corot_multistep_loaded(corot_integrator *self, corot_history history) {
  multistep *m = self->method;
  double h = self->def.first_step;
  bool felt = history == COROT_HISTORY_RESTART;
  if (m->ledger.broken || self->before == self->t) return corot_multistep_changed(self, history);
  COROT_TRY(load_jump(m));
  if (history == COROT_HISTORY_AUTO) COROT_TRY(is_felt(m, &felt, &h));
  if (!felt) return COROT_OK;
  m->before.nrestart++;
  return begin_again(m, h);
}

/* The history of the solution is not among it: SUNDIALS does not take one in. */
void corot_multistep_exchange(corot_integrator *self, pack *p) {
  multistep *m = self->method;
  corot_pack_doubles(p, m->ledger.work_end, 2);
  corot_pack_double(p, &m->driver.longest);
}

void corot_multistep_statistics(const corot_integrator *self, corot_statistics *s) {
  const multistep *m = self->method;
  const corot_statistics *b = &m->before;
  s->nfe = b->nfe, s->nsetups = b->nsetups, s->netf = b->netf, s->nni = b->nni, s->ncfn = b->ncfn;
  s->nfeQ = b->nfeQ, s->nrestart = b->nrestart;
  (void)add_counts(m, s); /* what is not told stays as it was before the last start */
}
