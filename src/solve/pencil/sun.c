/* The pencil in the clothes of a SUNMatrix and a SUNLinearSolver.

   The solver says DIRECT, not MATRIX_EMBEDDED: an integrator then keeps its rules on when to set up
   again and how to correct for a gamma that has changed since. */
#include <nvector/nvector_serial.h>
#include <string.h>

#include "core/ode/trial.h"
#include "pencil.h"
#include "seam.h"
#include "solve/sundials/sun_status.h"
#include "wall_clock.h"

static SUNMatrix_ID matrix_id(SUNMatrix A) {
  (void)A;
  return SUNMATRIX_CUSTOM;
}

/* Integrators that clear the matrix before each assembly: the pencil clears its own. */
static sun_status matrix_zero(SUNMatrix A) {
  (void)A;
  return 0;
}

static void matrix_destroy(SUNMatrix A) {
  if (!A) return;
  A->content = NULL; /* the pencil is the host's */
  SUNMatFreeEmpty(A);
}

SUNMatrix corot_sun_matrix(corot_pencil *pencil, SUNContext ctx) {
  SUNMatrix A = pencil && ctx ? SUNMatNewEmpty(ctx) : NULL;
  if (!A) return NULL;
  A->content = pencil;
  A->ops->getid = matrix_id;
  A->ops->zero = matrix_zero;
  A->ops->destroy = matrix_destroy;
  return A;
}

corot_status corot_seam_matrix(SUNMatrix A, const char *who, corot_pencil **pencil) {
  if (!A || !A->ops || A->ops->getid != matrix_id || !A->content)
    return corot_fail(COROT_EINVAL, "%s: the matrix is none of corot_sun_matrix", who);
  *pencil = A->content;
  return COROT_OK;
}

static SUNLinearSolver_Type solver_type(SUNLinearSolver LS) {
  (void)LS;
  return SUNLINEARSOLVER_DIRECT;
}

static int solver_setup(SUNLinearSolver LS, SUNMatrix A) {
  (void)A;
  return sun_callback_code(corot_pencil_factor(LS->content));
}

static corot_status solve(corot_pencil *pencil, N_Vector x, N_Vector b) {
  COROT_TRY(corot_seam_vectors("corot_sun_linsol", 2 * pencil->n, 2, (N_Vector[]){x, b}));
  return corot_pencil_newton(pencil, N_VGetArrayPointer(b), N_VGetArrayPointer(x));
}

static int solver_solve(SUNLinearSolver LS, SUNMatrix A, N_Vector x, N_Vector b, sunrealtype tol) {
  (void)A, (void)tol;
  return sun_solve_code(solve(LS->content, x, b));
}

static sun_status solver_free(SUNLinearSolver LS) {
  if (!LS) return 0;
  LS->content = NULL;
  SUNLinSolFreeEmpty(LS);
  return 0;
}

SUNLinearSolver corot_sun_linsol(corot_pencil *pencil, SUNContext ctx) {
  SUNLinearSolver LS = pencil && ctx ? SUNLinSolNewEmpty(ctx) : NULL;
  if (!LS) return NULL;
  LS->content = pencil;
  LS->ops->gettype = solver_type;
  LS->ops->setup = solver_setup;
  LS->ops->solve = solver_solve;
  LS->ops->free = solver_free;
  return LS;
}

corot_status corot_pencil_linsys(corot_pencil *p, double t, N_Vector y, bool keep,
                                 sunbooleantype *made, double gamma) {
  *made = !keep || p->dirty;
  if (*made) {
    const double *u = N_VGetArrayPointer(y);
    COROT_TRY(corot_pencil_assemble(p, t, u, u + p->n));
  }
  corot_pencil_combine(p, 1, gamma, gamma * gamma);
  return COROT_OK;
}

static corot_status linsys(double t, N_Vector y, SUNMatrix A, bool keep, sunbooleantype *made,
                           double gamma) {
  corot_pencil *pencil = NULL;
  COROT_TRY(corot_seam_matrix(A, "corot_sun_linsys", &pencil));
  COROT_TRY(corot_seam_vectors("corot_sun_linsys", 2 * pencil->n, 1, &y));
  return corot_pencil_linsys(pencil, t, y, keep, made, gamma);
}

int corot_sun_linsys(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix A, sunbooleantype jok,
                     sunbooleantype *jcur, sunrealtype gamma, void *user_data, N_Vector tmp1,
                     N_Vector tmp2, N_Vector tmp3) {
  (void)fy, (void)user_data, (void)tmp1, (void)tmp2, (void)tmp3;
  return sun_callback_code(linsys(t, y, A, jok, jcur, gamma));
}

int corot_sun_linsys_ark(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix A, SUNMatrix M,
                         sunbooleantype jok, sunbooleantype *jcur, sunrealtype gamma,
                         void *user_data, N_Vector tmp1, N_Vector tmp2, N_Vector tmp3) {
  (void)M;
  return corot_sun_linsys(t, y, fy, A, jok, jcur, gamma, user_data, tmp1, tmp2, tmp3);
}

corot_status corot_rate(const corot_sun_data *data, double t, N_Vector y, N_Vector ydot) {
  int n = corot_model_ndof(data->model);
  const double *u = N_VGetArrayPointer(y), *v = u + n;
  double *du = N_VGetArrayPointer(ydot), *dv = du + n;
  if (corot_model_mass_kind(data->model) == COROT_MASS_LUMPED)
    return corot_rhs_trial(data->model, data->state, t, u, du);
  if (!data->mass)
    return corot_fail(COROT_EINVAL,
                      "corot_sun_rhs: consistent mass needs a corot_mass_solver in corot_sun_data");
  COROT_TRY(corot_residual_trial(data->model, data->state, t, u, v, dv));
  memcpy(du, v, n * sizeof *du);
  return corot_mass_solve(data->mass, dv, dv);
}

static corot_status rhs(const corot_sun_data *data, double t, N_Vector y, N_Vector ydot) {
  COROT_TRY(corot_seam_data(data, "corot_sun_rhs"));
  COROT_TRY(corot_seam_vectors("corot_sun_rhs", 2 * corot_model_ndof(data->model), 2,
                               (N_Vector[]){y, ydot}));
  return corot_rate(data, t, y, ydot);
}

int corot_sun_rhs(sunrealtype t, N_Vector y, N_Vector ydot, void *user_data) {
  return sun_callback_code(rhs(user_data, t, y, ydot));
}

const char *corot_sundials_version(void) {
  static _Thread_local char version[32];
  if (SUNDIALSGetVersion(version, sizeof version)) version[0] = 0;
  return version;
}
