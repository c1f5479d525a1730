/* Materials that change while a run goes on. */
#include <corot/inputs.h>
#include <corot/statics.h>

#include "alloc.h"
#include "live.h"

/* Of two materials, the one by the other. */
static const corot_material_factors factors[] = {{2, 0.5, 3, 0}, {0.7, 1.5, 0.1, 4}};

typedef struct kind {
  const char *strain;
  int order;
  corot_dilatation dilatation;
} kind;

/* A bar of two materials, held at its base; scaled: by the factors. */
static body make_mixed(const kind *of, bool scaled) {
  corot_box box = {.size = {0.1, 0.1, 0.3}, .cells = {1, 1, 4}, .split = COROT_BOX_SYMMETRIC};
  corot_mesh *mesh;
  corot_material material[2] = {soft, soft};
  assert_ok(corot_mesh_box(&box, &mesh));
  if (of->order == 2) mesh = given_order(mesh, 2);
  assert_ok(
      corot_mesh_group_box(mesh, "upper", (double[]){-1, -1, 0.15}, (double[]){1, 1, 1}, 1e-9));
  material[1].group = "upper", material[1].mu *= 2, material[1].damping_mass = 2;
  for (int k = 0; k < 2 && scaled; k++) {
    material[k].lambda *= factors[k].lambda, material[k].mu *= factors[k].mu;
    material[k].damping_lambda *= factors[k].damping_lambda;
    material[k].damping_mu *= factors[k].damping_mu;
  }
  corot_model_def def = corot_model_defaults();
  def.strain = of->strain, def.dilatation = of->dilatation;
  def.nmaterial = 2, def.material = material;
  def.nfix = 1, def.fix = &base;
  def.nload = 1, def.load = loads;
  return make_body(mesh, def);
}

static void scale_materials(corot_inputs *in) {
  for (int k = 0; k < 2; k++) assert_ok(corot_inputs_set_material(in, k, &factors[k]));
}

/* r, jvp, K, D, energies and fields, to rounding. */
static void assert_same_material(const body *a, const body *b) {
  const body *of[] = {a, b};
  int n = a->n, nblock = corot_model_nblock(a->model), ntet = a->mesh->ntet;
  double *u = some_motion(n, 1e-3), *d = some_motion(n, 1), *r[2], *jv[2], *stress[2];
  double(*K[2])[9], (*D[2])[9];
  corot_energies e[2];
  for (int k = 0; k < 2; k++) {
    const corot_model *m = of[k]->model;
    corot_state *s = of[k]->state;
    r[k] = malloc(2 * n * sizeof *u), jv[k] = r[k] + n, stress[k] = malloc(2 * ntet * sizeof *u);
    K[k] = malloc(2 * nblock * sizeof **K), D[k] = K[k] + nblock;
    corot_element_fields fields = {.von_mises = stress[k], .energy = stress[k] + ntet};
    assert_ok(corot_residual(m, s, 0.3, u, u + n, r[k]));
    assert_ok(corot_jvp(m, s, 0.3, u, u + n, COROT_TANGENT_EXACT, d, d + n, jv[k]));
    assert_ok(corot_jacobian(m, s, 0.3, u, u + n, COROT_TANGENT_EXACT, K[k], D[k]));
    assert_ok(corot_energy(m, s, 0.3, u, u + n, &e[k]));
    assert_ok(corot_elements(m, s, 0.3, u, &fields));
  }
  assert_below(difference_of(n, r[0], r[1]), 1e-12 * norm_max(n, r[0]));
  assert_below(difference_of(n, jv[0], jv[1]), 1e-12 * norm_max(n, jv[0]));
  assert_below(difference_of(9 * nblock, K[0][0], K[1][0]), 1e-12 * norm_max(9 * nblock, K[0][0]));
  assert_below(difference_of(9 * nblock, D[0][0], D[1][0]), 1e-12 * norm_max(9 * nblock, D[0][0]));
  assert_below(difference_of(2 * ntet, stress[0], stress[1]),
               1e-12 * norm_max(2 * ntet, stress[0]));
  assert_close(e[0].elastic, e[1].elastic, 1e-12, 0);
  assert_close(e[0].power_dissipated, e[1].power_dissipated, 1e-12, 0);
  for (int k = 0; k < 2; k++) free(r[k]), free(K[k]), free(stress[k]);
  free(u), free(d);
}

static void factors_make_the_materials_of_another_model(void **state) {
  (void)state;
  const corot_dilatation dilatations[] = {COROT_DILATATION_LOCAL, COROT_DILATATION_NODAL,
                                          COROT_DILATATION_ELEMENT};
  for (int m = 0; m < NMEASURE; m++)
    for (int order = 1; order <= 2; order++)
      for (int k = 0; k < 3; k++) {
        kind of = {measures[m], order, dilatations[k]};
        body other = make_mixed(&of, true), b = make_mixed(&of, false),
             plain = make_mixed(&of, false);
        corot_inputs *in = give_inputs(&b);
        scale_materials(in);
        assert_same_material(&other, &b);
        /* and its own again */
        for (int i = 0; i < 2; i++) assert_ok(corot_inputs_set_material(in, i, NULL));
        assert_same_material(&plain, &b);
        drop_body(&other), drop_body(&plain), drop_with(&b, in);
      }
}

static void what_makes_no_sense_is_refused(void **state) {
  (void)state;
  kind of = {"polar", 1, COROT_DILATATION_NODAL};
  body b = make_mixed(&of, false);
  corot_inputs *in = give_inputs(&b);
  double *u = some_motion(b.n, 1e-3), *r = malloc(2 * b.n * sizeof *r);
  assert_ok(corot_inputs_set_material(in, 0, &factors[0]));
  assert_ok(corot_residual(b.model, b.state, 0, u, u, r));
  const struct {
    int k;
    corot_material_factors by;
    const char *words;
  } bad[] = {
      {2, {1, 1, 1, 1}, "there is no material 2: the model has 2"},
      {-1, {1, 1, 1, 1}, "there is no material -1"},
      {0, {NAN, 1, 1, 1}, "no factor of lambda"},
      {0, {1, 0, 1, 1}, "0 is no factor of mu"},
      {0, {1, INFINITY, 1, 1}, "no factor of mu"},
      {0, {1, 1, -1, 1}, "no factor of damping_lambda"},
      {0, {1, 1, 1, NAN}, "no factor of damping_mu"},
      {0, {-1, 1, 1, 1}, "3 lambda + 2 mu must be > 0"},
  };
  for (size_t k = 0; k < sizeof bad / sizeof *bad; k++)
    assert_fails(corot_inputs_set_material(in, bad[k].k, &bad[k].by), COROT_EINVAL, bad[k].words);
  assert_ok(corot_residual(b.model, b.state, 0, u, u, r + b.n));
  assert_true(difference_of(b.n, r, r + b.n) == 0);
  free(u), free(r);
  drop_with(&b, in);
}

/* Of a lambda that the tets keep, as there is no more of it than mu, nothing can be averaged later.
 */
static void averages_do_not_begin(void **state) {
  (void)state;
  corot_material stiff = {.lambda = 1e4, .mu = 1e4, .density = 1000};
  corot_box box = {.size = {1, 1, 1}, .cells = {1, 1, 2}};
  corot_mesh *mesh;
  corot_inputs *in;
  assert_ok(corot_mesh_box(&box, &mesh));
  corot_model_def def = corot_model_defaults();
  def.dilatation = COROT_DILATATION_NODAL, def.nmaterial = 1, def.material = &stiff;
  body b = make_body(mesh, def);
  assert_ok(corot_inputs_create(b.model, &in));
  assert_fails(corot_inputs_set_material(in, 0, &(corot_material_factors){2, 1, 1, 1}),
               COROT_EINVAL, "would begin to be averaged");
  assert_ok(corot_inputs_set_material(in, 0, &(corot_material_factors){0.5, 1, 1, 1}));
  drop_with(&b, in);
}

/* Half way the bar gets stiffer and more damped: what that does to the strained body is external
   work, 4.6e-5 J, and with it the books close. */
static void the_books_close_over_a_change(void **state) {
  (void)state;
  for (int i = 0; corot_method_at(i); i++) {
    double missing[2], change = 0, start = 0;
    for (int changes = 0; changes < 2; changes++) {
      kind of = {"polar", 1, COROT_DILATATION_LOCAL};
      body b = make_mixed(&of, false);
      corot_inputs *in = give_inputs(&b);
      corot_integrator *integrator = integrate_by(i, &b, 1e-6);
      double *u = malloc(2 * b.n * sizeof *u), dissipated, external, before;
      corot_energies e;
      go_to(integrator, 0.05);
      assert_ok(corot_integrator_work(integrator, 0.05, &dissipated, &before));
      if (changes) {
        scale_materials(in);
        assert_ok(corot_integrator_changed(integrator, COROT_HISTORY_AUTO));
        assert_ok(corot_integrator_work(integrator, 0.05, &dissipated, &external));
        change = fabs(external - before);
        assert_ok(corot_integrator_at(integrator, 0.05, u, u + b.n));
        assert_ok(corot_integrator_energy(integrator, u, u + b.n, &e));
        start = e.kinetic + e.elastic + dissipated - external;
      }
      go_to(integrator, 0.1);
      assert_ok(corot_integrator_at(integrator, 0.1, u, u + b.n));
      assert_ok(corot_integrator_energy(integrator, u, u + b.n, &e));
      assert_ok(corot_integrator_work(integrator, 0.1, &dissipated, &external));
      missing[changes] = fabs(e.kinetic + e.elastic + dissipated - external);
      free(u);
      corot_integrator_destroy(integrator);
      drop_with(&b, in);
    }
    assert_true(change > 1e-5);
    if (corot_method_at(i)->controls_error) assert_below(fabs(start), 1e-3 * change);
    /* a constant step is not made anew: its formulas go over the change as they are */
    if (corot_method_at(i)->controls_error)
      assert_below(missing[1], 1e-3 * change);
    else
      assert_below(missing[1], 2 * missing[0] + 0.3 * change);
  }
}

static corot_status make_factors(void *of) {
  corot_inputs *in;
  COROT_TRY(corot_inputs_create(((const body *)of)->model, &in));
  corot_status status = corot_inputs_set_material(in, 0, &factors[0]);
  corot_inputs_destroy(in);
  return status;
}

static void memory_may_run_out(void **state) {
  (void)state;
  kind of = {"polar", 1, COROT_DILATATION_NODAL};
  body b = make_mixed(&of, false);
  assert_true(assert_survives_failed_allocations(make_factors, &b) > 8);
  drop_body(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(factors_make_the_materials_of_another_model),
      cmocka_unit_test(what_makes_no_sense_is_refused),
      cmocka_unit_test(averages_do_not_begin),
      cmocka_unit_test(the_books_close_over_a_change),
      cmocka_unit_test(memory_may_run_out),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
