/* A bar that is shaken at its base, against the wave in closed form; and what it costs a consistent
   mass to be lumped in the elements at a support whose velocity may jump. */
#include "solution.h"

static double wave_speed(void) { return sqrt((elastic.lambda + 2 * elastic.mu) / elastic.density); }

static const double points[] = {0, 1}, nothing[] = {0, 0};

typedef enum base { FIXED, SHAKEN, PIECEWISE } base;

/* A bar of length one that can only move along itself, by strains linear in u. */
static body guided_bar(int cells, corot_mass mass, base how, double frequency) {
  corot_box box = {.size = {0.1, 0.1, 1}, .cells = {1, 1, cells}};
  double low[3] = {-1, -1, 0.1 / cells}, high[3] = {1, 1, 2};
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  assert_ok(corot_mesh_group_box(mesh, "rest", low, high, 0));
  corot_fix fix[] = {{"rest", {true, true, false}}, {"zmin", {true, true, true}}};
  corot_motion motion = {.kind = COROT_MOVE, .group = "zmin", .direction = {0, 0, 1}};
  motion.amplitude = (corot_amplitude){.curve = COROT_CURVE_SINE, .frequency = frequency};
  if (how == PIECEWISE) motion.amplitude = (corot_amplitude){2, points, nothing};
  corot_model_def def = corot_model_defaults();
  def.strain = "cauchy", def.nmaterial = 1, def.material = &elastic, def.mass = mass;
  def.nfix = how == FIXED ? 2 : 1, def.fix = fix;
  def.nmotion = how != FIXED, def.motion = &motion;
  return make_body(mesh, def);
}

/* u = sin(omega t) cos(k (1 - z)) / cos(k), omega = k c, has the motion of the base and no stress
   at the end. The largest error after most of a period, over the largest displacement of the time,
   of the means over cross-sections: their nodes have uneven masses, which bends them a little. */
static double shaken_error(int cells, corot_mass mass) {
  double k = 1, omega = k * wave_speed(), period = 2 * pi / omega, t = 0.95 * period, worst = 0;
  body b = guided_bar(cells, mass, SHAKEN, 1 / period);
  double *u = calloc(2 * b.n, sizeof *u), *v = u + b.n;
  for (int n = 0; n < b.mesh->nnode; n++) {
    int i = corot_model_dof(b.model)[n][2];
    if (i >= 0) v[i] = omega * cos(k * (1 - b.mesh->x[n][2])) / cos(k);
  }
  corot_integrator_def def = corot_integrator_defaults();
  def.method = "arkode", def.order = 5, def.rtol = 1e-8;
  corot_integrator *integrator = start(&b, &def, u, v);
  advance(integrator, t);
  assert_ok(corot_integrator_at(integrator, t, u, v));
  for (int layer = 1; layer <= cells; layer++) {
    double z = (double)layer / cells, mean = 0;
    for (int n = 4 * layer; n < 4 * layer + 4; n++) mean += u[corot_model_dof(b.model)[n][2]] / 4;
    worst = fmax(worst, fabs(mean - sin(omega * t) * cos(k * (1 - z)) / cos(k)));
  }
  corot_integrator_destroy(integrator), free(u), drop_body(&b);
  return worst * fabs(cos(k));
}

/* Both to second order. Consistent mass errs half as much as lumped mass here, and twice as much if
   nothing of the base's acceleration is handed on. */
static void a_shaken_bar_follows_its_wave(void **state) {
  (void)state;
  double lumped[3], consistent[3];
  for (int r = 0; r < 3; r++) {
    lumped[r] = shaken_error(8 << r, COROT_MASS_LUMPED);
    consistent[r] = shaken_error(8 << r, COROT_MASS_CONSISTENT);
    assert_below(consistent[r], 0.6 * lumped[r]);
    if (r == 0) continue;
    assert_close(order_of(lumped[r - 1], lumped[r], 2), 2, 0, 0.15);
    assert_close(order_of(consistent[r - 1], consistent[r], 2), 2, 0, 0.15);
  }
  assert_below(consistent[0], 1e-3);
}

/* The lowest frequency. */
static double frequency(int cells, base how) {
  body b = guided_bar(cells, COROT_MASS_CONSISTENT, how, 1);
  double *x = malloc(b.n * sizeof *x);
  for (int n = 0; n < b.mesh->nnode; n++) {
    int i = corot_model_dof(b.model)[n][2];
    if (i >= 0) x[i] = sin(pi / 2 * b.mesh->x[n][2]);
  }
  double omega = lowest_mode(&b, x);
  free(x), drop_body(&b);
  return omega;
}

/* Consistent mass errs by a frequency that is too high, to second order. The layer takes a part of
   that away, to third order. A support that moves smoothly has the mass of one that is fixed. */
static void a_lumped_layer_costs_less_than_the_mass_errs(void **state) {
  (void)state;
  double exact = pi / 2 * wave_speed(), change[3], last = 0;
  for (int r = 0; r < 3; r++) {
    double whole = frequency(8 << r, FIXED);
    assert_true(frequency(8 << r, SHAKEN) == whole);
    change[r] = 1 - frequency(8 << r, PIECEWISE) / whole;
    double error = whole / exact - 1;
    assert_above(change[r], 0);
    assert_below(change[r], error);
    if (r > 0) assert_close(order_of(last, error, 2), 2, 0, 0.1);
    if (r > 0) assert_close(order_of(change[r - 1], change[r], 2), 3, 0, 0.1);
    last = error;
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_shaken_bar_follows_its_wave),
      cmocka_unit_test(a_lumped_layer_costs_less_than_the_mass_errs),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
