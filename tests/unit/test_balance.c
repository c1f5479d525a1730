/* The balance of forces at all nodes: what supports hold the body with is what loads and inertia
   leave. */
#include <corot/solve.h>

#include "solid.h"

static const double times[] = {0, 0.4, 1}, values[] = {0, 1, -0.5};

/* Supports of zmin. */
static const corot_motion supports[] = {
    {COROT_ROTATE, "zmin", {1, 2, 3}, {0.1, -0.2, 0.05}, 0.1, {0}, 0, 2},
    {COROT_TRANSLATE, "zmin", {0}, {0}, 0, {0.03, -0.04, 0.02}, 0, 2},
    {.kind = COROT_MOVE,
     .group = "zmin",
     .direction = {0.007, 0.004, -0.01},
     .amplitude = {.curve = COROT_CURVE_SINE, .frequency = 2}},
    {.kind = COROT_TURN,
     .group = "zmin",
     .axis = {1, 2, 3},
     .center = {0.1, -0.2, 0.05},
     .angle = 0.05,
     .amplitude = {3, times, values, COROT_CURVE_SMOOTH}},
};
enum { NSUPPORT = sizeof supports / sizeof *supports };

static const corot_load loads[] = {
    {COROT_TRACTION, "zmax", {200, -30, 50}, {3, times, values}},
    {COROT_GRAVITY, NULL, {1, 2, -9.81}, {0}},
    {COROT_PRESSURE, "xmax", {300}, {0}},
    {COROT_FORCE, "zmin", {3, 2, 1}, {0}}, /* on held nodes alone */
};
static const corot_load weight = {COROT_GRAVITY, NULL, {1, 0, 0}, {0}};

/* A bar whose base is fixed (support -1) or moves. */
static body bar(const char *strain, corot_mass mass, int support, const corot_load *load,
                int nload) {
  corot_box box = {.size = {0.1, 0.1, 0.3}, .cells = {1, 1, 3}, .split = COROT_BOX_SYMMETRIC};
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  corot_material material = soft;
  material.damping_mass = 3;
  corot_fix fix[] = {{"zmin", {true, true, true}}, {"zmax", {false, true, false}}};
  corot_model_def def = corot_model_defaults();
  def.strain = strain, def.mass = mass;
  def.nmaterial = 1, def.material = &material;
  def.nfix = support < 0 ? 2 : 0, def.fix = fix;
  def.nmotion = support < 0 ? 0 : 1, def.motion = support < 0 ? NULL : &supports[support];
  def.nload = nload, def.load = load;
  return make_body(of_order(mesh), def);
}

typedef struct fields {
  double *u, *v, *a;
  double (*x)[3], (*velocity)[3], (*acceleration)[3], (*mass)[3], (*damped)[3];
  corot_nodal_forces f;
} fields;

static double (*nodal(const body *b))[3] {
  double(*f)[3] = calloc(b->mesh->nnode, sizeof *f);
  assert_non_null(f);
  return f;
}

/* A strained body in motion at t, its free acceleration by M a = r. */
static fields move(const body *b, double t) {
  fields s = {.u = calloc(3 * b->n, sizeof *s.u)};
  corot_mass_solver *solver;
  uint64_t seed = 17;
  s.v = s.u + b->n, s.a = s.v + b->n;
  for (int i = 0; i < b->n; i++) s.u[i] = 0.0015 * noise(&seed), s.v[i] = 0.3 * noise(&seed);
  corot_state_enter(b->state, t);
  assert_ok(corot_residual(b->model, b->state, t, s.u, s.v, s.a));
  assert_ok(corot_mass_solver_create(b->model, &solver));
  assert_ok(corot_mass_solve(solver, s.a, s.a));
  corot_mass_solver_destroy(solver);
  s.x = nodal(b), s.velocity = nodal(b), s.acceleration = nodal(b), s.mass = nodal(b);
  s.f = (corot_nodal_forces){nodal(b), nodal(b), nodal(b), nodal(b)};
  assert_ok(corot_forces(b->model, b->state, t, s.u, s.v, s.a, &s.f));
  corot_nodal(b->model, t, s.u, s.v, s.x, NULL);
  corot_nodal_motion(b->model, b->state, t, s.v, s.a, s.velocity, s.acceleration);
  return s;
}

static void drop(fields *s) {
  free(s->u), free(s->x), free(s->velocity), free(s->acceleration), free(s->mass);
  free(s->f.internal), free(s->f.viscous), free(s->f.inertial), free(s->f.load);
}

static double reaction(const fields *s, int n, int c) {
  return s->f.internal[n][c] + s->f.viscous[n][c] + s->f.inertial[n][c] - s->f.load[n][c];
}

/* On free components there is none; and with the loads the reactions accelerate the body:

     sum reaction + sum load = sum m (a + damping v),   m the row sums of the mass,

   and the same of moments about the origin where the internal forces are those of an energy, and
   the viscous law is objective. Tolerance: rounding of sums of some hundred forces. */
static void check(int k, corot_mass mass, int support) {
  body b = bar(measures[k], mass, support, loads, 4),
       of_mass = bar(measures[k], mass, support, &weight, 1);
  const int(*dof)[3] = corot_model_dof(b.model);
  double t = 0.3, force[3] = {0}, moment[3] = {0}, largest = 0;
  fields s = move(&b, t);
  assert_ok(corot_load_force(of_mass.model, t, 1, (const double(*)[3])s.x, s.mass));
  for (int n = 0; n < b.mesh->nnode; n++)
    for (int c = 0; c < 3; c++)
      largest = fmax(largest, fmax(fabs(s.f.internal[n][c]), fabs(s.f.inertial[n][c])));
  assert_true(largest > 1);
  for (int n = 0; n < b.mesh->nnode; n++)
    for (int c = 0; c < 3; c++) {
      double r = reaction(&s, n, c);
      if (dof[n][c] >= 0) assert_close(r, 0, 0, 1e-12 * largest);
      if (dof[n][c] < 0) force[c] += r;
      force[c] += s.f.load[n][c];
      force[c] -= s.mass[n][0] * (s.acceleration[n][c] + 3 * s.velocity[n][c]);
    }
  for (int c = 0; c < 3; c++) assert_close(force[c], 0, 0, 1e-11 * largest);

  for (int n = 0; n < b.mesh->nnode; n++)
    for (int c = 0; c < 3; c++) {
      int i = (c + 1) % 3, j = (c + 2) % 3;
      double at[2] = {b.mesh->x[n][i] + s.x[n][i], b.mesh->x[n][j] + s.x[n][j]};
      moment[c] += at[0] * s.f.internal[n][j] - at[1] * s.f.internal[n][i];
    }
  for (int c = 0; conserves(k) && c < 3; c++) assert_close(moment[c], 0, 0, 1e-12 * largest);
  drop(&s), drop_body(&b), drop_body(&of_mass);
}

static void reactions_balance_loads_and_inertia(void **state) {
  (void)state;
  for (int k = 0; k < NMEASURE; k++)
    for (int support = -1; support < NSUPPORT; support++)
      for (corot_mass mass = COROT_MASS_LUMPED; mass <= COROT_MASS_CONSISTENT; mass++)
        check(k, mass, support);
}

/* Of supports: by differences of the velocity, h^2/6 of its second derivative and rounding. */
static void supports_accelerate(void **state) {
  (void)state;
  for (int support = 0; support < NSUPPORT; support++) {
    body b = bar("polar", COROT_MASS_LUMPED, support, loads, 4);
    double t = 0.3, h = 1e-5, *zero = calloc(b.n, sizeof *zero);
    double(*before)[3] = nodal(&b), (*after)[3] = nodal(&b), (*a)[3] = nodal(&b);
    corot_nodal_motion(b.model, b.state, t - h, zero, NULL, before, NULL);
    corot_nodal_motion(b.model, b.state, t + h, zero, NULL, after, NULL);
    corot_nodal_motion(b.model, b.state, t, NULL, zero, NULL, a);
    for (int n = 0; n < b.mesh->nnode; n++)
      for (int c = 0; c < 3; c++)
        assert_close(a[n][c], (after[n][c] - before[n][c]) / (2 * h), 0, 1e3 * h * h + 1e-15 / h);
    free(zero), free(before), free(after), free(a), drop_body(&b);
  }
}

/* Parts that are not asked for one by one are together. */
static void internal_forces_have_the_viscous_ones(void **state) {
  (void)state;
  body b = bar("polar", COROT_MASS_AUTO, -1, loads, 4);
  fields s = move(&b, 0.3);
  double(*both)[3] = nodal(&b);
  assert_ok(
      corot_forces(b.model, b.state, 0.3, s.u, s.v, NULL, &(corot_nodal_forces){.internal = both}));
  for (int n = 0; n < b.mesh->nnode; n++)
    for (int c = 0; c < 3; c++)
      assert_close(both[n][c], s.f.internal[n][c] + s.f.viscous[n][c], 1e-12, 1e-12);
  free(both), drop(&s), drop_body(&b);
}

/* In statics there are the loads of another time, times a factor, and nothing moves. */
static void nothing_moves_in_statics(void **state) {
  (void)state;
  body b = bar("polar", COROT_MASS_AUTO, 2, loads, 4);
  fields s = move(&b, 0.3);
  double(*load)[3] = nodal(&b);
  corot_state_stand_still(b.state, 0.8, 0.5);
  assert_ok(corot_forces(b.model, b.state, 0.3, s.u, NULL, NULL, &s.f));
  assert_ok(corot_load_force(b.model, 0.8, 0.5, (const double(*)[3])s.x, load));
  corot_nodal_motion(b.model, b.state, 0.3, s.v, s.a, s.velocity, s.acceleration);
  for (int n = 0; n < b.mesh->nnode; n++)
    for (int c = 0; c < 3; c++) {
      assert_close(s.f.load[n][c], load[n][c], 0, 0);
      assert_true(s.f.inertial[n][c] == 0 && s.f.viscous[n][c] == 0);
      assert_true(s.velocity[n][c] == 0 && s.acceleration[n][c] == 0);
    }
  free(load), drop(&s), drop_body(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(reactions_balance_loads_and_inertia),
      cmocka_unit_test(supports_accelerate),
      cmocka_unit_test(internal_forces_have_the_viscous_ones),
      cmocka_unit_test(nothing_moves_in_statics),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
