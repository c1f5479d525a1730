/* The solid of the host programs, for C and C++: a bar clamped at its base, under a shear load that
   rises over one second. */
#ifndef BAR_H
#define BAR_H

#include <corot/ode.h>
#include <stdio.h>
#include <stdlib.h>

static const double T_END = 2; /* [s] */

/* Ends the program with corot's message unless the call succeeded. */
static inline void check(corot_status status) {
  if (status == COROT_OK) return;
  fprintf(stderr, "corot: %s\n", corot_error());
  exit(1);
}

static inline corot_model *bar_create(void) {
  const corot_fix base = {"zmin", {true, true, true}};
  const double time[] = {0, 1}, factor[] = {0, 1};
  const corot_amplitude rise = {2, time, factor, COROT_CURVE_LINEAR, 0, 0, 0};
  const corot_load shear = {COROT_TRACTION, "zmax", {20, 10, 0}, rise}; /* [Pa] */

  corot_material jelly = {0};
  jelly.lambda = 1e5, jelly.mu = 1e4, jelly.density = 1000, jelly.damping_mu = 20;
  corot_box box = {0};
  box.size[0] = box.size[1] = 0.1, box.size[2] = 0.6;
  box.cells[0] = box.cells[1] = 1, box.cells[2] = 6;
  corot_mesh *mesh;
  check(corot_mesh_box(&box, &mesh));

  corot_model *model;
  corot_model_def def = corot_model_defaults();
  def.mesh = mesh;
  def.nmaterial = 1, def.material = &jelly;
  def.nfix = 1, def.fix = &base;
  def.nload = 1, def.load = &shear;
  check(corot_model_create(&def, &model));
  corot_mesh_destroy(mesh); /* the model has its own copy */
  return model;
}

/* Where the corner at the top has got to: what the programs are compared by. u [n]. */
static inline void bar_print(const corot_model *model, const double *u) {
  const double top[] = {0.1, 0.1, 0.6};
  const int *dof = corot_model_dof(model)[corot_mesh_nearest(corot_model_mesh(model), top)];
  printf("%.12g %.12g %.12g\n", u[dof[0]], u[dof[1]], u[dof[2]]);
}

#endif
