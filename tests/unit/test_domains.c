/* Conjugate gradients by domains: these do not touch, what is computed is what it is in one piece,
   and who shares it out makes no difference. */
#include <corot/solve.h>

#include "solid.h"
#include "solve/linsol/iterative/linsol_nodes.h"
#include "solve/pencil/pencil.h"
#include "solver.h"

static const corot_fix clamp = {"zmin", {true, true, true}}, slide = {"zmin", {false, false, true}};

/* Some 4000 nodes or more, which make four domains. */
static body make_long(int nx, int nz, const corot_fix *fix) {
  corot_model_def def = corot_model_defaults();
  corot_mesh *mesh = linear_box(nx, nx, nz);
  def.nmaterial = 1, def.material = &soft;
  def.nfix = fix != NULL, def.fix = fix;
  return make_body(mesh, def);
}

static corot_pencil *stepped_pencil(const body *b) {
  corot_pencil *p;
  double *u = calloc(b->n, sizeof *u);
  assert_ok(corot_pencil_create(b->model, b->state, SOLVER("pcg"), &p));
  assert_ok(corot_pencil_assemble(p, 0, u, u));
  corot_pencil_combine(p, 1, 1e-2, 1e-4);
  free(u);
  return p;
}

static void fill(int n, uint64_t seed, double *x) {
  for (int i = 0; i < n; i++) x[i] = noise(&seed);
}

/* --- The domains --- */

/* Compact bodies and long ones. */
static void domains_do_not_touch(void **state) {
  static const int sizes[][2] = {{2, 5}, {9, 30}, {16, 15}, {3, 700}};
  static const int expected[] = {1, 2, 4, 8};
  (void)state;
  for (int k = 0; k < 4; k++) {
    body b = make_long(sizes[k][0], sizes[k][1], &clamp);
    corot_csc *csc;
    node_graph g;
    domains d;
    assert_ok(corot_csc_create(b.model, COROT_LOWER, &csc));
    assert_ok(corot_graph_create(csc, &g));
    int *order = malloc(g.n * sizeof *order), *of = malloc(g.n * sizeof *of);
    assert_ok(corot_domains_find(&g, order, &d));
    assert_int_equal(d.n, expected[k]);
    for (int i = 0; i < g.n; i++) of[i] = -1;
    for (int i = 0; i < d.first[d.n]; i++) {
      int domain = 0;
      while (i >= d.first[domain + 1]) domain++;
      assert_int_equal(of[order[i]], -1); /* each stands once */
      of[order[i]] = domain;
    }
    for (int i = d.first[d.n]; i < g.n; i++) {
      assert_int_equal(of[order[i]], -1);
      of[order[i]] = d.n;
    }
    for (int i = 0; i < g.n; i++)
      for (int p = g.colptr[i]; p < g.colptr[i + 1]; p++)
        assert_true(of[i] == of[g.row[p]] || of[i] == d.n || of[g.row[p]] == d.n);
    for (int i = 0; i < d.n; i++) /* and they are alike */
      assert_true(d.first[i + 1] - d.first[i] > g.n / (2 * d.n));
    free(order), free(of);
    corot_graph_clear(&g);
    corot_csc_destroy(csc);
    drop_body(&b);
  }
}

/* --- What is computed --- */

/* x of the unknowns in the order of a matrix. */
static void to_slots(const node_matrix *A, int n, const double *x, double *slots) {
  memset(slots, 0, 3 * A->n * sizeof *slots);
  for (int i = 0; i < n; i++) slots[A->slot[i]] = x[i];
}

/* Products by domains are those in one piece; Eisenstat's arrangement is what it is made of; and
   the preconditioner is symmetric and positive. */
static void domains_make_no_other_products(void **state) {
  (void)state;
  body b = make_long(15, 15, &slide); /* nodes of which a component is held */
  corot_pencil *p = stepped_pencil(&b);
  node_matrix A[2];
  int n = b.n, at;
  double *x = malloc(2 * (size_t)n * sizeof *x), *y = x + n;
  for (int k = 0; k < 2; k++) {
    assert_ok(corot_nodes_create(p->csc, k == 1, &A[k]));
    corot_nodes_load(&A[k], p->csc, p->S);
  }
  assert_int_equal(A[0].parts.n, 1);
  assert_int_equal(A[1].parts.n, 4);
  int m = 3 * A[1].n;
  double *big = calloc(5 * (size_t)m, sizeof *big), *a = big + m, *c = a + m, *e = c + m,
         *f = e + m;
  fill(n, 3, x);
  to_slots(&A[0], n, x, big);
  corot_nodes_multiply(&A[0], big, a);
  to_slots(&A[1], n, x, c);
  corot_nodes_multiply(&A[1], c, e);
  for (int i = 0; i < n; i++)
    assert_close(e[A[1].slot[i]], a[A[0].slot[i]], 0, 1e-13 * norm_max(m, a));

  assert_true(corot_nodes_cholesky(&A[1], 1, &at));
  memcpy(a, c, m * sizeof *a);
  corot_nodes_backward(&A[1], a);
  corot_nodes_multiply(&A[1], a, e);
  corot_nodes_forward(&A[1], e);
  corot_nodes_sandwich(&A[1], c, a);
  for (int i = 0; i < m; i++) assert_close(a[i], e[i], 0, 1e-13 * norm_max(m, e));

  /* M^-1 x . y = x . M^-1 y */
  fill(n, 5, y);
  double *of[2] = {a, e};
  to_slots(&A[1], n, x, big), to_slots(&A[1], n, y, f);
  memcpy(a, big, m * sizeof *a), memcpy(e, f, m * sizeof *e);
  for (int k = 0; k < 2; k++) {
    corot_nodes_scale(&A[1], of[k]);
    corot_nodes_forward(&A[1], of[k]);
    corot_nodes_backward(&A[1], of[k]);
    corot_nodes_unscale_transposed(&A[1], of[k]);
  }
  double scale = sqrt(inner(m, big, a) * inner(m, f, e));
  assert_true(inner(m, big, a) > 0);
  assert_close(inner(m, big, e), inner(m, f, a), 0, 1e-12 * scale);
  free(x), free(big);
  corot_nodes_clear(&A[0]), corot_nodes_clear(&A[1]);
  corot_pencil_destroy(p);
  drop_body(&b);
}

/* A pivot that is missing is found in a domain and between them. */
static void missing_pivots_are_found(void **state) {
  (void)state;
  body b = make_long(16, 15, &clamp);
  corot_pencil *p = stepped_pencil(&b);
  node_matrix A;
  int at;
  assert_ok(corot_nodes_create(p->csc, true, &A));
  const int nodes[] = {0, A.parts.first[1], A.parts.first[3] + 5, A.parts.first[4], A.n - 1};
  for (int k = 0; k < 5; k++) {
    corot_nodes_load(&A, p->csc, p->S);
    A.value[9 * nodes[k] + 4] *= -1;
    assert_false(corot_nodes_cholesky(&A, 1, &at));
    assert_int_equal(at, nodes[k]);
    assert_fails(corot_nodes_indefinite(&A, p->csc, at), COROT_RETRY, "not positive definite");
  }
  corot_nodes_clear(&A);
  corot_pencil_destroy(p);
  drop_body(&b);
}

/* --- Who shares it out --- */

static void backwards(void *host, int nparts, void (*part)(void *work, int k), void *work) {
  (void)host;
  for (int k = nparts - 1; k >= 0; k--) part(work, k);
}

/* Solutions and iterations are those of one thread, whoever preconditions. */
static void any_number_of_threads_solves_the_same(void **state) {
  static const char *const preconditioners[] = {"incomplete-cholesky", "block-jacobi", "amg"};
  (void)state;
  body b = make_long(16, 15, &clamp);
  size_t bytes = b.n * sizeof(double);
  double *f = malloc(bytes), *one = malloc(bytes), *x = malloc(bytes);
  fill(b.n, 7, f);
  for (int k = 0; k < 3; k++) {
    corot_linear_def def = *SOLVER("pcg");
    corot_pencil *p;
    long before = 0, iterations = 0;
    def.preconditioner = preconditioners[k];
    assert_ok(corot_pencil_create(b.model, b.state, &def, &p));
    memset(x, 0, bytes);
    for (int threads = 1; threads <= 5; threads++) { /* the last by a host */
      if (threads < 5) assert_ok(corot_state_threads(b.state, threads));
      if (threads == 5) assert_ok(corot_state_parallel(b.state, 3, backwards, NULL));
      memset(x, 0, bytes);
      assert_ok(corot_pencil_assemble(p, 0, x, x));
      corot_pencil_combine(p, 1, 1e-2, 1e-4);
      assert_ok(corot_pencil_factor(p));
      assert_ok(corot_pencil_solve(p, f, x));
      long sum = corot_pencil_statistics(p).niteration;
      if (threads == 1) memcpy(one, x, bytes), iterations = sum;
      assert_memory_equal(x, one, bytes);
      assert_int_equal(sum - before, iterations);
      before = sum;
    }
    assert_ok(corot_state_threads(b.state, 1)); /* which the pencil notices */
    assert_ok(corot_pencil_solve(p, f, x));
    corot_pencil_destroy(p);
  }
  free(f), free(one), free(x);
  drop_body(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(domains_do_not_touch),
      cmocka_unit_test(domains_make_no_other_products),
      cmocka_unit_test(missing_pivots_are_found),
      cmocka_unit_test(any_number_of_threads_solves_the_same),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
