/* Hierarchical models for tests. */
#ifndef HIERARCHICAL_H
#define HIERARCHICAL_H

#include <corot/hierarchy.h>

#include "solid.h"

typedef struct choice {
  const char *coarse, *fine;
  int nlevel, frame_level; /* refined so many times */
  bool conservative;
  bool raised; /* then given ten nodes a tet, which is one more level */
} choice;

typedef struct solid {
  corot_mesh *coarse, *mesh;
  corot_refinement *refinement;
  corot_model *model;
  corot_state *state;
  int n;
} solid;

/* A test that is run under each coupling that has one energy, or under each, which is its state. */
static const corot_coupling means = COROT_COUPLING_MEAN, nodes = COROT_COUPLING_NODES;
static const corot_coupling one_way = COROT_COUPLING_ONE_WAY;
#define coupled_unit_test(f) \
  {#f ", mean", f, NULL, NULL, (void *)&means}, { #f ", nodes", f, NULL, NULL, (void *)&nodes }

#define each_coupling_unit_test(f) \
  coupled_unit_test(f), { #f ", one way", f, NULL, NULL, (void *)&one_way }

static inline corot_coupling coupling_of(void **state) { return *(const corot_coupling *)*state; }

static const corot_material undamped = {.lambda = 3.0e4, .mu = 1.0e4, .density = 1000};

/* Free, or held at one end. */
static inline corot_model_def definition(const choice *c, corot_coupling coupling,
                                         const corot_material *material, bool held,
                                         corot_hierarchy_def *hierarchy) {
  static const corot_fix fix = {"zmin", {true, true, true}};
  corot_model_def def = corot_model_defaults();
  *hierarchy = corot_hierarchy_defaults();
  hierarchy->coarse_strain = c->coarse;
  hierarchy->frame_level = c->frame_level;
  hierarchy->conservative = c->conservative;
  hierarchy->coupling = coupling;
  def.strain = c->fine, def.hierarchy = hierarchy;
  def.viscosity = COROT_COROTATED; /* of the plain models that hierarchies are held against, too */
  def.nmaterial = 1, def.material = material;
  def.nfix = held, def.fix = &fix;
  return def;
}

/* The mesh refined as often as the choice says, and raised if it says so. */
static inline void refine_to(const choice *c, const corot_mesh *coarse, corot_mesh **mesh,
                             corot_refinement **refinement) {
  assert_ok(corot_mesh_refine(coarse, c->nlevel, COROT_DIAGONAL_CONSISTENT, mesh, refinement));
  if (!c->raised) return;
  corot_mesh *linear = *mesh;
  assert_ok(corot_mesh_change_order(linear, 2, mesh));
  assert_ok(corot_refinement_raise(*refinement, *mesh));
  corot_mesh_destroy(linear);
}

static inline solid make_solid(const choice *c, corot_coupling coupling,
                               const corot_material *material, bool held) {
  solid s = {.coarse = linear_box(1, 1, 2)};
  corot_hierarchy_def hierarchy;
  corot_model_def def = definition(c, coupling, material, held, &hierarchy);
  refine_to(c, s.coarse, &s.mesh, &s.refinement);
  def.mesh = s.mesh, hierarchy.refinement = s.refinement;
  assert_ok(corot_model_create(&def, &s.model));
  assert_ok(corot_state_create(s.model, &s.state));
  s.n = corot_model_ndof(s.model);
  return s;
}

/* The plain model of one measure on the refined mesh. */
static inline body plain_body(const solid *s, const char *strain, const corot_material *material,
                              bool held) {
  choice c = {.fine = strain};
  corot_hierarchy_def hierarchy;
  corot_model_def def = definition(&c, means, material, held, &hierarchy);
  corot_mesh *copy;
  def.hierarchy = NULL;
  assert_ok(corot_mesh_copy(s->mesh, &copy));
  return make_body(copy, def);
}

static inline void drop_solid(solid *s) {
  corot_state_destroy(s->state);
  corot_model_destroy(s->model);
  corot_refinement_destroy(s->refinement);
  corot_mesh_destroy(s->mesh);
  corot_mesh_destroy(s->coarse);
}

/* A turn that grows along the body, and noise of each node's own. */
static inline void bend(const solid *s, double angle, double size, double *u) {
  const int(*dof)[3] = corot_model_dof(s->model);
  uint64_t seed = 5;
  for (int n = 0; n < s->mesh->nnode; n++) {
    double axis[3] = {0.2, 1, 0.1}, Q[9], x[3];
    rotation(axis, angle * (s->mesh->x[n][2] - 0.1), Q);
    apply(Q, s->mesh->x[n], x);
    for (int c = 0; c < 3; c++) {
      double part = size * noise(&seed);
      if (dof[n][c] >= 0) u[dof[n][c]] = x[c] - s->mesh->x[n][c] + part;
    }
  }
}

static inline void fill_noise(int n, uint64_t seed, double size, double *x) {
  for (int i = 0; i < n; i++) x[i] = size * noise(&seed);
}

static inline double elastic_energy(const corot_model *m, corot_state *s, const double *u,
                                    const double *zero) {
  corot_energies e;
  assert_ok(corot_energy(m, s, 0, u, zero, &e));
  return e.elastic;
}

static inline double *vectors(int count, int n) {
  return calloc((size_t)count * n, sizeof(double));
}

/* Within rtol of the largest. */
static inline void assert_near(int n, const double *a, const double *expected, double rtol) {
  double scale = norm_max(n, expected);
  for (int i = 0; i < n; i++) assert_close(a[i], expected[i], 0, rtol * scale);
}

/* The displacement of the body displaced by u, turned (or deformed) by Q and moved; all nodes free.
 */
static inline void turn(const solid *s, const double Q[9], const double *u, double *turned) {
  for (int n = 0; n < s->mesh->nnode; n++) {
    double x[3], Qx[3];
    for (int c = 0; c < 3; c++) x[c] = s->mesh->x[n][c] + u[3 * n + c];
    apply(Q, x, Qx);
    for (int c = 0; c < 3; c++) turned[3 * n + c] = Qx[c] - s->mesh->x[n][c] + 0.1 * (c + 1);
  }
}

#endif
