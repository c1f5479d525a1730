/* Where the integrator cannot go on: it says so, says why, and leaves what it had. */
#include <stdio.h>

#include "bar.h"

/* A cube of six tets on a fixed base under a gravity it cannot bear. */
typedef struct cube {
  corot_model *model;
  corot_state *state;
  int n;
  double *u, *v;
  double det[6];
} cube;

static cube cube_create(const char *strain, const double gravity[3]) {
  cube c;
  corot_box box = {.size = {1, 1, 1}, .cells = {1, 1, 1}};
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  corot_fix base = {"zmin", {true, true, true}};
  corot_load load = {COROT_GRAVITY, NULL, {gravity[0], gravity[1], gravity[2]}, {0, NULL, NULL}};
  corot_model_def def = corot_model_defaults();
  def.mesh = mesh, def.strain = strain;
  def.nmaterial = 1, def.material = &soft;
  def.nfix = 1, def.fix = &base;
  def.nload = 1, def.load = &load;
  assert_ok(corot_model_create(&def, &c.model));
  assert_ok(corot_state_create(c.model, &c.state));
  corot_mesh_destroy(mesh);
  c.n = corot_model_ndof(c.model);
  c.u = calloc(2 * c.n, sizeof *c.u);
  c.v = c.u + c.n;
  return c;
}

static void cube_destroy(cube *c) {
  corot_state_destroy(c->state);
  corot_model_destroy(c->model);
  free(c->u);
}

static corot_integrator *start_cube(cube *c, const corot_integrator_def *def) {
  corot_integrator *integrator;
  assert_ok(corot_integrator_create(def, c->model, c->state, 0, c->u, c->v, &integrator));
  return integrator;
}

/* Steps until one fails; the last good one is in *step. */
static corot_status run_until_it_fails(corot_integrator *integrator, corot_step *step) {
  corot_status status = COROT_OK;
  *step = (corot_step){0};
  for (int k = 0; !status && step->t < 40; k++) {
    if (k == 20000) fail_msg("t = %.17g after 20000 steps, h = %g", step->t, step->h);
    status = corot_integrator_step(integrator, 40, step);
  }
  return status;
}

static void expect_words(const char *words) {
  if (!strstr(corot_error(), words)) fail_msg("'%s' lacks '%s'", corot_error(), words);
}

/* Pressed down or swept aside; soon, or after some vibration. The element that is named has all but
   lost its volume. */
static void an_element_that_inverts_for_good_ends_the_run(void **state) {
  (void)state;
  static const double gravity[][3] = {{0, 0, -1000}, {-1000, 0, 0}, {0, 0, -30}, {-30, 0, 0}};
  for (int m = 0; m < NMEASURE; m++)
    if (!corot_strain_traits(m)->linear)
      for (int g = 0; g < 4; g++) {
        cube c = cube_create(measures[m], gravity[g]);
        corot_integrator_def def = corot_integrator_defaults();
        corot_integrator *integrator = start_cube(&c, &def);
        corot_step step;
        assert_int_equal(run_until_it_fails(integrator, &step), COROT_EINTEGRATE);
        char time[32];
        snprintf(time, sizeof time, "past t = %.9g: tet ", step.t);
        expect_words("cvode: cannot get ");
        expect_words(time);
        expect_words("is inverted (steps have shrunk to ");
        int tet = atoi(strstr(corot_error(), "tet ") + 4);

        /* what was reached is there, in working order */
        corot_element_fields fields = {.det = c.det};
        double dissipated, external;
        assert_ok(corot_integrator_at(integrator, step.t, c.u, c.v));
        assert_ok(corot_elements(c.model, c.state, step.t, c.u, &fields));
        assert_ok(corot_integrator_work(integrator, step.t, &dissipated, &external));
        assert_true(dissipated > 0 && external > 0);
        assert_true(c.det[tet] > 0 && c.det[tet] < 1e-6);
        assert_ok(corot_integrator_at(integrator, step.t - step.h / 2, c.u, c.v));
        assert_true(corot_integrator_statistics(integrator).nst < 1000);
        /* and it stays at that */
        assert_int_equal(corot_integrator_step(integrator, 40, &step), COROT_EINTEGRATE);
        expect_words(time);
        corot_integrator_destroy(integrator);
        cube_destroy(&c);
      }
}

/* Linear elasticity has nothing against negative volumes, only against infinite ones. */
static void cauchy_ends_in_overflow_only(void **state) {
  (void)state;
  cube c = cube_create("cauchy", (double[]){0, 0, -1000});
  corot_integrator_def def = corot_integrator_defaults();
  corot_integrator *integrator = start_cube(&c, &def);
  corot_step step;
  assert_ok(run_until_it_fails(integrator, &step));
  corot_element_fields fields = {.det = c.det};
  assert_ok(corot_integrator_at(integrator, 40, c.u, c.v));
  corot_elements(c.model, c.state, 40, c.u, &fields);
  assert_true(c.det[0] < 0);
  corot_integrator_destroy(integrator);
  cube_destroy(&c);

  c = cube_create("cauchy", (double[]){0, 0, -1e307});
  integrator = start_cube(&c, &def);
  assert_int_equal(run_until_it_fails(integrator, &step), COROT_EINTEGRATE);
  expect_words("exceed double precision");
  assert_ok(corot_integrator_at(integrator, step.t, c.u, c.v));
  assert_true(isfinite(norm_max(2 * c.n, c.u)));
  corot_integrator_destroy(integrator);
  cube_destroy(&c);
}

static void a_start_that_is_inverted_is_refused_in_the_first_step(void **state) {
  (void)state;
  cube c = cube_create("polar", (double[]){0, 0, -1});
  for (int i = 2; i < c.n; i += 3) c.u[i] = -1.5;
  corot_integrator_def def = corot_integrator_defaults();
  corot_integrator *integrator = start_cube(&c, &def);
  corot_step step = {.t = -7};
  assert_fails(corot_integrator_step(integrator, 1, &step), COROT_EINTEGRATE,
               "cannot get past t = 0: tet ");
  expect_words("is inverted");
  assert_true(step.t == -7);
  corot_integrator_destroy(integrator);
  cube_destroy(&c);
}

static void limits_set_by_the_user_are_named(void **state) {
  (void)state;
  cube c = cube_create("polar", (double[]){0, 0, -1});
  corot_integrator_def def = corot_integrator_defaults();
  def.max_steps = 5;
  corot_integrator *integrator = start_cube(&c, &def);
  corot_step step = {0};
  for (int k = 0; k < 5; k++) assert_ok(corot_integrator_step(integrator, 40, &step));
  assert_fails(corot_integrator_step(integrator, 40, &step), COROT_EINTEGRATE,
               "max_steps = 5 reached at t = 0.00");
  assert_int_equal(corot_integrator_statistics(integrator).nst, 5);
  corot_integrator_destroy(integrator);

  def = corot_integrator_defaults();
  def.min_step = 0.1;
  integrator = start_cube(&c, &def);
  assert_fails(corot_integrator_step(integrator, 40, &step), COROT_EINTEGRATE,
               "cannot get past t = 0: At t = 0 and h = 0.1");
  expect_words("min_step = 0.1");
  corot_integrator_destroy(integrator);

  def = corot_integrator_defaults();
  def.rtol = 1e-18; /* below rounding */
  integrator = start_cube(&c, &def);
  assert_int_equal(run_until_it_fails(integrator, &step), COROT_EINTEGRATE);
  expect_words("too much accuracy requested");
  corot_integrator_destroy(integrator);
  cube_destroy(&c);
}

/* A trial that inverts an element is not the end: the step was too long, and is shortened. */
static void a_step_that_was_too_long_is_repeated(void **state) {
  (void)state;
  cube c = cube_create("green", (double[]){0, 0, -9.81});
  for (int i = 2; i < c.n; i += 3) c.v[i] = -3;
  corot_integrator_def def = corot_integrator_defaults();
  def.rtol = 1e-2, def.first_step = 0.5; /* one and a half times through the floor */
  corot_integrator *integrator = start_cube(&c, &def);
  corot_step step;
  assert_ok(corot_integrator_step(integrator, 1, &step));
  assert_true(step.h < 0.5);
  assert_true(corot_integrator_statistics(integrator).ncfn > 0);
  corot_integrator_destroy(integrator);
  cube_destroy(&c);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(an_element_that_inverts_for_good_ends_the_run),
      cmocka_unit_test(cauchy_ends_in_overflow_only),
      cmocka_unit_test(a_start_that_is_inverted_is_refused_in_the_first_step),
      cmocka_unit_test(limits_set_by_the_user_are_named),
      cmocka_unit_test(a_step_that_was_too_long_is_repeated),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
