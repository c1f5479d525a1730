/* The space error: how much a bar of four-node tets bends too little under its weight, as one
   linear solve tells, and as ten-node tets confirm; and where that comes from, with the tets cut
   that have most of it. Needs corot::integrate. */
#include <corot/space.h>
#include <corot/statics.h>
#include <stdio.h>
#include <stdlib.h>

static void check(corot_status status) {
  if (status == COROT_OK) return;
  fprintf(stderr, "corot: %s\n", corot_error());
  exit(1);
}

/* The equilibrium u of the model; the value is what its end sinks by [m]. */
static double sink(const corot_model *model, double *u) {
  corot_statics_def def = corot_statics_defaults();
  corot_statics *statics;
  check(corot_statics_create(&def, model, 0, NULL, &statics));
  check(corot_statics_solve(statics));
  corot_statics_at(statics, u);
  corot_statics_destroy(statics);
  int end = corot_mesh_nearest(corot_model_mesh(model), (double[]){0.6, 0.05, 0.05});
  return -u[corot_model_dof(model)[end][2]];
}

int main(void) {
  corot_box box = corot_box_defaults();
  box.size[0] = 0.6, box.size[1] = 0.1, box.size[2] = 0.1;
  box.cells[0] = 12, box.cells[1] = 2, box.cells[2] = 2;
  const corot_material rubber = {.lambda = 0, .mu = 2e6, .density = 1000}; /* E = 4e6 */
  const corot_fix wall = {"xmin", {true, true, true}};
  const corot_load weight = {.kind = COROT_GRAVITY, .value = {0, 0, -9.81}};
  corot_mesh *mesh, *raised;
  corot_model *model, *other;
  check(corot_mesh_box(&box, &mesh));
  check(corot_mesh_change_order(mesh, 2, &raised));
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = &rubber;
  def.nfix = 1, def.fix = &wall;
  def.nload = 1, def.load = &weight;
  def.mesh = mesh;
  check(corot_model_create(&def, &model));
  def.mesh = raised;
  check(corot_model_create(&def, &other));

  double *u = calloc((size_t)corot_model_ndof(other), sizeof *u); /* has room for both */
  double(*correction)[3] = calloc((size_t)mesh->nnode, sizeof *correction);
  if (!u || !correction) return 1;
  printf("four-node tets: %.4e m\n", sink(model, u));

  /* What is missing, by the state at hand alone. */
  corot_space_moment now = {.u = u, .still = true, .factor = 1};
  corot_space_estimate estimate;
  check(corot_space_error(&def, model, &now, NULL, correction, &estimate));
  int end = corot_mesh_nearest(mesh, (double[]){0.6, 0.05, 0.05});
  printf("correction %.4e m\n", -correction[end][2]);
  printf("missing %.0f %% of the displacement\n", 100 * estimate.relative);
  printf("ten-node tets: %.4e m\n", sink(other, u));

  /* Where that comes from: a half of it is in few tets, which are cut. */
  double *goal = calloc((size_t)corot_model_ndof(model), sizeof *goal);
  double *indicator = calloc((size_t)mesh->ntet, sizeof *indicator);
  int nmark, *mark = calloc((size_t)mesh->ntet, sizeof *mark);
  corot_space_total total;
  corot_mesh *fine;
  if (!goal || !indicator || !mark) return 1;
  sink(model, u);
  goal[corot_model_dof(model)[end][2]] = 1; /* the derivative of what it sinks by, upward */
  check(corot_space_indicators(model, &now, goal, NULL, indicator, &total));
  check(corot_space_mark(mesh->ntet, indicator, 0.5, &nmark, mark));
  printf("indicated %.4e m\n", -total.goal);
  printf("half of it in %d of %d tets\n", nmark, mesh->ntet);
  check(corot_mesh_refine_marked(mesh, nmark, mark, &fine, NULL));
  corot_model_destroy(other);
  def.mesh = fine;
  check(corot_model_create(&def, &other));
  u = realloc(u, (size_t)corot_model_ndof(other) * sizeof *u);
  if (!u) return 1;
  printf("cut there: %.4e m\n", sink(other, u));

  free(goal);
  free(indicator);
  free(mark);
  corot_mesh_destroy(fine);
  free(u);
  free(correction);
  corot_model_destroy(model);
  corot_model_destroy(other);
  corot_mesh_destroy(mesh);
  corot_mesh_destroy(raised);
}
