/* Looks at what a host hands over. */
#include "seam.h"

#include <nvector/nvector_serial.h>

#include "core/ode/state.h"
#include "pencil.h"

corot_status corot_seam_data(const corot_sun_data *data, const char *who) {
  if (data) return corot_state_check(data->model, data->state, who);
  return corot_fail(COROT_EINVAL, "%s: user_data is NULL, and no corot_sun_data", who);
}

corot_status corot_seam_pencil(const corot_pencil *pencil, const corot_sun_data *data,
                               const char *who) {
  COROT_TRY(corot_pencil_check(pencil, who));
  if (data && (pencil->model != data->model || pencil->state != data->state))
    return corot_fail(COROT_EINVAL, "%s: the pencil is of another model or state", who);
  return COROT_OK;
}

/* A vector on another device, or in parts, has no array that we could read. */
static bool has_array(N_Vector x) {
  const struct _generic_N_Vector_Ops *ops = x->ops;
  return ops && ops->nvgetarraypointer && ops->nvgetlength && !ops->nvgetdevicearraypointer &&
         N_VGetArrayPointer(x);
}

corot_status corot_seam_vectors(const char *who, int n, int count, const N_Vector *x) {
  for (int k = 0; k < count; k++) {
    if (!x[k]) return corot_fail(COROT_EINVAL, "%s: vector %d of %d is NULL", who, k + 1, count);
    if (!has_array(x[k]))
      return corot_fail(COROT_EINVAL,
                        "%s: vector %d of %d has no array in memory: take a serial N_Vector", who,
                        k + 1, count);
    long length = (long)N_VGetLength(x[k]);
    if (length != n)
      return corot_fail(COROT_EINVAL, "%s: vector %d of %d has %ld numbers, the model asks for %d",
                        who, k + 1, count, length, n);
  }
  return COROT_OK;
}
