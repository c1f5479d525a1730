/* What a body in motion must keep - energy, momentum, angular momentum - and how nearly an
   integration keeps it. */
#include "solution.h"

/* A free bar of 0.3 m about the origin, bent, spinning at half a turn a second and drifting at
   1 m/s. */
static body free_bar(const char *strain, const corot_material *material,
                     corot_viscosity viscosity) {
  corot_box box = {.size = {0.1, 0.1, 0.3}, .cells = {1, 1, 3}, .origin = {-0.05, -0.05, -0.15}};
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  corot_model_def def = corot_model_defaults();
  def.strain = strain, def.nmaterial = 1, def.material = material, def.viscosity = viscosity;
  return make_body(mesh, def);
}

static void throw_it(const body *b, double *u, double *v) {
  double(*nodal_u)[3] = calloc(2 * b->mesh->nnode, sizeof *nodal_u);
  double(*nodal_v)[3] = nodal_u + b->mesh->nnode;
  for (int n = 0; n < b->mesh->nnode; n++) {
    const double *X = b->mesh->x[n], spin = pi;
    double velocity[3] = {1 - spin * X[1] + 0.1 * X[2], spin * X[0], -0.2 * X[0]};
    nodal_u[n][0] = 0.03 * pow(X[2] / 0.15, 2);
    memcpy(nodal_v[n], velocity, sizeof velocity);
  }
  to_dofs(b, (const double(*)[3])nodal_u, u);
  to_dofs(b, (const double(*)[3])nodal_v, v);
  free(nodal_u);
}

/* The bar held at one end, swung sideways and, with a traction, pulled at the other. */
static body held_bar(const corot_material *material, double traction) {
  corot_box box = {.size = {0.1, 0.1, 0.6}, .cells = {1, 1, 6}};
  corot_fix fix = {"zmin", {true, true, true}};
  corot_load load = {COROT_TRACTION, "zmax", {traction, 0, 2 * traction}, {0, NULL, NULL}};
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = material;
  def.nfix = 1, def.fix = &fix, def.nload = 1, def.load = &load;
  return make_body(mesh, def);
}

static void swing_it(const body *b, double *u, double *v) {
  for (int i = 0; i < b->n; i++) u[i] = v[i] = 0;
  for (int n = 0; n < b->mesh->nnode; n++) {
    int i = corot_model_dof(b->model)[n][0];
    double z = b->mesh->x[n][2] / 0.6;
    if (i >= 0) v[i] = 0.5 * z * z;
  }
}

/* Largest deviations from the beginning, over a run to t_end. */
typedef struct drift {
  double gain, loss;           /* of kinetic and elastic energy, relative to it */
  double loss_half;            /* in the first half of the time */
  double balance;              /* the same with dissipated and external work, either sign */
  double dissipated, external; /* largest, relative */
  double momentum;             /* relative */
  double angular;              /* relative */
} drift;

static double deviation(const double a[3], const double b[3]) {
  double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  return norm_max(3, d) / fmax(norm_max(3, b), 1e-300);
}

static drift run(const body *b, void (*begin)(const body *, double *, double *), double rtol,
                 double t_end) {
  enum { NTIME = 50 };
  double *u = malloc(2 * b->n * sizeof *u), *v = u + b->n;
  corot_integrator_def def = corot_integrator_defaults();
  corot_energies first, now;
  drift d = {0};
  begin(b, u, v);
  def.rtol = rtol, def.max_order = 2;
  assert_ok(corot_energy(b->model, b->state, 0, u, v, &first));
  double energy = first.kinetic + first.elastic;
  corot_integrator *integrator = start(b, &def, u, v);
  for (int k = 1; k <= NTIME; k++) {
    double t = t_end * k / NTIME, dissipated, external;
    advance(integrator, t);
    assert_ok(corot_integrator_at(integrator, t, u, v));
    assert_ok(corot_integrator_work(integrator, t, &dissipated, &external));
    assert_ok(corot_energy(b->model, b->state, t, u, v, &now));
    double change = (now.kinetic + now.elastic - energy) / energy;
    d.gain = fmax(d.gain, change);
    d.loss = fmax(d.loss, -change);
    if (2 * k <= NTIME) d.loss_half = d.loss;
    d.dissipated = fmax(d.dissipated, dissipated / energy);
    d.external = fmax(d.external, fabs(external) / energy);
    d.balance = fmax(d.balance, fabs(change + (dissipated - external) / energy));
    d.momentum = fmax(d.momentum, deviation(now.momentum, first.momentum));
    d.angular = fmax(d.angular, deviation(now.angular_momentum, first.angular_momentum));
  }
  corot_integrator_destroy(integrator), free(u);
  return d;
}

/* Momentum is linear in the unknowns and every BDF, and every Newton iteration with a K that has
   its null vectors, keeps it to rounding. Order two takes energy from a mode in proportion to h^3,
   and h^3 is in proportion to the tolerance. Angular momentum, quadratic in the unknowns, drifts as
   the error of the solution does, with the power 2/3, up to cancellation. */
static void a_free_body_keeps_its_invariants(void **state) {
  (void)state;
  for (int m = 0; m < NSTRAIN; m++) {
    if (!conserves(m)) continue;
    body b = free_bar(measures[m], &elastic, COROT_COROTATED);
    drift loose = run(&b, throw_it, 1e-4, 1), tight = run(&b, throw_it, 1e-6, 1);
    assert_below(loose.momentum, 1e-12);
    assert_below(tight.momentum, 1e-12);
    assert_below(loose.gain, 1e-9);
    assert_below(tight.gain, 1e-9);
    assert_below(tight.loss, 5e-4);
    assert_close(order_of(loose.loss, tight.loss, 100), 1, 0, 0.15);
    assert_below(tight.angular, 5e-5);
    assert_above(order_of(loose.angular, tight.angular, 100), 0.45);
    /* no faster in the second half than in the first */
    assert_below(loose.loss, 2.5 * loose.loss_half);
    assert_below(tight.loss, 2.5 * tight.loss_half);
    drop_body(&b);
  }
}

/* Viscous forces of green, and of the objective law, have no moment. The corotated law has one, of
   the order of the strain: what it takes from the angular momentum does not depend on the
   tolerance. */
static void damping_and_angular_momentum(void **state) {
  (void)state;
  static const struct {
    const char *strain;
    corot_viscosity viscosity;
  } keeping[] = {{"green", COROT_COROTATED}, {"polar", COROT_OBJECTIVE}};
  for (int k = 0; k < 2; k++) {
    body b = free_bar(keeping[k].strain, &soft, keeping[k].viscosity);
    drift loose = run(&b, throw_it, 1e-4, 1), tight = run(&b, throw_it, 1e-6, 1);
    assert_above(tight.dissipated, 0.1);
    assert_below(tight.angular, 5e-5);
    assert_above(order_of(loose.angular, tight.angular, 100), 0.45);
    drop_body(&b);
  }
  body b = free_bar("polar", &soft, COROT_COROTATED);
  drift loose = run(&b, throw_it, 1e-5, 1), tight = run(&b, throw_it, 1e-6, 1);
  assert_close(tight.angular, loose.angular, 0.1, 0);
  assert_close(tight.angular, 3e-3, 0.5, 0);
  assert_below(tight.momentum, 1e-12);
  drop_body(&b);
}

/* kinetic + elastic + dissipated - external stays what it was, to the error of the solution and of
   the work integrals, which goes with the power 2/3 of the tolerance. */
static void the_ledger_of_energy_closes(void **state) {
  (void)state;
  corot_material thick = soft;
  thick.damping_lambda *= 300, thick.damping_mu *= 300;
  body b = held_bar(&thick, 100);
  drift loose = run(&b, swing_it, 1e-5, 1), tight = run(&b, swing_it, 1e-7, 1);
  assert_above(loose.dissipated, 0.3); /* there is something to account for */
  assert_above(loose.external, 0.3);
  assert_below(loose.balance, 2 * pow(1e-5, 2. / 3));
  assert_below(tight.balance, 2 * pow(1e-7, 2. / 3));
  assert_close(order_of(loose.balance, tight.balance, 100), 2. / 3, 0, 0.2);
  drop_body(&b);
}

/* Largest energy of the held bar after any step of 20 s, undamped, relative to the initial one; no
 * further than twice that. */
static double highest_energy(const corot_integrator_def *def) {
  body b = held_bar(&elastic, 0);
  double *u = malloc(2 * b.n * sizeof *u), *v = u + b.n, highest = 0;
  corot_energies e;
  swing_it(&b, u, v);
  assert_ok(corot_energy(b.model, b.state, 0, u, v, &e));
  double first = e.kinetic + e.elastic;
  corot_integrator *integrator = start(&b, def, u, v);
  if (!def->max_order) assert_int_equal(corot_integrator_chosen(integrator).max_order, 2);
  for (corot_step step = {0}; step.t < 20 && highest < 2;) {
    assert_ok(corot_integrator_step(integrator, 20, &step));
    assert_ok(corot_integrator_at(integrator, step.t, u, v));
    assert_ok(corot_energy(b.model, b.state, step.t, u, v, &e));
    highest = fmax(highest, (e.kinetic + e.elastic) / first);
  }
  corot_integrator_destroy(integrator), free(u), drop_body(&b);
  return highest;
}

/* What is chosen for an undamped body never pumps energy into it, whatever the tolerance; order
   five does, and so does order two where Newton's method may stop at a tenth of the tolerance with
   a matrix that lags, as is CVODE's own custom. */
static void the_default_does_not_gain_energy(void **state) {
  (void)state;
  const double rtol[] = {1e-2, 3e-3, 1e-3, 3e-4, 1e-4};
  for (int k = 0; k < 5; k++) {
    corot_integrator_def def = corot_integrator_defaults();
    def.rtol = rtol[k];
    assert_below(highest_energy(&def), 1 + 1e-4);
  }
  corot_integrator_def def = corot_integrator_defaults();
  def.rtol = 1e-2, def.max_order = 5;
  assert_above(highest_energy(&def), 2);
  def.rtol = 3e-3, def.max_order = 0, def.convergence = 0.1;
  assert_above(highest_energy(&def), 1.02);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_free_body_keeps_its_invariants),
      cmocka_unit_test(damping_and_angular_momentum),
      cmocka_unit_test(the_ledger_of_energy_closes),
      cmocka_unit_test(the_default_does_not_gain_energy),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
