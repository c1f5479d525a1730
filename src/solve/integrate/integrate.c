/* What every method of integration has in common: definition, choices, dispatch. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/base/names.h"
#include "core/base/sized.h"
#include "core/ode/state.h"
#include "integrator.h"
#include "solve/pencil/wall_clock.h"
#include "solve/sundials/vector.h"

void corot_integrator_set_defaults(corot_integrator_def *def, size_t bytes) {
  const corot_integrator_def ours = {.method = "cvode",
                                     .linear = corot_linear_defaults(),
                                     .rtol = 1e-4,
                                     .predictor = -1,
                                     .tangent = COROT_TANGENT_AUTO,
                                     .newton_tolerance = 1e-9,
                                     .newton_iterations = 50,
                                     .spectral_radius = 0.8};
  corot_sized_fill(def, bytes, &ours, sizeof ours);
}

static const integrator_ops *const controlled[] = {&corot_integrator_cvode, &corot_integrator_ida,
                                                   &corot_integrator_arkode, &corot_integrator_erk};

enum { NCONTROLLED = sizeof controlled / sizeof *controlled };

/* NULL beyond the last. */
static const integrator_ops *method_at(int i) {
  if (i < 0) return NULL;
  if (i < NCONTROLLED) return controlled[i];
  for (const integrator_ops *o = corot_integrators_fixed; o->kind.name; o++)
    if (i-- == NCONTROLLED) return o;
  return NULL;
}

static const integrator_ops *method_of(const char *name) {
  const integrator_ops *o = NULL;
  for (int i = 0; name && (o = method_at(i)); i++)
    if (strcmp(name, o->kind.name) == 0) break;
  return o;
}

const corot_method_kind *corot_method_at(int i) {
  const integrator_ops *o = method_at(i);
  return o ? &o->kind : NULL;
}

const corot_method_kind *corot_method_traits(const char *name) {
  const integrator_ops *o = method_of(name);
  return o ? &o->kind : NULL;
}

bool corot_integrator_controls_error(const char *method) {
  const corot_method_kind *kind = corot_method_traits(method);
  return kind && kind->controls_error;
}

static const char *name_of(int i) { return method_at(i) ? method_at(i)->kind.name : NULL; }

static corot_status find_method(const char *name, const integrator_ops **ops) {
  char all[NAMES_SIZE];
  *ops = method_of(name);
  if (*ops) return COROT_OK;
  return corot_fail(COROT_EINVAL, "no integrator '%s': %s", name ? name : "",
                    names_list(name_of, all));
}

static corot_status check(const corot_integrator_def *d) {
  const struct {
    const char *name;
    double value;
    bool zero; /* stands for "choose" or "none" */
  } number[] = {
      {"rtol", d->rtol, false},
      {"atol_displacement", d->atol_displacement, true},
      {"atol_velocity", d->atol_velocity, true},
      {"first_step", d->first_step, true},
      {"min_step", d->min_step, true},
      {"max_step", d->max_step, true},
      {"gamma_change", d->gamma_change, true},
      {"reassembly", d->reassembly, true},
      {"refactorisation", d->refactorisation, true},
      {"convergence", d->convergence, true},
      {"max_steps", (double)d->max_steps, true},
      {"step", d->step, true},
      {"newton_tolerance", d->newton_tolerance, false},
      {"newton_iterations", d->newton_iterations, false},
  };
  for (size_t k = 0; k < sizeof number / sizeof *number; k++)
    if (!(number[k].value > 0 || (number[k].zero && number[k].value == 0)) ||
        !isfinite(number[k].value))
      return corot_fail(COROT_EINVAL, "integrator: %s = %g is not positive%s and finite",
                        number[k].name, number[k].value, number[k].zero ? ", or 0," : "");
  if (d->max_order < 0 || d->max_order > 5)
    return corot_fail(COROT_EINVAL, "integrator: max_order = %d is not in 1 to 5 (0: choose)",
                      d->max_order);
  if (d->max_step > 0 && d->min_step > d->max_step)
    return corot_fail(COROT_EINVAL, "integrator: min_step = %g exceeds max_step = %g", d->min_step,
                      d->max_step);
  if (d->tangent < COROT_TANGENT_AUTO || d->tangent > COROT_TANGENT_CLAMPED)
    return corot_fail(COROT_EINVAL, "integrator: tangent = %d is none", (int)d->tangent);
  return COROT_OK;
}

static corot_status check_start(double t, int n, const double *u, const double *v) {
  if (!isfinite(t)) return corot_fail(COROT_EINVAL, "integrator: cannot start at t = %g", t);
  for (int i = 0; i < n; i++)
    if (!isfinite(u[i]) || !isfinite(v[i]))
      return corot_fail(COROT_EINVAL, "integrator: at the start u[%d] = %g, v[%d] = %g", i, u[i], i,
                        v[i]);
  return COROT_OK;
}

/* What the definition leaves open of what `advice` has; the rest is the method's own. */
static void take(corot_integrator_def *d, const corot_sun_advice *a) {
  if (d->max_order == 0) d->max_order = a->max_order;
  if (d->tangent == COROT_TANGENT_AUTO) d->tangent = a->tangent;
  if (d->reassembly == 0) d->reassembly = a->reassembly;
  if (d->refactorisation == 0) d->refactorisation = a->refactorisation;
  if (d->gamma_change == 0) d->gamma_change = a->gamma_change;
  if (d->convergence == 0) d->convergence = a->convergence;
}

void corot_integrator_take_advice(corot_integrator *self, corot_sun_method method) {
  corot_sun_advice a = corot_advise(self->model, method, self->def.rtol, self->def.max_step,
                                    corot_model_moves(self->model) || self->seen.moves);
  take(&self->def, &a);
}

static void choose(corot_integrator *self) {
  corot_integrator_def *d = &self->def;
  if (d->atol_displacement == 0)
    d->atol_displacement = 0.01 * d->rtol * corot_model_length(self->model);
  if (d->atol_velocity == 0)
    d->atol_velocity = d->atol_displacement * corot_model_frequency(self->model);
  self->ops->choose(self);
}

corot_status corot_integrator_create(const corot_integrator_def *def, const corot_model *model,
                                     corot_state *state, double t, const double *u, const double *v,
                                     corot_integrator **integrator) {
  const integrator_ops *ops;
  COROT_TRY(COROT_DEFINED(def, corot_integrator_def));
  COROT_TRY(COROT_GIVEN(u));
  COROT_TRY(COROT_GIVEN(v));
  COROT_TRY(COROT_GIVEN(integrator));
  COROT_TRY(corot_state_check(model, state, "corot_integrator_create"));
  COROT_TRY(check(def));
  COROT_TRY(find_method(def->method, &ops));
  COROT_TRY(check_start(t, corot_model_ndof(model), u, v));
  corot_integrator *self = calloc(1, sizeof *self);
  if (!self) return corot_fail(COROT_ENOMEM, "no memory for an integrator");
  *self = (corot_integrator){.ops = ops,
                             .model = model,
                             .state = state,
                             .def = *def,
                             .t = t,
                             .before = t,
                             .t_energies = NAN,
                             .t_given = -INFINITY,
                             .seen = corot_state_stamp(state)};
  /* back over a kink, or on from an equilibrium: not where a step is to cross a kink */
  if (state->still || !isnan(state->side)) corot_state_enter(state, t);
  choose(self);
  corot_materials_settle(state);

  corot_status status = corot_mass_solver_create(model, &self->mass);
  if (!status && !ops->kind.explicit_steps) {
    status = corot_pencil_create(model, state, &def->linear, &self->pencil);
    if (!status) corot_pencil_use(self->pencil, self->def.tangent);
  }
  if (!status) status = ops->create(self, u, v);
  self->asked = corot_integrator_sum_of(def);
  self->def.method = ops->kind.name;
  self->def.table = NULL;
  self->def.linear = corot_linear_defaults();
  if (status) {
    corot_integrator_destroy(self);
    return status;
  }
  *integrator = self;
  return COROT_OK;
}

void corot_integrator_destroy(corot_integrator *self) {
  if (!self) return;
  if (self->clock) corot_frame_clock_orphan(self->clock);
  if (self->method) self->ops->destroy(self->method);
  corot_pencil_destroy(self->pencil);
  corot_mass_solver_destroy(self->mass);
  free(self);
}

double corot_integrator_time(const corot_integrator *self) { return self->t; }

/* Two clocks that mean one instant differ by rounding, over which there is no step to take. */
static bool within_rounding(const corot_integrator *self, double t_stop) {
  return t_stop - self->t <= 100 * DBL_EPSILON * (fabs(self->t) + self->t - self->before);
}

double corot_integrator_sight(const corot_integrator *self, double h, double t_stop) {
  return corot_sight(self->model, self->t, self->t - self->before, h, t_stop);
}

static void settle_at(corot_integrator *self, double t_stop, corot_step *step) {
  *step = (corot_step){.t = t_stop, .h = t_stop - self->t, .order = self->qlast};
  if (self->before == self->t) self->before = t_stop;
  self->t = t_stop;
}

corot_status corot_integrator_step(corot_integrator *self, double t_stop, corot_step *step) {
  COROT_TRY(COROT_GIVEN_AS(self, "integrator"));
  COROT_TRY(COROT_GIVEN(step));
  /* what needs no step, or may not have one */
  if (!(t_stop > self->t) || !isfinite(t_stop))
    return corot_fail(COROT_EINVAL, "integrator: cannot stop at t = %.17g, being at %.17g", t_stop,
                      self->t);
  if (within_rounding(self, t_stop)) {
    settle_at(self, t_stop, step);
    return COROT_OK;
  }
  if (self->def.max_steps > 0 && self->nst >= self->def.max_steps)
    return corot_fail(COROT_EINTEGRATE, "%s: max_steps = %ld reached at t = %g",
                      self->ops->kind.name, self->def.max_steps, self->t);
  /* the method's own step */
  corot_step taken;
  double start = clock_wall();
  team *before = corot_vector_share(self->state->system.team);
  corot_status status = self->ops->step(self, t_stop, &taken);
  corot_vector_share(before);
  self->step_s += clock_wall() - start;
  if (status) return status;
  /* what the step has changed */
  taken.h = taken.t - self->t;
  self->before = self->t;
  self->t = taken.t;
  self->hlast = taken.h;
  self->qlast = taken.order;
  self->nst++;
  *step = taken;
  return COROT_OK;
}

static corot_status check_within(const corot_integrator *self, double t) {
  if (t >= self->before && t <= self->t) return COROT_OK;
  if (self->before == self->t)
    return corot_fail(COROT_EINVAL, "%s: t = %.17g is not where the integrator (re)started, %.17g",
                      self->ops->kind.name, t, self->t);
  return corot_fail(COROT_EINVAL, "%s: t = %.17g is not in the last step, %.17g to %.17g",
                    self->ops->kind.name, t, self->before, self->t);
}

corot_status corot_integrator_at(corot_integrator *self, double t, double *u, double *v) {
  COROT_TRY(COROT_GIVEN_AS(self, "integrator"));
  COROT_TRY(check_within(self, t));
  return self->ops->at(self, t, u, v);
}

corot_status corot_integrator_work(corot_integrator *self, double t, double *dissipated,
                                   double *external) {
  COROT_TRY(COROT_GIVEN_AS(self, "integrator"));
  COROT_TRY(COROT_GIVEN(dissipated));
  COROT_TRY(COROT_GIVEN(external));
  COROT_TRY(check_within(self, t));
  COROT_TRY(self->ops->work(self, t, dissipated, external));
  *external += t < self->t_given ? self->given_before : self->given;
  return COROT_OK;
}

corot_status corot_integrator_energy(corot_integrator *self, const double *u, const double *v,
                                     corot_energies *energies) {
  COROT_TRY(COROT_GIVEN_AS(self, "integrator"));
  COROT_TRY(COROT_GIVEN(energies));
  double near = 100 * DBL_EPSILON * (fabs(self->t) + self->t - self->before);
  if (fabs(self->t_energies - self->t) <= near) {
    *energies = self->energies;
    return COROT_OK;
  }
  return corot_energy(self->model, self->state, self->t, u, v, energies);
}

/* The energy that a change of materials puts into the body is external work. */
static corot_status take_gain(corot_integrator *self) {
  double gain, *u = malloc(corot_model_ndof(self->model) * sizeof *u);
  if (!u) return corot_fail(COROT_ENOMEM, "no memory for a displacement");
  corot_status status = self->ops->at(self, self->t, u, NULL);
  if (!status) status = corot_materials_gain(self->model, self->state, self->t, u, &gain);
  free(u);
  COROT_TRY(status);
  if (self->t_given != self->t) self->given_before = self->given;
  self->t_given = self->t;
  self->given += gain;
  return COROT_OK;
}

corot_status corot_integrator_changed(corot_integrator *self, corot_history history) {
  COROT_TRY(COROT_GIVEN_AS(self, "integrator"));
  state_stamp now = corot_state_stamp(self->state), before = self->seen;
  bool loads = now.loads != before.loads, paths = now.paths != before.paths;
  bool others = now.frames != before.frames || now.matrices != before.matrices;
  if (now.matrices != before.matrices) COROT_TRY(take_gain(self));
  self->seen = now;
  if (loads || paths || now.matrices != before.matrices) self->t_energies = NAN;
  if (loads && !paths && !others && self->ops->loaded) return self->ops->loaded(self, history);
  if (self->pencil && (others || !(loads || paths))) corot_pencil_invalidate(self->pencil);
  return self->ops->changed(self, history);
}

corot_status corot_integrator_kink(corot_integrator *self) {
  COROT_TRY(COROT_GIVEN_AS(self, "integrator"));
  if (!corot_integrator_controls_error(self->ops->kind.name)) return COROT_OK;
  return self->ops->changed(self, COROT_HISTORY_AUTO);
}

corot_statistics corot_integrator_statistics(const corot_integrator *self) {
  corot_pencil_counts p = {0};
  if (self->pencil) p = corot_pencil_statistics(self->pencil);
  corot_statistics s = {.nje = p.nassembly,
                        .nli = p.niteration,
                        .nfactor = p.nfactor,
                        .nsolve = p.nsolve,
                        .nlsfail = p.nlsfail,
                        .nfresh = p.nfresh,
                        .nindefinite = p.nindefinite,
                        .nclamped = p.nclamped,
                        .nfallback = p.nfallback,
                        .force_s = self->force_s,
                        .work_s = self->work_s,
                        .assembly_s = p.assembly_s,
                        .combine_s = p.combine_s,
                        .factor_s = p.factor_s,
                        .solve_s = p.solve_s};
  /* the method's own counts, and what the steps took beside the phases above */
  const corot_statistics *c = &self->carried;
  self->ops->statistics(self, &s);
  s.nfe += c->nfe, s.nsetups += c->nsetups, s.netf += c->netf, s.nni += c->nni, s.ncfn += c->ncfn;
  s.nfeQ += c->nfeQ, s.nrestart += c->nrestart;
  s.nst = self->nst;
  s.hlast = self->hlast;
  s.qlast = self->qlast;
  s.integrator_s =
      self->step_s - s.force_s - s.assembly_s - s.combine_s - s.factor_s - s.solve_s - s.work_s;
  return s;
}

corot_integrator_choice corot_integrator_chosen(const corot_integrator *self) {
  const corot_integrator_def *d = &self->def;
  return (corot_integrator_choice){
      .method = self->ops->kind.name,
      .linear_solver = self->pencil ? corot_pencil_solver(self->pencil) : "none",
      .table = self->table ? self->table : "",
      .atol_displacement = d->atol_displacement,
      .atol_velocity = d->atol_velocity,
      .max_order = self->table ? d->order : d->max_order,
      .tangent = d->tangent,
      .reassembly = d->reassembly,
      .refactorisation = d->refactorisation,
      .predictor = d->predictor,
      .gamma_change = d->gamma_change,
      .convergence = d->convergence};
}
