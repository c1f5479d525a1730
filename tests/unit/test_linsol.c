/* The linear solvers, each through the same tests. */
#include <stdbool.h>
#include <suitesparse/SuiteSparse_config.h>

#include "bar.h"
#include "solve/linsol.h"

static const char *const names[] = {"klu", "cholmod", "pcg"};
enum { NSOLVER = 3 };

/* NULL: not in this build. */
static const linsol_ops *find(const char *name) {
  const linsol_ops *ops;
  if (corot_linsol_find(name, 1, &ops) == COROT_OK) return ops;
  assert_fails(corot_linsol_find("cholmod", 1, &ops), COROT_EINVAL, "COROT_CHOLMOD=ON");
  return NULL;
}

/* A bar away from rest, its matrices, and one solver on their pattern. */
typedef struct problem {
  bar bar;
  double (*K)[9], (*D)[9];
  corot_csc *csc;
  double *S;
  const linsol_ops *ops;
  void *solver;
  double *x, *b, *y; /* [n] */
} problem;

static problem problem_create(const linsol_ops *ops, int across, int along) {
  problem p = {.ops = ops};
  bar_def def = example2;
  def.cells[0] = def.cells[1] = across, def.cells[2] = along;
  p.bar = bar_create(&def);
  int n = p.bar.n, nblock = corot_model_nblock(p.bar.model);
  uint64_t seed = 3;
  for (int i = 0; i < n; i++) p.bar.u[i] = 1e-3 * noise(&seed);
  p.K = malloc(2 * nblock * sizeof *p.K);
  p.D = p.K + nblock;
  assert_ok(
      corot_jacobian(p.bar.model, p.bar.state, 0, p.bar.u, p.bar.v, COROT_TANGENT_HELD, p.K, p.D));
  assert_ok(corot_csc_create(p.bar.model, ops->triangle, &p.csc));
  p.S = malloc(p.csc->nnz * sizeof *p.S);
  p.x = malloc(3 * n * sizeof *p.x);
  p.b = p.x + n, p.y = p.b + n;
  for (int i = 0; i < n; i++) p.x[i] = noise(&seed);
  assert_ok(ops->create(p.csc, &p.solver));
  if (ops->set_tolerance) ops->set_tolerance(p.solver, 1e-14);
  return p;
}

static void problem_destroy(problem *p) {
  p->ops->destroy(p->solver);
  corot_csc_destroy(p->csc);
  bar_destroy(&p->bar);
  free(p->K), free(p->S), free(p->x);
}

/* S = a M + b D + c K in the columns, and S x in p->b by the blocks. */
static void set(problem *p, double a, double b, double c) {
  const corot_model *m = p->bar.model;
  const double(*K)[9] = (const double(*)[9])p->K, (*D)[9] = (const double(*)[9])p->D;
  const double *mass = corot_model_mass(m);
  corot_csc_combine(m, p->csc, a, b, D, c, K, p->S);
  corot_block_multiply(m, K, p->x, p->b);
  corot_block_multiply(m, D, p->x, p->y);
  for (int i = 0; i < p->bar.n; i++) p->b[i] = a * mass[i] * p->x[i] + b * p->y[i] + c * p->b[i];
}

/* The largest error of the solution found for p->b. */
static double error(problem *p) {
  memcpy(p->y, p->b, p->bar.n * sizeof *p->y);
  assert_ok(p->ops->solve(p->solver, p->y));
  return difference_of(p->bar.n, p->y, p->x);
}

/* In CVODE's matrices of three steps and in that of statics. The error of the solution is the
   condition number (1e4 at the most, of K) times eps, or the tolerance of an iterative solver. */
static void solve_to_rounding(void **state) {
  (void)state;
  static const double abc[][3] = {
      {1, 1e-4, 1e-8}, {1, 1e-2, 1e-4}, {1, 1, 1}, {1e4, 1e2, 1}, {0, 0, 1}};
  for (int s = 0; s < NSOLVER; s++) {
    const linsol_ops *ops = find(names[s]);
    if (!ops) continue;
    problem p = problem_create(ops, 2, 8);
    for (int k = 0; k < 5; k++) {
      bool fresh = false;
      set(&p, abc[k][0], abc[k][1], abc[k][2]);
      assert_ok(ops->factor(p.solver, p.S, &fresh));
      assert_true(fresh || k > 0);
      assert_below(error(&p), 1e-11);
    }
    problem_destroy(&p);
  }
}

static void factors_with_old_and_new_pivots_agree(void **state) {
  (void)state;
  for (int s = 0; s < NSOLVER; s++) {
    const linsol_ops *ops = find(names[s]);
    if (!ops) continue;
    problem p = problem_create(ops, 2, 6);
    bool fresh = false;
    set(&p, 1, 1e-3, 1e-6);
    assert_ok(ops->factor(p.solver, p.S, &fresh));
    assert_true(fresh);
    set(&p, 1, 1e-2, 1e-4);
    assert_ok(ops->factor(p.solver, p.S, &fresh));
    if (ops == &corot_linsol_klu) assert_false(fresh);
    assert_below(error(&p), 1e-12);
    double *reused = malloc(p.bar.n * sizeof *reused);
    memcpy(reused, p.y, p.bar.n * sizeof *reused);

    ops->destroy(p.solver);
    assert_ok(ops->create(p.csc, &p.solver));
    if (ops->set_tolerance) ops->set_tolerance(p.solver, 1e-14);
    assert_ok(ops->factor(p.solver, p.S, &fresh));
    assert_true(fresh);
    assert_below(error(&p), 1e-12);
    assert_below(difference_of(p.bar.n, p.y, reused), 1e-12);
    free(reused);
    problem_destroy(&p);
  }
}

/* [[d, 1], [1, d]]: a good matrix whether d is large or small, but not with the same pivots. */
static void klu_chooses_new_pivots_where_the_old_ones_fail(void **state) {
  (void)state;
  int colptr[] = {0, 2, 4}, row[] = {0, 1, 0, 1}, diagonal[] = {0, 3};
  corot_csc csc = {.n = 2, .nnz = 4, .colptr = colptr, .row = row, .diagonal = diagonal};
  const double d[] = {4, 3, 1e-14, 0, 5}; /* pivots on the diagonal, but for 1e-14 and 0 */
  const bool expected[] = {true, false, true, false, true};
  void *solver;
  assert_ok(corot_linsol_klu.create(&csc, &solver));
  for (int k = 0; k < 5; k++) {
    double value[] = {d[k], 1, 1, d[k]}, x[] = {d[k] + 2, 1 + 2 * d[k]};
    bool fresh = !expected[k];
    assert_ok(corot_linsol_klu.factor(solver, value, &fresh));
    /* d = 5 can do with the pivots off the diagonal: growth 5, rcond about 1/24 */
    if (k < 4) assert_int_equal(fresh, expected[k]);
    assert_ok(corot_linsol_klu.solve(solver, x));
    assert_close(x[0], 1, 0, 1e-14);
    assert_close(x[1], 2, 0, 1e-14);
  }
  corot_linsol_klu.destroy(solver);
}

/* Without its row and column, a degree of freedom has no pivot; afterwards all is as before. */
static void a_singular_matrix_is_refused(void **state) {
  (void)state;
  enum { GONE = 7 };
  for (int s = 0; s < NSOLVER; s++) {
    const linsol_ops *ops = find(names[s]);
    if (!ops) continue;
    bool klu = ops == &corot_linsol_klu, fresh;
    problem p = problem_create(ops, 1, 6);
    set(&p, 1, 1e-2, 1e-4);
    for (int j = 0; j < p.csc->n; j++)
      for (int k = p.csc->colptr[j]; k < p.csc->colptr[j + 1]; k++)
        if (j == GONE || p.csc->row[k] == GONE) p.S[k] = 0;
    if (klu)
      assert_fails(ops->factor(p.solver, p.S, &fresh), COROT_ESINGULAR, "degree of freedom 7");
    else
      assert_fails(ops->factor(p.solver, p.S, &fresh), COROT_RETRY, "not positive definite");
    set(&p, NAN, 0, 0);
    assert_int_not_equal(ops->factor(p.solver, p.S, &fresh), COROT_OK);
    set(&p, 1, 1e-2, 1e-4);
    assert_ok(ops->factor(p.solver, p.S, &fresh));
    assert_below(error(&p), 1e-12);
    problem_destroy(&p);
  }
}

/* K of a free body is singular, but elimination leaves rounding where the zeros should be. */
static void a_matrix_singular_to_rounding_is_refused(void **state) {
  (void)state;
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = &soft;
  body free_body = make_body(crooked_box(2, 2, 2), def);
  const corot_model *model = free_body.model;
  double(*K)[9] = malloc(corot_model_nblock(model) * sizeof *K);
  double *u = calloc(free_body.n, sizeof *u);
  assert_ok(corot_jacobian(model, free_body.state, 0, u, u, COROT_TANGENT_HELD, K, NULL));
  for (int s = 0; s < NSOLVER; s++) {
    const linsol_ops *ops = find(names[s]);
    if (!ops || ops->iterations) continue;
    corot_csc *csc;
    assert_ok(corot_csc_create(model, ops->triangle, &csc));
    double *S = malloc(csc->nnz * sizeof *S);
    corot_csc_combine(model, csc, 0, 0, NULL, 1, (const double(*)[9])K, S);
    void *solver;
    bool fresh;
    assert_ok(ops->create(csc, &solver));
    corot_status status = ops->factor(solver, S, &fresh);
    assert_true(status == COROT_ESINGULAR || status == COROT_RETRY);
    if (ops == &corot_linsol_klu) assert_int_equal(status, COROT_ESINGULAR);
    ops->destroy(solver);
    corot_csc_destroy(csc);
    free(S);
  }
  free(K), free(u);
  drop_body(&free_body);
}

/* Small enough for cholmod's column by column factorisation, and large enough for its blocks. */
static void an_indefinite_matrix_is_for_klu_only(void **state) {
  (void)state;
  for (int size = 0; size < 2; size++)
    for (int s = 0; s < NSOLVER; s++) {
      const linsol_ops *ops = find(names[s]);
      if (!ops || ops->iterations) continue;
      bool fresh;
      problem p = problem_create(ops, size ? 6 : 1, size ? 24 : 3);
      set(&p, -1e4, 0, 1); /* some modes have a frequency below 100/s */
      if (ops == &corot_linsol_klu) {
        assert_ok(ops->factor(p.solver, p.S, &fresh));
        assert_below(error(&p), 1e-9); /* its distance from a mode's frequency is luck */
      } else {
        assert_fails(ops->factor(p.solver, p.S, &fresh), COROT_RETRY, "not positive definite");
        set(&p, 1, 0, 1);
        assert_ok(ops->factor(p.solver, p.S, &fresh));
        assert_below(error(&p), 1e-11);
      }
      problem_destroy(&p);
    }
}

static void there_is_no_solution_without_a_factor(void **state) {
  (void)state;
  for (int s = 0; s < NSOLVER; s++) {
    const linsol_ops *ops = find(names[s]);
    if (!ops) continue;
    bool fresh;
    problem p = problem_create(ops, 1, 3);
    set(&p, 1, 1e-2, 1e-4);
    assert_fails(ops->solve(p.solver, p.b), COROT_EINVAL, "there is no factor");
    assert_ok(ops->factor(p.solver, p.S, &fresh));
    assert_below(error(&p), 1e-12);
    set(&p, NAN, 0, 0);
    assert_int_not_equal(ops->factor(p.solver, p.S, &fresh), COROT_OK);
    assert_fails(ops->solve(p.solver, p.b), COROT_EINVAL, "there is no factor");
    problem_destroy(&p);
  }
}

/* The bound is on the residual, relative to the right-hand side. */
static void pcg_iterates_to_its_tolerance(void **state) {
  (void)state;
  const double tolerance[] = {1e-3, 1e-6, 1e-9};
  long before = 0;
  problem p = problem_create(&corot_linsol_pcg, 2, 8);
  double *z = malloc(p.bar.n * sizeof *z);
  bool fresh;
  set(&p, 1, 1e-2, 1e-4);
  assert_ok(corot_linsol_pcg.factor(p.solver, p.S, &fresh));
  for (int k = 0; k < 3; k++) {
    corot_linsol_pcg.set_tolerance(p.solver, tolerance[k]);
    set(&p, 1, 1e-2, 1e-4);
    error(&p);
    long iterations = corot_linsol_pcg.iterations(p.solver) - before;
    assert_true(iterations > 2 * (k + 1) && iterations < p.bar.n);
    before += iterations;
    memcpy(z, p.b, p.bar.n * sizeof *z); /* residual: b - S y */
    memcpy(p.x, p.y, p.bar.n * sizeof *z);
    set(&p, 1, 1e-2, 1e-4);
    double residual = 0, size = 0;
    for (int i = 0; i < p.bar.n; i++) residual += (z[i] - p.b[i]) * (z[i] - p.b[i]);
    for (int i = 0; i < p.bar.n; i++) size += z[i] * z[i];
    assert_below(sqrt(residual / size), 1.01 * tolerance[k]);
    assert_above(sqrt(residual / size), 1e-3 * tolerance[k]);
  }
  memset(p.b, 0, p.bar.n * sizeof *p.b);
  memset(p.x, 0, p.bar.n * sizeof *p.x);
  assert_true(error(&p) == 0);
  free(z);
  problem_destroy(&p);
}

static void solvers_are_found_by_name_or_size(void **state) {
  (void)state;
  const linsol_ops *ops, *large = find("cholmod") ? find("cholmod") : find("klu");
  assert_ok(corot_linsol_find("auto", 3000, &ops));
  assert_string_equal(ops->name, "klu");
  assert_ok(corot_linsol_find("auto", 3001, &ops));
  assert_ptr_equal(ops, large);
  for (int s = 0; s < NSOLVER; s++)
    if (find(names[s])) assert_string_equal(find(names[s])->name, names[s]);
  assert_fails(corot_linsol_find("umfpack", 10, &ops), COROT_EINVAL,
               "'umfpack': auto, klu, cholmod or pcg");
  assert_fails(corot_linsol_find(NULL, 10, &ops), COROT_EINVAL, "''");
}

/* SuiteSparse's allocations, counted and failed on demand. */
static struct { long count, live, fail_at; } memory;

static bool fails(void) { return ++memory.count == memory.fail_at; }

static void *counted(void *p) {
  memory.live += p != NULL;
  return p;
}

static void *failing_malloc(size_t size) { return fails() ? NULL : counted(malloc(size)); }
static void *failing_calloc(size_t n, size_t size) {
  return fails() ? NULL : counted(calloc(n, size));
}
static void *failing_realloc(void *p, size_t size) {
  if (fails()) return NULL;
  return p ? realloc(p, size) : counted(malloc(size));
}
static void counting_free(void *p) {
  memory.live -= p != NULL;
  free(p);
}

/* Analysis, a factor, another one, a solution. */
static corot_status make(problem *p) {
  bool fresh;
  void *solver = NULL;
  corot_status status = p->ops->create(p->csc, &solver);
  for (int k = 0; k < 2 && !status; k++) status = p->ops->factor(solver, p->S, &fresh);
  memcpy(p->y, p->b, p->bar.n * sizeof *p->y);
  if (!status) status = p->ops->solve(solver, p->y);
  if (solver) p->ops->destroy(solver);
  return status;
}

static void failed_allocations_are_reported(void **state) {
  (void)state;
  struct SuiteSparse_config_struct saved = SuiteSparse_config;
  for (int size = 0; size < 2; size++)
    for (int s = 0; s < NSOLVER; s++) {
      const linsol_ops *ops = find(names[s]);
      if (!ops || ops == &corot_linsol_pcg) continue; /* its memory is not SuiteSparse's */
      problem p = problem_create(ops, size ? 4 : 1, size ? 16 : 3);
      set(&p, 1, 1e-2, 1e-4);
      SuiteSparse_config.malloc_func = failing_malloc;
      SuiteSparse_config.calloc_func = failing_calloc;
      SuiteSparse_config.realloc_func = failing_realloc;
      SuiteSparse_config.free_func = counting_free;
      for (long k = 1;; k++) {
        memory.count = memory.live = 0, memory.fail_at = k;
        corot_status status = make(&p);
        assert_int_equal(memory.live, 0);
        if (status) {
          assert_int_equal(status, COROT_ENOMEM);
          assert_non_null(strstr(corot_error(), ops->name));
          continue; /* or the solver could do without it, as where a shorter block will do */
        }
        assert_below(difference_of(p.bar.n, p.y, p.x), 1e-12);
        if (memory.count < k) break;
      }
      assert_true(memory.count > 10);
      SuiteSparse_config = saved;
      problem_destroy(&p);
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(solve_to_rounding),
      cmocka_unit_test(factors_with_old_and_new_pivots_agree),
      cmocka_unit_test(klu_chooses_new_pivots_where_the_old_ones_fail),
      cmocka_unit_test(a_singular_matrix_is_refused),
      cmocka_unit_test(a_matrix_singular_to_rounding_is_refused),
      cmocka_unit_test(an_indefinite_matrix_is_for_klu_only),
      cmocka_unit_test(there_is_no_solution_without_a_factor),
      cmocka_unit_test(pcg_iterates_to_its_tolerance),
      cmocka_unit_test(solvers_are_found_by_name_or_size),
      cmocka_unit_test(failed_allocations_are_reported),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
