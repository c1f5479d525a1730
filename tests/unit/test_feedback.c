/* A host's own force on the body, with its stiffness and damping: what is made of it, and what of
   its failures. */
#include "feedback.h"

#include <corot/statics.h>

#include "alloc.h"
#include "live.h"

/* Of an edge that leads from the base to the nodes above it, and which a tet has; and a pair that
   no tet has. */
static tie make_tie(const body *b) {
  tie s = {.node = {b->mesh->tet[3][0], b->mesh->tet[3][1]}, .k = 300, .q = 2e5, .c = 4};
  uint64_t seed = 3;
  for (int i = 0; i < 9; i++) s.B[i] = 100 * noise(&seed);
  return s;
}

static void difference(const body *b, const double *u, const double *du, const double *dv,
                       double *out) {
  enum { POINTS = 4 };
  static const double at[POINTS] = {-2, -1, 1, 2},
                      weight[POINTS] = {1.0 / 12, -2.0 / 3, 2.0 / 3, -1.0 / 12};
  int n = b->n;
  double h = 2e-4, *y = malloc(3 * n * sizeof *y), *r = y + 2 * n;
  memset(out, 0, n * sizeof *out);
  for (int k = 0; k < POINTS; k++) {
    for (int i = 0; i < n; i++) {
      y[i] = u[i] + at[k] * h * du[i];
      y[n + i] = u[n + i] + at[k] * h * dv[i];
    }
    assert_ok(corot_residual(b->model, b->state, 0.4, y, y + n, r));
    for (int i = 0; i < n; i++) out[i] += weight[k] * r[i] / h;
  }
  free(y);
}

/* All that may come in, at once. */
static void give_everything(const body *b, corot_inputs *in, const corot_feedback *of) {
  static const double x[1][3] = {{1e-3, 2e-3, -1e-3}}, v[1][3] = {{0.1, 0.2, 0.3}};
  const corot_path path = {"zmin", 0.3, 1, x, v, v};
  const corot_material_factors factors = {2, 0.5, 30, 50};
  double(*f)[3] = malloc(b->mesh->nnode * sizeof *f);
  uint64_t seed = 9;
  for (int i = 0; i < 3 * b->mesh->nnode; i++) f[i / 3][i % 3] = noise(&seed);
  assert_ok(corot_inputs_set_feedback(in, of));
  assert_ok(corot_inputs_set_load(in, 3, 7));
  assert_ok(corot_inputs_set_force(in, b->mesh->nnode, (const double(*)[3])f));
  assert_ok(corot_inputs_start_path(in, &path));
  assert_ok(corot_inputs_set_material(in, 0, &factors));
  free(f);
}

/* With a load that follows the surface, too. The error of the difference is that of its fourth
   order, as in test_derivatives.c. */
static void jvp_knows_all_that_comes_in(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++)
    for (int order = 1; order <= 2; order++)
      for (int change = 0; change < 2; change++) {
        body b = make_bar(measures[m], order, NLOAD, loads);
        corot_inputs *in = give_inputs(&b);
        tie s = make_tie(&b);
        corot_feedback of = feedback_of_tie(&s, change);
        give_everything(&b, in, &of);
        double *u = some_motion(b.n, 1e-3), *d = some_motion(b.n, 1e-2);
        double *jv = malloc(2 * b.n * sizeof *jv), *fd = jv + b.n;
        difference(&b, u, d, d + b.n, fd);
        assert_ok(
            corot_jvp(b.model, b.state, 0.4, u, u + b.n, COROT_TANGENT_EXACT, d, d + b.n, jv));
        assert_below(difference_of(b.n, jv, fd), 1e-7 * norm_max(b.n, fd));
        free(u), free(d), free(jv);
        drop_with(&b, in);
      }
}

/* Whether the difference that the feedback makes to the derivative along x and y has the matrices'
   difference as its symmetric part: (x'Jy + y'Jx) / 2 = - x'Ay. */
static void check_matrix(const body *b, corot_inputs *in, const corot_feedback *of, bool damping) {
  int n = b->n, nblock = corot_model_nblock(b->model);
  double *u = some_motion(n, 1e-3), *x = some_motion(n, 1), *y = x + n;
  double *zero = calloc(n, sizeof *zero), *p = malloc(5 * n * sizeof *p);
  double(*A)[9] = malloc(2 * nblock * sizeof *A), (*B)[9] = A + nblock, sum[3] = {0};
  for (int with = 0; with < 2; with++) {
    double *Jx = p + 2 * with * n, *Jy = Jx + n;
    assert_ok(corot_inputs_set_feedback(in, with ? of : NULL));
    assert_ok(corot_jacobian(b->model, b->state, 0.4, u, u + n, COROT_TANGENT_HELD,
                             damping ? NULL : (with ? B : A), damping ? (with ? B : A) : NULL));
    for (int k = 0; k < 2; k++)
      assert_ok(corot_jvp(b->model, b->state, 0.4, u, u + n, COROT_TANGENT_HELD,
                          damping ? zero : (k ? y : x), damping ? (k ? y : x) : zero, k ? Jy : Jx));
  }
  for (int k = 0; k < nblock; k++)
    for (int i = 0; i < 9; i++) B[k][i] -= A[k][i];
  corot_block_multiply(b->model, (const double(*)[9])B, y, p + 4 * n);
  for (int i = 0; i < n; i++) {
    sum[0] += x[i] * p[4 * n + i];
    sum[1] += -0.5 * (x[i] * (p[3 * n + i] - p[n + i]) + y[i] * (p[2 * n + i] - p[i]));
    sum[2] += fabs(x[i] * p[4 * n + i]);
  }
  /* what cancels is the solid's part, of some 1e5 N */
  assert_close(sum[0], sum[1], 0, 1e-8 * sum[2]);
  assert_true(sum[2] > 1);
  free(u), free(x), free(zero), free(p), free(A);
}

static void matrices_have_its_symmetric_part(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++)
    for (int order = 1; order <= 2; order++) {
      body b = make_bar(measures[m], order, NLOAD, loads);
      corot_inputs *in = give_inputs(&b);
      tie s = make_tie(&b);
      corot_feedback of = feedback_of_tie(&s, false);
      check_matrix(&b, in, &of, false);
      check_matrix(&b, in, &of, true);
      drop_with(&b, in);
    }
}

static void its_power_is_external_and_its_force_a_load(void **state) {
  (void)state;
  body b = make_bar("polar", 1, NLOAD, loads);
  corot_inputs *in = give_inputs(&b);
  tie s = make_tie(&b);
  corot_feedback of = feedback_of_tie(&s, false);
  int n = b.n, nnode = b.mesh->nnode;
  double *u = some_motion(n, 1e-3), *r = malloc(2 * n * sizeof *r), power = 0;
  double(*f)[3] = malloc(2 * nnode * sizeof *f), (*g)[3] = f + nnode;
  corot_energies e[2];
  for (int with = 0; with < 2; with++) {
    corot_nodal_forces load = {.load = with ? g : f};
    assert_ok(corot_inputs_set_feedback(in, with ? &of : NULL));
    assert_ok(corot_residual(b.model, b.state, 0.4, u, u + n, r + with * n));
    assert_ok(corot_energy(b.model, b.state, 0.4, u, u + n, &e[with]));
    assert_ok(corot_forces(b.model, b.state, 0.4, u, u + n, u + n, &load));
  }
  for (int i = 0; i < n; i++) power += (r[n + i] - r[i]) * u[n + i];
  assert_close(e[1].power_external - e[0].power_external, power, 1e-10, 0);
  assert_true(fabs(power) > 1e-5);
  assert_true(e[1].elastic == e[0].elastic && e[1].power_dissipated == e[0].power_dissipated);
  const int(*dof)[3] = corot_model_dof(b.model);
  for (int i = 0; i < 3 * nnode; i++) {
    int k = dof[i / 3][i % 3];
    if (k >= 0) assert_close(g[i / 3][i % 3] - f[i / 3][i % 3], r[n + k] - r[k], 0, 1e-10);
  }
  free(u), free(r), free(f);
  drop_with(&b, in);
}

/* --- Statics ---------------------------------------------------------------------------------- */

/* The nodes of a group, and the parts of its area that are theirs, as those of a traction. */
static foundation make_foundation(const body *b, const char *group, double k) {
  const corot_group *g = corot_mesh_find_group(b->mesh, group);
  corot_load pull = {COROT_TRACTION, group, {0, 0, 1}, {0}};
  corot_fix other = {strcmp(group, "zmax") == 0 ? "zmin" : "zmax", {true, true, true}};
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = &soft, def.nload = 1, def.load = &pull;
  def.nfix = 1, def.fix = &other;
  body loaded = make_body(b->mesh, def);
  int nnode = b->mesh->nnode;
  double(*f)[3] = malloc(2 * nnode * sizeof *f), *share = malloc(g->nnode * sizeof *share), all = 0;
  memset(f, 0, 2 * nnode * sizeof *f);
  assert_ok(corot_load_force(loaded.model, 0, 1, (const double(*)[3])(f + nnode), f));
  for (int i = 0; i < g->nnode; i++) all += share[i] = f[g->node[i]][2];
  for (int i = 0; i < g->nnode; i++) share[i] /= all;
  loaded.mesh = NULL;
  drop_body(&loaded);
  free(f);
  return (foundation){.n = g->nnode, .node = g->node, .share = share, .k = k};
}

/* A bar without lateral contraction, pulled by P at its end, where a spring k holds it as well: it
   gets longer by P / (E A / L + k), E = 2 mu. */
static void a_spring_at_the_end_of_a_bar(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++)
    for (int order = 1; order <= 2; order++) {
      corot_box box = {.size = {0.1, 0.1, 0.6}, .cells = {1, 1, 4}};
      corot_mesh *mesh;
      assert_ok(corot_mesh_box(&box, &mesh));
      if (order == 2) mesh = given_order(mesh, 2);
      corot_material material = {.lambda = 0, .mu = 1e4, .density = 1000};
      corot_load pull = {COROT_TRACTION, "zmax", {0, 0, 1e-3}, {0}};
      corot_model_def def = corot_model_defaults();
      def.strain = measures[m], def.nmaterial = 1, def.material = &material;
      def.nfix = 1, def.fix = &base, def.nload = 1, def.load = &pull;
      body b = make_body(mesh, def);
      corot_inputs *in = give_inputs(&b);
      foundation s = make_foundation(&b, "zmax", 500);
      corot_feedback of = feedback_of_foundation(&s);
      assert_ok(corot_inputs_set_feedback(in, &of));
      corot_statics_def how = corot_statics_defaults();
      corot_statics *statics;
      corot_load_step step;
      how.inputs = in;
      double *u = malloc(b.n * sizeof *u), longer = 1e-5 / (2e4 * 0.01 / 0.6 + 500);
      assert_ok(corot_statics_create(&how, b.model, 0, NULL, &statics));
      assert_ok(corot_statics_step(statics, &step));
      corot_statics_at(statics, u);
      /* strains of 1e-8 are small, and what is left of the residual is 1e-10 of the force */
      assert_close(u[corot_model_dof(b.model)[s.node[0]][2]], longer, 1e-6, 0);
      assert_int_equal(step.stability, COROT_STABLE);
      corot_statics_destroy(statics);
      free((void *)s.share), free(u);
      drop_with(&b, in);
    }
}

/* Which without the spring nothing holds, and with a feedback that has no stiffness neither. */
static void a_spring_may_hold_a_free_body(void **state) {
  (void)state;
  corot_box box = {.size = {0.1, 0.1, 0.3}, .cells = {1, 1, 3}};
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  corot_load weight = {COROT_GRAVITY, NULL, {0, 0, -9.81}, {0}};
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = &soft, def.nload = 1, def.load = &weight;
  body b = make_body(mesh, def);
  corot_inputs *in = give_inputs(&b);
  foundation s = make_foundation(&b, "zmax", 1000); /* it hangs */
  corot_feedback of = feedback_of_foundation(&s);
  corot_statics_def how = corot_statics_defaults();
  corot_statics *statics;
  how.inputs = in;
  assert_fails(corot_statics_create(&how, b.model, 0, NULL, &statics), COROT_ESINGULAR,
               "no support");
  of.blocks = NULL;
  assert_ok(corot_inputs_set_feedback(in, &of));
  assert_fails(corot_statics_create(&how, b.model, 0, NULL, &statics), COROT_ESINGULAR,
               "no support");
  of.blocks = foundation_blocks;
  assert_ok(corot_inputs_set_feedback(in, &of));
  assert_ok(corot_statics_create(&how, b.model, 0, NULL, &statics));
  assert_ok(corot_statics_solve(statics));
  double *u = malloc(b.n * sizeof *u), sum = 0;
  corot_statics_at(statics, u);
  for (int i = 0; i < s.n; i++) sum += s.k * s.share[i] * u[corot_model_dof(b.model)[s.node[i]][2]];
  assert_close(sum, -9.81 * 3, 1e-9, 0); /* its weight */
  corot_statics_destroy(statics);
  free((void *)s.share), free(u);
  drop_with(&b, in);
}

/* As its own status. */
static void an_equilibrium_ends_with_its_failure(void **state) {
  (void)state;
  body b = make_bar("polar", 1, 1, loads);
  corot_inputs *in = give_inputs(&b);
  int node = b.mesh->nnode - 1;
  foundation s = {.n = 1, .node = &node, .k = 1};
  corot_feedback of = feedback_of_foundation(&s);
  corot_statics_def how = corot_statics_defaults();
  corot_statics *statics;
  corot_load_step step;
  how.inputs = in;
  assert_ok(corot_inputs_set_feedback(in, &of));
  assert_ok(corot_statics_create(&how, b.model, 0, NULL, &statics));
  s.status = COROT_EIO, s.bad = -1, s.good = 2, s.why = "the valve is stuck";
  assert_fails(corot_statics_step(statics, &step), COROT_EIO, "the valve is stuck");
  s.status = COROT_OK;
  assert_ok(corot_statics_solve(statics));
  corot_statics_destroy(statics);
  drop_with(&b, in);
}

/* --- Integrators ------------------------------------------------------------------------------ */

/* A spring of 1e5 N/m, some three hundred times as stiff as the bar, at a corner of its end, on
   which a pull is let go. Where steps are implicit its blocks are in the matrix, and Newton's
   iteration converges; what it takes from the body is what its potential has. */
static void a_stiff_spring_costs_no_failure(void **state) {
  (void)state;
  for (int i = 0; corot_method_at(i); i++) {
    body b = make_bar("polar", 1, 1, loads);
    corot_inputs *in = give_inputs(&b);
    const corot_group *top = corot_mesh_find_group(b.mesh, "zmax");
    foundation s = {.n = 1, .node = top->node, .k = 1e5};
    corot_feedback of = feedback_of_foundation(&s);
    assert_ok(corot_inputs_set_feedback(in, &of));
    /* BDF 3 of a constant step is not stable for a spring like that, in the long run */
    bool controlled = corot_method_at(i)->controls_error;
    double t_end = controlled ? 1 : 0.1;
    corot_integrator *integrator = integrate_by(i, &b, 1e-3);
    go_to(integrator, t_end);
    corot_statistics count = corot_integrator_statistics(integrator);
    assert_int_equal(count.ncfn, 0);

    /* the books */
    double *u = malloc(2 * b.n * sizeof *u), dissipated, external;
    corot_energies e;
    assert_ok(corot_integrator_at(integrator, t_end, u, u + b.n));
    assert_ok(corot_integrator_energy(integrator, u, u + b.n, &e));
    assert_ok(corot_integrator_work(integrator, t_end, &dissipated, &external));
    double missing = e.kinetic + e.elastic + dissipated - external;
    /* ten times the tolerance; of a constant step backward Euler is the worst */
    assert_below(fabs(missing), (controlled ? 1e-2 : 0.1) * external);
    free(u);
    corot_integrator_destroy(integrator);
    drop_with(&b, in);
  }
}

/* As a force alone, it is what Newton's iteration fails at. */
static void without_its_blocks_it_does(void **state) {
  (void)state;
  body b = make_bar("polar", 1, 1, loads);
  corot_inputs *in = give_inputs(&b);
  foundation s = {.n = 1, .node = corot_mesh_find_group(b.mesh, "zmax")->node, .k = 1e5};
  corot_feedback of = feedback_of_foundation(&s);
  of.blocks = NULL;
  assert_ok(corot_inputs_set_feedback(in, &of));
  corot_integrator *integrator = integrate_by(0, &b, 1e-3);
  go_to(integrator, 1);
  assert_true(corot_integrator_statistics(integrator).ncfn > 10);
  corot_integrator_destroy(integrator);
  drop_with(&b, in);
}

/* --- Failures --------------------------------------------------------------------------------- */

static corot_status bad_pair(void *data, double t, const double (*u)[3], const double (*v)[3],
                             corot_blocks *blocks) {
  const int *pair = data;
  const double K[9] = {pair[2] ? NAN : 1};
  (void)t, (void)u, (void)v;
  (void)corot_blocks_add(blocks, pair[0], pair[1], K, NULL); /* and does not look */
  return COROT_OK;
}

static corot_status no_force(void *data, double t, const double (*u)[3], const double (*v)[3],
                             double (*f)[3]) {
  (void)data, (void)t, (void)u, (void)v, (void)f;
  return COROT_OK;
}

static void blocks_off_the_pattern_are_refused(void **state) {
  (void)state;
  body b = make_bar("polar", 1, 0, NULL);
  corot_inputs *in = give_inputs(&b);
  int last = b.mesh->nnode - 1, pair[3];
  const struct {
    int pair[3];
    corot_status status;
    const char *words;
  } bad[] = {
      {{0, last, 0}, COROT_EINVAL, "they share no tet"},
      {{last, 0, 0}, COROT_EINVAL, "they share no tet"},
      {{-1, 2, 0}, COROT_EINVAL, "the mesh has"},
      {{2, last + 1, 0}, COROT_EINVAL, "the mesh has"},
      {{last, last, 1}, COROT_RETRY, "has nan in row 0, column 0"},
  };
  corot_feedback of = {"claw", pair, no_force, bad_pair, NULL};
  double *u = some_motion(b.n, 1e-3), *jv = malloc(b.n * sizeof *jv);
  double(*K)[9] = malloc(corot_model_nblock(b.model) * sizeof *K);
  assert_ok(corot_inputs_set_feedback(in, &of));
  for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
    memcpy(pair, bad[k].pair, sizeof pair);
    assert_fails(corot_jacobian(b.model, b.state, 0, u, u, COROT_TANGENT_HELD, K, NULL),
                 bad[k].status, bad[k].words);
    assert_non_null(strstr(corot_error(), "claw at t = 0"));
    assert_fails(corot_jvp(b.model, b.state, 0, u, u, COROT_TANGENT_HELD, u, u, jv), bad[k].status,
                 bad[k].words);
    assert_ok(corot_residual(b.model, b.state, 0, u, u, jv));
  }
  free(u), free(jv), free(K);
  drop_with(&b, in);
}

static void what_fails_is_told(void **state) {
  (void)state;
  body b = make_bar("polar", 1, 0, NULL);
  corot_inputs *in = give_inputs(&b);
  int node = b.mesh->nnode - 1;
  foundation s = {.n = 1, .node = &node, .k = 1, .status = COROT_EIO, .bad = -1};
  corot_feedback of = feedback_of_foundation(&s);
  double *u = some_motion(b.n, 1e-3), *r = malloc(b.n * sizeof *r);
  corot_energies e;
  of.force = NULL;
  assert_fails(corot_inputs_set_feedback(in, &of), COROT_EINVAL, "has no force");
  of.force = foundation_force;
  assert_ok(corot_inputs_set_feedback(in, &of));
  assert_fails(corot_residual(b.model, b.state, 2, u, u, r), COROT_EIO,
               "foundation at t = 2: it failed, and does not say why");
  s.why = "the valve is stuck";
  assert_fails(corot_residual(b.model, b.state, 2, u, u, r), COROT_EIO,
               "foundation at t = 2: the valve is stuck");
  assert_fails(corot_energy(b.model, b.state, 2, u, u, &e), COROT_EIO, "the valve is stuck");
  s.status = COROT_ESINGULAR; /* which to an integrator means a shorter step */
  assert_fails(corot_residual(b.model, b.state, 2, u, u, r), COROT_EINVAL, "the valve is stuck");
  s.status = (corot_status)17;
  assert_fails(corot_residual(b.model, b.state, 2, u, u, r), COROT_RETRY, "the valve is stuck");
  s.status = COROT_OK, s.k = NAN;
  assert_fails(corot_residual(b.model, b.state, 2, u, u, r), COROT_RETRY,
               "the x component of its force on node");
  s.k = 1;
  assert_ok(corot_residual(b.model, b.state, 2, u, u, r));
  free(u), free(r);
  drop_with(&b, in);
}

/* By every method: what a shorter step helps makes the step shorter, anything else ends it with its
   status and message, and the integrator goes on when it is mended. */
static void steps_are_shortened_or_end(void **state) {
  (void)state;
  for (int i = 0; corot_method_at(i); i++) {
    body b = make_bar("polar", 1, 1, loads);
    corot_inputs *in = give_inputs(&b);
    int node = b.mesh->nnode - 1;
    foundation s = {.n = 1, .node = &node, .k = 1};
    corot_feedback of = feedback_of_foundation(&s);
    corot_step step;
    assert_ok(corot_inputs_set_feedback(in, &of));
    corot_integrator *integrator = integrate_by(i, &b, 1e-5);
    go_to(integrator, 0.01);
    double *u = malloc(2 * b.n * sizeof *u);
    bool controlled = corot_method_at(i)->controls_error;

    /* fatal: with its own status */
    s.status = COROT_EIO, s.bad = -1, s.why = "the valve is stuck";
    assert_fails(corot_integrator_step(integrator, 1, &step), COROT_EIO, "the valve is stuck");
    s.status = COROT_OK;
    assert_ok(corot_integrator_at(integrator, 0.01, u, u + b.n));

    /* twice, in the middle of a step */
    assert_ok(corot_integrator_changed(integrator, COROT_HISTORY_RESTART));
    go_to(integrator, 0.02);
    s.status = COROT_RETRY, s.bad = controlled ? 1 : 2, s.good = 1;
    corot_status status = corot_integrator_step(integrator, 1, &step);
    if (controlled) {
      if (status) fail_msg("%s: %s", corot_method_at(i)->name, corot_error());
    } else if (status) {
      assert_int_equal(status, COROT_EINTEGRATE);
      assert_non_null(strstr(corot_error(), "the valve is stuck"));
    }
    s.status = COROT_OK;
    go_to(integrator, 0.03);
    free(u);
    corot_integrator_destroy(integrator);
    drop_with(&b, in);
  }
}

static corot_status make_feedback(void *of) {
  corot_inputs *in;
  const body *b = ((void **)of)[0];
  COROT_TRY(corot_inputs_create(b->model, &in));
  corot_status status = corot_inputs_set_feedback(in, ((void **)of)[1]);
  corot_inputs_destroy(in);
  return status;
}

static void memory_may_run_out(void **state) {
  (void)state;
  body b = make_bar("polar", 1, 1, loads);
  tie s = make_tie(&b);
  corot_feedback of = feedback_of_tie(&s, false);
  void *context[] = {&b, &of};
  assert_true(assert_survives_failed_allocations(make_feedback, context) > 7);
  drop_body(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(jvp_knows_all_that_comes_in),
      cmocka_unit_test(matrices_have_its_symmetric_part),
      cmocka_unit_test(its_power_is_external_and_its_force_a_load),
      cmocka_unit_test(a_spring_at_the_end_of_a_bar),
      cmocka_unit_test(a_spring_may_hold_a_free_body),
      cmocka_unit_test(an_equilibrium_ends_with_its_failure),
      cmocka_unit_test(a_stiff_spring_costs_no_failure),
      cmocka_unit_test(without_its_blocks_it_does),
      cmocka_unit_test(blocks_off_the_pattern_are_refused),
      cmocka_unit_test(what_fails_is_told),
      cmocka_unit_test(steps_are_shortened_or_end),
      cmocka_unit_test(memory_may_run_out),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
