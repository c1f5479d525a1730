/* Equilibria by KINSOL: load steps, Newton iterations, held frames by fixed point. */
#include <corot/statics.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/base/sized.h"
#include "core/ode/stamp.h"
#include "equilibrium.h"
#include "rigid.h"
#include "solve/pencil/wall_clock.h"

struct corot_statics {
  corot_statics_def def;
  equilibrium e;
  double factor;           /* load factor reached */
  double *u;               /* [n] equilibrium there */
  double length;           /* of the next load step */
  double stable, unstable; /* load factors between which stability was lost; NaN: nowhere */
  double ceiling;          /* a load factor where the equilibrium found was unstable; or infinity */
  double all_s;
};

void corot_statics_set_defaults(corot_statics_def *def, size_t bytes) {
  const corot_statics_def ours = {
      .linear = corot_linear_defaults(),
      .frames = COROT_FRAMES_EXACT,
      .tolerance = 1e-10,
      .max_iterations = 20,
      .first_step = 1,
      .min_step = 1e-4,
      .max_step = 1,
  };
  corot_sized_fill(def, bytes, &ours, sizeof ours);
}

static corot_status check(const corot_statics_def *d, const corot_model *model, double t) {
  const struct {
    const char *name;
    double value, most;
  } field[] = {
      {"tolerance", d->tolerance, 1},
      {"first_step", d->first_step, 1},
      {"min_step", d->min_step, 1},
      {"max_step", d->max_step, 1},
  };
  for (int k = 0; k < 4; k++)
    if (!(field[k].value > 0 && field[k].value <= field[k].most))
      return corot_fail(COROT_EINVAL, "statics: %s = %g is not above 0 and at most 1",
                        field[k].name, field[k].value);
  if (d->max_iterations <= 0 || d->max_iterations > 1000000)
    return corot_fail(COROT_EINVAL, "statics: max_iterations = %d is not in 1 to 1000000",
                      d->max_iterations);
  if (d->frames != COROT_FRAMES_EXACT && d->frames != COROT_FRAMES_HELD)
    return corot_fail(COROT_EINVAL, "statics: frames are exact or held");
  if (corot_model_ndof(model) == 0)
    return corot_fail(COROT_EINVAL, "statics: the model has no degree of freedom");
  if (!isfinite(t)) return corot_fail(COROT_EINVAL, "statics: t = %g is not finite", t);
  return COROT_OK;
}

static corot_status allocate(corot_statics *s, const corot_model *model, double t,
                             const double *u0) {
  size_t n = corot_model_ndof(model);
  if (!corot_inputs_may_hold(s->def.inputs)) COROT_TRY(corot_rigid_check(model));
  s->u = calloc(n, sizeof *s->u);
  if (!s->u) return corot_fail(COROT_ENOMEM, "no memory for statics");
  for (size_t i = 0; u0 && i < n; i++) {
    if (!isfinite(u0[i]))
      return corot_fail(COROT_EINVAL, "statics: u[%zu] = %g is not finite", i, u0[i]);
    s->u[i] = u0[i];
  }
  return corot_equilibrium_open(&s->e, &s->def, model, t);
}

corot_status corot_statics_create(const corot_statics_def *def, const corot_model *model, double t,
                                  const double *u0, corot_statics **statics) {
  COROT_TRY(COROT_DEFINED(def, corot_statics_def));
  COROT_TRY(COROT_GIVEN(model));
  COROT_TRY(COROT_GIVEN(statics));
  COROT_TRY(check(def, model, t));
  corot_statics *s = calloc(1, sizeof *s);
  if (!s) return corot_fail(COROT_ENOMEM, "no memory for statics");
  s->def = *def;
  if (def->follow_unstable) { /* which factors K as it is */
    s->def.linear = corot_linear_defaults();
    s->def.linear.solver = "klu";
  }
  s->length = fmin(def->first_step, def->max_step);
  s->stable = s->unstable = NAN;
  s->ceiling = INFINITY;
  corot_status status = allocate(s, model, t, u0);
  if (status) {
    corot_statics_destroy(s);
    return status;
  }
  *statics = s;
  return COROT_OK;
}

void corot_statics_destroy(corot_statics *s) {
  if (!s) return;
  corot_equilibrium_close(&s->e);
  free(s->u);
  free(s);
}

/* Shorter steps are not taken to see where stability is lost. */
static double resolution(const corot_statics *s, double factor) {
  return fmax(5e-4 * factor, s->def.min_step);
}

/* After so many iterations or less the next step may be longer. */
enum { EASY = 7 };

/* Where the next load step goes. A load factor where the equilibrium was unstable is approached by
   halves: a long step may have left the path, and found what a shorter one will not. */
static double next_target(const corot_statics *s) {
  double target = s->factor + s->length, gap = s->ceiling - s->factor;
  if (target > 1 - 0.5 * s->def.min_step) target = 1;
  if (gap <= resolution(s, s->ceiling)) return fmin(target, s->ceiling);
  if (target > s->factor + 0.5 * gap) return s->factor + 0.5 * gap;
  return target;
}

static corot_status lose_stability(corot_statics *s, double unstable) {
  s->stable = s->factor, s->unstable = unstable;
  return corot_fail(COROT_EINTEGRATE,
                    "the equilibrium becomes unstable at load factor %.4g: the stiffness is no "
                    "longer positive definite (buckling)",
                    0.5 * (s->factor + unstable));
}

/* Whether K leaves out how frames vary: an iteration then gains a factor, which the bend takes
 * away.
 */
static bool leaves_out_frames(const corot_model *model) {
  const corot_strain_kind *kind = corot_strain_find(corot_model_strain(model));
  return kind && kind->frames && !kind->polar;
}

/* `indefinite`: trials met a stiffness that is not positive definite. */
static corot_status give_up(const corot_statics *s, bool indefinite) {
  return corot_fail(
      COROT_EINTEGRATE, "no equilibrium found beyond load factor %.6g: %s%s; min_step = %g%s",
      s->factor, s->e.reason,
      indefinite ? " (the stiffness is not positive definite there: buckling)" : "",
      s->def.min_step,
      leaves_out_frames(s->e.model)
          ? "; strain warp, whose stiffness leaves out how the frames vary, takes the "
            "more iterations the further the body bends: raise max_iterations, or "
            "take strain polar"
          : "");
}

static void report(const corot_statics *s, double target, int rejected, corot_stability stability,
                   corot_load_step *step) {
  const equilibrium *e = &s->e;
  *step = (corot_load_step){
      .factor = target,
      .length = target - s->factor,
      .iterations = e->iterations,
      .rejected = rejected,
      .force = e->force,
      .nresidual = e->nhistory,
      .residual = e->history,
      .rounding = e->history[e->nhistory - 1] > s->def.tolerance * e->force,
      .stability = stability,
  };
}

/* Begins at the last equilibrium. (What the last two point to is closer, and saves one iteration in
   four, but where a column begins to bend it leads to its other side.) The line search is the last
   resort before giving up. */
static corot_status look(corot_statics *s, double target) {
  double *guess = N_VGetArrayPointer(s->e.u);
  memcpy(guess, s->u, s->e.n * sizeof *guess);
  corot_status status = corot_equilibrium_find(&s->e, target);
  if (status != COROT_RETRY || 0.5 * (target - s->factor) >= s->def.min_step) return status;
  memcpy(guess, s->u, s->e.n * sizeof *guess);
  return corot_equilibrium_search(&s->e, target);
}

static corot_status step_on(corot_statics *s, corot_load_step *step) {
  long nindefinite = corot_pencil_statistics(s->e.pencil).nindefinite;
  for (int rejected = 0;; rejected++) {
    /* an equilibrium there, and whether it is stable */
    double target = next_target(s), length = target - s->factor;
    corot_stability stability = COROT_STABLE;
    corot_status status = look(s, target);
    if (status < 0) return status;
    if (status == COROT_OK) COROT_TRY(corot_equilibrium_judge(&s->e, &stability));
    /* if so, go on from it */
    if (status == COROT_OK && stability != COROT_UNSTABLE) {
      report(s, target, rejected, stability, step);
      memcpy(s->u, N_VGetArrayPointer(s->e.u), s->e.n * sizeof *s->u);
      s->factor = target;
      if (target >= s->ceiling) s->ceiling = INFINITY;
      s->e.counts.nstep++;
      s->length = fmin(s->e.iterations <= EASY ? 2 * length : length, s->def.max_step);
      return COROT_OK;
    }
    /* if not, go half as far */
    s->e.counts.nrejected++;
    s->length = 0.5 * length;
    if (status == COROT_OK) s->ceiling = target;
    if (status == COROT_OK && s->length < resolution(s, target)) return lose_stability(s, target);
    if (s->length < s->def.min_step)
      return give_up(s, corot_pencil_statistics(s->e.pencil).nindefinite > nindefinite);
  }
}

corot_status corot_statics_step(corot_statics *s, corot_load_step *step) {
  COROT_TRY(COROT_GIVEN_AS(s, "statics"));
  COROT_TRY(COROT_GIVEN(step));
  if (s->factor >= 1) return corot_fail(COROT_EINVAL, "statics: the full load has been reached");
  if (s->unstable == s->unstable)
    return corot_fail(COROT_EINTEGRATE, "statics: stability was lost at load factor %.4g",
                      s->unstable);
  double start = clock_wall();
  corot_status status = step_on(s, step);
  s->all_s += clock_wall() - start;
  return status;
}

corot_status corot_statics_solve(corot_statics *s) {
  COROT_TRY(COROT_GIVEN_AS(s, "statics"));
  corot_load_step step;
  while (s->factor < 1) COROT_TRY(corot_statics_step(s, &step));
  return COROT_OK;
}

double corot_statics_at(const corot_statics *s, double *u) {
  if (u) memcpy(u, s->u, s->e.n * sizeof *u);
  return s->factor;
}

void corot_statics_critical(const corot_statics *s, double *stable, double *unstable) {
  *stable = s->stable;
  *unstable = s->unstable;
}

corot_statics_counts corot_statics_statistics(const corot_statics *s) {
  corot_statics_counts c = s->e.counts;
  corot_pencil_counts p = corot_pencil_statistics(s->e.pencil);
  c.nje = p.nassembly, c.nfactor = p.nfactor, c.nsolve = p.nsolve, c.nli = p.niteration;
  c.nlsfail = p.nlsfail, c.nindefinite = p.nindefinite;
  c.force_s = s->e.force_s;
  c.assembly_s = p.assembly_s, c.combine_s = p.combine_s;
  c.factor_s = p.factor_s, c.solve_s = p.solve_s;
  c.other_s = fmax(0, s->all_s - c.force_s - c.assembly_s - c.combine_s - c.factor_s - c.solve_s);
  return c;
}

const char *corot_statics_solver(const corot_statics *s) {
  return corot_pencil_solver(s->e.pencil);
}

size_t corot_statics_bytes(const corot_statics *s) { return corot_state_bytes(s->e.state); }
