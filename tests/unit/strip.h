/* A strip one cell wide, bent or pressed in its plane: the beams of tests of statics. */
#ifndef STRIP_H
#define STRIP_H

#include <corot/statics.h>

#include "solid.h"

typedef struct strip_def {
  const char *strain;
  double length;   /* [m]; it is 1 m high, and as wide as a cell is long */
  int cells[2];    /* along and across */
  double tip[2];   /* load on its free end over E I / length^2, along and across */
  double pressure; /* on its upper side, over E I / length^3 */
  int order;       /* of its tets; 0: 1 */
} strip_def;

static const double strip_stiffness = 1e6; /* Young's modulus [Pa] */

static inline body strip_create(const strip_def *s) {
  double L = s->length, width = L / s->cells[0], EI = strip_stiffness * width / 12;
  corot_box box = {.size = {L, 1, width}, .cells = {s->cells[0], s->cells[1], 1}};
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  mesh = given_order(mesh, s->order ? s->order : 1);
  corot_material material = {.mu = strip_stiffness / 2, .density = 1000}; /* Poisson's ratio 0 */
  corot_fix fix[] = {
      {"xmin", {true, true, true}}, {"zmin", {false, false, true}}, {"zmax", {false, false, true}}};
  double area = width;
  corot_load load[] = {
      {COROT_TRACTION,
       "xmax",
       {s->tip[0] * EI / (L * L * area), s->tip[1] * EI / (L * L * area)},
       {0}},
      {COROT_PRESSURE, "ymax", {s->pressure * EI / (L * L * L * width)}, {0}},
  };
  corot_model_def def = corot_model_defaults();
  def.strain = s->strain;
  def.nmaterial = 1, def.material = &material;
  def.nfix = 3, def.fix = fix;
  def.nload = s->pressure ? 2 : 1, def.load = load;
  return make_body(mesh, def);
}

/* Mean displacement of the free end over the length. */
static inline void strip_tip(const body *b, const double *u, double mean[2]) {
  const int(*dof)[3] = corot_model_dof(b->model);
  const corot_group *end = corot_mesh_find_group(b->mesh, "xmax");
  double length = b->mesh->x[end->node[0]][0];
  for (int c = 0; c < 2; c++) {
    mean[c] = 0;
    for (int k = 0; k < end->nnode; k++) mean[c] += u[dof[end->node[k]][c]];
    mean[c] /= end->nnode * length;
  }
}

static inline corot_statics *begin(const body *b, const corot_statics_def *def) {
  corot_statics *s;
  assert_ok(corot_statics_create(def, b->model, 1, NULL, &s));
  return s;
}

#endif
