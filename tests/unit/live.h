/* Bodies with inputs, and every method of integration on them. */
#ifndef LIVE_H
#define LIVE_H

#include <corot/inputs.h>

#include "bar.h"

static const corot_fix base = {"zmin", {true, true, true}};
static const double times[] = {0, 1}, values[] = {0.5, 1.5};

/* Loads of every kind, the first of which stand for what comes in. */
static const corot_load loads[] = {
    {COROT_TRACTION, "zmax", {200, -30, 50}, {2, times, values}},
    {COROT_FORCE, "xmax", {0.3, -0.2, 0.1}, {0}},
    {COROT_GRAVITY, NULL, {1, 2, -9.81}, {0}},
    {COROT_PRESSURE, "xmax", {300}, {2, times, values}},
};
enum { NLOAD = 4 };

/* A bar held at its base, with these loads. */
static inline body make_bar(const char *strain, int order, int nload, const corot_load *load) {
  corot_box box = {.size = {0.1, 0.1, 0.3}, .cells = {1, 1, 3}, .split = COROT_BOX_SYMMETRIC};
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  if (order == 2) mesh = given_order(mesh, 2);
  corot_material material = soft;
  material.damping_mass = 3;
  corot_model_def def = corot_model_defaults();
  def.strain = strain;
  def.nmaterial = 1, def.material = &material;
  def.nfix = 1, def.fix = &base;
  def.nload = nload, def.load = load;
  return make_body(mesh, def);
}

static inline corot_inputs *give_inputs(const body *b) {
  corot_inputs *in;
  assert_ok(corot_inputs_create(b->model, &in));
  assert_ok(corot_state_use_inputs(b->state, in));
  return in;
}

static inline void drop_with(body *b, corot_inputs *in) {
  drop_body(b);
  corot_inputs_destroy(in);
}

/* A displacement and a velocity, [2 n]. */
static inline double *some_motion(int n, double size) {
  double *u = malloc(2 * n * sizeof *u);
  uint64_t seed = 5;
  for (int i = 0; i < n; i++) u[i] = size * noise(&seed), u[n + i] = 10 * size * noise(&seed);
  return u;
}

/* What two states make of one motion at t, to rounding: r, energies, all forces. */
static inline void assert_same(const body *a, const body *b, double t, const double *u) {
  int n = a->n, nnode = a->mesh->nnode;
  double *r = malloc(2 * n * sizeof *r), *s = r + n;
  double(*f)[3] = malloc(2 * nnode * sizeof *f), (*g)[3] = f + nnode;
  corot_energies e, d;
  assert_ok(corot_residual(a->model, a->state, t, u, u + n, r));
  assert_ok(corot_residual(b->model, b->state, t, u, u + n, s));
  assert_below(difference_of(n, r, s), 1e-13 * norm_max(n, r));
  assert_ok(corot_energy(a->model, a->state, t, u, u + n, &e));
  assert_ok(corot_energy(b->model, b->state, t, u, u + n, &d));
  assert_close(e.power_external, d.power_external, 1e-12, 0);
  assert_close(e.elastic, d.elastic, 1e-13, 0);
  assert_close(e.power_dissipated, d.power_dissipated, 1e-13, 0);
  corot_nodal_forces of_a = {.load = f}, of_b = {.load = g};
  assert_ok(corot_forces(a->model, a->state, t, u, u + n, u + n, &of_a));
  assert_ok(corot_forces(b->model, b->state, t, u, u + n, u + n, &of_b));
  assert_below(difference_of(3 * nnode, f[0], g[0]), 1e-13 * norm_max(3 * nnode, f[0]));
  free(r), free(f);
}

/* An integrator of the i-th method; NULL: there is none. */
static inline corot_integrator *integrate_by(int i, const body *b, double rtol) {
  corot_integrator *integrator;
  const corot_method_kind *kind = corot_method_at(i);
  if (!kind) return NULL;
  corot_integrator_def def = corot_integrator_defaults();
  def.method = kind->name, def.rtol = rtol;
  if (!kind->controls_error) def.step = 1e-3;
  double *rest = calloc(b->n, sizeof *rest);
  assert_ok(corot_integrator_create(&def, b->model, b->state, 0, rest, rest, &integrator));
  free(rest);
  return integrator;
}

/* Steps to t; those of a constant step end there to rounding. */
static inline void go_to(corot_integrator *integrator, double t) {
  corot_step step = {0};
  while (step.t < t * (1 - 1e-9)) assert_ok(corot_integrator_step(integrator, t, &step));
}

#endif
