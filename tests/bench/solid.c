#include "solid.h"

#include <math.h>
#include <stdlib.h>

corot_status solid_mesh(int ntet, int order, corot_mesh **mesh) {
  /* cells i x i x 3/4 i, as 16 x 16 x 12 for 18432 tets */
  int i = (int)fmax(1, round(cbrt(ntet / 6.0 / 0.75)));
  int k = (int)fmax(1, round(ntet / 6.0 / i / i));
  corot_box box = {.size = {0.1, 0.1, 0.6}, .cells = {i, i, k}};
  corot_mesh *linear;
  COROT_TRY(corot_mesh_box(&box, &linear));
  corot_status status = corot_mesh_change_order(linear, order, mesh);
  corot_mesh_destroy(linear);
  return status;
}

static void deform(specimen *s) {
  const corot_mesh *mesh = corot_model_mesh(s->model);
  const int(*dof)[3] = corot_model_dof(s->model);
  for (int n = 0; n < mesh->nnode; n++) {
    const double *x = mesh->x[n];
    double angle = 0.5 * x[2], c = cos(angle), sn = sin(angle);
    double u[3] = {c * x[0] + sn * x[2] - x[0], 1e-3 * sin(40 * x[2]), c * x[2] - sn * x[0] - x[2]};
    for (int k = 0; k < 3; k++) {
      int i = dof[n][k];
      if (i < 0) continue;
      s->u[i] = u[k];
      s->v[i] = 0.1 * u[k];
      s->du[i] = s->dv[i] = sin(7 * x[0] + 5 * x[1] + 3 * x[2] + k);
    }
  }
}

corot_status solid_define(corot_mesh *mesh, const char *strain, bool damped, specimen *s) {
  if (!corot_mesh_find_group(mesh, "base"))
    COROT_TRY(corot_mesh_group_plane(mesh, "base", 2, 0, 0));
  corot_material material = {.lambda = 1e5, .mu = 1e4, .density = 1000};
  if (damped) material.damping_lambda = 10, material.damping_mu = 1;
  corot_fix fix = {"base", {true, true, true}};
  corot_model_def def = corot_model_defaults();
  def.mesh = mesh, def.strain = strain;
  def.viscosity = COROT_COROTATED, def.mass = COROT_MASS_LUMPED; /* the paper's */
  def.nmaterial = 1, def.material = &material;
  def.nfix = 1, def.fix = &fix;
  COROT_TRY(corot_model_create(&def, &s->model));
  s->ntet = corot_model_mesh(s->model)->ntet;
  s->n = corot_model_ndof(s->model);
  return COROT_OK;
}

corot_status solid_begin(specimen *s) {
  COROT_TRY(corot_state_create(s->model, &s->state));
  s->y = calloc(7 * (size_t)s->n, sizeof *s->y);
  if (!s->y) return corot_fail(COROT_ENOMEM, "no memory for %d tets", s->ntet);
  s->u = s->y, s->v = s->u + s->n, s->ydot = s->v + s->n;
  s->r = s->ydot + 2 * (size_t)s->n, s->du = s->r + s->n, s->dv = s->du + s->n;
  deform(s);
  return corot_frames_update(s->model, s->state, 0, s->u, NULL);
}

static corot_status fill(specimen *s) {
  COROT_TRY(solid_begin(s));
  size_t nblock = corot_model_nblock(s->model);
  s->K = calloc(nblock, sizeof *s->K);
  s->D = calloc(nblock, sizeof *s->D);
  return s->K && s->D ? COROT_OK : corot_fail(COROT_ENOMEM, "no memory for %d tets", s->ntet);
}

corot_status solid_create(corot_mesh *mesh, const char *strain, bool damped, specimen *out) {
  specimen s = {0};
  corot_status status = solid_define(mesh, strain, damped, &s);
  if (!status) status = fill(&s);
  if (status) {
    solid_clear(&s);
    return status;
  }
  *out = s;
  return COROT_OK;
}

void solid_clear(specimen *s) {
  corot_state_destroy(s->state);
  corot_model_destroy(s->model);
  free(s->y);
  free(s->K);
  free(s->D);
  *s = (specimen){0};
}
