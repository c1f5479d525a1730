/* A level 0 that moves for itself: its rows against those of the plain model of its mesh, the rows
   of the detail against those of the finest level alone. */
#include "hierarchical.h"

static const double ramp_time[] = {0, 2}, ramp_value[] = {0, 1};
static const corot_material viscous = {.lambda = 3.0e4,
                                       .mu = 1.0e4,
                                       .density = 1000,
                                       .damping_lambda = 10,
                                       .damping_mu = 5,
                                       .damping_mass = 2};

/* Two levels, one end held and the other on a moving support. */
typedef struct pair {
  body one_way, coarse;     /* the second the plain green model of level 0 */
  body detail;              /* E_fine alone, in frames of level 0 */
  int nnode, n;             /* of level 0: nodes, and free degrees of freedom */
  double *u, *v, *r, *work; /* [one_way.n] of a bent body */
} pair;

static void set_conditions(corot_model_def *def) {
  static const corot_load load[] = {
      {COROT_TRACTION, "xmax", {30, -20, 10}, {2, ramp_time, ramp_value}},
      {COROT_GRAVITY, NULL, {0, -9.81, 1}, {0, NULL, NULL}},
  };
  static const corot_motion turn_end = {.kind = COROT_ROTATE,
                                        .group = "zmax",
                                        .axis = {0.2, 1, 0.1},
                                        .rate = 0.55, /* as `bend` turns it by 1.2 s */
                                        .from = 0,
                                        .to = 1.3};
  def->nload = 2, def->load = load;
  def->nmotion = 1, def->motion = &turn_end;
}

static body make(const choice *c, corot_coupling coupling) {
  corot_mesh *box = crooked_box(2, 2, 2), *mesh;
  corot_refinement *refinement;
  corot_hierarchy_def hierarchy;
  corot_model_def def = definition(c, coupling, &viscous, true, &hierarchy);
  set_conditions(&def);
  if (coupling != one_way) def.mass = COROT_MASS_LUMPED; /* as one way it is by itself */
  refine_to(c, box, &mesh, &refinement);
  hierarchy.refinement = refinement;
  body b = make_body(mesh, def);
  corot_refinement_destroy(refinement);
  corot_mesh_destroy(box);
  return b;
}

/* The levels are octasections, or the last one is that of ten-node tets. */
static pair make_pair(int frame_level, bool raised) {
  int nlevel = raised ? 1 : 2;
  pair p = {
      .one_way = make(&(choice){"green", "polar", nlevel, frame_level, false, raised}, one_way),
      .coarse = make(&(choice){"green", "polar", 0, 0, true}, means),
      .detail = make(&(choice){"polar", "polar", nlevel, frame_level, false, raised}, nodes)};
  int n = p.one_way.n;
  p.nnode = p.coarse.mesh->nnode, p.n = p.coarse.n;
  p.u = vectors(8, n), p.v = p.u + n, p.r = p.v + n, p.work = p.r + n;
  solid s = {.mesh = p.one_way.mesh, .model = p.one_way.model};
  bend(&s, 0.6, 0.005, p.u);
  fill_noise(n, 3, 1, p.v);
  return p;
}

static void drop_pair(pair *p) {
  drop_body(&p->one_way);
  drop_body(&p->coarse);
  drop_body(&p->detail);
  free(p->u);
}

/* Free values of level 0 come first in both models. */
static void level_0_feels_its_own_forces(void **state) {
  (void)state;
  for (int raised = 0; raised < 2; raised++) {
    pair p = make_pair(0, raised);
    double t = 1.2;
    assert_near(p.n, corot_model_mass(p.one_way.model), corot_model_mass(p.coarse.model), 1e-14);
    assert_ok(corot_residual(p.one_way.model, p.one_way.state, t, p.u, p.v, p.r));
    assert_ok(corot_residual(p.coarse.model, p.coarse.state, t, p.u, p.v, p.work));
    assert_near(p.n, p.r, p.work, 1e-14);
    drop_pair(&p);
  }
}

static void the_detail_feels_the_finest_level(void **state) {
  (void)state;
  for (int raised = 0; raised < 2; raised++) {
    for (int level = 0; level < 3; level++) {
      pair p = make_pair(level, raised);
      int rest = p.one_way.n - p.n;
      assert_ok(corot_residual(p.one_way.model, p.one_way.state, 1.2, p.u, p.v, p.r));
      assert_ok(corot_residual(p.detail.model, p.detail.state, 1.2, p.u, p.v, p.work));
      assert_near(rest, p.r + p.n, p.work + p.n, 1e-14);
      assert_memory_equal(corot_model_mass(p.one_way.model) + p.n,
                          corot_model_mass(p.detail.model) + p.n, rest * sizeof(double));
      drop_pair(&p);
    }
  }
}

/* The balance is that of level 0. */
static void energies_are_those_of_level_0(void **state) {
  (void)state;
  for (int raised = 0; raised < 2; raised++) {
    pair p = make_pair(0, raised);
    corot_energies found, expected;
    assert_ok(corot_energy(p.one_way.model, p.one_way.state, 1.2, p.u, p.v, &found));
    assert_ok(corot_energy(p.coarse.model, p.coarse.state, 1.2, p.u, p.v, &expected));
    assert_close(found.kinetic, expected.kinetic, 1e-13, 0);
    assert_close(found.elastic, expected.elastic, 1e-13, 0);
    assert_close(found.power_dissipated, expected.power_dissipated, 1e-13, 0);
    assert_close(found.power_external, expected.power_external, 1e-12, 0);
    for (int c = 0; c < 3; c++) {
      assert_close(found.momentum[c], expected.momentum[c], 0,
                   1e-12 * norm_max(3, expected.momentum));
      assert_close(found.angular_momentum[c], expected.angular_momentum[c], 0,
                   1e-12 * norm_max(3, expected.angular_momentum));
    }
    drop_pair(&p);
  }
}

/* When nothing moves, for K is that of v = 0: y = -A x by blocks, against the product with the
   derivative; `at` and `n`: where x is, and where they must agree. Elsewhere y is zero. */
static void assert_block(const pair *p, int at, int n) {
  const body *b = &p->one_way;
  double *du = p->work, *zero = du + b->n, *y = zero + b->n, *jv = y + b->n;
  int nblock = corot_model_nblock(b->model);
  double(*K)[9] = calloc(2 * nblock, sizeof *K), (*D)[9] = K + nblock;
  memset(p->work, 0, 2 * b->n * sizeof *du);
  fill_noise(n, 4, 1, du + at);
  assert_ok(corot_jacobian(b->model, b->state, 1.5, p->u, zero, COROT_TANGENT_HELD, K, D));
  for (int k = 0; k < 2; k++) {
    const double *x = k == 0 ? du : zero, *dx = k == 0 ? zero : du;
    corot_block_multiply(b->model, (const double(*)[9])(k == 0 ? K : D), du, y);
    assert_ok(corot_jvp(b->model, b->state, 1.5, p->u, zero, COROT_TANGENT_HELD, x, dx, jv));
    for (int i = 0; i < b->n; i++) {
      y[i] = -y[i];
      if (i < at || i >= at + n) assert_true(y[i] == 0);
    }
    assert_near(n, y + at, jv + at, 1e-12);
  }
  free(K);
}

static void matrices_are_block_diagonal(void **state) {
  (void)state;
  for (int raised = 0; raised < 2; raised++) {
    pair p = make_pair(0, raised);
    corot_state_use(p.one_way.state, COROT_FRAMES_HELD);
    assert_ok(corot_frames_update(p.one_way.model, p.one_way.state, 1.5, p.u, NULL));
    assert_block(&p, 0, p.n);
    assert_block(&p, p.n, p.one_way.n - p.n);
    drop_pair(&p);
  }
}

static void what_has_no_place_is_refused(void **state) {
  (void)state;
  solid s = make_solid(&(choice){"green", "polar", 1, 0, false}, one_way, &soft, true);
  corot_load pressure = {COROT_PRESSURE, "zmax", {1, 0, 0}, {0, NULL, NULL}};
  corot_hierarchy_def hierarchy;
  corot_model_def def =
      definition(&(choice){"green", "polar", 1, 0, false}, one_way, &soft, true, &hierarchy);
  corot_model *model;
  def.mesh = s.mesh, hierarchy.refinement = s.refinement;
  def.mass = COROT_MASS_CONSISTENT;
  assert_fails(corot_model_create(&def, &model), COROT_EINVAL, "a mass of its own");
  def.mass = COROT_MASS_LUMPED;
  def.nload = 1, def.load = &pressure;
  assert_fails(corot_model_create(&def, &model), COROT_EINVAL, "pressure on group 'zmax'");
  drop_solid(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(level_0_feels_its_own_forces),
      cmocka_unit_test(the_detail_feels_the_finest_level),
      cmocka_unit_test(energies_are_those_of_level_0),
      cmocka_unit_test(matrices_are_block_diagonal),
      cmocka_unit_test(what_has_no_place_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
