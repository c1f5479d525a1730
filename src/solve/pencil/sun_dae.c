/* The pencil for the residual form, F(t, y, y') = (u' - v, M v' - r) of y = (u, v), of IDA. */
#include <nvector/nvector_serial.h>

#include "core/ode/trial.h"
#include "pencil.h"
#include "seam.h"
#include "solve/sundials/sun_status.h"
#include "wall_clock.h"

static corot_status solve(corot_pencil *pencil, N_Vector x, N_Vector b) {
  COROT_TRY(corot_seam_vectors("corot_sun_linsol_dae", 2 * pencil->n, 2, (N_Vector[]){x, b}));
  return corot_pencil_newton_dae(pencil, N_VGetArrayPointer(b), N_VGetArrayPointer(x));
}

static int solver_solve(SUNLinearSolver LS, SUNMatrix A, N_Vector x, N_Vector b, sunrealtype tol) {
  (void)A, (void)tol;
  return sun_solve_code(solve(LS->content, x, b));
}

SUNLinearSolver corot_sun_linsol_dae(corot_pencil *pencil, SUNContext ctx) {
  SUNLinearSolver LS = corot_sun_linsol(pencil, ctx);
  if (LS) LS->ops->solve = solver_solve;
  return LS;
}

int corot_sun_jacobian_dae(sunrealtype t, sunrealtype cj, N_Vector y, N_Vector yp, N_Vector F,
                           SUNMatrix A, void *user_data, N_Vector tmp1, N_Vector tmp2,
                           N_Vector tmp3) {
  (void)yp;
  sunbooleantype current;
  return corot_sun_linsys(t, y, F, A, 0, &current, 1 / cj, user_data, tmp1, tmp2, tmp3);
}

corot_status corot_defect(const corot_sun_data *data, double t, N_Vector y, N_Vector yp,
                          N_Vector F) {
  int n = corot_model_ndof(data->model);
  const double *u = N_VGetArrayPointer(y), *v = u + n;
  const double *ut = N_VGetArrayPointer(yp), *vt = ut + n;
  double *Fu = N_VGetArrayPointer(F), *Fv = Fu + n;

  COROT_TRY(corot_residual_trial(data->model, data->state, t, u, v, Fu)); /* r, for now */
  corot_mass_multiply(data->model, vt, Fv);
  for (int i = 0; i < n; i++) {
    Fv[i] -= Fu[i];
    Fu[i] = ut[i] - v[i];
  }
  return COROT_OK;
}

static corot_status residual(const corot_sun_data *data, double t, N_Vector y, N_Vector yp,
                             N_Vector F) {
  COROT_TRY(corot_seam_data(data, "corot_sun_residual"));
  COROT_TRY(corot_seam_vectors("corot_sun_residual", 2 * corot_model_ndof(data->model), 3,
                               (N_Vector[]){y, yp, F}));
  return corot_defect(data, t, y, yp, F);
}

int corot_sun_residual(sunrealtype t, N_Vector y, N_Vector yp, N_Vector F, void *user_data) {
  return sun_callback_code(residual(user_data, t, y, yp, F));
}
