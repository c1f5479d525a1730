/* Inputs of a run: their memory, forces on nodes, factors of loads. */
#include "inputs.h"

#include <stdlib.h>
#include <string.h>

/* Room for the fields of all nodes, and the loads' factors of one. */
static corot_status allocate(corot_inputs *in) {
  size_t nnode = in->model->mesh->nnode, nload = in->model->nload;
  in->force = calloc(nnode, sizeof *in->force);
  in->slope = calloc(nnode, sizeof *in->slope);
  in->load = calloc(nload + 1, sizeof *in->load);
  if (!in->force || !in->slope || !in->load)
    return corot_fail(COROT_ENOMEM, "no memory for the inputs of %zu nodes", nnode);
  for (size_t k = 0; k < nload; k++) in->load[k].value = 1;
  in->bytes = sizeof *in + 2 * nnode * sizeof *in->force + (nload + 1) * sizeof *in->load;
  return COROT_OK;
}

corot_status corot_inputs_create(const corot_model *model, corot_inputs **inputs) {
  COROT_TRY(COROT_GIVEN(model));
  COROT_TRY(COROT_GIVEN(inputs));
  corot_inputs *in = calloc(1, sizeof *in);
  if (!in) return corot_fail(COROT_ENOMEM, "no memory for inputs");
  in->model = model;
  corot_status status = allocate(in);
  if (status) {
    corot_inputs_destroy(in);
    return status;
  }
  *inputs = in;
  return COROT_OK;
}

void corot_inputs_destroy(corot_inputs *in) {
  if (!in) return;
  free(in->force);
  free(in->slope);
  free(in->load);
  corot_other_system_destroy(in->other);
  corot_other_system_destroy(in->before);
  free(in->path);
  for (int k = 0; k < 3; k++) free(in->law[k]);
  free(in->u);
  free(in->v);
  free(in->du);
  free(in->dv);
  free(in->f);
  free(in);
}

size_t corot_inputs_bytes(const corot_inputs *in) { return in->bytes; }

/* --- Forces ---------------------------------------------------------------------------------- */

corot_status corot_inputs_check(const char *what, const char *row, int n, const double (*x)[3]) {
  for (int i = 0; i < n; i++)
    for (int c = 0; c < 3; c++)
      if (!isfinite(x[i][c]))
        return corot_fail(COROT_EINVAL, "inputs: the %c component of the %s at %s %d is %g",
                          "xyz"[c], what, row, i, x[i][c]);
  return COROT_OK;
}

static corot_status check_force(const corot_inputs *in, int nnode, const double (*force)[3]) {
  if (nnode != in->model->mesh->nnode)
    return corot_fail(COROT_EINVAL, "inputs: a force on %d nodes, but the mesh has %d", nnode,
                      in->model->mesh->nnode);
  return corot_inputs_check("force", "node", nnode, force);
}

corot_status corot_inputs_set_force(corot_inputs *in, int nnode, const double (*force)[3]) {
  COROT_TRY(COROT_GIVEN_AS(in, "inputs"));
  if (force) COROT_TRY(check_force(in, nnode, force));
  in->forced = force != NULL;
  in->loads++;
  if (!force) return COROT_OK;
  memcpy(in->force, force, nnode * sizeof *force);
  memset(in->slope, 0, nnode * sizeof *in->slope);
  return COROT_OK;
}

static corot_status check_window(double t0, double t1) {
  if (t0 < t1 && isfinite(t1 - t0)) return COROT_OK;
  return corot_fail(COROT_EINVAL, "inputs: a window from t = %g to t = %g s has no length", t0, t1);
}

corot_status corot_inputs_ramp_force(corot_inputs *in, int nnode, double t0,
                                     const double (*from)[3], double t1, const double (*to)[3]) {
  COROT_TRY(COROT_GIVEN_AS(in, "inputs"));
  COROT_TRY(COROT_GIVEN(from));
  COROT_TRY(COROT_GIVEN(to));
  COROT_TRY(check_window(t0, t1));
  COROT_TRY(check_force(in, nnode, from));
  COROT_TRY(check_force(in, nnode, to));
  for (int n = 0; n < nnode; n++)
    for (int c = 0; c < 3; c++) {
      in->force[n][c] = from[n][c];
      in->slope[n][c] = (to[n][c] - from[n][c]) / (t1 - t0);
    }
  in->t_force = t0;
  in->forced = true;
  in->loads++;
  return COROT_OK;
}

static corot_status check_load(const corot_inputs *in, int k, double factor) {
  COROT_TRY(COROT_GIVEN_AS(in, "inputs"));
  if (k < 0 || k >= in->model->nload)
    return corot_fail(COROT_EINVAL, "inputs: there is no load %d: the model has %d", k,
                      in->model->nload);
  if (isfinite(factor)) return COROT_OK;
  return corot_fail(COROT_EINVAL, "inputs: the factor of load %d is %g", k, factor);
}

corot_status corot_inputs_set_load(corot_inputs *in, int k, double factor) {
  COROT_TRY(check_load(in, k, factor));
  in->load[k] = (ramp){0, factor, 0};
  in->loads++;
  return COROT_OK;
}

corot_status corot_inputs_ramp_load(corot_inputs *in, int k, double t0, double from, double t1,
                                    double to) {
  COROT_TRY(check_window(t0, t1));
  COROT_TRY(check_load(in, k, from));
  COROT_TRY(check_load(in, k, to));
  in->load[k] = (ramp){t0, from, (to - from) / (t1 - t0)};
  in->loads++;
  return COROT_OK;
}

double corot_inputs_load(const instant *now, int k) {
  return ramp_at(now->inputs->load[k], now->load_t);
}

void corot_inputs_add_force(const corot_model *m, const instant *now, double *f) {
  const corot_inputs *in = now->inputs;
  double factor = now->load_factor, since = factor * (now->load_t - in->t_force);
  for (int n = 0; in->forced && n < m->mesh->nnode; n++)
    for (int c = 0; c < 3; c++)
      if (m->dof[n][c] >= 0) f[m->dof[n][c]] += factor * in->force[n][c] + since * in->slope[n][c];
}

void corot_inputs_add_nodal_force(const corot_model *m, const instant *now, double (*f)[3]) {
  const corot_inputs *in = now->inputs;
  double factor = now->load_factor, since = factor * (now->load_t - in->t_force);
  for (int n = 0; in->forced && n < m->mesh->nnode; n++)
    for (int c = 0; c < 3; c++) f[n][c] += factor * in->force[n][c] + since * in->slope[n][c];
}
