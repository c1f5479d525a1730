/* Supports on paths that come in while a run goes on. */
#include <corot/inputs.h>
#include <corot/statics.h>

#include "alloc.h"
#include "live.h"

static const double knots[] = {0, 0.3, 1}, places[] = {0, 1, -0.5};

/* Motions of the base whose velocity does not jump, so that a consistent mass is that of a base
   which is fixed. */
static const corot_motion motions[] = {
    {.kind = COROT_MOVE,
     .group = "zmin",
     .direction = {0.007, 0.004, -0.01},
     .amplitude = {.curve = COROT_CURVE_SINE, .frequency = 2, .phase = 1}},
    {.kind = COROT_TURN,
     .group = "zmin",
     .axis = {1, 2, 3},
     .center = {0.1, -0.2, 0.05},
     .angle = 0.05,
     .amplitude = {3, knots, places, COROT_CURVE_SMOOTH}},
};
enum { NMOTION = sizeof motions / sizeof *motions };

/* A bar whose base has that motion; NULL: is fixed. */
static body make_moved(const char *strain, int order, const corot_motion *motion) {
  corot_box box = {.size = {0.1, 0.1, 0.3}, .cells = {1, 1, 3}, .split = COROT_BOX_SYMMETRIC};
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  if (order == 2) mesh = given_order(mesh, 2);
  corot_material material = soft;
  material.damping_mass = 3;
  corot_model_def def = corot_model_defaults();
  def.strain = strain;
  def.nmaterial = 1, def.material = &material;
  def.nfix = motion ? 0 : 1, def.fix = &base;
  def.nmotion = motion ? 1 : 0, def.motion = motion;
  return make_body(mesh, def);
}

/* Rows for the nodes of a group: where, how fast and how quickly faster they are in a body at t. */
typedef struct rows {
  int n;
  double (*x)[3], (*v)[3], (*a)[3];
} rows;

static rows rows_of(const body *b, const char *name, double t) {
  const corot_group *group = corot_mesh_find_group(b->mesh, name);
  int nnode = b->mesh->nnode;
  double(*all)[3] = malloc(3 * nnode * sizeof *all), *zero = calloc(b->n, sizeof *zero);
  rows r = {.n = group->nnode, .x = malloc(3 * group->nnode * sizeof *r.x)};
  r.v = r.x + r.n, r.a = r.v + r.n;
  corot_state_nodal(b->model, b->state, t, zero, NULL, all, NULL);
  corot_nodal_motion(b->model, b->state, t, zero, zero, all + nnode, all + 2 * nnode);
  for (int k = 0; k < 3; k++)
    for (int i = 0; i < r.n; i++)
      memcpy(r.x[k * r.n + i], all[k * nnode + group->node[i]], sizeof *r.x);
  free(all), free(zero);
  return r;
}

static corot_path path_of_rows(const rows *r, double t) {
  return (corot_path){"zmin",
                      t,
                      r->n,
                      (const double(*)[3])r->x,
                      (const double(*)[3])r->v,
                      (const double(*)[3])r->a};
}

/* r, energies and powers, reactions, and where all nodes are. */
static void assert_same_at(const body *a, const body *b, double t, const double *u) {
  int n = a->n, nnode = a->mesh->nnode;
  double *r = malloc(3 * n * sizeof *r), *s = r + n;
  double(*f)[3] = malloc(4 * nnode * sizeof *f), (*g)[3] = f + 2 * nnode;
  corot_energies e, d;
  assert_ok(corot_residual(a->model, a->state, t, u, u + n, r));
  assert_ok(corot_residual(b->model, b->state, t, u, u + n, s));
  assert_below(difference_of(n, r, s), 1e-12 * norm_max(n, r));
  assert_ok(corot_energy(a->model, a->state, t, u, u + n, &e));
  assert_ok(corot_energy(b->model, b->state, t, u, u + n, &d));
  assert_close(e.elastic, d.elastic, 1e-12, 0);
  assert_close(e.power_dissipated, d.power_dissipated, 1e-11, 0);
  assert_close(e.power_supports, d.power_supports, 1e-11, 0);
  assert_close(e.power_external, d.power_external, 1e-10, 0);
  corot_nodal_forces of_a = {.internal = f, .inertial = f + nnode};
  corot_nodal_forces of_b = {.internal = g, .inertial = g + nnode};
  assert_ok(corot_forces(a->model, a->state, t, u, u + n, u + n, &of_a));
  assert_ok(corot_forces(b->model, b->state, t, u, u + n, u + n, &of_b));
  assert_below(difference_of(6 * nnode, f[0], g[0]), 1e-12 * norm_max(6 * nnode, f[0]));
  corot_state_nodal(a->model, a->state, t, u, u + n, f, f + nnode);
  corot_state_nodal(b->model, b->state, t, u, u + n, g, g + nnode);
  assert_below(difference_of(6 * nnode, f[0], g[0]), 1e-14);
  free(r), free(f);
}

/* A path on a fixed base, and on one that moves otherwise by itself, is the motion. */
static void a_path_is_the_motion_of_a_model(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++)
    for (int order = 1; order <= 2; order++)
      for (int k = 0; k < 2 * NMOTION; k++) {
        body moves = make_moved(measures[m], order, &motions[k / 2]);
        body led = make_moved(measures[m], order, k % 2 ? &motions[1 - k / 2] : NULL);
        corot_inputs *in = give_inputs(&led);
        double t = 0.2, *u = some_motion(moves.n, 1e-3), *d = some_motion(moves.n, 1);
        double *jv = malloc(2 * moves.n * sizeof *jv);
        rows r = rows_of(&moves, "zmin", t);
        corot_path path = path_of_rows(&r, t);
        assert_ok(corot_inputs_start_path(in, &path));
        assert_same_at(&moves, &led, t, u);
        assert_ok(
            corot_jvp(moves.model, moves.state, t, u, u + moves.n, COROT_TANGENT_EXACT, d, d, jv));
        assert_ok(corot_jvp(led.model, led.state, t, u, u + led.n, COROT_TANGENT_EXACT, d, d,
                            jv + led.n));
        assert_below(difference_of(led.n, jv, jv + led.n), 1e-12 * norm_max(led.n, jv));

        /* and the same by a window that ends there */
        double(*zero)[3] = calloc(r.n, sizeof *zero);
        corot_path rest = {"zmin", t - 0.1, r.n, (const double(*)[3])zero, NULL, NULL};
        assert_ok(corot_inputs_start_path(in, &rest));
        assert_ok(corot_inputs_reach(in, t - 0.1, &path));
        assert_same_at(&moves, &led, t, u);
        free(u), free(d), free(jv), free(r.x), free(zero);
        drop_body(&moves), drop_with(&led, in);
      }
}

/* One row is that of all; x, v and a are derivatives of each other along every kind of window,
   whose ends are where they are said to be. */
static void windows_are_smooth(void **state) {
  (void)state;
  body b = make_moved("polar", 1, NULL);
  corot_inputs *in = give_inputs(&b);
  const double x[][3] = {{0.01, 0, 0}, {0.02, 0.01, -0.01}, {0.01, 0.03, 0}};
  const double v[3] = {0.3, -0.2, 0.1}, a[3] = {1, 2, 3}, h = 1e-5;
  corot_path path = {"zmin", 1, 1, x, NULL, NULL};
  assert_ok(corot_inputs_start_path(in, &path));
  for (int kind = 0; kind < 3; kind++) {
    path = (corot_path){"zmin",
                        1.3 + 0.1 * kind,
                        1,
                        &x[(kind + 1) % 3],
                        kind > 0 ? &v : NULL,
                        kind > 1 ? &a : NULL};
    assert_ok(corot_inputs_reach(in, path.t - (kind ? 0.1 : 0.3), &path));
    rows end = rows_of(&b, "zmin", path.t), mid = rows_of(&b, "zmin", path.t - 0.04);
    rows before = rows_of(&b, "zmin", path.t - 0.04 - h),
         after = rows_of(&b, "zmin", path.t - 0.04 + h);
    for (int i = 0; i < end.n; i++)
      for (int c = 0; c < 3; c++) {
        assert_close(end.x[i][c], path.x[0][c], 0, 1e-15);
        if (kind > 0) assert_close(end.v[i][c], v[c], 0, 1e-13);
        if (kind > 1) assert_close(end.a[i][c], a[c], 0, 1e-11);
        /* off by h^2 times derivatives of some 1e4, and rounding over h */
        assert_close((after.x[i][c] - before.x[i][c]) / (2 * h), mid.v[i][c], 0, 1e-6);
        assert_close((after.v[i][c] - before.v[i][c]) / (2 * h), mid.a[i][c], 0, 1e-4);
      }
    free(end.x), free(mid.x), free(before.x), free(after.x);
  }
  drop_with(&b, in);
}

static void jumps_and_nonsense_are_refused(void **state) {
  (void)state;
  body b = make_moved("polar", 1, &motions[0]);
  corot_inputs *in = give_inputs(&b);
  rows r = rows_of(&b, "zmin", 0.5);
  corot_path path = path_of_rows(&r, 0.5), bad;
  double *u = some_motion(b.n, 1e-3), *q = malloc(2 * b.n * sizeof *q);
  assert_ok(corot_inputs_set_path(in, &path)); /* where the motion has it */
  assert_ok(corot_residual(b.model, b.state, 0.6, u, u + b.n, q));

  assert_fails(corot_inputs_set_path(in, (bad = path, bad.t = 0.6, &bad)), COROT_EINVAL,
               "jumps by");
  assert_fails(corot_inputs_set_path(in, (bad = path, bad.group = "hand", &bad)), COROT_EINVAL,
               "no group 'hand'");
  assert_fails(corot_inputs_set_path(in, (bad = path, bad.group = NULL, &bad)), COROT_EINVAL,
               "no group");
  assert_fails(corot_inputs_set_path(in, (bad = path, bad.group = "zmax", &bad)), COROT_EINVAL,
               "holds nothing of group 'zmax'");
  assert_fails(corot_inputs_set_path(in, (bad = path, bad.n = 2, &bad)), COROT_EINVAL,
               "a path of 2 rows");
  assert_fails(corot_inputs_set_path(in, (bad = path, bad.t = NAN, &bad)), COROT_EINVAL, "no time");
  assert_fails(corot_inputs_start_path(in, (bad = path, bad.x = NULL, &bad)), COROT_EINVAL,
               "no displacement");
  assert_fails(corot_inputs_reach(in, 0.5, &path), COROT_EINVAL, "no length");
  assert_fails(corot_inputs_reach(in, 0.4, (bad = path, bad.v = NULL, &bad)), COROT_EINVAL,
               "no velocity");
  assert_fails(corot_inputs_release(in, "zmin", 0.9), COROT_EINVAL, "jumps by");
  assert_fails(corot_inputs_release(in, "zmax", 0.5), COROT_EINVAL, "holds nothing");
  r.v[1][2] = INFINITY;
  assert_fails(corot_inputs_set_path(in, &path), COROT_EINVAL,
               "z component of the velocity at row 1");

  /* all of which has changed nothing; and released where the motion is, it goes on by that */
  assert_ok(corot_residual(b.model, b.state, 0.6, u, u + b.n, q + b.n));
  assert_true(difference_of(b.n, q, q + b.n) == 0);
  assert_ok(corot_inputs_release(in, "zmin", 0.5));
  assert_ok(corot_residual(b.model, b.state, 0.6, u, u + b.n, q));
  assert_ok(corot_state_use_inputs(b.state, NULL));
  assert_ok(corot_residual(b.model, b.state, 0.6, u, u + b.n, q + b.n));
  assert_true(difference_of(b.n, q, q + b.n) == 0);
  free(u), free(q), free(r.x);
  drop_with(&b, in);
}

/* --- Runs ------------------------------------------------------------------------------------- */

/* In windows of 0.01 s, over which the base goes as the model has it, or on paths of degree five
   with its places, velocities and accelerations at the ends: off by 1e-9 of its way. */
typedef struct trace {
  int n;
  double *u;
  long cost;
  double missing;
} trace;

static const double RTOL = 1e-5;

static trace run(int i, int order, bool led) {
  enum { NWINDOW = 20 };
  body moves = make_moved("polar", order, &motions[1]),
       b = make_moved("polar", order, led ? NULL : &motions[1]);
  corot_inputs *in = give_inputs(&b);
  corot_integrator *integrator = NULL;
  trace r = {.n = b.n, .u = malloc(2 * b.n * sizeof *r.u)};
  for (int k = 0; k < NWINDOW; k++) {
    double t0 = 0.01 * k, t1 = 0.01 * (k + 1);
    rows end = rows_of(&moves, "zmin", t1), begin = rows_of(&moves, "zmin", t0);
    corot_path path = path_of_rows(&end, t1), first = path_of_rows(&begin, t0);
    if (led && k == 0) assert_ok(corot_inputs_start_path(in, &first));
    if (led) assert_ok(corot_inputs_reach(in, t0, &path));
    if (!integrator)
      integrator = integrate_by(i, &b, RTOL);
    else if (led)
      assert_ok(corot_integrator_changed(integrator, COROT_HISTORY_AUTO));
    go_to(integrator, t1);
    free(end.x), free(begin.x);
  }
  double dissipated, external;
  corot_energies e;
  assert_ok(corot_integrator_at(integrator, 0.2, r.u, r.u + r.n));
  assert_ok(corot_integrator_energy(integrator, r.u, r.u + r.n, &e));
  assert_ok(corot_integrator_work(integrator, 0.2, &dissipated, &external));
  corot_statistics s = corot_integrator_statistics(integrator);
  r.missing = fabs(e.kinetic + e.elastic + dissipated - external) / external;
  r.cost = s.nfe + s.nfactor + s.nsolve;
  corot_integrator_destroy(integrator);
  drop_body(&moves), drop_with(&b, in);
  return r;
}

/* It costs a look at r a window, some of a tenth of the steps. */
static void every_integrator_follows(void **state) {
  (void)state;
  for (int i = 0; corot_method_at(i); i++)
    for (int order = 1; order <= 2; order++) {
      const corot_method_kind *kind = corot_method_at(i);
      if (order == 2 && (kind->explicit_steps || !kind->controls_error)) continue; /* seconds */
      trace moved = run(i, order, false), led = run(i, order, true);
      assert_below(difference_of(led.n, led.u, moved.u), 1e-4 * norm_max(led.n, led.u));
      assert_true(led.cost <= 1.2 * moved.cost);
      /* the noise of other steps; what is missing below the tolerance is so by chance */
      assert_below(led.missing, 4 * fmax(moved.missing, RTOL));
      free(moved.u), free(led.u);
    }
}

static void statics_stand_where_the_path_is(void **state) {
  (void)state;
  body moves = make_moved("polar", 1, &motions[1]), led = make_moved("polar", 1, NULL);
  corot_inputs *in = give_inputs(&led);
  rows r = rows_of(&moves, "zmin", 1);
  corot_path path = path_of_rows(&r, 1);
  double(*zero)[3] = calloc(r.n, sizeof *zero), *u = malloc(2 * led.n * sizeof *u);
  corot_path rest = {"zmin", 0, r.n, (const double(*)[3])zero, NULL, NULL};
  assert_ok(corot_inputs_start_path(in, &rest));
  path.v = path.a = NULL;
  assert_ok(corot_inputs_reach(in, 0, &path));
  for (int k = 0; k < 2; k++) {
    corot_statics_def def = corot_statics_defaults();
    corot_statics *statics;
    def.inputs = k ? in : NULL;
    assert_ok(corot_statics_create(&def, (k ? &led : &moves)->model, 1, NULL, &statics));
    assert_ok(corot_statics_solve(statics));
    corot_statics_at(statics, u + k * led.n);
    corot_statics_destroy(statics);
  }
  /* a rigid motion of the whole body */
  assert_true(norm_max(led.n, u) > 1e-3);
  assert_below(difference_of(led.n, u, u + led.n), 1e-7 * norm_max(led.n, u));
  free(u), free(zero), free(r.x);
  drop_body(&moves), drop_with(&led, in);
}

static corot_status make_path(void *of) {
  static const double zero[1][3];
  corot_inputs *in;
  const corot_path path = {"zmin", 0, 1, zero, NULL, NULL};
  COROT_TRY(corot_inputs_create(((const body *)of)->model, &in));
  corot_status status = corot_inputs_set_path(in, &path);
  corot_inputs_destroy(in);
  return status;
}

static void memory_may_run_out(void **state) {
  (void)state;
  body b = make_moved("polar", 1, NULL);
  assert_true(assert_survives_failed_allocations(make_path, &b) > 6);
  drop_body(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_path_is_the_motion_of_a_model), cmocka_unit_test(windows_are_smooth),
      cmocka_unit_test(jumps_and_nonsense_are_refused),  cmocka_unit_test(every_integrator_follows),
      cmocka_unit_test(statics_stand_where_the_path_is), cmocka_unit_test(memory_may_run_out),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
