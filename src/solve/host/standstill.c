/* Equilibria of a host's KINSOL: F(u) = -r(u), and K in the clothes of a SUNMatrix. Nothing moves,
   so that any velocity will do: u itself is passed for it. */
#include <float.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdlib.h>

#include "core/ode/state.h"
#include "core/ode/trial.h"
#include "host.h"
#include "solve/pencil/pencil.h"
#include "solve/pencil/seam.h"
#include "solve/sundials/sun_status.h"

static double *values(N_Vector x) { return N_VGetArrayPointer(x); }

static corot_status check(const char *who, const corot_sun_data *d, int count, const N_Vector *x) {
  COROT_TRY(corot_seam_data(d, who));
  COROT_TRY(corot_seam_vectors(who, corot_model_ndof(d->model), count, x));
  if (d->state->still) return COROT_OK;
  return corot_fail(COROT_EINVAL, "%s: call corot_state_stand_still first", who);
}

static corot_status force(const corot_sun_data *d, N_Vector u, N_Vector F) {
  COROT_TRY(check("corot_sun_force", d, 2, (N_Vector[]){u, F}));
  double *f = values(F), t = d->state->load_time;
  COROT_TRY(corot_residual_trial(d->model, d->state, t, values(u), values(u), f));
  for (int i = 0; i < corot_model_ndof(d->model); i++) f[i] = -f[i];
  return COROT_OK;
}

int corot_sun_force(N_Vector u, N_Vector F, void *user_data) {
  return sun_callback_code(force(user_data, u, F));
}

/* --- Scales ----------------------------------------------------------------------------------- */

corot_status corot_largest_force(const corot_model *model, corot_state *state, double t,
                                 const double *u, const double *r, double (*f)[3],
                                 double *largest) {
  const int(*dof)[3] = corot_model_dof(model);
  double most = 0;
  COROT_TRY(corot_elastic_force(model, state, t, u, f));
  for (int n = 0; n < corot_model_mesh(model)->nnode; n++)
    for (int c = 0; c < 3; c++) {
      double outer = dof[n][c] >= 0 ? r[dof[n][c]] + f[n][c] : 0;
      most = fmax(most, fmax(fabs(f[n][c]), fabs(outer)));
    }
  *largest = most;
  return COROT_OK;
}

double corot_rounding_of_forces(const corot_pencil *p) {
  double stiffest = 0;
  for (int i = 0; i < p->n; i++) stiffest = fmax(stiffest, p->S[p->csc->diagonal[i]]);
  return 4 * DBL_EPSILON * stiffest;
}

double corot_longest_edge(const corot_mesh *mesh) {
  double longest = 0;
  for (int k = 0; k < mesh->ntet; k++)
    for (int a = 1; a < 4; a++)
      for (int b = 0; b < a; b++) {
        const double *x = mesh->x[mesh->tet[k][a]], *y = mesh->x[mesh->tet[k][b]];
        longest = fmax(longest, hypot(hypot(x[0] - y[0], x[1] - y[1]), x[2] - y[2]));
      }
  return longest;
}

static corot_status assemble(corot_pencil *p, const double *u) {
  COROT_TRY(corot_pencil_assemble(p, p->state->load_time, u, u));
  corot_pencil_combine(p, 0, 0, 1);
  return COROT_OK;
}

/* With room for r [n] and f [nnode]. */
static corot_status scale(const corot_sun_data *d, const double *u, double *r, double (*f)[3],
                          double *force, double *rounding) {
  double t = d->state->load_time, size = 0;
  COROT_TRY(corot_residual(d->model, d->state, t, u, u, r));
  COROT_TRY(assemble(d->pencil, u));
  COROT_TRY(corot_largest_force(d->model, d->state, t, u, r, f, force));
  for (int i = 0; i < d->pencil->n; i++) size = fmax(size, fabs(u[i]));
  size += corot_longest_edge(corot_model_mesh(d->model));
  *rounding = size * corot_rounding_of_forces(d->pencil);
  return COROT_OK;
}

corot_status corot_sun_force_scale(const corot_sun_data *d, const double *u, double *largest,
                                   double *rounding) {
  double force = 0, rest = 0;
  COROT_TRY(check("corot_sun_force_scale", d, 0, NULL));
  COROT_TRY(corot_seam_pencil(d->pencil, d, "corot_sun_force_scale"));
  double *r = malloc(d->pencil->n * sizeof *r);
  double(*f)[3] = malloc(corot_model_mesh(d->model)->nnode * sizeof *f);
  corot_status status =
      r && f ? scale(d, u, r, f, &force, &rest) : corot_fail(COROT_ENOMEM, "no memory for forces");
  free(r), free(f);
  COROT_TRY(status);
  *largest = force;
  *rounding = rest;
  return COROT_OK;
}

/* --- A host's KINSOL -------------------------------------------------------------------------- */

static corot_status open_rest(corot_sun_rest *rest, N_Vector u) {
  const corot_sun_data *d = &rest->data;
  COROT_TRY(corot_seam_data(d, "corot_sun_rest_open"));
  COROT_TRY(corot_seam_pencil(d->pencil, d, "corot_sun_rest_open"));
  if (d->pencil->role != COROT_ROLE_STATIC)
    return corot_fail(COROT_EINVAL, "corot_sun_rest_open: the pencil's role is not static");
  COROT_TRY(corot_seam_vectors("corot_sun_rest_open", d->pencil->n, 1, &u));
  rest->u_scale = N_VClone(u);
  rest->f_scale = N_VClone(u);
  rest->A = corot_sun_matrix(d->pencil, u->sunctx);
  rest->LS = corot_sun_linsol_static(d->pencil, u->sunctx);
  if (!rest->u_scale || !rest->f_scale || !rest->A || !rest->LS)
    return corot_fail(COROT_ENOMEM, "no memory for an equilibrium of %d unknowns", d->pencil->n);
  N_VConst(1 / corot_model_length(d->model), rest->u_scale);
  N_VConst(1, rest->f_scale);
  corot_pencil_use(d->pencil, COROT_TANGENT_EXACT);
  return COROT_OK;
}

corot_status corot_sun_rest_open(corot_sun_rest *rest, void *memory, corot_pencil *pencil,
                                 const corot_sun_data *data, N_Vector u) {
  if (!rest || !memory || !data)
    return corot_fail(COROT_EINVAL, "corot_sun_rest_open: there is no %s",
                      !rest    ? "corot_sun_rest"
                      : memory ? "corot_sun_data"
                               : "KINSOL");
  *rest = (corot_sun_rest){.data = *data, .memory = memory};
  rest->data.pencil = pencil;
  corot_status status = open_rest(rest, u);
  if (status) corot_sun_rest_close(rest);
  return status;
}

void corot_sun_rest_close(corot_sun_rest *rest) {
  if (!rest) return;
  if (rest->LS) SUNLinSolFree(rest->LS);
  if (rest->A) SUNMatDestroy(rest->A);
  if (rest->u_scale) N_VDestroy(rest->u_scale);
  if (rest->f_scale) N_VDestroy(rest->f_scale);
  *rest = (corot_sun_rest){0};
}

/* --- Direct ----------------------------------------------------------------------------------- */

static corot_status make_jacobian(corot_pencil *p, N_Vector u) {
  COROT_TRY(corot_seam_vectors("corot_sun_jacobian_static", p->n, 1, &u));
  return assemble(p, values(u));
}

int corot_sun_jacobian_static(N_Vector u, N_Vector F, SUNMatrix A, void *user_data, N_Vector tmp1,
                              N_Vector tmp2) {
  (void)F, (void)user_data, (void)tmp1, (void)tmp2;
  corot_pencil *pencil = NULL;
  corot_status status = corot_seam_matrix(A, "corot_sun_jacobian_static", &pencil);
  return sun_callback_code(status ? status : make_jacobian(pencil, u));
}

static int solver_setup(SUNLinearSolver LS, SUNMatrix A) {
  (void)A;
  return sun_callback_code(corot_pencil_factor_downhill(LS->content));
}

static corot_status solve(corot_pencil *p, N_Vector x, N_Vector b) {
  COROT_TRY(corot_seam_vectors("corot_sun_linsol_static", p->n, 2, (N_Vector[]){x, b}));
  return corot_pencil_solve_downhill(p, values(b), values(x));
}

static int solver_solve(SUNLinearSolver LS, SUNMatrix A, N_Vector x, N_Vector b, sunrealtype tol) {
  (void)A, (void)tol;
  return sun_solve_code(solve(LS->content, x, b));
}

SUNLinearSolver corot_sun_linsol_static(corot_pencil *pencil, SUNContext ctx) {
  SUNLinearSolver LS = corot_sun_linsol(pencil, ctx);
  if (!LS) return NULL;
  LS->ops->setup = solver_setup;
  LS->ops->solve = solver_solve;
  return LS;
}

/* --- Krylov ----------------------------------------------------------------------------------- */

static corot_status times(const corot_sun_data *d, N_Vector u, N_Vector x, N_Vector Jx) {
  COROT_TRY(check("corot_sun_jtimes_static", d, 3, (N_Vector[]){u, x, Jx}));
  double t = d->state->load_time, *j = values(Jx);
  COROT_TRY(corot_jvp(d->model, d->state, t, values(u), values(u), COROT_TANGENT_EXACT, values(x),
                      values(x), j));
  for (int i = 0; i < corot_model_ndof(d->model); i++) j[i] = -j[i];
  return COROT_OK;
}

int corot_sun_jtimes_static(N_Vector v, N_Vector Jv, N_Vector u, sunbooleantype *new_u,
                            void *user_data) {
  (void)new_u;
  return sun_callback_code(times(user_data, u, v, Jv));
}

static corot_status set_up(const corot_sun_data *d, N_Vector u) {
  COROT_TRY(check("corot_sun_psetup_static", d, 1, &u));
  COROT_TRY(corot_seam_pencil(d->pencil, d, "corot_sun_psetup_static"));
  COROT_TRY(make_jacobian(d->pencil, u));
  return corot_pencil_factor_downhill(d->pencil);
}

int corot_sun_psetup_static(N_Vector u, N_Vector uscale, N_Vector F, N_Vector fscale,
                            void *user_data) {
  (void)uscale, (void)F, (void)fscale;
  return sun_callback_code(set_up(user_data, u));
}

static corot_status precondition(const corot_sun_data *d, N_Vector v) {
  COROT_TRY(check("corot_sun_psolve_static", d, 1, &v));
  COROT_TRY(corot_seam_pencil(d->pencil, d, "corot_sun_psolve_static"));
  return corot_pencil_solve(d->pencil, values(v), values(v));
}

int corot_sun_psolve_static(N_Vector u, N_Vector uscale, N_Vector F, N_Vector fscale, N_Vector v,
                            void *user_data) {
  (void)u, (void)uscale, (void)F, (void)fscale;
  return sun_callback_code(precondition(user_data, v));
}
