/* The ledger of multistep methods: what the loads and the moving supports put into the body, and
   what dissipates.

   A method of this kind makes of each step a polynomial through u, and the work of the loads is
   that along it. With Lobatto's rule, and the polynomial through u at its points,

     W = sum_k w_k f(t_k, u_k) . u'(t_k),

   which takes the changes of u alone: for two points it is (f_0 + f_1) / 2 . (u_1 - u_0). A
   constant force has its work to rounding so, and a step of any length through equilibria has that
   which the elastic energy gains. The velocities at the ends would not do: those of a stiff body
   are what the last step went by, and a quadrature within SUNDIALS, which takes the powers there,
   sums a ramp in one step of order 1 to twice its work.

   Of what dissipates, and of the supports, a power takes an evaluation of all tets. While the step
   resolves the motion, such that the velocities at its ends tell how far it went, the powers there
   are enough: the polynomial through the latest of them, as many as the order, is integrated
   (Adams and Moulton's rule). Where they do not tell, or r has jumped, or at order 1, the powers
   are evaluated along the path, at Lobatto's points with the velocities of the path itself.

   The forces on a support have in them what Newton's iteration left of u, times the stiffness. Of
   supports that move as one their work is therefore the change of the momentum they carry. */
#include <math.h>
#include <nvector/nvector_serial.h>
#include <string.h>

#include "core/model/load_force.h"
#include "multistep.h"
#include "solve/pencil/wall_clock.h"

enum { DISSIPATED, EXTERNAL, NWORK };

corot_status corot_multistep_open_ledger(multistep *m) {
  multistep_ledger *l = &m->ledger;
  l->start = N_VClone(m->driver.y);
  l->end = N_VClone(m->driver.y);
  l->loads = N_VClone(m->driver.y);
  l->room = N_VClone(m->driver.y);
  if (!l->start || !l->end || !l->loads || !l->room)
    return corot_fail(COROT_ENOMEM, "no memory for the ledger of %s",
                      m->driver.self->ops->kind.name);
  N_VScale(1, m->driver.y, l->end);
  l->load_start = N_VGetArrayPointer(l->loads);
  l->load_end = l->load_start + corot_model_ndof(m->driver.self->model);
  l->broken = true;
  return COROT_OK;
}

void corot_multistep_close_ledger(multistep_ledger *l) {
  if (l->start) N_VDestroy(l->start);
  if (l->end) N_VDestroy(l->end);
  if (l->loads) N_VDestroy(l->loads);
  if (l->room) N_VDestroy(l->room);
}

/* --- The loads ------------------------------------------------------------------------------- */

/* Points of Lobatto's rule from the start of the last step to t. */
typedef struct path {
  int n;
  double t[LOBATTO_MOST];
  const double *u[LOBATTO_MOST]; /* [2 ndof] and velocity */
} path;

static corot_status find_path(multistep *m, double t, int npoint, path *p) {
  const multistep_ledger *l = &m->ledger;
  const lobatto_point *rule = corot_lobatto(npoint);
  N_Vector room[] = {m->error, m->scratch, m->weight};
  p->n = npoint;
  p->t[0] = l->t_start, p->u[0] = N_VGetArrayPointer(l->start);
  for (int k = 1; k < npoint; k++) {
    bool at_end = k == npoint - 1;
    p->t[k] = at_end ? t : l->t_start + rule[k].x * (t - l->t_start);
    N_Vector y = at_end && t == m->t_last ? l->end : room[k - 1];
    if (y != l->end && m->api->interpolate(m->memory, p->t[k], 0, y))
      return corot_driver_refuse(&m->driver, "interpolant");
    p->u[k] = N_VGetArrayPointer(y);
  }
  return COROT_OK;
}

/* The mean of two forces [n] along the way from u0 to u1. */
static double mean_along(int n, const double *f0, const double *f1, const double *u0,
                         const double *u1) {
  double sum = 0;
  for (int i = 0; i < n; i++) sum += (f0[i] + f1[i]) * (u1[i] - u0[i]);
  return 0.5 * sum;
}

/* The force [n] along the slope of the path at its k-th point, times the weight of that. */
static double along_slope(int n, const double *f, const path *p, int k) {
  const lobatto_point *rule = corot_lobatto(p->n);
  double x[LOBATTO_MOST], slope[LOBATTO_MOST], sum = 0;
  for (int j = 0; j < p->n; j++) x[j] = rule[j].x;
  for (int j = 0; j < p->n; j++) slope[j] = rule[k].weight * corot_lagrange_slope(p->n, x, j, k);
  for (int i = 0; i < n; i++) {
    double rate = 0;
    for (int j = 1; j < p->n; j++) rate += slope[j] * (p->u[j][i] - p->u[0][i]);
    sum += f[i] * rate;
  }
  return sum;
}

/* load [n] = the force of the loads in the state y at t; where a feedback cannot be evaluated,
   which it can be at the ends of the step, that of its start. */
static corot_status find_load(const multistep *m, double t, const double *y, double *load) {
  const corot_integrator *self = m->driver.self;
  int n = corot_model_ndof(self->model);
  corot_status status = corot_force_of_loads(self->model, self->state, t, y, y + n, load);
  if (sun_is_fatal(status)) return status;
  if (status && load != m->ledger.load_start) memcpy(load, m->ledger.load_start, n * sizeof *load);
  return COROT_OK;
}

/* *work = that of the loads from the start of the last step to t, where their force is `load` in
   the end. */
static corot_status work_of_loads(multistep *m, double t, int order, double *load, double *work) {
  const corot_integrator *self = m->driver.self;
  const double *load_start = m->ledger.load_start;
  int n = corot_model_ndof(self->model), npoint = corot_lobatto_points(order);
  double sum = 0;
  path p;
  COROT_TRY(find_path(m, t, npoint, &p));
  if (npoint > 2) sum = along_slope(n, load_start, &p, 0);
  for (int k = 1; k < npoint; k++) {
    COROT_TRY(find_load(m, p.t[k], p.u[k], load));
    if (npoint > 2) sum += along_slope(n, load, &p, k);
  }
  *work = npoint > 2 ? sum : mean_along(n, load_start, load, p.u[0], p.u[1]);
  return COROT_OK;
}

/* --- Powers ---------------------------------------------------------------------------------- */

/* Whether the velocities at the ends of the last step tell how far it went: to a tenth, or to a
   hundredth of the tolerance, by their mean. A vibration of w h = 1 is a tenth off. */
static bool is_resolved(const multistep *m, double h) {
  const multistep_ledger *l = &m->ledger;
  int n = corot_model_ndof(m->driver.self->model);
  const double *u0 = N_VGetArrayPointer(l->start), *v0 = u0 + n;
  const double *u1 = N_VGetArrayPointer(l->end), *v1 = u1 + n;
  double off = 0, all = 0, weight = n > 0 ? N_VGetArrayPointer(m->weight)[0] : 0;
  for (int i = 0; i < n; i++) {
    double du = u1[i] - u0[i], e = du - 0.5 * h * (v0[i] + v1[i]);
    off += e * e;
    all += du * du;
  }
  return off <= 0.01 * all || weight * sqrt(off / n) <= 0.01;
}

/* The powers along the path at t, with its own velocities. Where they cannot be evaluated, those at
   the end of the step, which can. */
static corot_status find_power(multistep *m, double t, bool at_start, multistep_power *power) {
  driver *d = &m->driver;
  const corot_integrator *self = d->self;
  size_t n = corot_model_ndof(self->model);
  double *u = N_VGetArrayPointer(m->scratch), *rate = N_VGetArrayPointer(m->error);
  corot_energies e;
  if (m->api->interpolate(m->memory, t, 0, m->scratch) ||
      m->api->interpolate(m->memory, t, 1, m->error))
    return corot_driver_refuse(d, "interpolant");
  if (at_start) memcpy(u, N_VGetArrayPointer(m->ledger.start), n * sizeof *u);
  m->before.nfeQ++;
  corot_status status = corot_energy(self->model, self->state, t, u, rate, &e);
  if (sun_is_fatal(status)) return status;
  if (status) e = self->energies;
  *power = (multistep_power){t, e.power_dissipated, e.power_carried};
  return COROT_OK;
}

static corot_status find_powers_along_path(multistep *m, int order) {
  multistep_ledger *l = &m->ledger;
  int npoint = corot_lobatto_points(order);
  const lobatto_point *rule = corot_lobatto(npoint);
  for (int k = 0; k < npoint - 1; k++) {
    double t = l->t_start + rule[k].x * (m->t_last - l->t_start);
    COROT_TRY(find_power(m, t, k == 0, &l->inside[k]));
  }
  l->inside[npoint - 1] = l->power[0];
  l->ninside = npoint;
  return COROT_OK;
}

/* The power at the end of the last step, which SUNDIALS has asked for, goes before the others. */
static void add_end(multistep *m) {
  multistep_ledger *l = &m->ledger;
  const corot_energies *e = &m->driver.self->energies;
  if (l->npower == LOBATTO_MOST) l->npower--;
  memmove(l->power + 1, l->power, l->npower * sizeof *l->power);
  l->power[0] = (multistep_power){m->t_last, e->power_dissipated, e->power_carried};
  l->npower++;
}

/* Adds to `work` the integrals of the powers from the start of the last step to t. */
static void add_powers(const multistep *m, double t, double work[NWORK]) {
  const multistep_ledger *l = &m->ledger;
  double x[LOBATTO_MOST], h = m->t_last - l->t_start;
  for (int k = 0; k < l->ninside; k++) x[k] = (l->inside[k].t - l->t_start) / h;
  for (int k = 0; k < l->ninside; k++) {
    double part = h * corot_lagrange_integral(l->ninside, x, k, 0, (t - l->t_start) / h);
    work[DISSIPATED] += part * l->inside[k].dissipated;
    work[EXTERNAL] += part * l->inside[k].supports;
  }
}

/* What the end of the path to t, where y is, has above its start of what the supports carry: with
   the powers, their work. */
static double carried_on(const multistep *m, double t, N_Vector y) {
  const corot_integrator *self = m->driver.self;
  const multistep_ledger *l = &m->ledger;
  const double *u0 = N_VGetArrayPointer(l->start), *u1 = N_VGetArrayPointer(y);
  int n = corot_model_ndof(self->model);
  return corot_carried(self->model, self->state, t, u1, u1 + n) -
         corot_carried(self->model, self->state, l->t_start, u0, u0 + n);
}

/* --- A step ---------------------------------------------------------------------------------- */

static void turn_page(multistep *m) {
  multistep_ledger *l = &m->ledger;
  N_Vector y = l->start;
  double *load = l->load_start;
  l->start = l->end, l->end = y;
  l->load_start = l->load_end, l->load_end = load;
  N_VScale(1, m->driver.y, l->end);
  memcpy(l->work_start, l->work_end, sizeof l->work_start);
}

corot_status corot_multistep_measure_work(multistep *m, int order) {
  multistep_ledger *l = &m->ledger;
  corot_integrator *self = m->driver.self;
  double started = clock_wall(), work[NWORK] = {l->work_end[0], l->work_end[1]}, loads;
  /* the step before is over; after a break its powers tell nothing */
  turn_page(m);
  if (l->broken) {
    l->npower = 0;
    COROT_TRY(find_load(m, l->t_start, N_VGetArrayPointer(l->start), l->load_start));
  }
  /* powers: those at the ends of the last steps, or where they do not tell, along the path */
  add_end(m);
  if (order == 1 || l->broken || !is_resolved(m, m->t_last - l->t_start)) {
    l->npower = 1;
    COROT_TRY(find_powers_along_path(m, order));
  } else {
    l->ninside = order < l->npower ? order : l->npower;
    memcpy(l->inside, l->power, l->ninside * sizeof *l->inside);
  }
  /* work: of the loads along the path, of the rest by its powers */
  COROT_TRY(work_of_loads(m, m->t_last, order, l->load_end, &loads));
  add_powers(m, m->t_last, work);
  work[EXTERNAL] += loads + carried_on(m, m->t_last, l->end);
  memcpy(l->work_end, work, sizeof work);
  l->broken = false;
  self->work_s += clock_wall() - started;
  return COROT_OK;
}

corot_status corot_multistep_reload(multistep *m, double *jump) {
  multistep_ledger *l = &m->ledger;
  driver *d = &m->driver;
  const corot_integrator *self = d->self;
  const double *y = N_VGetArrayPointer(l->end);
  int n = corot_model_ndof(self->model);
  for (int i = 0; i < n; i++) jump[i] = -l->load_end[i];
  if (corot_driver_answer(
          d, corot_force_of_loads(self->model, self->state, m->t_last, y, y + n, l->load_end)))
    return corot_driver_give_up(d, "after a change of the inputs");
  for (int i = 0; i < n; i++) jump[i] += l->load_end[i];
  if (l->npower > 1) l->npower = 1; /* powers have a kink there */
  return COROT_OK;
}

corot_status corot_multistep_work(corot_integrator *self, double t, double *dissipated,
                                  double *external) {
  multistep *m = self->method;
  multistep_ledger *l = &m->ledger;
  double work[NWORK] = {l->work_end[0], l->work_end[1]}, loads;
  if (t < m->t_last) {
    double *load = N_VGetArrayPointer(l->room);
    memcpy(work, l->work_start, sizeof work);
    COROT_TRY(work_of_loads(m, t, self->qlast, load, &loads));
    add_powers(m, t, work);
    if (m->api->interpolate(m->memory, t, 0, m->error))
      return corot_driver_refuse(&m->driver, "interpolant");
    work[EXTERNAL] += loads + carried_on(m, t, m->error);
  }
  *dissipated = work[DISSIPATED];
  *external = work[EXTERNAL];
  return COROT_OK;
}
