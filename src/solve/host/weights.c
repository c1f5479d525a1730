/* Error weights by the longest vector of a node. */
#include "host.h"

#include <math.h>
#include <nvector/nvector_serial.h>

#include "solve/pencil/seam.h"
#include "solve/sundials/sun_status.h"

/* Largest length of a node's vector in x [n], infinity if one is not a number. */
static double largest_vector(const corot_model *model, const double *x) {
  int nnode = corot_model_mesh(model)->nnode;
  const int(*dof)[3] = corot_model_dof(model);
  double largest = 0;
  for (int n = 0; n < nnode; n++) {
    double square = 0;
    for (int c = 0; c < 3; c++)
      if (dof[n][c] >= 0) square += x[dof[n][c]] * x[dof[n][c]];
    if (!(square < INFINITY)) return INFINITY;
    largest = fmax(largest, square);
  }
  return sqrt(largest);
}

corot_status corot_weigh(const corot_model *model, const tolerance *tol, const double *y,
                         double *w) {
  int n = corot_model_ndof(model);
  double wu = 1 / (tol->rtol * largest_vector(model, y) + tol->atol_displacement);
  double wv = 1 / (tol->rtol * largest_vector(model, y + n) + tol->atol_velocity);
  if (!(wu > 0 && wv > 0))
    return corot_fail(COROT_EINTEGRATE, "the motion exceeds double precision");
  for (int i = 0; i < n; i++) w[i] = wu, w[n + i] = wv;
  return COROT_OK;
}

static corot_status weigh_vectors(const corot_sun_data *data, N_Vector y, N_Vector weight) {
  COROT_TRY(corot_seam_data(data, "corot_sun_weights"));
  COROT_TRY(corot_seam_vectors("corot_sun_weights", 2 * corot_model_ndof(data->model), 2,
                               (N_Vector[]){y, weight}));
  tolerance tol = {data->rtol, data->atol_displacement, data->atol_velocity};
  if (!(tol.rtol > 0 && tol.atol_displacement > 0 && tol.atol_velocity > 0))
    return corot_fail(COROT_EINVAL,
                      "corot_sun_weights: rtol = %g, atol_displacement = %g, atol_velocity = %g in "
                      "corot_sun_data: corot_sun_advise has positive ones",
                      tol.rtol, tol.atol_displacement, tol.atol_velocity);
  return corot_weigh(data->model, &tol, N_VGetArrayPointer(y), N_VGetArrayPointer(weight));
}

int corot_sun_weights(N_Vector y, N_Vector weight, void *user_data) {
  return sun_callback_code(weigh_vectors(user_data, y, weight));
}
