/* Eigenfrequencies: a clamped bar bends at k^2 / (2 pi L^2) sqrt(E I / (rho A)), k = 1.8751, and
   sounds along itself at sqrt(E / rho) / (4 L). Needs corot::integrate, built with ARPACK. */
#include <corot/modes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void check(corot_status status) {
  if (status == COROT_OK) return;
  fprintf(stderr, "corot: %s\n", corot_error());
  exit(1);
}

int main(void) {
  if (!corot_modes_available()) return puts("this corot has no ARPACK") == EOF;
  const double length = 1, side = 0.05, young = 1e6, density = 1000; /* Poisson's ratio is 0 */
  corot_box box = corot_box_defaults();
  box.size[0] = side, box.size[1] = side, box.size[2] = length;
  box.cells[0] = 1, box.cells[1] = 1, box.cells[2] = 12;
  const corot_material rubber = {.lambda = 0, .mu = young / 2, .density = density};
  const corot_fix clamp = {"zmin", {true, true, true}};
  corot_mesh *linear, *mesh;
  corot_model *model;
  check(corot_mesh_box(&box, &linear));
  check(
      corot_mesh_change_order(linear, 2, &mesh)); /* of ten-node tets, which bend as they should */
  corot_model_def model_def = corot_model_defaults();
  model_def.mesh = mesh, model_def.nmaterial = 1, model_def.material = &rubber;
  model_def.nfix = 1, model_def.fix = &clamp;
  check(corot_model_create(&model_def, &model));
  corot_mesh_destroy(linear), corot_mesh_destroy(mesh);

  corot_modes_def def = corot_modes_defaults();
  corot_modes *modes;
  check(corot_modes_find(&def, model, 0, NULL, &modes)); /* NULL: about rest */
  double mass = density * side * side * length;
  for (int k = 0; k < corot_modes_count(modes); k++) {
    corot_mode mode = corot_modes_at(modes, k);
    printf("mode %d %.5f Hz, of the mass %.3f along z, residual %.0e\n", k + 1, mode.frequency,
           mode.effective_mass[2] / mass, mode.residual);
  }
  double root = 1.87510406871196, speed = sqrt(young / density);
  printf("bending %.5f Hz\n", root * root * speed * side / sqrt(12) / (2 * 3.14159265 * length));
  printf("along the bar %.5f Hz\n", speed / (4 * length));
  corot_modes_destroy(modes);
  corot_model_destroy(model);
}
