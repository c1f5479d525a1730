/* Assembles K and D, combines them with M, and factors the sum when it has to. */
#include "pencil.h"

#include <stdlib.h>
#include <string.h>

#include "core/base/sized.h"
#include "core/ode/state.h"
#include "wall_clock.h"

/* What is in p->chosen. */
static void adopt(corot_pencil *p) {
  p->solver = &p->chosen;
  p->csc = p->chosen.csc;
  p->S = p->chosen.value;
}

static corot_status allocate(const corot_linear_def *linear, corot_pencil *p) {
  COROT_TRY(corot_linsol_create(p->model, linear, &p->chosen));
  adopt(p);
  p->tentative = p->chosen.by_cost && p->chosen.ops->iterative;
  size_t nblock = corot_model_nblock(p->model);
  p->K = malloc(nblock * sizeof *p->K);
  p->D = malloc(nblock * sizeof *p->D);
  p->u = malloc(p->n * sizeof *p->u);
  p->v = malloc(p->n * sizeof *p->v);
  p->work = malloc(2 * (size_t)p->n * sizeof *p->work);
  if (!p->K || !p->D || !p->u || !p->v || !p->work)
    return corot_fail(COROT_ENOMEM, "no memory for matrices of %d unknowns", p->n);
  return COROT_OK;
}

corot_status corot_pencil_create(const corot_model *model, corot_state *state,
                                 const corot_linear_def *linear, corot_pencil **pencil) {
  COROT_TRY(COROT_GIVEN(pencil));
  if (linear) COROT_TRY(corot_linear_check(linear));
  COROT_TRY(corot_state_check(model, state, "corot_pencil_create"));
  corot_linear_def def = linear ? *linear : corot_linear_defaults();
  corot_pencil *p = calloc(1, sizeof *p);
  if (!p) return corot_fail(COROT_ENOMEM, "no memory for a pencil");
  p->model = model;
  p->state = state;
  p->n = corot_model_ndof(model);
  p->role = def.role;
  p->dirty = true;
  corot_status status = allocate(&def, p);
  if (status) {
    corot_pencil_destroy(p);
    return status;
  }
  *pencil = p;
  return COROT_OK;
}

void corot_pencil_destroy(corot_pencil *p) {
  if (!p) return;
  corot_linsol_clear(&p->chosen);
  corot_linsol_clear(&p->set_aside);
  corot_linsol_clear(&p->klu);
  free(p->K);
  free(p->D);
  free(p->u);
  free(p->v);
  free(p->work);
  free(p);
}

corot_status corot_pencil_check(const corot_pencil *p, const char *who) {
  return p ? COROT_OK : corot_fail(COROT_EINVAL, "%s: 'pencil' is NULL", who);
}

const char *corot_pencil_solver(const corot_pencil *p) { return p ? p->chosen.name : ""; }

void corot_pencil_use(corot_pencil *p, corot_tangent tangent) {
  if (p) p->tangent = tangent;
}

void corot_pencil_invalidate(corot_pencil *p) {
  if (p) p->dirty = true;
}

corot_pencil_parts corot_pencil_view(const corot_pencil *p) {
  if (!p) return (corot_pencil_parts){0};
  return (corot_pencil_parts){
      .K = (const double(*)[9])p->K, .D = (const double(*)[9])p->D, .csc = p->csc, .S = p->S};
}

corot_pencil_counts corot_pencil_statistics(const corot_pencil *p) {
  if (!p) return (corot_pencil_counts){0};
  corot_pencil_counts counts = p->counts;
  const linsol *s = &p->chosen;
  counts.niteration = p->niteration;
  if (s->ops->iterative) counts.niteration += s->ops->iterations(s->solver) - p->origin;
  return counts;
}

corot_status corot_pencil_assemble(corot_pencil *p, double t, const double *u, const double *v) {
  COROT_TRY(corot_pencil_check(p, "corot_pencil_assemble"));
  COROT_TRY(COROT_GIVEN(u));
  double start = clock_wall();
  corot_status status = corot_jacobian(p->model, p->state, t, u, v, p->tangent, p->K, p->D);
  p->dirty = status != COROT_OK;
  p->known = status == COROT_OK;
  p->assembled = p->tangent;
  p->t = t;
  memcpy(p->u, u, p->n * sizeof *u);
  for (int i = 0; i < p->n; i++) p->v[i] = v ? v[i] : 0;
  corot_linsol_move(&p->chosen, p->model, t, u);
  p->counts.nassembly++;
  p->counts.assembly_s += clock_wall() - start;
  return status;
}

corot_status corot_pencil_assemble_again(corot_pencil *p, corot_tangent tangent) {
  double start = clock_wall();
  corot_status status = corot_jacobian(p->model, p->state, p->t, p->u, p->v, tangent, p->K, NULL);
  p->dirty = p->dirty || status != COROT_OK;
  p->known = p->known && status == COROT_OK;
  p->assembled = tangent;
  p->counts.nassembly++;
  p->counts.assembly_s += clock_wall() - start;
  return status;
}

/* A combination that is made by parts. */
typedef struct combining {
  const corot_pencil *pencil;
  linsol *solver;
} combining;

static void combine_part(void *work, int from, int end) {
  const combining *c = work;
  const corot_pencil *p = c->pencil;
  const linsol *s = c->solver;
  corot_csc_combine_columns(p->model, s->csc, p->a, p->b, (const double(*)[9])p->D, p->c,
                            (const double(*)[9])p->K, from, end, s->value);
}

/* S for one of the solvers. */
static void combine(corot_pencil *p, linsol *s) {
  double start = clock_wall();
  combining c = {p, s};
  corot_team_loop(p->state->system.team, p->n, combine_part, &c);
  p->counts.ncombine++;
  p->counts.combine_s += clock_wall() - start;
}

void corot_pencil_combine(corot_pencil *p, double a, double b, double c) {
  if (!p) return;
  p->a = a, p->b = b, p->c = c;
  p->gamma = b;
  p->combined = p->known;
  p->factored = false;
  combine(p, &p->chosen);
}

/* The team of the state, which may have changed, works for its solver. */
static void share(const corot_pencil *p, const linsol *s) {
  if (s->ops->share) s->ops->share(s->solver, p->state->system.team);
}

static corot_status factor(corot_pencil *p, const linsol *s) {
  double start = clock_wall();
  bool fresh = false;
  share(p, s);
  corot_status status = s->ops->factor(s->solver, s->value, &fresh);
  p->solver = s;
  p->factored = status == COROT_OK;
  p->counts.nfactor++;
  p->counts.nfresh += fresh;
  p->counts.factor_s += clock_wall() - start;
  return status;
}

static bool no_pivots(corot_status status) {
  return status == COROT_RETRY || status == COROT_ESINGULAR;
}

/* With K cut off where it is negative. If that is no help, K is as before. */
static corot_status factor_clamped(corot_pencil *p) {
  corot_tangent before = p->assembled;
  COROT_TRY(corot_pencil_assemble_again(p, COROT_TANGENT_CLAMPED));
  combine(p, &p->chosen);
  corot_status status = factor(p, &p->chosen);
  p->counts.nclamped += status == COROT_OK;
  if (!no_pivots(status)) return status;
  COROT_TRY(corot_pencil_assemble_again(p, before));
  combine(p, &p->chosen);
  return status;
}

/* A solver of that name, *s being set on success. */
static corot_status make_solver(corot_pencil *p, const char *name, linsol *s) {
  double start = clock_wall();
  corot_linear_def def = corot_linear_defaults();
  def.solver = name, def.role = p->role;
  linsol made;
  corot_status status = corot_linsol_create(p->model, &def, &made);
  p->counts.factor_s += clock_wall() - start;
  if (status)
    corot_linsol_clear(&made);
  else
    *s = made;
  return status;
}

/* By a solver that does not mind. */
static corot_status factor_by_klu(corot_pencil *p) {
  if (!p->klu.solver) COROT_TRY(make_solver(p, "klu", &p->klu));
  combine(p, &p->klu);
  corot_status status = factor(p, &p->klu);
  p->counts.nfallback += status == COROT_OK;
  return status;
}

static corot_status solve(corot_pencil *p, double *x) {
  double start = clock_wall();
  const linsol *s = p->solver;
  share(p, s);
  if (s->ops->aim) s->ops->aim(s->solver, p->aim);
  corot_status status = s->ops->solve(s->solver, x);
  p->counts.nsolve++;
  p->counts.nlsfail += status != COROT_OK;
  p->counts.solve_s += clock_wall() - start;
  return status;
}

static corot_status factor_chosen(corot_pencil *p) {
  corot_status status = factor(p, &p->chosen);
  p->counts.nindefinite += status == COROT_RETRY;
  if (status != COROT_RETRY || p->role == COROT_ROLE_STATIC) return status;
  if (p->assembled != COROT_TANGENT_CLAMPED) status = factor_clamped(p);
  return no_pivots(status) ? factor_by_klu(p) : status;
}

/* A direct solver in the place of conjugate gradients that were chosen, or these again. The other
   one is kept: a state may come back that has it in use. */
static corot_status change_solver(corot_pencil *p) {
  linsol other = p->set_aside;
  if (!other.solver) COROT_TRY(make_solver(p, corot_linsol_direct, &other));
  p->niteration = corot_pencil_statistics(p).niteration;
  p->set_aside = p->chosen;
  p->chosen = other;
  p->origin = other.ops->iterative ? other.ops->iterations(other.solver) : 0;
  adopt(p);
  return COROT_OK;
}

/* Conjugate gradients that were chosen do not do. */
static corot_status choose_again(corot_pencil *p) {
  COROT_TRY(change_solver(p));
  p->tentative = false;
  combine(p, &p->chosen);
  return factor_chosen(p);
}

/* Whether the iterations so far have cost twice as much as a direct solver would have. */
static bool chosen_in_vain(const corot_pencil *p) {
  const linsol *s = &p->chosen;
  double direct = s->rival.factor * p->counts.nfactor + s->rival.solution * p->counts.nsolve;
  if (!p->tentative || !(direct > 0)) return false;
  return corot_pencil_statistics(p).niteration > 100 + 2 * direct;
}

corot_status corot_pencil_factor(corot_pencil *p) {
  COROT_TRY(corot_pencil_check(p, "corot_pencil_factor"));
  if (!p->combined)
    return corot_fail(COROT_EINVAL,
                      "corot_pencil_factor: there is no S: assemble K and D, and "
                      "combine them");
  if (!chosen_in_vain(p)) return factor_chosen(p);
  corot_status status = choose_again(p);
  if (status != COROT_ENOMEM || !p->tentative) return status;
  p->tentative = false; /* slow, but right */
  return factor_chosen(p);
}

static corot_status refuse_indefinite(corot_pencil *p) {
  p->counts.nindefinite++;
  return corot_fail(COROT_RETRY, "the stiffness is not positive definite");
}

static corot_status check_pivots(corot_pencil *p) {
  int negative;
  double start = clock_wall();
  corot_status status = corot_linsol_count_negative(&p->chosen, p->S, &negative);
  p->counts.factor_s += clock_wall() - start;
  return !status && negative ? refuse_indefinite(p) : status;
}

corot_status corot_pencil_factor_definite(corot_pencil *p) {
  COROT_TRY(corot_pencil_factor(p));
  return check_pivots(p);
}

void corot_pencil_aim(corot_pencil *p, double tolerance) { p->aim = tolerance; }

/* COROT_RETRY: the iteration does not converge. */
static corot_status prove(corot_pencil *p, bool *definite) {
  double start = clock_wall();
  const linsol *s = &p->chosen;
  share(p, s);
  corot_status status = s->ops->prove(s->solver, definite);
  p->counts.nsolve++;
  p->counts.nlsfail += status != COROT_OK;
  p->counts.solve_s += clock_wall() - start;
  return status;
}

corot_status corot_pencil_factor_proved(corot_pencil *p, bool *known) {
  bool definite;
  *known = true;
  COROT_TRY(corot_pencil_factor_definite(p));
  if (!p->chosen.ops->prove) return COROT_OK;
  corot_status status = prove(p, &definite);
  if (status == COROT_OK) return definite ? COROT_OK : refuse_indefinite(p);
  *known = false;
  if (status != COROT_RETRY) return status;
  if (!p->tentative) return COROT_OK;
  *known = true;
  COROT_TRY(choose_again(p));
  return check_pivots(p);
}

/* Whether the last solution showed that S is not positive definite. */
static bool met_indefinite(const corot_pencil *p) {
  const linsol *s = p->solver;
  return s->ops->met_indefinite && s->ops->met_indefinite(s->solver);
}

corot_status corot_pencil_solve(corot_pencil *p, const double *b, double *x) {
  COROT_TRY(corot_pencil_check(p, "corot_pencil_solve"));
  if (!p->factored) {
    p->counts.nsolve++, p->counts.nlsfail++;
    return corot_fail(COROT_EINVAL,
                      "corot_pencil_solve: there is no factor of S since it was combined");
  }
  if (x != b) memcpy(x, b, p->n * sizeof *x);
  corot_status status = solve(p, x);
  if (status != COROT_RETRY || !p->tentative || p->solver != &p->chosen) return status;
  if (p->role == COROT_ROLE_STATIC && met_indefinite(p)) return status; /* no solver minds less */
  COROT_TRY(choose_again(p));
  return solve(p, x);
}

static corot_status clamp(corot_pencil *p) {
  COROT_TRY(corot_pencil_assemble_again(p, COROT_TANGENT_CLAMPED));
  corot_pencil_combine(p, 0, 0, 1);
  return corot_pencil_factor(p);
}

corot_status corot_pencil_factor_downhill(corot_pencil *p) {
  corot_status status = corot_pencil_factor_definite(p);
  return status == COROT_RETRY ? clamp(p) : status;
}

corot_status corot_pencil_solve_downhill(corot_pencil *p, const double *b, double *x) {
  corot_status status = corot_pencil_solve(p, b, x);
  if (status != COROT_RETRY || !met_indefinite(p)) return status;
  p->counts.nindefinite++;
  COROT_TRY(clamp(p));
  return corot_pencil_solve(p, b, x);
}

corot_status corot_pencil_slow_part(corot_pencil *p, const double *x, double *y) {
  corot_pencil_counts counts = p->counts; /* are of the steps */
  corot_mass_multiply(p->model, x, p->work);
  corot_status status = corot_pencil_solve(p, p->work, y);
  p->counts = counts;
  return status;
}

/* --- A state that is taken away, and back ----------------------------------------------------- */

static void forget(const linsol *s) {
  if (s->solver && s->ops->forget) s->ops->forget(s->solver);
}

void corot_pencil_forget(corot_pencil *p) {
  p->known = p->combined = p->factored = false;
  p->dirty = true;
  p->solver = &p->chosen;
  forget(&p->chosen);
  forget(&p->set_aside);
  forget(&p->klu);
}

static void exchange_counts(pack *p, corot_pencil_counts *c) {
  long *const count[] = {&c->nassembly,   &c->ncombine, &c->nfactor,   &c->nfresh,  &c->nsolve,
                         &c->nindefinite, &c->nclamped, &c->nfallback, &c->nlsfail, &c->niteration};
  double *const time[] = {&c->assembly_s, &c->combine_s, &c->factor_s, &c->solve_s};
  for (size_t k = 0; k < sizeof count / sizeof *count; k++) corot_pack_long(p, count[k]);
  for (size_t k = 0; k < sizeof time / sizeof *time; k++) corot_pack_double(p, time[k]);
}

/* Which solver was chosen for the model in the beginning has to be the same; whether another one
   has taken its place since comes with the state. */
void corot_pencil_exchange(pack *p, corot_pencil *pencil) {
  bool changed = pencil->set_aside.solver && pencil->set_aside.ops->iterative;
  const char *name = changed ? pencil->set_aside.name : pencil->chosen.name;
  bool is_changed = changed, tentative = pencil->tentative;
  corot_pencil_counts counts = corot_pencil_statistics(pencil);
  corot_pack_same(p, corot_checksum(COROT_CHECKSUM, name, strlen(name)),
                  "the checksum of the linear solver's name");
  corot_pack_bool(p, &changed);
  corot_pack_bool(p, &tentative);
  exchange_counts(p, &counts);
  if (!p->reading || p->status) return;

  if (changed != is_changed) p->status = change_solver(pencil);
  if (p->status) return;
  const linsol *s = &pencil->chosen;
  pencil->tentative = tentative;
  pencil->counts = counts;
  pencil->niteration = counts.niteration;
  pencil->origin = s->ops->iterative ? s->ops->iterations(s->solver) : 0;
}
