#include "motion.h"

#include <math.h>
#include <stdlib.h>

corot_status motion_create(corot_model *model, motion *m) {
  m->model = model;
  COROT_TRY(corot_state_create(model, &m->state));
  int n = corot_model_ndof(model);
  m->zero = calloc(2 * (size_t)n, sizeof *m->zero);
  if (!m->zero) return corot_fail(COROT_ENOMEM, "out of memory");
  m->u = m->zero + n;
  const double corner[3] = {0.1, 0.1, 0.6};
  m->probe = corot_model_dof(model)[corot_mesh_nearest(corot_model_mesh(model), corner)][0];
  return COROT_OK;
}

void motion_destroy(motion *m) {
  free(m->zero);
  corot_state_destroy(m->state);
  corot_model_destroy(m->model);
}

/* The corner's ux at the outputs within the last step. */
static corot_status read_outputs(motion *m, corot_integrator *integrator, double t, int *next,
                                 double ux[NOUTPUT]) {
  while (*next < NOUTPUT && 0.1 * *next <= t * (1 + 1e-12)) {
    COROT_TRY(corot_integrator_at(integrator, fmin(0.1 * *next, t), m->u, NULL));
    ux[(*next)++] = m->u[m->probe];
  }
  return COROT_OK;
}

/* The load has its kink at 10 s. */
corot_status motion_run(motion *m, const corot_integrator_def *def, double ux[NOUTPUT],
                        corot_statistics *counts) {
  corot_integrator *integrator;
  COROT_TRY(corot_integrator_create(def, m->model, m->state, 0, m->zero, m->zero, &integrator));
  corot_status status = COROT_OK;
  int next = 1;
  ux[0] = 0;
  for (corot_step step = {0}; !status && next < NOUTPUT;) {
    status = corot_integrator_step(integrator, step.t < 10 ? 10 : 40.001, &step);
    if (!status) status = read_outputs(m, integrator, step.t, &next, ux);
  }
  *counts = corot_integrator_statistics(integrator);
  corot_integrator_destroy(integrator);
  return status;
}
