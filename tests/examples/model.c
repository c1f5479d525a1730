/* A model: a mesh with material, supports and loads, and what can be asked of it before anything
   moves. Needs corot::core. */
#include <corot/model.h>
#include <stdio.h>
#include <stdlib.h>

static void check(corot_status status) {
  if (status == COROT_OK) return;
  fprintf(stderr, "corot: %s\n", corot_error());
  exit(1);
}

int main(void) {
  corot_box box = corot_box_defaults();
  box.size[0] = 0.1, box.size[1] = 0.1, box.size[2] = 0.6; /* [m] */
  box.cells[0] = 2, box.cells[1] = 2, box.cells[2] = 12;
  corot_mesh *mesh;
  check(corot_mesh_box(&box, &mesh));

  /* The lower end is shaken to and fro; the upper one is pulled by a traction that rises in a
     second and rests from then on. */
  const corot_material rubber = {
      .lambda = 1e5, .mu = 1e4, .density = 1000, .damping_mu = 20}; /* everywhere: no group */
  const corot_motion shaken = {.kind = COROT_MOVE,
                               .group = "zmin",
                               .direction = {0.01, 0, 0},
                               .amplitude = {.curve = COROT_CURVE_SINE, .frequency = 2}};
  const double time[] = {0, 1}, factor[] = {0, 1};
  const corot_load loads[] = {
      {.kind = COROT_GRAVITY, .value = {0, 0, -9.81}},
      {.kind = COROT_TRACTION,
       .group = "zmax",
       .value = {0, 0, 200},
       .amplitude = {.n = 2, .time = time, .value = factor}},
  };
  corot_model_def def = corot_model_defaults();
  def.mesh = mesh;
  def.strain = "polar";
  def.nmaterial = 1, def.material = &rubber;
  def.nmotion = 1, def.motion = &shaken;
  def.nload = 2, def.load = loads;
  corot_model *model;
  check(corot_model_create(&def, &model));

  printf("degrees of freedom %d, nodes %d\n", corot_model_ndof(model),
         corot_model_mesh(model)->nnode);
  double kinks[8];
  int nkink = corot_model_kinks(model, 0, 10, 8, kinks);
  printf("kinks %d, the first at %g s\n", nkink, nkink > 0 ? kinks[0] : -1);
  printf("a step from t = 0 should end by %g s\n", corot_model_horizon(model, 0));
  corot_model_destroy(model);

  /* What does not fit is told by name. */
  def.strain = "linear";
  corot_status status = corot_model_create(&def, &model);
  corot_mesh_destroy(mesh); /* at any time: a model has copies of all that it was made of */
  printf("%s: %s\n", status == COROT_EINVAL ? "COROT_EINVAL" : "?", corot_error());

  for (int i = 0; corot_strain_traits(i); i++) {
    const corot_strain_kind *kind = corot_strain_traits(i);
    printf("strain measure %s: %s\n", kind->name, kind->frames ? "turns with the body" : "fixed");
  }
}
