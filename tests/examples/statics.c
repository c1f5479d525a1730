/* An equilibrium: a bar that hangs from its upper end grows longer under its own weight by
   density g L^2 / (2 E), where strains are small. Needs corot::integrate. */
#include <corot/statics.h>
#include <stdio.h>
#include <stdlib.h>

static void check(corot_status status) {
  if (status == COROT_OK) return;
  fprintf(stderr, "corot: %s\n", corot_error());
  exit(1);
}

int main(void) {
  const double length = 0.6, young = 1e6, density = 1000, g = 9.81; /* Poisson's ratio is 0 */
  corot_box box = corot_box_defaults();
  box.size[0] = 0.1, box.size[1] = 0.1, box.size[2] = length;
  box.cells[0] = 2, box.cells[1] = 2, box.cells[2] = 12;
  const corot_material rubber = {.lambda = 0, .mu = young / 2, .density = density};
  const corot_fix ceiling = {"zmax", {true, true, true}};
  const corot_load weight = {.kind = COROT_GRAVITY, .value = {0, 0, -g}};
  corot_mesh *mesh;
  corot_model *model;
  check(corot_mesh_box(&box, &mesh));
  corot_model_def model_def = corot_model_defaults();
  model_def.mesh = mesh, model_def.nmaterial = 1, model_def.material = &rubber;
  model_def.nfix = 1, model_def.fix = &ceiling;
  model_def.nload = 1, model_def.load = &weight;
  check(corot_model_create(&model_def, &model));
  corot_mesh_destroy(mesh);

  /* The load in steps of a half; each is a Newton iteration, of which the residuals tell. */
  corot_statics_def def = corot_statics_defaults();
  def.first_step = def.max_step = 0.5;
  corot_statics *statics;
  check(corot_statics_create(&def, model, 0, NULL, &statics));
  for (corot_load_step step = {0}; step.factor < 1;) {
    check(corot_statics_step(statics, &step));
    printf("load factor %g: %s after %d iterations, residual %.1e N\n", step.factor,
           step.stability == COROT_STABLE ? "stable" : "not known to be stable", step.iterations,
           step.residual[step.nresidual - 1]);
  }

  double *u = calloc((size_t)corot_model_ndof(model), sizeof *u);
  if (!u) return 1;
  corot_statics_at(statics, u);
  int lowest = corot_mesh_nearest(corot_model_mesh(model), (double[]){0.05, 0.05, 0});
  printf("longer by %.4e m, closed form %.4e m\n", -u[corot_model_dof(model)[lowest][2]],
         density * g * length * length / (2 * young));

  free(u);
  corot_statics_destroy(statics);
  corot_model_destroy(model);
}
