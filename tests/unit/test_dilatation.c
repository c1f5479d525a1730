/* Dilatations averaged at the nodes: force, energy and derivatives belong together, rigid motions
   do nothing, and uniform strain is none of its business. */
#include "solid.h"

/* Two nearly incompressible materials that meet in a plane, and one that is not averaged. The nodes
   of crooked_box(2, 3, 4) come layer by layer, twelve in each: the first is of the layers 0 to 2,
   the second of 3 and 4, the third of what is between. */
static const corot_material material[3] = {
    {.group = "low", .lambda = 3e5, .mu = 1e4, .density = 1000},
    {.group = "high", .lambda = 5e3, .mu = 2e4, .density = 1000, .damping_mu = 3},
    {.lambda = 1e6, .mu = 1e4, .density = 1000, .damping_lambda = 20},
};

static int material_of(const int tet[4]) {
  int low = 1, high = 1;
  for (int a = 0; a < 4; a++) low &= tet[a] < 3 * 12, high &= tet[a] >= 3 * 12;
  return low ? 0 : high ? 1 : 2;
}

static body make(const char *strain, corot_dilatation dilatation, double local) {
  corot_mesh *mesh = crooked_box(2, 3, 4);
  int node[5 * 12];
  for (int n = 0; n < 5 * 12; n++) node[n] = n;
  assert_ok(corot_mesh_group_nodes(mesh, "low", 3 * 12, node));
  assert_ok(corot_mesh_group_nodes(mesh, "high", 2 * 12, node + 3 * 12));
  corot_model_def def = corot_model_defaults();
  def.strain = strain, def.nmaterial = 3, def.material = material;
  def.dilatation = dilatation, def.dilatation_local = local;
  return make_body(mesh, def);
}

/* What is averaged over: nodes, or each element, which a second run of a test sets. */
static corot_dilatation averages = COROT_DILATATION_NODAL;

static body make_nodal(const char *strain) { return make(strain, averages, 1); }

/* x -> F x, and noise. */
static void move(const body *b, const double F[9], double size, uint64_t *seed, double *u) {
  const int(*dof)[3] = corot_model_dof(b->model);
  for (int n = 0; n < b->mesh->nnode; n++) {
    double x[3];
    apply(F, b->mesh->x[n], x);
    for (int c = 0; c < 3; c++) u[dof[n][c]] = x[c] - b->mesh->x[n][c] + size * noise(seed);
  }
}

/* A turned, strained body with noise on all of it, and directions. */
static double *make_fields(const body *b) {
  double *u = malloc(6 * b->n * sizeof *u), Q[9], S[9], F[9];
  uint64_t seed = 19;
  random_rotation(&seed, Q);
  random_gradient(&seed, 0.15, S);
  multiply(Q, S, F);
  move(b, F, 0.02, &seed, u);
  for (int i = b->n; i < 4 * b->n; i++) u[i] = noise(&seed);
  return u;
}

static double energy(const body *b, const double *u) {
  corot_energies e;
  double *v = calloc(b->n, sizeof *v);
  assert_ok(corot_energy(b->model, b->state, 0, u, v, &e));
  free(v);
  return e.elastic;
}

static void combine(int n, const double *a, double factor, const double *b, double *c) {
  for (int i = 0; i < n; i++) c[i] = a[i] + factor * b[i];
}

/* Volume of a point of a tet and the trace of the Green or Cauchy strain there. */
static double point_dilatation(const body *b, const double *u, int tet, int q, bool green,
                               double *volume) {
  const int(*dof)[3] = corot_model_dof(b->model);
  double g[10][3], F[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, trace = 0;
  int node[10], nnode = order_of_test() == 1 ? 4 : 10;
  *volume = point_gradients(b->mesh, tet, q, node, g);
  for (int a = 0; a < nnode; a++)
    for (int k = 0; k < 9; k++) F[k] += u[dof[node[a]][k / 3]] * g[a][k % 3];
  for (int k = 0; k < 9; k++) trace += green ? F[k] * F[k] / 2 : (k % 4 == 0) * F[k];
  return green ? trace - 1.5 : trace - 3;
}

/* Central differences: (step times gradients of 10)^2 is 4e-10, rounding over the step 1e-10. */
static const double step = 2e-6, difference_error = 1e-7;

/* The sums over tets and nodes, node by node and material by material. */
static void energy_is_that_of_the_averages(void **state) {
  (void)state;
  for (int green = 0; green < 2; green++) {
    const char *strain = green ? "green" : "cauchy";
    body b = make_nodal(strain), plain = make(strain, COROT_DILATATION_LOCAL, 1);
    double *u = make_fields(&b), expected = energy(&plain, u), V;
    for (int k = 0; k < 3; k++) {
      double lambda = material[k].lambda, local = fmin(lambda, material[k].mu);
      for (int e = 0; e < b.mesh->ntet; e++) {
        if (material_of(b.mesh->tet[e]) != k) continue;
        for (int q = 0; q < points_of_tets(b.mesh); q++) {
          double theta = point_dilatation(&b, u, e, q, green, &V);
          expected -= V * (lambda - local) / 2 * theta * theta;
        }
      }
      for (int n = 0; n < b.mesh->nnode; n++) {
        double sum = 0, volume = 0;
        for (int e = 0; e < b.mesh->ntet; e++) {
          const int *tet = b.mesh->tet[e];
          if (material_of(tet) != k) continue;
          if (tet[0] != n && tet[1] != n && tet[2] != n && tet[3] != n) continue;
          for (int q = 0; q < points_of_tets(b.mesh); q++) {
            sum += point_dilatation(&b, u, e, q, green, &V) * V;
            volume += V;
          }
        }
        if (volume > 0) expected += volume / 4 * (lambda - local) / 2 * pow(sum / volume, 2);
      }
    }
    assert_close(energy(&b, u), expected, 1e-12, 0);
    free(u), drop_body(&b), drop_body(&plain);
  }
}

static void force_is_the_gradient_of_the_energy(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++) {
    body b = make_nodal(measures[m]);
    double *u = make_fields(&b), *du = u + 2 * b.n, *r = u + 4 * b.n, *at = u + 5 * b.n;
    double *rest = calloc(b.n, sizeof *rest);
    if (m == WARP) { /* the force of warp is the gradient at constant frames */
      assert_ok(corot_frames_update(b.model, b.state, 0, u, NULL));
      corot_state_use(b.state, COROT_FRAMES_HELD);
    }
    assert_ok(corot_residual(b.model, b.state, 0, u, rest, r));
    combine(b.n, u, step, du, at);
    double after = energy(&b, at);
    combine(b.n, u, -step, du, at);
    double before = energy(&b, at);
    assert_close((after - before) / (2 * step), -inner(b.n, r, du), difference_error, 0);
    free(u), free(rest), drop_body(&b);
  }
}

static void derivative_is_that_of_the_force(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++)
    for (int held = 0; held < 2; held++) {
      body b = make_nodal(measures[m]);
      double *u = make_fields(&b), *v = u + b.n, *du = v + b.n, *dv = du + b.n;
      double *ahead = dv + b.n, *behind = ahead + b.n;
      double *at = malloc(2 * b.n * sizeof *at), *vt = at + b.n;
      double *jv = malloc(b.n * sizeof *jv);
      assert_ok(corot_frames_update(b.model, b.state, 0, u, NULL));
      if (held) corot_state_use(b.state, COROT_FRAMES_HELD);
      combine(b.n, u, step, du, at), combine(b.n, v, step, dv, vt);
      assert_ok(corot_residual(b.model, b.state, 0, at, vt, ahead));
      combine(b.n, u, -step, du, at), combine(b.n, v, -step, dv, vt);
      assert_ok(corot_residual(b.model, b.state, 0, at, vt, behind));
      corot_tangent tangent = held ? COROT_TANGENT_HELD : COROT_TANGENT_EXACT;
      assert_ok(corot_jvp(b.model, b.state, 0, u, v, tangent, du, dv, jv));
      double size = norm_max(b.n, jv);
      for (int i = 0; i < b.n; i++)
        assert_close((ahead[i] - behind[i]) / (2 * step), jv[i], 0, difference_error * size);
      free(u), free(at), free(jv), drop_body(&b);
    }
}

/* K on its wider pattern leaves out nothing but what it always does. */
static void stiffness_is_the_derivative(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++)
    for (int exact = 0; exact < 2; exact++) {
      body b = make_nodal(measures[m]);
      double *u = make_fields(&b), *du = u + 2 * b.n, *Kdu = u + 4 * b.n, *jv = u + 5 * b.n;
      double *rest = calloc(b.n, sizeof *rest);
      double(*K)[9] = malloc(corot_model_nblock(b.model) * sizeof *K);
      corot_tangent tangent = exact && m != WARP ? COROT_TANGENT_EXACT : COROT_TANGENT_HELD;
      for (int again = 0; again < 2; again++) /* and nothing stays behind */
        assert_ok(corot_jacobian(b.model, b.state, 0, u, rest, tangent, K, NULL));
      corot_block_multiply(b.model, (const double(*)[9])K, du, Kdu);
      assert_ok(corot_jvp(b.model, b.state, 0, u, rest, tangent, du, rest, jv));
      for (int i = 0; i < b.n; i++) assert_close(Kdu[i], -jv[i], 0, 1e-13 * norm_max(b.n, jv));
      free(u), free(rest), free(K), drop_body(&b);
    }
}

/* The kernels work chunk by chunk, the averages do not. */
static void averages_reach_across_chunks(void **state) {
  (void)state;
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = &soft, def.dilatation = COROT_DILATATION_NODAL;
  body b = make_body(crooked_box(6, 7, 8), def);
  assert_true(b.mesh->ntet > 7 * 256);
  double *u = make_fields(&b), *du = u + 2 * b.n, *Kdu = u + 4 * b.n, *jv = u + 5 * b.n;
  double *rest = calloc(2 * b.n, sizeof *rest), *at = rest + b.n;
  double(*K)[9] = malloc(corot_model_nblock(b.model) * sizeof *K);
  uint64_t seed = 2;
  move(&b, identity, 0.004, &seed, u);
  assert_ok(corot_jacobian(b.model, b.state, 0, u, rest, COROT_TANGENT_EXACT, K, NULL));
  corot_block_multiply(b.model, (const double(*)[9])K, du, Kdu);
  assert_ok(corot_jvp(b.model, b.state, 0, u, rest, COROT_TANGENT_EXACT, du, rest, jv));
  for (int i = 0; i < b.n; i++) assert_close(Kdu[i], -jv[i], 0, 1e-13 * norm_max(b.n, jv));

  combine(b.n, u, step, du, at);
  double after = energy(&b, at);
  combine(b.n, u, -step, du, at);
  double before = energy(&b, at);
  assert_ok(corot_residual(b.model, b.state, 0, u, rest, at));
  assert_close((after - before) / (2 * step), -inner(b.n, at, du), difference_error, 0);
  free(u), free(rest), free(K), drop_body(&b);
}

/* Clamped is no less than exact, and semidefinite, in a crushed state where exact is not. */
static void clamped_stiffness_is_semidefinite(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++) {
    if (!conserves(m)) continue;
    body b = make_nodal(measures[m]);
    double *u = make_fields(&b), *x = u + 2 * b.n, *Kx = u + 4 * b.n, *Ex = u + 5 * b.n;
    const double crushed[9] = {0.5, 0, 0, 0, 0.6, 0, 0, 0, 0.4};
    uint64_t seed = 5;
    double *rest = calloc(b.n, sizeof *rest);
    double(*K)[9] = malloc(corot_model_nblock(b.model) * sizeof *K);
    double(*E)[9] = malloc(corot_model_nblock(b.model) * sizeof *E);
    move(&b, crushed, 0.002, &seed, u);
    assert_ok(corot_jacobian(b.model, b.state, 0, u, rest, COROT_TANGENT_CLAMPED, K, NULL));
    assert_ok(corot_jacobian(b.model, b.state, 0, u, rest, COROT_TANGENT_EXACT, E, NULL));
    double most = 0;
    for (int k = 0; k < 100; k++) {
      for (int i = 0; i < b.n; i++) x[i] = noise(&seed);
      corot_block_multiply(b.model, (const double(*)[9])K, x, Kx);
      corot_block_multiply(b.model, (const double(*)[9])E, x, Ex);
      double clamped = inner(b.n, x, Kx), exact = inner(b.n, x, Ex);
      assert_true(clamped > 0 && clamped >= exact);
      most = fmax(most, clamped - exact);
    }
    assert_true(most > 0);
    free(u), free(rest), free(K), free(E), drop_body(&b);
  }
}

static void rigid_motions_do_nothing(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++) {
    if (corot_strain_traits(m)->linear) continue;
    body b = make_nodal(measures[m]);
    double *u = make_fields(&b), *r = u + 2 * b.n, *Qr = u + 3 * b.n, *Qu = u + 4 * b.n;
    double *rest = calloc(b.n, sizeof *rest), Q[9];
    uint64_t seed = 3;
    random_rotation(&seed, Q);
    move(&b, Q, 0, &seed, Qu);
    assert_ok(corot_residual(b.model, b.state, 0, Qu, rest, r));
    assert_close(norm_max(b.n, r), 0, 0, 1e-9); /* of coefficients of 1e6 */
    assert_close(energy(&b, Qu), 0, 0, 1e-20);

    const int(*dof)[3] = corot_model_dof(b.model);
    for (int n = 0; n < b.mesh->nnode; n++) { /* the deformed body, turned */
      double x[3], Qx[3];
      for (int c = 0; c < 3; c++) x[c] = b.mesh->x[n][c] + u[dof[n][c]];
      apply(Q, x, Qx);
      for (int c = 0; c < 3; c++) Qu[dof[n][c]] = Qx[c] - b.mesh->x[n][c];
    }
    assert_close(energy(&b, Qu), energy(&b, u), 1e-12, 0);
    assert_ok(corot_residual(b.model, b.state, 0, u, rest, r));
    assert_ok(corot_residual(b.model, b.state, 0, Qu, rest, Qr));
    double size = norm_max(b.n, r);
    for (int n = 0; n < b.mesh->nnode; n++) {
      double f[3], Qf[3];
      for (int c = 0; c < 3; c++) f[c] = r[dof[n][c]];
      apply(Q, f, Qf);
      for (int c = 0; c < 3; c++) assert_close(Qr[dof[n][c]], Qf[c], 0, 1e-12 * size);
    }
    free(u), free(rest), drop_body(&b);
  }
}

/* A uniform dilatation is its own average: the patch test. Warp's is not uniform, for its frames
   depend on the tets' edges. */
static void uniform_strain_is_as_without(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++) {
    if (m == WARP) continue;
    body b = make_nodal(measures[m]);
    body plain = make(measures[m], COROT_DILATATION_LOCAL, 1);
    double *u = make_fields(&b), *r = u + 2 * b.n, *same = u + 3 * b.n, F[9];
    double *rest = calloc(b.n, sizeof *rest);
    uint64_t seed = 41;
    random_gradient(&seed, 0.3, F);
    move(&b, F, 0, &seed, u);
    assert_ok(corot_residual(b.model, b.state, 0, u, rest, r));
    assert_ok(corot_residual(plain.model, plain.state, 0, u, rest, same));
    for (int i = 0; i < b.n; i++) assert_close(r[i], same[i], 0, 1e-13 * norm_max(b.n, r));
    assert_close(energy(&b, u), energy(&plain, u), 1e-13, 0);
    double *mises = malloc(2 * b.mesh->ntet * sizeof *mises);
    corot_element_fields nodal = {.von_mises = mises}, local = {.von_mises = mises + b.mesh->ntet};
    assert_ok(corot_elements(b.model, b.state, 0, u, &nodal));
    assert_ok(corot_elements(plain.model, plain.state, 0, u, &local));
    for (int e = 0; e < b.mesh->ntet; e++)
      assert_close(nodal.von_mises[e], local.von_mises[e], 1e-12, 0);
    free(u), free(rest), free(mises), drop_body(&b), drop_body(&plain);
  }
}

/* Averages never store more than the tets themselves would, and here much less. */
static void averages_are_softer(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++) {
    body plain = make(measures[m], COROT_DILATATION_LOCAL, 0);
    double *u = make_fields(&plain), before = energy(&plain, u);
    const double local[] = {40, 5, 0};
    for (int k = 0; k < 3; k++) {
      body b = make(measures[m], COROT_DILATATION_NODAL, local[k]);
      double now = energy(&b, u);
      assert_below(now, before);
      before = now;
      drop_body(&b);
    }
    free(u), drop_body(&plain);
  }
}

/* Where all of lambda is left to the tets, nothing is averaged. */
static void enough_left_is_the_plain_model(void **state) {
  (void)state;
  body plain = make("polar", COROT_DILATATION_LOCAL, 1);
  body same = make("polar", COROT_DILATATION_NODAL, 100);
  double *u = make_fields(&plain), *v = u + plain.n, *r = v + plain.n, *again = r + plain.n;
  assert_ok(corot_residual(plain.model, plain.state, 0, u, v, r));
  assert_ok(corot_residual(same.model, same.state, 0, u, v, again));
  assert_memory_equal(r, again, plain.n * sizeof *r);
  assert_int_equal(corot_model_nblock(plain.model), corot_model_nblock(same.model));
  assert_int_equal(corot_model_bytes(plain.model), corot_model_bytes(same.model));
  assert_int_equal(corot_state_bytes(plain.state), corot_state_bytes(same.state));
  body nodal = make_nodal("polar");
  assert_true(corot_model_nblock(nodal.model) > 2 * corot_model_nblock(plain.model));
  assert_true(corot_model_bytes(nodal.model) > corot_model_bytes(plain.model));
  assert_true(corot_state_bytes(nodal.state) > corot_state_bytes(plain.state));
  free(u), drop_body(&plain), drop_body(&same), drop_body(&nodal);
}

/* What the supports carry is computed by it. */
static void internal_force_averages_too(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++) {
    body b = make_nodal(measures[m]), polar = make_nodal("polar");
    double *u = make_fields(&b), *r = u + 2 * b.n, *f = u + 3 * b.n;
    double *rest = calloc(b.n, sizeof *rest);
    double(*nodal)[3] = malloc(b.mesh->nnode * sizeof *nodal);
    assert_ok(corot_residual(b.model, b.state, 0, u, rest, r));
    assert_ok(corot_internal_force(polar.model, polar.state, 0, u, measures[m], 1, 1, nodal));
    to_dofs(&b, (const double(*)[3])nodal, f);
    for (int i = 0; i < b.n; i++) assert_close(f[i], -r[i], 0, 1e-13 * norm_max(b.n, r));
    free(u), free(rest), free(nodal), drop_body(&b), drop_body(&polar);
  }
}

static void a_share_out_of_range_is_refused(void **state) {
  (void)state;
  corot_mesh *mesh = crooked_box(1, 1, 1);
  corot_model_def def = corot_model_defaults();
  def.mesh = mesh, def.nmaterial = 1, def.material = &soft;
  def.dilatation = COROT_DILATATION_NODAL;
  const double bad[] = {-0.1, NAN, INFINITY};
  for (int k = 0; k < 3; k++) {
    corot_model *model = NULL;
    def.dilatation_local = bad[k];
    assert_fails(corot_model_create(&def, &model), COROT_EINVAL, "dilatation_local = ");
    assert_null(model);
  }
  corot_mesh_destroy(mesh);
}

static int over_elements(void **state) {
  (void)state;
  averages = COROT_DILATATION_ELEMENT;
  return 0;
}

static int over_nodes(void **state) {
  (void)state;
  averages = COROT_DILATATION_NODAL;
  return 0;
}

/* Of ten-node tets only: a linear one has one dilatation. */
#define element_test(f) \
  { #f ", over elements", f, over_elements, over_nodes, NULL }

static int run_over_elements(void) {
  const struct CMUnitTest tests[] = {
      element_test(force_is_the_gradient_of_the_energy),
      element_test(derivative_is_that_of_the_force),
      element_test(stiffness_is_the_derivative),
      element_test(clamped_stiffness_is_semidefinite),
      element_test(rigid_motions_do_nothing),
      element_test(uniform_strain_is_as_without),
      element_test(internal_force_averages_too),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(energy_is_that_of_the_averages),
      cmocka_unit_test(force_is_the_gradient_of_the_energy),
      cmocka_unit_test(derivative_is_that_of_the_force),
      cmocka_unit_test(stiffness_is_the_derivative),
      cmocka_unit_test(averages_reach_across_chunks),
      cmocka_unit_test(clamped_stiffness_is_semidefinite),
      cmocka_unit_test(rigid_motions_do_nothing),
      cmocka_unit_test(uniform_strain_is_as_without),
      cmocka_unit_test(averages_are_softer),
      cmocka_unit_test(enough_left_is_the_plain_model),
      cmocka_unit_test(internal_force_averages_too),
      cmocka_unit_test(a_share_out_of_range_is_refused),
  };
  int failed = order_of_test() > 1 ? run_over_elements() : 0;
  return failed + cmocka_run_group_tests(tests, NULL, NULL);
}
