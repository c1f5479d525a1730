/* Orders of convergence: in space by a manufactured equilibrium, in time by the tolerance. */
#include "core/lanes/polar.h"
#include "solution.h"

/* --- Space ---------------------------------------------------------------------------------- */

/* A displacement on the unit cube that vanishes on its boundary, and its gradient:
   u_i = size_i (1 + slope_i . X) sin(pi x) sin(pi y) sin(pi z). Strains reach a third. */
static const double size[3] = {0.05, -0.04, 0.03};
static const corot_material moderate = {.lambda = 1.5e4, .mu = 1e4, .density = 1000};
static const double slope[3][3] = {{0.3, 0, 0.5}, {0, -0.4, 0.2}, {0.5, 0.1, 0}};

static void field(const double X[3], double u[3], double F[9]) {
  double s[3], c[3];
  for (int k = 0; k < 3; k++) s[k] = sin(pi * X[k]), c[k] = pi * cos(pi * X[k]);
  double bubble = s[0] * s[1] * s[2];
  double grad[3] = {c[0] * s[1] * s[2], s[0] * c[1] * s[2], s[0] * s[1] * c[2]};
  for (int i = 0; i < 3; i++) {
    double factor = 1 + slope[i][0] * X[0] + slope[i][1] * X[1] + slope[i][2] * X[2];
    u[i] = size[i] * factor * bubble;
    for (int j = 0; j < 3; j++)
      F[3 * i + j] = (i == j) + size[i] * (factor * grad[j] + slope[i][j] * bubble);
  }
}

/* First Piola-Kirchhoff stress from the formulas of the measures. */
static void stress_at(const char *strain, const double X[3], double P[9]) {
  double u[3], F[9], R[9], S[9], C[9], by_frame[9], by_gradient[9];
  field(X, u, F);
  assert_ok(corot_polar(F, R));
  multiply_transposed(R, F, S);
  multiply_transposed(F, F, C);
  for (int k = 0; k < 9; k++) S[k] -= identity[k], C[k] = (C[k] - identity[k]) / 2;
  multiply(R, S, by_frame);
  multiply(F, C, by_gradient);
  double lambda = moderate.lambda, mu = moderate.mu;
  double e = lambda * (S[0] + S[4] + S[8]), g = lambda * (C[0] + C[4] + C[8]);
  bool polar_pressure = strcmp(strain, "polar") == 0, green = strcmp(strain, "green") == 0;
  for (int k = 0; k < 9; k++)
    P[k] = (polar_pressure ? e * R[k] : g * F[k]) + 2 * mu * (green ? by_gradient[k] : by_frame[k]);
}

/* The body force that holds the field: -Div P, by differences of fourth order. */
static void body_force(const char *strain, const double X[3], double force[3]) {
  static const double at[4] = {-2, -1, 1, 2}, weight[4] = {1. / 12, -2. / 3, 2. / 3, -1. / 12};
  double h = 2e-3;
  force[0] = force[1] = force[2] = 0;
  for (int j = 0; j < 3; j++)
    for (int p = 0; p < 4; p++) {
      double moved[3] = {X[0], X[1], X[2]}, P[9];
      moved[j] += at[p] * h;
      stress_at(strain, moved, P);
      for (int i = 0; i < 3; i++) force[i] -= weight[p] * P[3 * i + j] / h;
    }
}

/* The four points of a tet that integrate quadratic polynomials, and their coordinates. */
static void quadrature_point(const corot_mesh *mesh, int tet, int q, double N[4], double X[3]) {
  for (int a = 0; a < 4; a++) N[a] = a == q ? 0.58541019662496852 : 0.13819660112501052;
  for (int i = 0; i < 3; i++) {
    X[i] = 0;
    for (int a = 0; a < 4; a++) X[i] += N[a] * mesh->x[mesh->tet[tet][a]][i];
  }
}

static void consistent_load(const body *b, const char *strain, double volume, double *load) {
  const int(*dof)[3] = corot_model_dof(b->model);
  for (int i = 0; i < b->n; i++) load[i] = 0;
  for (int e = 0; e < b->mesh->ntet; e++)
    for (int q = 0; q < 4; q++) {
      double N[4], X[3], force[3];
      quadrature_point(b->mesh, e, q, N, X);
      body_force(strain, X, force);
      for (int a = 0; a < 4; a++)
        for (int c = 0; c < 3; c++) {
          int i = dof[b->mesh->tet[e][a]][c];
          if (i >= 0) load[i] += volume / 4 * N[a] * force[c];
        }
    }
}

/* r(u) + load = 0 by Newton's method from rest, which with the exact tangent doubles the digits in
   every iteration. */
static void solve(const body *b, const double *load, double *u) {
  double *zero = calloc(2 * b->n, sizeof *zero), *r = zero + b->n, last = INFINITY;
  corot_pencil *pencil;
  assert_ok(corot_pencil_create(b->model, b->state, NULL, &pencil));
  corot_pencil_use(pencil, COROT_TANGENT_EXACT);
  for (int k = 0; last > 1e-12; k++) {
    assert_true(k < 8);
    assert_ok(corot_residual(b->model, b->state, 0, u, zero, r));
    for (int i = 0; i < b->n; i++) r[i] += load[i];
    assert_ok(corot_pencil_assemble(pencil, 0, u, zero));
    corot_pencil_combine(pencil, 0, 0, 1);
    assert_ok(corot_pencil_factor(pencil));
    assert_ok(corot_pencil_solve(pencil, r, r));
    for (int i = 0; i < b->n; i++) u[i] += r[i];
    double step = norm_max(b->n, r);
    if (last < 1e-2) assert_below(step, 50 * last * last + 1e-14);
    last = step;
  }
  corot_pencil_destroy(pencil);
  free(zero);
}

/* Errors of u in L2, and of its gradient. */
static void errors(const body *b, const double *u, double volume, double *l2, double *h1) {
  int nnode = b->mesh->nnode;
  double(*nodal)[3] = malloc(nnode * sizeof *nodal), square = 0, gradient = 0;
  corot_nodal(b->model, 0, u, u, nodal, NULL);
  for (int e = 0; e < b->mesh->ntet; e++) {
    const int *node = b->mesh->tet[e];
    double D[9], d[9], cofactor[9], F[9], exact[9], value[3], N[4], X[3];
    for (int i = 0; i < 3; i++)
      for (int a = 0; a < 3; a++) {
        D[3 * i + a] = b->mesh->x[node[a + 1]][i] - b->mesh->x[node[0]][i];
        d[3 * i + a] = D[3 * i + a] + nodal[node[a + 1]][i] - nodal[node[0]][i];
      }
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) {
        int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
        cofactor[3 * j + i] = (D[3 * i1 + j1] * D[3 * i2 + j2] - D[3 * i1 + j2] * D[3 * i2 + j1]) /
                              determinant(D); /* D^-1 */
      }
    multiply(d, cofactor, F);
    for (int q = 0; q < 4; q++) {
      quadrature_point(b->mesh, e, q, N, X);
      field(X, value, exact);
      for (int i = 0; i < 3; i++) {
        for (int a = 0; a < 4; a++) value[i] -= N[a] * nodal[node[a]][i];
        square += volume / 4 * value[i] * value[i];
      }
      for (int k = 0; k < 9; k++) gradient += volume / 4 * pow(F[k] - exact[k], 2);
    }
  }
  free(nodal);
  *l2 = sqrt(square);
  *h1 = sqrt(gradient);
}

static void manufactured(const char *strain, int cells, double *l2, double *h1) {
  static const char *const sides[] = {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"};
  corot_box box = {.size = {1, 1, 1}, .cells = {cells, cells, cells}};
  corot_fix fix[6];
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  for (int k = 0; k < 6; k++) fix[k] = (corot_fix){sides[k], {true, true, true}};
  corot_model_def def = corot_model_defaults();
  def.strain = strain, def.nmaterial = 1, def.material = &moderate, def.nfix = 6, def.fix = fix;
  body b = make_body(mesh, def);
  double volume = 1.0 / mesh->ntet, *u = calloc(2 * b.n, sizeof *u), *load = u + b.n;
  consistent_load(&b, strain, volume, load);
  solve(&b, load, u);
  errors(&b, u, volume, l2, h1);
  free(u), drop_body(&b);
}

/* Linear tets: order two in the displacement and one in its gradient, approached from below. */
static void space_converges_with_orders_two_and_one(void **state) {
  (void)state;
  static const int cells[] = {4, 8, 12};
  for (int s = 0; s < NSTRAIN; s++) {
    if (!conserves(s)) continue;
    double l2[3], h1[3];
    for (int k = 0; k < 3; k++) manufactured(measures[s], cells[k], &l2[k], &h1[k]);
    assert_close(order_of(l2[1], l2[2], 1.5), 2, 0, 0.15);
    assert_close(order_of(h1[1], h1[2], 1.5), 1, 0, 0.05);
  }
}

/* --- Time ----------------------------------------------------------------------------------- */

/* A damped cantilever set in motion by a sideways velocity. */
static body cantilever(const char *strain) {
  corot_box box = {.size = {0.1, 0.1, 0.6}, .cells = {1, 1, 6}};
  corot_fix fix = {"zmin", {true, true, true}};
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  corot_model_def def = corot_model_defaults();
  def.strain = strain, def.nmaterial = 1, def.material = &soft, def.nfix = 1, def.fix = &fix;
  return make_body(mesh, def);
}

enum { NTIME = 40 };

/* u at NTIME times up to one second, in which the tip swings by 0.1 m and back: [NTIME][n]. */
static double *trajectory(const body *b, double rtol, int max_order) {
  double *path = malloc((size_t)NTIME * b->n * sizeof *path);
  double *u = calloc(2 * b->n, sizeof *u), *v = u + b->n;
  for (int n = 0; n < b->mesh->nnode; n++) {
    int i = corot_model_dof(b->model)[n][0];
    double z = b->mesh->x[n][2] / 0.6;
    if (i >= 0) v[i] = 0.5 * z * z;
  }
  corot_integrator_def def = corot_integrator_defaults();
  def.rtol = rtol, def.max_order = max_order;
  corot_integrator *integrator = start(b, &def, u, v);
  for (int k = 0; k < NTIME; k++) {
    double t = (k + 1.0) / NTIME;
    advance(integrator, t);
    assert_ok(corot_integrator_at(integrator, t, path + (size_t)k * b->n, NULL));
  }
  corot_integrator_destroy(integrator), free(u);
  return path;
}

/* Slope of log(error) over log(rtol) from 1e-3 to 1e-6, by least squares. */
static double error_exponent(const body *b, const double *reference, int max_order) {
  double sum_xy = 0, sum_xx = 0;
  for (int k = 3; k <= 6; k++) {
    double rtol = pow(10, -k), *path = trajectory(b, rtol, max_order), error = 0;
    for (int i = 0; i < NTIME * b->n; i++) error = fmax(error, fabs(path[i] - reference[i]));
    assert_below(error, 2 * 0.1 * pow(rtol, 2. / 3)); /* with the swing of 0.1 m */
    double x = 4.5 - k;

    sum_xy += x * log10(error);
    sum_xx += x * x;
    free(path);
  }
  return sum_xy / sum_xx;
}

/* Local errors of order q + 1 are held at the tolerance, so steps go with its power 1 / (q + 1),
   and the error of the whole with the power q / (q + 1): 2/3 for order two, 5/6 for order five,
   where the order in use is lower at times. */
static void error_falls_with_the_tolerance(void **state) {
  (void)state;
  static const char *const strains[] = {"polar", "green"};
  for (int s = 0; s < 2; s++) {
    body b = cantilever(strains[s]);
    double *reference = trajectory(&b, 1e-10, 5);
    assert_close(error_exponent(&b, reference, 2), 2. / 3, 0, 0.15);
    assert_close(error_exponent(&b, reference, 5), 5. / 6, 0, 0.25);
    free(reference), drop_body(&b);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(space_converges_with_orders_two_and_one),
      cmocka_unit_test(error_falls_with_the_tolerance),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
