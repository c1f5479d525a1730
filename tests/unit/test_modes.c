/* Modes against a dense solver, about rest and under loads; rigid motions; what is refused. */
#include <corot/modes.h>

#include "alloc.h"
#include "solid.h"

/* --- The same by dense matrices: A = L^-1 K L^-T, M = L L', by Jacobi's rotations --- */

typedef struct dense {
  int n;
  double *K, *M;  /* [n][n] */
  double *lambda; /* [n] ascending */
} dense;

/* L of A = L L' takes its place. */
static void cholesky(int n, double *A) {
  for (int j = 0; j < n; j++)
    for (int i = j; i < n; i++) {
      double sum = A[i * n + j];
      for (int k = 0; k < j; k++) sum -= A[i * n + k] * A[j * n + k];
      if (i == j) assert_above(sum, 0);
      A[i * n + j] = i == j ? sqrt(sum) : sum / A[j * n + j];
    }
}

/* A = L^-1 A, by columns of the transposed: rows of A are columns where A is symmetric. */
static void solve_rows(int n, const double *L, double *A) {
  for (int row = 0; row < n; row++) {
    double *x = A + row * n;
    for (int i = 0; i < n; i++) {
      for (int k = 0; k < i; k++) x[i] -= L[i * n + k] * x[k];
      x[i] /= L[i * n + i];
    }
  }
}

static void transpose(int n, double *A) {
  for (int i = 0; i < n; i++)
    for (int j = 0; j < i; j++) {
      double swap = A[i * n + j];
      A[i * n + j] = A[j * n + i], A[j * n + i] = swap;
    }
}

static void rotate(int n, double *A, int p, int q) {
  double angle = 0.5 * atan2(2 * A[p * n + q], A[q * n + q] - A[p * n + p]);
  double c = cos(angle), s = sin(angle);
  for (int k = 0; k < n; k++) {
    double a = A[p * n + k], b = A[q * n + k];
    A[p * n + k] = c * a - s * b, A[q * n + k] = s * a + c * b;
  }
  for (int k = 0; k < n; k++) {
    double a = A[k * n + p], b = A[k * n + q];
    A[k * n + p] = c * a - s * b, A[k * n + q] = s * a + c * b;
  }
}

static int ascending(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* -dr/du of the whole body in steps of unit vectors: nothing is left out, and of that the symmetric
   part. */
static dense solve_dense(const body *b, const double *u) {
  int n = b->n;
  dense d = {n, calloc(n * n, sizeof(double)), calloc(n * n, sizeof(double)),
             calloc(n, sizeof(double))};
  double *unit = calloc(3 * n, sizeof *unit), *zero = unit + n, *y = zero + n;
  corot_state_stand_still(b->state, 0, u ? 1 : 0);
  for (int j = 0; j < n; j++) {
    unit[j] = 1;
    assert_ok(
        corot_jvp(b->model, b->state, 0, u ? u : zero, zero, COROT_TANGENT_EXACT, unit, zero, y));
    for (int i = 0; i < n; i++) d.K[i * n + j] -= y[i] / 2, d.K[j * n + i] -= y[i] / 2;
    corot_mass_multiply(b->model, unit, y);
    for (int i = 0; i < n; i++) d.M[i * n + j] = y[i];
    unit[j] = 0;
  }
  double *L = malloc(2 * n * n * sizeof *L), *A = L + n * n;
  memcpy(L, d.M, n * n * sizeof *L), memcpy(A, d.K, n * n * sizeof *A);
  cholesky(n, L);
  solve_rows(n, L, A), transpose(n, A), solve_rows(n, L, A);
  for (int sweep = 0; sweep < 12; sweep++)
    for (int p = 0; p < n; p++)
      for (int q = p + 1; q < n; q++) rotate(n, A, p, q);
  for (int i = 0; i < n; i++) d.lambda[i] = A[i * n + i];
  qsort(d.lambda, n, sizeof *d.lambda, ascending);
  free(unit), free(L);
  return d;
}

static void drop_dense(dense *d) { free(d->K), free(d->M), free(d->lambda); }

static corot_modes *find(const body *b, int count, const double *u) {
  corot_modes *modes;
  corot_modes_def def = corot_modes_defaults();
  def.count = count;
  assert_ok(corot_modes_find(&def, b->model, 0, u, &modes));
  assert_int_equal(corot_modes_count(modes), count);
  return modes;
}

/* Both are right to rounding of the largest eigenvalue, of some 30 operations in a row. */
static void compare(const body *b, int count, const double *u) {
  dense d = solve_dense(b, u);
  corot_modes *modes = find(b, count, u);
  double rounding = 30 * 2.3e-16 * d.lambda[d.n - 1];
  for (int k = 0; k < count; k++) {
    corot_mode mode = corot_modes_at(modes, k);
    assert_close(mode.eigenvalue, d.lambda[k], 1e-11, rounding);
    assert_true(mode.frequency >= 0 && mode.growth >= 0);
    assert_close(mode.eigenvalue,
                 39.478417604357434 * mode.frequency * mode.frequency - mode.growth * mode.growth,
                 1e-14, 0);
  }
  /* K x = lambda M x, to ARPACK's tolerance and to rounding; and x' M x = 1 */
  corot_modes_facts facts = corot_modes_known(modes);
  for (int k = 0; k < count; k++) {
    corot_mode mode = corot_modes_at(modes, k), other = corot_modes_at(modes, k ? k - 1 : 0);
    assert_below(mode.residual, 1e-10 + (mode.eigenvalue ? facts.zero / fabs(mode.eigenvalue) : 0));
    double one = 0, cross = 0;
    for (int i = 0; i < d.n; i++)
      for (int j = 0; j < d.n; j++) {
        one += mode.shape[i] * d.M[i * d.n + j] * mode.shape[j];
        if (k) cross += other.shape[i] * d.M[i * d.n + j] * mode.shape[j];
      }
    assert_close(one, 1, 1e-13, 0);
    assert_close(cross, 0, 0, 1e-13);
  }
  corot_modes_destroy(modes), drop_dense(&d);
}

static body make_box(const char *strain, corot_mass mass, bool held) {
  static const corot_material elastic = {.lambda = 2e4, .mu = 1e4, .density = 1000};
  static const corot_fix fix = {"zmin", {true, true, true}};
  corot_model_def def = corot_model_defaults();
  def.strain = strain, def.mass = mass;
  def.nmaterial = 1, def.material = &elastic;
  def.nfix = held, def.fix = &fix;
  return make_body(order_of_test() == 1 ? crooked_box(2, 2, 3) : crooked_box(1, 1, 1), def);
}

/* Free bodies and held ones, by both masses; at rest all measures are one. */
static void modes_at_rest_are_those_of_a_dense_solver(void **state) {
  (void)state;
  static const corot_mass masses[] = {COROT_MASS_LUMPED, COROT_MASS_CONSISTENT};
  for (int k = 0; k < NMEASURE; k++)
    for (int held = 0; held < 2; held++) {
      body b = make_box(measures[k], masses[k % 2], held);
      compare(&b, 12, NULL);
      corot_modes *modes = find(&b, 7, NULL);
      corot_modes_facts facts = corot_modes_known(modes);
      assert_int_equal(facts.nrigid, held ? 0 : 6);
      /* K is all there is: what the derivative has beside is rounding */
      assert_below(facts.asymmetry, 1e-9);
      corot_modes_destroy(modes), drop_body(&b);
    }
}

static void every_number_of_modes_can_be_had(void **state) {
  (void)state;
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = &soft;
  body b = make_body(straight_box(1, 1, 1), def);
  for (int count = 1; count < b.n; count++) compare(&b, count, NULL);
  drop_body(&b);
}

/* Of two equal eigenvalues a Krylov space has one. A square bar bends both ways alike. */
static void none_of_several_equal_modes_is_missed(void **state) {
  (void)state;
  corot_box box = corot_box_defaults();
  box.size[0] = box.size[1] = box.size[2] = 1;
  box.cells[0] = box.cells[1] = box.cells[2] = 2; /* cut so that it is its own mirror image */
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = &soft, def.mass = COROT_MASS_LUMPED;
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  body b = make_body(mesh, def);
  for (int count = 6; count < 24; count++) compare(&b, count, NULL);
  drop_body(&b);
}

/* Rigid motions are exactly that: frequency 0, all of the mass, each node as it should move. */
static void a_free_body_has_six_rigid_modes(void **state) {
  (void)state;
  body b = make_box("polar", COROT_MASS_AUTO, false);
  for (int count = 2; count <= 8; count += 3) {
    corot_modes *modes = find(&b, count, NULL);
    double sum = 0, all[3] = {0};
    for (int k = 0; k < count; k++) {
      corot_mode mode = corot_modes_at(modes, k);
      if (k < 6) assert_true(mode.eigenvalue == 0 && mode.frequency == 0 && mode.growth == 0);
      if (k >= 6) assert_above(mode.frequency, 0.1);
      for (int c = 0; c < 3; c++) all[c] += mode.effective_mass[c];
    }
    const double *mass = corot_model_mass(b.model); /* as row sums add up to the body's mass */
    for (int i = 0; i < b.n; i += 3) sum += mass[i];
    for (int c = 0; c < 3 && count >= 6; c++) assert_close(all[c], sum, 1e-12, 0);
    corot_modes_destroy(modes);
  }
  drop_body(&b);
}

/* Two boxes that do not touch have twelve, and one on a hinge has one. */
static void each_part_and_each_hinge_is_seen(void **state) {
  (void)state;
  corot_mesh *one = linear_box(1, 1, 1);
  int n = one->nnode, ntet = one->ntet, (*tet)[4] = malloc(2 * ntet * sizeof *tet);
  double(*x)[3] = malloc(2 * n * sizeof *x);
  for (int i = 0; i < 2 * n; i++)
    for (int c = 0; c < 3; c++) x[i][c] = one->x[i % n][c] + (i < n ? 0 : 5);
  for (int k = 0; k < 2 * ntet; k++)
    for (int a = 0; a < 4; a++) tet[k][a] = one->tet[k % ntet][a] + (k < ntet ? 0 : n);
  corot_mesh *mesh;
  assert_ok(corot_mesh_create(2 * n, (const double(*)[3])x, 2 * ntet, (const int(*)[4])tet, &mesh));
  assert_ok(corot_mesh_group_nodes(mesh, "pin", 2, (int[]){0, 1}));
  corot_mesh_destroy(one), free(x), free(tet);
  corot_fix fix = {"pin", {true, true, true}};
  for (int held = 0; held < 2; held++) {
    corot_model_def def = corot_model_defaults();
    def.nmaterial = 1, def.material = &soft, def.nfix = held, def.fix = &fix;
    corot_mesh *copy;
    assert_ok(corot_mesh_copy(mesh, &copy));
    body b = make_body(of_order(copy), def);
    int nrigid = held ? 7 : 12;
    corot_modes *modes = find(&b, nrigid + 2, NULL);
    if (order_of_test() == 1) assert_int_equal(corot_modes_known(modes).nrigid, nrigid);
    for (int k = 0; k < nrigid; k++) assert_true(corot_modes_at(modes, k).frequency == 0);
    assert_above(corot_modes_at(modes, nrigid).frequency, 0.01);
    corot_modes_destroy(modes), drop_body(&b);
  }
  corot_mesh_destroy(mesh);
}

/* A block squeezed to less than half its height is unstable: growth rates, and the same numbers
   as the dense solver's. Away from rest polar, hybrid, green and cauchy have their own. */
static void unstable_modes_have_growth_rates(void **state) {
  (void)state;
  for (int k = 0; k < NMEASURE; k++) {
    if (strcmp(measures[k], "warp") == 0) continue;
    body b = make_box(measures[k], COROT_MASS_AUTO, true);
    double *u = calloc(b.n, sizeof *u);
    const int(*dof)[3] = corot_model_dof(b.model);
    for (int n = 0; n < b.mesh->nnode; n++)
      if (dof[n][2] >= 0) u[dof[n][2]] = -0.6 * (b.mesh->x[n][2] - 0.1);
    compare(&b, 8, u);
    corot_modes *modes = find(&b, 8, u);
    bool stiff = strcmp(measures[k], "cauchy") == 0;
    assert_true(stiff == (corot_modes_at(modes, 0).growth == 0));
    assert_true(isfinite(corot_modes_at(modes, 0).frequency));
    corot_modes_destroy(modes), drop_body(&b), free(u);
  }
}

/* By any direct solver, be it one that refuses a matrix that is not positive definite or one whose
   pivots are counted: the shift lies below all eigenvalues, of which some are negative here. */
static void any_direct_solver_will_do(void **state) {
  (void)state;
  body b = make_box("green", COROT_MASS_AUTO, true);
  double *u = calloc(b.n, sizeof *u);
  const int(*dof)[3] = corot_model_dof(b.model);
  for (int n = 0; n < b.mesh->nnode; n++)
    if (dof[n][2] >= 0) u[dof[n][2]] = -0.6 * (b.mesh->x[n][2] - 0.1);
  corot_modes *one = find(&b, 5, u), *other;
  corot_modes_def def = corot_modes_defaults();
  def.count = 5, def.linear.solver = "klu";
  assert_ok(corot_modes_find(&def, b.model, 0, u, &other));
  assert_non_null(strstr(corot_modes_known(other).solver, "klu"));
  assert_below(corot_modes_known(other).shift, corot_modes_at(other, 0).eigenvalue);
  for (int k = 0; k < 5; k++)
    assert_close(corot_modes_at(other, k).eigenvalue, corot_modes_at(one, k).eigenvalue, 1e-10, 0);
  corot_modes_destroy(one), corot_modes_destroy(other), drop_body(&b), free(u);
}

/* A pressure all around, which has a potential, and one on a face with free edges, of which K has
   the symmetric part, and the facts say what is left. */
static void pressure_counts_where_it_has_a_potential(void **state) {
  (void)state;
  static const corot_material elastic = {.lambda = 2e4, .mu = 1e4, .density = 1000};
  for (int open = 0; open < 2; open++) {
    corot_mesh *mesh = order_of_test() == 1 ? crooked_box(2, 2, 2) : crooked_box(1, 1, 1);
    int *node = malloc(mesh->nnode * sizeof *node);
    for (int n = 0; n < mesh->nnode; n++) node[n] = n;
    assert_ok(corot_mesh_group_nodes(mesh, "skin", mesh->nnode, node));
    corot_load load = {COROT_PRESSURE, open ? "zmax" : "skin", {500}, {0}};
    corot_model_def def = corot_model_defaults();
    def.strain = "green", def.nmaterial = 1, def.material = &elastic;
    def.nload = 1, def.load = &load;
    body b = make_body(mesh, def);
    double *u = malloc(b.n * sizeof *u);
    uint64_t seed = 3;
    for (int i = 0; i < b.n; i++) u[i] = 0.01 * noise(&seed);
    compare(&b, 9, u);
    corot_modes *modes = find(&b, 9, u);
    double left = corot_modes_known(modes).asymmetry;
    if (open) assert_above(left, 1e-3);
    if (!open) assert_below(left, 1e-10);
    corot_modes_destroy(modes), drop_body(&b), free(u), free(node);
  }
}

/* At rest a hierarchy is the plain body; under loads its matrices are not all there. */
static void a_hierarchy_has_modes_at_rest(void **state) {
  (void)state;
  corot_mesh *coarse = linear_box(1, 1, 1), *fine;
  corot_refinement *refinement;
  static const corot_material elastic = {.lambda = 2e4, .mu = 1e4, .density = 1000};
  assert_ok(corot_mesh_refine(coarse, 1, COROT_DIAGONAL_SHORTEST, &fine, &refinement));
  static const struct {
    corot_coupling coupling;
    bool rest;
  } row[] = {{COROT_COUPLING_MEAN, true}, {COROT_COUPLING_NODES, true}, {COROT_COUPLING_ONE_WAY}};
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = &elastic;
  for (int k = 0; k < 3; k++) {
    corot_hierarchy_def hierarchy = corot_hierarchy_defaults();
    hierarchy.refinement = refinement, hierarchy.coupling = row[k].coupling;
    def.hierarchy = &hierarchy, def.mass = COROT_MASS_LUMPED;
    corot_mesh *copy;
    assert_ok(corot_mesh_copy(fine, &copy));
    body b = make_body(copy, def);
    corot_modes *modes;
    corot_modes_def how = corot_modes_defaults();
    double *u = calloc(b.n, sizeof *u);
    assert_fails(corot_modes_find(&how, b.model, 0, u, &modes), COROT_EINVAL,
                 row[k].rest ? "not all there under loads" : "coupled one way");
    if (row[k].rest)
      compare(&b, 10, NULL);
    else
      assert_fails(corot_modes_find(&how, b.model, 0, NULL, &modes), COROT_EINVAL, "one way");
    free(u), drop_body(&b);
  }
  corot_refinement_destroy(refinement), corot_mesh_destroy(fine), corot_mesh_destroy(coarse);
}

static void the_same_call_gives_the_same_bits(void **state) {
  (void)state;
  body b = make_box("polar", COROT_MASS_AUTO, true);
  corot_modes *one = find(&b, 9, NULL), *two = find(&b, 9, NULL);
  for (int k = 0; k < 9; k++) {
    corot_mode x = corot_modes_at(one, k), y = corot_modes_at(two, k);
    assert_true(x.eigenvalue == y.eigenvalue);
    assert_memory_equal(x.shape, y.shape, b.n * sizeof *x.shape);
    double most = norm_max(b.n, x.shape), positive = 0;
    for (int i = 0; i < b.n; i++) positive = fmax(positive, x.shape[i]);
    assert_close(positive, most, 2e-6, 0);
  }
  corot_modes_destroy(one), corot_modes_destroy(two), drop_body(&b);
}

static bool at_once(void *data) { return ++*(int *)data > 3; }

static void what_makes_no_sense_is_refused(void **state) {
  (void)state;
  body b = make_box("warp", COROT_MASS_AUTO, true);
  double *u = calloc(b.n, sizeof *u);
  int asked = 0;
  corot_modes *modes = NULL;
  corot_modes_def good = corot_modes_defaults(), d;
  char most[64];
  snprintf(most, sizeof most, "at most %d can be found", b.n - 1);
  /* clang-format off */
  d = good, d.count = 0;
  assert_fails(corot_modes_find(&d, b.model, 0, NULL, &modes), COROT_EINVAL, "0 modes are asked");
  d.count = b.n;
  assert_fails(corot_modes_find(&d, b.model, 0, NULL, &modes), COROT_EINVAL, most);
  d = good, d.tolerance = NAN;
  assert_fails(corot_modes_find(&d, b.model, 0, NULL, &modes), COROT_EINVAL, "tolerance = nan");
  d = good, d.max_restarts = 0;
  assert_fails(corot_modes_find(&d, b.model, 0, NULL, &modes), COROT_EINVAL, "max_restarts = 0");
  d = good, d.linear.solver = "pcg";
  assert_fails(corot_modes_find(&d, b.model, 0, NULL, &modes), COROT_EINVAL, "not a direct one");
  assert_fails(corot_modes_find(&good, b.model, NAN, NULL, &modes), COROT_EINVAL, "not finite");
  assert_fails(corot_modes_find(&good, b.model, 0, u, &modes), COROT_EINVAL, "turning of its frames");
  d = good, d.stop = at_once, d.stop_data = &asked;
  assert_fails(corot_modes_find(&d, b.model, 0, NULL, &modes), COROT_EINTEGRATE, "stopped");
  /* clang-format on */
  drop_body(&b), free(u);
  assert_null(modes);
  b = make_box("green", COROT_MASS_AUTO, true);
  u = calloc(b.n, sizeof *u);
  u[3] = INFINITY;
  assert_fails(corot_modes_find(&good, b.model, 0, u, &modes), COROT_EINVAL, "u[3] = inf");
  u[3] = 0, u[2] = 50;
  assert_fails(corot_modes_find(&good, b.model, 0, u, &modes), COROT_RETRY, "inverted");
  drop_body(&b), free(u);
}

static void too_few_restarts_are_told(void **state) {
  (void)state;
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = &soft;
  body b = make_body(crooked_box(4, 4, 4), def);
  corot_modes *modes;
  corot_modes_def how = corot_modes_defaults();
  how.max_restarts = 1, how.count = 16;
  assert_fails(corot_modes_find(&how, b.model, 0, NULL, &modes), COROT_EINTEGRATE,
               "after 1 restarts");
  drop_body(&b);
}

/* A support that stands elsewhere than the body at rest. */
static void a_support_away_from_rest_is_refused(void **state) {
  (void)state;
  double time[] = {0, 1}, value[] = {0, 1};
  corot_motion shift = {COROT_MOVE, "zmin", .direction = {0, 0, 0.1},
                        .amplitude = {2, time, value, COROT_CURVE_LINEAR}};
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = &soft, def.nmotion = 1, def.motion = &shift;
  body b = make_body(straight_box(1, 1, 1), def);
  corot_modes *modes;
  corot_modes_def how = corot_modes_defaults();
  assert_fails(corot_modes_find(&how, b.model, 1, NULL, &modes), COROT_EINVAL,
               "a support has taken node 0 away from rest");
  corot_modes_destroy(find(&b, 5, NULL)), drop_body(&b);
}

static corot_status make(void *context) {
  corot_modes *modes;
  corot_modes_def def = corot_modes_defaults();
  def.count = 8;
  corot_status status = corot_modes_find(&def, context, 0, NULL, &modes);
  if (!status) corot_modes_destroy(modes);
  return status;
}

static void every_failed_allocation_is_told(void **state) {
  (void)state;
  body b = make_box("polar", COROT_MASS_AUTO, false);
  assert_true(assert_survives_failed_allocations(make, b.model) > 30);
  drop_body(&b);
}

int main(void) {
  if (!corot_modes_available()) return 77;
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(modes_at_rest_are_those_of_a_dense_solver),
      cmocka_unit_test(every_number_of_modes_can_be_had),
      cmocka_unit_test(none_of_several_equal_modes_is_missed),
      cmocka_unit_test(a_free_body_has_six_rigid_modes),
      cmocka_unit_test(each_part_and_each_hinge_is_seen),
      cmocka_unit_test(unstable_modes_have_growth_rates),
      cmocka_unit_test(any_direct_solver_will_do),
      cmocka_unit_test(pressure_counts_where_it_has_a_potential),
      cmocka_unit_test(a_hierarchy_has_modes_at_rest),
      cmocka_unit_test(the_same_call_gives_the_same_bits),
      cmocka_unit_test(what_makes_no_sense_is_refused),
      cmocka_unit_test(too_few_restarts_are_told),
      cmocka_unit_test(a_support_away_from_rest_is_refused),
      cmocka_unit_test(every_failed_allocation_is_told),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
