/* The solid of the host programs: a bar clamped at its base, under a shear load that rises over
   one second. */
#ifndef BAR_H
#define BAR_H

#include <corot/model.h>
#include <stdio.h>
#include <stdlib.h>

enum { T_END = 2 }; /* [s] */

static inline void check(corot_status status) {
  if (status == COROT_OK) return;
  fprintf(stderr, "corot: %s\n", corot_error());
  exit(1);
}

static inline corot_model *bar_create(void) {
  const corot_box box = {.size = {0.1, 0.1, 0.6}, .cells = {1, 1, 6}};
  const corot_material jelly = {.lambda = 1e5, .mu = 1e4, .density = 1000, .damping_mu = 20};
  const corot_fix base = {"zmin", {true, true, true}};
  const double time[] = {0, 1}, factor[] = {0, 1};
  const corot_load shear = {COROT_TRACTION, "zmax", {20, 10, 0}, {2, time, factor}};

  corot_mesh *mesh;
  corot_model *model;
  check(corot_mesh_box(&box, &mesh));
  corot_model_def def = corot_model_defaults();
  def.mesh = mesh;
  def.nmaterial = 1, def.material = &jelly;
  def.nfix = 1, def.fix = &base;
  def.nload = 1, def.load = &shear;
  check(corot_model_create(&def, &model));
  corot_mesh_destroy(mesh); /* the model has its own copy */
  return model;
}

/* Where the corner at the top has got to: what the programs are compared by. */
static inline void bar_print(const corot_model *model, const double *u) {
  const corot_mesh *mesh = corot_model_mesh(model);
  const int *dof = corot_model_dof(model)[corot_mesh_nearest(mesh, (double[]){0.1, 0.1, 0.6})];
  printf("%.12g %.12g %.12g\n", u[dof[0]], u[dof[1]], u[dof[2]]);
}

#endif
