/* Conjugate gradients: the solver's own properties; what all solvers share is in test_linsol.c. */
#include <malloc.h>

#include "alloc.h"
#include "bar.h"
#include "solve/linsol/iterative/linsol_nodes.h"
#include "solve/linsol/linsol.h"
#include "solve/pencil/pencil.h"
#include "solver.h"

/* A bent bar of which some nodes are held in one or two components, with inner nodes free. */
static body partly_held_bar(int along) {
  corot_box box = {.size = {0.1, 0.1, 0.6}, .cells = {2, 2, along}};
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  corot_fix fix[] = {{"zmin", {true, true, true}},
                     {"xmin", {false, true, false}},
                     {"ymin", {true, false, false}},
                     {"zmax", {true, false, false}}};
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = &soft, def.nfix = 4, def.fix = fix;
  return make_body(mesh, def);
}

static corot_linear_def pcg_with(const char *preconditioner) {
  corot_linear_def def = corot_linear_defaults();
  def.solver = "pcg", def.preconditioner = preconditioner, def.tolerance = 1e-12;
  return def;
}

/* A pencil on a state off rest. */
static corot_pencil *pencil_with(const body *b, const corot_linear_def *def) {
  corot_pencil *p;
  double *u = malloc(2 * b->n * sizeof *u);
  uint64_t seed = 5;
  for (int i = 0; i < 2 * b->n; i++) u[i] = 2e-3 * noise(&seed);
  assert_ok(corot_pencil_create(b->model, b->state, def, &p));
  assert_ok(corot_pencil_assemble(p, 0, u, u + b->n));
  free(u);
  return p;
}

static corot_pencil *pencil_on(const body *b, const char *solver) {
  return pencil_with(b, SOLVER_TO(solver, 1e-12));
}

static long iterations(corot_pencil *p) { return corot_pencil_statistics(p).niteration; }

static void random_vector(int n, double *b) {
  uint64_t seed = 8;
  for (int i = 0; i < n; i++) b[i] = noise(&seed);
}

/* From a step so short that the mass is all there is, to one so long that it is none. */
static void solves_like_klu_in_more_iterations_as_steps_grow(void **state) {
  (void)state;
  body b = partly_held_bar(8);
  corot_pencil *klu = pencil_on(&b, "klu"), *pcg = pencil_on(&b, "pcg");
  double *f = malloc(3 * b.n * sizeof *f), *x = f + b.n, *y = x + b.n;
  long last = 0;
  assert_int_equal(iterations(klu), 0);
  random_vector(b.n, f);
  const double gamma[] = {1e-6, 3e-4, 1e-3, 1e-2, 1e-1};
  for (int k = 0; k < 5; k++) {
    double g = gamma[k];
    corot_pencil *const both[] = {klu, pcg};
    for (int i = 0; i < 2; i++) {
      corot_pencil_combine(both[i], 1, g, g * g);
      assert_ok(corot_pencil_factor(both[i]));
    }
    assert_ok(corot_pencil_solve(klu, f, x));
    long before = iterations(pcg);
    assert_ok(corot_pencil_solve(pcg, f, y));
    long took = iterations(pcg) - before;
    /* the condition number is 1e4 at the most */
    assert_below(difference_of(b.n, x, y), 1e-9 * norm_max(b.n, x));
    if (k == 0) assert_true(took <= 3); /* the preconditioner is the inverse, nearly */
    assert_true(took > last && took < b.n);
    last = took;
  }
  assert_int_equal(corot_pencil_statistics(pcg).nsolve, 5);
  assert_int_equal(corot_pencil_statistics(pcg).nfactor, 5);
  free(f), corot_pencil_destroy(klu), corot_pencil_destroy(pcg), drop_body(&b);
}

/* Nodes of one, two and three free components each have a block of their own: where no two free
   nodes share a tet, the preconditioner is the inverse and one iteration is all. */
static void blocks_of_partly_held_nodes_are_inverted(void **state) {
  (void)state;
  for (int held = 0; held < 3; held++) {
    corot_box box = {.size = {1, 1, 1}, .cells = {1, 1, 1}};
    corot_mesh *mesh;
    assert_ok(corot_mesh_box(&box, &mesh));
    int node[] = {0, 1, 2, 3, 4, 5, 6}, last = 7;
    assert_ok(corot_mesh_group_nodes(mesh, "all but one", 7, node));
    assert_ok(corot_mesh_group_nodes(mesh, "one", 1, &last));
    corot_fix fix[] = {{"all but one", {true, true, true}}, {"one", {held > 1, false, held > 0}}};
    corot_model_def def = corot_model_defaults();
    def.nmaterial = 1, def.material = &soft, def.nfix = 2, def.fix = fix;
    body b = make_body(mesh, def);
    assert_int_equal(b.n, 3 - held);
    corot_pencil *klu = pencil_on(&b, "klu"), *pcg = pencil_on(&b, "pcg");
    double f[3] = {1, -2, 3}, x[3], y[3];
    corot_pencil_combine(klu, 1, 0.1, 0.01), corot_pencil_combine(pcg, 1, 0.1, 0.01);
    assert_ok(corot_pencil_factor(klu));
    assert_ok(corot_pencil_factor(pcg));
    assert_ok(corot_pencil_solve(klu, f, x));
    assert_ok(corot_pencil_solve(pcg, f, y));
    assert_int_equal(iterations(pcg), 1);
    for (int i = 0; i < b.n; i++) assert_close(y[i], x[i], 1e-13, 0);
    corot_pencil_destroy(klu), corot_pencil_destroy(pcg), drop_body(&b);
  }
}

static const char *const preconditioners[] = {"block-jacobi", "incomplete-cholesky"};

/* K - w^2 M with w above the lowest frequencies: no node's block says so, but a direction does. */
static void an_indefinite_matrix_is_found_out(void **state) {
  (void)state;
  body b = partly_held_bar(8);
  double *f = malloc(2 * b.n * sizeof *f), *x = f + b.n;
  random_vector(b.n, f);
  for (int k = 0; k < 2; k++) {
    corot_linear_def def = pcg_with(preconditioners[k]);
    def.role = COROT_ROLE_STATIC; /* as nobody steps in there */
    corot_pencil *pcg = pencil_with(&b, &def);
    corot_pencil_combine(pcg, -1e4, 0, 1);
    assert_ok(corot_pencil_factor(pcg));
    assert_fails(corot_pencil_solve(pcg, f, x), COROT_RETRY, "not positive definite");
    assert_true(iterations(pcg) < b.n);
    corot_pencil_combine(pcg, -1e9, 0, 1);
    assert_fails(corot_pencil_factor(pcg), COROT_RETRY, "degree of freedom 0 of node 9");
    assert_int_equal(corot_pencil_statistics(pcg).nindefinite, 1);
    corot_pencil_combine(pcg, 1, 1e-2, 1e-4); /* and forgotten */
    assert_ok(corot_pencil_factor(pcg));
    assert_ok(corot_pencil_solve(pcg, f, x));
    x[0] = NAN;
    assert_fails(corot_pencil_solve(pcg, x, x), COROT_RETRY, "pcg: ");
    corot_pencil_destroy(pcg);
  }
  free(f), drop_body(&b);
}

static corot_status try_shift(corot_pencil *p, double shift, bool *known) {
  corot_pencil_combine(p, -shift, 0, 1);
  return corot_pencil_factor_proved(p, known);
}

/* The lowest eigenvalue of K, M, to 14 digits: up to it K - s M is positive definite. */
static double lowest(corot_pencil *klu) {
  double low = 0, high = 1;
  bool known;
  while (try_shift(klu, high, &known) == COROT_OK) low = high, high *= 2;
  while (high - low > 1e-14 * high) {
    double middle = 0.5 * (low + high);
    *(try_shift(klu, middle, &known) ? &high : &low) = middle;
  }
  return low;
}

/* Both of a matrix that is positive definite by a hair and of one that is not by as much. */
static void definiteness_is_proved(void **state) {
  (void)state;
  static const char *const names[] = {"block-jacobi", "incomplete-cholesky", "amg"};
  body b = partly_held_bar(8);
  corot_linear_def def = corot_linear_defaults();
  def.role = COROT_ROLE_STATIC, def.solver = "klu";
  corot_pencil *klu = pencil_with(&b, &def);
  double root = lowest(klu);
  for (int k = 0; k < 3; k++) {
    def.solver = "pcg", def.preconditioner = names[k];
    corot_pencil *p = pencil_with(&b, &def);
    for (double apart = 0.5; apart > 1e-9; apart *= 0.1) {
      bool known = false;
      assert_ok(try_shift(p, root * (1 - apart), &known));
      assert_true(known);
      assert_fails(try_shift(p, root * (1 + apart), &known), COROT_RETRY, "not positive definite");
      assert_true(known);
    }
    corot_pencil_destroy(p);
  }
  corot_pencil_destroy(klu);
  drop_body(&b);
}

/* --- incomplete Cholesky --- */

/* The matrix of a step of a pencil by nodes, with its incomplete factor. */
static node_matrix factored_nodes(corot_pencil *p) {
  node_matrix A;
  int at;
  assert_ok(corot_nodes_create(p->csc, false, &A));
  corot_pencil_combine(p, 1, 1e-2, 1e-4);
  corot_nodes_load(&A, p->csc, p->S);
  assert_true(corot_nodes_cholesky(&A, 0.1, &at));
  return A;
}

static double dot(int n, const double *a, const double *b) {
  double sum = 0;
  for (int i = 0; i < n; i++) sum += a[i] * b[i];
  return sum;
}

/* M^-1 = C^-T (I + L')^-1 (I + L)^-1 C^-1 */
static void apply_preconditioner(node_matrix *A, const double *x, double *y) {
  memcpy(y, x, 3 * A->n * sizeof *y);
  corot_nodes_scale(A, y);
  corot_nodes_forward(A, y);
  corot_nodes_backward(A, y);
  corot_nodes_unscale_transposed(A, y);
}

static void the_preconditioner_is_symmetric_and_positive(void **state) {
  (void)state;
  body b = partly_held_bar(4);
  corot_pencil *p = pencil_on(&b, "pcg");
  node_matrix A = factored_nodes(p);
  int n = 3 * A.n;
  double *x = malloc(4 * n * sizeof *x), *y = x + n, *Mx = y + n, *My = Mx + n;
  uint64_t seed = 3;
  for (int k = 0; k < 20; k++) {
    for (int i = 0; i < 2 * n; i++) x[i] = noise(&seed);
    apply_preconditioner(&A, x, Mx);
    apply_preconditioner(&A, y, My);
    double scale = sqrt(dot(n, x, Mx) * dot(n, y, My));
    assert_true(dot(n, x, Mx) > 0 && dot(n, y, My) > 0);
    assert_close(dot(n, x, My), dot(n, y, Mx), 0, 1e-13 * scale);
  }
  free(x), corot_nodes_clear(&A), corot_pencil_destroy(p), drop_body(&b);
}

/* Eisenstat's arrangement against its definition, (I + L)^-1 (D + L + L') (I + L')^-1. */
static void the_sandwich_is_what_it_is_made_of(void **state) {
  (void)state;
  body b = partly_held_bar(4);
  corot_pencil *p = pencil_on(&b, "pcg");
  node_matrix A = factored_nodes(p);
  int n = 3 * A.n;
  double *x = malloc(4 * n * sizeof *x), *y = x + n, *z = y + n;
  random_vector(n, x);
  memcpy(y, x, n * sizeof *x);
  corot_nodes_backward(&A, y);
  corot_nodes_multiply(&A, y, z);
  corot_nodes_forward(&A, z);
  corot_nodes_sandwich(&A, x, y);
  assert_below(difference_of(n, y, z), 1e-13 * norm_max(n, z));
  free(x), corot_nodes_clear(&A), corot_pencil_destroy(p), drop_body(&b);
}

/* Where the free nodes are the beads of a string, elimination makes no fill. */
static void without_fill_the_factor_is_complete(void **state) {
  (void)state;
  corot_box box = {.size = {0.1, 0.1, 0.9}, .cells = {1, 1, 9}};
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  int *rest = malloc(mesh->nnode * sizeof *rest), nrest = 0;
  for (int i = 0; i < mesh->nnode; i++)
    if (mesh->x[i][0] > 0 || mesh->x[i][1] > 0) rest[nrest++] = i;
  assert_int_equal(mesh->nnode - nrest, 10);
  assert_ok(corot_mesh_group_nodes(mesh, "rest", nrest, rest));
  free(rest);
  corot_fix fix = {"rest", {true, true, true}};
  corot_model_def model = corot_model_defaults();
  model.nmaterial = 1, model.material = &soft, model.nfix = 1, model.fix = &fix;
  body b = make_body(mesh, model);
  double f[30], x[30], y[30];
  assert_int_equal(b.n, 30);
  random_vector(30, f);
  corot_pencil *klu = pencil_on(&b, "klu");
  corot_pencil_combine(klu, 1, 0.1, 0.01);
  assert_ok(corot_pencil_factor(klu));
  assert_ok(corot_pencil_solve(klu, f, x));
  for (int k = 0; k < 2; k++) {
    corot_linear_def def = pcg_with(preconditioners[k]);
    corot_pencil *pcg = pencil_with(&b, &def);
    corot_pencil_combine(pcg, 1, 0.1, 0.01);
    assert_ok(corot_pencil_factor(pcg));
    assert_ok(corot_pencil_solve(pcg, f, y));
    assert_below(difference_of(30, x, y), 1e-10 * norm_max(30, x));
    assert_true(k == 1 ? iterations(pcg) == 1 : iterations(pcg) > 5);
    corot_pencil_destroy(pcg);
  }
  corot_pencil_destroy(klu), drop_body(&b);
}

static void it_halves_the_iterations(void **state) {
  (void)state;
  body b = partly_held_bar(8);
  double *f = malloc(2 * b.n * sizeof *f);
  const double abc[][3] = {{1, 1e-2, 1e-4}, {0, 0, 1}};
  random_vector(b.n, f);
  for (int i = 0; i < 2; i++) {
    long took[2];
    for (int k = 0; k < 2; k++) {
      corot_linear_def def = pcg_with(preconditioners[k]);
      corot_pencil *pcg = pencil_with(&b, &def);
      corot_pencil_combine(pcg, abc[i][0], abc[i][1], abc[i][2]);
      assert_ok(corot_pencil_factor(pcg));
      assert_ok(corot_pencil_solve(pcg, f, f + b.n));
      took[k] = iterations(pcg);
      corot_pencil_destroy(pcg);
    }
    assert_true(took[1] < 0.55 * took[0]);
  }
  free(f), drop_body(&b);
}

/* Kershaw's (1978): positive definite, but its incomplete factor has a negative pivot. */
static void a_factor_that_breaks_down_is_shifted(void **state) {
  (void)state;
  int colptr[] = {0, 3, 5, 7, 8}, row[] = {0, 1, 3, 1, 2, 2, 3, 3};
  int diagonal[] = {0, 3, 5, 7}, node[] = {0, 1, 2, 3}, at;
  double value[] = {3, -2, 2, 3, -2, 3, -2, 3};
  int source[8] = {0}; /* each node has its x component only */
  corot_csc csc = {4, 8, colptr, row, source, diagonal, node};
  node_matrix A;
  assert_ok(corot_nodes_create(&csc, false, &A));
  corot_nodes_load(&A, &csc, value);
  assert_false(corot_nodes_cholesky(&A, 0, &at));
  assert_int_equal(at, 3);
  corot_nodes_clear(&A);

  linsol_plan plan = {.def = pcg_with("incomplete-cholesky")};
  void *solver;
  bool fresh;
  double x[] = {3 - 4 + 8, -2 + 6 - 6, -4 + 9 - 8, 2 - 6 + 12}; /* of 1, 2, 3, 4 */
  assert_ok(corot_linsol_pcg.create(&csc, &plan, &solver));
  assert_ok(corot_linsol_pcg.factor(solver, value, &fresh));
  assert_ok(corot_linsol_pcg.solve(solver, x));
  for (int i = 0; i < 4; i++) assert_close(x[i], i + 1, 0, 1e-11);
  corot_linsol_pcg.destroy(solver);
}

/* With a right-hand side of which most cancels in the product, rounding keeps the residual above a
   tolerance this small; what can be had is had. */
static void rounding_is_no_failure(void **state) {
  (void)state;
  body b = partly_held_bar(16);
  double *f = malloc(2 * b.n * sizeof *f);
  random_vector(b.n, f);
  for (int k = 0; k < 2; k++) {
    corot_linear_def def = pcg_with(preconditioners[k]);
    def.tolerance = 1e-16;
    corot_pencil *pcg = pencil_with(&b, &def);
    corot_pencil_combine(pcg, 0, 0, 1);
    assert_ok(corot_pencil_factor(pcg));
    assert_ok(corot_pencil_solve(pcg, f, f + b.n));
    corot_pencil_destroy(pcg);
  }
  free(f), drop_body(&b);
}

static size_t bytes_in_use(void) {
#if defined(__GLIBC__) && (__GLIBC__ > 2 || __GLIBC_MINOR__ >= 33)
  return mallinfo2().uordblks;
#else
  return 0;
#endif
}

static corot_status make_pcg(void *context) {
  linsol s;
  corot_status status = corot_linsol_create(context, SOLVER("pcg"), &s);
  corot_linsol_clear(&s);
  return status;
}

/* All that is ever needed is allocated at creation: of ours each piece is counted, of SUNDIALS'
   what is left behind. */
static void memory_is_of_creation_only(void **state) {
  (void)state;
  body b = partly_held_bar(4);
  assert_true(assert_survives_failed_allocations(make_pcg, b.model) > 10);

  corot_pencil *pcg = pencil_on(&b, "pcg");
  double *f = malloc(b.n * sizeof *f);
  alloc_fail_at(0);
  size_t before = bytes_in_use();
  for (int k = 0; k < 5; k++) {
    random_vector(b.n, f);
    corot_pencil_combine(pcg, 1, 1e-2, 1e-4);
    assert_ok(corot_pencil_factor(pcg));
    assert_ok(corot_pencil_solve(pcg, f, f));
  }
  assert_int_equal(bytes_in_use(), before);
  assert_int_equal(alloc_count(), 0);
  free(f), corot_pencil_destroy(pcg), drop_body(&b);
}

/* The same steps, and the same way to 1e-8 of it, of the tip of the bar of bar.h. */
static void a_run_takes_the_same_way(void **state) {
  (void)state;
  bar_def of = example2;
  of.ramp = 0.2, of.traction[0] = 1000;
  bar b = bar_create(&of), c = bar_create(&of);
  corot_integrator_def def = corot_integrator_defaults();
  def.linear.solver = "klu";
  corot_integrator *klu = start(&b, &def);
  def.linear.solver = "pcg", def.linear.tolerance = 1e-12;
  corot_integrator *pcg = start(&c, &def);
  for (corot_step step = {0}; step.t < 0.3;) {
    corot_step other;
    assert_ok(corot_integrator_step(klu, 0.3, &step));
    assert_ok(corot_integrator_step(pcg, 0.3, &other));
    assert_close(other.t, step.t, 1e-8, 0);
    assert_int_equal(other.order, step.order);
  }
  assert_ok(corot_integrator_at(klu, 0.3, b.u, NULL));
  assert_ok(corot_integrator_at(pcg, 0.3, c.u, NULL));
  assert_below(difference_of(b.n, b.u, c.u), 1e-8 * norm_max(b.n, b.u));
  corot_statistics s = corot_integrator_statistics(pcg);
  assert_true(s.nli > s.nsolve && corot_integrator_statistics(klu).nli == 0);
  corot_integrator_destroy(klu), corot_integrator_destroy(pcg);
  bar_destroy(&b), bar_destroy(&c);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(solves_like_klu_in_more_iterations_as_steps_grow),
      cmocka_unit_test(blocks_of_partly_held_nodes_are_inverted),
      cmocka_unit_test(an_indefinite_matrix_is_found_out),
      cmocka_unit_test(definiteness_is_proved),
      cmocka_unit_test(the_preconditioner_is_symmetric_and_positive),
      cmocka_unit_test(the_sandwich_is_what_it_is_made_of),
      cmocka_unit_test(without_fill_the_factor_is_complete),
      cmocka_unit_test(it_halves_the_iterations),
      cmocka_unit_test(a_factor_that_breaks_down_is_shifted),
      cmocka_unit_test(rounding_is_no_failure),
      cmocka_unit_test(memory_is_of_creation_only),
      cmocka_unit_test(a_run_takes_the_same_way),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
