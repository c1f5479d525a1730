/* Runge-Kutta methods with error control: arkode, diagonally implicit, and erk, explicit. */
#include <stdio.h>

#include "alloc.h"
#include "bar.h"
#include "solve/integrate/runge_kutta/explicit_limit.h"
#include "solve/integrate/runge_kutta/runge_kutta.h"

static const char *const methods[] = {"arkode", "erk"};
enum { NMETHOD = 2 };

static bar quick_bar(void) {
  bar_def def = example2;
  def.ramp = 0.5;
  return bar_create(&def);
}

static corot_integrator_def method_to(const char *method, double rtol) {
  corot_integrator_def def = corot_integrator_defaults();
  def.method = method;
  def.rtol = rtol;
  return def;
}

/* --- definition ------------------------------------------------------------------------------ */

static void refuse(bar *b, const corot_integrator_def *def, const char *words) {
  corot_integrator *integrator = (corot_integrator *)b;
  assert_fails(corot_integrator_create(def, b->model, b->state, 0, b->u, b->v, &integrator),
               COROT_EINVAL, words);
  assert_ptr_equal(integrator, b);
}

static void what_there_is_none_of_is_refused(void **state) {
  (void)state;
  static const struct {
    const char *method, *table;
    int order, predictor;
    const char *words;
  } cases[] = {
      {"arkode", NULL, 6, -1, "no table of order 6: there are orders 2, 3, 4, 5 (0: choose)"},
      {"arkode", NULL, 1, -1, "no table of order 1"},
      {"arkode", NULL, -3, -1, "no table of order -3"},
      {"erk", NULL, 7, -1, "no table of order 7: there are orders 2, 3, 4, 5, 6, 8 (0: choose)"},
      {"arkode", "rk4", 0, -1, "arkode: no table 'rk4': ARKODE_TRBDF2_3_3_2, "},
      {"arkode", "rk4", 0, -1, ", ARKODE_KVAERNO_7_4_5"},
      {"erk", "", 0, -1, "erk: no table '': ARKODE_HEUN_EULER_2_1_2, "},
      {"erk", "ARKODE_KNOTH_WOLKE_3_3", 0, -1, ", ARKODE_FEHLBERG_13_7_8"},
      {"arkode", "ARKODE_ZONNEVELD_5_3_4", 0, -1, "ARKODE_ZONNEVELD_5_3_4 is explicit, of erk"},
      {"erk", "ARKODE_SDIRK_2_1_2", 0, -1, "ARKODE_SDIRK_2_1_2 is implicit, of arkode"},
      {"erk", "ARKODE_ZONNEVELD_5_3_4", 3, -1, "ARKODE_ZONNEVELD_5_3_4 is of order 4, not 3"},
      {"arkode", NULL, 0, 5, "predictor = 5 is not in 0 to 4 (-1: choose)"},
  };
  bar b = quick_bar();
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    corot_integrator_def def = method_to(cases[k].method, 1e-4);
    def.table = cases[k].table;
    def.order = cases[k].order;
    def.predictor = cases[k].predictor;
    refuse(&b, &def, cases[k].words);
  }
  bar_destroy(&b);
}

static corot_integrator_choice choice_of(bar *b, const corot_integrator_def *def) {
  corot_integrator *integrator = start(b, def);
  corot_integrator_choice choice = corot_integrator_chosen(integrator);
  corot_integrator_destroy(integrator);
  return choice;
}

static void what_is_left_open_is_chosen(void **state) {
  (void)state;
  bar b = quick_bar();
  corot_integrator_def def = method_to("arkode", 1e-4);
  corot_integrator_choice c = choice_of(&b, &def);
  assert_string_equal(c.method, "arkode");
  assert_string_equal(c.table, "ARKODE_ARK437L2SA_DIRK_7_3_4");
  assert_true(c.max_order == 4 && c.tangent == COROT_TANGENT_EXACT && c.predictor == 4);
  assert_true(c.reassembly > 0 && c.refactorisation > 0);
  assert_true(c.gamma_change > 0 && c.convergence > 0);
  def.rtol = 1e-5;
  assert_int_equal(choice_of(&b, &def).max_order, 5);
  def.order = 2;
  assert_string_equal(choice_of(&b, &def).table, "ARKODE_TRBDF2_3_3_2");
  def.table = "ARKODE_SDIRK_2_1_2";
  def.predictor = 1, def.tangent = COROT_TANGENT_HELD, def.convergence = 0.5;
  c = choice_of(&b, &def);
  assert_string_equal(c.table, "ARKODE_SDIRK_2_1_2");
  assert_true(c.predictor == 1 && c.tangent == COROT_TANGENT_HELD && c.convergence == 0.5);

  const struct {
    double rtol;
    int order;
  } explicit_ones[] = {{1e-4, 4}, {1e-7, 5}, {1e-11, 8}};
  for (int k = 0; k < 3; k++) {
    def = method_to("erk", explicit_ones[k].rtol);
    c = choice_of(&b, &def);
    assert_int_equal(c.max_order, explicit_ones[k].order);
    assert_true(c.reassembly == 0 && c.refactorisation == 0 && c.convergence == 0);
  }
  def.table = "ARKODE_CASH_KARP_6_4_5";
  assert_int_equal(choice_of(&b, &def).max_order, 5);
  bar_destroy(&b);
}

static corot_status create_and_step(void *context) {
  bar *b = context;
  corot_integrator_def def = method_to(b->tip < 0 ? "erk" : "arkode", 1e-4);
  corot_integrator *integrator;
  COROT_TRY(corot_integrator_create(&def, b->model, b->state, 0, b->u, b->v, &integrator));
  corot_step step;
  corot_status status = corot_integrator_step(integrator, 0.01, &step);
  corot_integrator_destroy(integrator);
  return status;
}

static void each_failed_allocation_is_survived(void **state) {
  (void)state;
  bar b = quick_bar();
  assert_true(assert_survives_failed_allocations(create_and_step, &b) > 5);
  b.tip = -1;
  assert_true(assert_survives_failed_allocations(create_and_step, &b) > 3);
  bar_destroy(&b);
}

/* --- orders ---------------------------------------------------------------------------------- */

/* A swinging bar, tolerance so wide that every step is of the longest length. */
static const double swing_time = 0.016;

static bar swinging_bar(void) {
  bar_def def = example2;
  def.strain = "green";
  def.cells[2] = 2;
  def.ramp = 0;
  bar b = bar_create(&def);
  for (int i = 0; i < b.n; i++) b.v[i] = i % 3 == 0 ? 2 : 0.3;
  return b;
}

static void swing(const char *method, const char *table, int steps, double *u) {
  bar b = swinging_bar();
  corot_integrator_def def = method_to(method, 1);
  def.table = table;
  def.max_step = def.first_step = swing_time / steps;
  def.convergence = 1e-13;
  corot_integrator *integrator = start(&b, &def);
  run_to(integrator, swing_time);
  assert_ok(corot_integrator_at(integrator, swing_time, u, NULL));
  long taken = corot_integrator_statistics(integrator).nst;
  if (taken > steps + 1) fail_msg("%s: %ld steps, not %d", table, taken, steps);
  corot_integrator_destroy(integrator);
  bar_destroy(&b);
}

/* Whatever the elements are: few unknowns are enough. */
static void check_orders(const char *method, const rk_table *tables) {
  enum { LARGEST = 100 };
  if (order_of_test() > 1) skip();
  double exact[LARGEST], u[LARGEST];
  bar b = swinging_bar();
  int n = b.n;
  bar_destroy(&b);
  assert_true(n <= LARGEST);
  swing("erk", "ARKODE_FEHLBERG_13_7_8", 200, exact);
  for (; tables->name; tables++) {
    int steps = tables->order >= 6 ? 8 : tables->order >= 4 ? 12 : 40;
    swing(method, tables->name, steps, u);
    double coarse = difference_of(n, u, exact);
    swing(method, tables->name, 2 * steps, u);
    double order = log2(coarse / difference_of(n, u, exact));
    if (!(fabs(order - tables->order) < 0.5))
      fail_msg("%s: order %.2f, not %d (error %.2g)", tables->name, order, tables->order, coarse);
  }
}

static void each_implicit_table_has_its_order(void **state) {
  (void)state;
  check_orders("arkode", corot_rk_implicit);
}

/* Those whose last stage is not the next one's first, too: see integrate_erk.c. */
static void each_explicit_table_has_its_order(void **state) {
  (void)state;
  check_orders("erk", corot_rk_explicit);
}

/* --- solutions ------------------------------------------------------------------------------- */

typedef struct outcome {
  double tip; /* at the end */
  corot_statistics s;
} outcome;

static outcome run(const bar_def *of, const corot_integrator_def *def, double t_end) {
  bar b = bar_create(of);
  corot_integrator *integrator = start(&b, def);
  run_to(integrator, t_end);
  assert_ok(corot_integrator_at(integrator, t_end, b.u, NULL));
  outcome o = {b.u[b.tip], corot_integrator_statistics(integrator)};
  corot_integrator_destroy(integrator);
  bar_destroy(&b);
  return o;
}

/* The three methods have only the model in common. */
static void all_methods_agree(void **state) {
  (void)state;
  bar_def of = example2;
  of.ramp = 0.5;
  corot_integrator_def def = method_to("erk", 1e-11);
  double exact = run(&of, &def, 0.5).tip;
  def = method_to("arkode", 1e-8);
  assert_close(run(&of, &def, 0.5).tip, exact, 1e-8, 0);
  def = method_to("cvode", 1e-10);
  assert_close(run(&of, &def, 0.5).tip, exact, 1e-8, 0);
}

enum { MOMENTS = 8 };

/* The displacement at the moments 1/8, 2/8, ... 1, one after the other. */
static void record(const bar_def *of, const corot_integrator_def *def, double *u) {
  bar b = bar_create(of);
  corot_integrator *integrator = start(&b, def);
  for (int k = 1; k <= MOMENTS; k++, u += b.n) {
    run_to(integrator, (double)k / MOMENTS);
    assert_ok(corot_integrator_at(integrator, (double)k / MOMENTS, u, NULL));
  }
  corot_integrator_destroy(integrator);
  bar_destroy(&b);
}

/* Orders of magnitude only: the error of many steps is a few times that of one, and the longest
   steps may be better than their tolerance. Of all displacements at several moments, for the error
   of one of them passes through zero. */
static void the_error_follows_the_tolerance(void **state) {
  (void)state;
  bar_def of = example2;
  of.ramp = 0.5;
  bar b = bar_create(&of);
  int n = MOMENTS * b.n;
  bar_destroy(&b);
  double *exact = malloc(n * sizeof *exact), *u = malloc(n * sizeof *u);
  corot_integrator_def def = method_to("erk", 1e-10);
  record(&of, &def, exact);
  double most = norm_max(n, exact);
  for (int order = 2; order <= 5; order++) {
    def = method_to("arkode", 1e-3);
    def.order = order;
    record(&of, &def, u);
    double coarse = difference_of(n, u, exact) / most;
    def.rtol = 1e-5;
    record(&of, &def, u);
    double fine = difference_of(n, u, exact) / most;
    assert_below(coarse, 3e-3);
    assert_below(fine, fmin(1e-4, coarse / 5));
  }
  free(exact), free(u);
}

/* Each choice of the Newton iteration has its effect; the explicit method has none. */
static void the_counts_are_the_methods_own(void **state) {
  (void)state;
  bar_def of = example2;
  of.ramp = 0.5;
  corot_integrator_def def = method_to("arkode", 1e-4);
  corot_statistics s = run(&of, &def, 1).s;
  assert_true(s.nst > 10 && s.nni > 6 * s.nst && s.nfe > s.nni);
  assert_true(s.nsetups > 0 && s.nsetups < s.nst && s.nfactor == s.nsetups && s.nje == s.nsetups);
  assert_int_equal(s.nsolve, s.nni);
  assert_true(s.nfeQ >= 2 * s.nst && s.nfeQ <= 5 * s.nst && s.qlast == 4);
  def.reassembly = 1000;
  corot_statistics seldom = run(&of, &def, 1).s;
  assert_true(seldom.nje < seldom.nsetups);
  def = method_to("arkode", 1e-4), def.refactorisation = 1;
  assert_true(run(&of, &def, 1).s.nsetups >= s.nst / 2);
  def = method_to("arkode", 1e-4), def.convergence = 1e-5;
  corot_statistics exact = run(&of, &def, 1).s;
  assert_true(exact.nni * s.nst > 1.2 * s.nni * exact.nst);
  def = method_to("arkode", 1e-4), def.predictor = 0;
  assert_true(run(&of, &def, 1).s.nni != s.nni);

  def = method_to("erk", 1e-4);
  s = run(&of, &def, 1).s;
  assert_true(s.nfe >= 5 * s.nst && s.nfe < 5.5 * s.nst);
  assert_true(s.nsetups + s.nni + s.ncfn + s.nje + s.nfactor + s.nsolve == 0);
}

/* No loss and no gain: what is put in is stored or lost, to the accuracy of the solution. */
static double worst_balance(const char *method, double rtol, double damping) {
  bar_def of = example2;
  of.ramp = 0.1, of.damping = damping;
  bar b = bar_create(&of);
  corot_integrator_def def = method_to(method, rtol);
  corot_integrator *integrator = start(&b, &def);
  double worst = 0, most = 0;
  corot_step step = {0};
  while (step.t < 0.5) {
    assert_ok(corot_integrator_step(integrator, 0.5, &step));
    for (int k = 1; k <= 3; k++) {
      double t = step.t - (k - 1) * 0.3 * step.h, dissipated, external;
      corot_energies e;
      assert_ok(corot_integrator_at(integrator, t, b.u, b.v));
      assert_ok(corot_energy(b.model, b.state, t, b.u, b.v, &e));
      assert_ok(corot_integrator_work(integrator, t, &dissipated, &external));
      worst = fmax(worst, fabs(e.kinetic + e.elastic + dissipated - external));
      most = fmax(most, fabs(external));
    }
  }
  corot_integrator_destroy(integrator);
  bar_destroy(&b);
  return worst / most;
}

static void the_energy_balance_closes(void **state) {
  (void)state;
  assert_below(worst_balance("arkode", 1e-4, 1), 3e-3);
  assert_below(worst_balance("arkode", 1e-8, 1), 1e-7);
  assert_below(worst_balance("erk", 1e-4, 1), 1e-5);
  assert_below(worst_balance("erk", 1e-11, 1), 1e-8);
  assert_below(worst_balance("arkode", 1e-8, 0), 1e-7);
}

/* --- the explicit limit ---------------------------------------------------------------------- */

static double limit_of(bar *b, int degree, const double *stability) {
  explicit_limit *limit;
  corot_mass_solver *mass;
  assert_ok(corot_mass_solver_create(b->model, &mass));
  assert_ok(corot_explicit_limit_create(b->model, b->state, mass, degree, stability, &limit));
  assert_true(corot_explicit_limit(limit) == INFINITY);
  for (int k = 0; k < 100; k++) corot_explicit_limit_follow(limit, 0, b->u);
  double h = corot_explicit_limit(limit);
  corot_explicit_limit_destroy(limit);
  corot_mass_solver_destroy(mass);
  return h;
}

/* Of the classical methods of order 3 and 4 without damping: sqrt 3 and sqrt 8 over the frequency;
   of Euler's, damped beyond vibration: 2 over the rate of decay. */
static void the_limit_is_that_of_the_fastest_mode(void **state) {
  (void)state;
  static const double taylor[] = {1, 1, 1. / 2, 1. / 6, 1. / 24};
  bar_def of = example2;
  of.damping = 0;
  bar b = bar_create(&of);
  double third = limit_of(&b, 3, taylor), fourth = limit_of(&b, 4, taylor);
  assert_close(fourth / third, sqrt(8. / 3), 0.03, 0);
  bar_destroy(&b);

  of.damping = 1e3;
  b = bar_create(&of);
  double first = limit_of(&b, 1, taylor), frequency = sqrt(3) / third;
  double beta = 1e-4 * of.damping, d = beta * frequency * frequency / 2;
  assert_close(first, 2 / (d + sqrt(d * d - frequency * frequency)), 0.05, 0);
  bar_destroy(&b);
}

/* However strong the damping, which asks for steps far shorter than a vibration. */
static void the_limit_keeps_up_with_the_damping(void **state) {
  (void)state;
  static const double taylor[] = {1, 1, 1. / 2, 1. / 6, 1. / 24};
  double rate = 0;
  for (double damping = 1e3; damping <= 1e7; damping *= 10) {
    bar_def of = example2;
    of.damping = damping;
    bar b = bar_create(&of);
    double first = limit_of(&b, 1, taylor), fourth = limit_of(&b, 4, taylor);
    assert_close(fourth / first, 2.785 / 2, 0.04, 0); /* of the stable part of the real axis */
    if (rate > 0) assert_close(first * damping, rate, 0.05, 0);
    rate = first * damping;
    bar_destroy(&b);
  }
}

/* At the limit error control has nothing to refuse, and the step is as long as it can be. */
static void steps_at_the_limit_do_not_fail(void **state) {
  (void)state;
  bar_def of = example2;
  of.ramp = 0.5;
  for (const rk_table *table = corot_rk_explicit; table->name; table++) {
    corot_integrator_def def = method_to("erk", 1e-2);
    def.table = table->name;
    corot_statistics s = run(&of, &def, 0.5).s;
    if (s.netf > 2) fail_msg("%s: %ld of %ld steps fail", table->name, s.netf, s.nst);
    assert_true(s.nst < 1500);
  }
}

/* --- steps ----------------------------------------------------------------------------------- */

static void every_stop_is_reached_exactly_and_once(void **state) {
  (void)state;
  enum { STOPS = 150 };
  static const corot_history histories[] = {COROT_HISTORY_AUTO, COROT_HISTORY_KEEP,
                                            COROT_HISTORY_RESTART};
  for (int k = 0; k < NMETHOD; k++) {
    bar b = quick_bar();
    corot_integrator_def def = method_to(methods[k], 1e-3);
    corot_integrator *integrator = start(&b, &def);
    corot_step step = {0};
    long steps = 0, restarts = 0;
    for (int stop = 1; stop <= STOPS; stop++) {
      int here = 0;
      while (step.t < 2e-3 * stop) {
        double before = step.t;
        assert_ok(corot_integrator_step(integrator, 2e-3 * stop, &step));
        assert_true(step.t > before && step.t <= 2e-3 * stop && step.h == step.t - before);
        assert_true(step.error <= 1);
        assert_true(++here <= 20);
      }
      assert_true(step.t == 2e-3 * stop);
      steps += here;
      if (stop % 4 < 3) assert_ok(corot_integrator_changed(integrator, histories[stop % 4]));
      restarts += stop % 4 == 2;
    }
    corot_statistics s = corot_integrator_statistics(integrator);
    assert_int_equal(s.nst, steps);
    assert_int_equal(s.nrestart, restarts);
    corot_integrator_destroy(integrator);
    bar_destroy(&b);
  }
}

static void a_stop_can_be_moved(void **state) {
  (void)state;
  for (int k = 0; k < NMETHOD; k++) {
    bar b = quick_bar();
    corot_integrator_def def = method_to(methods[k], 1e-4);
    corot_integrator *integrator = start(&b, &def);
    corot_step step = {0};
    for (int j = 0; j < 20; j++) assert_ok(corot_integrator_step(integrator, 40, &step));
    double near = step.t + step.h / 3;
    assert_ok(corot_integrator_step(integrator, near, &step));
    assert_true(step.t == near);
    assert_ok(corot_integrator_step(integrator, near + 1e-9, &step));
    assert_true(step.t == near + 1e-9);
    double rounding = nextafter(near + 1e-9, INFINITY);
    assert_ok(corot_integrator_step(integrator, rounding, &step));
    assert_true(step.t == rounding);
    assert_ok(corot_integrator_at(integrator, rounding, b.u, b.v));
    assert_ok(corot_integrator_step(integrator, 40, &step));
    assert_true(step.t > rounding && step.t < 40);
    corot_integrator_destroy(integrator);
    bar_destroy(&b);
  }
}

/* Against steps so short that their ends are the truth. */
static void the_interpolant_is_as_good_as_the_steps(void **state) {
  (void)state;
  for (int k = 0; k < NMETHOD; k++)
    for (int order = 2; order <= 5; order++) {
      bar b = quick_bar(), exact = quick_bar();
      corot_integrator_def def = method_to(methods[k], 1e-5);
      def.order = order;
      corot_integrator *integrator = start(&b, &def);
      def = method_to("erk", 1e-10);
      corot_integrator *fine = start(&exact, &def);
      corot_step step = {0};
      double at_end = 0, inside = 0;
      while (step.t < 0.3) {
        assert_ok(corot_integrator_step(integrator, 40, &step));
        if (step.t < 0.25) continue;
        for (int j = 1; j <= 4; j++) {
          double t = j == 4 ? step.t : step.t - step.h + j * (step.h / 4);
          if (t <= 0.25) continue;
          run_to(fine, t);
          assert_ok(corot_integrator_at(fine, t, exact.u, exact.v));
          assert_ok(corot_integrator_at(integrator, t, b.u, b.v));
          double error = difference_of(b.n, b.u, exact.u) / norm_max(b.n, exact.u) +
                         difference_of(b.n, b.v, exact.v) / norm_max(b.n, exact.v);
          if (j == 4)
            at_end = fmax(at_end, error);
          else
            inside = fmax(inside, error);
        }
      }
      if (!(inside < 3 * at_end + 1e-9))
        fail_msg("%s %d: error %g inside steps, %g at ends", methods[k], order, inside, at_end);
      corot_integrator_destroy(integrator);
      corot_integrator_destroy(fine);
      bar_destroy(&b);
      bar_destroy(&exact);
    }
}

static void only_the_last_step_can_be_asked_for(void **state) {
  (void)state;
  for (int k = 0; k < NMETHOD; k++) {
    bar b = quick_bar();
    corot_integrator_def def = method_to(methods[k], 1e-4);
    corot_integrator *integrator = start(&b, &def);
    double *u = malloc(b.n * sizeof *u), dissipated, external, after[2];
    assert_ok(corot_integrator_at(integrator, 0, b.u, b.v));
    assert_ok(corot_integrator_work(integrator, 0, &dissipated, &external));
    assert_true(dissipated == 0 && external == 0);
    corot_step step = {0};
    for (int j = 0; j < 20; j++) assert_ok(corot_integrator_step(integrator, 40, &step));
    double inside = step.t - step.h / 2;
    assert_fails(corot_integrator_at(integrator, step.t - 1.01 * step.h, u, NULL), COROT_EINVAL,
                 "not in the last step");

    /* the inside of the step outlives a change, but not a restart; its end outlives both */
    assert_ok(corot_integrator_at(integrator, inside, b.u, NULL));
    assert_ok(corot_integrator_work(integrator, inside, &dissipated, &external));
    assert_ok(corot_integrator_changed(integrator, COROT_HISTORY_AUTO));
    assert_ok(corot_integrator_at(integrator, inside, u, NULL));
    assert_int_equal(memcmp(u, b.u, b.n * sizeof *u), 0);
    assert_ok(corot_integrator_work(integrator, inside, &after[0], &after[1]));
    assert_true(after[0] == dissipated && after[1] == external);
    assert_ok(corot_integrator_at(integrator, step.t, b.u, NULL));
    assert_ok(corot_integrator_changed(integrator, COROT_HISTORY_RESTART));
    assert_ok(corot_integrator_at(integrator, step.t, u, NULL));
    assert_int_equal(memcmp(u, b.u, b.n * sizeof *u), 0);
    assert_fails(corot_integrator_at(integrator, inside, u, NULL), COROT_EINVAL, "(re)started");
    assert_int_equal(corot_integrator_statistics(integrator).nrestart, 1);
    free(u);
    corot_integrator_destroy(integrator);
    bar_destroy(&b);
  }
}

/* A step after a change of held frames is that of an integrator which begins there. */
static void a_change_leaves_no_trace_of_the_old_frames(void **state) {
  (void)state;
  for (int k = 0; k < NMETHOD; k++) {
    bar b = quick_bar();
    corot_state_use(b.state, COROT_FRAMES_HELD);
    corot_integrator_def def = method_to(methods[k], 1e-6);
    corot_integrator *integrator = start(&b, &def), *fresh;
    run_to(integrator, 0.3);
    assert_ok(corot_integrator_at(integrator, 0.3, b.u, b.v));
    assert_ok(corot_frames_update(b.model, b.state, 0.3, b.u, NULL));
    assert_ok(corot_integrator_changed(integrator, COROT_HISTORY_AUTO));
    def.first_step = 1e-4;
    assert_ok(corot_integrator_create(&def, b.model, b.state, 0.3, b.u, b.v, &fresh));
    double *u = malloc(2 * b.n * sizeof *u), *v = u + b.n;
    run_to(integrator, 0.3001);
    run_to(fresh, 0.3001);
    assert_ok(corot_integrator_at(integrator, 0.3001, b.u, b.v));
    assert_ok(corot_integrator_at(fresh, 0.3001, u, v));
    assert_below(difference_of(b.n, u, b.u), 1e-8 * norm_max(b.n, u));
    assert_below(difference_of(b.n, v, b.v), 1e-5 * norm_max(b.n, v));
    /* and inside the step the acceleration is that of the new frames */
    assert_ok(corot_integrator_at(integrator, 0.30005, b.u, b.v));
    assert_ok(corot_integrator_at(fresh, 0.30005, u, v));
    assert_below(difference_of(b.n, v, b.v), 1e-4 * norm_max(b.n, v));
    free(u);
    corot_integrator_destroy(integrator);
    corot_integrator_destroy(fresh);
    bar_destroy(&b);
  }
}

/* --- where there is no way on ---------------------------------------------------------------- */

/* A bar pressed into the ground. */
static void an_element_that_inverts_for_good_ends_the_run(void **state) {
  (void)state;
  for (int k = 0; k < NMETHOD; k++) {
    bar_def of = {.strain = "polar",
                  .cells = {1, 1, 2},
                  .damping = 1,
                  .traction = {0, 0, -5e4},
                  .Q = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    bar b = bar_create(&of);
    corot_integrator_def def = method_to(methods[k], 1e-4);
    corot_integrator *integrator = start(&b, &def);
    corot_step step = {0}, last = {0};
    corot_status status = COROT_OK;
    for (int j = 0; !status && j < 5000; j++) {
      last = step;
      status = corot_integrator_step(integrator, 40, &step);
    }
    assert_int_equal(status, COROT_EINTEGRATE);
    char words[64];
    snprintf(words, sizeof words, "%s: cannot get past t = ", methods[k]);
    for (int again = 0; again < 2; again++) {
      if (!strstr(corot_error(), words) || !strstr(corot_error(), "is inverted"))
        fail_msg("'%s'", corot_error());
      double dissipated, external;
      assert_true(step.t >= last.t);
      assert_ok(corot_integrator_at(integrator, step.t, b.u, b.v));
      assert_ok(corot_integrator_work(integrator, step.t, &dissipated, &external));
      assert_true(isfinite(norm_max(2 * b.n, b.u)) && dissipated > 0 && external > 0);
      assert_int_equal(corot_integrator_step(integrator, 40, &step), COROT_EINTEGRATE);
    }
    corot_integrator_destroy(integrator);
    bar_destroy(&b);
  }
}

/* A first step into an inverted state is but too long. */
static void a_step_too_long_is_taken_back(void **state) {
  (void)state;
  for (int k = 0; k < NMETHOD; k++) {
    bar_def of = example2;
    of.ramp = 0, of.traction[0] = 2e3;
    corot_integrator_def def = method_to(methods[k], 1e-2);
    def.first_step = 2;
    outcome o = run(&of, &def, 0.2);
    def.rtol = 1e-6, def.first_step = 0;
    assert_close(o.tip, run(&of, &def, 0.2).tip, 0.1, 0);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(what_there_is_none_of_is_refused),
      cmocka_unit_test(what_is_left_open_is_chosen),
      cmocka_unit_test(each_failed_allocation_is_survived),
      cmocka_unit_test(each_implicit_table_has_its_order),
      cmocka_unit_test(each_explicit_table_has_its_order),
      cmocka_unit_test(all_methods_agree),
      cmocka_unit_test(the_error_follows_the_tolerance),
      cmocka_unit_test(the_counts_are_the_methods_own),
      cmocka_unit_test(the_energy_balance_closes),
      cmocka_unit_test(the_limit_is_that_of_the_fastest_mode),
      cmocka_unit_test(the_limit_keeps_up_with_the_damping),
      cmocka_unit_test(steps_at_the_limit_do_not_fail),
      cmocka_unit_test(every_stop_is_reached_exactly_and_once),
      cmocka_unit_test(a_stop_can_be_moved),
      cmocka_unit_test(the_interpolant_is_as_good_as_the_steps),
      cmocka_unit_test(only_the_last_step_can_be_asked_for),
      cmocka_unit_test(a_change_leaves_no_trace_of_the_old_frames),
      cmocka_unit_test(an_element_that_inverts_for_good_ends_the_run),
      cmocka_unit_test(a_step_too_long_is_taken_back),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
