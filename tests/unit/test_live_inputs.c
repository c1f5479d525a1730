/* What comes in while a run goes on, through everything that sees it: forces, factors of loads. */
#include <corot/inputs.h>
#include <corot/statics.h>
#include <stdio.h>

#include "alloc.h"
#include "live.h"

/* --- Forces and factors ----------------------------------------------------------------------- */

/* The force of the first load on all nodes, at t. */
static double (*force_of_load(const body *b, double t))[3] {
  int nnode = b->mesh->nnode;
  double(*f)[3] = malloc(nnode * sizeof *f), (*rest)[3] = calloc(nnode, sizeof *rest);
  assert_ok(corot_load_force(b->model, t, 1, (const double(*)[3])rest, f));
  free(rest);
  return f;
}

static void give_ramp(corot_inputs *in, const body *loaded, double t0, double t1) {
  double(*f)[3] = force_of_load(loaded, t0), (*g)[3] = force_of_load(loaded, t1);
  assert_ok(corot_inputs_ramp_force(in, loaded->mesh->nnode, t0, (const double(*)[3])f, t1,
                                    (const double(*)[3])g));
  free(f), free(g);
}

static void a_force_is_the_load_of_a_model(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++)
    for (int order = 1; order <= 2; order++) {
      body with = make_bar(measures[m], order, 1, loads),
           without = make_bar(measures[m], order, 0, NULL);
      corot_inputs *in = give_inputs(&without);
      double *u = some_motion(with.n, 1e-3);
      give_ramp(in, &with, 0, 1);
      assert_same(&with, &without, 0.3, u); /* within the window, */
      assert_same(&with, &without, 1, u);   /* and at its end */
      double(*f)[3] = force_of_load(&with, 0.7);
      assert_ok(corot_inputs_set_force(in, with.mesh->nnode, (const double(*)[3])f));
      assert_same(&with, &without, 0.7, u);
      corot_state_stand_still(with.state, 0.7, 0.25),
          corot_state_stand_still(without.state, 0.7, 0.25);
      assert_same(&with, &without, 0.1, u);
      free(f), free(u);
      drop_body(&with), drop_with(&without, in);
    }
}

static void a_factor_is_that_of_a_load(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++) {
    corot_load scaled[NLOAD];
    memcpy(scaled, loads, sizeof loads);
    for (int k = 0; k < NLOAD; k++)
      for (int c = 0; c < 3; c++) scaled[k].value[c] *= 0.5 + k;
    body with = make_bar(measures[m], 1, NLOAD, scaled),
         in_time = make_bar(measures[m], 1, NLOAD, loads);
    corot_inputs *in = give_inputs(&in_time);
    double *u = some_motion(with.n, 1e-3), *jv = malloc(2 * with.n * sizeof *jv);
    for (int k = 0; k < NLOAD; k++) assert_ok(corot_inputs_set_load(in, k, 0.5 + k));
    assert_same(&with, &in_time, 0.3, u);
    assert_ok(corot_jvp(with.model, with.state, 0.3, u, u + with.n, COROT_TANGENT_EXACT, u, u, jv));
    assert_ok(corot_jvp(in_time.model, in_time.state, 0.3, u, u + with.n, COROT_TANGENT_EXACT, u, u,
                        jv + with.n));
    assert_below(difference_of(with.n, jv, jv + with.n), 1e-12 * norm_max(with.n, jv));
    /* along a line, 0.5 + k at 0.3 */
    for (int k = 0; k < NLOAD; k++) assert_ok(corot_inputs_ramp_load(in, k, 0.2, k, 0.4, 1 + k));
    assert_same(&with, &in_time, 0.3, u);
    free(u), free(jv);
    drop_body(&with), drop_with(&in_time, in);
  }
}

static void states_do_not_see_each_others_inputs(void **state) {
  (void)state;
  body b = make_bar("polar", 1, 1, loads);
  corot_inputs *one = give_inputs(&b), *two;
  corot_state *other, *plain;
  double *u = some_motion(b.n, 1e-3), *r = malloc(4 * b.n * sizeof *r);
  assert_ok(corot_inputs_create(b.model, &two));
  assert_ok(corot_state_create(b.model, &other));
  assert_ok(corot_state_create(b.model, &plain));
  assert_ok(corot_state_use_inputs(other, two));
  assert_ok(corot_inputs_set_load(one, 0, 0));
  assert_ok(corot_inputs_set_load(two, 0, 3));
  corot_state *of[] = {b.state, plain, other};
  for (int k = 0; k < 3; k++)
    assert_ok(corot_residual(b.model, of[k], 0.5, u, u + b.n, r + k * b.n));
  /* 0, 1 and 3 times the load */
  for (int i = 0; i < b.n; i++)
    assert_close(r[2 * b.n + i] - r[i], 3 * (r[b.n + i] - r[i]), 0, 1e-12 * norm_max(b.n, r));
  assert_true(difference_of(b.n, r, r + b.n) > 0.1);
  /* and none once they are taken away */
  assert_ok(corot_state_use_inputs(b.state, NULL));
  assert_ok(corot_residual(b.model, b.state, 0.5, u, u + b.n, r));
  assert_true(difference_of(b.n, r, r + b.n) == 0);
  corot_state_destroy(other), corot_state_destroy(plain);
  free(u), free(r);
  corot_inputs_destroy(two), drop_with(&b, one);
}

static void an_equilibrium_is_that_of_the_load(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++) {
    body with = make_bar(measures[m], 1, 1, loads), without = make_bar(measures[m], 1, 0, NULL);
    corot_inputs *in = give_inputs(&without);
    give_ramp(in, &with, 0, 1);
    double *u = calloc(2 * with.n, sizeof *u);
    corot_statics_def def = corot_statics_defaults();
    def.max_iterations = 100; /* warp's frames vary beside K */
    for (int k = 0; k < 2; k++) {
      corot_statics *statics;
      def.inputs = k ? in : NULL;
      assert_ok(corot_statics_create(&def, (k ? &without : &with)->model, 0.8, NULL, &statics));
      assert_ok(corot_statics_solve(statics));
      corot_statics_at(statics, u + k * with.n);
      corot_statics_destroy(statics);
    }
    assert_true(norm_max(with.n, u) > 1e-3);
    /* residuals of 1e-10, and a bar ten times softer in bending than a cube */
    assert_below(difference_of(with.n, u, u + with.n), 1e-7 * norm_max(with.n, u));
    free(u);
    drop_body(&with), drop_with(&without, in);
  }
}

/* --- Bad input -------------------------------------------------------------------------------- */

static void what_makes_no_sense_is_refused(void **state) {
  (void)state;
  body b = make_bar("polar", 1, 1, loads), other = make_bar("polar", 1, 1, loads);
  corot_inputs *in = give_inputs(&b);
  int nnode = b.mesh->nnode;
  double(*f)[3] = force_of_load(&b, 1), *u = some_motion(b.n, 1e-3),
  *r = malloc(2 * b.n * sizeof *r);
  const double(*force)[3] = (const double(*)[3])f;
  assert_ok(corot_inputs_set_force(in, nnode, force));
  assert_ok(corot_inputs_set_load(in, 0, 2));
  assert_ok(corot_residual(b.model, b.state, 0, u, u + b.n, r));

  assert_fails(corot_inputs_set_force(in, nnode - 1, force), COROT_EINVAL, "but the mesh has");
  assert_fails(corot_inputs_ramp_force(in, 3 * nnode, 0, force, 1, force), COROT_EINVAL,
               "but the mesh has");
  assert_fails(corot_inputs_ramp_force(in, nnode, 1, force, 1, force), COROT_EINVAL, "no length");
  assert_fails(corot_inputs_ramp_force(in, nnode, NAN, force, 1, force), COROT_EINVAL, "no length");
  assert_fails(corot_inputs_set_load(in, 1, 1), COROT_EINVAL,
               "there is no load 1: the model has 1");
  assert_fails(corot_inputs_set_load(in, -1, 1), COROT_EINVAL, "there is no load -1");
  assert_fails(corot_inputs_set_load(in, 0, INFINITY), COROT_EINVAL, "the factor of load 0 is inf");
  assert_fails(corot_inputs_ramp_load(in, 0, 0, NAN, 1, 1), COROT_EINVAL,
               "the factor of load 0 is");
  assert_fails(corot_inputs_ramp_load(in, 0, 1, 0, 0, 1), COROT_EINVAL, "no length");
  f[4][1] = NAN;
  assert_fails(corot_inputs_set_force(in, nnode, force), COROT_EINVAL,
               "y component of the force at node 4");
  assert_fails(corot_state_use_inputs(other.state, in), COROT_EINVAL, "of another model");

  /* all of which has changed nothing */
  assert_ok(corot_residual(b.model, b.state, 0, u, u + b.n, r + b.n));
  assert_true(difference_of(b.n, r, r + b.n) == 0);
  free(f), free(u), free(r);
  drop_body(&other), drop_with(&b, in);
}

static corot_status make_inputs(void *model) {
  corot_inputs *in;
  COROT_TRY(corot_inputs_create(model, &in));
  corot_inputs_destroy(in);
  return COROT_OK;
}

static void memory_may_run_out(void **state) {
  (void)state;
  body b = make_bar("polar", 1, 1, loads);
  assert_true(assert_survives_failed_allocations(make_inputs, b.model) > 3);
  drop_body(&b);
}

/* --- Integrators ------------------------------------------------------------------------------ */

/* To the last bit, for all sums are the same. */
static void every_integrator_takes_a_force_for_a_load(void **state) {
  (void)state;
  for (int i = 0; corot_method_at(i); i++) {
    body with = make_bar("polar", 1, 1, loads), without = make_bar("polar", 1, 0, NULL);
    corot_inputs *in = give_inputs(&without);
    double *u = malloc(2 * with.n * sizeof *u), work[2][2];
    give_ramp(in, &with, 0, 1);
    for (int k = 0; k < 2; k++) {
      corot_integrator *integrator = integrate_by(i, k ? &without : &with, 1e-5);
      go_to(integrator, 0.02);
      assert_ok(corot_integrator_at(integrator, 0.02, u + k * with.n, NULL));
      assert_ok(corot_integrator_work(integrator, 0.02, &work[k][0], &work[k][1]));
      corot_integrator_destroy(integrator);
    }
    /* but for the rounding of the line in time, and the steps that follow it */
    assert_below(difference_of(with.n, u, u + with.n), 1e-9 * norm_max(with.n, u));
    assert_close(work[1][1], work[0][1], 1e-8, 0);
    free(u);
    drop_body(&with), drop_with(&without, in);
  }
}

/* --- Windows ---------------------------------------------------------------------------------- */

enum { NWINDOW = 60 };
static const double window = 0.01;

/* What a partner pushes with at the ends of the windows. */
static double push(double t) { return sin(6.3 * t) + 0.3 * sin(19 * t + 1); }

/* The paper's bar under the partner's force: as a load of the model that is linear between the ends
   of the windows, or from outside. */
static body coupled_bar(bool from_outside) {
  static double time[NWINDOW + 1], value[NWINDOW + 1];
  for (int k = 0; k <= NWINDOW; k++) time[k] = k * window, value[k] = push(k * window);
  corot_box box = {.size = {0.1, 0.1, 0.6}, .cells = {1, 1, 6}};
  corot_load load = {COROT_TRACTION, "zmax", {200, 10, 0}, {NWINDOW + 1, time, value}};
  if (from_outside) load.amplitude = (corot_amplitude){0};
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = &soft;
  def.nfix = 1, def.fix = &base;
  def.nload = 1, def.load = &load;
  return make_body(mesh, def);
}

/* f [nnode] = `factor` times the traction. */
static void scale(int nnode, double factor, const double (*of)[3], double (*f)[3]) {
  for (int n = 0; n < nnode; n++)
    for (int c = 0; c < 3; c++) f[n][c] = factor * of[n][c];
}

/* How far it got by the end of the windows, and what it took: evaluations of r, factorisations and
   solves; the energy that is missing in the books, by the largest entry. */
typedef struct loop {
  int n;
  double *u; /* [n] */
  long cost;
  int order;
  double missing;
} loop;

static loop close_loop(loop l, const body *b, corot_integrator *integrator) {
  double t = NWINDOW * window, *v = l.u + b->n, dissipated, external;
  corot_statistics s = corot_integrator_statistics(integrator);
  corot_energies e;
  assert_ok(corot_integrator_at(integrator, t, l.u, v));
  assert_ok(corot_integrator_energy(integrator, l.u, v, &e));
  assert_ok(corot_integrator_work(integrator, t, &dissipated, &external));
  l.cost = s.nfe + s.nfactor + s.nsolve;
  l.order = s.qlast;
  l.missing = fabs(e.kinetic + e.elastic + dissipated - external) / fmax(external, dissipated);
  corot_integrator_destroy(integrator);
  return l;
}

/* By the i-th method, and stopping at the end of each window, with the partner's force for the next
   one or without. */
static loop run_windows(int i, double rtol, bool from_outside) {
  body b = coupled_bar(from_outside);
  corot_inputs *in = give_inputs(&b);
  int nnode = b.mesh->nnode;
  double(*one)[3] = force_of_load(&b, 0), (*f)[3] = malloc(2 * nnode * sizeof *f),
  (*g)[3] = f + nnode;
  if (from_outside) assert_ok(corot_inputs_set_load(in, 0, 0));
  corot_integrator *integrator = NULL;
  for (int k = 0; k < NWINDOW; k++) {
    double t0 = k * window, t1 = (k + 1) * window;
    if (from_outside) {
      scale(nnode, push(t0), (const double(*)[3])one, f);
      scale(nnode, push(t1), (const double(*)[3])one, g);
      assert_ok(
          corot_inputs_ramp_force(in, nnode, t0, (const double(*)[3])f, t1, (const double(*)[3])g));
    }
    if (!integrator)
      integrator = integrate_by(i, &b, rtol);
    else if (from_outside)
      assert_ok(corot_integrator_changed(integrator, COROT_HISTORY_AUTO));
    go_to(integrator, t1);
  }
  loop l = close_loop((loop){.n = b.n, .u = malloc(2 * b.n * sizeof *l.u)}, &b, integrator);
  free(one), free(f);
  drop_with(&b, in);
  return l;
}

/* A window costs no restart: what the loop takes beside a run that merely stops there is the noise
   of other steps, which is below 10 %; and both are as far off as the tolerance lets them be. */
static void windows_cost_what_stopping_costs(void **state) {
  (void)state;
  const double rtol[] = {1e-4, 1e-6};
  for (int i = 0; corot_method_at(i); i++)
    for (int k = 0; k < (corot_method_at(i)->controls_error ? 2 : 1); k++) {
      loop stops = run_windows(i, rtol[k], false), goes_on = run_windows(i, rtol[k], true);
      assert_true(goes_on.cost <= 1.2 * stops.cost);
      assert_true(goes_on.order >= stops.order);
      assert_below(difference_of(stops.n, stops.u, goes_on.u),
                   10 * rtol[k] * norm_max(stops.n, stops.u));
      assert_below(goes_on.missing, 3 * stops.missing); /* of the books, nearly nothing in common */
      free(stops.u), free(goes_on.u);
    }
}

/* A force that jumps begins a multistep method anew where the next step feels it, unless it is told
   to keep its past; and by every method the books close over it. */
static void a_jump_is_felt_or_not(void **state) {
  (void)state;
  const struct {
    double part; /* of the force that is added */
    corot_history history;
    bool restarts;
  } jump[] = {
      {1, COROT_HISTORY_AUTO, true},
      {1e-9, COROT_HISTORY_AUTO, false},
      {1e-9, COROT_HISTORY_RESTART, true},
      {1, COROT_HISTORY_KEEP, false},
  };
  for (int i = 0; corot_method_at(i); i++)
    for (size_t k = 0; k < sizeof jump / sizeof *jump; k++) {
      body with = make_bar("polar", 1, 1, loads), b = make_bar("polar", 1, 0, NULL);
      corot_inputs *in = give_inputs(&b);
      int nnode = b.mesh->nnode;
      double(*f)[3] = force_of_load(&with, 0), *u = malloc(2 * b.n * sizeof *u);
      assert_ok(corot_inputs_set_force(in, nnode, (const double(*)[3])f));
      corot_integrator *integrator = integrate_by(i, &b, 1e-6);
      go_to(integrator, 0.05);
      scale(nnode, 1 + jump[k].part, (const double(*)[3])f, f);
      assert_ok(corot_inputs_set_force(in, nnode, (const double(*)[3])f));
      assert_ok(corot_integrator_changed(integrator, jump[k].history));
      bool multistep = corot_method_at(i)->multistep;
      if (multistep)
        assert_int_equal(corot_integrator_statistics(integrator).nrestart, jump[k].restarts);
      go_to(integrator, 0.1);

      double dissipated, external;
      corot_energies e;
      assert_ok(corot_integrator_at(integrator, 0.1, u, u + b.n));
      assert_ok(corot_integrator_energy(integrator, u, u + b.n, &e));
      assert_ok(corot_integrator_work(integrator, 0.1, &dissipated, &external));
      /* of a constant step of a millisecond backward Euler is the worst */
      assert_below(fabs(e.kinetic + e.elastic + dissipated - external),
                   (corot_method_at(i)->controls_error ? 1e-4 : 0.1) * external);
      free(f), free(u);
      corot_integrator_destroy(integrator);
      drop_body(&with), drop_with(&b, in);
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_force_is_the_load_of_a_model),
      cmocka_unit_test(a_factor_is_that_of_a_load),
      cmocka_unit_test(states_do_not_see_each_others_inputs),
      cmocka_unit_test(an_equilibrium_is_that_of_the_load),
      cmocka_unit_test(what_makes_no_sense_is_refused),
      cmocka_unit_test(memory_may_run_out),
      cmocka_unit_test(every_integrator_takes_a_force_for_a_load),
      cmocka_unit_test(a_jump_is_felt_or_not),
      cmocka_unit_test(windows_cost_what_stopping_costs),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
