/* A hierarchical model: its force against differences of the energy, its derivatives against
   differences of the force, and the models to which it reduces. */
#include <corot/hierarchy.h>

#include "alloc.h"
#include "solid.h"

typedef struct choice {
  const char *coarse, *fine;
  int nlevel, frame_level;
  bool conservative;
} choice;

typedef struct solid {
  corot_mesh *coarse, *mesh;
  corot_refinement *refinement;
  corot_model *model;
  corot_state *state;
  int n;
} solid;

static const corot_material undamped = {.lambda = 3.0e4, .mu = 1.0e4, .density = 1000};

/* Free, or held at one end. */
static corot_model_def definition(const choice *c, const corot_material *material, bool held,
                                  corot_hierarchy_def *hierarchy) {
  static const corot_fix fix = {"zmin", {true, true, true}};
  corot_model_def def = corot_model_defaults();
  *hierarchy = corot_hierarchy_defaults();
  hierarchy->coarse_strain = c->coarse;
  hierarchy->frame_level = c->frame_level;
  hierarchy->conservative = c->conservative;
  def.strain = c->fine, def.hierarchy = hierarchy;
  def.nmaterial = 1, def.material = material;
  def.nfix = held, def.fix = &fix;
  return def;
}

static solid make_solid(const choice *c, const corot_material *material, bool held) {
  solid s = {.coarse = crooked_box(1, 1, 2)};
  corot_hierarchy_def hierarchy;
  corot_model_def def = definition(c, material, held, &hierarchy);
  assert_ok(
      corot_mesh_refine(s.coarse, c->nlevel, COROT_DIAGONAL_CONSISTENT, &s.mesh, &s.refinement));
  def.mesh = s.mesh, hierarchy.refinement = s.refinement;
  assert_ok(corot_model_create(&def, &s.model));
  assert_ok(corot_state_create(s.model, &s.state));
  s.n = corot_model_ndof(s.model);
  return s;
}

/* The plain model of one measure on the refined mesh. */
static body plain_body(const solid *s, const char *strain, const corot_material *material,
                       bool held) {
  choice c = {.fine = strain};
  corot_hierarchy_def hierarchy;
  corot_model_def def = definition(&c, material, held, &hierarchy);
  corot_mesh *copy;
  def.hierarchy = NULL;
  assert_ok(corot_mesh_copy(s->mesh, &copy));
  return make_body(copy, def);
}

static void drop_solid(solid *s) {
  corot_state_destroy(s->state);
  corot_model_destroy(s->model);
  corot_refinement_destroy(s->refinement);
  corot_mesh_destroy(s->mesh);
  corot_mesh_destroy(s->coarse);
}

/* A turn that grows along the body, and noise of each node's own. */
static void bend(const solid *s, double angle, double size, double *u) {
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

static void fill_noise(int n, uint64_t seed, double size, double *x) {
  for (int i = 0; i < n; i++) x[i] = size * noise(&seed);
}

static double elastic_energy(const corot_model *m, corot_state *s, const double *u,
                             const double *zero) {
  corot_energies e;
  assert_ok(corot_energy(m, s, 0, u, zero, &e));
  return e.elastic;
}

static double *vectors(int count, int n) { return calloc((size_t)count * n, sizeof(double)); }

/* --- Force and energy ------------------------------------------------------------------------ */

/* |dE/du du + f du| / |f du| by central differences, along a random direction. */
static double gradient_error(const choice *c, corot_frames frames) {
  solid s = make_solid(c, &undamped, true);
  double *u = vectors(5, s.n), *zero = u + s.n, *du = zero + s.n, *r = du + s.n, *x = r + s.n;
  bend(&s, 0.6, 0.01, u);
  if (frames != COROT_FRAMES_EXACT) {
    bend(&s, 0.5, 0.005, x);
    corot_state_use(s.state, frames);
    assert_ok(corot_frames_update(s.model, s.state, 0, x, NULL));
  }
  fill_noise(s.n, 21, 1, du);
  assert_ok(corot_residual(s.model, s.state, 0, u, zero, r));
  double energy[2], h = 1e-5;
  for (int side = 0; side < 2; side++) {
    for (int i = 0; i < s.n; i++) x[i] = u[i] + (side ? h : -h) * du[i];
    energy[side] = elastic_energy(s.model, s.state, x, zero);
  }
  double expected = -inner(s.n, r, du), found = (energy[1] - energy[0]) / (2 * h);
  free(u);
  drop_solid(&s);
  return fabs(found - expected) / fabs(expected);
}

static void test_force_is_the_gradient_of_the_energy(void **state) {
  (void)state;
  const choice choices[] = {
      {"green", "polar", 1, 0, true},  {"green", "polar", 2, 0, true},
      {"green", "polar", 2, 1, true},  {"green", "polar", 2, 2, true},
      {"polar", "polar", 2, 1, true},  {"hybrid", "polar", 1, 0, true},
      {"green", "cauchy", 1, 0, true}, {"cauchy", "polar", 1, 1, true},
  };
  for (size_t k = 0; k < sizeof choices / sizeof *choices; k++)
    assert_below(gradient_error(&choices[k], COROT_FRAMES_EXACT), 1e-6);
}

/* As in the paper: not a gradient, unless the frames are held. */
static void test_force_without_the_turning_of_frames(void **state) {
  (void)state;
  choice c = {"green", "polar", 2, 0, false}, warp = {"green", "warp", 2, 0, false};
  assert_above(gradient_error(&c, COROT_FRAMES_EXACT), 1e-4);
  assert_below(gradient_error(&c, COROT_FRAMES_HELD), 1e-6);
  assert_below(gradient_error(&warp, COROT_FRAMES_HELD), 1e-6);
  c.conservative = true;
  assert_below(gradient_error(&c, COROT_FRAMES_HELD), 1e-6);
}

/* Sum of the forces and of their moments about the origin, on the displaced body; relative. */
static void resultants(const solid *s, const double *u, const double *r, double *force,
                       double *moment) {
  double f[3] = {0}, m[3] = {0}, scale = 0;
  for (int n = 0; n < s->mesh->nnode; n++) {
    double x[3];
    const double *p = r + 3 * n;
    for (int c = 0; c < 3; c++) {
      x[c] = s->mesh->x[n][c] + u[3 * n + c];
      f[c] += p[c];
      scale += fabs(p[c]);
    }
    m[0] += x[1] * p[2] - x[2] * p[1];
    m[1] += x[2] * p[0] - x[0] * p[2];
    m[2] += x[0] * p[1] - x[1] * p[0];
  }
  *force = norm_max(3, f) / scale;
  *moment = norm_max(3, m) / scale;
}

static void test_forces_on_a_free_body_balance(void **state) {
  (void)state;
  choice c = {"green", "polar", 2, 1, true};
  for (int k = 0; k < 2; k++) {
    c.conservative = k == 0;
    solid s = make_solid(&c, &undamped, false);
    double *u = vectors(3, s.n), *zero = u + s.n, *r = zero + s.n, force, moment;
    bend(&s, 0.6, 0.01, u);
    assert_ok(corot_residual(s.model, s.state, 0, u, zero, r));
    resultants(&s, u, r, &force, &moment);
    assert_below(force, 1e-13);
    if (c.conservative)
      assert_below(moment, 1e-13);
    else
      assert_above(moment, 1e-6);
    free(u);
    drop_solid(&s);
  }
}

static void turn(const solid *s, const double Q[9], const double *u, double *turned) {
  for (int n = 0; n < s->mesh->nnode; n++) {
    double x[3], Qx[3];
    for (int c = 0; c < 3; c++) x[c] = s->mesh->x[n][c] + u[3 * n + c];
    apply(Q, x, Qx);
    for (int c = 0; c < 3; c++) turned[3 * n + c] = Qx[c] - s->mesh->x[n][c] + 0.1 * (c + 1);
  }
}

static void test_a_turned_body_feels_turned_forces(void **state) {
  (void)state;
  const choice choices[] = {{"green", "polar", 2, 0, true},
                            {"green", "warp", 1, 0, false},
                            {"hybrid", "polar", 2, 1, false}};
  for (int k = 0; k < 3; k++) {
    solid s = make_solid(&choices[k], &undamped, false);
    double *u = vectors(5, s.n), *zero = u + s.n, *r = zero + s.n, *Qu = r + s.n, *Qr = Qu + s.n;
    double axis[3] = {1, -2, 0.5}, Q[9];
    rotation(axis, 2.1, Q);

    turn(&s, Q, zero, Qu); /* rigidly */
    assert_ok(corot_residual(s.model, s.state, 0, Qu, zero, r));
    assert_below(norm_max(s.n, r), 1e-10); /* rounding of mu times an area, 1e4 m^2 Pa */
    assert_below(elastic_energy(s.model, s.state, Qu, zero), 1e-20);

    bend(&s, 0.6, 0.01, u);
    turn(&s, Q, u, Qu);
    assert_ok(corot_residual(s.model, s.state, 0, u, zero, r));
    assert_ok(corot_residual(s.model, s.state, 0, Qu, zero, Qr));
    double scale = norm_max(s.n, r);
    for (int n = 0; n < s.mesh->nnode; n++) {
      double expected[3];
      apply(Q, r + 3 * n, expected);
      for (int c = 0; c < 3; c++) assert_close(Qr[3 * n + c], expected[c], 0, 1e-12 * scale);
    }
    free(u);
    drop_solid(&s);
  }
}

/* --- What it reduces to ---------------------------------------------------------------------- */

static void test_no_level_is_the_plain_model(void **state) {
  (void)state;
  choice c = {"green", "warp", 0, 0, true};
  solid s = make_solid(&c, &soft, true);
  body b = plain_body(&s, "green", &soft, true);
  double *u = vectors(4, s.n), *v = u + s.n, *r = v + s.n, *plain = r + s.n;
  bend(&s, 0.6, 0.01, u);
  fill_noise(s.n, 3, 1, v);
  assert_string_equal(corot_model_strain(s.model), "green");
  assert_ok(corot_residual(s.model, s.state, 0, u, v, r));
  assert_ok(corot_residual(b.model, b.state, 0, u, v, plain));
  assert_memory_equal(r, plain, s.n * sizeof *r);
  free(u);
  drop_body(&b);
  drop_solid(&s);
}

/* Where all differences vanish, the forces on level 0 and the energies are those of the coarse
   mesh: to the rounding of fine and linear terms that cancel. */
static void test_coarse_motion_feels_coarse_forces(void **state) {
  (void)state;
  const choice choices[] = {{"green", "polar", 2, 0, true},
                            {"polar", "polar", 1, 1, true},
                            {"hybrid", "warp", 2, 0, false},
                            {"green", "cauchy", 1, 0, true}};
  for (int k = 0; k < 4; k++) {
    solid s = make_solid(&choices[k], &soft, false);
    solid zero_level = make_solid(&(choice){choices[k].coarse, "polar", 0, 0, true}, &soft, false);
    double *u = vectors(6, s.n), *v = u + s.n, *r = v + s.n;
    double *uc = r + s.n, *vc = uc + s.n, *rc = vc + s.n;
    bend(&zero_level, 0.6, 0.03, uc);
    fill_noise(zero_level.n, 3, 1, vc);
    memcpy(u, uc, zero_level.n * sizeof *u);
    memcpy(v, vc, zero_level.n * sizeof *v);
    corot_hierarchy_apply(s.refinement, (double(*)[3])u);
    corot_hierarchy_apply(s.refinement, (double(*)[3])v);

    corot_energies fine, coarse;
    assert_ok(corot_energy(s.model, s.state, 0, u, v, &fine));
    assert_ok(corot_energy(zero_level.model, zero_level.state, 0, uc, vc, &coarse));
    assert_close(fine.elastic, coarse.elastic, 1e-12, 0);
    assert_close(fine.power_dissipated, coarse.power_dissipated, 1e-12, 0);

    assert_ok(corot_residual(s.model, s.state, 0, u, v, r));
    assert_ok(corot_residual(zero_level.model, zero_level.state, 0, uc, vc, rc));
    corot_hierarchy_apply_transposed(s.refinement, (double(*)[3])r);
    double scale = norm_max(zero_level.n, rc);
    for (int i = 0; i < zero_level.n; i++) assert_close(r[i], rc[i], 0, 1e-12 * scale);
    free(u);
    drop_solid(&zero_level);
    drop_solid(&s);
  }
}

/* One strain everywhere: no force on a node inside, coarse or fine. */
static void test_affine_motion_has_no_force_inside(void **state) {
  (void)state;
  choice c = {"green", "polar", 2, 0, true};
  solid s = make_solid(&c, &undamped, false);
  double *u = vectors(3, s.n), *zero = u + s.n, *r = zero + s.n, F[9];
  uint64_t seed = 9;
  random_gradient(&seed, 0.2, F);
  turn(&s, F, zero, u);
  assert_ok(corot_residual(s.model, s.state, 0, u, zero, r));
  int ntri, (*tri)[3], inside = 0;
  char *surface = calloc(s.mesh->nnode, 1);
  assert_ok(corot_mesh_boundary(s.mesh, &ntri, &tri));
  for (int k = 0; k < ntri; k++)
    for (int a = 0; a < 3; a++) surface[tri[k][a]] = 1;
  double scale = norm_max(s.n, r);
  for (int n = 0; n < s.mesh->nnode; n++) {
    if (surface[n]) continue;
    inside++;
    assert_below(norm_max(3, r + 3 * n), 1e-12 * scale);
  }
  assert_true(inside > 20);
  free(surface), free(tri), free(u);
  drop_solid(&s);
}

static void test_one_measure_in_its_own_frames_is_the_plain_model(void **state) {
  (void)state;
  const char *const strains[] = {"cauchy", "polar"};
  for (int k = 0; k < 2; k++) {
    choice c = {strains[k], strains[k], 1, 1, true};
    solid s = make_solid(&c, &soft, true);
    body b = plain_body(&s, strains[k], &soft, true);
    double *u = vectors(4, s.n), *v = u + s.n, *r = v + s.n, *plain = r + s.n;
    bend(&s, 0.6, 0.01, u);
    fill_noise(s.n, 3, 1, v);
    assert_ok(corot_residual(s.model, s.state, 0, u, v, r));
    assert_ok(corot_residual(b.model, b.state, 0, u, v, plain));
    double scale = norm_max(s.n, plain);
    for (int i = 0; i < s.n; i++) assert_close(r[i], plain[i], 0, 1e-12 * scale);
    free(u);
    drop_body(&b);
    drop_solid(&s);
  }
}

/* --- Derivatives ----------------------------------------------------------------------------- */

/* r(u + h du, v + h dv) differenced centrally. */
static void difference(const solid *s, const double *u, const double *v, const double *du,
                       const double *dv, double *work, double *dr) {
  double *x = work, *y = x + s->n, *r = y + s->n, h = 1e-5;
  for (int side = 0; side < 2; side++) {
    double step = side ? h : -h;
    for (int i = 0; i < s->n; i++) x[i] = u[i] + step * du[i], y[i] = v[i] + step * dv[i];
    assert_ok(corot_residual(s->model, s->state, 0, x, y, r));
    for (int i = 0; i < s->n; i++) dr[i] = side ? (r[i] - dr[i]) / (2 * h) : r[i];
  }
}

static void assert_near(int n, const double *a, const double *expected, double rtol) {
  double scale = norm_max(n, expected);
  for (int i = 0; i < n; i++) assert_close(a[i], expected[i], 0, rtol * scale);
}

static void test_product_with_the_derivative(void **state) {
  (void)state;
  const choice choices[] = {
      {"green", "polar", 2, 0, true},  {"green", "polar", 2, 1, true},
      {"polar", "polar", 1, 1, true},  {"hybrid", "polar", 1, 0, false},
      {"green", "warp", 2, 0, false},  {"warp", "warp", 1, 0, false},
      {"green", "cauchy", 1, 0, true},
  };
  for (size_t k = 0; k < sizeof choices / sizeof *choices; k++)
    for (int held = 0; held < 2; held++) {
      solid s = make_solid(&choices[k], &soft, true);
      double *u = vectors(9, s.n), *v = u + s.n, *du = v + s.n, *dv = du + s.n;
      double *jv = dv + s.n, *expected = jv + s.n, *work = expected + s.n;
      bend(&s, 0.6, 0.01, u);
      fill_noise(s.n, 3, 100, v); /* fast, so that the viscous part shows */
      fill_noise(s.n, 4, 1, du);
      fill_noise(s.n, 6, 100, dv);
      corot_tangent tangent = held ? COROT_TANGENT_HELD : COROT_TANGENT_EXACT;
      if (held) {
        corot_state_use(s.state, COROT_FRAMES_HELD);
        assert_ok(corot_frames_update(s.model, s.state, 0, u, NULL));
      }
      difference(&s, u, v, du, dv, work, expected);
      assert_ok(corot_jvp(s.model, s.state, 0, u, v, tangent, du, dv, jv));
      assert_near(s.n, jv, expected, 1e-7);
      free(u);
      drop_solid(&s);
    }
}

/* K at v = 0 and D, with the frames held. */
static void test_matrices(void **state) {
  (void)state;
  const choice choices[] = {{"green", "polar", 1, 0, true},
                            {"green", "polar", 2, 1, true},
                            {"polar", "warp", 1, 0, false},
                            {"green", "cauchy", 2, 0, true}};
  for (int k = 0; k < 4; k++) {
    solid s = make_solid(&choices[k], &soft, true);
    double *u = vectors(9, s.n), *zero = u + s.n, *du = zero + s.n, *y = du + s.n;
    double *expected = y + s.n, *work = expected + s.n;
    int nblock = corot_model_nblock(s.model);
    double(*K)[9] = calloc(2 * nblock, sizeof *K), (*D)[9] = K + nblock;
    bend(&s, 0.6, 0.01, u);
    fill_noise(s.n, 4, 1, du);
    corot_state_use(s.state, COROT_FRAMES_HELD);
    assert_ok(corot_frames_update(s.model, s.state, 0, u, NULL));
    assert_ok(corot_jacobian(s.model, s.state, 0, u, zero, COROT_TANGENT_HELD, K, D));

    difference(&s, u, zero, du, zero, work, expected);
    corot_block_multiply(s.model, (const double(*)[9])K, du, y);
    for (int i = 0; i < s.n; i++) y[i] = -y[i];
    assert_near(s.n, y, expected, 1e-7);
    difference(&s, u, zero, zero, du, work, expected);
    corot_block_multiply(s.model, (const double(*)[9])D, du, y);
    for (int i = 0; i < s.n; i++) y[i] = -y[i];
    assert_near(s.n, y, expected, 1e-7);
    free(K), free(u);
    drop_solid(&s);
  }
}

/* Under exact frames, what is left out is of the size of the strain times the difference. */
static void test_exact_tangent_at_rest(void **state) {
  (void)state;
  choice c = {"green", "polar", 2, 0, true};
  solid s = make_solid(&c, &undamped, true);
  double *u = vectors(5, s.n), *zero = u + s.n, *du = zero + s.n, *y = du + s.n, *jv = y + s.n;
  double(*K)[9] = calloc(corot_model_nblock(s.model), sizeof *K);
  fill_noise(s.n, 4, 1, du);
  assert_ok(corot_jacobian(s.model, s.state, 0, u, zero, COROT_TANGENT_EXACT, K, NULL));
  assert_ok(corot_jvp(s.model, s.state, 0, u, zero, COROT_TANGENT_EXACT, du, zero, jv));
  corot_block_multiply(s.model, (const double(*)[9])K, du, y);
  for (int i = 0; i < s.n; i++) y[i] = -y[i];
  assert_near(s.n, y, jv, 1e-12);
  free(K), free(u);
  drop_solid(&s);
}

/* --- Frames ---------------------------------------------------------------------------------- */

static void test_frames_are_handed_down(void **state) {
  (void)state;
  for (int level = 0; level < 3; level++) {
    choice c = {"green", "polar", 2, level, true};
    solid s = make_solid(&c, &undamped, true);
    int ntet = s.mesh->ntet, shift = 3 * (2 - level);
    double *u = vectors(1, s.n), (*R)[9] = calloc(ntet, sizeof *R);
    corot_element_fields fields = {.frame = R};
    bend(&s, 0.6, 0.01, u);
    assert_ok(corot_elements(s.model, s.state, 0, u, &fields));
    for (int e = 0; e < ntet; e++) assert_true(distance(R[e], R[e >> shift << shift]) == 0);
    assert_true(distance(R[0], R[1 << shift]) > 1e-3);
    assert_true(distance(R[0], R[ntet / 2]) > 1e-3);
    free(R), free(u);
    drop_solid(&s);
  }
}

static void test_update_of_held_frames(void **state) {
  (void)state;
  choice c = {"green", "polar", 2, 1, true};
  solid s = make_solid(&c, &undamped, true);
  double *u = vectors(5, s.n), *zero = u + s.n, *r = zero + s.n, *exact = r + s.n;
  bend(&s, 0.6, 0.01, u);
  corot_state_use(s.state, COROT_FRAMES_HELD);
  double before = elastic_energy(s.model, s.state, u, zero);
  corot_frames_change drift, change;
  assert_ok(corot_frames_drift(s.model, s.state, 0, u, &drift));
  assert_close(elastic_energy(s.model, s.state, u, zero), before, 0, 0);
  assert_ok(corot_frames_update(s.model, s.state, 0, u, &change));
  double after = elastic_energy(s.model, s.state, u, zero);
  assert_close(change.energy, after - before, 1e-12, 0);
  assert_close(drift.energy, change.energy, 0, 0);
  assert_close(drift.angle_max, change.angle_max, 0, 0);
  assert_close(change.angle_max, 0.95, 0, 0.1); /* 0.66 at the top, and half the shear there */
  assert_int_equal(change.angle_tet % 8, 0);
  assert_ok(corot_frames_drift(s.model, s.state, 0, u, &drift));
  assert_below(drift.angle_max, 1e-15);

  /* the energies agree; the forces where nothing turns */
  corot_state_use(s.state, COROT_FRAMES_EXACT);
  assert_close(elastic_energy(s.model, s.state, u, zero), after, 1e-14, 0);
  choice paper = c;
  paper.conservative = false;
  solid p = make_solid(&paper, &undamped, true);
  assert_ok(corot_residual(p.model, p.state, 0, u, zero, exact));
  corot_state_use(s.state, COROT_FRAMES_HELD);
  assert_ok(corot_residual(s.model, s.state, 0, u, zero, r));
  assert_near(s.n, r, exact, 1e-14);
  free(u);
  drop_solid(&p);
  drop_solid(&s);
}

/* A body that turns as a whole, seen 0.1 s later. */
static void test_extrapolated_frames(void **state) {
  (void)state;
  choice c = {"green", "polar", 2, 1, true};
  solid s = make_solid(&c, &undamped, false);
  double *u = vectors(4, s.n), *v = u + s.n, *zero = v + s.n, *r = zero + s.n;
  double axis[3] = {0, 0, 1}, Q[9], spin;
  rotation(axis, 0.2, Q);
  for (int n = 0; n < s.mesh->nnode; n++) {
    v[3 * n] = -2 * s.mesh->x[n][1];
    v[3 * n + 1] = 2 * s.mesh->x[n][0];
  }
  assert_ok(corot_frames_update(s.model, s.state, 0, u, NULL));
  assert_ok(corot_frames_spin(s.model, s.state, 0, u, v, &spin));
  assert_close(spin, 2, 1e-12, 0);
  turn(&s, Q, zero, u);
  corot_state_use(s.state, COROT_FRAMES_EXTRAPOLATED);
  assert_int_equal(corot_state_frames(s.state), COROT_FRAMES_EXTRAPOLATED);
  assert_ok(corot_residual(s.model, s.state, 0.1, u, zero, r));
  assert_below(norm_max(s.n, r), 1e-10);
  corot_state_use(s.state, COROT_FRAMES_HELD);
  assert_ok(corot_residual(s.model, s.state, 0.1, u, zero, r));
  assert_above(norm_max(s.n, r), 1);
  free(u);
  drop_solid(&s);
}

/* --- Forces on supports, statics, inversion -------------------------------------------------- */

static void test_force_on_all_nodes(void **state) {
  (void)state;
  choice c = {"green", "polar", 2, 1, true};
  solid held = make_solid(&c, &undamped, true), free_one = make_solid(&c, &undamped, false);
  int n = free_one.n, nnode = held.mesh->nnode;
  double *u = vectors(4, n), *all = u + n, *zero = all + n, *r = zero + n;
  double(*f)[3] = calloc(nnode, sizeof *f);
  bend(&held, 0.6, 0.01, u);
  for (int k = 0; k < nnode; k++)
    for (int i = 0; i < 3; i++) {
      int d = corot_model_dof(held.model)[k][i];
      all[3 * k + i] = d >= 0 ? u[d] : 0;
    }
  assert_ok(corot_elastic_force(held.model, held.state, 0, u, f));
  assert_ok(corot_residual(free_one.model, free_one.state, 0, all, zero, r));
  for (int i = 0; i < n; i++) r[i] = -r[i];
  assert_near(n, f[0], r, 1e-13);
  free(f), free(u);
  drop_solid(&free_one);
  drop_solid(&held);
}

static void test_standing_still_has_no_viscous_force(void **state) {
  (void)state;
  choice c = {"green", "polar", 1, 0, true};
  solid s = make_solid(&c, &soft, true);
  double *u = vectors(4, s.n), *v = u + s.n, *r = v + s.n, *still = r + s.n;
  bend(&s, 0.6, 0.01, u);
  assert_ok(corot_residual(s.model, s.state, 0, u, v, r));
  fill_noise(s.n, 3, 100, v);
  corot_state_stand_still(s.state, 0, 1);
  assert_ok(corot_residual(s.model, s.state, 0, u, v, still));
  assert_near(s.n, still, r, 1e-14);
  free(u);
  drop_solid(&s);
}

static void test_inverted_tets_are_named(void **state) {
  (void)state;
  choice c = {"green", "polar", 2, 0, true};
  solid s = make_solid(&c, &soft, false);
  double *u = vectors(3, s.n), *zero = u + s.n, *r = zero + s.n;
  u[0] = u[1] = u[2] = 3; /* a corner of the body beyond the opposite one */
  assert_fails(corot_residual(s.model, s.state, 0, u, zero, r), COROT_RETRY, "of level 0");
  assert_int_equal(corot_state_inverted(s.state) % 64, 0);
  u[0] = u[1] = u[2] = 0;
  int last = s.mesh->nnode - 1;
  u[3 * last] = 3;
  assert_fails(corot_residual(s.model, s.state, 0, u, zero, r), COROT_RETRY, "is inverted");
  const int *tet = s.mesh->tet[corot_state_inverted(s.state)];
  assert_true(tet[0] == last || tet[1] == last || tet[2] == last || tet[3] == last);
  free(u);
  drop_solid(&s);
}

/* --- Refusals -------------------------------------------------------------------------------- */

static void refuse(const choice *c, const corot_mesh *mesh, const corot_refinement *refinement,
                   const char *words) {
  corot_hierarchy_def hierarchy;
  corot_model_def def = definition(c, &soft, true, &hierarchy);
  corot_model *model;
  def.mesh = mesh, hierarchy.refinement = refinement;
  assert_fails(corot_model_create(&def, &model), COROT_EINVAL, words);
}

static void test_refusals(void **state) {
  (void)state;
  choice good = {"green", "polar", 1, 0, true}, bad = good;
  solid s = make_solid(&good, &soft, true);
  refuse(&good, s.mesh, NULL, "no refinement");
  refuse(&good, s.coarse, s.refinement, "the mesh has");
  bad.frame_level = 2;
  refuse(&bad, s.mesh, s.refinement, "frame level 2, where the levels are 0 to 1");
  bad = good, bad.coarse = "blue";
  refuse(&bad, s.mesh, s.refinement, "no strain measure 'blue'");
  bad = good, bad.fine = "hybrid";
  refuse(&bad, s.mesh, s.refinement, "strain hybrid is not linear");
  bad = good, bad.fine = "warp";
  refuse(&bad, s.mesh, s.refinement, "set conservative to false");
  bad.conservative = false, bad.frame_level = 1;
  refuse(&bad, s.mesh, s.refinement, "or frame level 0");

  int moved = s.mesh->nnode - 1;
  s.mesh->x[moved][1] += 1e-4;
  refuse(&good, s.mesh, s.refinement, "off the middle of its parents");
  drop_solid(&s);
}

static void test_materials_are_those_of_level_0(void **state) {
  (void)state;
  choice c = {"green", "polar", 1, 0, true};
  solid s = make_solid(&c, &soft, true);
  corot_hierarchy_def hierarchy;
  corot_material two[2] = {soft, soft};
  corot_model_def def = definition(&c, two, true, &hierarchy);
  corot_model *model;
  def.mesh = s.mesh, hierarchy.refinement = s.refinement;
  def.nmaterial = 2, two[1].group = "corner";
  assert_ok(corot_mesh_group_nodes(s.mesh, "corner", 4, s.mesh->tet[9]));
  assert_fails(corot_model_create(&def, &model), COROT_EINVAL,
               "tets 8 and 9 descend from tet 1 of level 0");
  def.viscosity = COROT_OBJECTIVE;
  def.nmaterial = 1;
  assert_fails(corot_model_create(&def, &model), COROT_EINVAL, "the viscous law");
  drop_solid(&s);
}

static corot_status make_and_drop(void *context) {
  const corot_model_def *def = context;
  corot_model *model;
  corot_state *state = NULL;
  COROT_TRY(corot_model_create(def, &model));
  corot_status status = corot_state_create(model, &state);
  corot_state_destroy(state);
  corot_model_destroy(model);
  return status;
}

static void test_failed_allocations(void **state) {
  (void)state;
  choice c = {"green", "polar", 2, 1, true};
  solid s = make_solid(&c, &soft, true);
  corot_hierarchy_def hierarchy;
  corot_model_def def = definition(&c, &soft, true, &hierarchy);
  def.mesh = s.mesh, hierarchy.refinement = s.refinement;
  assert_true(assert_survives_failed_allocations(make_and_drop, &def) > 60);
  drop_solid(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_force_is_the_gradient_of_the_energy),
      cmocka_unit_test(test_force_without_the_turning_of_frames),
      cmocka_unit_test(test_forces_on_a_free_body_balance),
      cmocka_unit_test(test_a_turned_body_feels_turned_forces),
      cmocka_unit_test(test_no_level_is_the_plain_model),
      cmocka_unit_test(test_coarse_motion_feels_coarse_forces),
      cmocka_unit_test(test_affine_motion_has_no_force_inside),
      cmocka_unit_test(test_one_measure_in_its_own_frames_is_the_plain_model),
      cmocka_unit_test(test_product_with_the_derivative),
      cmocka_unit_test(test_matrices),
      cmocka_unit_test(test_exact_tangent_at_rest),
      cmocka_unit_test(test_frames_are_handed_down),
      cmocka_unit_test(test_update_of_held_frames),
      cmocka_unit_test(test_extrapolated_frames),
      cmocka_unit_test(test_force_on_all_nodes),
      cmocka_unit_test(test_standing_still_has_no_viscous_force),
      cmocka_unit_test(test_inverted_tets_are_named),
      cmocka_unit_test(test_refusals),
      cmocka_unit_test(test_materials_are_those_of_level_0),
      cmocka_unit_test(test_failed_allocations),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
