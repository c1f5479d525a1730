/* One linear solve on the next order of elements: corot/space.h says what it means. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/base/sized.h"
#include "raised.h"
#include "rigid_fit.h"
#include "rigid_modes.h"
#include "solve/pencil/pencil.h"

/* A displacement of no more than this part of the body's length is rounding. */
#define NOTHING 1e-12

/* Of conjugate gradients, if nothing else is asked for. */
#define TOLERANCE 1e-4

typedef struct estimation {
  const corot_space_moment *at;
  raised fine;
  raised_fields now;
  rigid_modes modes;
  double *room;   /* of the fields, and of */
  double *e, *r;  /* [n] the estimate, and what is out of balance, */
  double *work;   /* [n] */
  double (*d)[3]; /* [nnode] displacement */
  corot_space_estimate result;
} estimation;

static corot_status allocate(estimation *s) {
  size_t n = (size_t)s->fine.n, nnode = (size_t)s->fine.mesh->nnode;
  s->room = calloc(6 * n + 6 * nnode, sizeof *s->room);
  if (!s->room) return corot_fail(COROT_ENOMEM, "no memory for the space error of %zu unknowns", n);
  double **const part[] = {&s->now.u, &s->now.v, &s->now.a, &s->e, &s->r, &s->work};
  for (int k = 0; k < 6; k++) *part[k] = s->room + k * n;
  s->now.x = (double(*)[3])(s->room + 6 * n);
  s->d = s->now.x + nnode;
  return COROT_OK;
}

/* --- The system K2 e = r2 - M2 a --- */

static corot_status find_imbalance(estimation *s) {
  const raised *f = &s->fine;
  corot_space_enter(s->at, f->state);
  COROT_TRY(corot_residual(f->model, f->state, s->at->t, s->now.u, s->now.v, s->r));
  if (!s->at->still) {
    corot_mass_multiply(f->model, s->now.a, s->work);
    for (int i = 0; i < f->n; i++) s->r[i] -= s->work[i];
  }
  corot_rigid_modes_balance(&s->modes, s->r);
  return COROT_OK;
}

/* With the tangent of a model on the ten-node tets, and its state. */
static corot_status solve(estimation *s, const corot_linear_def *linear, const corot_model *model,
                          corot_state *state, corot_tangent tangent) {
  double frequency = corot_model_frequency(model), tie = SPACE_TIE * frequency * frequency;
  corot_pencil *p = NULL;
  COROT_TRY(corot_pencil_create(model, state, linear, &p));
  corot_pencil_use(p, tangent);
  corot_status status = corot_pencil_assemble(p, s->at->t, s->now.u, s->now.v);
  corot_pencil_combine(p, s->modes.any ? tie : 0, 0, 1);
  if (!status) status = corot_pencil_factor_definite(p);
  if (!status) status = corot_pencil_solve(p, s->r, s->e);
  s->result.niteration = corot_pencil_statistics(p).niteration;
  corot_pencil_destroy(p);
  return status;
}

/* With the stiffness of the material alone, in the frames of polar, which is never negative. */
static corot_status solve_without_stress(estimation *s, const corot_model_def *def,
                                         const corot_linear_def *linear) {
  const raised *f = &s->fine;
  if (corot_strain_find(def->strain)->linear_in_frames)
    return solve(s, linear, f->model, f->state, COROT_TANGENT_HELD);
  corot_model_def of = *def;
  corot_model *model = NULL;
  corot_state *state = NULL;
  of.mesh = f->mesh, of.strain = "polar", of.viscosity = COROT_VISCOSITY_AUTO;
  COROT_TRY(corot_model_create(&of, &model));
  corot_status status = corot_state_create(model, &state);
  if (!status) {
    corot_space_enter(s->at, state);
    status = solve(s, linear, model, state, COROT_TANGENT_HELD);
  }
  corot_state_destroy(state);
  corot_model_destroy(model);
  return status;
}

static corot_status find_error(estimation *s, const corot_model_def *def,
                               const corot_linear_def *given) {
  corot_linear_def linear = corot_linear_defaults();
  linear.solver = "pcg", linear.preconditioner = "multigrid", linear.tolerance = TOLERANCE;
  if (given) linear = *given;
  linear.refinement = s->fine.refinement;
  linear.role = COROT_ROLE_STATIC; /* what is not positive definite is to be told */
  corot_status status = solve(s, &linear, s->fine.model, s->fine.state, COROT_TANGENT_EXACT);
  s->result.indefinite = status == COROT_RETRY || status == COROT_ESINGULAR;
  if (s->result.indefinite) status = solve_without_stress(s, def, &linear);
  if (!status) corot_rigid_modes_leave(&s->modes, s->e);
  return status;
}

/* --- What it says --- */

/* Over the mass of what is free to move. */
static double root_of_mean_square(estimation *s, const double *x) {
  const double *mass = corot_model_mass(s->fine.model);
  double square = 0, whole = 0;
  corot_mass_multiply(s->fine.model, x, s->work);
  for (int i = 0; i < s->fine.n; i++) square += x[i] * s->work[i], whole += mass[i] / 3;
  return sqrt(fmax(0, square) / whole);
}

/* s->r = u + e, less rigid motions, which is no longer needed for anything else. */
static corot_status find_displacement(estimation *s) {
  const raised *f = &s->fine;
  const int(*dof)[3] = corot_model_dof(f->model);
  for (int i = 0; i < f->n; i++) s->r[i] = s->now.u[i] + s->e[i];
  corot_nodal(f->model, s->at->t, s->r, NULL, s->d, NULL);
  COROT_TRY(corot_fit_out(f->model, &s->modes.rigid, s->d));
  for (int i = 0; i < f->mesh->nnode; i++)
    for (int c = 0; c < 3; c++)
      if (dof[i][c] >= 0) s->r[dof[i][c]] = s->d[i][c];
  return COROT_OK;
}

static corot_status judge(estimation *s) {
  corot_space_estimate *e = &s->result;
  COROT_TRY(find_displacement(s));
  e->error = root_of_mean_square(s, s->e);
  e->displacement = root_of_mean_square(s, s->r);
  bool nothing = !(e->displacement > NOTHING * corot_model_length(s->fine.model));
  e->relative = nothing ? 0 : e->error / e->displacement;
  if (isfinite(e->error) && isfinite(e->displacement)) return COROT_OK;
  return corot_fail(COROT_RETRY, "space error: the solution of the linear system is not finite");
}

static void hand_out(const estimation *s, int nnode, double (*correction)[3]) {
  const int(*dof)[3] = corot_model_dof(s->fine.model);
  for (int i = 0; i < nnode; i++)
    for (int c = 0; c < 3; c++) correction[i][c] = dof[i][c] >= 0 ? s->e[dof[i][c]] : 0;
}

/* --- All of it --- */

static corot_status check(const corot_model_def *def, const corot_model *model,
                          const corot_space_moment *at) {
  if (def->hierarchy)
    return corot_fail(COROT_EINVAL, "space error: not of a hierarchy of two strain measures");
  if (corot_mesh_order(corot_model_mesh(model)) != 1)
    return corot_fail(COROT_EINVAL, "space error: not of ten-node tets");
  if (!at->u || (!at->v && !at->still))
    return corot_fail(COROT_EINVAL, "space error: the state has no %s", at->u ? "velocity" : "u");
  return COROT_OK;
}

static corot_status estimate_error(estimation *s, const corot_model_def *def,
                                   const corot_model *model, const corot_linear_def *linear) {
  COROT_TRY(corot_raised_create(def, model, &s->fine));
  COROT_TRY(allocate(s));
  COROT_TRY(corot_raised_take(model, s->at, &s->fine, &s->now));
  COROT_TRY(corot_rigid_modes_create(s->fine.model, (const double(*)[3])s->now.x, &s->modes));
  COROT_TRY(find_imbalance(s));
  COROT_TRY(find_error(s, def, linear));
  return judge(s);
}

corot_status corot_space_error(const corot_model_def *def, const corot_model *model,
                               const corot_space_moment *at, const corot_linear_def *linear,
                               double (*correction)[3], corot_space_estimate *estimate) {
  COROT_TRY(COROT_DEFINED(def, corot_model_def));
  COROT_TRY(COROT_GIVEN(model));
  COROT_TRY(COROT_GIVEN(at));
  COROT_TRY(COROT_GIVEN(estimate));
  COROT_TRY(check(def, model, at));
  estimation s = {.at = at};
  corot_status status = estimate_error(&s, def, model, linear);
  if (!status) {
    if (correction) hand_out(&s, corot_model_mesh(model)->nnode, correction);
    *estimate = s.result;
  }
  corot_rigid_modes_clear(&s.modes);
  corot_raised_clear(&s.fine);
  free(s.room);
  return status;
}
