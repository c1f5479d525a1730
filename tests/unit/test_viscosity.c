/* The viscous laws against closed forms, and the matrix D of each. */
#include "solid.h"

static body free_box(const char *strain, corot_viscosity viscosity) {
  corot_model_def def = corot_model_defaults();
  def.strain = strain, def.nmaterial = 1, def.material = &soft;
  def.viscosity = viscosity;
  return make_body(straight_box(1, 1, 2), def);
}

/* y = A x at all nodes of a free body, and V x. */
static void affine(const body *b, const double A[9], const double V[9], double *u, double *v) {
  for (int n = 0; n < b->mesh->nnode; n++) {
    apply(A, b->mesh->x[n], u + 3 * n);
    apply(V, b->mesh->x[n], v + 3 * n);
    for (int c = 0; c < 3; c++) u[3 * n + c] -= b->mesh->x[n][c];
  }
}

/* Power of the viscous forces, in two ways. */
static double power(const body *b, const double F[9], const double V[9]) {
  double *u = malloc(4 * b->n * sizeof *u), *v = u + b->n, *r = v + b->n, *elastic = r + b->n;
  corot_energies e;
  affine(b, F, V, u, v);
  assert_ok(corot_energy(b->model, b->state, 0, u, v, &e));
  assert_ok(corot_residual(b->model, b->state, 0, u, v, r));
  for (int i = 0; i < b->n; i++) v[i] = 0;
  assert_ok(corot_residual(b->model, b->state, 0, u, v, elastic));
  affine(b, F, V, u, v);
  for (int i = 0; i < b->n; i++) r[i] -= elastic[i];
  double size = norm_max(b->n, r) * norm_max(b->n, v) + norm_max(b->n, elastic) * 1e-3;
  assert_close(e.power_dissipated, -inner(b->n, r, v), 0,
               (order_of_test() == 1 ? 1e-12 : 4e-12) * size);
  free(u);
  return e.power_dissipated;
}

static const double stretch[9] = {1.3, 0, 0, 0, 0.8, 0, 0, 0, 1.1};
static const double about_z[9] = {0, -1, 0, 1, 0, 0, 0, 0, 0};

/* A body of stretches s1, s2 across the axis it spins about with w: the corotated law dissipates
   V d_mu w^2 (s1 - s2)^2, for sym(R' dF/dt) = w (s2 - s1)/2 off the diagonal. */
static void the_corotated_law_feels_a_spin(void **state) {
  (void)state;
  double w = 7, Q[9], F[9], V[9], spin[9], axis[3] = {0, 0, 1};
  rotation(axis, 0.6, Q);
  multiply(Q, stretch, F);
  for (int k = 0; k < 9; k++) spin[k] = w * about_z[k];
  multiply(spin, F, V);
  for (int k = 0; k < NSTRAIN; k++) {
    if (!is_polar(k)) continue;
    body b = free_box(measures[k], COROT_COROTATED);
    double volume = corot_mesh_measure(b.mesh).volume, difference = stretch[0] - stretch[4];
    assert_close(power(&b, F, V), volume * soft.damping_mu * w * w * difference * difference, 1e-13,
                 0);
    drop_body(&b);
    b = free_box(measures[k], COROT_OBJECTIVE);
    /* the stress is the rounding of rates w S, and works at those */
    assert_below(fabs(power(&b, F, V)), 1e-15 * volume * soft.damping_lambda * w * w);
    drop_body(&b);
  }
}

/* F = R S with S and dS/dt of the same axes: the objective power is that of dS/dt, whatever the
   spin; hybrid's pressure term is that of F : dF/dt = S : dS/dt. */
static void the_objective_law_is_that_of_the_stretch(void **state) {
  (void)state;
  const double rate[9] = {0.5, 0, 0, 0, -0.2, 0, 0, 0, 0.9};
  double Q[9], F[9], square = 0, trace = 0, product = 0, axis[3] = {1, 2, 2};
  rotation(axis, 2, Q);
  multiply(Q, stretch, F);
  for (int k = 0; k < 9; k += 4) {
    square += rate[k] * rate[k], trace += rate[k], product += stretch[k] * rate[k];
  }
  for (int m = 0; m < NSTRAIN; m++)
    for (double w = 0; is_polar(m) && w < 20; w += 6) {
      body b = free_box(measures[m], COROT_OBJECTIVE);
      double volume = corot_mesh_measure(b.mesh).volume, V[9], spin[9], turning[9];
      double pressure = corot_strain_traits(m)->linear_in_frames ? trace : product;
      for (int k = 0; k < 9; k++) spin[k] = w * about_z[k];
      multiply(Q, rate, V);
      multiply(spin, F, turning);
      for (int k = 0; k < 9; k++) V[k] += turning[k];
      double expected =
          volume * (2 * soft.damping_mu * square + soft.damping_lambda * pressure * pressure);
      assert_close(power(&b, F, V), expected, 1e-13, 0);
      drop_body(&b);
    }
}

/* Whether A + shift I has a Cholesky factor. A [n][n] is destroyed. */
static bool is_positive(int n, double *A, double shift) {
  for (int i = 0; i < n; i++) A[n * i + i] += shift;
  for (int k = 0; k < n; k++) {
    if (!(A[n * k + k] > 0)) return false;
    for (int i = k + 1; i < n; i++) {
      double factor = A[n * i + k] / A[n * k + k];
      for (int j = k; j < n; j++) A[n * i + j] -= factor * A[n * k + j];
    }
  }
  return true;
}

/* D column by column from the derivative of the force, at a crumpled, turned state: symmetric and
   positive semi-definite to rounding, and no more than that (translations are in its null space).
   Green's law and the objective one have rotations there too. */
static void the_matrix_is_symmetric_and_semi_definite(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++)
    for (corot_viscosity law = COROT_COROTATED; law <= COROT_OBJECTIVE; law++) {
      if (law == COROT_OBJECTIVE && !is_polar(m)) continue;
      body b = free_box(measures[m], law);
      int n = b.n;
      double *u = calloc(5 * n, sizeof *u), *v = u + n, *e = v + n, *zero = e + n, *Dw = zero + n;
      double *D = malloc(n * n * sizeof *D), Q[9], spin[9] = {0, -3, 2, 3, 0, -1, -2, 1, 0}, V[9];
      uint64_t seed = 23;
      random_rotation(&seed, Q);
      multiply(spin, Q, V);
      affine(&b, Q, V, u, v);
      for (int i = 0; i < n; i++) u[i] += 0.1 * noise(&seed);
      for (int j = 0; j < n; j++) {
        e[j] = -1;
        assert_ok(corot_jvp(b.model, b.state, 0, u, v, COROT_TANGENT_EXACT, zero, e, D + j * n));
        e[j] = 0;
      }
      double size = norm_max(n * n, D);
      for (int i = 0; i < n; i++)
        for (int j = 0; j < i; j++) assert_close(D[n * i + j], D[n * j + i], 0, 1e-14 * size);
      for (int k = 0; k < b.mesh->nnode; k++) { /* x becomes w x */
        double x[3];
        for (int c = 0; c < 3; c++) x[c] = b.mesh->x[k][c] + u[3 * k + c];
        apply(spin, x, v + 3 * k);
      }
      for (int i = 0; i < n; i++) Dw[i] = inner(n, D + n * i, v);
      bool blind = law == COROT_OBJECTIVE || corot_strain_traits(m)->exact;
      if (blind) assert_below(norm_max(n, Dw), 1e-13 * size * norm_max(n, v));
      if (!blind) assert_above(norm_max(n, Dw), 1e-3 * size * norm_max(n, v));

      double *copy = malloc(n * n * sizeof *copy);
      memcpy(copy, D, n * n * sizeof *copy);
      assert_true(is_positive(n, copy, 1e-13 * size));
      memcpy(copy, D, n * n * sizeof *copy);
      assert_false(is_positive(n, copy, -1e-13 * size));
      free(copy), free(D), free(u), drop_body(&b);
    }
}

/* By default the law is the objective one where the measure has the frame for it. */
static void the_default_law_is_by_the_frame(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++) {
    bool polar = is_polar(m);
    body b = free_box(measures[m], corot_model_defaults().viscosity);
    assert_int_equal(corot_model_viscosity(b.model), polar ? COROT_OBJECTIVE : COROT_COROTATED);
    drop_body(&b);
    b = free_box(measures[m], COROT_COROTATED);
    assert_int_equal(corot_model_viscosity(b.model), COROT_COROTATED);
    drop_body(&b);
  }
  corot_mesh *mesh = crooked_box(1, 1, 2);
  corot_model_def def = corot_model_defaults();
  corot_model *model = NULL;
  def.mesh = mesh, def.nmaterial = 1, def.material = &soft, def.viscosity = (corot_viscosity)3;
  assert_fails(corot_model_create(&def, &model), COROT_EINVAL, "there is no viscous law 3");
  corot_mesh_destroy(mesh);
}

/* A model says that K and D depend on the frames alone: then, and only then, held frames give the
   same ones wherever the body is. */
static void matrices_by_frames(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++)
    for (corot_viscosity law = COROT_COROTATED; law <= COROT_OBJECTIVE; law++) {
      if (law == COROT_OBJECTIVE && !is_polar(m)) continue;
      body b = free_box(measures[m], law);
      int nblock = corot_model_nblock(b.model);
      double(*K)[9] = calloc(4 * nblock, sizeof *K), (*D)[9] = K + nblock, (*there)[9] = D + nblock;
      double *u = calloc(2 * b.n, sizeof *u), *zero = u + b.n;
      uint64_t seed = 5;
      corot_state_use(b.state, COROT_FRAMES_HELD);
      assert_ok(corot_jacobian(b.model, b.state, 0, u, zero, COROT_TANGENT_HELD, K, D));
      for (int i = 0; i < b.n; i++) u[i] = 0.05 * noise(&seed);
      assert_ok(
          corot_jacobian(b.model, b.state, 0, u, zero, COROT_TANGENT_HELD, there, there + nblock));
      bool same = memcmp(K, there, 2 * nblock * sizeof *K) == 0;
      assert_int_equal(corot_model_matrices_by_frames(b.model), same);
      assert_int_equal(same, corot_strain_traits(m)->linear_in_frames && law == COROT_COROTATED);
      free(u), free(K), drop_body(&b);
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_corotated_law_feels_a_spin),
      cmocka_unit_test(the_objective_law_is_that_of_the_stretch),
      cmocka_unit_test(the_default_law_is_by_the_frame),
      cmocka_unit_test(matrices_by_frames),
      cmocka_unit_test(the_matrix_is_symmetric_and_semi_definite),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
