/* Bodies that spin freely: the equilibrium of stretch and centrifugal force, vibrations about it,
   and what is kept; by four-node and by ten-node tets.
 */
#include "solution.h"

/* A plate of 0.6 x 0.2 x 0.05 m about the origin, spinning about z, its axis of largest inertia.
   With lambda = 0 the axes decouple: in the turning frame a point goes from X to x(X) along each,
   where P(x')' + rho omega^2 x = 0 with P = 2 mu (x' - 1) for the corotated measures, so
     x = sin(k X) / (k cos k L),  k^2 = rho omega^2 / 2 mu,
   and P = mu (x'^3 - x') for green. Both are exact in three dimensions. */
static const corot_material no_lambda = {.mu = 1e4, .density = 1000, .damping_mu = 1000};
static const double half[3] = {0.3, 0.1, 0.025}, omega = 9;

static double corotated_position(double X, double L) {
  double k = omega * sqrt(no_lambda.density / (2 * no_lambda.mu));
  return sin(k * X) / (k * cos(k * L));
}

/* Green's x and x' at X > 0 from the stretch x'(0) = q, by Runge and Kutta's method. */
static void shoot(double X, double q, double *x, double *stretch) {
  enum { NSTEP = 100 };
  double s = no_lambda.density * omega * omega / no_lambda.mu, h = X / NSTEP;
  static const double at[] = {0, 0.5, 0.5, 1}, weight[] = {1. / 6, 1. / 3, 1. / 3, 1. / 6};
  *x = 0;
  for (int i = 0; i < NSTEP; i++) {
    double dx = 0, dq = 0, sum_x = 0, sum_q = 0;
    for (int j = 0; j < 4; j++) {
      double xj = *x + at[j] * h * dx, qj = q + at[j] * h * dq;
      dx = qj, dq = -s * xj / (3 * qj * qj - 1);
      sum_x += weight[j] * dx, sum_q += weight[j] * dq;
    }
    *x += h * sum_x, q += h * sum_q;
  }
  *stretch = q;
}

/* With the end X = L free: x'(L) = 1. */
static double green_position(double X, double L) {
  double low = 1, high = 2, x = 0, stretch;
  if (X == 0) return 0;
  while (high - low > 1e-14) {
    double q = 0.5 * (low + high);
    shoot(L, q, &x, &stretch);
    if (stretch > 1)
      high = q;
    else
      low = q;
  }
  shoot(fabs(X), low, &x, &stretch);
  return X > 0 ? x : -x;
}

typedef double position(double X, double L);

static corot_mesh *plate_mesh(int order, const int cells[3]) {
  corot_box box = {.cells = {cells[0], cells[1], cells[2]}};
  for (int c = 0; c < 3; c++) box.size[c] = 2 * half[c], box.origin[c] = -half[c];
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  return given_order(mesh, order);
}

static body plate(const char *strain, int order, int refined) {
  corot_mesh *mesh = plate_mesh(order, (const int[3]){6 * refined, 2 * refined, refined});
  corot_model_def def = corot_model_defaults();
  def.strain = strain, def.nmaterial = 1, def.material = &no_lambda;
  if (strcmp(strain, "polar") == 0) def.viscosity = COROT_OBJECTIVE;
  return make_body(mesh, def);
}

/* x [nnode][3] of the equilibrium. */
static void stretch_to(const body *b, position *of, double (*x)[3]) {
  for (int n = 0; n < b->mesh->nnode; n++) {
    const double *X = b->mesh->x[n];
    x[n][0] = of(X[0], half[0]), x[n][1] = of(X[1], half[1]), x[n][2] = X[2];
  }
}

static double length(const double x[3]) { return sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]); }

/* What a turn, begun in an equilibrium, leads to. */
typedef struct outcome {
  double off; /* change of the distance from the centre, root mean square over the nodes [m] */
  double tip; /* mean distance of the ends from the centre, over that at rest */
} outcome;

static outcome spin(const char *strain, int order, int refined, position *of, double turns) {
  body b = plate(strain, order, refined);
  int nnode = b.mesh->nnode;
  double *u = calloc(2 * b.n, sizeof *u), *v = u + b.n, t_end = turns * 2 * pi / omega;
  double(*x)[3] = malloc(nnode * sizeof *x), ends = 0, ends_at_rest = 0;
  stretch_to(&b, of, x);
  for (int n = 0; n < nnode; n++) { /* free: dof 3n + c */
    for (int c = 0; c < 3; c++) u[3 * n + c] = x[n][c] - b.mesh->x[n][c];
    v[3 * n] = -omega * x[n][1], v[3 * n + 1] = omega * x[n][0];
  }
  corot_integrator_def def = corot_integrator_defaults();
  def.rtol = order == 1 ? 1e-5 : 1e-7; /* whose share of the error is small */
  corot_integrator *integrator = start(&b, &def, u, v);
  advance(integrator, t_end);
  assert_ok(corot_integrator_at(integrator, t_end, u, v));
  outcome o = {0};
  for (int n = 0; n < nnode; n++) {
    double now[3];
    for (int c = 0; c < 3; c++) now[c] = b.mesh->x[n][c] + u[3 * n + c];
    double off = length(now) - length(x[n]);
    o.off += off * off / nnode;
    if (fabs(b.mesh->x[n][0]) < 0.999 * half[0]) continue;
    ends += length(now), ends_at_rest += length(b.mesh->x[n]);
  }
  o.off = sqrt(o.off);
  o.tip = ends / ends_at_rest;
  corot_integrator_destroy(integrator);
  free(u), free(x), drop_body(&b);
  return o;
}

static void closed_forms_agree_with_themselves(void **state) {
  (void)state;
  double x, stretch, k = omega * sqrt(no_lambda.density / (2 * no_lambda.mu));
  assert_close(corotated_position(0.3, 0.3), tan(k * 0.3) / k, 1e-15, 0);
  /* green's first integral: mu (3/4 q^4 - q^2/2) + rho omega^2 x^2 / 2 */
  double s = no_lambda.density * omega * omega / no_lambda.mu, q = 1.15;
  shoot(0.2, q, &x, &stretch);
  assert_close(0.75 * pow(stretch, 4) - 0.5 * stretch * stretch + 0.5 * s * x * x,
               0.75 * pow(q, 4) - 0.5 * q * q, 1e-9, 0);
  assert_close(green_position(1e-3, 1e-3), 1e-3, 1e-4, 0);
}

/* Each measure stays at its own equilibrium, to an error of discretisation of second order with
   four-node tets, measured slopes 1.84 and 1.82, and of third order with ten-node tets, whose nodes
   gain a part of an order: 3.29 and 3.28. The two equilibria are 2.5 % apart at the tips, which the
   meshes tell. */
static void polar_and_green_keep_their_equilibrium(void **state) {
  (void)state;
  static const struct {
    const char *strain;
    position *own, *other;
  } kase[] = {{"polar", corotated_position, green_position},
              {"green", green_position, corotated_position}};
  assert_close(corotated_position(0.3, 0.3) / green_position(0.3, 0.3), 1.0254, 1e-4, 0);
  for (int k = 0; k < 2; k++) {
    outcome coarse = spin(kase[k].strain, 1, 1, kase[k].own, 1);
    outcome fine = spin(kase[k].strain, 1, 2, kase[k].own, 1);
    outcome wrong = spin(kase[k].strain, 1, 2, kase[k].other, 1);
    assert_below(coarse.off, 6e-3 * half[0]);
    assert_close(order_of(coarse.off, fine.off, 2), 2, 0, 0.2);
    assert_above(wrong.off, 5 * fine.off);
    /* ten-node tets: a quarter of a turn is three periods of the vibration that the error excites
     */
    coarse = spin(kase[k].strain, 2, 1, kase[k].own, 0.25);
    fine = spin(kase[k].strain, 2, 2, kase[k].own, 0.25);
    wrong = spin(kase[k].strain, 2, 1, kase[k].other, 0.25);
    double slope = order_of(coarse.off, fine.off, 2);
    assert_below(coarse.off, 6e-3 * half[0] / 50);
    assert_above(slope, 3 - 0.2);
    assert_below(slope, 4);
    assert_above(wrong.off, 100 * coarse.off);
  }
}

/* --- A plate whose thickness vibrates as it spins ------------------------------------------- */

/* Without lambda nothing couples the axes of a body that is stretched along them, and for `polar`
   each obeys a linear law: while x and y keep their equilibrium,

     z = Z + a cos(w t) sin(pi Z / H),  w = (pi / H) sqrt(2 mu / rho),  H the thickness,

   is a motion of the free plate at any amplitude a, undamped, as exact as the stretch. */
static const corot_material ringing = {.mu = 1e4, .density = 1000};
static const double swing = 0.004; /* a: strains of a quarter */

static double ring(void) { return pi / (2 * half[2]) * sqrt(2 * ringing.mu / ringing.density); }

static void vibrating(const double X[3], double t, double x[3], double v[3]) {
  double c = cos(omega * t), s = sin(omega * t), shape = sin(pi * X[2] / (2 * half[2]));
  double p = corotated_position(X[0], half[0]), q = corotated_position(X[1], half[1]);
  x[0] = c * p - s * q, x[1] = s * p + c * q, x[2] = X[2] + swing * cos(ring() * t) * shape;
  v[0] = -omega * x[1], v[1] = omega * x[0], v[2] = -swing * ring() * sin(ring() * t) * shape;
}

/* What is kept, and how nearly; the largest changes since the start. */
typedef struct kept {
  double energy;  /* kinetic and elastic, relative */
  double angular; /* angular momentum, relative */
} kept;

static void go_on(corot_integrator *integrator, const body *b, double t, double *u, double *v,
                  const corot_energies *first, kept *worst) {
  corot_energies now;
  advance(integrator, t);
  assert_ok(corot_integrator_at(integrator, t, u, v));
  assert_ok(corot_energy(b->model, b->state, t, u, v, &now));
  double total = first->kinetic + first->elastic, change[3];
  worst->energy = fmax(worst->energy, fabs(now.kinetic + now.elastic - total) / total);
  for (int c = 0; c < 3; c++) change[c] = now.angular_momentum[c] - first->angular_momentum[c];
  worst->angular = fmax(worst->angular, length(change) / length(first->angular_momentum));
}

/* Distance from where the nodes should be, root mean square [m]. */
static double off_vibration(const body *b, double t, const double *u) {
  double square = 0;
  for (int n = 0; n < b->mesh->nnode; n++) {
    double x[3], v[3];
    vibrating(b->mesh->x[n], t, x, v);
    for (int c = 0; c < 3; c++) x[c] -= b->mesh->x[n][c] + u[3 * n + c];
    square += x[0] * x[0] + x[1] * x[1] + x[2] * x[2];
  }
  return sqrt(square / b->mesh->nnode);
}

/* One vibration; returns how far it is off. Invariants of second degree are off by twice what the
   solution is by the sum of the errors of the steps. */
static double ring_once(int order, int refined) {
  corot_mesh *mesh = plate_mesh(order, (const int[3]){6 * refined, 2 * refined, 2 * refined});
  corot_model_def def = corot_model_defaults();
  def.strain = "polar", def.nmaterial = 1, def.material = &ringing;
  body b = make_body(mesh, def);
  double *u = malloc(2 * b.n * sizeof *u), *v = u + b.n, off = 0;
  for (int n = 0; n < mesh->nnode; n++) {
    vibrating(mesh->x[n], 0, u + 3 * n, v + 3 * n);
    for (int c = 0; c < 3; c++) u[3 * n + c] -= mesh->x[n][c];
  }
  corot_energies first;
  kept worst = {0};
  assert_ok(corot_energy(b.model, b.state, 0, u, v, &first));
  corot_integrator_def method = corot_integrator_defaults();
  method.method = "erk", method.rtol = 1e-7;
  corot_integrator *integrator = start(&b, &method, u, v);
  for (int k = 1; k <= 8; k++) {
    double t = 2 * pi / ring() * k / 8;
    go_on(integrator, &b, t, u, v, &first, &worst);
    off = fmax(off, off_vibration(&b, t, u));
  }
  double bound = 2 * corot_integrator_statistics(integrator).nst * method.rtol;
  print_message("order %d: off %.3e, energy %.1e, angular momentum %.1e, bound %.1e\n", order, off,
                worst.energy, worst.angular, bound);
  assert_below(worst.energy, bound);
  assert_below(worst.angular, bound);
  corot_integrator_destroy(integrator), free(u), drop_body(&b);
  return off;
}

/* The error of displacements, of order 2 with four-node and of order 3 with ten-node tets: slopes
   1.71 and 3.14 from meshes of two and four cells through the thickness, half a wave. */
static void a_spinning_plate_vibrates_in_its_thickness(void **state) {
  (void)state;
  for (int order = 1; order <= 2; order++) {
    double coarse = ring_once(order, 1), fine = ring_once(order, 2);
    assert_below(fine, order == 1 ? swing / 5 : swing / 100);
    assert_close(order_of(coarse, fine, 2), order + 1, 0, 0.3);
  }
}

/* --- Mean strains --------------------------------------------------------------------------- */

/* A body that turns at a small rate has the mean strains of Chree (1892): by Betti's theorem, with
   the moments q_i = rho omega^2 mean(X_i^2) of the centrifugal force about z,

     E e_xx = q_x - nu q_y,  E e_yy = q_y - nu q_x,  E e_zz = -nu (q_x + q_y),

   of whatever shape it is: a plate becomes thinner. The fields of the theorem are linear, and every
   element has them, so that a mesh with consistent mass has these means exactly, however coarse. */
static const corot_material stretching = {.lambda = 2e4, .mu = 1e4, .density = 1000};
static const double slow = 0.5; /* [1/s] */

static void chree(double e[3]) {
  double lambda = stretching.lambda, mu = stretching.mu, nu = lambda / (2 * (lambda + mu)), q[2];
  for (int c = 0; c < 2; c++) q[c] = stretching.density * slow * slow * half[c] * half[c] / 3;
  for (int c = 0; c < 3; c++)
    e[c] = (c < 2 ? q[c] - nu * q[1 - c] : -nu * (q[0] + q[1])) / (2 * mu * (1 + nu));
}

/* The displacement that holds the centrifugal force: K u = omega^2 M (X, Y, 0). What keeps the free
   body's K from being singular is 1e-7 of the square of the frequency of its lowest mode, at most.
 */
static void stretch_slowly(const body *b, double *u) {
  double *force = calloc(2 * b->n, sizeof *force), *X = force + b->n;
  for (int i = 0; i < b->n; i++) X[i] = i % 3 < 2 ? slow * slow * b->mesh->x[i / 3][i % 3] : 0;
  corot_mass_multiply(b->model, X, force);
  for (int i = 0; i < b->n; i++) X[i] = 0;
  corot_pencil *K;
  assert_ok(corot_pencil_create(b->model, b->state, NULL, &K));
  assert_ok(corot_pencil_assemble(K, 0, X, X));
  corot_pencil_combine(K, 2e-6, 0, 1);
  assert_ok(corot_pencil_factor(K));
  assert_ok(corot_pencil_solve(K, force, u));
  corot_pencil_destroy(K), free(force);
}

/* Along the axes of the body at rest: those of green's strain, and of the frames. */
static void mean_strains(const body *b, double t, const double *u, double e[6]) {
  const corot_mesh *mesh = b->mesh;
  double(*strain)[6] = malloc(mesh->ntet * sizeof *strain), edge[9], volume = 0;
  assert_ok(corot_elements(b->model, b->state, t, u, &(corot_element_fields){.strain = strain}));
  for (int c = 0; c < 6; c++) e[c] = 0;
  for (int k = 0; k < mesh->ntet; k++) {
    for (int i = 0; i < 9; i++)
      edge[i] = mesh->x[mesh->tet[k][i / 3 + 1]][i % 3] - mesh->x[mesh->tet[k][0]][i % 3];
    volume += determinant(edge);
    for (int c = 0; c < 6; c++) e[c] += determinant(edge) * strain[k][c];
  }
  for (int c = 0; c < 6; c++) e[c] /= volume;
  free(strain);
}

static body slow_plate(const char *strain, int order) {
  corot_model_def def = corot_model_defaults();
  def.strain = strain, def.nmaterial = 1, def.material = &stretching;
  def.mass = COROT_MASS_CONSISTENT;
  return make_body(plate_mesh(order, (const int[3]){3, 2, 1}), def);
}

/* A quarter of a turn from that equilibrium, a dozen periods of the longitudinal vibration. The
   start leaves out by how much the stretch e adds to the moments, 2 e of them: the means swing
   about a place that is 2 e higher, up to twice as high, relative to themselves. */
static void check_quarter_turn(const body *b, double *u, double *v, const double exact[3]) {
  double within = 4 * exact[0], e[6];
  corot_energies first;
  kept worst = {0};
  assert_ok(corot_energy(b->model, b->state, 0, u, v, &first));
  corot_integrator_def method = corot_integrator_defaults();
  method.rtol = 1e-7;
  corot_integrator *integrator = start(b, &method, u, v);
  for (int k = 1; k <= 4; k++) {
    double t = pi / 2 / slow * k / 4;
    go_on(integrator, b, t, u, v, &first, &worst);
    mean_strains(b, t, u, e);
    for (int c = 0; c < 3; c++) assert_close(e[c], exact[c], within, 0);
    for (int c = 3; c < 6; c++) assert_close(e[c], 0, 0, within * exact[0]);
  }
  double bound = 2 * corot_integrator_statistics(integrator).nst * method.rtol;
  assert_below(worst.energy, bound);
  assert_below(worst.angular, bound);
  corot_integrator_destroy(integrator);
}

static void mean_strains_are_exact_on_coarse_meshes(void **state) {
  (void)state;
  double exact[3], e[6];
  chree(exact);
  for (int order = 1; order <= 2; order++)
    for (int m = 0; m < NMEASURE; m++) {
      if (!conserves(m)) continue;
      body b = slow_plate(measures[m], order);
      double *u = calloc(2 * b.n, sizeof *u), *v = u + b.n;
      stretch_slowly(&b, u);
      mean_strains(&b, 0, u, e); /* of second order in e: green's own, and turns of frames */
      for (int c = 0; c < 3; c++) assert_close(e[c], exact[c], exact[0], 0);
      for (int n = 0; n < b.mesh->nnode; n++) {
        v[3 * n] = -slow * (b.mesh->x[n][1] + u[3 * n + 1]);
        v[3 * n + 1] = slow * (b.mesh->x[n][0] + u[3 * n]);
      }
      check_quarter_turn(&b, u, v, exact);
      free(u), drop_body(&b);
    }
}

/* To linear elasticity a rotation is a strain, and a velocity of rotation none: nothing holds the
   ends back, and the body grows like sqrt(1 + (omega t)^2) for ever. */
static void cauchy_grows_without_bound(void **state) {
  (void)state;
  for (int turns = 1; turns <= 4; turns *= 2) {
    outcome o = spin("cauchy", 1, 1, corotated_position, turns);
    double angle = 2 * pi * turns;
    /* by the stretch at the start, some 10 %, the rate of growth exceeds omega */
    assert_close(o.tip, sqrt(1 + angle * angle), 0.2, 0);
    assert_above(o.tip, sqrt(1 + angle * angle));
  }
}

/* A bent bar that tumbles and swings, undamped. The relative drift of its angular momentum in a
   second. */
static double drift_of(const char *strain, double rtol) {
  corot_box box = {.size = {0.1, 0.1, 0.3}, .cells = {1, 1, 3}, .origin = {-0.05, -0.05, -0.15}};
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  corot_model_def def = corot_model_defaults();
  def.strain = strain, def.nmaterial = 1, def.material = &elastic;
  body b = make_body(mesh, def);
  double *u = calloc(2 * b.n, sizeof *u), *v = u + b.n, worst = 0;
  for (int n = 0; n < mesh->nnode; n++) {
    const double *X = mesh->x[n];
    u[3 * n] = 0.03 * pow(X[2] / 0.15, 2);
    v[3 * n] = -pi * X[1] + 2 * X[2], v[3 * n + 1] = pi * X[0] - X[2],
          v[3 * n + 2] = X[1] - 2 * X[0];
  }
  corot_energies first, now;
  assert_ok(corot_energy(b.model, b.state, 0, u, v, &first));
  corot_integrator_def method = corot_integrator_defaults();
  method.rtol = rtol, method.max_order = 2;
  corot_integrator *integrator = start(&b, &method, u, v);
  for (int k = 1; k <= 20; k++) {
    advance(integrator, k / 20.0);
    assert_ok(corot_integrator_at(integrator, k / 20.0, u, v));
    assert_ok(corot_energy(b.model, b.state, k / 20.0, u, v, &now));
    double change[3];
    for (int c = 0; c < 3; c++) change[c] = now.angular_momentum[c] - first.angular_momentum[c];
    worst = fmax(worst, length(change) / length(first.angular_momentum));
    for (int c = 0; c < 3; c++)
      assert_close(now.momentum[c], first.momentum[c], 0, 1e-12 * length(first.angular_momentum));
  }
  corot_integrator_destroy(integrator), free(u), drop_body(&b);
  return worst;
}

/* Polar's drift is the integrator's and falls with the tolerance. Warp's is the model's: the frame
   of three edges is not that of the stress, whose moment does not vanish. */
static void warp_loses_angular_momentum_and_polar_does_not(void **state) {
  (void)state;
  double polar[2], warp[2];
  for (int k = 0; k < 2; k++) {
    polar[k] = drift_of("polar", k ? 1e-7 : 1e-5);
    warp[k] = drift_of("warp", k ? 1e-7 : 1e-5);
  }
  assert_below(polar[0], 1e-4);
  assert_below(polar[1], 0.1 * polar[0]);
  assert_close(warp[0], 0.31, 0.1, 0);
  assert_close(warp[1], warp[0], 0.05, 0);
  assert_above(warp[1], 1e5 * polar[1]);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(closed_forms_agree_with_themselves),
      cmocka_unit_test(polar_and_green_keep_their_equilibrium),
      cmocka_unit_test(a_spinning_plate_vibrates_in_its_thickness),
      cmocka_unit_test(mean_strains_are_exact_on_coarse_meshes),
      cmocka_unit_test(cauchy_grows_without_bound),
      cmocka_unit_test(warp_loses_angular_momentum_and_polar_does_not),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
