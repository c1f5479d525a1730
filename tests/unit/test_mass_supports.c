/* A consistent mass with supports that move: what it hands on to the free nodes, and that momenta
   and the ledger of energy know of it. */
#include <corot/integrate.h>
#include <corot/solve.h>

#include "alloc.h"
#include "solid.h"

static const double times[] = {0.1, 0.2, 0.35, 0.4}, values[] = {0, 0.5, 1, 0.8};
static const double omega = 4 * 3.14159265358979324; /* of the sines */

/* Jolted ones start and stop at once. */
static const struct {
  corot_motion motion;
  bool smooth;
} supports[] = {
    {{COROT_ROTATE, "zmin", {1, 2, 3}, {0.1, -0.2, 0.05}, 0.5, {0}, 0.1, 0.4}, false},
    {{COROT_TRANSLATE, "zmin", {0}, {0}, 0, {0.3, -0.4, 0.2}, 0.1, 0.4}, false},
    {{.kind = COROT_MOVE,
      .group = "zmin",
      .direction = {0.05, -0.02, 0.1},
      .amplitude = {4, times, values}},
     false},
    {{.kind = COROT_MOVE,
      .group = "zmin",
      .direction = {0.05, -0.02, 0.1},
      .amplitude = {4, times, values, COROT_CURVE_SMOOTH}},
     true},
    {{.kind = COROT_MOVE,
      .group = "zmin",
      .direction = {0.02, 0.01, -0.03},
      .amplitude = {.curve = COROT_CURVE_SINE, .frequency = 2}},
     true},
    {{.kind = COROT_TURN,
      .group = "zmin",
      .axis = {1, 2, 3},
      .center = {0.1, -0.2, 0.05},
      .angle = 0.1,
      .amplitude = {4, times, values, COROT_CURVE_SMOOTH}},
     true},
    {{.kind = COROT_TURN,
      .group = "zmin",
      .axis = {1, 2, 3},
      .center = {0.1, -0.2, 0.05},
      .angle = 0.1,
      .amplitude = {.curve = COROT_CURVE_SINE, .frequency = 2, .phase = 1}},
     true},
};
enum { NSUPPORT = sizeof supports / sizeof *supports };

static bool turns(int k) {
  corot_motion_kind kind = supports[k].motion.kind;
  return kind == COROT_ROTATE || kind == COROT_TURN;
}

/* Motions one after the other, each alone and then each with the next of those that it adds up
   with; returns how many there are, 0 at the end. *smooth: all of them are. */
static int next_motions(int k, corot_motion m[2], bool *smooth) {
  int i = k % NSUPPORT, j = i + 1;
  if (k >= 2 * NSUPPORT) return 0;
  m[0] = supports[i].motion, *smooth = supports[i].smooth;
  if (k < NSUPPORT) return 1;
  while (j < NSUPPORT && turns(j) != turns(i)) j++;
  if (j == NSUPPORT) return 1;
  m[1] = supports[j].motion, *smooth &= supports[j].smooth;
  return 2;
}

/* Two materials without viscosity, but with mass damping times `damping`, in a body of unlike tets.
 */
static body crooked(corot_mass mass, double damping, int nmotion, const corot_motion *motion,
                    const corot_load *load) {
  corot_mesh *mesh = crooked_box(2, 3, 4);
  double low[3] = {-10, -10, -10}, high[3] = {10, 10, 10};
  high[2] = mesh->x[mesh->nnode / 2][2];
  assert_ok(corot_mesh_group_box(mesh, "lower", low, high, 0));
  corot_material material[2] = {{.lambda = 1e5, .mu = 1e4, .density = 1000}};
  material[1] = material[0], material[0].group = "lower", material[1].density *= 3;
  material[0].damping_mass = 0.3 * damping, material[1].damping_mass = 2 * damping;
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 2, def.material = material, def.mass = mass;
  def.nmotion = nmotion, def.motion = motion, def.nload = load != NULL, def.load = load;
  return make_body(mesh, def);
}

/* --- The force ------------------------------------------------------------------------------- */

/* What r of the consistent mass has beside r of the lumped one, of a body at rest but for its
   supports: f [n]. Returns n. */
static int find_drag(int nmotion, const corot_motion *motion, double side, double t, double *f) {
  body b = crooked(COROT_MASS_CONSISTENT, 1, nmotion, motion, NULL);
  body lumped = crooked(COROT_MASS_LUMPED, 1, nmotion, motion, NULL);
  double *zero = calloc(2 * b.n, sizeof *zero), *r = zero + b.n;
  corot_state_enter(b.state, side);
  assert_ok(corot_residual(b.model, b.state, t, zero, zero, f));
  assert_ok(corot_residual(lumped.model, lumped.state, t, zero, zero, r));
  for (int i = 0; i < b.n; i++) f[i] -= r[i];
  int n = b.n;
  free(zero), drop_body(&b), drop_body(&lumped);
  return n;
}

/* The same from the matrices of the body without supports, of which the free rows are taken: -M a
   for the accelerations a of the supports, central differences of their velocities over 2 h; and
   -C v for their velocities, the force of that body when it is not deformed. *size: of both. */
static void expect_drag(int nmotion, const corot_motion *motion, double t, double h, double *f,
                        double *size) {
  body b = crooked(COROT_MASS_CONSISTENT, 1, nmotion, motion, NULL);
  body whole = crooked(COROT_MASS_CONSISTENT, 1, 0, NULL, NULL);
  const int(*dof)[3] = corot_model_dof(b.model), (*all)[3] = corot_model_dof(whole.model);
  int nnode = b.mesh->nnode;
  double *zero = calloc(5 * whole.n, sizeof *zero), *a = zero + whole.n, *v = a + whole.n;
  double *Ma = v + whole.n, *Cv = Ma + whole.n;
  double(*at)[3] = calloc(3 * nnode, sizeof *at), (*before)[3] = at + nnode,
  (*after)[3] = before + nnode;
  corot_nodal(b.model, t, zero, zero, NULL, at);
  corot_nodal(b.model, t - h, zero, zero, NULL, before);
  corot_nodal(b.model, t + h, zero, zero, NULL, after);
  for (int i = 0; i < 3 * nnode; i++) {
    int to = all[i / 3][i % 3];
    v[to] = at[i / 3][i % 3];
    a[to] = (after[i / 3][i % 3] - before[i / 3][i % 3]) / (2 * h);
  }
  corot_mass_multiply(whole.model, a, Ma);
  assert_ok(corot_residual(whole.model, whole.state, 0, zero, v, Cv));
  *size = norm_max(whole.n, Ma) + norm_max(whole.n, Cv);
  for (int i = 0; i < 3 * nnode; i++)
    if (dof[i / 3][i % 3] >= 0)
      f[dof[i / 3][i % 3]] = Cv[all[i / 3][i % 3]] - Ma[all[i / 3][i % 3]];
  free(at), free(zero), drop_body(&b), drop_body(&whole);
}

/* The differences err by h^2 / 6 of the fourth derivative, some 3e4 times the displacement, and by
   the rounding of velocities of 1 m/s over h: together 1e-7 of accelerations of some 10 m/s^2. What
   lumped and consistent r share has the rounding of elastic forces of 1e3 N. */
static void smooth_supports_drag_their_neighbours(void **state) {
  (void)state;
  double f[400], expected[400], size;
  corot_motion m[2];
  bool smooth;
  for (int k = 0, nmotion; (nmotion = next_motions(k, m, &smooth)); k++)
    for (double t = 0.05; t < 0.5; t += 0.08) { /* no point is nearer than h */
      int n = find_drag(nmotion, m, NAN, t, f);
      if (!smooth) {
        assert_below(norm_max(n, f), 1e-11);
        continue;
      }
      expect_drag(nmotion, m, t, 1e-5, expected, &size);
      for (int i = 0; i < n; i++) assert_close(f[i], expected[i], 0, 1e-7 * size + 1e-11);
      if (t > 0.1 && t < 0.4) assert_above(norm_max(n, f), 1e-2);
    }
}

/* There the acceleration jumps, and the state knows which side is meant. Lumped, or with a part
   that jolts, there is no drag, and a spline has no kinks. */
static void ends_of_a_spline_are_kinks_of_the_drag(void **state) {
  (void)state;
  double f[400], kink[4];
  for (int k = 0; k < NSUPPORT; k++) {
    const corot_motion m[] = {supports[k].motion, supports[k].motion};
    bool spline = m[0].amplitude.curve == COROT_CURVE_SMOOTH;
    for (corot_mass mass = COROT_MASS_LUMPED; mass <= COROT_MASS_CONSISTENT; mass++) {
      body b = crooked(mass, 1, 1, m, NULL);
      int nkink = corot_model_kinks(b.model, -9, 9, 4, kink), n = b.n;
      drop_body(&b);
      if (!supports[k].smooth) continue;
      bool has = spline && mass == COROT_MASS_CONSISTENT;
      assert_int_equal(nkink, has ? 2 : 0);
      if (!has) continue;
      assert_true(kink[0] == 0.1 && kink[1] == 0.4);
      const double side[] = {-1, 0.1, 0.1, 0.4}, at[] = {0.1, 0.1, 0.4, 0.4};
      for (int i = 0; i < 4; i++) {
        find_drag(1, m, side[i], at[i], f);
        assert_true((norm_max(n, f) > 0.1) == (i == 1 || i == 2));
      }
    }
  }
}

/* Where gravity is the acceleration of the support, and the body displaced as the support is, all
   of it falls alike, M a = r. Beside a jolted support, which is at rest yet, all falls alike in any
   gravity: nothing couples them. a is right to rounding of forces of some 1e3 N over masses of some
   kg, times the condition of M, which is some tens. */
static void all_of_a_body_falls_alike(void **state) {
  (void)state;
  for (int k = 0; k < NSUPPORT; k++) {
    const corot_motion *m = &supports[k].motion;
    bool sine = m->amplitude.curve == COROT_CURVE_SINE;
    double t = 0.0625, shift = sine ? sin(omega * t) : 0, *direction = (double *)m->direction;
    corot_load gravity = {COROT_GRAVITY, NULL, {0.7, -2, 9.81}, {0}};
    if (supports[k].smooth && (!sine || turns(k))) continue;
    for (int c = 0; c < 3 && sine; c++) gravity.value[c] = -omega * omega * shift * direction[c];
    body b = crooked(COROT_MASS_CONSISTENT, 0, 1, m, &gravity);
    double *u = calloc(4 * b.n, sizeof *u), *v = u + b.n, *r = v + b.n, *a = r + b.n;
    const int(*dof)[3] = corot_model_dof(b.model);
    for (int i = 0; i < 3 * b.mesh->nnode; i++)
      if (dof[i / 3][i % 3] >= 0) u[dof[i / 3][i % 3]] = shift * direction[i % 3];
    corot_mass_solver *solver;
    assert_ok(corot_mass_solver_create(b.model, &solver));
    assert_ok(corot_residual(b.model, b.state, t, u, v, r));
    assert_ok(corot_mass_solve(solver, r, a));
    for (int i = 0; i < 3 * b.mesh->nnode; i++)
      if (dof[i / 3][i % 3] >= 0)
        assert_close(a[dof[i / 3][i % 3]], gravity.value[i % 3], 0, 1e-11);
    corot_mass_solver_destroy(solver);
    free(u), drop_body(&b);
  }
}

/* Statics know of no acceleration. */
static void at_rest_nothing_drags(void **state) {
  (void)state;
  double f[400];
  for (int k = 0; k < NSUPPORT; k++) {
    body b = crooked(COROT_MASS_CONSISTENT, 1, 1, &supports[k].motion, NULL);
    body lumped = crooked(COROT_MASS_LUMPED, 1, 1, &supports[k].motion, NULL);
    double *zero = calloc(2 * b.n, sizeof *zero), *r = zero + b.n;
    corot_state_stand_still(b.state, 0, 1), corot_state_stand_still(lumped.state, 0, 1);
    assert_ok(corot_residual(b.model, b.state, 0.17, zero, zero, f));
    assert_ok(corot_residual(lumped.model, lumped.state, 0.17, zero, zero, r));
    assert_memory_equal(f, r, b.n * sizeof *r);
    free(zero), drop_body(&b), drop_body(&lumped);
  }
}

/* --- Momenta and energies -------------------------------------------------------------------- */

/* What the energies are counted by: momentum changes by all forces, kinetic energy by their power,
   and what a rigid motion of supports carries by what they put in; at a state that swings, along
   M v' = r, by central differences. */
static void balances_hold_at_each_moment(void **state) {
  (void)state;
  for (int k = 0; k < NSUPPORT; k++) {
    body b = crooked(COROT_MASS_CONSISTENT, 1, 1, &supports[k].motion, NULL);
    double *y = calloc(7 * b.n, sizeof *y), *rate = y + 2 * b.n, *near = y + 4 * b.n;
    double *r = y + 6 * b.n, force[3] = {0};
    const double t = 0.22, dt = 1e-6;
    const int(*dof)[3] = corot_model_dof(b.model);
    uint64_t seed = 5;
    corot_energies e, there[2];
    corot_mass_solver *solver;
    assert_ok(corot_mass_solver_create(b.model, &solver));
    for (int i = 0; i < 2 * b.n; i++) y[i] = (i < b.n ? 1e-3 : 0.1) * noise(&seed);
    corot_state_enter(b.state, 0.2);
    assert_ok(corot_energy(b.model, b.state, t, y, y + b.n, &e));
    assert_ok(corot_residual(b.model, b.state, t, y, y + b.n, r));
    assert_ok(corot_mass_solve(solver, r, rate + b.n));
    memcpy(rate, y + b.n, b.n * sizeof *rate);
    for (int side = 0; side < 2; side++) {
      for (int i = 0; i < 2 * b.n; i++) near[i] = y[i] + (side ? dt : -dt) * rate[i];
      assert_ok(
          corot_energy(b.model, b.state, t + (side ? dt : -dt), near, near + b.n, &there[side]));
    }
    for (int i = 0; i < 3 * b.mesh->nnode; i++)
      if (dof[i / 3][i % 3] >= 0) force[i % 3] += r[dof[i / 3][i % 3]];
    double size = norm_max(b.n, r), power = fabs(e.power_dissipated) + fabs(e.power_external);
    for (int c = 0; c < 3; c++)
      assert_close((there[1].momentum[c] - there[0].momentum[c]) / (2 * dt), force[c], 0,
                   1e-6 * size);
    double stored[2];
    for (int side = 0; side < 2; side++) stored[side] = there[side].kinetic + there[side].elastic;
    assert_close((stored[1] - stored[0]) / (2 * dt), e.power_external - e.power_dissipated, 0,
                 1e-5 * power);
    assert_close(e.power_carried + (there[1].carried - there[0].carried) / (2 * dt),
                 e.power_supports, 0, 1e-5 * power);
    assert_true((e.carried != 0) == (k < 2)); /* at a constant rate */
    corot_mass_solver_destroy(solver);
    free(y), drop_body(&b);
  }
}

/* Energy that no work accounts for, over the work done, of a damped bar on the support, which is
   told of all kinks and, for no reason, to begin again; *u: its end. */
static double imbalance(const char *strain, const char *method, const corot_motion *motion,
                        double end[3]) {
  corot_box box = {.size = {0.1, 0.1, 0.3}, .cells = {1, 1, 3}, .origin = {-0.05, -0.05, 0}};
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  corot_material material = soft;
  material.damping_mass = 1, material.damping_lambda *= 10, material.damping_mu *= 10;
  corot_model_def model = corot_model_defaults();
  model.strain = strain, model.nmaterial = 1, model.material = &material;
  model.nmotion = 1, model.motion = motion, model.mass = COROT_MASS_CONSISTENT;
  body b = make_body(mesh, model);
  double *u = calloc(2 * b.n, sizeof *u), *v = u + b.n, dissipated, external;
  corot_integrator_def def = corot_integrator_defaults();
  def.method = method;
  if (corot_integrator_controls_error(method))
    def.rtol = 1e-6;
  else
    def.step = 1e-3;
  corot_integrator *integrator;
  corot_energies first, last;
  corot_state_enter(b.state, 0);
  assert_ok(corot_energy(b.model, b.state, 0, u, v, &first));
  assert_ok(corot_integrator_create(&def, b.model, b.state, 0, u, v, &integrator));
  const double stop[] = {0.1, 0.2, 0.3, 0.35, 0.4, 0.5};
  corot_step step = {0};
  for (int k = 0; k < 6; k++) {
    while (step.t < stop[k] - 1e-9) assert_ok(corot_integrator_step(integrator, stop[k], &step));
    if (k == 5) break;
    corot_state_enter(b.state, stop[k]);
    if (k == 2)
      assert_ok(corot_integrator_changed(integrator, COROT_HISTORY_RESTART));
    else
      assert_ok(corot_integrator_kink(integrator));
  }
  assert_ok(corot_integrator_at(integrator, step.t, u, v));
  assert_ok(corot_integrator_work(integrator, step.t, &dissipated, &external));
  assert_ok(corot_energy(b.model, b.state, step.t, u, v, &last));
  memcpy(end, u + b.n - 3, 3 * sizeof *end);
  corot_integrator_destroy(integrator), free(u), drop_body(&b);
  double stored = last.kinetic + last.elastic - first.kinetic - first.elastic;
  return fabs(stored + dissipated - external) / (last.kinetic + last.elastic + dissipated);
}

/* To the error of integration, which grows to a few times 1e-4 of the work at a tolerance of 1e-6;
   constant steps of 1e-3 s are a fortieth of the time in which the fastest of the bar's modes
   swings and, at order 2, leave some per cent of what a jolt of a support puts into these. The
   force of warp is not the gradient of an energy. */
static void every_method_closes_the_ledger(void **state) {
  (void)state;
  const corot_method_kind *method;
  for (int k = 0; k < NSUPPORT; k++)
    for (int s = 0; s < NMEASURE; s++) {
      const corot_strain_kind *strain = corot_strain_traits(s);
      double best[3], end[3], size;
      if (k % 3 != 0 && s != k % NMEASURE) continue; /* all with a jolted one and two others */
      imbalance(strain->name, "arkode", &supports[k].motion, best);
      size = norm_max(3, best);
      for (int i = 0; (method = corot_method_at(i)); i++) {
        bool euler = strcmp(method->name, "backward-euler") == 0;
        double off = imbalance(strain->name, method->name, &supports[k].motion, end);
        double worst = method->controls_error ? 3e-4 : euler ? 0.5 : 0.1;
        double apart = method->controls_error ? 3e-4 : euler ? 0.2 : 5e-3;
        if (!strain->frames || strain->polar) assert_below(off, worst);
        for (int c = 0; c < 3; c++) assert_close(end[c], best[c], 0, apart * size);
      }
    }
}

static corot_status make_model(void *context) {
  corot_material material = soft;
  material.damping_mass = 1;
  corot_model_def def = corot_model_defaults();
  def.mesh = context, def.nmaterial = 1, def.material = &material;
  def.mass = COROT_MASS_CONSISTENT, def.nmotion = 1;
  for (int k = 0; k < NSUPPORT; k++) {
    corot_model *model;
    def.motion = &supports[k].motion;
    COROT_TRY(corot_model_create(&def, &model));
    corot_model_destroy(model);
  }
  return COROT_OK;
}

static void failed_allocations_are_survived(void **state) {
  (void)state;
  corot_mesh *mesh = crooked_box(1, 1, 2);
  assert_true(assert_survives_failed_allocations(make_model, mesh) > 10 * NSUPPORT);
  corot_mesh_destroy(mesh);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(smooth_supports_drag_their_neighbours),
      cmocka_unit_test(ends_of_a_spline_are_kinks_of_the_drag),
      cmocka_unit_test(all_of_a_body_falls_alike),
      cmocka_unit_test(at_rest_nothing_drags),
      cmocka_unit_test(balances_hold_at_each_moment),
      cmocka_unit_test(every_method_closes_the_ledger),
      cmocka_unit_test(failed_allocations_are_survived),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
