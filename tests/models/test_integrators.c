/* Every integrator with error control, in the same tests: one trajectory, an error that follows the
   tolerance, stops and restarts that leave no mark, a ledger of energy that closes, and the same
   solution whatever the linear solver and the tangent. */
#include "bar.h"

static const double t_end = 1;

typedef struct variant {
  const char *name, *method;
  int max_order, order;
  double tight; /* tolerance at which the solution is right to 1e-8 */
  double
      slope; /* of log error over log tolerance, at least: p / (p + 1) of order p, less a margin */
} variant;

static const variant variants[] = {
    {"cvode 2", "cvode", 2, 0, 1e-12, 0.5},
    {"cvode 5", "cvode", 5, 0, 1e-10, 0.7},
    {"ida 2", "ida", 2, 0, 1e-12, 0.5},
    {"ida 5", "ida", 5, 0, 1e-10, 0.7},
    {"arkode 2", "arkode", 0, 2, 1e-12, 0.5},
    {"arkode 3", "arkode", 0, 3, 1e-10, 0.6},
    {"arkode 4", "arkode", 0, 4, 1e-10, 0.7},
    {"arkode 5", "arkode", 0, 5, 1e-10, 0.7},
    {"erk 3", "erk", 0, 3, 1e-10, 0},
    {"erk 4", "erk", 0, 4, 1e-10, 0},
    {"erk 5", "erk", 0, 5, 1e-10, 0},
    {"erk 8", "erk", 0, 8, 1e-10, 0}, /* stability keeps these right beyond what is asked for */
};
enum { NVARIANT = sizeof variants / sizeof *variants };

static corot_integrator_def def_of(const variant *v, double rtol) {
  corot_integrator_def def = corot_integrator_defaults();
  def.method = v->method, def.max_order = v->max_order, def.order = v->order, def.rtol = rtol;
  return def;
}

/* The bar, and its state at the end as CVODE has it at order 5 and 1e-13. */
typedef struct problem {
  bar bar;
  double *reference, *y; /* [2n] */
} problem;

static double energy_at(bar *b, double t, const double *y) {
  corot_energies e;
  assert_ok(corot_energy(b->model, b->state, t, y, y + b->n, &e));
  return e.kinetic + e.elastic;
}

/* To the end; `stop_every`: stops on the way, 0: none. Leaves the solution in p->y. */
static corot_statistics solve(problem *p, const corot_integrator_def *def, double stop_every) {
  corot_integrator *integrator = start(&p->bar, def);
  if (stop_every > 0)
    for (double t = stop_every; t < t_end; t += stop_every) {
      run_to(integrator, t);
      assert_ok(corot_integrator_changed(integrator, COROT_HISTORY_RESTART));
    }
  run_to(integrator, t_end);
  assert_ok(corot_integrator_at(integrator, t_end, p->y, p->y + p->bar.n));
  corot_statistics s = corot_integrator_statistics(integrator);
  corot_integrator_destroy(integrator);
  return s;
}

static double error(const problem *p) {
  int n = p->bar.n;
  return difference_of(n, p->y, p->reference) / norm_max(n, p->reference);
}

static int setup(void **state) {
  problem *p = calloc(1, sizeof *p);
  p->bar = bar_create(&example2);
  p->y = malloc(2 * p->bar.n * sizeof *p->y);
  p->reference = malloc(2 * p->bar.n * sizeof *p->reference);
  corot_integrator_def def = def_of(&variants[1], 1e-13);
  solve(p, &def, 0);
  memcpy(p->reference, p->y, 2 * p->bar.n * sizeof *p->y);
  *state = p;
  return 0;
}

static int teardown(void **state) {
  problem *p = *state;
  bar_destroy(&p->bar);
  free(p->reference), free(p->y), free(p);
  return 0;
}

static void all_find_one_trajectory(void **state) {
  problem *p = *state;
  for (int k = 0; k < NVARIANT; k++) {
    corot_integrator_def def = def_of(&variants[k], variants[k].tight);
    solve(p, &def, 0);
    if (!(error(p) < 1e-8)) fail_msg("%s: off by %.2e", variants[k].name, error(p));
  }
}

/* Tolerances a thousandfold apart, so that single accidents of step control do not count. */
static void the_error_follows_the_tolerance(void **state) {
  problem *p = *state;
  for (int k = 0; k < NVARIANT; k++) {
    const variant *v = &variants[k];
    corot_integrator_def loose = def_of(v, 1e-5), tight = def_of(v, 1e-8);
    solve(p, &loose, 0);
    double first = error(p);
    solve(p, &tight, 0);
    double slope = log10(first / error(p)) / 3;
    if (v->slope > 0 && !(slope > v->slope)) fail_msg("%s: error = C rtol^%.2f", v->name, slope);
    if (!(first < 1e-3)) fail_msg("%s: off by %.2e at 1e-5", v->name, first);
  }
}

/* A restart costs steps, of a low order to begin with, and adds an error of the tolerance's size.
 */
static void restarts_leave_no_mark(void **state) {
  problem *p = *state;
  for (int k = 0; k < NVARIANT; k++) {
    corot_integrator_def def = def_of(&variants[k], 1e-7);
    corot_statistics s = solve(p, &def, 0.0937);
    assert_int_equal(s.nrestart, 10);
    if (!(error(p) < 1e-4)) fail_msg("%s: off by %.2e", variants[k].name, error(p));
  }
}

static void the_ledger_of_energy_closes(void **state) {
  problem *p = *state;
  for (int k = 0; k < NVARIANT; k++) {
    double balance[2];
    for (int i = 0; i < 2; i++) {
      corot_integrator_def def = def_of(&variants[k], i ? 1e-8 : 1e-5);
      corot_integrator *integrator = start(&p->bar, &def);
      double dissipated, external;
      run_to(integrator, t_end);
      assert_ok(corot_integrator_at(integrator, t_end, p->y, p->y + p->bar.n));
      assert_ok(corot_integrator_work(integrator, t_end, &dissipated, &external));
      assert_above(dissipated, 0);
      balance[i] = fabs(energy_at(&p->bar, t_end, p->y) + dissipated - external) / external;
      corot_integrator_destroy(integrator);
    }
    if (!(balance[0] < 2e-3 && balance[1] < 2e-5))
      fail_msg("%s: balance %.2e at 1e-5, %.2e at 1e-8", variants[k].name, balance[0], balance[1]);
  }
}

/* Solvers and tangents change the iteration only: the solutions differ by what it leaves, which is
   a fraction of the tolerance. */
static void linear_algebra_makes_no_difference(void **state) {
  problem *p = *state;
  static const struct {
    const char *solver;
    corot_tangent tangent;
  } ways[] = {{"klu", COROT_TANGENT_HELD},
              {"klu", COROT_TANGENT_EXACT},
              {"klu", COROT_TANGENT_CLAMPED},
              {"cholmod", COROT_TANGENT_HELD},
              {"pcg", COROT_TANGENT_HELD}};
  for (int k = 0; k < NVARIANT; k++)
    for (size_t w = 0; w < sizeof ways / sizeof *ways; w++) {
      if (strcmp(variants[k].method, "erk") == 0) continue; /* has none */
      corot_integrator_def def = def_of(&variants[k], 1e-7);
      def.linear.solver = ways[w].solver, def.tangent = ways[w].tangent;
      corot_integrator *probe;
      corot_status status =
          corot_integrator_create(&def, p->bar.model, p->bar.state, 0, p->bar.u, p->bar.v, &probe);
      if (status == COROT_EINVAL && strcmp(ways[w].solver, "cholmod") == 0) continue;
      assert_ok(status); /* only cholmod may be left out of a build */
      corot_integrator_destroy(probe);
      corot_statistics s = solve(p, &def, 0);
      assert_int_equal(s.nindefinite, 0);
      if (!(error(p) < 3e-5))
        fail_msg("%s with %s, tangent %d: off by %.2e", variants[k].name, ways[w].solver,
                 ways[w].tangent, error(p));
    }
}

/* Under SUNDIALS' own names. */
static void the_counts_make_sense(void **state) {
  problem *p = *state;
  for (int k = 0; k < NVARIANT; k++) {
    corot_integrator_def def = def_of(&variants[k], 1e-5);
    corot_statistics s = solve(p, &def, 0);
    assert_true(s.nst > 10 && s.nfe >= s.nst && s.netf < s.nst && s.nfeQ >= s.nst);
    assert_true(s.nsolve >= s.nni && s.nfactor == s.nsetups && s.nje <= s.nsetups);
    assert_true(s.hlast > 0 && s.qlast >= 1 && s.force_s > 0 && s.work_s > 0 && s.integrator_s > 0);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(all_find_one_trajectory),
      cmocka_unit_test(the_error_follows_the_tolerance),
      cmocka_unit_test(restarts_leave_no_mark),
      cmocka_unit_test(the_ledger_of_energy_closes),
      cmocka_unit_test(linear_algebra_makes_no_difference),
      cmocka_unit_test(the_counts_make_sense),
  };
  return cmocka_run_group_tests(tests, setup, teardown);
}
