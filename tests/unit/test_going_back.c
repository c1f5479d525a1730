/* Hosts that go back in time, on from an equilibrium, over jumps, and on after a failure. */
#include <cvodes/cvodes.h>

#include <corot/sun_cvode.h>
#include <nvector/nvector_serial.h>

#include "live.h"
#include "solve/sundials/sun_compat.h"

/* --- Going back ------------------------------------------------------------------------------- */

static const double jump_time[] = {0, 0.05, 0.05}, jump_value[] = {0.2, 0.2, 1};
static const corot_load pulled = {COROT_TRACTION, "zmax", {300, 0, 0}, {3, jump_time, jump_value}};

/* u at 0.06 s, by an integrator made at t of (u, v), which stops at the jump. */
static void go_on(int i, const body *b, double t, double *u, double *v) {
  corot_integrator *integrator;
  corot_integrator_def def = corot_integrator_defaults();
  def.method = corot_method_at(i)->name, def.rtol = 1e-6, def.step = 2e-4;
  assert_ok(corot_integrator_create(&def, b->model, b->state, t, u, v, &integrator));
  const double stops[] = {0.05, 0.06};
  corot_step step = {.t = t};
  for (int k = 0; k < 2; k++) {
    while (step.t < stops[k] - 1e-9) assert_ok(corot_integrator_step(integrator, stops[k], &step));
    if (k) continue;
    corot_state_enter(b->state, step.t);
    assert_ok(corot_integrator_kink(integrator));
  }
  assert_ok(corot_integrator_at(integrator, step.t, u, v));
  corot_integrator_destroy(integrator);
}

/* By every method, on a new state and on one that has passed the jump, where it may then have stood
   still under half of the loads. */
static void assert_starts_anew(bool still) {
  for (int i = 0; corot_method_at(i); i++) {
    body b = make_bar("polar", 1, 1, &pulled);
    double *first = calloc(4 * b.n, sizeof *first), *again = first + 2 * b.n;
    corot_state_enter(b.state, 0);
    go_on(i, &b, 0, first, first + b.n);
    if (still) corot_state_stand_still(b.state, 0.06, 0.5);
    go_on(i, &b, 0, again, again + b.n);
    assert_memory_equal(first, again, 2 * b.n * sizeof *first);
    free(first);
    drop_body(&b);
  }
}

static void an_integrator_may_be_made_before_a_jump_that_is_past(void **state) {
  (void)state;
  assert_starts_anew(false);
}

static void a_host_may_restart_before_a_jump_that_is_past(void **state) {
  (void)state;
  body b = make_bar("polar", 1, 1, &pulled);
  corot_pencil *pencil;
  corot_mass_solver *mass;
  SUNContext ctx;
  assert_int_equal(sun_context_create(&ctx), 0);
  N_Vector y = N_VNew_Serial(2 * b.n, ctx), kept = N_VClone(y), first = N_VClone(y);
  N_VConst(0, y), N_VConst(0, kept);
  assert_ok(corot_pencil_create(b.model, b.state, NULL, &pencil));
  assert_ok(corot_mass_solver_create(b.model, &mass));
  void *cvode = CVodeCreate(CV_BDF, ctx);
  assert_int_equal(CVodeInit(cvode, corot_sun_rhs, 0, y), 0);
  corot_sun_host host = {0};
  corot_sun_data data = {.model = b.model, .state = b.state, .mass = mass, .rtol = 1e-6};
  data.atol_velocity = -1;
  assert_fails(corot_sun_cvode_open(&host, cvode, pencil, &data, y), COROT_EINVAL, "absolute");
  data.atol_velocity = 0;
  assert_ok(corot_sun_cvode_open(&host, cvode, pencil, &data, y));
  assert_ok(corot_sun_host_advance(&host, 0.06, y));
  N_VScale(1, y, first);
  N_VScale(1, kept, y);
  assert_ok(corot_sun_host_restart(&host, 0, y, 0));
  assert_ok(corot_sun_host_advance(&host, 0.06, y));
  double *u = N_VGetArrayPointer(first);
  assert_below(difference_of(b.n, u, N_VGetArrayPointer(y)), 1e-5 * norm_max(b.n, u));

  /* what makes no sense is told, and goes by */
  assert_fails(corot_sun_host_advance(&host, 0.06, y), COROT_EINVAL, "cannot stop");
  assert_fails(corot_sun_host_advance(&host, NAN, y), COROT_EINVAL, "cannot stop");
  assert_fails(corot_sun_host_restart(&host, NAN, y, 0), COROT_EINVAL, "cannot begin again");
  assert_fails(corot_sun_host_restart(&host, 0.06, y, -1), COROT_EINVAL, "cannot begin again");
  assert_ok(corot_sun_host_advance(&host, 0.061, y));
  corot_sun_host_close(&host);
  CVodeFree(&cvode);
  corot_mass_solver_destroy(mass), corot_pencil_destroy(pencil);
  N_VDestroy(y), N_VDestroy(kept), N_VDestroy(first);
  SUNContext_Free(&ctx);
  drop_body(&b);
}

static void a_state_that_stood_still_moves(void **state) {
  (void)state;
  assert_starts_anew(true);
}

/* --- Jumps of inputs -------------------------------------------------------------------------- */

/* u at 0.2 s, by a method of constant step; a force comes in at 0.1 s. */
static void push(int i, double h, double *u) {
  body b = make_bar("polar", 1, 0, NULL);
  corot_inputs *in = give_inputs(&b);
  corot_integrator *integrator;
  corot_integrator_def def = corot_integrator_defaults();
  def.method = corot_method_at(i)->name, def.step = h;
  double *zero = calloc(2 * b.n, sizeof *zero);
  double(*force)[3] = calloc(b.mesh->nnode, sizeof *force);
  for (int n = 0; n < b.mesh->nnode; n++) force[n][0] = 0.05;
  assert_ok(corot_integrator_create(&def, b.model, b.state, 0, zero, zero + b.n, &integrator));
  corot_step step = {0};
  while (step.t < 0.1 - 1e-9) assert_ok(corot_integrator_step(integrator, 1, &step));
  assert_ok(corot_inputs_set_force(in, b.mesh->nnode, (const double(*)[3])force));
  assert_ok(corot_integrator_changed(integrator, COROT_HISTORY_AUTO));
  while (step.t < 0.2 - 1e-9) assert_ok(corot_integrator_step(integrator, 1, &step));
  assert_ok(corot_integrator_at(integrator, step.t, u, NULL));
  corot_integrator_destroy(integrator);
  free(zero), free(force);
  drop_with(&b, in);
}

/* Methods of one step keep their order over it: three steps tell. */
static void methods_of_one_step_keep_their_order_over_a_jump(void **state) {
  (void)state;
  int n = 0, nmethod = 0;
  body b = make_bar("polar", 1, 0, NULL);
  n = b.n;
  drop_body(&b);
  double *u = malloc(3 * n * sizeof *u);
  for (int i = 0; corot_method_at(i); i++) {
    const corot_method_kind *kind = corot_method_at(i);
    if (kind->controls_error || strncmp(kind->name, "bdf", 3) == 0) continue;
    for (int k = 0; k < 3; k++) push(i, 2e-3 / (1 << k), u + k * n);
    double order = log2(difference_of(n, u, u + n) / difference_of(n, u + n, u + 2 * n));
    assert_close(order, kind->order_max, 0, 0.15);
    nmethod++;
  }
  assert_int_equal(nmethod, 5);
  free(u);
}

/* The integrator would miss the energy of materials that change with the inputs as a whole. */
static void inputs_with_factors_are_not_changed_for_others(void **state) {
  (void)state;
  body b = make_bar("polar", 1, 1, &pulled);
  corot_inputs *in = give_inputs(&b), *other;
  const corot_material_factors half = {0.5, 0.5, 0.5, 0.5};
  double *zero = calloc(2 * b.n, sizeof *zero);
  corot_integrator *integrator;
  assert_ok(corot_inputs_create(b.model, &other));
  assert_ok(corot_inputs_set_material(in, 0, &half)); /* before an integrator is made, at will */
  assert_ok(corot_state_use_inputs(b.state, NULL));
  assert_ok(corot_state_use_inputs(b.state, in));
  integrator = integrate_by(0, &b, 1e-4);
  assert_fails(corot_state_use_inputs(b.state, NULL), COROT_EINVAL, "energy");
  assert_fails(corot_state_use_inputs(b.state, other), COROT_EINVAL, "energy");
  assert_ok(corot_state_use_inputs(b.state, in));
  corot_integrator_destroy(integrator);
  free(zero);
  drop_with(&b, in);
  corot_inputs_destroy(other);
}

/* --- After a failure -------------------------------------------------------------------------- */

static bool broken;

static corot_status hold(void *data, double t, const double (*u)[3], const double (*v)[3],
                         double (*f)[3]) {
  (void)data, (void)t, (void)v;
  for (int c = 0; c < 3; c++) f[3][c] -= 100 * u[3][c];
  return COROT_OK;
}

static corot_status hold_blocks(void *data, double t, const double (*u)[3], const double (*v)[3],
                                corot_blocks *blocks) {
  (void)data, (void)t, (void)u, (void)v;
  const double K[9] = {100, 0, 0, 0, 100, 0, 0, 0, 100};
  if (broken) return corot_fail(COROT_EINVAL, "contact is lost");
  return corot_blocks_add(blocks, 3, 3, K, NULL);
}

static void every_method_goes_on_once_a_feedback_is_mended(void **state) {
  (void)state;
  const corot_feedback contact = {"contact", NULL, hold, hold_blocks, NULL};
  for (int i = 0; corot_method_at(i); i++) {
    body b = make_bar("polar", 1, 1, &pulled);
    corot_inputs *in = give_inputs(&b);
    assert_ok(corot_inputs_set_feedback(in, &contact));
    corot_integrator *integrator = integrate_by(i, &b, 1e-4);
    corot_step step;
    broken = true;
    if (!corot_method_at(i)->explicit_steps)
      assert_true(corot_integrator_step(integrator, 0.1, &step) < 0);
    broken = false;
    assert_ok(corot_inputs_set_feedback(in, &contact));
    assert_ok(corot_integrator_changed(integrator, COROT_HISTORY_AUTO));
    for (int k = 0; k < 3; k++) assert_ok(corot_integrator_step(integrator, 0.1, &step));
    corot_integrator_destroy(integrator);
    drop_with(&b, in);
  }
}

/* --- The order of a pencil's calls ------------------------------------------------------------ */

static void a_pencil_has_no_factor_but_that_of_its_matrices(void **state) {
  (void)state;
  body b = make_bar("polar", 1, 1, &pulled);
  double *x = calloc(4 * b.n, sizeof *x), *r = x + 2 * b.n;
  corot_pencil *p;
  for (int i = 0; i < 2 * b.n; i++) r[i] = 1;
  assert_ok(corot_pencil_create(b.model, b.state, NULL, &p));
  corot_pencil_combine(p, 1, 1e-3, 1e-6); /* of what? */
  assert_fails(corot_pencil_factor(p), COROT_EINVAL, "there is no S");
  assert_fails(corot_pencil_solve(p, r, x), COROT_EINVAL, "there is no factor");
  assert_ok(corot_pencil_assemble(p, 0, x, x));
  assert_fails(corot_pencil_factor(p), COROT_EINVAL, "there is no S");
  corot_pencil_combine(p, 1, 1e-3, 1e-6);
  assert_fails(corot_pencil_newton(p, r, x), COROT_EINVAL, "there is no factor");
  assert_ok(corot_pencil_factor(p));
  assert_ok(corot_pencil_newton(p, r, x));
  corot_pencil_combine(p, 1, 1e-2, 1e-4);
  assert_fails(corot_pencil_newton(p, r, x), COROT_EINVAL, "there is no factor");
  assert_fails(corot_pencil_newton_dae(p, r, x), COROT_EINVAL, "there is no factor");
  assert_ok(corot_pencil_factor(p));
  assert_ok(corot_pencil_newton_dae(p, r, x));
  corot_pencil_destroy(p);
  free(x);
  drop_body(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(an_integrator_may_be_made_before_a_jump_that_is_past),
      cmocka_unit_test(a_host_may_restart_before_a_jump_that_is_past),
      cmocka_unit_test(a_state_that_stood_still_moves),
      cmocka_unit_test(methods_of_one_step_keep_their_order_over_a_jump),
      cmocka_unit_test(inputs_with_factors_are_not_changed_for_others),
      cmocka_unit_test(every_method_goes_on_once_a_feedback_is_mended),
      cmocka_unit_test(a_pencil_has_no_factor_but_that_of_its_matrices),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
