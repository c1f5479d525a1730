/* Supports that move: their paths in time, and the work they do on a body. */
#include <corot/integrate.h>

#include "core/model/amplitude.h"
#include "solid.h"

static corot_mesh *bar_mesh(void) {
  corot_box box = {.size = {0.1, 0.1, 0.3}, .cells = {1, 1, 3}, .origin = {-0.05, -0.05, 0}};
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  return mesh;
}

static body moved_body(corot_mesh *mesh, const char *strain, int nmotion,
                       const corot_motion *motion) {
  corot_model_def def = corot_model_defaults();
  def.strain = strain, def.nmaterial = 1, def.material = &soft;
  def.nmotion = nmotion, def.motion = motion;
  return make_body(mesh, def);
}

static const corot_motion turn = {COROT_ROTATE, "zmin", {1, 2, 3}, {0.1, -0.2, 0.05}, 2,
                                  {0, 0, 0},    0.5,    1.5};
static const corot_motion shift = {COROT_TRANSLATE, "zmax", {0, 0, 0}, {0, 0, 0}, 0,
                                   {1, -2, 0.5},    -1,     0.8};

static double largest(int n, const double (*a)[3]) { return norm_max(3 * n, a[0]); }

/* Central differences: the error is h^2/6 of the third derivative, 2^3 times arms of 0.4 m, and the
   rounding of displacements over 2 h. Before and after the motion both sides are zero. */
static void velocity_is_the_derivative_of_the_path(void **state) {
  (void)state;
  const corot_motion both[] = {turn, shift};
  body b = moved_body(bar_mesh(), "polar", 2, both);
  int nnode = b.mesh->nnode;
  double h = 1e-5, *zero = calloc(b.n, sizeof *zero);
  double(*x)[3] = calloc(3 * nnode, sizeof *x), (*y)[3] = x + nnode, (*v)[3] = y + nnode;
  for (double t = -1.45; t < 2; t += 0.1) {
    corot_nodal(b.model, t - h, zero, zero, x, NULL);
    corot_nodal(b.model, t + h, zero, zero, y, NULL);
    corot_nodal(b.model, t, zero, zero, NULL, v);
    for (int n = 0; n < nnode; n++)
      for (int c = 0; c < 3; c++)
        assert_close((y[n][c] - x[n][c]) / (2 * h), v[n][c], 0, h * h + 1e-16 * 4 / h);
    if (t < -1 || t > 1.5) assert_true(largest(nnode, (const double(*)[3])v) == 0);
    if (t > -1 && t < 0.8) assert_close(largest(nnode, (const double(*)[3])v), 2, 1e-15, 0);
  }
  corot_nodal(b.model, -2, zero, zero, x, NULL);
  assert_true(largest(nnode, (const double(*)[3])x) == 0);
  free(x), free(zero), drop_body(&b);
}

/* A pause, and the way back: what has been turned and shifted stays, until it is undone. */
static void motions_of_a_group_follow_one_another(void **state) {
  (void)state;
  corot_motion there_and_back[4] = {turn, turn, shift, shift};
  there_and_back[1].rate = -4, there_and_back[1].from = 2, there_and_back[1].to = 2.5;
  for (int c = 0; c < 3; c++) there_and_back[3].velocity[c] *= -0.9;
  there_and_back[3].from = 0.8, there_and_back[3].to = 2.8;
  body b = moved_body(bar_mesh(), "polar", 4, there_and_back);
  body once = moved_body(bar_mesh(), "polar", 1, &turn);
  int nnode = b.mesh->nnode;
  double *zero = calloc(once.n, sizeof *zero);
  double(*x)[3] = calloc(2 * nnode, sizeof *x), (*y)[3] = x + nnode;
  corot_nodal(b.model, 1.7, zero, zero, x, NULL); /* in the pause */
  corot_nodal(once.model, 1.7, zero, zero, y, NULL);
  const corot_group *base = corot_mesh_find_group(b.mesh, "zmin");
  for (int i = 0; i < base->nnode; i++)
    for (int c = 0; c < 3; c++) assert_true(x[base->node[i]][c] == y[base->node[i]][c]);
  corot_nodal(b.model, 3, zero, zero, x, y);
  assert_below(largest(nnode, (const double(*)[3])x), 1e-15);
  assert_true(largest(nnode, (const double(*)[3])y) == 0);

  double kink[8];
  const double expected[] = {-1, 0.5, 0.8, 1.5, 2, 2.5, 2.8};
  assert_int_equal(corot_model_kinks(b.model, -2, 5, 8, kink), 7);
  for (int k = 0; k < 7; k++) assert_true(kink[k] == expected[k]);
  free(x), free(zero), drop_body(&b), drop_body(&once);
}

static const double pulse_time[] = {-0.5, 0.25, 1}, pulse_value[] = {0.1, 0.9, -0.4};

/* By each kind of amplitude, and two that add up, one to a shift at constant rate. */
static void amplitudes_move_supports(void **state) {
  (void)state;
  corot_amplitude by[] = {{3, pulse_time, pulse_value},
                          {3, pulse_time, pulse_value, COROT_CURVE_SMOOTH},
                          {.curve = COROT_CURVE_SINE, .frequency = 0.7, .phase = 1, .offset = 2},
                          {0}};
  for (int k = 0; k < 4; k++) {
    corot_motion m[] = {{.kind = COROT_MOVE, .group = "zmax", .direction = {1, -2, 0.5}},
                        {.kind = COROT_TURN, .group = "zmin", .axis = {1, 2, 3}, .angle = 0.8},
                        {.kind = COROT_MOVE, .group = "zmax", .direction = {0, 0, -1}},
                        shift};
    m[0].amplitude = m[1].amplitude = by[k], m[2].amplitude = by[2];
    m[3].from = 0.3;
    for (int c = 0; c < 3; c++) m[1].center[c] = turn.center[c];
    body b = moved_body(bar_mesh(), "polar", 4, m);
    int nnode = b.mesh->nnode, top = corot_mesh_find_group(b.mesh, "zmax")->node[0];
    double h = 1e-5, *zero = calloc(b.n, sizeof *zero);
    double(*x)[3] = calloc(3 * nnode, sizeof *x), (*y)[3] = x + nnode, (*v)[3] = y + nnode;
    amplitude a, sine;
    assert_ok(corot_amplitude_create(&by[k], "load", 0, &a));
    assert_ok(corot_amplitude_create(&by[2], "load", 0, &sine));
    for (double t = -0.93; t < 2; t += 0.1) { /* no kink is nearer than h */
      corot_nodal(b.model, t - h, zero, zero, x, NULL);
      corot_nodal(b.model, t + h, zero, zero, y, NULL);
      corot_nodal(b.model, t, zero, zero, NULL, v);
      for (int n = 0; n < nnode;
           n++) /* as in the test before; third derivatives of 2 (2 pi 0.7)^3 */
        for (int c = 0; c < 3; c++)
          assert_close((y[n][c] - x[n][c]) / (2 * h), v[n][c], 0, 100 * h * h + 1e-15 / h);
      corot_nodal(b.model, t, zero, zero, x, NULL);
      double shifted = fmin(fmax(t - 0.3, 0), 0.5);
      for (int c = 0; c < 3; c++)
        assert_close(x[top][c],
                     corot_amplitude_at(&a, NAN, t) * m[0].direction[c] +
                         corot_amplitude_at(&sine, NAN, t) * m[2].direction[c] +
                         shifted * shift.velocity[c],
                     1e-14, 1e-15);
      double Q[9], arm[3], turned[3];
      int base = corot_mesh_find_group(b.mesh, "zmin")->node[0];
      rotation(turn.axis, 0.8 * corot_amplitude_at(&a, NAN, t), Q);
      for (int c = 0; c < 3; c++) arm[c] = b.mesh->x[base][c] - turn.center[c];
      apply(Q, arm, turned);
      for (int c = 0; c < 3; c++) assert_close(x[base][c], turned[c] - arm[c], 0, 1e-15);
    }
    assert_int_equal(corot_model_kinks(b.model, -9, 9, 0, NULL), k == 0 ? 5 : 2);
    corot_amplitude_clear(&a), corot_amplitude_clear(&sine);
    free(x), free(zero), drop_body(&b);
  }
}

/* The velocity of a piecewise linear path jumps at its points: the state says which is meant. */
static void a_path_of_pieces_has_two_velocities_at_a_kink(void **state) {
  (void)state;
  corot_motion m = {.kind = COROT_MOVE,
                    .group = "zmin",
                    .direction = {0.001, 0, 0},
                    .amplitude = {2, (const double[]){0, 1}, (const double[]){0, 1}}};
  body b = moved_body(bar_mesh(), "polar", 1, &m);
  double *zero = calloc(2 * b.n, sizeof *zero), *r = zero + b.n;
  const struct {
    double phase, t;
    bool moving;
  } side[] = {{NAN, 0, true}, {-1, 0, false}, {0, 0, true}, {0, 1, true}, {1, 1, false}};
  for (int k = 0; k < 5; k++) {
    corot_energies e;
    corot_state_enter(b.state, side[k].phase);
    assert_ok(corot_energy(b.model, b.state, side[k].t, zero, zero, &e));
    assert_true((e.power_dissipated > 0) == side[k].moving);
  }
  assert_ok(corot_residual(b.model, b.state, 1, zero, zero, r));
  free(zero), drop_body(&b);
}

static void an_amplitude_that_cannot_move_is_refused(void **state) {
  (void)state;
  const double time[] = {0, 1, 1}, value[] = {0, 1, 2};
  corot_motion m[2] = {{.kind = COROT_MOVE, .group = "zmin", .direction = {1, 0, 0}}, {0}};
  corot_mesh *mesh = bar_mesh();
  corot_model_def def = corot_model_defaults();
  corot_model *model = NULL;
  def.mesh = mesh, def.nmaterial = 1, def.material = &soft, def.motion = m, def.nmotion = 1;
  m[0].amplitude = (corot_amplitude){3, time, value};
  assert_fails(corot_model_create(&def, &model), COROT_EINVAL,
               "motion 0: its amplitude jumps at t = 1, and group 'zmin' cannot be in two places");
  m[0].amplitude = (corot_amplitude){.curve = COROT_CURVE_SINE};
  assert_fails(corot_model_create(&def, &model), COROT_EINVAL,
               "motion 0: the amplitude's frequency");
  m[0].amplitude = (corot_amplitude){2, time, value}, m[0].direction[1] = NAN;
  assert_fails(corot_model_create(&def, &model), COROT_EINVAL, "motion 0: a number is not finite");
  m[0].direction[1] = 0, m[1] = m[0], m[1].kind = COROT_TURN, def.nmotion = 2;
  assert_fails(corot_model_create(&def, &model), COROT_EINVAL, "motion 1: the axis has no direc");
  m[1].axis[0] = 1, m[1].angle = INFINITY;
  assert_fails(corot_model_create(&def, &model), COROT_EINVAL, "motion 1: a number is not finite");
  m[1].angle = 1;
  assert_fails(
      corot_model_create(&def, &model), COROT_EINVAL,
      "motion 1: does not continue the other motion of zmin: it has to translate (motion 0)");
  assert_null(model);
  corot_mesh_destroy(mesh);
}

/* What a support that turns or translates puts in is what changes in the momentum it carries, and a
   part that hangs on no force at its nodes: dG/dt along a motion with M v' = r. */
static void supports_put_in_the_momentum_they_carry(void **state) {
  (void)state;
  corot_motion away = turn;
  away.kind = COROT_TRANSLATE;
  away.velocity[0] = 0.3, away.velocity[2] = -0.2;
  const corot_motion *motions[] = {&turn, &away};
  for (int k = 0; k < 2; k++) {
    body b = moved_body(bar_mesh(), "polar", 1, motions[k]);
    double *y = calloc(6 * b.n, sizeof *y), *rate = y + 2 * b.n, *near = y + 4 * b.n;
    const double t = 0.52, dt = 1e-6;
    double carried[2];
    uint64_t seed = 5;
    corot_energies e, there;
    for (int i = 0; i < 2 * b.n; i++) y[i] = (i < b.n ? 1e-3 : 0.1) * noise(&seed);
    assert_ok(corot_energy(b.model, b.state, t, y, y + b.n, &e));
    assert_true(e.carried == 0 && e.power_carried == e.power_supports);
    corot_state_enter(b.state, 0.5); /* now a step may not pass the support's stop */
    assert_ok(corot_energy(b.model, b.state, t, y, y + b.n, &e));
    assert_ok(corot_rhs(b.model, b.state, t, y, rate));
    for (int side = 0; side < 2; side++) {
      double h = side ? dt : -dt;
      for (int i = 0; i < 2 * b.n; i++) near[i] = y[i] + h * rate[i];
      assert_ok(corot_energy(b.model, b.state, t + h, near, near + b.n, &there));
      carried[side] = there.carried;
    }
    assert_above(fabs(e.carried), 1e-3);
    assert_above(fabs(e.power_supports - e.power_carried), 1e-2);
    assert_close(e.power_carried + (carried[1] - carried[0]) / (2 * dt), e.power_supports, 1e-6,
                 1e-6);
    free(y), drop_body(&b);
  }
}

/* At a kink the velocity has two values. Only the viscous force feels it, of a body at rest. */
static void the_state_knows_which_side_of_a_kink_is_meant(void **state) {
  (void)state;
  corot_motion little = turn;
  little.rate = 0.1;
  body b = moved_body(bar_mesh(), "polar", 1, &little);
  double *zero = calloc(2 * b.n, sizeof *zero), *r = zero + b.n;
  const double kink[] = {0.5, 1.5};
  for (int k = 0; k < 2; k++) {
    const struct {
      double phase;
      bool moving;
    } side[] = {{NAN, k == 0}, {kink[k], k == 0}, {k == 0 ? -10 : 0.5, k == 1}};
    for (int i = 0; i < 3; i++) {
      corot_energies e;
      corot_state_enter(b.state, side[i].phase);
      assert_ok(corot_energy(b.model, b.state, kink[k], zero, zero, &e));
      assert_true((e.power_dissipated > 0) == side[i].moving);
      assert_true((e.power_external != 0) == side[i].moving);
      if (k == 0) { /* nothing has been turned yet */
        assert_ok(corot_residual(b.model, b.state, kink[k], zero, zero, r));
        assert_true((norm_max(b.n, r) > 0) == side[i].moving);
        assert_close(e.power_external, e.power_dissipated, 1e-13, 0); /* all of it, at once */
      }
    }
  }
  corot_state_enter(b.state, 0.5); /* the law of a phase goes on beyond its end */
  double at_kink, beyond;
  corot_energies e;
  assert_ok(corot_energy(b.model, b.state, 1.5, zero, zero, &e));
  at_kink = e.power_dissipated;
  assert_ok(corot_energy(b.model, b.state, 1.5 + 1e-9, zero, zero, &e));
  beyond = e.power_dissipated;
  assert_close(beyond, at_kink, 1e-6, 0);
  free(zero), drop_body(&b);
}

static void what_is_held_twice_is_refused(void **state) {
  (void)state;
  corot_mesh *mesh = bar_mesh();
  corot_motion side = turn, motion[2] = {turn, turn};
  side.group = "xmin", motion[1] = side; /* shares an edge with zmin */
  corot_fix fix = {"zmin", {false, false, true}};
  corot_model_def def = corot_model_defaults();
  corot_model *model = NULL;
  def.mesh = mesh, def.nmaterial = 1, def.material = &soft, def.motion = motion;
  def.nmotion = 2;
  assert_fails(corot_model_create(&def, &model), COROT_EINVAL,
               "motion 1: node 0 of group 'xmin' is already held in x");
  def.nmotion = 1, def.nfix = 1, def.fix = &fix;
  assert_fails(corot_model_create(&def, &model), COROT_EINVAL,
               "motion 0: node 0 of group 'zmin' is already held in z");
  motion[0].axis[0] = motion[0].axis[1] = motion[0].axis[2] = 0, def.nfix = 0;
  assert_fails(corot_model_create(&def, &model), COROT_EINVAL,
               "motion 0: the axis has no direction");
  assert_null(model);
  corot_mesh_destroy(mesh);
}

/* All of the boundary turned by theta about z, the inner nodes with it: F = Q. The strain in a
   frame is rounding, some 1e-15 of coordinates over edges; cauchy's is (cos theta - 1) across the
   axis, which is a von Mises stress of 2 mu (1 - cos theta). */
static void a_turned_boundary_makes_stress_in_cauchy_only(void **state) {
  (void)state;
  corot_motion all = {COROT_ROTATE, "skin", {0, 0, 1}, {0.2, 0.7, 0}, 1.5, {0}, 0, INFINITY};
  double t = 0.8, theta = all.rate * t, Q[9];
  rotation(all.axis, theta, Q);
  for (int m = 0; m < NMEASURE; m++) {
    corot_mesh *mesh = crooked_box(3, 3, 3);
    int *node = malloc(mesh->nnode * sizeof *node), nnode = 0;
    char *seen = calloc(mesh->nnode, 1);
    for (int g = 0; g < 6; g++) /* the sides */
      for (int k = 0; k < mesh->group[g].nnode; k++) seen[mesh->group[g].node[k]] = 1;
    for (int n = 0; n < mesh->nnode; n++)
      if (seen[n]) node[nnode++] = n;
    assert_ok(corot_mesh_group_nodes(mesh, "skin", nnode, node));
    free(seen), free(node);

    body b = moved_body(mesh, measures[m], 1, &all);
    /* 24 of the edges inside are of tets with all corners on the skin, which belong to it */
    assert_int_equal(b.n, 3 * (order_of_test() == 1 ? 8 : 5 * 5 * 5 - 24));
    double *u = calloc(3 * b.n, sizeof *u), *v = u + b.n, *r = v + b.n;
    for (int n = 0; n < mesh->nnode; n++)
      for (int c = 0; c < 3; c++) {
        int i = corot_model_dof(b.model)[n][c];
        double arm[3], turned[3];
        for (int k = 0; k < 3; k++) arm[k] = mesh->x[n][k] - all.center[k];
        apply(Q, arm, turned);
        if (i >= 0) u[i] = turned[c] - arm[c];
        if (i >= 0 && c < 2) v[i] = c == 0 ? -all.rate * turned[1] : all.rate * turned[0];
      }
    double *mises = calloc(mesh->ntet, sizeof *mises);
    corot_element_fields fields = {.von_mises = mises};
    assert_ok(corot_elements(b.model, b.state, t, u, &fields));
    assert_ok(corot_residual(b.model, b.state, t, u, v, r));
    double stress = strcmp(measures[m], "cauchy") == 0 ? 2 * soft.mu * (1 - cos(theta)) : 0;
    for (int e = 0; e < mesh->ntet; e++) assert_close(mises[e], stress, 1e-12, 1e-14 * soft.lambda);
    if (stress == 0) assert_below(norm_max(b.n, r), 1e-14 * soft.lambda); /* faces of 0.1 m^2 */
    free(mises), free(u), drop_body(&b);
  }
}

static void go_to(corot_integrator *integrator, double t) {
  corot_step step = {0};
  while (step.t != t) assert_ok(corot_integrator_step(integrator, t, &step));
}

/* A bar whose base is turned for a while and then held: the work put in at the base is what moves
   in the bar, what is stored in it and what is lost. Relative to the work; the largest error, at
   the end of each of three laws. */
static double imbalance(const char *strain, double rtol, double *work) {
  corot_motion base = turn;
  base.rate = 2, base.from = 0.05, base.to = 0.3;
  const double until[] = {0.05, 0.3, 0.6};
  corot_motion m[] = {base};
  body b = moved_body(bar_mesh(), strain, 1, m);
  double *u = calloc(2 * b.n, sizeof *u), *v = u + b.n, worst = 0;
  corot_integrator *integrator;
  corot_integrator_def def = corot_integrator_defaults();
  def.rtol = rtol;
  assert_ok(corot_integrator_create(&def, b.model, b.state, 0, u, v, &integrator));
  corot_state_enter(b.state, 0);
  *work = 0;
  for (int k = 0; k < 3; k++) {
    double dissipated, external;
    corot_energies e;
    go_to(integrator, until[k]);
    assert_ok(corot_integrator_at(integrator, until[k], u, v));
    assert_ok(corot_integrator_work(integrator, until[k], &dissipated, &external));
    assert_ok(corot_energy(b.model, b.state, until[k], u, v, &e));
    if (k == 0) assert_true(external == 0 && e.kinetic == 0);
    if (k == 2) assert_close(external, *work, 1e-12, 0); /* at rest again: no more work */
    *work = external;
    worst = fmax(worst, fabs(e.kinetic + e.elastic + dissipated - external));
    corot_state_enter(b.state, until[k]);
    assert_ok(corot_integrator_changed(integrator, COROT_HISTORY_RESTART));
  }
  corot_integrator_destroy(integrator), free(u), drop_body(&b);
  return worst / *work;
}

/* To the error of integration, which goes with the power 2/3 of the tolerance. */
static void the_ledger_closes(void **state) {
  (void)state;
  for (int m = 0; m < NSTRAIN; m++) {
    if (!conserves(m)) continue;
    double work, loose = imbalance(measures[m], 1e-5, &work),
                 tight = imbalance(measures[m], 1e-7, &work);
    assert_above(work, 0.5); /* J, in a bar of 3 kg */
    assert_below(loose, 2 * pow(1e-5, 2. / 3));
    assert_below(tight, 2 * pow(1e-7, 2. / 3));
    assert_below(tight, 0.2 * loose);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(velocity_is_the_derivative_of_the_path),
      cmocka_unit_test(motions_of_a_group_follow_one_another),
      cmocka_unit_test(amplitudes_move_supports),
      cmocka_unit_test(a_path_of_pieces_has_two_velocities_at_a_kink),
      cmocka_unit_test(an_amplitude_that_cannot_move_is_refused),
      cmocka_unit_test(supports_put_in_the_momentum_they_carry),
      cmocka_unit_test(the_state_knows_which_side_of_a_kink_is_meant),
      cmocka_unit_test(what_is_held_twice_is_refused),
      cmocka_unit_test(a_turned_boundary_makes_stress_in_cauchy_only),
      cmocka_unit_test(the_ledger_closes),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
