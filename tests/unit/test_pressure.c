/* What loads do to a body that deforms: forces of a pressure all around, power, work, amplitudes.
 */
#include <corot/integrate.h>

#include "solid.h"

static corot_mesh *closed_box(void) { /* with all of the boundary as one group */
  corot_mesh *mesh = crooked_box(2, 2, 2);
  int *node = malloc(mesh->nnode * sizeof *node);
  for (int n = 0; n < mesh->nnode; n++) node[n] = n;
  assert_ok(corot_mesh_group_nodes(mesh, "skin", mesh->nnode, node));
  assert_int_equal(corot_mesh_find_group(mesh, "skin")->ntri, 6 * 4 * 2);
  free(node);
  return mesh;
}

static body loaded_box(int nload, const corot_load *load) {
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = &soft;
  def.nload = nload, def.load = load;
  return make_body(closed_box(), def);
}

/* A free body has the degree of freedom 3n + c. */
static void crumple(int n, double size, double *a) {
  uint64_t seed = 19;
  int order = order_of_test(); /* the nodes are as much closer */
  for (int i = 0; i < n; i++) a[i] = size / (order * order) * noise(&seed);
}

static double volume_of(const corot_mesh *mesh, const double *u) {
  double sum = 0;
  if (mesh->mid) { /* the mesh measures itself, by a rule that is exact */
    corot_mesh *moved;
    assert_ok(corot_mesh_copy(mesh, &moved));
    for (int i = 0; i < 3 * mesh->nnode; i++) moved->x[i / 3][i % 3] += u[i];
    sum = corot_mesh_measure(moved).volume;
    corot_mesh_destroy(moved);
    return sum;
  }
  for (int e = 0; e < mesh->ntet; e++) {
    double edge[9];
    for (int a = 0; a < 3; a++)
      for (int c = 0; c < 3; c++) {
        int n = mesh->tet[e][a + 1], o = mesh->tet[e][0];
        edge[3 * a + c] = mesh->x[n][c] + u[3 * n + c] - mesh->x[o][c] - u[3 * o + c];
      }
    sum += determinant(edge) / 6;
  }
  return sum;
}

/* The load alone: the residual less that of a body without. */
static void load_force(const body *b, double t, const double *u, double *f) {
  body bare = loaded_box(0, NULL);
  double *zero = calloc(2 * b->n, sizeof *zero), *internal = zero + b->n;
  assert_ok(corot_residual(b->model, b->state, t, u, zero, f));
  assert_ok(corot_residual(bare.model, bare.state, t, u, zero, internal));
  for (int i = 0; i < b->n; i++) f[i] -= internal[i];
  free(zero), drop_body(&bare);
}

/* The surface of a crumpled body is closed still: neither force nor moment, to the rounding of
   forces of p times 0.1 m^2 on 26 nodes. */
static void pressure_on_a_closed_surface_has_no_resultant(void **state) {
  (void)state;
  double p = 1e6, sum[6] = {0};
  corot_load load = {COROT_PRESSURE, "skin", {p}, {0, NULL, NULL}};
  body b = loaded_box(1, &load);
  double *u = malloc(2 * b.n * sizeof *u), *f = u + b.n;
  crumple(b.n, 0.1, u);
  load_force(&b, 0, u, f);
  assert_above(norm_max(b.n, f), 0.05 * p);
  for (int n = 0; n < b.mesh->nnode; n++)
    for (int c = 0; c < 3; c++) {
      int i = (c + 1) % 3, j = (c + 2) % 3;
      double xi = b.mesh->x[n][i] + u[3 * n + i], xj = b.mesh->x[n][j] + u[3 * n + j];
      sum[c] += f[3 * n + c];
      sum[3 + c] += xi * f[3 * n + j] - xj * f[3 * n + i];
    }
  assert_below(norm_max(6, sum), 26 * 1e-16 * p);
  free(u), drop_body(&b);
}

/* -p dV/dt. The volume is a cubic in time here, of which five points give the derivative; rounding
   of volumes of one over h remains. */
static void power_of_a_pressure_is_that_of_the_volume(void **state) {
  (void)state;
  double p = 300, h = 1e-2;
  corot_load load = {COROT_PRESSURE, "skin", {p}, {0, NULL, NULL}};
  body b = loaded_box(1, &load);
  double *u = malloc(3 * b.n * sizeof *u), *v = u + b.n, *w = v + b.n, rate = 0;
  const double weight[] = {1. / 12, -2. / 3, 0, 2. / 3, -1. / 12};
  crumple(2 * b.n, 0.1, u);
  for (int k = -2; k <= 2; k++) {
    for (int i = 0; i < b.n; i++) w[i] = u[i] + k * h * v[i];
    rate += weight[k + 2] * volume_of(b.mesh, w) / h;
  }
  corot_energies e;
  assert_ok(corot_energy(b.model, b.state, 0, u, v, &e));
  assert_close(e.power_external, -p * rate, 0, p * 1e-15 / h);
  assert_above(fabs(e.power_external), 1e6 * p * 1e-15 / h); /* so that six digits are right */
  free(u), drop_body(&b);
}

/* f_i = -p dV/du_i at a crumpled state, in directions at random: V is a cubic along each. */
static void pressure_is_minus_the_gradient_of_the_volume(void **state) {
  (void)state;
  double p = 300, h = 1e-2;
  corot_load load = {COROT_PRESSURE, "skin", {p}, {0, NULL, NULL}};
  const double weight[] = {1. / 12, -2. / 3, 0, 2. / 3, -1. / 12};
  body b = loaded_box(1, &load);
  double *u = malloc(4 * b.n * sizeof *u), *f = u + b.n, *du = f + b.n, *w = du + b.n;
  uint64_t seed = 43;
  crumple(b.n, 0.1, u);
  load_force(&b, 0, u, f);
  for (int repeat = 0; repeat < 10; repeat++) {
    double rate = 0;
    for (int i = 0; i < b.n; i++) du[i] = 0.1 * noise(&seed);
    for (int k = -2; k <= 2; k++) {
      for (int i = 0; i < b.n; i++) w[i] = u[i] + k * h * du[i];
      rate += weight[k + 2] * volume_of(b.mesh, w) / h;
    }
    assert_close(inner(b.n, f, du), -p * rate, 0, p * 1e-14 / h); /* rounding of volumes over h */
  }
  free(u), drop_body(&b);
}

/* Blown up from rest by a pressure from within, the box takes up p (V - V0); pulled by a force on
   one side besides, F times the way of that side's middle. */
static void work_is_that_of_the_way(void **state) {
  (void)state;
  double p = 2e4, F[3] = {300, -200, 500}, t_end = 0.2;
  corot_load load[2] = {{COROT_PRESSURE, "skin", {-p}, {0, NULL, NULL}},
                        {COROT_FORCE, "zmax", {F[0], F[1], F[2]}, {0, NULL, NULL}}};
  body b = loaded_box(2, load);
  double *u = calloc(2 * b.n, sizeof *u), *v = u + b.n, dissipated, external;
  corot_integrator_def def = corot_integrator_defaults();
  corot_integrator *integrator;
  corot_energies e;
  def.rtol = 1e-7;
  assert_ok(corot_integrator_create(&def, b.model, b.state, 0, u, v, &integrator));
  for (corot_step step = {0}; step.t < t_end;)
    assert_ok(corot_integrator_step(integrator, t_end, &step));
  assert_ok(corot_integrator_at(integrator, t_end, u, v));
  assert_ok(corot_integrator_work(integrator, t_end, &dissipated, &external));
  double work = p * (volume_of(b.mesh, u) - corot_mesh_measure(b.mesh).volume);
  const corot_group *side = corot_mesh_find_group(b.mesh, "zmax");
  for (int i = 0; i < side->nnode; i++)
    for (int c = 0; c < 3; c++) work += F[c] * u[3 * side->node[i] + c] / side->nnode;
  assert_close(external, work, 1e-4, 0);
  assert_ok(corot_energy(b.model, b.state, t_end, u, v, &e));
  assert_close(e.kinetic + e.elastic + dissipated, work, 1e-4, 0);
  assert_above(work, 100);
  corot_integrator_destroy(integrator), free(u), drop_body(&b);
}

/* Linear between its points, constant beyond; the same for every load. */
static void loads_follow_their_amplitude(void **state) {
  (void)state;
  const double time[] = {1, 2, 4}, value[] = {0.5, -1, 0};
  const struct {
    double t, factor;
  } at[] = {{-3, 0.5}, {1, 0.5}, {1.5, -0.25}, {2, -1}, {3.5, -0.25}, {4, 0}, {9, 0}};
  static const corot_load kinds[] = {{COROT_PRESSURE, "skin", {1e5}, {0, NULL, NULL}},
                                     {COROT_FORCE, "zmax", {3e4, 2e4, 1e4}, {0, NULL, NULL}},
                                     {COROT_TRACTION, "xmin", {3e4, 2e4, 1e4}, {0, NULL, NULL}},
                                     {COROT_GRAVITY, NULL, {10, 20, 30}, {0, NULL, NULL}}};
  for (int k = 0; k < 4; k++) {
    corot_load load = kinds[k];
    body steady = loaded_box(1, &load);
    load.amplitude = (corot_amplitude){3, time, value};
    body b = loaded_box(1, &load);
    double *u = malloc(3 * b.n * sizeof *u), *f = u + b.n, *one = f + b.n;
    crumple(b.n, 0.05, u);
    load_force(&steady, 0, u, one);
    for (size_t i = 0; i < sizeof at / sizeof *at; i++) {
      load_force(&b, at[i].t, u, f);
      for (int j = 0; j < b.n; j++) assert_close(f[j], at[i].factor * one[j], 0, 1e-10);
    }
    double kink[4];
    assert_int_equal(corot_model_kinks(b.model, 0, 10, 4, kink), 3);
    assert_true(kink[0] == 1 && kink[1] == 2 && kink[2] == 4);
    free(u), drop_body(&b), drop_body(&steady);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(pressure_on_a_closed_surface_has_no_resultant),
      cmocka_unit_test(power_of_a_pressure_is_that_of_the_volume),
      cmocka_unit_test(pressure_is_minus_the_gradient_of_the_volume),
      cmocka_unit_test(work_is_that_of_the_way),
      cmocka_unit_test(loads_follow_their_amplitude),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
