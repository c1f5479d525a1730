/* Methods of constant step: the paper's (backward Euler, BDF3) and the field's. The system of a
   step (see fixed.h) is solved either linearly, by one solve from the predictor, which is exact
   where the frames are held and both bases are R (the paper's "linear" rows) and elsewhere takes a
   matrix of its own each step; or by Newton with backtracking, the factor kept while it
   converges. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/ode/trial.h"
#include "fixed.h"
#include "solve/pencil/wall_clock.h"

/* --- one step -------------------------------------------------------------------------------- */

/* G(w) at w = f->trial; *norm = G' L^-1 G with the lumped mass L. */
static corot_status evaluate(corot_integrator *self, const stage *g, double *norm) {
  fixed *f = self->method;
  double *u = f->u[NHISTORY - 1], *v = f->v[NHISTORY - 1], start = clock_wall(), sum = 0;
  for (int i = 0; i < f->n; i++) {
    u[i] = f->U[i] + g->p * f->trial[i];
    v[i] = f->V[i] + g->q * f->trial[i];
    f->apart[i] = f->trial[i] - f->W[i];
  }
  corot_mass_multiply(self->model, f->apart, f->inertia);
  corot_status status = corot_residual_trial(self->model, self->state, g->t, u, v, f->G);
  for (int i = 0; i < f->n; i++) {
    f->G[i] = g->s * f->inertia[i] - g->k * f->G[i];
    sum += f->G[i] * f->G[i] / f->lumped[i];
  }
  f->counts.nfe++;
  self->force_s += clock_wall() - start;
  *norm = sum;
  return status;
}

/* The factor of G' at the state last evaluated, made anew if it belongs to other coefficients or
   `fresh` is asked for. */
static corot_status ensure_factor(corot_integrator *self, const stage *g, bool fresh) {
  fixed *f = self->method;
  bool same = f->factored.s == g->s && f->factored.p == g->p && f->factored.q == g->q &&
              f->factored.k == g->k;
  if (same && !fresh && !self->pencil->dirty) return COROT_OK;
  f->factored.s = 0;
  if (fresh || self->pencil->dirty)
    COROT_TRY(corot_pencil_assemble(self->pencil, g->t, f->u[NHISTORY - 1], f->v[NHISTORY - 1]));
  corot_pencil_combine(self->pencil, g->s, g->k * g->q, g->k * g->p);
  f->counts.nsetups++;
  COROT_TRY(corot_pencil_factor(self->pencil));
  f->factored = *g;
  return COROT_OK;
}

/* Size of a correction of w: the largest displacement it stands for, over the model's length. */
static double correction(const corot_integrator *self, const stage *g) {
  const fixed *f = self->method;
  double largest = 0;
  for (int i = 0; i < f->n; i++) largest = fmax(largest, fabs(f->d[i]));
  return largest * g->p / corot_model_length(self->model);
}

/* G at the predictor or, where that cannot be evaluated, at the w that leaves the body where it is.
 */
static corot_status predict(corot_integrator *self, const stage *g, double *norm) {
  fixed *f = self->method;
  memcpy(f->trial, f->w, f->n * sizeof *f->w);
  corot_status status = evaluate(self, g, norm);
  if (status <= 0) return status;
  for (int i = 0; i < f->n; i++) f->trial[i] = f->w[i] = (f->u[0][i] - f->U[i]) / g->p;
  return evaluate(self, g, norm);
}

/* Whether K and D are the same in every step until the frames change. */
static bool has_constant_matrices(const corot_integrator *self) {
  if (corot_state_stamp(self->state).feedback) return false;
  const corot_strain_kind *strain = corot_strain_find(corot_model_strain(self->model));
  if (strain && strain->linear) return true; /* a hierarchy is none of them */
  return corot_model_matrices_by_frames(self->model) &&
         corot_state_frames(self->state) == COROT_FRAMES_HELD;
}

static corot_status solve_linear(corot_integrator *self, const stage *g) {
  fixed *f = self->method;
  double norm;
  COROT_TRY(predict(self, g, &norm));
  COROT_TRY(ensure_factor(self, g, !has_constant_matrices(self)));
  COROT_TRY(corot_pencil_solve(self->pencil, f->G, f->d));
  for (int i = 0; i < f->n; i++) f->w[i] -= f->d[i];
  return COROT_OK;
}

/* Halves the correction until |G| falls; leaves w + fraction d in f->w and its G in f->G. */
static corot_status backtrack(corot_integrator *self, const stage *g, double *norm, bool *fell) {
  fixed *f = self->method;
  double before = *norm, fraction = 1;
  *fell = true;
  for (int halving = 0; halving < 12; halving++, fraction /= 2) {
    for (int i = 0; i < f->n; i++) f->trial[i] = f->w[i] - fraction * f->d[i];
    corot_status status = evaluate(self, g, norm);
    if (status < 0) return status;
    if (status == COROT_OK && *norm <= (1 - 1e-4 * fraction) * before) {
      memcpy(f->w, f->trial, f->n * sizeof *f->w);
      return COROT_OK;
    }
  }
  *fell = false;
  memcpy(f->trial, f->w, f->n * sizeof *f->w);
  return evaluate(self, g, norm);
}

/* The matrix is made anew where corrections shrink slowly and, from the first correction on that an
   older one has spoilt, each time. */
static corot_status solve_newton(corot_integrator *self, const stage *g, int *iterations) {
  fixed *f = self->method;
  double norm, size = 0, last = INFINITY;
  bool fresh = false, always = false, fell = true;
  COROT_TRY(predict(self, g, &norm));
  for (*iterations = 1; *iterations <= self->def.newton_iterations; ++*iterations) {
    /* the correction */
    COROT_TRY(ensure_factor(self, g, fresh));
    COROT_TRY(corot_pencil_solve(self->pencil, f->G, f->d));
    size = correction(self, g);
    f->counts.nni++;
    if (size <= self->def.newton_tolerance) {
      for (int i = 0; i < f->n; i++) f->w[i] -= f->d[i];
      return COROT_OK;
    }
    /* as much of it as reduces the residual */
    COROT_TRY(backtrack(self, g, &norm, &fell));
    if (!fell && fresh)
      return corot_fail(COROT_EINTEGRATE,
                        "%s: in the step from t = %.9g: Newton's correction of %.2g lengths does "
                        "not reduce the residual",
                        f->scheme->name, self->t, size);
    /* whether the next one needs a matrix of its own */
    always = always || !fell;
    fresh = always || size > 0.3 * last;
    last = size;
  }
  return corot_fail(COROT_EINTEGRATE,
                    "%s: in the step from t = %.9g: Newton has not converged in %d iterations "
                    "(correction %.2g lengths, tolerance %.2g)",
                    f->scheme->name, self->t, self->def.newton_iterations, size,
                    self->def.newton_tolerance);
}

static void rotate_history(double *x[NHISTORY]) {
  double *oldest = x[NHISTORY - 2]; /* the last one is scratch */
  for (int j = NHISTORY - 2; j > 0; j--) x[j] = x[j - 1];
  x[0] = oldest;
}

static void rotate_back(double *x[NHISTORY]) {
  double *newest = x[0];
  for (int j = 0; j < NHISTORY - 2; j++) x[j] = x[j + 1];
  x[NHISTORY - 2] = newest;
}

/* Work by the trapezoidal rule, up to the state in u[0], v[0]. */
static corot_status add_work(corot_integrator *self, double t, double h) {
  fixed *f = self->method;
  double start = clock_wall();
  corot_energies *e = &self->energies;
  COROT_TRY(corot_energy(self->model, self->state, t, f->u[0], f->v[0], e));
  self->t_energies = t;
  double now[2] = {e->power_dissipated, e->power_external};
  for (int k = 0; k < 2; k++) {
    f->old_work[k] = f->work[k];
    f->work[k] += 0.5 * h * (f->power[k] + now[k]);
    f->power[k] = now[k];
  }
  f->counts.nfeQ++;
  self->work_s += clock_wall() - start;
  return COROT_OK;
}

/* r where the body is, in G. */
static corot_status find_r(corot_integrator *self, double t) {
  fixed *f = self->method;
  f->counts.nfe++;
  return corot_residual(self->model, self->state, t, f->u[0], f->v[0], f->G);
}

/* The state at t from the solution w of the step's system. Where that state cannot be evaluated
   (midpoint and the alpha methods solve for one between) the old one is back in place. */
static corot_status finish(corot_integrator *self, double t) {
  fixed *f = self->method;
  rotate_history(f->u);
  rotate_history(f->v);
  f->scheme->finish(f);
  bool with_r = self->seen.inputs && f->scheme->needs_acceleration;
  corot_status status = with_r ? find_r(self, t) : COROT_OK;
  if (!status) status = add_work(self, t, f->h);
  if (status) {
    rotate_back(f->u);
    rotate_back(f->v);
    if (f->depth > NHISTORY - 2) f->depth = NHISTORY - 2; /* the oldest was overwritten */
    return status;
  }
  if (f->scheme->needs_acceleration) memcpy(f->a, f->w, f->n * sizeof *f->a);
  if (with_r) memcpy(f->r, f->G, f->n * sizeof *f->r);
  f->r_known = with_r;
  f->count++;
  if (f->depth < NHISTORY - 1) f->depth++;
  return COROT_OK;
}

static corot_status fixed_step(corot_integrator *self, double t_stop, corot_step *step) {
  (void)t_stop; /* the grid of steps is its own */
  fixed *f = self->method;
  stage g;
  f->scheme->prepare(f, &g);
  step->t = f->t0 + (f->count + 1) * f->h;
  step->order = f->scheme->order == 0 ? 2 : f->depth >= f->scheme->order ? f->scheme->order : 1;
  step->error = 0; /* not estimated */
  step->newton = 0;
  corot_status status = self->def.solution == COROT_SOLUTION_LINEAR
                            ? solve_linear(self, &g)
                            : solve_newton(self, &g, &step->newton);
  if (!status) status = finish(self, step->t);
  if (status > 0)
    return corot_fail(COROT_EINTEGRATE, "%s: in the step from t = %.9g: %g s are too long: %s",
                      f->scheme->name, self->t, f->h, corot_error());
  f->counts.hlast = f->h;
  f->counts.qlast = step->order;
  return status;
}

/* --- the rest of the interface --------------------------------------------------------------- */

/* Cubic Hermite interpolant of u within the last step, and its derivative for v. */
static corot_status fixed_at(corot_integrator *self, double t, double *u, double *v) {
  const fixed *f = self->method;
  double s = (t - self->t) / f->h; /* -1 to 0 */
  if (s == 0) {
    if (u) memcpy(u, f->u[0], f->n * sizeof *u);
    if (v) memcpy(v, f->v[0], f->n * sizeof *v);
    return COROT_OK;
  }
  if (!(s >= -1 - 1e-9 && s <= 1e-9) || f->depth < 2)
    return corot_fail(COROT_EINVAL, "%s: t = %.17g is not in the last step", f->scheme->name, t);
  double x = 1 + s; /* 0 to 1 */
  double a0 = (1 + 2 * x) * s * s, b0 = x * s * s, a1 = x * x * (3 - 2 * x), b1 = x * x * s;
  double da = 6 * x * s, db0 = s * (3 * x - 1), db1 = x * (3 * x - 2);
  for (int i = 0; i < f->n; i++) {
    double u0 = f->u[1][i], u1 = f->u[0][i], hv0 = f->h * f->v[1][i], hv1 = f->h * f->v[0][i];
    if (u) u[i] = a0 * u0 + b0 * hv0 + a1 * u1 + b1 * hv1;
    if (v) v[i] = (da * (u0 - u1) + db0 * hv0 + db1 * hv1) / f->h;
  }
  return COROT_OK;
}

static corot_status fixed_work(corot_integrator *self, double t, double *dissipated,
                               double *external) {
  const fixed *f = self->method;
  double s = fmin(0, fmax(-1, (t - self->t) / f->h));
  *dissipated = f->work[0] + s * (f->work[0] - f->old_work[0]);
  *external = f->work[1] + s * (f->work[1] - f->old_work[1]);
  return COROT_OK;
}

/* The powers that the next step begins with, where inputs have jumped. */
static corot_status renew_powers(corot_integrator *self) {
  fixed *f = self->method;
  corot_energies *e = &self->energies;
  COROT_TRY(corot_energy(self->model, self->state, self->t, f->u[0], f->v[0], e));
  f->power[0] = e->power_dissipated, f->power[1] = e->power_external;
  f->counts.nfeQ++;
  return COROT_OK;
}

/* The Newmark family's acceleration jumps as r has; where that is not known, it is as at a start.
 */
static corot_status jump(corot_integrator *self) {
  fixed *f = self->method;
  COROT_TRY(find_r(self, self->t));
  for (int i = 0; i < f->n; i++) f->d[i] = f->r_known ? f->G[i] - f->r[i] : f->G[i];
  COROT_TRY(corot_mass_solve(self->mass, f->d, f->d));
  for (int i = 0; i < f->n; i++) f->a[i] = f->r_known ? f->a[i] + f->d[i] : f->d[i];
  memcpy(f->r, f->G, f->n * sizeof *f->r);
  f->r_known = true;
  return COROT_OK;
}

/* One-step methods have no history but that acceleration; BDF keeps it, as the paper does, unless
   told otherwise. */
static corot_status fixed_changed(corot_integrator *self, corot_history history) {
  fixed *f = self->method;
  if (self->seen.inputs) COROT_TRY(renew_powers(self));
  if (self->seen.inputs && f->scheme->needs_acceleration && history != COROT_HISTORY_KEEP)
    COROT_TRY(jump(self));
  if (history != COROT_HISTORY_RESTART) return COROT_OK;
  f->depth = 1;
  self->before = self->t; /* no interpolant any more */
  f->counts.nrestart++;
  return COROT_OK;
}

/* All there is to know: nothing is lost. */
static void fixed_exchange(corot_integrator *self, pack *p) {
  fixed *f = self->method;
  corot_pack_double(p, &f->t0);
  corot_pack_long(p, &f->count);
  corot_pack_int(p, &f->depth);
  for (int j = 0; j < f->depth && j < NHISTORY - 1; j++) {
    corot_pack_doubles(p, f->u[j], (size_t)f->n);
    corot_pack_doubles(p, f->v[j], (size_t)f->n);
  }
  corot_pack_bool(p, &f->r_known);
  if (f->scheme->needs_acceleration) {
    corot_pack_doubles(p, f->a, (size_t)f->n);
    corot_pack_doubles(p, f->r, (size_t)f->n);
  }
  corot_pack_doubles(p, f->power, 2);
  corot_pack_doubles(p, f->work, 2);
}

static void fixed_statistics(const corot_integrator *self, corot_statistics *s) {
  const corot_statistics *c = &((const fixed *)self->method)->counts;
  s->nfe = c->nfe, s->nsetups = c->nsetups, s->nni = c->nni, s->nfeQ = c->nfeQ;
  s->nrestart = c->nrestart, s->hlast = c->hlast, s->qlast = c->qlast;
}

static void fixed_destroy(void *method) {
  fixed *f = method;
  free(f->memory);
  free(f);
}

static void fixed_choose(corot_integrator *self) {
  corot_integrator_def *d = &self->def;
  if (d->tangent == COROT_TANGENT_AUTO) d->tangent = COROT_TANGENT_HELD;
}

static corot_status fixed_create(corot_integrator *self, const double *u, const double *v) {
  const corot_integrator_def *d = &self->def;
  fixed *f = self->method = calloc(1, sizeof *f);
  if (!f) return corot_fail(COROT_ENOMEM, "no memory for %s", d->method);
  f->scheme = corot_scheme_find(d->method);
  if (!(d->step > 0)) return corot_fail(COROT_EINVAL, "%s needs a step", d->method);
  double lowest = self->ops->kind.radius_min;
  if (!(d->spectral_radius >= lowest && d->spectral_radius <= 1))
    return corot_fail(COROT_EINVAL, "%s: spectral_radius = %g is not in %g to 1", d->method,
                      d->spectral_radius, lowest);
  size_t n = f->n = corot_model_ndof(self->model);
  f->lumped = corot_model_mass(self->model);
  f->t0 = self->t, f->h = d->step;
  corot_scheme_set_family(f, d->spectral_radius);

  f->memory = calloc(NVECTOR * n, sizeof *f->memory);
  if (!f->memory) return corot_fail(COROT_ENOMEM, "no memory for %s", d->method);
  double *next = f->memory;
  for (int j = 0; j < NHISTORY; j++, next += 2 * n) f->u[j] = next, f->v[j] = next + n;
  double **const vectors[] = {&f->a,     &f->r, &f->U, &f->V,     &f->W,      &f->w,
                              &f->trial, &f->G, &f->d, &f->apart, &f->inertia};
  for (int k = 0; k < NVECTOR - 2 * NHISTORY; k++, next += n) *vectors[k] = next;
  memcpy(f->u[0], u, n * sizeof *u);
  memcpy(f->v[0], v, n * sizeof *v);
  f->depth = 1;

  if (f->scheme->needs_acceleration) { /* a = M^-1 r at the start */
    COROT_TRY(corot_residual(self->model, self->state, self->t, u, v, f->r));
    f->counts.nfe++;
    COROT_TRY(corot_mass_solve(self->mass, f->r, f->a));
    f->r_known = true;
  }
  return add_work(self, self->t, 0);
}

#define FIXED(word, order, radius)                                                                \
  {                                                                                               \
    .kind = {.name = word, .order_min = order, .order_max = order, .radius_min = radius},         \
    .choose = fixed_choose, .create = fixed_create, .destroy = fixed_destroy, .step = fixed_step, \
    .at = fixed_at, .work = fixed_work, .changed = fixed_changed, .statistics = fixed_statistics, \
    .exchange = fixed_exchange,                                                                   \
  }
const integrator_ops corot_integrators_fixed[] = {
    FIXED("backward-euler", 1, 0),    FIXED("bdf2", 2, 0),      FIXED("bdf3", 3, 0),
    FIXED("midpoint", 2, 0),          FIXED("newmark", 2, 0),   FIXED("hht", 2, 0.5),
    FIXED("generalized-alpha", 2, 0), {.kind = {.name = NULL}},
};
