/* The paper's bar (Hauth & Strasser 2004, Example 2) on a coarse box mesh: held at its base,
   sheared by a traction on its top that grows for a while and then stays. */
#ifndef BAR_H
#define BAR_H

#include <corot/integrate.h>

#include "solid.h"

typedef struct bar_def {
  const char *strain;
  int cells[3];
  double damping; /* times the paper's */
  corot_viscosity viscosity;
  double traction[3]; /* [Pa] */
  double ramp;        /* [s] */
  double Q[9];        /* rotates all of it */
  bool lumped;        /* its mass, of whatever order */
} bar_def;

static const bar_def example2 = {.strain = "polar",
                                 .cells = {1, 1, 6},
                                 .damping = 1,
                                 .viscosity = COROT_VISCOSITY_AUTO,
                                 .traction = {200, 0, 0},
                                 .ramp = 10,
                                 .Q = {1, 0, 0, 0, 1, 0, 0, 0, 1}};

typedef struct bar {
  corot_model *model;
  corot_state *state;
  int n;         /* degrees of freedom */
  int tip;       /* that of the corner's x displacement */
  double *u, *v; /* [n] at rest */
} bar;

static inline bar bar_create(const bar_def *def) {
  bar b;
  corot_box box = {.size = {0.1, 0.1, 0.6}};
  memcpy(box.cells, def->cells, sizeof box.cells);
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  int corner = mesh->nnode - 1;
  mesh = of_order(mesh);
  double(*Qx)[3] = malloc(mesh->nnode * sizeof *Qx);
  for (int n = 0; n < mesh->nnode; n++) apply(def->Q, mesh->x[n], Qx[n]);
  memcpy(mesh->x, Qx, mesh->nnode * sizeof *Qx);
  free(Qx);

  corot_material material = soft;
  material.damping_lambda *= def->damping;
  material.damping_mu *= def->damping;
  double time[] = {0, def->ramp}, value[] = {0, 1};
  corot_fix base = {"zmin", {true, true, true}};
  corot_load load = {COROT_TRACTION, "zmax", {0}, {def->ramp > 0 ? 2 : 0, time, value}};
  apply(def->Q, def->traction, load.value);
  corot_model_def model = corot_model_defaults();
  model.mesh = mesh, model.strain = def->strain, model.viscosity = def->viscosity;
  if (def->lumped) model.mass = COROT_MASS_LUMPED;
  model.nmaterial = 1, model.material = &material;
  model.nfix = 1, model.fix = &base;
  model.nload = 1, model.load = &load;
  assert_ok(corot_model_create(&model, &b.model));
  assert_ok(corot_state_create(b.model, &b.state));
  corot_mesh_destroy(mesh);
  b.n = corot_model_ndof(b.model);
  b.tip = corot_model_dof(b.model)[corner][0];
  b.u = calloc(2 * b.n, sizeof *b.u);
  b.v = b.u + b.n;
  return b;
}

static inline void bar_destroy(bar *b) {
  corot_state_destroy(b->state);
  corot_model_destroy(b->model);
  free(b->u);
}

/* Starts at t = 0 from b->u, b->v. */
static inline corot_integrator *start(bar *b, const corot_integrator_def *def) {
  corot_integrator *integrator;
  assert_ok(corot_integrator_create(def, b->model, b->state, 0, b->u, b->v, &integrator));
  return integrator;
}

/* Steps until t_end. */
static inline void run_to(corot_integrator *integrator, double t_end) {
  for (corot_step step = {0}; step.t < t_end;)
    assert_ok(corot_integrator_step(integrator, t_end, &step));
}

/* Largest |a_i - b_i|; norm_max is that of one array. */
static inline double difference_of(int n, const double *a, const double *b) {
  double d = 0;
  for (int i = 0; i < n; i++) d = fmax(d, fabs(a[i] - b[i]));
  return d;
}

#endif
