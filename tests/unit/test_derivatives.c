/* K, D and the Jacobian-vector product against central differences of the residual. */
#include "solid.h"

/* A model with every load and a partly held face, and a state far from rest. */
typedef struct solid {
  corot_mesh *mesh;
  corot_model *model;
  corot_state *state;
  int n;
  double *u, *v, *du, *dv;
} solid;

static solid make_with(const char *strain, double velocity, corot_viscosity viscosity,
                       bool pressure) {
  solid s = {.mesh = crooked_box(2, 2, 2)};
  double time[] = {0, 2}, value[] = {0, 3};
  corot_fix fix[] = {{"zmin", {true, true, true}}, {"xmin", {true, false, false}}};
  corot_load load[] = {
      {COROT_TRACTION, "zmax", {200, 0, 30}, {2, time, value}},
      {COROT_GRAVITY, NULL, {0, 0, -9.81}, {0, NULL, NULL}},
      {COROT_FORCE, "xmax", {3, -2, 1}, {0, NULL, NULL}},
      {COROT_PRESSURE, "zmax", {500}, {2, time, value}},
  };
  corot_material material = soft;
  material.damping_mass = 0.3;
  corot_model_def def = corot_model_defaults();
  def.mesh = s.mesh, def.strain = strain;
  def.nmaterial = 1, def.material = &material;
  def.nfix = 2, def.fix = fix, def.nload = pressure ? 4 : 3, def.load = load;
  def.viscosity = viscosity;
  assert_ok(corot_model_create(&def, &s.model));
  assert_ok(corot_state_create(s.model, &s.state));
  s.n = corot_model_ndof(s.model);
  s.u = malloc(4 * s.n * sizeof *s.u);
  s.v = s.u + s.n, s.du = s.v + s.n, s.dv = s.du + s.n;

  /* a large rotation about y growing along the bar, and noise */
  const int(*dof)[3] = corot_model_dof(s.model);
  uint64_t seed = 11;
  for (int n = 0; n < s.mesh->nnode; n++) {
    double axis[3] = {0.2, 1, 0.1}, Q[9], x[3];
    rotation(axis, 0.5 * (s.mesh->x[n][2] - 0.1), Q);
    apply(Q, s.mesh->x[n], x);
    for (int c = 0; c < 3; c++) {
      double noise_u = 0.02 * noise(&seed), noise_v = noise(&seed), noise_du = noise(&seed),
             noise_dv = noise(&seed);
      int i = dof[n][c];
      if (i < 0) continue;
      s.u[i] = x[c] - s.mesh->x[n][c] + noise_u;
      s.v[i] = velocity * noise_v;
      s.du[i] = noise_du;
      s.dv[i] = noise_dv;
    }
  }
  return s;
}

static solid make(const char *strain, double velocity) {
  return make_with(strain, velocity, COROT_COROTATED, false);
}

static void drop(solid *s) {
  corot_state_destroy(s->state);
  corot_model_destroy(s->model);
  corot_mesh_destroy(s->mesh);
  free(s->u);
}

/* Central difference of r along (du, dv), fourth order: its error is h^4 f^(5) / 30 + eps |f| / h,
   with lengths of one and h = 1e-3 about 1e-12 |K du| + 1e-13 |f|. */
static void difference(solid *s, const double *du, const double *dv, double *out) {
  enum { POINTS = 4 };
  static const double at[POINTS] = {-2, -1, 1, 2},
                      weight[POINTS] = {1.0 / 12, -2.0 / 3, 2.0 / 3, -1.0 / 12};
  double h = 2e-4, *y = malloc(3 * s->n * sizeof *y), *r = y + 2 * s->n;
  for (int i = 0; i < s->n; i++) out[i] = 0;
  for (int k = 0; k < POINTS; k++) {
    for (int i = 0; i < s->n; i++) {
      y[i] = s->u[i] + (du ? at[k] * h * du[i] : 0);
      y[s->n + i] = s->v[i] + (dv ? at[k] * h * dv[i] : 0);
    }
    assert_ok(corot_residual(s->model, s->state, 1.5, y, y + s->n, r));
    for (int i = 0; i < s->n; i++) out[i] += weight[k] * r[i] / h;
  }
  free(y);
}

static double relative(int n, const double *a, const double *b, double sign) {
  double error = 0, size = 0;
  for (int i = 0; i < n; i++) {
    error = fmax(error, fabs(a[i] - sign * b[i]));
    size = fmax(size, fabs(b[i]));
  }
  return size > 0 ? error / size : error;
}

static void hold_frames(solid *s) {
  double *other = malloc(s->n * sizeof *other); /* frames lag behind the state */
  for (int i = 0; i < s->n; i++) other[i] = 0.9 * s->u[i];
  assert_ok(corot_frames_update(s->model, s->state, 0, other, NULL));
  corot_state_use(s->state, COROT_FRAMES_HELD);
  free(other);
}

static void matrices_are_derivatives(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++)
    for (int held = 0; held < 2; held++) {
      if (!held && strcmp(measures[m], "warp") == 0) continue; /* K leaves its variation out */
      solid s = make(measures[m], 0);
      if (held) hold_frames(&s);
      corot_tangent tangent = held ? COROT_TANGENT_HELD : COROT_TANGENT_EXACT;
      int nblock = corot_model_nblock(s.model);
      double(*K)[9] = malloc(2 * nblock * sizeof *K), (*D)[9] = K + nblock;
      double *fd = malloc(2 * s.n * sizeof *fd), *product = fd + s.n;
      assert_ok(corot_jacobian(s.model, s.state, 1.5, s.u, s.v, tangent, K, D));

      difference(&s, s.du, NULL, fd);
      corot_block_multiply(s.model, (const double(*)[9])K, s.du, product);
      assert_below(relative(s.n, product, fd, -1), 1e-7);
      difference(&s, NULL, s.dv, fd);
      corot_block_multiply(s.model, (const double(*)[9])D, s.dv, product);
      assert_below(relative(s.n, product, fd, -1), 1e-7);
      free(K), free(fd), drop(&s);
    }
}

static void jvp_is_the_derivative_with_nothing_left_out(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++)
    for (int held = 0; held < 2; held++) {
      solid s = make(measures[m], 30); /* fast enough that viscous forces weigh in */
      if (held) hold_frames(&s);
      corot_tangent tangent = held ? COROT_TANGENT_HELD : COROT_TANGENT_EXACT;
      double *fd = malloc(2 * s.n * sizeof *fd), *jv = fd + s.n;
      difference(&s, s.du, s.dv, fd);
      assert_ok(corot_jvp(s.model, s.state, 1.5, s.u, s.v, tangent, s.du, s.dv, jv));
      assert_below(relative(s.n, jv, fd, 1), 1e-7);
      free(fd), drop(&s);
    }
}

/* The objective law's derivative has terms of its own, and a pressure turns with the surface. */
static void jvp_knows_the_objective_law_and_pressure(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++)
    if (is_polar(m))
      for (int held = 0; held < 2; held++) {
        solid s = make_with(measures[m], 30, COROT_OBJECTIVE, true);
        if (held) hold_frames(&s);
        corot_tangent tangent = held ? COROT_TANGENT_HELD : COROT_TANGENT_EXACT;
        double *fd = malloc(2 * s.n * sizeof *fd), *jv = fd + s.n;
        difference(&s, s.du, s.dv, fd);
        assert_ok(corot_jvp(s.model, s.state, 1.5, s.u, s.v, tangent, s.du, s.dv, jv));
        assert_below(relative(s.n, jv, fd, 1), 1e-7);

        int nblock = corot_model_nblock(s.model);
        double(*D)[9] = malloc(nblock * sizeof *D);
        assert_ok(corot_jacobian(s.model, s.state, 1.5, s.u, s.v, tangent, NULL, D));
        difference(&s, NULL, s.dv, fd);
        corot_block_multiply(s.model, (const double(*)[9])D, s.dv, jv);
        assert_below(relative(s.n, jv, fd, -1), 1e-7);
        free(fd), free(D), drop(&s);
      }
}

static void jvp_is_the_matrices_times_the_direction(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++)
    for (int tangent = COROT_TANGENT_HELD; tangent <= COROT_TANGENT_EXACT; tangent++) {
      if (tangent == COROT_TANGENT_EXACT && strcmp(measures[m], "warp") == 0) continue;
      solid s = make(measures[m], 0);
      int nblock = corot_model_nblock(s.model);
      double(*K)[9] = malloc(2 * nblock * sizeof *K), (*D)[9] = K + nblock;
      double *jv = malloc(3 * s.n * sizeof *jv), *k = jv + s.n, *d = k + s.n;
      assert_ok(corot_jacobian(s.model, s.state, 0, s.u, s.v, tangent, K, D));
      assert_ok(corot_jvp(s.model, s.state, 0, s.u, s.v, tangent, s.du, s.dv, jv));
      corot_block_multiply(s.model, (const double(*)[9])K, s.du, k);
      corot_block_multiply(s.model, (const double(*)[9])D, s.dv, d);
      for (int i = 0; i < s.n; i++) k[i] += d[i];
      assert_below(relative(s.n, k, jv, -1), 1e-13); /* rounding of sums over some 20 tets */
      free(K), free(jv), drop(&s);
    }
}

/* Both triangles of the compressed columns, against the product with the blocks. */
static void columns_hold_the_same_symmetric_matrix(void **state) {
  (void)state;
  solid s = make("hybrid", 0);
  int nblock = corot_model_nblock(s.model);
  double(*K)[9] = malloc(2 * nblock * sizeof *K), (*D)[9] = K + nblock;
  double *x = s.du, *y = calloc(5 * s.n, sizeof *y), *z = y + s.n, *d = z + s.n, *k = d + s.n,
         *mass = k + s.n;
  assert_ok(corot_jacobian(s.model, s.state, 0, s.u, s.v, COROT_TANGENT_EXACT, K, D));
  corot_block_multiply(s.model, (const double(*)[9])K, x, k);
  corot_block_multiply(s.model, (const double(*)[9])D, x, d);
  corot_mass_multiply(s.model, x, mass);
  for (int i = 0; i < s.n; i++) k[i] = 2 * mass[i] + 3 * d[i] + 5 * k[i];

  for (corot_triangle triangle = COROT_FULL; triangle <= COROT_LOWER; triangle++) {
    corot_csc *csc;
    assert_ok(corot_csc_create(s.model, triangle, &csc));
    double *value = malloc(csc->nnz * sizeof *value);
    corot_csc_combine(s.model, csc, 2, 3, (const double(*)[9])D, 5, (const double(*)[9])K, value);
    for (int i = 0; i < s.n; i++) y[i] = z[i] = 0;
    for (int j = 0; j < s.n; j++)
      for (int p = csc->colptr[j]; p < csc->colptr[j + 1]; p++) {
        int i = csc->row[p];
        if (p > csc->colptr[j]) assert_true(i > csc->row[p - 1]);
        y[i] += value[p] * x[j];
        z[j] += value[p] * x[i]; /* the transposed product */
        if (triangle == COROT_LOWER && i != j) y[j] += value[p] * x[i];
        if (triangle == COROT_LOWER && i != j) z[i] += value[p] * x[j];
      }
    assert_below(relative(s.n, y, k, 1), 1e-13);
    assert_below(relative(s.n, z, k, 1), 1e-13); /* symmetric */
    free(value);
    corot_csc_destroy(csc);
  }
  free(K), free(y), drop(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(matrices_are_derivatives),
      cmocka_unit_test(jvp_is_the_derivative_with_nothing_left_out),
      cmocka_unit_test(jvp_knows_the_objective_law_and_pressure),
      cmocka_unit_test(jvp_is_the_matrices_times_the_direction),
      cmocka_unit_test(columns_hold_the_same_symmetric_matrix),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
