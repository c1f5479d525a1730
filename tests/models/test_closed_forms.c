/* Motions known in closed form, against what the integrator makes of them.

   The error of a run is the sum of its local errors, each held below rtol: where nothing amplifies
   them it stays below steps * rtol, in units of the solution. */
#include "solution.h"

static const double a = 0.1; /* [m] half the edge of the cube a regular tet is inscribed in */

static body regular_tet(void) {
  const double x[4][3] = {{a, a, a}, {a, -a, -a}, {-a, a, -a}, {-a, -a, a}};
  const int tet[1][4] = {{0, 2, 1, 3}};
  corot_mesh *mesh;
  assert_ok(corot_mesh_create(4, x, 1, tet, &mesh));
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = &elastic;
  return make_body(mesh, def);
}

static corot_integrator_def tight(void) {
  corot_integrator_def def = corot_integrator_defaults();
  def.rtol = 1e-9;
  def.max_order = 5; /* no mode here is fast enough to leave its region of stability */
  return def;
}

/* x = s X has the stress (2 mu + 3 lambda)(s - 1) I and, with sum m X X' = rho V a^2 I, obeys
   s'' = -omega^2 (s - 1), omega^2 = (2 mu + 3 lambda) / (rho a^2): harmonic at any amplitude. */
static void a_breathing_tet_is_harmonic(void **state) {
  (void)state;
  double omega = sqrt((2 * elastic.mu + 3 * elastic.lambda) / elastic.density) / a;
  static const double amplitudes[] = {1e-3, 0.5};
  for (int k = 0; k < 2; k++) {
    body b = regular_tet();
    double u[12], v[12] = {0}, amplitude = amplitudes[k];
    for (int i = 0; i < 12; i++) u[i] = amplitude * b.mesh->x[i / 3][i % 3];
    corot_integrator_def def = tight();
    def.atol_displacement = 1e-2 * def.rtol * amplitude * a;
    corot_integrator *integrator = start(&b, &def, u, v);
    for (int p = 1; p <= 48; p++) { /* three periods */
      double t = 2 * pi / omega * p / 16;
      advance(integrator, t);
      assert_ok(corot_integrator_at(integrator, t, u, v));
      double bound = corot_integrator_statistics(integrator).nst * def.rtol * amplitude * a;
      for (int i = 0; i < 12; i++) {
        double X = b.mesh->x[i / 3][i % 3];
        assert_close(u[i], amplitude * cos(omega * t) * X, 0, bound);
        assert_close(v[i], -omega * amplitude * sin(omega * t) * X, 0, omega * bound);
      }
    }
    corot_integrator_destroy(integrator), drop_body(&b);
  }
}

/* x = Rz(omega t) diag(s, s, t) X turns without changing its shape if centrifugal force and stress
   balance: mu and lambda terms of P = (2 mu (s - 1) + p, ., 2 mu (t - 1) + p), p = lambda (2s + t -
   3), obey P11 = rho a^2 omega^2 s and P33 = 0. */
static void a_spinning_tet_keeps_its_shape(void **state) {
  (void)state;
  double mu = elastic.mu, lambda = elastic.lambda, omega = 20;
  double inertia = elastic.density * a * a * omega * omega;
  /* [2 mu - inertia + 2 lambda, lambda; 2 lambda, 2 mu + lambda] (s, t) = (2 mu + 3 lambda)(1, 1)
   */
  double m11 = 2 * mu - inertia + 2 * lambda, m12 = lambda, m21 = 2 * lambda, m22 = 2 * mu + lambda;
  double rhs = 2 * mu + 3 * lambda, det = m11 * m22 - m12 * m21;
  double stretch = rhs * (m22 - m12) / det, thin = rhs * (m11 - m21) / det;
  assert_above(stretch, 1.05); /* no small strain */
  assert_below(thin, 0.95);

  body b = regular_tet();
  double u[12], v[12];
  for (int n = 0; n < 4; n++) {
    const double *X = b.mesh->x[n];
    u[3 * n] = (stretch - 1) * X[0], u[3 * n + 1] = (stretch - 1) * X[1];
    u[3 * n + 2] = (thin - 1) * X[2];
    v[3 * n] = -omega * stretch * X[1], v[3 * n + 1] = omega * stretch * X[0], v[3 * n + 2] = 0;
  }
  corot_integrator_def def = tight();
  corot_integrator *integrator = start(&b, &def, u, v);
  for (int p = 1; p <= 30; p++) { /* three turns */
    double t = 2 * pi / omega * p / 10, c = cos(omega * t), s = sin(omega * t);
    advance(integrator, t);
    assert_ok(corot_integrator_at(integrator, t, u, v));
    /* nothing holds a free body's angle: errors in velocity add up over the time */
    double bound = corot_integrator_statistics(integrator).nst * def.rtol * 2 * a * (1 + omega * t);
    for (int n = 0; n < 4; n++) {
      const double *X = b.mesh->x[n];
      assert_close(X[0] + u[3 * n], stretch * (c * X[0] - s * X[1]), 0, bound);
      assert_close(X[1] + u[3 * n + 1], stretch * (s * X[0] + c * X[1]), 0, bound);
      assert_close(X[2] + u[3 * n + 2], thin * X[2], 0, bound);
    }
  }
  corot_integrator_destroy(integrator), drop_body(&b);
}

/* A bar of length one that can only move along itself: a one-dimensional wave of the speed
   sqrt((lambda + 2 mu) / rho), held at one end. */
static body guided_bar(int order, int cells, double traction, corot_mass mass) {
  corot_box box = {.size = {0.1, 0.1, 1}, .cells = {1, 1, cells}};
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  assert_ok(corot_mesh_group_box(mesh, "all", box.origin, box.size, 0));
  corot_fix fix[] = {{"all", {true, true, false}}, {"zmin", {true, true, true}}};
  corot_load load = {COROT_TRACTION, "zmax", {0, 0, traction}, {0, NULL, NULL}};
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = &elastic;
  def.nfix = 2, def.fix = fix, def.nload = 1, def.load = &load;
  def.mass = mass;
  return make_body(given_order(mesh, order), def);
}

static double wave_speed(void) { return sqrt((elastic.lambda + 2 * elastic.mu) / elastic.density); }

/* The lowest mode of the bar without end effects. */
static double *sine(const body *b) {
  double *x = malloc(4 * b->n * sizeof *x);
  for (int n = 0; n < b->mesh->nnode; n++) {
    int i = corot_model_dof(b->model)[n][2];
    if (i >= 0) x[i] = sin(pi / 2 * b->mesh->x[n][2]);
  }
  return x;
}

/* omega_1 = (pi / 2) c / L; linear elements and lumped mass err by -(k h)^2 / 24, less the uneven
   masses of the end. */
static void the_bar_frequency_converges_with_order_two(void **state) {
  (void)state;
  double exact = pi / 2 * wave_speed(), error[4];
  for (int k = 0; k < 4; k++) {
    int cells = 4 << k;
    body b = guided_bar(1, cells, 0, COROT_MASS_LUMPED);
    double kh = pi / 2 / cells, *x = sine(&b);
    error[k] = 1 - lowest_mode(&b, x) / exact;
    assert_close(error[k], kh * kh / 24, 0.25, 0);
    if (k > 0) assert_close(order_of(error[k - 1], error[k], 2), 2, 0, 0.05);
    free(x), drop_body(&b);
  }
}

/* Consistent mass errs as much, upwards: frequencies of a Galerkin method are no lower than the
   exact ones, nor higher than the Rayleigh quotient of any field. A field of z alone is linear in
   every tet, and its quotient that of linear elements in one dimension,

     omega_h = (2 c / h) sin(k h / 2) / sqrt(1 - 2/3 sin^2(k h / 2)). */
static void consistent_mass_shifts_the_bar_frequency_up(void **state) {
  (void)state;
  double exact = pi / 2 * wave_speed(), error[4];
  for (int k = 0; k < 4; k++) {
    int cells = 4 << k;
    body b = guided_bar(1, cells, 0, COROT_MASS_CONSISTENT);
    double kh = pi / 2 / cells, s = sin(kh / 2);
    double one_dimensional = 2 * wave_speed() * cells * s / sqrt(1 - 2. / 3 * s * s);
    double *x = sine(&b), *y = x + b.n, *zero = y + b.n;
    for (int i = 0; i < 2 * b.n; i++) zero[i] = 0;
    double(*K)[9] = malloc(corot_model_nblock(b.model) * sizeof *K);
    assert_ok(corot_jacobian(b.model, b.state, 0, zero, zero, COROT_TANGENT_HELD, K, NULL));
    corot_block_multiply(b.model, (const double(*)[9])K, x, y);
    double xKx = inner(b.n, x, y);
    corot_mass_multiply(b.model, x, y);
    assert_close(sqrt(xKx / inner(b.n, x, y)), one_dimensional, 1e-12, 0);

    double omega = lowest_mode(&b, x);
    assert_below(omega, one_dimensional * (1 + 1e-10));
    error[k] = omega / exact - 1;
    assert_close(error[k], kh * kh / 24, 0.25, 0);
    if (k > 0) assert_close(order_of(error[k - 1], error[k], 2), 2, 0, 0.05);
    free(K), free(x), drop_body(&b);
  }
}

/* Frequencies by elements of order p and consistent mass err by h^(2 p), upwards. They are no
   higher than those of one-dimensional elements, whose fields the tets have, too: these err by (k
   h)^2 / 24 and (k h)^4 / 1440, and terms that are smaller by some (k h)^2. Fields that vary across
   the bar gain a part of that, but not all: the error of the square of the frequency is that of the
   mode in the energy, to terms that are smaller by (k h)^2, and so at least what polynomials in
   each tet by itself would leave of it. Strains are polynomials of degree p - 1 there, and that of
   the mode is linear, for order 2 quadratic in z, to terms of the next order. Of z a constant
   leaves h^2 times 3/80 in the tets with one or three corners at an end of a cell, 2/3 of the
   volume, and 4/80 in those with two: 1/24, where one dimension leaves 1/12, the half. Of z^2
   linear functions leave h^4 times 1/525 and 1/350: 1/450, where one dimension leaves 1/180, two
   fifths. (What a field across the bar costs in shear is left out.) Terms of the next order move
   the slope by some (k h)^2 of the coarser mesh, 0.15 and 0.04. */
static void frequencies_converge_with_twice_the_order(void **state) {
  (void)state;
  double exact = pi / 2 * wave_speed(), error[3];
  for (int order = 1; order <= 2; order++)
    for (int k = 0; k < 3; k++) {
      int cells = 4 << k;
      body b = guided_bar(order, cells, 0, COROT_MASS_CONSISTENT);
      double kh = pi / 2 / cells, *x = sine(&b);
      double one_dimensional = order == 1 ? kh * kh / 24 : pow(kh, 4) / 1440;
      error[k] = lowest_mode(&b, x) / exact - 1;
      assert_below(error[k], one_dimensional * (1 + kh * kh));
      assert_above(error[k], one_dimensional * (order == 1 ? 0.5 : 0.4) * (1 - kh * kh));
      if (k > 0) {
        double slope = order_of(error[k - 1], error[k], 2);
        print_message("order %d, %2d cells: error %.4e, slope %.3f\n", order, cells, error[k],
                      slope);
        assert_close(slope, 2 * order, 0, 1.3 * pow(pi / cells, 2));
      }
      free(x), drop_body(&b);
    }
}

static void a_mode_of_the_bar_swings_at_its_frequency(void **state) {
  (void)state;
  for (corot_mass mass = COROT_MASS_LUMPED; mass <= COROT_MASS_CONSISTENT; mass++) {
    body b = guided_bar(1, 16, 0, mass);
    double *x = sine(&b), *u = x + b.n, *v = u + b.n, omega = lowest_mode(&b, x);
    double amplitude = 1e-6; /* so that no frame turns: uneven end masses bend it a little */
    double size = amplitude / norm_max(b.n, x);
    for (int i = 0; i < b.n; i++) x[i] *= size, u[i] = x[i], v[i] = 0;
    corot_integrator_def def = tight();
    def.atol_displacement = 1e-2 * def.rtol * amplitude;
    def.atol_velocity = omega * def.atol_displacement;
    corot_integrator *integrator = start(&b, &def, u, v);
    for (int p = 1; p <= 20; p++) {
      double t = 2 * pi / omega * p / 10;
      advance(integrator, t);
      assert_ok(corot_integrator_at(integrator, t, u, NULL));
      double bound = corot_integrator_statistics(integrator).nst * def.rtol * amplitude;
      for (int i = 0; i < b.n; i++) assert_close(u[i], cos(omega * t) * x[i], 0, bound);
    }
    corot_integrator_destroy(integrator), free(x), drop_body(&b);
  }
}

/* A traction p put on the end at once sends a step of stress along the bar: the end moves at
   p / (rho c) until the wave is back at 2 L / c, has then gone twice as far as under a static load,
   returns, and is where it began at 4 L / c. Nothing moves ahead of the wave. */
static void a_step_load_overshoots_twofold(void **state) {
  (void)state;
  int cells = 40;
  double traction = 120, c = wave_speed(), travel = 1 / c;
  double still = traction / (elastic.lambda + 2 * elastic.mu), highest = 0, at = 0;
  double share = still / cells; /* of one cell: the wave front is about as wide */
  body b = guided_bar(1, cells, traction, COROT_MASS_LUMPED);
  const int(*dof)[3] = corot_model_dof(b.model);
  int tip = dof[4 * cells][2], middle = dof[4 * (cells / 2)][2];
  double *u = calloc(2 * b.n, sizeof *u), *v = u + b.n;
  corot_integrator_def def = corot_integrator_defaults();
  def.rtol = 1e-5;
  corot_integrator *integrator = start(&b, &def, u, v);
  for (int p = 1; p <= 200; p++) {
    double t = 4 * travel * p / 200;
    advance(integrator, t);
    assert_ok(corot_integrator_at(integrator, t, u, v));
    if (u[tip] > highest) highest = u[tip], at = t;
    if (t <= 0.4 * travel) assert_below(fabs(u[middle]), 1e-3 * still);
    if (t < 1.9 * travel) assert_close(u[tip], traction / (elastic.density * c) * t, 0, share);
  }
  assert_close(highest, 2 * still, 0, 2 * share);
  assert_close(at, 2 * travel, 0.03, 0);
  assert_close(u[tip], 0, 0, 2 * share);
  corot_integrator_destroy(integrator), free(u), drop_body(&b);
}

/* Timoshenko's frequency equation of a clamped-free beam (Huang 1961) for
   b^2 = rho A L^4 omega^2 / EI, r^2 = I / A L^2, s^2 = EI / k A G L^2; zero at a frequency. */
static double timoshenko(double b, double r2, double s2) {
  double root = sqrt((r2 - s2) * (r2 - s2) + 4 / (b * b));
  double alpha = sqrt((root - r2 - s2) / 2), beta = sqrt((root + r2 + s2) / 2);
  return 2 + (b * b * (r2 - s2) * (r2 - s2) + 2) * cosh(b * alpha) * cos(b * beta) -
         b * (r2 + s2) / sqrt(1 - b * b * r2 * s2) * sinh(b * alpha) * sin(b * beta);
}

static double first_root(double r2, double s2) {
  double low = 2, high = 3.6; /* 1.875104^2 = 3.516 is that of the Euler-Bernoulli beam */
  for (int k = 0; k < 60; k++) {
    double middle = (low + high) / 2;
    if (timoshenko(middle, r2, s2) > 0)
      low = middle;
    else
      high = middle;
  }
  return low;
}

/* The bending frequency of a square cantilever with `cells` through the thickness. By symmetry in
   x and y the mode along the diagonal stays by itself. */
static double bending_frequency(int cells, const corot_material *material) {
  corot_box box = {.size = {0.1, 0.1, 1}, .cells = {cells, cells, 10 * cells}};
  corot_fix fix = {"zmin", {true, true, true}};
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = material, def.nfix = 1, def.fix = &fix;
  body b = make_body(mesh, def);
  double *x = malloc(b.n * sizeof *x);
  for (int n = 0; n < mesh->nnode; n++)
    for (int c = 0; c < 3; c++) {
      const double *X = mesh->x[n];
      int i = corot_model_dof(b.model)[n][c];
      if (i >= 0) x[i] = c < 2 ? X[2] * X[2] : -2 * X[2] * (X[0] + X[1] - 0.1);
    }
  double omega = lowest_mode(&b, x);
  free(x), drop_body(&b);
  return omega;
}

/* Linear tets are far too stiff in bending on coarse meshes, and lose that with order two. Without
   Poisson's effect the beam's theory is right to (h / L)^2 but for the clamped end. */
static void bending_converges_to_the_beam(void **state) {
  (void)state;
  corot_material material = {.lambda = 0, .mu = 1e4, .density = 1000};
  double h = 0.1, young = 2 * material.mu, r2 = h * h / 12, s2 = r2 * young / (material.mu * 5 / 6);
  double unit = sqrt(young * r2 / material.density);
  assert_close(first_root(1e-9, 1e-9), 1.875104 * 1.875104, 1e-6, 0); /* the slender limit */
  double beam = unit * first_root(r2, s2), omega[3], error[3];
  for (int k = 0; k < 3; k++) {
    omega[k] = bending_frequency(2 * (k + 1), &material);
    error[k] = omega[k] / beam - 1;
    assert_above(error[k], 0);
  }
  assert_close(order_of(error[0], error[1], 2), 2, 0, 0.3);
  assert_close(order_of(error[1], error[2], 1.5), 2, 0, 0.2);
  double limit = omega[2] + (omega[2] - omega[1]) * 16 / (36 - 16); /* the h^2 term taken out */
  assert_close(limit, beam, 0.01, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_breathing_tet_is_harmonic),
      cmocka_unit_test(a_spinning_tet_keeps_its_shape),
      cmocka_unit_test(the_bar_frequency_converges_with_order_two),
      cmocka_unit_test(consistent_mass_shifts_the_bar_frequency_up),
      cmocka_unit_test(frequencies_converge_with_twice_the_order),
      cmocka_unit_test(a_mode_of_the_bar_swings_at_its_frequency),
      cmocka_unit_test(a_step_load_overshoots_twofold),
      cmocka_unit_test(bending_converges_to_the_beam),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
