/* Conjugate gradients: the solver's own properties; what all solvers share is in test_linsol.c. */
#include <malloc.h>

#include "alloc.h"
#include "bar.h"
#include "solve/linsol.h"
#include "solve/pencil.h"
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

/* A pencil on a state off rest. */
static corot_pencil *pencil_on(const body *b, const char *solver) {
  corot_pencil *p;
  double *u = malloc(2 * b->n * sizeof *u);
  uint64_t seed = 5;
  for (int i = 0; i < 2 * b->n; i++) u[i] = 2e-3 * noise(&seed);
  assert_ok(corot_pencil_create(b->model, b->state, SOLVER_TO(solver, 1e-12), &p));
  assert_ok(corot_pencil_assemble(p, 0, u, u + b->n));
  free(u);
  return p;
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

/* K - w^2 M with w above the lowest frequencies: no node's block says so, but a direction does. */
static void an_indefinite_matrix_is_found_out(void **state) {
  (void)state;
  body b = partly_held_bar(8);
  corot_pencil *pcg = pencil_on(&b, "pcg");
  double *f = malloc(2 * b.n * sizeof *f), *x = f + b.n;
  random_vector(b.n, f);
  corot_pencil_combine(pcg, -1e4, 0, 1);
  assert_ok(corot_pencil_factor(pcg));
  assert_fails(corot_pencil_solve(pcg, f, x), COROT_RETRY, "not positive definite");
  assert_true(iterations(pcg) < b.n);
  corot_pencil_combine(pcg, -1e9, 0, 1);
  assert_fails(corot_pencil_factor(pcg), COROT_RETRY, "not positive definite (unknown 0)");
  assert_int_equal(corot_pencil_statistics(pcg).nindefinite, 1);
  corot_pencil_combine(pcg, 1, 1e-2, 1e-4); /* and forgotten */
  assert_ok(corot_pencil_factor(pcg));
  assert_ok(corot_pencil_solve(pcg, f, x));
  x[0] = NAN;
  assert_fails(corot_pencil_solve(pcg, x, x), COROT_RETRY, "pcg: ");
  free(f), corot_pencil_destroy(pcg), drop_body(&b);
}

static size_t bytes_in_use(void) {
#if defined(__GLIBC__) && (__GLIBC__ > 2 || __GLIBC_MINOR__ >= 33)
  return mallinfo2().uordblks;
#else
  return 0;
#endif
}

static corot_status make_pcg(void *context) {
  void *solver;
  COROT_TRY(corot_linsol_pcg.create(context, &solver));
  corot_linsol_pcg.destroy(solver);
  return COROT_OK;
}

/* All that is ever needed is allocated at creation: of ours each piece is counted, of SUNDIALS'
   what is left behind. */
static void memory_is_of_creation_only(void **state) {
  (void)state;
  body b = partly_held_bar(4);
  corot_csc *csc;
  assert_ok(corot_csc_create(b.model, COROT_FULL, &csc));
  assert_int_equal(assert_survives_failed_allocations(make_pcg, csc), 3);

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
  free(f), corot_pencil_destroy(pcg), corot_csc_destroy(csc), drop_body(&b);
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
      cmocka_unit_test(memory_is_of_creation_only),
      cmocka_unit_test(a_run_takes_the_same_way),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
