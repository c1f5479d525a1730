/* Products and preconditioners for the Krylov methods of SUNDIALS: of y' = f, of the residual form,
   and of an equilibrium. */
#include <nvector/nvector_serial.h>
#include <string.h>

#include "host.h"
#include "solve/pencil/pencil.h"
#include "solve/pencil/seam.h"
#include "solve/sundials/sun_status.h"

static double *values(N_Vector x) { return N_VGetArrayPointer(x); }

/* What all callbacks ask of their arguments: unknowns by `share` times the degrees of freedom. */
static corot_status check(const char *who, const corot_sun_data *data, bool pencil, int share,
                          int count, const N_Vector *x) {
  COROT_TRY(corot_seam_data(data, who));
  if (pencil) COROT_TRY(corot_seam_pencil(data->pencil, data, who));
  return corot_seam_vectors(who, share * corot_model_ndof(data->model), count, x);
}

/* The exact derivative of r at (t, u, v) along (du, dv), with the frames that the state is in. */
static corot_status product(const corot_sun_data *d, double t, const double *u, const double *v,
                            const double *du, const double *dv, double *jv) {
  return corot_jvp(d->model, d->state, t, u, v, COROT_TANGENT_EXACT, du, dv, jv);
}

/* --- y' = f ----------------------------------------------------------------------------------- */

static corot_status times(const corot_sun_data *d, double t, N_Vector y, N_Vector x, N_Vector Jx) {
  COROT_TRY(check("corot_sun_jtimes", d, false, 2, 3, (N_Vector[]){y, x, Jx}));
  int n = corot_model_ndof(d->model);
  const double *u = values(y), *du = values(x), *mass = corot_model_mass(d->model);
  double *ju = values(Jx), *jv = ju + n;
  COROT_TRY(product(d, t, u, u + n, du, du + n, jv));
  memcpy(ju, du + n, n * sizeof *ju);
  if (d->mass) return corot_mass_solve(d->mass, jv, jv);
  if (corot_model_mass_kind(d->model) != COROT_MASS_LUMPED)
    return corot_fail(COROT_EINVAL, "corot_sun_jtimes: consistent mass needs a corot_mass_solver");
  for (int i = 0; i < n; i++) jv[i] /= mass[i];
  return COROT_OK;
}

int corot_sun_jtimes(N_Vector v, N_Vector Jv, sunrealtype t, N_Vector y, N_Vector fy,
                     void *user_data, N_Vector tmp) {
  (void)fy, (void)tmp;
  return sun_callback_code(times(user_data, t, y, v, Jv));
}

static corot_status set_up(const char *who, const corot_sun_data *d, double t, N_Vector y,
                           bool keep, sunbooleantype *made, double gamma) {
  COROT_TRY(check(who, d, true, 2, 1, &y));
  COROT_TRY(corot_pencil_linsys(d->pencil, t, y, keep, made, gamma));
  return corot_pencil_factor(d->pencil);
}

int corot_sun_psetup(sunrealtype t, N_Vector y, N_Vector fy, sunbooleantype jok,
                     sunbooleantype *jcur, sunrealtype gamma, void *user_data) {
  (void)fy;
  return sun_callback_code(set_up("corot_sun_psetup", user_data, t, y, jok, jcur, gamma));
}

typedef corot_status newton(corot_pencil *pencil, const double *r, double *x);

static corot_status precondition(const char *who, const corot_sun_data *d, newton *solve,
                                 N_Vector r, N_Vector z) {
  COROT_TRY(check(who, d, true, 2, 2, (N_Vector[]){r, z}));
  return solve(d->pencil, values(r), values(z));
}

int corot_sun_psolve(sunrealtype t, N_Vector y, N_Vector fy, N_Vector r, N_Vector z,
                     sunrealtype gamma, sunrealtype delta, int lr, void *user_data) {
  (void)t, (void)y, (void)fy, (void)gamma, (void)delta, (void)lr;
  return sun_callback_code(precondition("corot_sun_psolve", user_data, corot_pencil_newton, r, z));
}

/* --- F(t, y, y') = 0 -------------------------------------------------------------------------- */

/* (cj du - dv, cj M dv - dr). */
static corot_status times_dae(const corot_sun_data *d, double t, double cj, N_Vector y, N_Vector x,
                              N_Vector Jx) {
  COROT_TRY(check("corot_sun_jtimes_dae", d, false, 2, 3, (N_Vector[]){y, x, Jx}));
  int n = corot_model_ndof(d->model);
  const double *u = values(y), *du = values(x), *dv = du + n;
  double *Ju = values(Jx), *Jv = Ju + n;
  COROT_TRY(product(d, t, u, u + n, du, dv, Ju)); /* dr, for now */
  corot_mass_multiply(d->model, dv, Jv);
  for (int i = 0; i < n; i++) {
    Jv[i] = cj * Jv[i] - Ju[i];
    Ju[i] = cj * du[i] - dv[i];
  }
  return COROT_OK;
}

int corot_sun_jtimes_dae(sunrealtype t, N_Vector y, N_Vector yp, N_Vector F, N_Vector v,
                         N_Vector Jv, sunrealtype cj, void *user_data, N_Vector tmp1,
                         N_Vector tmp2) {
  (void)yp, (void)F, (void)tmp1, (void)tmp2;
  return sun_callback_code(times_dae(user_data, t, cj, y, v, Jv));
}

int corot_sun_psetup_dae(sunrealtype t, N_Vector y, N_Vector yp, N_Vector F, sunrealtype cj,
                         void *user_data) {
  (void)yp, (void)F;
  sunbooleantype made;
  return sun_callback_code(set_up("corot_sun_psetup_dae", user_data, t, y, false, &made, 1 / cj));
}

int corot_sun_psolve_dae(sunrealtype t, N_Vector y, N_Vector yp, N_Vector F, N_Vector r, N_Vector z,
                         sunrealtype cj, sunrealtype delta, void *user_data) {
  (void)t, (void)y, (void)yp, (void)F, (void)cj, (void)delta;
  return sun_callback_code(
      precondition("corot_sun_psolve_dae", user_data, corot_pencil_newton_dae, r, z));
}
