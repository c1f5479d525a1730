/* Values of variables, all of which are 64-bit floating point numbers. */
#include <math.h>
#include <string.h>

#include "instance.h"

/* The variables of a list, and that their numbers are as many as there is room for. */
static corot_status check_list(const instance *in, const fmi3ValueReference reference[], size_t n,
                               const void *value, size_t nvalue) {
  size_t count = 0;
  if (n > 0) COROT_TRY(instance_given(reference, "valueReferences"));
  if (nvalue > 0) COROT_TRY(instance_given(value, "values"));
  for (size_t i = 0; i < n; i++) {
    const variable *v;
    COROT_TRY(instance_variable(in, reference[i], &v));
    count += (size_t)v->size;
  }
  if (count == nvalue) return COROT_OK;
  return corot_fail(COROT_EINVAL, "these variables have %zu values, and nValues is %zu", count,
                    nvalue);
}

/* --- Get --- */

static corot_status find_slope(instance *in, int which, double *value) {
  size_t n = (size_t)corot_model_ndof(in->body.model);
  if (which == 0) {
    memcpy(value, in->now.v, n * sizeof *value);
    return COROT_OK;
  }
  COROT_TRY(instance_slopes(in));
  return slopes_find(&in->slopes, &in->now, value);
}

/* What follows from the others is known from Initialization Mode on. */
static corot_status get_calculated(instance *in, const variable *v, double *value) {
  if (in->mode == INSTANTIATED)
    return corot_fail(COROT_EINVAL, "%s has no value before Initialization Mode", v->name);
  COROT_TRY(instance_settle(in));
  if (v->kind == VARIABLE_OUTPUT) {
    COROT_TRY(instance_look(in));
    *value = in->sight.value[v->index];
    return COROT_OK;
  }
  if (v->kind == VARIABLE_SLOPE) return find_slope(in, v->index, value);
  memcpy(value, v->index == 0 ? in->now.u : in->now.v, (size_t)v->size * sizeof *value);
  return COROT_OK;
}

static corot_status get_one(instance *in, const variable *v, double *value) {
  switch (v->kind) {
    case VARIABLE_TIME:
      *value = in->now.t;
      return COROT_OK;
    case VARIABLE_PARAMETER:
      *value =
          *body_material_at(&in->body.material[v->index / BODY_MATERIAL], v->index % BODY_MATERIAL);
      return COROT_OK;
    case VARIABLE_LOAD:
    case VARIABLE_STIFFNESS:
      *value = in->body.value[v->index];
      return COROT_OK;
    default:
      return get_calculated(in, v, value);
  }
}

static corot_status get(instance *in, const fmi3ValueReference reference[], size_t n,
                        double value[], size_t nvalue) {
  COROT_TRY(check_list(in, reference, n, value, nvalue));
  for (size_t i = 0; i < n; i++) {
    const variable *v = &in->variables.all[reference[i]];
    COROT_TRY(get_one(in, v, value));
    value += v->size;
  }
  return COROT_OK;
}

fmi3Status fmi3GetFloat64(fmi3Instance instance_, const fmi3ValueReference reference[],
                          size_t nreference, fmi3Float64 value[], size_t nvalue) {
  FMI3_CALL(instance_, ALIVE, get(in, reference, nreference, value, nvalue));
}

/* --- Set --- */

static corot_status check_mode(const instance *in, const variable *v) {
  unsigned allowed = INSTANTIATED | INITIALIZATION;
  switch (v->kind) {
    case VARIABLE_PARAMETER:
      if (!(in->mode & allowed))
        return corot_fail(COROT_EINVAL,
                          "%s is fixed: it is set before the end of Initialization Mode", v->name);
      return COROT_OK;
    case VARIABLE_STIFFNESS:
      if (!(in->mode & (allowed | STEP | EVENT)))
        return corot_fail(COROT_EINVAL, "%s is discrete: it is set in Event Mode", v->name);
      return COROT_OK;
    case VARIABLE_LOAD:
      return instance_allow(in, allowed | STEP | EVENT | CONTINUOUS);
    default:
      return corot_fail(COROT_EINVAL, "%s is not set: it is neither a parameter nor an input",
                        v->name);
  }
}

static corot_status check_value(const variable *v, double x) {
  if (!isfinite(x)) return corot_fail(COROT_EINVAL, "%s: %g is not a finite number", v->name, x);
  if (v->kind == VARIABLE_STIFFNESS && !(x > 0))
    return corot_fail(COROT_EINVAL, "%s: a factor of a material is above 0, not %g", v->name, x);
  return COROT_OK;
}

/* The factor of a material may be one that the model refuses: then all is as it was. */
static corot_status set_input(instance *in, const variable *v, double x) {
  double before = in->body.value[v->index];
  if (v->kind == VARIABLE_STIFFNESS && before == x) return COROT_OK;
  in->body.value[v->index] = x;
  if (in->mode & (INSTANTIATED | INITIALIZATION)) {
    instance_unsettle(in);
    return COROT_OK;
  }
  corot_status status = instance_apply_input(in, v->index);
  if (status)
    in->body.value[v->index] = before;
  else if (in->stepping)
    stepping_tell(in->stepping);
  return status;
}

static corot_status set_one(instance *in, const variable *v, double x) {
  if (variable_is_input(v)) return set_input(in, v, x);
  double *number =
      body_material_at(&in->body.material[v->index / BODY_MATERIAL], v->index % BODY_MATERIAL);
  if (*number == x) return COROT_OK;
  instance_unsettle(in);
  in->body.built = false;
  *number = x;
  return COROT_OK;
}

/* All is looked at before anything is set. */
static corot_status set(instance *in, const fmi3ValueReference reference[], size_t n,
                        const double value[], size_t nvalue) {
  COROT_TRY(check_list(in, reference, n, value, nvalue));
  for (size_t i = 0; i < n; i++) {
    const variable *v = &in->variables.all[reference[i]];
    COROT_TRY(check_mode(in, v));
    COROT_TRY(check_value(v, value[i])); /* what can be set has one number each */
  }
  for (size_t i = 0; i < n; i++) COROT_TRY(set_one(in, &in->variables.all[reference[i]], value[i]));
  return COROT_OK;
}

fmi3Status fmi3SetFloat64(fmi3Instance instance_, const fmi3ValueReference reference[],
                          size_t nreference, const fmi3Float64 value[], size_t nvalue) {
  FMI3_CALL(instance_, ALIVE, set(in, reference, nreference, value, nvalue));
}
