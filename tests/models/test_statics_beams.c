/* Slender bodies against theory: the elastica, and the column of Euler. Linear tets are too stiff
   in bending, by a part that falls with the square of their size. */
#include "strip.h"

/* Mean displacement of the tip over the length; along and across. */
static void bend(strip_def of, double tip[2]) {
  body b = strip_create(&of);
  corot_statics_def def = corot_statics_defaults();
  corot_statics *s = begin(&b, &def);
  double *u = malloc(b.n * sizeof *u);
  assert_ok(corot_statics_solve(s));
  corot_statics_at(s, u);
  strip_tip(&b, u, tip);
  free(u);
  corot_statics_destroy(s);
  drop_body(&b);
}

/* Cantilever with a dead load P at its tip, alpha = P L^2 / (E I) (Bisshopp & Drucker 1945;
   Mattiasson 1981): deflection and shortening over L. The strip is 20 times as long as high and,
   unlike the elastica, gives way to shear, alpha (h/L)^2 / 5 of its length, and to stretch. */
static const struct {
  double alpha, down, back;
} table[] = {{1, 0.301721, 0.056433}, {2, 0.493457, 0.160642}, {4, 0.669964, 0.328941}};

static void the_elastica_is_approached(void **state) {
  (void)state;
  const char *exact[] = {"polar", "green"};
  for (int m = 0; m < 2; m++)
    for (int k = 0; k < 3; k++) {
      double tip[3][2];
      for (int f = 0; f < 3; f++) {
        strip_def of = {exact[m], 20, {80 << f, 4 << f}, {0, table[k].alpha}, 0};
        bend(of, tip[f]);
      }
      double theory[2] = {-table[k].back, table[k].down};
      /* What extrapolation leaves is shear and stretch. */
      double slack = table[k].alpha / (5 * 20 * 20);
      for (int c = 0; c < 2; c++) {
        double coarse = fabs(theory[c] - tip[0][c]), middle = fabs(theory[c] - tip[1][c]);
        double fine = fabs(theory[c] - tip[2][c]);
        double limit = tip[2][c] + (tip[2][c] - tip[1][c]) / 3;
        assert_above(coarse / middle, 3.2);
        assert_above(middle / fine, 3.8);
        assert_close(limit, theory[c], 0, 1.2 * slack);
      }
      assert_above(tip[2][1] + (tip[2][1] - tip[1][1]) / 3, theory[1] + 0.5 * slack);
    }
}

/* Ten-node tets are there with one cell across and twenty along; what is left is shear and stretch,
   of which the first alone is `slack`. */
static void ten_node_tets_are_at_the_elastica(void **state) {
  (void)state;
  const char *exact[] = {"polar", "green"};
  for (int m = 0; m < 2; m++)
    for (int k = 0; k < 3; k++) {
      strip_def of = {exact[m], 20, {20, 1}, {0, table[k].alpha}, .order = 2};
      double tip[2], slack = table[k].alpha / (5 * 20 * 20);
      bend(of, tip);
      assert_close(tip[0], -table[k].back, 0, 2 * slack);
      assert_close(tip[1], table[k].down, 0, 2 * slack);
    }
}

/* The load, over Euler's pi^2 E I / (4 L^2), at which a clamped column loses its stability. */
static double buckling_load(const char *strain, int fineness, const corot_linear_def *linear) {
  const double euler = 2.4674011002723395, pressed = 1.6;
  strip_def of = {strain, 20, {40 << fineness, 2 << fineness}, {-pressed * euler, 0}, 0};
  body b = strip_create(&of);
  corot_statics_def def = corot_statics_defaults();
  if (linear) def.linear = *linear;
  corot_statics *s = begin(&b, &def);
  double below, above;
  assert_fails(corot_statics_solve(s), COROT_EINTEGRATE, "buckling");
  corot_statics_critical(s, &below, &above);
  assert_close(corot_statics_at(s, NULL), below, 0, 0);
  assert_true(below < above && above - below <= 1e-3 * above);
  corot_statics_destroy(s);
  drop_body(&b);
  return pressed * above;
}

static void a_column_buckles_under_eulers_load(void **state) {
  (void)state;
  for (int m = 0; m < NSTRAIN; m++) {
    if (!conserves(m)) continue;
    double coarse = buckling_load(measures[m], 1, NULL), fine = buckling_load(measures[m], 2, NULL);
    assert_true(coarse > fine && fine > 1 && fine < 1.06);
    assert_close(fine - (coarse - fine) / 3, 1, 5e-3, 0);
  }
}

/* Conjugate gradients lose stability where a direct solver does: at load factors of the same
   halves. Below, what they find is stable, and they say so. */
static void iterations_see_the_buckling(void **state) {
  (void)state;
  static const char *const preconditioners[] = {"block-jacobi", "incomplete-cholesky", "amg"};
  double load = buckling_load("polar", 1, NULL);
  strip_def of = {"polar", 20, {40, 2}, {-2, 0}, 0}; /* of pi^2 / 4 */
  body b = strip_create(&of);
  for (int k = 0; k < 3; k++) {
    corot_statics_def def = corot_statics_defaults();
    corot_load_step step;
    def.linear.solver = "pcg", def.linear.preconditioner = preconditioners[k];
    assert_close(buckling_load("polar", 1, &def.linear), load, 0, 1e-12);
    corot_statics *s = begin(&b, &def);
    assert_ok(corot_statics_step(s, &step));
    assert_int_equal(step.stability, COROT_STABLE);
    corot_statics_destroy(s);
  }
  drop_body(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_elastica_is_approached),
      cmocka_unit_test(ten_node_tets_are_at_the_elastica),
      cmocka_unit_test(a_column_buckles_under_eulers_load),
      cmocka_unit_test(iterations_see_the_buckling),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
