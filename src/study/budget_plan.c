#include "budget_plan.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

const char *const budget_names[BUDGET_KINDS] = {
    [BUDGET_ALGEBRA] = "algebraic solver",
    [BUDGET_TIME] = "time integration",
    [BUDGET_FRAME_AGE] = "frame age",
    [BUDGET_FRAME_RULE] = "frame rule",
    [BUDGET_HIERARCHY] = "hierarchy",
    [BUDGET_STRAIN] = "strain measure",
    [BUDGET_SPACE] = "space",
};

const char *const budget_remedies[BUDGET_KINDS] = {
    [BUDGET_ALGEBRA] = "integrator.jacobian.convergence or integrator.newton.tolerance smaller",
    [BUDGET_TIME] = "integrator.rtol or integrator.step smaller",
    [BUDGET_FRAME_AGE] = "frames.interval shorter, extrapolate for hold, or policy exact",
    [BUDGET_FRAME_RULE] = "strain polar",
    [BUDGET_HIERARCHY] = "hierarchy.frame_level higher, or no hierarchy",
    [BUDGET_STRAIN] = "strain green",
    [BUDGET_SPACE] = "mesh.refine one more",
};

static void __attribute__((format(printf, 2, 3))) add(budget_part *part, const char *format, ...) {
  va_list values;
  va_start(values, format);
  vsnprintf(part->set[part->nset++], BUDGET_SETTING_SIZE, format, values);
  va_end(values);
}

static bool is(const char *a, const char *b) { return strcmp(a, b) == 0; }

/* A constant step has no tolerance: what it resolves is far from 1e-6. */
double budget_tight_rtol(const scenario *s) {
  double rtol = s->integrator.step > 0 ? 1e-3 : s->integrator.rtol;
  return fmax(fmin(rtol * 1e-3, 1e-6), 1e-10);
}

/* Newton's matrix may be old or inexact; only where it stops is an error. */
static void tighten_algebra(const scenario *s, budget_part *part) {
  if (s->integrator.step > 0) {
    add(part, "integrator.solution=newton");
    add(part, "integrator.newton.tolerance=%.3g", fmin(1e-12, s->integrator.newton_tolerance));
  } else {
    add(part, "integrator.jacobian.convergence=1e-3");
  }
  add(part, "linear_solver.tolerance=%.3g", fmin(1e-12, s->integrator.linear.tolerance));
}

static void tighten_time(const scenario *s, const char *method, budget_part *part) {
  bool same = s->integrator.step == 0 && is(s->integrator.method, method);
  double rtol = budget_tight_rtol(s);
  if (same)
    add(part, "integrator.rtol=%.3g", rtol);
  else if (is(method, "erk"))
    add(part, "integrator={method: erk, rtol: %.3g}", rtol);
  else
    add(part, "integrator={method: %s, rtol: %.3g, jacobian: {convergence: 1e-3}}", method, rtol);
  if (same && s->integrator.atol_displacement > 0) add(part, "integrator.atol.displacement=auto");
  if (same && s->integrator.atol_velocity > 0) add(part, "integrator.atol.velocity=auto");
}

static bool has_frames(const char *strain) { return !is(strain, "cauchy") && !is(strain, "green"); }

static budget_part *begin(budget_plan *plan, budget_kind kind) {
  budget_part *part = &plan->part[plan->npart++];
  part->kind = kind;
  return part;
}

static void plan_time(const scenario *s, budget_plan *plan) {
  const char *method = s->integrator.method;
  bool controlled = corot_integrator_controls_error(method);
  tighten_time(s, controlled ? method : "cvode", begin(plan, BUDGET_TIME));
  plan->check.kind = BUDGET_TIME;
  tighten_time(s, is(method, "arkode") ? "cvode" : "arkode", &plan->check);
}

/* Frames that are renewed after steps are as old as the steps are long: their error would vanish
   with that of time, and count as such, if it were not looked at before. */
static void plan_time_and_frame_age(const scenario *s, bool hierarchy, budget_plan *plan) {
  bool aged = s->frames.frames != COROT_FRAMES_EXACT && (has_frames(s->strain) || hierarchy);
  bool by_step = aged && (s->frames.every_step || s->frames.max_angle > 0);
  if (!by_step) plan_time(s, plan);
  if (aged) add(begin(plan, BUDGET_FRAME_AGE), "frames={policy: exact}");
  if (by_step) plan_time(s, plan);
}

/* The viscous law stays as it is under warp and a hierarchy, where by default another one would
   take its place: it is no approximation. */
static void add_with_its_damping(budget_part *part, const char *set) {
  add(part, "%s", set);
  add(part, "viscosity=corotated");
}

void budget_plan_make(const scenario *s, budget_plan *plan) {
  *plan = (budget_plan){0};
  bool hierarchy = s->coarse_strain && s->refine > 0;

  if (!is(s->integrator.method, "erk")) tighten_algebra(s, begin(plan, BUDGET_ALGEBRA));
  plan_time_and_frame_age(s, hierarchy, plan);
  if (is(s->strain, "warp")) add_with_its_damping(begin(plan, BUDGET_FRAME_RULE), "strain=polar");
  if (hierarchy) add_with_its_damping(begin(plan, BUDGET_HIERARCHY), "hierarchy=null");
  if (!is(s->strain, "green")) {
    budget_part *part = begin(plan, BUDGET_STRAIN);
    add(part, "strain=green");
    if (s->viscosity == COROT_OBJECTIVE) add(part, "viscosity=corotated");
    if (hierarchy) add(part, "hierarchy=null");
  }
  add(begin(plan, BUDGET_SPACE), "mesh.refine=%d", s->refine + 1);
}

void budget_plan_skip(budget_plan *plan, budget_kind kind) {
  int n = 0;
  for (int i = 0; i < plan->npart; i++)
    if (plan->part[i].kind != kind) plan->part[n++] = plan->part[i];
  plan->npart = n;
}
