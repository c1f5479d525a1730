/* The integrator with error control: its definition, its choices, its books. */
#include <corot/solve.h>

#include "bar.h"
#include "solver.h"

static bar quick_bar(void) {
  bar_def def = example2;
  def.ramp = 0.5;
  return bar_create(&def);
}

/* --- definition ------------------------------------------------------------------------------ */

static void expect_refusal(bar *b, corot_integrator_def def, const char *words) {
  corot_integrator *integrator = (corot_integrator *)b;
  assert_fails(corot_integrator_create(&def, b->model, b->state, 0, b->u, b->v, &integrator),
               COROT_EINVAL, words);
  assert_ptr_equal(integrator, b);
}

#define REFUSED(field, value, words)                         \
  do {                                                       \
    corot_integrator_def def_ = corot_integrator_defaults(); \
    def_.field = (value);                                    \
    expect_refusal(&b, def_, words);                         \
  } while (0)

static void each_field_is_checked(void **state) {
  (void)state;
  bar b = quick_bar();
  const double bad[] = {-1, NAN, INFINITY, -INFINITY};
  for (int k = 0; k < 4; k++) {
    REFUSED(rtol, bad[k], "rtol");
    REFUSED(atol_displacement, bad[k], "atol_displacement");
    REFUSED(atol_velocity, bad[k], "atol_velocity");
    REFUSED(first_step, bad[k], "first_step");
    REFUSED(min_step, bad[k], "min_step");
    REFUSED(max_step, bad[k], "max_step");
    REFUSED(gamma_change, bad[k], "gamma_change");
    REFUSED(convergence, bad[k], "convergence");
    REFUSED(step, bad[k], "step");
    REFUSED(newton_tolerance, bad[k], "newton_tolerance");
  }
  REFUSED(rtol, 0, "rtol = 0 is not positive and finite");
  REFUSED(max_order, -1, "max_order = -1 is not in 1 to 5");
  REFUSED(max_order, 6, "max_order = 6");
  REFUSED(max_steps, -1, "max_steps = -1 is not positive, or 0, and finite");
  REFUSED(reassembly, -3, "reassembly");
  REFUSED(refactorisation, -1, "refactorisation");
  REFUSED(newton_iterations, 0, "newton_iterations");
  REFUSED(tangent, (corot_tangent)7, "tangent = 7");
  REFUSED(method, "rk4", "no integrator 'rk4': cvode");
  REFUSED(method, NULL, "no integrator");
  REFUSED(linear.solver, "lu", "no linear solver 'lu'");
  REFUSED(linear.solver, NULL, "no linear solver");
  corot_integrator_def def = corot_integrator_defaults();
  def.min_step = 0.1, def.max_step = 0.01;
  expect_refusal(&b, def, "min_step = 0.1 exceeds max_step = 0.01");
  for (int k = 1; k < 20; k++) { /* equal ones are a constant step */
    def.min_step = def.max_step = def.first_step = 0.001 * k;
    corot_integrator *integrator = start(&b, &def);
    corot_integrator_destroy(integrator);
  }
  bar_destroy(&b);
}

static void the_start_is_checked(void **state) {
  (void)state;
  bar b = quick_bar();
  corot_integrator_def def = corot_integrator_defaults();
  corot_integrator *integrator;
  assert_fails(corot_integrator_create(&def, b.model, b.state, NAN, b.u, b.v, &integrator),
               COROT_EINVAL, "cannot start at t = nan");
  b.u[3] = NAN;
  expect_refusal(&b, def, "u[3] = nan");
  b.u[3] = 0, b.v[5] = INFINITY;
  expect_refusal(&b, def, "v[5] = inf");
  bar_destroy(&b);
}

static void open_fields_are_chosen(void **state) {
  (void)state;
  bar b = quick_bar();
  char method[] = "cvode", solver[] = "auto";
  corot_integrator_def def = corot_integrator_defaults();
  def.method = method, def.linear.solver = solver;
  corot_integrator *integrator = start(&b, &def);
  memset(method, 'x', 5), memset(solver, 'x', 4); /* nothing of the definition is kept */
  corot_integrator_choice c = corot_integrator_chosen(integrator);
  assert_string_equal(c.method, "cvode");
  assert_non_null(strstr(c.linear_solver, ", ")); /* and what it was chosen with */
  assert_close(c.atol_displacement, 1e-6 * corot_model_length(b.model), 1e-15, 0);
  assert_close(c.atol_velocity, c.atol_displacement * corot_model_frequency(b.model), 1e-15, 0);
  corot_integrator_destroy(integrator);
  bar_destroy(&b);
}

/* What the table says of a method is what its steps do. */
static void traits_are_true(void **state) {
  (void)state;
  const corot_method_kind *kind;
  for (int k = 0; (kind = corot_method_at(k)); k++) {
    bar b = quick_bar();
    corot_integrator_def def = corot_integrator_defaults();
    assert_ptr_equal(corot_method_traits(kind->name), kind);
    def.method = kind->name;
    if (!kind->controls_error) {
      expect_refusal(&b, def, "needs a step");
      def.step = 0.01;
    }
    corot_integrator *integrator = start(&b, &def);
    for (corot_step step = {0}; step.t < 0.1;) {
      assert_ok(corot_integrator_step(integrator, 0.1, &step));
      assert_true(step.order <= kind->order_max);
    }
    corot_statistics n = corot_integrator_statistics(integrator);
    corot_integrator_choice c = corot_integrator_chosen(integrator);
    assert_true(kind->explicit_steps == (n.nfactor == 0));
    assert_true(kind->stages == (c.table[0] != '\0'));
    assert_true(kind->multistep == (kind->controls_error && !kind->stages));
    corot_integrator_destroy(integrator);

    if (kind->gamma_change_below > 0) {
      def.gamma_change = kind->gamma_change_below;
      expect_refusal(&b, def, "gamma_change");
      def.gamma_change = 0;
    }
    if (kind->radius_min > 0) {
      def.spectral_radius = 0.99 * kind->radius_min;
      expect_refusal(&b, def, "spectral_radius");
    }
    bar_destroy(&b);
  }
  assert_null(corot_method_at(-1));
  assert_null(corot_method_traits("leapfrog"));
  assert_null(corot_method_traits(NULL));
}

/* --- order ----------------------------------------------------------------------------------- */

static int order_chosen(double damping, double rtol, double max_step) {
  bar_def of = example2;
  of.damping = damping;
  bar b = bar_create(&of);
  corot_integrator_def def = corot_integrator_defaults();
  def.rtol = rtol;
  def.max_step = max_step;
  corot_integrator *integrator = start(&b, &def);
  int order = corot_integrator_chosen(integrator).max_order;
  corot_integrator_destroy(integrator);
  bar_destroy(&b);
  return order;
}

/* The paper's bar has beta = damping/stiffness = 1e-4 s, and a shear wave takes 0.2 s across it: at
   rtol 1e-3 orders 3, 4, 5 need 0.145, 0.367, 0.738 times that. */
static void higher_orders_are_chosen_where_they_pay(void **state) {
  (void)state;
  assert_int_equal(order_chosen(1, 1e-4, 0), 2);
  assert_int_equal(order_chosen(1, 2e-7, 0), 2);
  assert_int_equal(order_chosen(1, 9e-8, 0), 5);
  assert_int_equal(order_chosen(1, 1e-7, 0), 5);
  const double rtol[] = {1e-2, 1e-4, 1e-7, 1e-9};
  for (int k = 0; k < 4; k++) assert_int_equal(order_chosen(0, rtol[k], 0), 2);
  bar b = quick_bar();
  double shear_wave = 1 / corot_model_frequency(b.model), beta = corot_model_damping_time(b.model);
  bar_destroy(&b);
  assert_close(beta, 1e-4, 1e-12, 0);
  const double bound[] = {0.145, 0.367, 0.738};
  for (int k = 0; k < 3; k++) {
    assert_int_equal(order_chosen(1.01 * bound[k] * shear_wave / beta, 1e-3, 0), 3 + k);
    assert_int_equal(order_chosen(0.99 * bound[k] * shear_wave / beta, 1e-3, 0), 2 + k);
    assert_int_equal(order_chosen(1, 1e-3, 0.99 * beta / bound[k]), 3 + k);
    assert_int_equal(order_chosen(1, 1e-3, 1.01 * beta / bound[k]), 2 + k);
  }
}

/* The largest energy in two seconds of free, linear vibration, over that at the start. */
static double energy_ratio(double rtol, int max_order) {
  bar_def of = example2;
  of.strain = "cauchy", of.damping = 0, of.traction[0] = 0;
  bar b = bar_create(&of);
  const corot_mesh *mesh = corot_model_mesh(b.model);
  const int(*dof)[3] = corot_model_dof(b.model);
  for (int n = 0; n < mesh->nnode; n++) { /* sheared by a parabola, and let go */
    double z = mesh->x[n][2] / 0.6;
    if (dof[n][0] >= 0) b.u[dof[n][0]] = 0.05 * z * z;
  }
  corot_energies e;
  assert_ok(corot_energy(b.model, b.state, 0, b.u, b.v, &e));
  double first = e.elastic, largest = 0;
  corot_integrator_def def = corot_integrator_defaults();
  def.rtol = rtol, def.max_order = max_order;
  corot_integrator *integrator = start(&b, &def);
  for (corot_step step = {0}; step.t < 2;) {
    assert_ok(corot_integrator_step(integrator, 2, &step));
    assert_ok(corot_integrator_at(integrator, step.t, b.u, b.v));
    assert_ok(corot_energy(b.model, b.state, step.t, b.u, b.v, &e));
    largest = fmax(largest, e.kinetic + e.elastic);
  }
  corot_integrator_destroy(integrator);
  bar_destroy(&b);
  return largest / first;
}

/* At a loose tolerance orders 3 to 5 are unstable for its modes, here by a factor of 28; order 2,
   the choice, only damps them. */
static void high_orders_pump_energy_into_an_undamped_bar(void **state) {
  (void)state;
  assert_above(energy_ratio(3e-3, 5), 2);
  assert_below(energy_ratio(3e-3, 0), 1.01);
}

/* --- tolerance ------------------------------------------------------------------------------- */

typedef struct outcome {
  corot_statistics s;
  double tip;
} outcome;

static outcome run(const bar_def *of, corot_integrator_def def, double t_end) {
  bar b = bar_create(of);
  corot_integrator *integrator = start(&b, &def);
  run_to(integrator, t_end);
  assert_ok(corot_integrator_at(integrator, t_end, b.u, b.v));
  outcome o = {corot_integrator_statistics(integrator), b.u[b.tip]};
  corot_integrator_destroy(integrator);
  bar_destroy(&b);
  return o;
}

/* The error falls with the tolerance, somewhat slower than it (order 2: steps with its cube root,
   errors with their square). */
static void the_error_follows_the_tolerance(void **state) {
  (void)state;
  bar_def of = example2;
  of.ramp = 0.5;
  corot_integrator_def def = corot_integrator_defaults();
  def.rtol = 1e-9;
  double exact = run(&of, def, 1).tip, error[4];
  long nst[4];
  for (int k = 0; k < 4; k++) {
    def.rtol = 1e-2 * pow(0.1, k);
    outcome o = run(&of, def, 1);
    error[k] = fabs(o.tip - exact) / fabs(exact);
    nst[k] = o.s.nst;
    assert_below(error[k], 30 * def.rtol);
    if (k > 0) assert_true(nst[k] > nst[k - 1]);
  }
  double slope = log10(error[0] / error[3]) / 3;
  assert_true(slope > 0.5 && slope < 1.3);
}

static void each_tolerance_has_its_effect(void **state) {
  (void)state;
  bar_def of = example2;
  of.ramp = 0.5;
  corot_integrator_def def = corot_integrator_defaults();
  long base = run(&of, def, 1).s.nst;
  corot_integrator_def finer = def;
  finer.rtol = def.rtol / 2;
  assert_true(run(&of, finer, 1).s.nst > 1.1 * base);
  finer = def, finer.atol_displacement = 1e-9; /* carries the velocities' along */
  assert_true(run(&of, finer, 1).s.nst > base);
  finer = def, finer.atol_velocity = 1e-9;
  assert_true(run(&of, finer, 1).s.nst > base);
  finer = def, finer.max_step = 1e-3;
  assert_true(run(&of, finer, 1).s.nst >= 1000);
  finer = def, finer.first_step = 1e-5;
  bar b = bar_create(&of);
  corot_integrator *integrator = start(&b, &finer);
  corot_step step;
  assert_ok(corot_integrator_step(integrator, 1, &step));
  assert_close(step.h, 1e-5, 1e-12, 0);
  corot_integrator_destroy(integrator);
  bar_destroy(&b);
}

/* --- invariance ------------------------------------------------------------------------------ */

/* Mesh, support and load turned together: the steps, and all that is counted, stay the same, with
   the tolerances that are chosen too. */
static void a_turned_copy_takes_the_same_steps(void **state) {
  (void)state;
  const double axis[] = {1, -2, 0.7};
  for (int m = 0; m < NMEASURE; m++) {
    bar_def of = example2;
    of.strain = measures[m], of.ramp = 0.5;
    corot_integrator_def def = corot_integrator_defaults();
    corot_statistics upright = run(&of, def, 0.5).s;
    rotation(axis, 1.9, of.Q);
    corot_statistics turned = run(&of, def, 0.5).s;
    assert_int_equal(turned.nst, upright.nst);
    assert_int_equal(turned.nfe, upright.nfe);
    assert_int_equal(turned.nsetups, upright.nsetups);
    assert_int_equal(turned.netf, upright.netf);
    assert_int_equal(turned.nni, upright.nni);
    assert_int_equal(turned.nje, upright.nje);
    assert_int_equal(turned.nfactor, upright.nfactor);
  }
}

/* --- books ----------------------------------------------------------------------------------- */

static void the_two_clocks_of_the_matrix_are_kept(void **state) {
  (void)state;
  bar_def of = example2;
  of.ramp = 0.5;
  corot_integrator_def def = corot_integrator_defaults();
  def.linear.solver = "klu";
  corot_statistics s = run(&of, def, 1).s;
  assert_int_equal(s.nfactor, s.nsetups);
  assert_true(s.nsetups < s.nst / 4 && s.nje <= s.nsetups);
  assert_int_equal(s.nsolve, s.nni);
  assert_int_equal(s.nfresh, 1);
  assert_int_equal(s.nli, 0);
  assert_true(s.nfeQ >= s.nst && s.nfe > s.nni);
  assert_true(s.hlast > 0 && s.qlast == 2);
  assert_true(s.force_s > 0 && s.assembly_s > 0 && s.combine_s > 0 && s.factor_s > 0 &&
              s.solve_s > 0 && s.work_s > 0);

  corot_integrator_def often = def;
  often.refactorisation = 1;
  corot_statistics o = run(&of, often, 1).s;
  assert_true(o.nsetups >= o.nst && o.nje < o.nst / 2);
  often.reassembly = 1;
  o = run(&of, often, 1).s;
  assert_true(o.nsetups >= o.nst && o.nje == o.nsetups && o.nfactor == o.nsetups);
  corot_integrator_def seldom = def;
  seldom.reassembly = 1000;
  o = run(&of, seldom, 1).s;
  assert_true(o.nje < s.nje);
  seldom.refactorisation = 1000;
  o = run(&of, seldom, 1).s;
  assert_true(o.nsetups < s.nsetups);
  corot_integrator_def stale = def;
  stale.gamma_change = 10; /* so that Newton's iteration has to fail to get a new matrix */
  o = run(&of, stale, 1).s;
  assert_true(o.ncfn > s.ncfn);
}

/* The frames' variation in K costs nothing here and changes little. */
static void both_tangents_lead_to_the_same_place(void **state) {
  (void)state;
  bar_def of = example2;
  of.ramp = 0.5;
  corot_integrator_def def = corot_integrator_defaults();
  def.rtol = 1e-6;
  double held = run(&of, def, 1).tip;
  def.tangent = COROT_TANGENT_EXACT;
  assert_close(run(&of, def, 1).tip, held, 1e-5, 0);
}

static void the_linear_solver_makes_no_difference(void **state) {
  (void)state;
  static const char *const others[] = {"cholmod", "pcg"};
  bar_def of = example2;
  of.ramp = 0.5;
  corot_integrator_def def = corot_integrator_defaults();
  def.linear.solver = "klu";
  outcome klu = run(&of, def, 1);
  assert_int_equal(klu.s.nli, 0);
  for (int k = 0; k < 2; k++) {
    corot_pencil *probe;
    bar b = bar_create(&of);
    corot_status status = corot_pencil_create(b.model, b.state, SOLVER(others[k]), &probe);
    if (!status) corot_pencil_destroy(probe);
    bar_destroy(&b);
    if (status) continue; /* not in this build */
    def.linear.solver = others[k];
    outcome other = run(&of, def, 1);
    bool iterative = strcmp(others[k], "pcg") == 0;
    assert_int_equal(other.s.nst, klu.s.nst);
    assert_int_equal(other.s.nfactor, klu.s.nfactor);
    assert_int_equal(other.s.nindefinite, 0);
    assert_true(iterative ? other.s.nli > other.s.nsolve : other.s.nli == 0);
    assert_close(other.tip, klu.tip, 1e-9, 0);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(each_field_is_checked),
      cmocka_unit_test(the_start_is_checked),
      cmocka_unit_test(open_fields_are_chosen),
      cmocka_unit_test(traits_are_true),
      cmocka_unit_test(higher_orders_are_chosen_where_they_pay),
      cmocka_unit_test(high_orders_pump_energy_into_an_undamped_bar),
      cmocka_unit_test(the_error_follows_the_tolerance),
      cmocka_unit_test(each_tolerance_has_its_effect),
      cmocka_unit_test(a_turned_copy_takes_the_same_steps),
      cmocka_unit_test(the_two_clocks_of_the_matrix_are_kept),
      cmocka_unit_test(both_tangents_lead_to_the_same_place),
      cmocka_unit_test(the_linear_solver_makes_no_difference),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
