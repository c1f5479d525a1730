/* Which settings take an approximation away, and in which order. */
#include "budget_plan.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

const char *const budget_names[BUDGET_KINDS] = {
    [BUDGET_ALGEBRA] = "algebraic solver", [BUDGET_TIME] = "time integration",
    [BUDGET_LOAD_STEPS] = "load steps",    [BUDGET_FRAME_AGE] = "frame age",
    [BUDGET_FRAME_RULE] = "frame rule",    [BUDGET_HIERARCHY] = "hierarchy",
    [BUDGET_STRAIN] = "strain measure",    [BUDGET_SPACE] = "space",
};

static const char *const remedies[BUDGET_KINDS] = {
    [BUDGET_ALGEBRA] = "integrator.jacobian.convergence or integrator.newton.tolerance smaller",
    [BUDGET_TIME] = "integrator.rtol or integrator.step smaller",
    [BUDGET_LOAD_STEPS] = "statics.max_step smaller",
    [BUDGET_FRAME_AGE] = "frames.interval shorter, extrapolate for hold, or policy exact",
    [BUDGET_FRAME_RULE] = "strain polar",
    [BUDGET_HIERARCHY] = "hierarchy.frame_level higher, or no hierarchy",
    [BUDGET_STRAIN] = "strain green",
    [BUDGET_SPACE] = "mesh.refine one more",
};

const char *budget_remedy(const budget_plan *plan, budget_kind kind, bool still) {
  if (kind == BUDGET_SPACE && plan->by_order) return "mesh.order 2";
  return still && kind == BUDGET_ALGEBRA ? "statics.tolerance smaller" : remedies[kind];
}

static void __attribute__((format(printf, 2, 3))) add(budget_part *part, const char *format, ...) {
  va_list values;
  va_start(values, format);
  vsnprintf(part->set[part->nset++], BUDGET_SETTING_SIZE, format, values);
  va_end(values);
}

/* A constant step has no tolerance: what it resolves is far from 1e-6. */
double budget_tight_rtol(const scenario *s) {
  double rtol = s->integrator.step > 0 ? 1e-3 : s->integrator.rtol;
  return fmax(fmin(rtol * 1e-3, 1e-6), 1e-10);
}

/* Newton's matrix may be old or inexact; only where it stops is an error. Tolerances are `loose`
   times the tightest. */
static void tighten_algebra(const scenario *s, double loose, budget_part *part) {
  if (s->integrator.step > 0) {
    add(part, "integrator.solution=newton");
    add(part, "integrator.newton.tolerance=%.3g",
        fmin(loose * 1e-12, s->integrator.newton_tolerance));
  } else {
    add(part, "integrator.jacobian.convergence=%.3g", loose * 1e-3);
  }
  add(part, "linear_solver.tolerance=%.3g", fmin(loose * 1e-12, s->integrator.linear.tolerance));
}

static void tighten_equilibrium(const scenario *s, double loose, budget_part *part) {
  add(part, "statics.tolerance=%.3g", fmin(loose * 1e-13, s->statics.tolerance));
  if (s->statics.max_iterations < 200) add(part, "statics.max_iterations=200");
  add(part, "linear_solver.tolerance=%.3g", fmin(loose * 1e-13, s->statics.linear.tolerance));
}

static bool is_explicit(const char *method) { return corot_method_traits(method)->explicit_steps; }

static bool is_implicit_runge_kutta(const char *method) {
  return corot_method_traits(method)->stages && !is_explicit(method);
}

static void tighten_time(const scenario *s, const char *method, double rtol, budget_part *part) {
  bool same = s->integrator.step == 0 && strcmp(s->integrator.method, method) == 0;
  if (same)
    add(part, "integrator.rtol=%.3g", rtol);
  else if (is_explicit(method))
    add(part, "integrator={method: %s, rtol: %.3g}", method, rtol);
  else
    add(part, "integrator={method: %s, rtol: %.3g, jacobian: {convergence: 1e-3}}", method, rtol);
  if (same && s->integrator.atol_displacement > 0) add(part, "integrator.atol.displacement=auto");
  if (same && s->integrator.atol_velocity > 0) add(part, "integrator.atol.velocity=auto");
}

/* The reference of time, by the scenario's own method if that controls its error; and its check,
   by another. */
static void judge_time(const scenario *s, double rtol, budget_part *reference, budget_part *check) {
  const char *method = s->integrator.method;
  bool controlled = corot_integrator_controls_error(method);
  tighten_time(s, controlled ? method : "cvode", rtol, reference);
  check->kind = BUDGET_TIME;
  tighten_time(s, is_implicit_runge_kutta(method) ? "cvode" : "arkode", rtol, check);
}

static bool has_frames(const char *strain) { return corot_strain_find(strain)->frames; }

static budget_part *begin(budget_plan *plan, budget_kind kind) {
  budget_part *part = &plan->part[plan->npart++];
  part->kind = kind;
  return part;
}

static void plan_time(const scenario *s, budget_plan *plan) {
  judge_time(s, budget_tight_rtol(s), begin(plan, BUDGET_TIME), &plan->check);
}

/* Frames that are renewed after steps are as old as the steps are long: their error would vanish
   with that of time, and count as such, if it were not looked at before. */
static void plan_time_and_frame_age(const scenario *s, bool hierarchy, budget_plan *plan) {
  bool aged = s->frames.frames != COROT_FRAMES_EXACT && (has_frames(s->model.strain) || hierarchy);
  bool by_step = aged && (s->frames.every_step || s->frames.max_angle > 0);
  if (!by_step) plan_time(s, plan);
  if (aged) add(begin(plan, BUDGET_FRAME_AGE), "frames={policy: exact}");
  if (by_step) plan_time(s, plan);
}

static bool has_hierarchy(const scenario *s) {
  return s->model.hierarchy && (s->refine > 0 || s->order == 2);
}

/* The viscous law stays as it is under warp and a hierarchy, where by default another one would
   take its place: it is no approximation. */
static void add_with_its_damping(budget_part *part, const char *set) {
  add(part, "%s", set);
  add(part, "viscosity=corotated");
}

/* What the model itself leaves out, in the order of budget_kind. */
static void plan_model(const scenario *s, budget_plan *plan) {
  bool hierarchy = has_hierarchy(s);
  const corot_strain_kind *strain = corot_strain_find(s->model.strain);
  if (strain->frames && !strain->polar)
    add_with_its_damping(begin(plan, BUDGET_FRAME_RULE), "strain=polar");
  if (hierarchy) add_with_its_damping(begin(plan, BUDGET_HIERARCHY), "hierarchy=null");
  if (!strain->exact) {
    budget_part *part = begin(plan, BUDGET_STRAIN);
    add(part, "strain=green");
    if (s->model.viscosity == COROT_OBJECTIVE) add(part, "viscosity=corotated");
    if (hierarchy) add(part, "hierarchy=null");
  }
  budget_plan_finer(plan, s, 1, begin(plan, BUDGET_SPACE));
}

void budget_plan_make(const scenario *s, int order, budget_plan *plan) {
  *plan = (budget_plan){.by_order = order == 1};
  if (!is_explicit(s->integrator.method)) {
    tighten_algebra(s, 1, begin(plan, BUDGET_ALGEBRA));
    tighten_algebra(s, 10, &plan->algebra_check);
  }
  plan_time_and_frame_age(s, has_hierarchy(s), plan);
  plan_model(s, plan);
}

void budget_plan_make_static(const scenario *s, int order, budget_plan *plan) {
  *plan = (budget_plan){.by_order = order == 1};
  tighten_equilibrium(s, 1, begin(plan, BUDGET_ALGEBRA));
  tighten_equilibrium(s, 10, &plan->algebra_check);
  double step = fmin(s->statics.max_step, 1) / 4;
  budget_part *part = begin(plan, BUDGET_LOAD_STEPS);
  add(part, "statics.max_step=%.6g", step);
  add(part, "statics.first_step=%.6g", fmin(step, s->statics.first_step));
  if (s->statics.min_step > step) add(part, "statics.min_step=%.6g", step);
  plan_model(s, plan);
}

double budget_plan_tighten(const scenario *s, int attempt, budget_part *reference,
                           budget_part *check) {
  double before = budget_tight_rtol(s) * pow(1e-2, attempt - 1);
  if (before <= 1e-11 * 1.01) return 0;
  double rtol = fmax(before * 1e-2, 1e-11);
  *reference = *check = (budget_part){.kind = BUDGET_TIME};
  judge_time(s, rtol, reference, check);
  return rtol;
}

void budget_plan_finer(const budget_plan *plan, const scenario *s, int level, budget_part *part) {
  int octasections = plan->by_order ? level - 1 : level;
  bool one_way = has_hierarchy(s) && s->hierarchy.coupling == COROT_COUPLING_ONE_WAY;
  part->kind = BUDGET_SPACE;
  if (plan->by_order) add(part, "mesh.order=2");
  if (octasections > 0) add(part, "mesh.refine=%d", s->refine + octasections);
  if (plan->by_order && s->model.mass == COROT_MASS_LUMPED && !one_way)
    add(part, "mass=consistent");
}

/* Statics factor their matrix in every iteration, and are dearer by the tet: 5e4 tets and
   iterations a second were measured, and 5e5 tets and steps of cvode. */
bool budget_plan_affords(bool still, double work, double tets) {
  return work <= (still ? 2e6 : 3e7) && tets <= 2e5;
}

void budget_plan_skip(budget_plan *plan, budget_kind kind) {
  int n = 0;
  for (int i = 0; i < plan->npart; i++)
    if (plan->part[i].kind != kind) plan->part[n++] = plan->part[i];
  plan->npart = n;
}
