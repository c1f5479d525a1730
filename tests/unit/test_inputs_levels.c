/* What comes in while a run goes on, in hierarchical models. */
#include <corot/inputs.h>

#include "feedback.h"
#include "hierarchical.h"

static const choice choices[] = {
    {"green", "polar", 1, 0, true, false},
    {"green", "polar", 2, 1, true, false},
    {"polar", "cauchy", 1, 1, true, true},
};
enum { NCHOICE = sizeof choices / sizeof *choices };

static double off(int n, const double *a, const double *b) {
  double most = 0;
  for (int i = 0; i < n; i++) most = fmax(most, fabs(a[i] - b[i]));
  return most;
}

/* Every term has the other coefficients. */
static void factors_make_the_materials_of_another_model(void **state) {
  const corot_material_factors factors = {2, 0.5, 3, 4};
  corot_material other = soft;
  other.lambda *= 2, other.mu *= 0.5, other.damping_lambda *= 3, other.damping_mu *= 4;
  for (int k = 0; k < NCHOICE; k++) {
    solid s = make_solid(&choices[k], coupling_of(state), &soft, true);
    solid scaled = make_solid(&choices[k], coupling_of(state), &other, true);
    corot_inputs *in;
    double *u = calloc(6 * s.n, sizeof *u), *v = u + s.n, *r[] = {v + s.n, v + 2 * s.n};
    double *jv[] = {v + 3 * s.n, v + 4 * s.n};
    corot_energies e, d;
    assert_ok(corot_inputs_create(s.model, &in));
    assert_ok(corot_state_use_inputs(s.state, in));
    assert_ok(corot_inputs_set_material(in, 0, &factors));
    bend(&s, 0.3, 0.01, u), bend(&s, 0.1, 0.5, v);
    assert_ok(corot_residual(s.model, s.state, 0, u, v, r[0]));
    assert_ok(corot_residual(scaled.model, scaled.state, 0, u, v, r[1]));
    assert_below(off(s.n, r[0], r[1]), 1e-12 * norm_max(s.n, r[0]));
    assert_ok(corot_jvp(s.model, s.state, 0, u, v, COROT_TANGENT_EXACT, v, v, jv[0]));
    assert_ok(corot_jvp(scaled.model, scaled.state, 0, u, v, COROT_TANGENT_EXACT, v, v, jv[1]));
    assert_below(off(s.n, jv[0], jv[1]), 1e-12 * norm_max(s.n, jv[0]));
    assert_ok(corot_energy(s.model, s.state, 0, u, v, &e));
    assert_ok(corot_energy(scaled.model, scaled.state, 0, u, v, &d));
    assert_close(e.elastic, d.elastic, 1e-11, 0);
    assert_close(e.power_dissipated, d.power_dissipated, 1e-11, 0);
    free(u);
    drop_solid(&s), drop_solid(&scaled);
    corot_inputs_destroy(in);
  }
}

/* The feedback's own part of the derivative is what the plain model has of it. */
static void a_feedback_is_that_of_its_nodes(void **state) {
  for (int k = 0; k < NCHOICE; k++) {
    solid s = make_solid(&choices[k], coupling_of(state), &soft, true);
    corot_inputs *in;
    tie of = {.node = {s.mesh->tet[3][0], s.mesh->tet[3][1]}, .k = 300, .q = 2e3, .c = 4};
    corot_feedback feedback = feedback_of_tie(&of, false);
    double *u = calloc(9 * s.n, sizeof *u), *v = u + s.n, *y = v + s.n, *rate = v + 6 * s.n;
    double *jv[] = {v + 2 * s.n, v + 3 * s.n}, *r = v + 4 * s.n, *fd = v + 5 * s.n;
    const double h = 1e-4;
    assert_ok(corot_inputs_create(s.model, &in));
    assert_ok(corot_state_use_inputs(s.state, in));
    bend(&s, 0.3, 0.01, u), bend(&s, 0.1, 0.5, v);
    for (int with = 0; with < 2; with++) {
      assert_ok(corot_inputs_set_feedback(in, with ? &feedback : NULL));
      assert_ok(corot_jvp(s.model, s.state, 0, u, v, COROT_TANGENT_EXACT, v, v, jv[with]));
      for (int side = -1; side <= 1; side += 2) { /* along (v, v), u and v at once */
        for (int i = 0; i < s.n; i++) y[i] = u[i] + side * h * v[i];
        for (int i = 0; i < s.n; i++) rate[i] = (1 + side * h) * v[i];
        assert_ok(corot_residual(s.model, s.state, 0, y, rate, r));
        for (int i = 0; i < s.n; i++) fd[i] += (with ? 1 : -1) * side * r[i] / (2 * h);
      }
    }
    for (int i = 0; i < s.n; i++) jv[1][i] -= jv[0][i];
    assert_true(norm_max(s.n, fd) > 10);
    /* of second order in h, and what cancels is of the solid */
    assert_below(off(s.n, jv[1], fd), 1e-4 * norm_max(s.n, fd));
    free(u);
    drop_solid(&s);
    corot_inputs_destroy(in);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      each_coupling_unit_test(factors_make_the_materials_of_another_model),
      each_coupling_unit_test(a_feedback_is_that_of_its_nodes),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
