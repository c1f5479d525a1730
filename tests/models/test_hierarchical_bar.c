/* The bar of Hauth & Strasser 2004, Example 3, on two levels below its 18 tets: bent by a force
   across its end that rises to 80 N/m^2 in two seconds. */
#include <corot/statics.h>

#include "hierarchical.h"
#include "solution.h"

static const corot_material rubber = {.lambda = 1500, /* mu = 1e3, nu = 0.3 */
                                      .mu = 1000,
                                      .density = 1000,
                                      .damping_lambda = 10,
                                      .damping_mu = 1};

/* `c` may be NULL: the plain polar model. */
static body make_bent(const choice *c, corot_coupling coupling) {
  int nlevel = c ? c->nlevel : 2;
  static const double time[] = {0, 2}, value[] = {0, 1};
  const corot_load load = {COROT_TRACTION, "zmax", {80, 0, 0}, {2, time, value}};
  const corot_box box = {.size = {0.1, 0.1, 0.3}, .cells = {1, 1, 3}};
  const choice plain = {.fine = "polar"};
  corot_mesh *coarse, *fine;
  corot_refinement *refinement;
  corot_hierarchy_def hierarchy;
  corot_model_def def = definition(c ? c : &plain, coupling, &rubber, true, &hierarchy);
  assert_ok(corot_mesh_box(&box, &coarse));
  assert_ok(corot_mesh_refine(coarse, nlevel, COROT_DIAGONAL_CONSISTENT, &fine, &refinement));
  hierarchy.refinement = refinement;
  if (!c) def.hierarchy = NULL;
  def.nload = 1, def.load = &load;
  body b = make_body(fine, def);
  corot_refinement_destroy(refinement);
  corot_mesh_destroy(coarse);
  return b;
}

/* From rest to time `end`; the value is that of the step that got there or did not. */
static corot_status move(const body *b, double rtol, double end, double *u) {
  double *zero = calloc(b->n, sizeof *zero);
  corot_integrator_def def = corot_integrator_defaults();
  corot_step step = {0};
  corot_status status = COROT_OK;
  def.rtol = rtol, def.max_order = 2;
  corot_integrator *integrator = start(b, &def, zero, zero);
  while (!status && step.t != end) status = corot_integrator_step(integrator, end, &step);
  if (!status) assert_ok(corot_integrator_at(integrator, end, u, zero));
  corot_integrator_destroy(integrator);
  free(zero);
  return status;
}

/* With green on level 0. Coupled by its nodes, these leave their surroundings, at 0.65 s. */
static void it_stands_the_load_where_means_couple(void **state) {
  (void)state;
  const choice c = {"green", "polar", 2, 0, true};
  body b = make_bent(&c, COROT_COUPLING_MEAN);
  double *u = vectors(1, b.n);
  assert_ok(move(&b, 1e-4, 3, u));
  assert_above(norm_max(b.n, u), 0.1); /* a third of the length */
  free(u);
  drop_body(&b);

  b = make_bent(&c, COROT_COUPLING_NODES);
  u = vectors(1, b.n);
  assert_fails(move(&b, 1e-4, 3, u), COROT_EINTEGRATE, "is inverted");
  free(u);
  drop_body(&b);
}

/* One way, level 0 moves as the mesh of level 0 does alone, and the detail holds on to it. */
static void one_way_it_bends_as_level_0_does(void **state) {
  (void)state;
  const choice c = {"green", "polar", 2, 0, true}, alone = {"green", "polar", 0, 0, true};
  body b = make_bent(&c, COROT_COUPLING_ONE_WAY), coarse = make_bent(&alone, means);
  double *u = vectors(2, b.n), *expected = u + b.n, error[2];
  for (int k = 0; k < 2; k++) {
    double rtol = k == 0 ? 1e-4 : 1e-6;
    assert_ok(move(&b, rtol, 3, u));
    assert_ok(move(&coarse, rtol, 3, expected));
    assert_above(norm_max(b.n, u), 0.05);
    for (int i = 0; i < coarse.n; i++) expected[i] -= u[i];
    error[k] = norm_max(coarse.n, expected) / norm_max(b.n, u);
  }
  assert_below(error[0], 1e-3); /* 4e-5: ten times the tolerance, which is for all nodes */
  assert_below(error[1], 5e-5); /* 1e-5 */
  free(u);
  drop_body(&coarse);
  drop_body(&b);
}

/* With polar on level 0 what is left is the error of the frames: about a third for each level from
   which they come. On the finest they are the plain model's, and its steps are taken again with
   other rounding. */
static void frames_of_finer_levels_come_closer(void **state) {
  corot_coupling coupling = coupling_of(state);
  body plain = make_bent(NULL, coupling);
  double *expected = vectors(2, plain.n), *u = expected + plain.n, error[3];
  assert_ok(move(&plain, 1e-5, 1.5, expected));
  for (int level = 0; level < 3; level++) {
    const choice c = {"polar", "polar", 2, level, true};
    body b = make_bent(&c, coupling);
    assert_ok(move(&b, 1e-5, 1.5, u));
    for (int i = 0; i < b.n; i++) u[i] -= expected[i];
    error[level] = norm_max(b.n, u) / norm_max(b.n, expected);
    drop_body(&b);
  }
  assert_below(error[0], 0.05);
  assert_below(error[1], 0.5 * error[0]);
  assert_below(error[2], 1e-8);
  free(expected);
  drop_body(&plain);
}

/* A twentieth of the load, by a matrix that is not the derivative and says nothing of stability. */
static void an_equilibrium_is_found(void **state) {
  const choice c = {"green", "polar", 2, 0, true};
  body b = make_bent(&c, coupling_of(state));
  corot_statics_def def = corot_statics_defaults();
  corot_statics *statics;
  corot_load_step step;
  assert_ok(corot_statics_create(&def, b.model, 0.1, NULL, &statics));
  assert_ok(corot_statics_step(statics, &step));
  assert_close(step.factor, 1, 0, 0);
  assert_int_equal(step.stability, COROT_STABILITY_UNKNOWN);
  corot_statics_destroy(statics);
  drop_body(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(it_stands_the_load_where_means_couple),
      cmocka_unit_test(one_way_it_bends_as_level_0_does),
      coupled_unit_test(frames_of_finer_levels_come_closer),
      each_coupling_unit_test(an_equilibrium_is_found),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
