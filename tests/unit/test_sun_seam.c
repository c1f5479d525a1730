/* What a host hands over by mistake comes back as a status with a message, never as a crash:
   vectors of another length or kind, nothing at all, a state of another model, a matrix of somebody
   else's. Afterwards everything is still usable. */
#include <cvodes/cvodes.h>

#include <corot/sun_cvode.h>
#include <nvector/nvector_manyvector.h>
#include <nvector/nvector_serial.h>
#include <sunmatrix/sunmatrix_sparse.h>

#include "bar.h"
#include "solve/sundials/sun_compat.h"
#include "solver.h"

typedef struct place {
  bar b, other;
  SUNContext ctx;
  corot_pencil *pencil, *statics;
  N_Vector y, short_one, parts, half; /* [2n], [2n - 1], two of [n] in one, [n] */
  SUNMatrix A, foreign;
} place;

static place p;

static int set_up(void **state) {
  (void)state;
  bar_def def = example2;
  def.cells[2] = 3;
  p = (place){.b = bar_create(&def), .other = bar_create(&def)};
  assert_int_equal(sun_context_create(&p.ctx), 0);
  assert_ok(corot_pencil_create(p.b.model, p.b.state, SOLVER("klu"), &p.pencil));
  corot_linear_def linear = corot_linear_defaults();
  linear.role = COROT_ROLE_STATIC;
  assert_ok(corot_pencil_create(p.b.model, p.b.state, &linear, &p.statics));
  int n = p.b.n;
  p.y = N_VNew_Serial(2 * n, p.ctx);
  p.short_one = N_VNew_Serial(2 * n - 1, p.ctx);
  p.half = N_VNew_Serial(n, p.ctx);
  N_Vector two[] = {p.half, p.half};
  p.parts = N_VNew_ManyVector(2, two, p.ctx);
  N_VConst(0, p.y), N_VConst(0, p.short_one), N_VConst(0, p.half);
  p.A = corot_sun_matrix(p.pencil, p.ctx);
  p.foreign = SUNSparseMatrix(2 * n, 2 * n, 1, CSC_MAT, p.ctx);
  return 0;
}

static int tear_down(void **state) {
  (void)state;
  SUNMatDestroy(p.A), SUNMatDestroy(p.foreign);
  N_VDestroy(p.parts), N_VDestroy(p.y), N_VDestroy(p.short_one), N_VDestroy(p.half);
  corot_pencil_destroy(p.pencil), corot_pencil_destroy(p.statics);
  SUNContext_Free(&p.ctx);
  bar_destroy(&p.b), bar_destroy(&p.other);
  return 0;
}

static corot_sun_data right_data(void) {
  return (corot_sun_data){.model = p.b.model,
                          .state = p.b.state,
                          .pencil = p.pencil,
                          .rtol = 1e-4,
                          .atol_displacement = 1e-8,
                          .atol_velocity = 1e-7};
}

/* --- The callbacks, by their vectors and their data ------------------------------------------- */

typedef int callback(N_Vector x, corot_sun_data *data);

static int call_rhs(N_Vector x, corot_sun_data *d) { return corot_sun_rhs(0, x, p.y, d); }
static int call_rhs_out(N_Vector x, corot_sun_data *d) { return corot_sun_rhs(0, p.y, x, d); }
static int call_residual(N_Vector x, corot_sun_data *d) {
  return corot_sun_residual(0, p.y, x, p.y, d);
}
static int call_weights(N_Vector x, corot_sun_data *d) { return corot_sun_weights(p.y, x, d); }
static int call_jtimes(N_Vector x, corot_sun_data *d) {
  return corot_sun_jtimes(x, p.y, 0, p.y, NULL, d, NULL);
}
static int call_psetup(N_Vector x, corot_sun_data *d) {
  sunbooleantype made;
  return corot_sun_psetup(0, x, NULL, 0, &made, 1e-3, d);
}
static int call_psolve(N_Vector x, corot_sun_data *d) {
  return corot_sun_psolve(0, p.y, NULL, x, p.y, 1e-3, 0, 1, d);
}
static int call_jtimes_dae(N_Vector x, corot_sun_data *d) {
  return corot_sun_jtimes_dae(0, p.y, NULL, NULL, p.y, x, 10, d, NULL, NULL);
}
static int call_psetup_dae(N_Vector x, corot_sun_data *d) {
  return corot_sun_psetup_dae(0, x, NULL, NULL, 1e3, d);
}
static int call_psolve_dae(N_Vector x, corot_sun_data *d) {
  return corot_sun_psolve_dae(0, p.y, NULL, NULL, p.y, x, 1e3, 0, d);
}

static const struct {
  const char *name;
  callback *call;
  bool pencil; /* it needs one */
} callbacks[] = {
    {"rhs", call_rhs, false},
    {"rhs, output", call_rhs_out, false},
    {"residual", call_residual, false},
    {"weights", call_weights, false},
    {"jtimes", call_jtimes, false},
    {"psetup", call_psetup, true},
    {"psolve", call_psolve, true},
    {"jtimes_dae", call_jtimes_dae, false},
    {"psetup_dae", call_psetup_dae, true},
    {"psolve_dae", call_psolve_dae, true},
};
enum { NCALLBACK = sizeof callbacks / sizeof *callbacks };

/* EINVAL, which ends an integrator, and these words. */
static void expect(const char *name, int flag, const char *words) {
  if (flag != COROT_EINVAL) fail_msg("%s: %d, for '%s'", name, flag, words);
  if (!strstr(corot_error(), words)) fail_msg("%s: '%s' lacks '%s'", name, corot_error(), words);
}

static void vectors_of_another_length_or_kind_are_refused(void **state) {
  (void)state;
  for (int k = 0; k < NCALLBACK; k++) {
    const char *name = callbacks[k].name;
    corot_sun_data d = right_data();
    N_Vector y = N_VClone(p.y);
    N_VConst(0, y);
    expect(name, callbacks[k].call(p.short_one, &d), "numbers, the model asks for");
    expect(name, callbacks[k].call(p.half, &d), "numbers, the model asks for");
    expect(name, callbacks[k].call(p.parts, &d), "has no array in memory: take a serial N_Vector");
    expect(name, callbacks[k].call(NULL, &d), "is NULL");
    assert_int_equal(callbacks[k].call(y, &d), 0); /* and the right one is not */
    N_VDestroy(y);
  }
}

static void models_states_and_pencils_that_do_not_belong_together_are_refused(void **state) {
  (void)state;
  for (int k = 0; k < NCALLBACK; k++) {
    const char *name = callbacks[k].name;
    N_Vector y = N_VClone(p.y);
    N_VConst(0, y);
    expect(name, callbacks[k].call(y, NULL), "user_data is NULL");
    corot_sun_data d = right_data();
    d.state = p.other.state; /* of an equal model */
    expect(name, callbacks[k].call(y, &d), "the state is another model's");
    d.state = NULL;
    expect(name, callbacks[k].call(y, &d), "'state' is NULL");
    d = right_data();
    d.model = NULL;
    expect(name, callbacks[k].call(y, &d), "'model' is NULL");
    d = right_data();
    d.pencil = NULL;
    if (callbacks[k].pencil) expect(name, callbacks[k].call(y, &d), "'pencil' is NULL");
    d = (corot_sun_data){.model = p.other.model, .state = p.other.state, .pencil = p.pencil};
    if (callbacks[k].pencil)
      expect(name, callbacks[k].call(y, &d), "the pencil is of another model or state");
    N_VDestroy(y);
  }
}

static void weights_without_a_tolerance_are_refused(void **state) {
  (void)state;
  corot_sun_data d = right_data();
  double *const tolerances[] = {&d.rtol, &d.atol_displacement, &d.atol_velocity};
  const double bad[] = {0, -1e-9, NAN};
  for (int k = 0; k < 3; k++)
    for (int i = 0; i < 3; i++) {
      d = right_data();
      *tolerances[k] = bad[i];
      expect("weights", corot_sun_weights(p.y, p.y, &d), "corot_sun_advise has positive ones");
    }
}

/* --- Matrix and solvers ----------------------------------------------------------------------- */

static int linsys(N_Vector y, SUNMatrix A) {
  sunbooleantype made;
  return corot_sun_linsys(0, y, NULL, A, 0, &made, 1e-3, NULL, NULL, NULL, NULL);
}

static void a_matrix_of_somebody_elses_is_refused(void **state) {
  (void)state;
  expect("linsys", linsys(p.y, p.foreign), "none of corot_sun_matrix");
  expect("linsys", linsys(p.y, NULL), "none of corot_sun_matrix");
  expect("linsys", linsys(p.short_one, p.A), "numbers");
  expect("jacobian", corot_sun_jacobian_static(p.half, NULL, p.foreign, NULL, NULL, NULL),
         "none of corot_sun_matrix");
  assert_null(corot_sun_matrix(NULL, p.ctx));
  assert_null(corot_sun_linsol(NULL, p.ctx));
  assert_null(corot_sun_linsol_dae(NULL, p.ctx));
  assert_null(corot_sun_linsol_static(NULL, p.ctx));
}

/* Integrators take codes of a solve that they do not know for a success: SUN_SOLVE_FATAL is known.
 */
static void a_solve_refuses_what_it_cannot_use(void **state) {
  (void)state;
  SUNLinearSolver (*const make[])(corot_pencil *, SUNContext) = {
      corot_sun_linsol, corot_sun_linsol_dae, corot_sun_linsol_static};
  assert_int_equal(linsys(p.y, p.A), 0);
  for (int k = 0; k < 3; k++) {
    SUNLinearSolver LS = make[k](p.pencil, p.ctx);
    assert_int_equal(SUNLinSolSetup(LS, p.A), 0);
    N_Vector right = k < 2 ? p.y : p.half, wrong[] = {p.short_one, p.parts, k < 2 ? p.half : p.y};
    for (int i = 0; i < 3; i++) {
      assert_int_equal(SUNLinSolSolve(LS, p.A, right, wrong[i], 0), SUN_SOLVE_FATAL);
      assert_int_equal(SUNLinSolSolve(LS, p.A, wrong[i], right, 0), SUN_SOLVE_FATAL);
    }
    assert_int_equal(SUNLinSolSolve(LS, p.A, right, right, 0), 0);
    SUNLinSolFree(LS);
  }
}

/* --- Functions of the library ----------------------------------------------------------------- */

static void the_pencil_does_without_nothing(void **state) {
  (void)state;
  corot_pencil *none = NULL;
  double x[1] = {0};
  assert_fails(corot_pencil_create(NULL, p.b.state, NULL, &none), COROT_EINVAL, "'model' is NULL");
  assert_fails(corot_pencil_create(p.b.model, NULL, NULL, &none), COROT_EINVAL, "'state' is NULL");
  assert_fails(corot_pencil_create(p.b.model, p.other.state, NULL, &none), COROT_EINVAL, "another");
  assert_fails(corot_pencil_assemble(NULL, 0, x, x), COROT_EINVAL, "'pencil' is NULL");
  assert_fails(corot_pencil_factor(NULL), COROT_EINVAL, "'pencil' is NULL");
  assert_fails(corot_pencil_solve(NULL, x, x), COROT_EINVAL, "'pencil' is NULL");
  assert_fails(corot_pencil_newton(NULL, x, x), COROT_EINVAL, "'pencil' is NULL");
  assert_fails(corot_pencil_newton_dae(NULL, x, x), COROT_EINVAL, "'pencil' is NULL");
  corot_pencil_combine(NULL, 1, 1, 1);
  corot_pencil_use(NULL, COROT_TANGENT_EXACT);
  corot_pencil_invalidate(NULL);
  assert_string_equal(corot_pencil_solver(NULL), "");
  assert_int_equal(corot_pencil_statistics(NULL).nfactor, 0);
  assert_null(corot_pencil_view(NULL).K);
  assert_null(none);
}

static void functions_of_the_ode_refuse_a_state_of_another_model(void **state) {
  (void)state;
  const corot_model *m = p.b.model;
  double *u = p.b.u, *v = p.b.v, *out = malloc(2 * p.b.n * sizeof *out);
  double(*K)[9] = malloc(corot_model_nblock(m) * sizeof *K);
  double(*f)[3] = malloc(corot_model_mesh(m)->nnode * sizeof *f);
  corot_energies e;
  struct {
    const corot_model *model;
    corot_state *state;
    const char *words;
  } bad[] = {{NULL, p.b.state, "'model' is NULL"},
             {m, NULL, "'state' is NULL"},
             {m, p.other.state, "another"}};
  for (int k = 0; k < 3; k++) {
    const corot_model *model = bad[k].model;
    corot_state *s = bad[k].state;
    const char *words = bad[k].words;
    assert_fails(corot_residual(model, s, 0, u, v, out), COROT_EINVAL, words);
    assert_fails(corot_rhs(model, s, 0, u, out), COROT_EINVAL, words);
    assert_fails(corot_jacobian(model, s, 0, u, v, 0, K, NULL), COROT_EINVAL, words);
    assert_fails(corot_jvp(model, s, 0, u, v, 0, u, v, out), COROT_EINVAL, words);
    assert_fails(corot_energy(model, s, 0, u, v, &e), COROT_EINVAL, words);
    assert_fails(corot_elastic_force(model, s, 0, u, f), COROT_EINVAL, words);
    assert_fails(corot_frames_update(model, s, 0, u, NULL), COROT_EINVAL, words);
    corot_integrator *none;
    corot_integrator_def def = corot_integrator_defaults();
    assert_fails(corot_integrator_create(&def, model, s, 0, u, v, &none), COROT_EINVAL, words);
  }
  corot_state *none;
  corot_mass_solver *mass;
  assert_fails(corot_state_create(NULL, &none), COROT_EINVAL, "'model' is NULL");
  assert_fails(corot_mass_solver_create(NULL, &mass), COROT_EINVAL, "'model' is NULL");
  free(out), free(K), free(f);
}

static void advice_is_for_models_and_tolerances(void **state) {
  (void)state;
  corot_sun_advice a;
  assert_fails(corot_sun_advise(NULL, COROT_SUN_IDA, 1e-4, &a), COROT_EINVAL, "'model' is NULL");
  assert_fails(corot_sun_advise(p.b.model, 7, 1e-4, &a), COROT_EINVAL, "method 7");
  const double bad[] = {0, -1, NAN, INFINITY};
  for (int k = 0; k < 4; k++)
    assert_fails(corot_sun_advise(p.b.model, COROT_SUN_IDA, bad[k], &a), COROT_EINVAL, "rtol");
}

/* A host's CVODE that is opened with the wrong things is left as it was: a second try succeeds. */
static void opening_refuses_and_can_be_tried_again(void **state) {
  (void)state;
  corot_sun_host h = {0};
  void *cvode = CVodeCreate(CV_BDF, p.ctx);
  corot_sun_data d = right_data(), strange = right_data(), loose = right_data();
  strange.state = p.other.state;
  loose.rtol = NAN;
  assert_int_equal(CVodeInit(cvode, corot_sun_rhs, 0, p.y), 0);
  assert_fails(corot_sun_cvode_open(&h, NULL, p.pencil, &d, p.y), COROT_EINVAL, "no integrator");
  assert_fails(corot_sun_cvode_open(&h, cvode, NULL, &d, p.y), COROT_EINVAL, "'pencil' is NULL");
  assert_fails(corot_sun_cvode_open(&h, cvode, p.pencil, NULL, p.y), COROT_EINVAL,
               "corot_sun_data");
  assert_fails(corot_sun_cvode_open(&h, cvode, p.pencil, &strange, p.y), COROT_EINVAL, "another");
  assert_fails(corot_sun_cvode_open(&h, cvode, p.pencil, &loose, p.y), COROT_EINVAL, "rtol");
  assert_fails(corot_sun_cvode_open(&h, cvode, p.pencil, &d, p.short_one), COROT_EINVAL, "numbers");
  assert_fails(corot_sun_cvode_open(&h, cvode, p.pencil, &d, NULL), COROT_EINVAL, "NULL");

  double t;
  assert_ok(corot_sun_cvode_open(&h, cvode, p.pencil, &d, p.y));
  assert_fails(corot_sun_host_step(&h, 0.1, p.short_one, &t), COROT_EINVAL, "numbers");
  assert_fails(corot_sun_host_step(&h, 0, p.y, &t), COROT_EINVAL, "cannot stop at t = 0");
  assert_fails(corot_sun_host_step(&h, NAN, p.y, &t), COROT_EINVAL, "cannot stop");
  assert_ok(corot_sun_host_advance(&h, 0.1, p.y));
  assert_true(h.t == 0.1);
  CVodeFree(&cvode);
  corot_sun_host_close(&h);
  corot_sun_host_close(&h); /* zeroed */
  corot_sun_host_close(NULL);
}

#define TEST(f) cmocka_unit_test_setup_teardown(f, set_up, tear_down)

int main(void) {
  const struct CMUnitTest tests[] = {
      TEST(vectors_of_another_length_or_kind_are_refused),
      TEST(models_states_and_pencils_that_do_not_belong_together_are_refused),
      TEST(weights_without_a_tolerance_are_refused),
      TEST(a_matrix_of_somebody_elses_is_refused),
      TEST(a_solve_refuses_what_it_cannot_use),
      TEST(the_pencil_does_without_nothing),
      TEST(functions_of_the_ode_refuse_a_state_of_another_model),
      TEST(advice_is_for_models_and_tolerances),
      TEST(opening_refuses_and_can_be_tried_again),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
