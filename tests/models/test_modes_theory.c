/* Frequencies against theory: a bar along itself and in bending, with the orders in which they
   converge; a free box; a column as its load nears Euler's. */
#include <corot/modes.h>

#include "solution.h"
#include "strip.h"

static double first(const body *b, int at, double t, const double *u) {
  corot_modes *modes;
  corot_modes_def def = corot_modes_defaults();
  def.count = at + 1;
  assert_ok(corot_modes_find(&def, b->model, t, u, &modes));
  double lambda = corot_modes_at(modes, at).eigenvalue;
  corot_modes_destroy(modes);
  return lambda;
}

/* Of order 1 or 2, n cells along it, Poisson's ratio 0; sides hold what would bend it. */
static body make_bar(int order, int n, double length, double height, bool straight) {
  static const corot_material rod = {.mu = 5e5, .density = 1000};
  static const corot_fix fix[] = {{"xmin", {true, true, true}},
                                  {"ymin", {false, true, false}},
                                  {"ymax", {false, true, false}},
                                  {"zmin", {false, false, true}},
                                  {"zmax", {false, false, true}}};
  corot_box box = {.size = {length, height, height}, .cells = {n, 1, 1}};
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = &rod;
  def.nfix = straight ? 5 : 1, def.fix = fix;
  def.mass = COROT_MASS_CONSISTENT;
  return make_body(given_order(mesh, order), def);
}

/* w = pi / (2 L) sqrt(E / rho): the error of w^2, which consistent mass makes too high, is of order
   2 p for elements of order p: 2 and 4, seen within 0.1 from 8 to 16 and 32 elements along it. */
static void a_bar_sounds_along_itself_with_the_textbook_order(void **state) {
  (void)state;
  double exact = pi * pi / 4 * 1000;
  for (int order = 1; order <= 2; order++) {
    double error[3];
    for (int k = 0; k < 3; k++) {
      body b = make_bar(order, 8 << k, 1, 0.25, true);
      error[k] = first(&b, 0, 0, NULL) / exact - 1;
      assert_above(error[k], 0);
      drop_body(&b);
    }
    for (int k = 0; k < 2; k++) assert_close(log2(error[k] / error[k + 1]), 2 * order, 0, 0.1);
  }
}

/* w^2 of a clamped beam of length 10 h, with E / G = 2 and a shear coefficient of 5/6, is 0.98703
   of Euler and Bernoulli's by Timoshenko's equations (by shooting), whose own error is of order
   (h/L)^4, some 1e-4, and 1e-3 of the clamped end, which holds the section's warping, too. Ten-node
   tets come near with an order of 2 at least, for the corners of the clamped end are singular;
   linear tets lock: on 8 cells along it they are more than twice too stiff. */
static void a_cantilever_bends_as_timoshenkos_beam(void **state) {
  (void)state;
  double L = 10, EI = 1e6 / 12, k = 1.87510406871196, beam = pow(k / L, 4) * EI / 1000;
  body b = make_bar(2, 40, L, 1, false);
  double fine = first(&b, 0, 0, NULL);
  drop_body(&b);
  assert_close(fine / beam, 0.98703, 0.002, 0);
  double error[2];
  for (int i = 0; i < 2; i++) {
    b = make_bar(2, 5 << i, L, 1, false);
    error[i] = first(&b, 0, 0, NULL) / fine - 1;
    drop_body(&b);
  }
  assert_above(log2(error[0] / error[1]), 2);
  b = make_bar(1, 8, L, 1, false);
  assert_above(first(&b, 0, 0, NULL) / fine, 2);
  drop_body(&b);
}

/* A free cube has modes in closed form (Lame): u = (sin(pi x) cos(pi y), -cos(pi x) sin(pi y), 0)
   and the like in the other planes, from a corner as origin, has no divergence and no traction on
   the faces, and w^2 = 2 mu pi^2 / (rho L^2). Elements of 1/2 and 1/4 are off by 2.5 % and 0.4 %.
 */
static void a_free_cube_has_lames_modes(void **state) {
  (void)state;
  static const corot_material cube = {.lambda = 1e4, .mu = 1e4, .density = 1000};
  double exact = 2 * 10 * pi * pi, error[2];
  for (int i = 0; i < 2; i++) {
    corot_box box = {.size = {1, 1, 1}, .cells = {2 << i, 2 << i, 2 << i}};
    corot_mesh *mesh;
    assert_ok(corot_mesh_box(&box, &mesh));
    corot_model_def def = corot_model_defaults();
    def.nmaterial = 1, def.material = &cube;
    body b = make_body(given_order(mesh, 2), def);
    corot_modes *modes;
    corot_modes_def how = corot_modes_defaults();
    how.count = 24;
    assert_ok(corot_modes_find(&how, b.model, 0, NULL, &modes));
    for (int k = 0; k < 6; k++) assert_true(corot_modes_at(modes, k).frequency == 0);
    assert_above(corot_modes_at(modes, 6).frequency, 1);
    double nearest = INFINITY;
    for (int k = 6; k < 24; k++) {
      double off = fabs(corot_modes_at(modes, k).eigenvalue / exact - 1);
      if (off < nearest) nearest = off;
    }
    error[i] = nearest;
    corot_modes_destroy(modes), drop_body(&b);
  }
  assert_below(error[1], 5e-3);
  assert_above(log2(error[0] / error[1]), 2.5); /* on the way to 4 */
}

/* A column of length 20 h between hinges, which vibrates and buckles in the same half wave, pressed
   by `load` times Euler's pi^2 E I / L^2. */
static body make_column(const char *strain, double load) {
  const double L = 20, width = 1, E = 1e6, I = width / 12;
  const corot_material rod = {.mu = E / 2, .density = 1000};
  const corot_fix fix[] = {{"xmin", {false, true, false}},
                           {"xmax", {false, true, false}},
                           {"hinge", {true, true, false}},
                           {"zmin", {false, false, true}},
                           {"zmax", {false, false, true}}};
  const corot_load press = {
      COROT_TRACTION, "xmax", {-load * pi * pi * E * I / (L * L * width)}, {0}};
  corot_box box = {.size = {L, 1, width}, .cells = {20, 2, 1}};
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  mesh = given_order(mesh, 2);
  const double low[] = {-0.01, 0.49, -1}, high[] = {0.01, 0.51, 2};
  assert_ok(corot_mesh_group_box(mesh, "hinge", low, high, 0));
  corot_model_def def = corot_model_defaults();
  def.strain = strain;
  def.nmaterial = 1, def.material = &rod, def.nfix = 5, def.fix = fix;
  def.nload = 1, def.load = &press;
  return make_body(mesh, def);
}

/* w^2 falls in proportion to the load, is zero where it buckles, and beyond it is a growth rate,
   for every measure whose stiffness has the stress's part. The line of the loads 0 and 0.3 meets
   zero at Euler's load, but for the shear, which takes 12/5 pi^2/12 (h/L)^2 = 0.5 %, and the
   column's being shorter and thicker by as much. */
static void a_loaded_column_falls_silent_at_eulers_load(void **state) {
  (void)state;
  static const char *const strain[] = {"polar", "hybrid", "green"};
  for (int m = 0; m < 3; m++) {
    double square[5];
    for (int k = 0; k < 5; k++) { /* 0, 0.3, 0.6, 0.9, 1.2 of Euler's load */
      body b = make_column(strain[m], 0.3 * k);
      double *u = calloc(b.n, sizeof *u);
      corot_statics_def def = corot_statics_defaults();
      def.follow_unstable = k == 4;
      corot_statics *s = begin(&b, &def);
      assert_ok(corot_statics_solve(s));
      corot_statics_at(s, u);
      square[k] = first(&b, 0, 1, u);
      corot_statics_destroy(s), free(u), drop_body(&b);
    }
    double critical = 0.3 * square[0] / (square[0] - square[1]);
    assert_close(critical, 1, 0.015, 0);
    for (int k = 2; k < 5; k++)
      assert_close(square[k] / square[0], 1 - 0.3 * k / critical, 0, 0.01);
    assert_above(square[3], 0);
    assert_below(square[4], 0);
  }
}

int main(void) {
  if (!corot_modes_available()) return 77;
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_bar_sounds_along_itself_with_the_textbook_order),
      cmocka_unit_test(a_cantilever_bends_as_timoshenkos_beam),
      cmocka_unit_test(a_free_cube_has_lames_modes),
      cmocka_unit_test(a_loaded_column_falls_silent_at_eulers_load),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
