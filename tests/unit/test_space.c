/* The estimate of the space error, where it is known in closed form: of linear equilibria it is the
   difference to ten-node tets. */
#include <corot/space.h>
#include <corot/statics.h>

#include "alloc.h"
#include "core/model/model.h"
#include "order_2.h"
#include "solid.h"
#include "solver.h"

static const corot_fix foot = {"zmin", {true, true, true}};
static const corot_material firm = {
    .lambda = 3.0e4, .mu = 2.0e4, .density = 1000, .damping_lambda = 10, .damping_mu = 1};

/* A crooked block under loads of all kinds, times `size`. */
typedef struct block {
  corot_load load[4];
  corot_model_def def;
} block;

static void block_define(const char *strain, double size, block *b) {
  const corot_load all[] = {
      {COROT_TRACTION, "zmax", {size, 0.4 * size, -0.2 * size}, {0}},
      {COROT_GRAVITY, "", {0.0003 * size, 0, -0.0005 * size}, {0}},
      {COROT_PRESSURE, "xmax", {0.3 * size}, {0}},
      {COROT_FORCE, "ymax", {0, 0.2 * size, 0}, {0}},
  };
  memcpy(b->load, all, sizeof all);
  b->def = corot_model_defaults();
  b->def.strain = strain;
  b->def.nmaterial = 1, b->def.material = &firm;
  b->def.nfix = 1, b->def.fix = &foot;
  b->def.nload = 4, b->def.load = b->load;
}

/* The equilibrium, to rounding; the caller's to free. */
static double *equilibrium_of(const body *b) {
  corot_statics_def def = corot_statics_defaults();
  corot_statics *s;
  double *u = malloc(b->n * sizeof *u);
  def.tolerance = 1e-13;
  assert_ok(corot_statics_create(&def, b->model, 0, NULL, &s));
  assert_ok(corot_statics_solve(s));
  corot_statics_at(s, u);
  corot_statics_destroy(s);
  return u;
}

static corot_space_moment still(const double *u) {
  return (corot_space_moment){.u = u, .still = true, .factor = 1};
}

/* How far e is from the difference of the equilibria of both orders, and how large that is: the
   largest component at a node of both. */
static void compare(const block *of, const corot_linear_def *linear, double *off, double *most) {
  corot_mesh *mesh = linear_box(3, 2, 3);
  body one = make_body(mesh, of->def), two = make_body(with_order(mesh, 2), of->def);
  double *u1 = equilibrium_of(&one), *u2 = equilibrium_of(&two);
  size_t nnode = (size_t)mesh->nnode;
  double(*e)[3] = malloc(nnode * sizeof *e);
  double(*x1)[3] = malloc(nnode * sizeof *x1);
  double(*x2)[3] = malloc((size_t)two.mesh->nnode * sizeof *x2);
  corot_space_moment at = still(u1);
  corot_space_estimate estimate;
  assert_ok(corot_space_error(&of->def, one.model, &at, linear, e, &estimate));
  assert_false(estimate.indefinite);
  assert_above(estimate.error, 0);
  corot_nodal(one.model, 0, u1, u1, x1, NULL);
  corot_nodal(two.model, 0, u2, u2, x2, NULL);
  *off = *most = 0;
  for (size_t n = 0; n < nnode; n++)
    for (int c = 0; c < 3; c++) {
      double difference = x2[n][c] - x1[n][c];
      *most = fmax(*most, fabs(difference));
      if (!(fabs(e[n][c] - difference) <= *off)) *off = fabs(e[n][c] - difference);
    }
  free(u1), free(u2), free(e), free(x1), free(x2);
  drop_body(&one), drop_body(&two);
}

static void of_a_linear_equilibrium_it_is_the_difference_of_both(void **state) {
  (void)state;
  const corot_linear_def *const linear[] = {SOLVER_TO("pcg", 1e-13), SOLVER("klu")};
  const corot_dilatation kind[] = {COROT_DILATATION_LOCAL, COROT_DILATATION_NODAL,
                                   COROT_DILATATION_ELEMENT};
  for (int k = 0; k < 3; k++)
    for (int l = 0; l < 3; l++) {
      block of;
      double off, most;
      block_define("cauchy", 100, &of);
      of.def.nload = k == 0 ? 2 : 4; /* the last two are not the same on both, and follow */
      of.load[2] = of.load[0];
      of.def.dilatation = kind[k];
      compare(&of, l < 2 ? linear[l] : NULL, &off, &most);
      /* rounding of equilibria; the tolerance of conjugate gradients by default is 1e-4 */
      assert_below(off, (l < 2 ? 1e-9 : 1e-3) * most);
      assert_above(most, 1e-5);
    }
}

/* One step of Newton's iteration: what it leaves shrinks with the square of the error, the part of
   which it is with the load. The tangent of warp leaves out the turning of the frames, and a
   pressure turns, which is in no tangent: both are of that size, too. */
static void of_any_measure_it_is_so_as_loads_get_small(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++) {
    double off[2], most[2];
    for (int k = 0; k < 2; k++) {
      block of;
      block_define(measures[m], k == 0 ? 200 : 20, &of);
      compare(&of, SOLVER_TO("pcg", 1e-13), &off[k], &most[k]);
    }
    assert_below(off[0], 0.05 * most[0]);
    assert_below(off[1] / most[1], 0.2 * off[0] / most[0] + 1e-8);
  }
}

/* --- Motion --- */

/* Estimates at all nodes of a model; the caller's to free. */
static double (*error_of(const corot_model_def *def, const body *b, const corot_space_moment *at,
                         corot_space_estimate *estimate))[3] {
  double(*e)[3] = malloc((size_t)b->mesh->nnode * sizeof *e);
  assert_ok(corot_space_error(def, b->model, at, SOLVER_TO("pcg", 1e-12), e, estimate));
  return e;
}

/* A straight bar, its own mirror image, or two of them, 3 m apart, with groups of the same names.
 */
static corot_mesh *bars(int count) {
  corot_box box = corot_box_defaults();
  box.size[0] = box.size[1] = 1, box.size[2] = 3;
  box.cells[0] = box.cells[1] = 2, box.cells[2] = 4;
  corot_mesh *one, *all;
  assert_ok(corot_mesh_box(&box, &one));
  size_t nnode = (size_t)one->nnode, ntet = (size_t)one->ntet;
  double(*x)[3] = malloc(2 * nnode * sizeof *x);
  int(*tet)[4] = malloc(2 * ntet * sizeof *tet);
  for (size_t n = 0; n < 2 * nnode; n++) {
    memcpy(x[n], one->x[n % nnode], sizeof *x);
    x[n][0] += n < nnode ? 0 : 3;
  }
  for (size_t k = 0; k < 8 * ntet; k++)
    tet[k / 4][k % 4] = one->tet[k / 4 % ntet][k % 4] + (k < 4 * ntet ? 0 : one->nnode);
  assert_ok(corot_mesh_create(count * one->nnode, (const double(*)[3])x, count * one->ntet,
                              (const int(*)[4])tet, &all));
  assert_ok(corot_mesh_group_plane(all, "zmin", 2, 0, 0));
  assert_ok(corot_mesh_group_plane(all, "zmax", 2, 3, 0));
  corot_mesh_destroy(one);
  free(x), free(tet);
  return all;
}

/* Infinitesimal rigid motions d change no distance: (x_i - x_j) . (d_i - d_j) = 0. */
static double change_of_distances(const corot_mesh *mesh, int nnode, const double (*d)[3]) {
  double most = 0;
  for (int i = 0; i < nnode; i++)
    for (int j = 0; j < i; j++) {
      double change = 0;
      for (int c = 0; c < 3; c++) change += (mesh->x[i][c] - mesh->x[j][c]) * (d[i][c] - d[j][c]);
      if (!(fabs(change) <= most)) most = fabs(change);
    }
  return most;
}

/* A bar that is pulled along its axis by `pull` [Pa] and flies, has the deformation of one that is
   held in three points by just so much that it cannot move, in a field of gravity that balances
   the pull. So has each of two. */
static void a_body_that_flies_is_held_by_its_inertia(void **state) {
  (void)state;
  const double pull = 50, g = pull / (firm.density * 3);
  corot_load acting[] = {{COROT_TRACTION, "zmax", {0, 0, pull}, {0}},
                         {COROT_GRAVITY, "", {0, 0, -g}, {0}}};
  corot_fix fix[] = {
      {"o", {true, true, true}}, {"x", {false, true, true}}, {"y", {false, false, true}}};
  const double corner[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  corot_model_def def = corot_model_defaults();
  def.strain = "cauchy", def.nmaterial = 1, def.material = &firm, def.load = acting;
  /* held */
  corot_mesh *mesh = bars(1);
  for (int k = 0; k < 3; k++) {
    int node = corot_mesh_nearest(mesh, corner[k]);
    assert_ok(corot_mesh_group_nodes(mesh, fix[k].group, 1, &node));
  }
  def.nload = 2, def.nfix = 3, def.fix = fix;
  body held = make_body(mesh, def);
  double *u = equilibrium_of(&held);
  double(*x)[3] = malloc((size_t)mesh->nnode * sizeof *x);
  corot_space_estimate expected, found;
  corot_space_moment at = still(u);
  double(*e)[3] = error_of(&def, &held, &at, &expected);
  corot_nodal(held.model, 0, u, u, x, NULL);
  assert_above(change_of_distances(mesh, mesh->nnode, (const double(*)[3])e), 1e-5);
  /* free, alone and beside another */
  for (int count = 1; count < 3; count++) {
    def.nload = 1, def.nfix = 0;
    body flying = make_body(bars(count), def);
    double *w = calloc((size_t)(2 * flying.n), sizeof *w);
    for (int i = 0; i < flying.n; i++) w[i] = x[i / 3 % mesh->nnode][i % 3];
    at = (corot_space_moment){.u = w, .v = w + flying.n};
    double(*d)[3] = error_of(&def, &flying, &at, &found);
    for (int b = 0; b < count; b++) {
      double(*of)[3] = d + b * mesh->nnode;
      for (int n = 0; n < mesh->nnode; n++)
        for (int c = 0; c < 3; c++) of[n][c] -= e[n][c];
      /* the springs that tie it down are 1e-5 of the frequency's square, a part of 1e-6 of the
         bar's own stiffness */
      assert_below(change_of_distances(mesh, mesh->nnode, (const double(*)[3])of), 3e-5 * 1e-1);
    }
    free(w), free(d);
    drop_body(&flying);
  }
  free(u), free(x), free(e);
  drop_body(&held);
}

/* On a base that shakes the body is in a field of gravity against the base's acceleration; and its
   displacement is counted from the base. */
static void a_moving_base_is_a_field_of_gravity(void **state) {
  (void)state;
  const double frequency = 0.3, omega = 2 * 3.14159265358979 * frequency, t = 0.4;
  const double way[3] = {0.5, -0.2, 0.1};
  corot_load gravity = {COROT_GRAVITY, "", {0, 0, 0}, {0}};
  corot_motion shake = {COROT_MOVE, "zmin"};
  shake.amplitude = (corot_amplitude){.curve = COROT_CURVE_SINE, .frequency = frequency};
  double s = sin(omega * t), c = cos(omega * t);
  for (int i = 0; i < 3; i++)
    shake.direction[i] = way[i], gravity.value[i] = omega * omega * s * way[i];
  block still_one, moving;
  corot_space_estimate expected, found;
  /* standing in gravity */
  block_define("cauchy", 0, &still_one);
  still_one.def.nload = 1, still_one.def.load = &gravity;
  body one = make_body(linear_box(2, 2, 3), still_one.def);
  double *u = equilibrium_of(&one);
  corot_space_moment at = still(u);
  double(*e)[3] = error_of(&still_one.def, &one, &at, &expected);
  /* and shaken */
  block_define("cauchy", 0, &moving);
  moving.def.nload = moving.def.nfix = 0;
  moving.def.nmotion = 1, moving.def.motion = &shake;
  body two = make_body(linear_box(2, 2, 3), moving.def);
  assert_int_equal(one.n, two.n);
  double *w = malloc((size_t)(2 * two.n) * sizeof *w);
  for (int i = 0; i < two.n; i++) { /* node by node all components are free, or none is */
    w[i] = u[i] + s * way[i % 3];
    w[two.n + i] = omega * c * way[i % 3];
  }
  at = (corot_space_moment){.t = t, .u = w, .v = w + two.n};
  double(*d)[3] = error_of(&moving.def, &two, &at, &found);
  double most = 0;
  for (int n = 0; n < one.mesh->nnode; n++)
    for (int k = 0; k < 3; k++) most = fmax(most, fabs(e[n][k]));
  for (int n = 0; n < one.mesh->nnode; n++)
    for (int k = 0; k < 3; k++) assert_close(d[n][k], e[n][k], 0, 1e-8 * most);
  assert_close(found.relative, expected.relative, 1e-6, 0);
  free(u), free(w), free(e), free(d);
  drop_body(&one), drop_body(&two);
}

/* Turned by a right angle, a body that spins errs as it did before, and neither the turn nor the
   way that it has flown are taken for deformation. */
static void turns_of_a_free_body_are_no_displacement(void **state) {
  (void)state;
  const double axis[3] = {0, 1, 0}, way[3] = {7, -5, 3}, spin = 0.5;
  corot_model_def def = corot_model_defaults();
  corot_load pull = {COROT_TRACTION, "zmax"};
  def.nmaterial = 1, def.material = &firm, def.nload = 1, def.load = &pull;
  double(*first)[3] = NULL, Q[9];
  corot_space_estimate estimate[2];
  for (int k = 0; k < 2; k++) {
    rotation(axis, k * 1.5707963267949, Q);
    apply(Q, (const double[3]){0, 0, 20}, pull.value);
    body b = make_body(bars(1), def);
    double *w = malloc((size_t)(2 * b.n) * sizeof *w);
    for (int n = 0; n < b.mesh->nnode; n++) {
      double arm[3] = {b.mesh->x[n][0] - 0.5, b.mesh->x[n][1] - 0.5, b.mesh->x[n][2] - 1.5}, to[3];
      apply(Q, arm, to);
      for (int c = 0; c < 3; c++) w[3 * n + c] = to[c] - arm[c] + k * way[c];
      double v[3] = {spin * to[2], 0, -spin * to[0]};
      for (int c = 0; c < 3; c++) w[b.n + 3 * n + c] = v[c] + k * way[c];
    }
    corot_space_moment at = {.u = w, .v = w + b.n};
    double(*e)[3] = error_of(&def, &b, &at, &estimate[k]);
    for (int n = 0; k == 1 && n < b.mesh->nnode; n++) {
      double turned[3];
      apply(Q, first[n], turned);
      for (int c = 0; c < 3; c++) assert_close(e[n][c], turned[c], 0, 1e-6 * estimate[0].error);
    }
    /* it is not stretched yet, so that all is missing that inertia and pull want: up to 20 Pa / E
       of its length */
    assert_above(estimate[k].error, 1e-5);
    assert_below(estimate[k].displacement, 1e-3);
    assert_close(estimate[k].relative, 1, 0.02, 0);
    free(w);
    if (k == 0)
      first = e;
    else
      free(e);
    drop_body(&b);
  }
  free(first);
}

/* Accelerations of supports by differences of their velocities. */
static void accelerations_of_supports_change_their_velocities(void **state) {
  (void)state;
  const double t = 0.37, h = 1e-5;
  corot_motion turn = {COROT_TURN, "zmin"};
  turn.axis[0] = 1, turn.axis[2] = 2, turn.center[1] = 0.7, turn.angle = 1.3;
  turn.amplitude = (corot_amplitude){.curve = COROT_CURVE_SINE, .frequency = 0.8, .phase = 0.4};
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = &firm, def.nmotion = 1, def.motion = &turn;
  body b = make_body(linear_box(2, 2, 2), def);
  size_t nnode = (size_t)b.mesh->nnode;
  double *zero = calloc((size_t)b.n, sizeof *zero);
  double(*v)[3] = malloc(3 * nnode * sizeof *v);
  instant now = {.t = t, .side = NAN, .moving = true};
  corot_model_acceleration(b.model, &now, zero, v[2 * nnode], 3);
  for (int k = 0; k < 2; k++) {
    now.t = t + (k ? h : -h);
    corot_model_velocity(b.model, &now, zero, v[k * nnode], 3);
  }
  for (size_t n = 0; n < nnode; n++)
    for (int c = 0; c < 3; c++) /* to the third derivative times h^2, and rounding over h */
      assert_close(v[2 * nnode + n][c], (v[nnode + n][c] - v[n][c]) / (2 * h), 1e-6, 1e-6);
  free(zero), free(v);
  drop_body(&b);
}

/* --- Where there is nothing to say --- */

static void a_body_at_rest_has_no_error(void **state) {
  (void)state;
  for (int fixed = 0; fixed < 2; fixed++) {
    block of;
    block_define("polar", 0, &of);
    of.def.nload = 0, of.def.nfix = fixed;
    body b = make_body(linear_box(2, 2, 2), of.def);
    double *w = calloc((size_t)(2 * b.n), sizeof *w);
    corot_space_moment at = {.u = w, .v = w + b.n};
    corot_space_estimate estimate;
    assert_ok(corot_space_error(&of.def, b.model, &at, NULL, NULL, &estimate));
    assert_below(estimate.error, 1e-14);
    assert_close(estimate.relative, 0, 0, 0);
    free(w);
    drop_body(&b);
  }
}

/* A strut that is pressed to beyond the load that buckles it, and stays straight. What it lacks is
   known all the same, with the stiffness of the material alone: no less than what is missing to a
   stable one. */
static void an_unstable_state_is_said_to_be_so(void **state) {
  (void)state;
  const corot_linear_def *const linear[] = {NULL, SOLVER("auto")};
  for (int m = 0; m < NMEASURE; m++) {
    corot_model_def def = corot_model_defaults();
    def.strain = measures[m];
    def.nmaterial = 1, def.material = &firm, def.nfix = 1, def.fix = &foot;
    body b = make_body(bars(1), def);
    const int(*dof)[3] = corot_model_dof(b.model);
    double *u = calloc((size_t)b.n, sizeof *u), first = 0;
    for (int n = 0; n < b.mesh->nnode; n++)
      if (dof[n][2] >= 0) u[dof[n][2]] = -0.2 * b.mesh->x[n][2];
    corot_space_moment at = still(u);
    for (int k = 0; k < 2; k++) {
      corot_space_estimate estimate;
      assert_ok(corot_space_error(&def, b.model, &at, linear[k], NULL, &estimate));
      bool stable = corot_strain_find(measures[m])->linear || !strcmp(measures[m], "warp");
      assert_int_equal(estimate.indefinite, !stable);
      assert_above(estimate.error, 0);
      if (k == 0) first = estimate.error;
      assert_close(estimate.error, first, 1e-3, 0);
    }
    free(u);
    drop_body(&b);
  }
}

static void what_cannot_be_estimated_is_refused(void **state) {
  (void)state;
  block of;
  corot_space_estimate estimate = {.error = -1};
  block_define("polar", 1, &of);
  body one = make_body(linear_box(1, 1, 1), of.def),
       two = make_body(with_order(one.mesh, 2), of.def);
  double *u = calloc((size_t)two.n, sizeof *u);
  corot_space_moment at = still(u);
  assert_fails(corot_space_error(&of.def, two.model, &at, NULL, NULL, &estimate), COROT_EINVAL,
               "not of ten-node tets");
  corot_hierarchy_def hierarchy = corot_hierarchy_defaults();
  corot_model_def with = of.def;
  with.hierarchy = &hierarchy;
  assert_fails(corot_space_error(&with, one.model, &at, NULL, NULL, &estimate), COROT_EINVAL,
               "not of a hierarchy");
  at.still = false;
  assert_fails(corot_space_error(&of.def, one.model, &at, NULL, NULL, &estimate), COROT_EINVAL,
               "the state has no velocity");
  at = still(u);
  assert_fails(corot_space_error(&of.def, one.model, &at, SOLVER("abacus"), NULL, &estimate),
               COROT_EINVAL, "abacus");
  assert_close(estimate.error, -1, 0, 0); /* outputs are set on success only */
  free(u);
  drop_body(&one), drop_body(&two);
}

/* --- Memory --- */

typedef struct asked {
  const corot_model_def *def;
  const corot_model *model;
  corot_space_moment at;
} asked;

static corot_status ask(void *context) {
  asked *a = context;
  corot_space_estimate estimate;
  return corot_space_error(a->def, a->model, &a->at, NULL, NULL, &estimate);
}

static void failed_allocations_leave_nothing(void **state) {
  (void)state;
  for (int fixed = 0; fixed < 2; fixed++) {
    block of;
    block_define("polar", 1, &of);
    of.def.nfix = fixed;
    body b = make_body(linear_box(1, 1, 2), of.def);
    double *w = calloc((size_t)(2 * b.n), sizeof *w);
    asked a = {&of.def, b.model, {.u = w, .v = w + b.n}};
    assert_true(assert_survives_failed_allocations(ask, &a) > 20);
    free(w);
    drop_body(&b);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(of_a_linear_equilibrium_it_is_the_difference_of_both),
      cmocka_unit_test(of_any_measure_it_is_so_as_loads_get_small),
      cmocka_unit_test(a_body_that_flies_is_held_by_its_inertia),
      cmocka_unit_test(a_moving_base_is_a_field_of_gravity),
      cmocka_unit_test(turns_of_a_free_body_are_no_displacement),
      cmocka_unit_test(accelerations_of_supports_change_their_velocities),
      cmocka_unit_test(a_body_at_rest_has_no_error),
      cmocka_unit_test(an_unstable_state_is_said_to_be_so),
      cmocka_unit_test(what_cannot_be_estimated_is_refused),
      cmocka_unit_test(failed_allocations_leave_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
