/* Forces on nodes, pressure that follows the surface, damping by mass, and supports that move. */
#include "solid.h"

/* A box of 1 x 0.5 x 2 m. */
static corot_mesh *block(void) {
  corot_box box = {.size = {1, 0.5, 2}, .cells = {2, 1, 4}, .origin = {0, 0, 0}};
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  return mesh;
}

static corot_model_def plain(void) {
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = &soft;
  return def;
}

/* Sum of the loads on a free body at x = A X, and of their moments about the origin: residual with
   the loads less that of `bare`, the same body without. */
static void resultant(const body *b, const body *bare, const double A[9], double force[3],
                      double moment[3]) {
  double *u = calloc(4 * b->n, sizeof *u), *v = u + b->n, *r = v + b->n, *internal = r + b->n;
  for (int n = 0; n < b->mesh->nnode; n++) {
    apply(A, b->mesh->x[n], u + 3 * n);
    for (int c = 0; c < 3; c++) u[3 * n + c] -= b->mesh->x[n][c];
  }
  assert_ok(corot_residual(b->model, b->state, 0, u, v, r));
  assert_ok(corot_residual(bare->model, bare->state, 0, u, v, internal));
  memset(force, 0, 3 * sizeof *force), memset(moment, 0, 3 * sizeof *moment);
  for (int n = 0; n < b->mesh->nnode; n++) {
    double x[3], f[3];
    apply(A, b->mesh->x[n], x);
    for (int c = 0; c < 3; c++) f[c] = r[3 * n + c] - internal[3 * n + c], force[c] += f[c];
    for (int c = 0; c < 3; c++) {
      int i = (c + 1) % 3, j = (c + 2) % 3;
      moment[c] += x[i] * f[j] - x[j] * f[i];
    }
  }
  free(u);
}

/* One load, at x = A X. */
static void resultant_of(const corot_load *load, int nload, const double A[9], double force[3],
                         double moment[3]) {
  corot_model_def def = plain();
  body bare = make_body(block(), def);
  def.nload = nload, def.load = load;
  body b = make_body(block(), def);
  resultant(&b, &bare, A, force, moment);
  drop_body(&b), drop_body(&bare);
}

static void a_force_is_spread_over_its_nodes(void **state) {
  (void)state;
  corot_load load = {COROT_FORCE, "zmax", {3, -2, 7}, {0, NULL, NULL}};
  double force[3], moment[3];
  resultant_of(&load, 1, identity, force, moment);
  for (int c = 0; c < 3; c++) assert_close(force[c], load.value[c], 1e-14, 0);

  /* evenly, and what falls on a held component is the support's */
  corot_fix fix = {"xmin", {true, false, false}};
  corot_model_def def = plain();
  def.nload = 1, def.load = &load, def.nfix = 1, def.fix = &fix;
  body b = make_body(block(), def);
  double *u = calloc(2 * b.n, sizeof *u), *r = u + b.n;
  const corot_group *top = corot_mesh_find_group(b.mesh, "zmax");
  const int(*dof)[3] = corot_model_dof(b.model);
  assert_ok(corot_residual(b.model, b.state, 0, u, u, r));
  for (int i = 0; i < top->nnode; i++)
    for (int c = 0; c < 3; c++)
      if (dof[top->node[i]][c] >= 0)
        assert_close(r[dof[top->node[i]][c]], load.value[c] / top->nnode, 1e-14, 0);
  free(u), drop_body(&b);
}

/* -p n on the deformed area: p times the area vector cof(A) N of a plane side. */
static void pressure_follows_the_surface(void **state) {
  (void)state;
  static const struct {
    const char *group;
    double area[3]; /* outward [m^2] */
  } side[] = {{"xmin", {-1, 0, 0}}, {"xmax", {1, 0, 0}},    {"ymin", {0, -2, 0}},
              {"ymax", {0, 2, 0}},  {"zmin", {0, 0, -0.5}}, {"zmax", {0, 0, 0.5}}};
  double Q[9], T[9], A[9], axis[3] = {1, 2, 0.5}, p = 300;
  uint64_t seed = 5;
  rotation(axis, 1.2, Q);
  random_gradient(&seed, 0.3, T);
  multiply(Q, T, A);
  for (int k = 0; k < 6; k++) {
    corot_load load = {COROT_PRESSURE, side[k].group, {p}, {0, NULL, NULL}};
    double force[3], moment[3];
    for (int i = 0; i < 3; i++) {
      double expected = 0; /* -p cof(A) N */
      for (int j = 0; j < 3; j++) {
        int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
        double cofactor = A[3 * i1 + j1] * A[3 * i2 + j2] - A[3 * i1 + j2] * A[3 * i2 + j1];
        expected -= p * cofactor * side[k].area[j];
      }
      resultant_of(&load, 1, A, force, moment);
      assert_close(force[i], expected, 0, 1e-9); /* internal forces are some 1e4 N */
    }
  }
}

/* All around, it neither pushes nor turns the body, however deformed. */
static void pressure_all_around_balances(void **state) {
  (void)state;
  static const char *const side[] = {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"};
  corot_load load[6];
  for (int k = 0; k < 6; k++) load[k] = (corot_load){COROT_PRESSURE, side[k], {300}, {0}};
  double A[9], force[3], moment[3];
  uint64_t seed = 7;
  random_gradient(&seed, 0.3, A);
  resultant_of(load, 6, A, force, moment);
  assert_below(norm_max(3, force), 1e-9);
  assert_below(norm_max(3, moment), 1e-9);
}

/* All loads there are, held components included: their sum is the whole body's, and on free
   components they are what the residual has. */
static void loads_are_known_on_supports_too(void **state) {
  (void)state;
  static const double time[] = {0, 2}, value[] = {0, 3};
  const corot_load load[] = {
      {COROT_GRAVITY, NULL, {1, -2, -9.81}, {0}},
      {COROT_TRACTION, "xmin", {5, 6, 7}, {2, time, value}},
      {COROT_FORCE, "zmin", {3, -2, 7}, {0}},
      {COROT_PRESSURE, "zmin", {11}, {0}},
  };
  /* volume 1 m^3; at t = 1 s; the sides' areas are 1 m^2 and 0.5 m^2 */
  const double sum[4][3] = {{soft.density, -2 * soft.density, -9.81 * soft.density},
                            {7.5, 9, 10.5},
                            {3, -2, 7},
                            {0, 0, 5.5}};
  corot_fix fix[] = {{"zmin", {true, true, true}}, {"xmin", {true, false, false}}};
  for (int k = 0; k < 4; k++) {
    corot_model_def def = plain();
    def.nload = 1, def.load = &load[k], def.nfix = 2, def.fix = fix;
    body b = make_body(block(), def);
    double *u = calloc(2 * b.n, sizeof *u), *r = u + b.n;
    double(*rest)[3] = calloc(2 * b.mesh->nnode, sizeof *rest), (*f)[3] = rest + b.mesh->nnode;
    assert_ok(corot_residual(b.model, b.state, 1, u, u, r));
    assert_ok(corot_load_force(b.model, 1, 0.5, (const double(*)[3])rest, f));
    for (int c = 0; c < 3; c++) {
      double total = 0, size = fabs(sum[k][0]) + fabs(sum[k][1]) + fabs(sum[k][2]);
      for (int n = 0; n < b.mesh->nnode; n++) {
        int i = corot_model_dof(b.model)[n][c];
        total += f[n][c];
        if (i >= 0) assert_close(f[n][c], 0.5 * r[i], 1e-14, 0);
      }
      assert_close(total, 0.5 * sum[k][c], 0, 1e-13 * size);
    }
    free(u), free(rest), drop_body(&b);
  }
}

static void damping_by_mass_slows_each_node(void **state) {
  (void)state;
  corot_material m = {.lambda = 1e5, .mu = 1e4, .density = 1000, .damping_mass = 4};
  corot_model_def def = plain();
  def.material = &m;
  body b = make_body(block(), def);
  corot_energies e;
  double *u = calloc(3 * b.n, sizeof *u), *v = u + b.n, *r = v + b.n;
  const double *mass = corot_model_mass(b.model);
  for (int i = 0; i < b.n; i++) v[i] = 1 + i % 3;
  assert_ok(corot_residual(b.model, b.state, 0, u, v, r));
  for (int i = 0; i < b.n; i++) assert_close(r[i], -4 * mass[i] * v[i], 1e-14, 0);
  assert_ok(corot_energy(b.model, b.state, 0, u, v, &e));
  assert_close(e.power_dissipated, 4 * 1000 * (1 + 4 + 9), 1e-13, 0); /* of one cubic metre */
  free(u), drop_body(&b);
}

static void refuses_a_motion_without_sense(void **state) {
  (void)state;
  static const corot_motion good = {COROT_ROTATE, "zmax", {0, 0, 1}, {0, 0, 0}, 1, {0, 0, 0}, 0, 1};
  static const double bad[] = {NAN, INFINITY};
  corot_mesh *mesh = block();
  corot_motion motion[2] = {good, good};
  corot_fix fix = {"xmin", {false, true, false}};
  corot_model_def def = plain();
  corot_model *model = NULL;
  def.mesh = mesh, def.nmotion = 1, def.motion = motion;
  double *const number[] = {&motion->center[1], &motion->rate, &motion->velocity[2], &motion->from};
  for (int k = 0; k < 4; k++)
    for (int i = 0; i < 2; i++) {
      motion[0] = good;
      *number[k] = bad[i];
      assert_fails(corot_model_create(&def, &model), COROT_EINVAL, "motion 0: ");
    }
  motion[0] = good, motion[0].axis[2] = 0;
  assert_fails(corot_model_create(&def, &model), COROT_EINVAL, "motion 0: the axis has no direct");
  motion[0].axis[2] = NAN;
  assert_fails(corot_model_create(&def, &model), COROT_EINVAL, "motion 0: the axis has no direct");
  motion[0] = good, motion[0].to = 0;
  assert_fails(corot_model_create(&def, &model), COROT_EINVAL, "from t = 0 to t = 0");
  motion[0].to = NAN;
  assert_fails(corot_model_create(&def, &model), COROT_EINVAL, "from t = 0 to t = nan");
  motion[0] = good, motion[0].kind = (corot_motion_kind)5;
  assert_fails(corot_model_create(&def, &model), COROT_EINVAL,
               "no kind of motion has the number 5");
  motion[0] = good, motion[0].group = "nowhere";
  assert_fails(corot_model_create(&def, &model), COROT_EINVAL,
               "motion 0: the mesh has no group 'now");
  motion[0] = good, motion[1].from = 0.5, motion[1].to = 2, def.nmotion = 2;
  assert_fails(corot_model_create(&def, &model), COROT_EINVAL,
               "motion 1: group 'zmax' is already moving from t = 0 to t = 1");
  motion[1].kind = COROT_TRANSLATE;
  assert_fails(
      corot_model_create(&def, &model), COROT_EINVAL,
      "motion 1: does not continue the other motion of zmax: it has to turn about the same");
  def.nmotion = 1, def.nfix = 1, def.fix = &fix;
  assert_fails(corot_model_create(&def, &model), COROT_EINVAL, "is already held in y");
  assert_null(model);
  corot_mesh_destroy(mesh);
}

/* Positions and velocities of moving supports: at rest before, on the path, at rest after. */
static void supports_move_on_their_paths(void **state) {
  (void)state;
  double c = cos(0.3), s = sin(0.3);
  corot_motion motion[] = {
      {COROT_ROTATE, "zmax", {0, 0, 2}, {1, 0.5, 0}, 0.5, {9, 9, 9}, 1, 1.6},
      {COROT_TRANSLATE, "zmin", {0, 0, 0}, {0, 0, 0}, 9, {1, -2, 3}, -1, INFINITY}};
  const double at[] = {0.5, 1.2, 1.6, 7};
  corot_model_def def = plain();
  def.nmotion = 2, def.motion = motion;
  body b = make_body(block(), def);
  int nnode = b.mesh->nnode;
  double *u = calloc(2 * b.n, sizeof *u), (*x)[3] = malloc(2 * nnode * sizeof *x),
         (*v)[3] = x + nnode;
  assert_int_equal(b.n, 3 * (nnode - 2 * 6));
  for (int k = 0; k < 4; k++) {
    double t = at[k], angle = 0.5 * fmin(fmax(t - 1, 0), 0.6), moving = t >= 1 && t < 1.6 ? 0.5 : 0;
    corot_nodal(b.model, t, u, u, x, v);
    if (k == 2) assert_close(angle, 0.3, 1e-15, 0); /* c, s */
    for (int n = 0; n < nnode; n++) {
      const double *X = b.mesh->x[n];
      double at_t[3] = {0}, velocity[3] = {0};
      if (X[2] == 0)
        for (int i = 0; i < 3; i++)
          at_t[i] = motion[1].velocity[i] * (t + 1), velocity[i] = motion[1].velocity[i];
      if (X[2] == 2) {
        double arm[2] = {X[0] - 1, X[1] - 0.5}, ct = cos(angle), st = sin(angle);
        double turned[2] = {ct * arm[0] - st * arm[1], st * arm[0] + ct * arm[1]};
        at_t[0] = turned[0] - arm[0], at_t[1] = turned[1] - arm[1];
        velocity[0] = -moving * turned[1], velocity[1] = moving * turned[0];
        if (k >= 2) assert_close(at_t[0], c * arm[0] - s * arm[1] - arm[0], 1e-13, 1e-15);
      }
      for (int i = 0; i < 3; i++) {
        assert_close(x[n][i], at_t[i], 1e-14, 1e-15);
        assert_close(v[n][i], velocity[i], 1e-14, 1e-15);
      }
    }
  }
  double kink[4];
  assert_int_equal(corot_model_kinks(b.model, -10, 10, 4, kink), 3);
  assert_true(kink[0] == -1 && kink[1] == 1 && kink[2] == 1.6);
  free(u), free(x), drop_body(&b);
}

/* A body carried by its supports as a whole, rigidly, feels nothing of it. */
static void a_carried_body_is_at_rest_in_itself(void **state) {
  (void)state;
  corot_motion motion = {COROT_ROTATE, "zmax", {1, 2, 3}, {0.2, 0, 1}, 0.7, {0, 0, 0}, 0, INFINITY};
  corot_model_def def = plain();
  def.nmotion = 1, def.motion = &motion;
  body b = make_body(block(), def);
  double *u = calloc(3 * b.n, sizeof *u), *v = u + b.n, *r = v + b.n, Q[9], t = 2;
  int nnode = b.mesh->nnode;
  double(*all)[3] = malloc(2 * nnode * sizeof *all), (*rate)[3] = all + nnode;
  rotation(motion.axis, motion.rate * t, Q);
  double length = sqrt(14), w[3] = {0.7 / length, 1.4 / length, 2.1 / length};
  for (int n = 0; n < nnode; n++) {
    double arm[3], turned[3];
    for (int i = 0; i < 3; i++) arm[i] = b.mesh->x[n][i] - motion.center[i];
    apply(Q, arm, turned);
    for (int i = 0; i < 3; i++) {
      int j = (i + 1) % 3, k = (i + 2) % 3;
      all[n][i] = turned[i] - arm[i];
      rate[n][i] = w[j] * turned[k] - w[k] * turned[j];
    }
  }
  to_dofs(&b, (const double(*)[3])all, u);
  to_dofs(&b, (const double(*)[3])rate, v);
  corot_energies e;
  assert_ok(corot_residual(b.model, b.state, t, u, v, r));
  assert_below(norm_max(b.n, r), 1e-9); /* eps (3 lambda + 2 mu) L h, as in a rigid motion */
  assert_ok(corot_energy(b.model, b.state, t, u, v, &e));
  assert_below(e.elastic, 1e-20);
  assert_below(fabs(e.power_external), 1e-9);
  free(u), free(all), drop_body(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_force_is_spread_over_its_nodes),
      cmocka_unit_test(pressure_follows_the_surface),
      cmocka_unit_test(pressure_all_around_balances),
      cmocka_unit_test(loads_are_known_on_supports_too),
      cmocka_unit_test(damping_by_mass_slows_each_node),
      cmocka_unit_test(refuses_a_motion_without_sense),
      cmocka_unit_test(supports_move_on_their_paths),
      cmocka_unit_test(a_carried_body_is_at_rest_in_itself),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
