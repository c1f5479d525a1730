/* The linear solvers, each through the same tests. */
#include <signal.h>
#include <stdbool.h>
#include <time.h>

#include "bar.h"
#include "solve/linsol/linsol.h"
#include "suitesparse_memory.h"

/* Every solver with every choice it has. */
static const corot_linear_def table[] = {
    {"klu", "amd", "auto", "auto", 1e-13, COROT_ROLE_DYNAMIC, NULL, NULL},
    {"klu", "metis", "auto", "auto", 1e-13, COROT_ROLE_DYNAMIC, NULL, NULL},
    {"cholmod", "amd", "simplicial", "auto", 1e-13, COROT_ROLE_DYNAMIC, NULL, NULL},
    {"cholmod", "metis", "simplicial", "auto", 1e-13, COROT_ROLE_DYNAMIC, NULL, NULL},
    {"cholmod", "amd", "supernodal", "auto", 1e-13, COROT_ROLE_DYNAMIC, NULL, NULL},
    {"cholmod", "metis", "supernodal", "auto", 1e-13, COROT_ROLE_DYNAMIC, NULL, NULL},
    {"pcg", "auto", "auto", "block-jacobi", 1e-13, COROT_ROLE_DYNAMIC, NULL, NULL},
    {"pcg", "auto", "auto", "incomplete-cholesky", 1e-13, COROT_ROLE_DYNAMIC, NULL, NULL},
    {"pcg", "auto", "auto", "amg", 1e-13, COROT_ROLE_DYNAMIC, NULL, NULL},
};
enum { NSOLVER = sizeof table / sizeof *table };

/* A bar away from rest, its matrices, and one solver on their pattern. */
typedef struct problem {
  bar bar;
  double (*K)[9], (*D)[9];
  linsol s;
  double *x, *b, *y; /* [n] */
} problem;

static void problem_destroy(problem *p) {
  corot_linsol_clear(&p->s);
  bar_destroy(&p->bar);
  free(p->K), free(p->x);
}

/* False: not in this build, and the message says how to have it. */
static bool problem_create(const corot_linear_def *solver, int across, int along, problem *p) {
  *p = (problem){0};
  bar_def def = example2;
  def.cells[0] = def.cells[1] = across, def.cells[2] = along;
  p->bar = bar_create(&def);
  int n = p->bar.n, nblock = corot_model_nblock(p->bar.model);
  uint64_t seed = 3;
  for (int i = 0; i < n; i++) p->bar.u[i] = 1e-3 * noise(&seed);
  p->K = malloc(2 * nblock * sizeof *p->K);
  p->D = p->K + nblock;
  assert_ok(corot_jacobian(p->bar.model, p->bar.state, 0, p->bar.u, p->bar.v, COROT_TANGENT_HELD,
                           p->K, p->D));
  p->x = malloc(3 * n * sizeof *p->x);
  p->b = p->x + n, p->y = p->b + n;
  for (int i = 0; i < n; i++) p->x[i] = noise(&seed);
  corot_status status = corot_linsol_create(p->bar.model, solver, &p->s);
  if (status == COROT_OK) return true;
  assert_int_equal(status, COROT_EINVAL);
  assert_non_null(strstr(corot_error(), "COROT_CHOLMOD=ON"));
  problem_destroy(p);
  return false;
}

static bool is(const problem *p, const char *name) { return strcmp(p->s.ops->name, name) == 0; }

/* S = a M + b D + c K in the columns, and S x in p->b by the blocks. */
static void set(problem *p, double a, double b, double c) {
  const corot_model *m = p->bar.model;
  const double(*K)[9] = (const double(*)[9])p->K, (*D)[9] = (const double(*)[9])p->D;
  corot_csc_combine(m, p->s.csc, a, b, D, c, K, p->s.value);
  corot_block_multiply(m, K, p->x, p->b);
  corot_block_multiply(m, D, p->x, p->y);
  for (int i = 0; i < p->bar.n; i++) p->b[i] = b * p->y[i] + c * p->b[i];
  corot_mass_multiply(m, p->x, p->y);
  for (int i = 0; i < p->bar.n; i++) p->b[i] += a * p->y[i];
}

/* Ten-node tets have a condition number a few times that of the four-node ones. */
static double worse(void) { return order_of_test() == 1 ? 1 : 10; }

/* The largest error of the solution found for p->b. */
static double error(problem *p) {
  memcpy(p->y, p->b, p->bar.n * sizeof *p->y);
  assert_ok(p->s.ops->solve(p->s.solver, p->y));
  return difference_of(p->bar.n, p->y, p->x);
}

static corot_status factor(problem *p) {
  bool fresh;
  return p->s.ops->factor(p->s.solver, p->s.value, &fresh);
}

/* In CVODE's matrices of three steps and in that of statics. The error of the solution is the
   condition number (1e4 at the most, of K) times eps, or the tolerance of an iterative solver. */
static void solve_to_rounding(void **state) {
  (void)state;
  static const double abc[][3] = {
      {1, 1e-4, 1e-8}, {1, 1e-2, 1e-4}, {1, 1, 1}, {1e4, 1e2, 1}, {0, 0, 1}};
  for (int k = 0; k < NSOLVER; k++) {
    problem p;
    if (!problem_create(&table[k], 2, 8, &p)) continue;
    for (int i = 0; i < 5; i++) {
      bool fresh = false;
      set(&p, abc[i][0], abc[i][1], abc[i][2]);
      assert_ok(p.s.ops->factor(p.s.solver, p.s.value, &fresh));
      assert_true(fresh || i > 0);
      assert_below(error(&p), 1e-11 * worse());
    }
    problem_destroy(&p);
  }
}

static void factors_with_old_and_new_pivots_agree(void **state) {
  (void)state;
  for (int k = 0; k < NSOLVER; k++) {
    problem p, q;
    bool fresh = false;
    if (!problem_create(&table[k], 2, 6, &p)) continue;
    assert_true(problem_create(&table[k], 2, 6, &q));
    set(&p, 1, 1e-3, 1e-6);
    assert_ok(p.s.ops->factor(p.s.solver, p.s.value, &fresh));
    assert_true(fresh);
    set(&p, 1, 1e-2, 1e-4);
    assert_ok(p.s.ops->factor(p.s.solver, p.s.value, &fresh));
    if (is(&p, "klu")) assert_false(fresh);
    assert_below(error(&p), 1e-12 * worse());

    set(&q, 1, 1e-2, 1e-4);
    assert_ok(q.s.ops->factor(q.s.solver, q.s.value, &fresh));
    assert_true(fresh);
    assert_below(error(&q), 1e-12 * worse());
    assert_below(difference_of(p.bar.n, p.y, q.y), 1e-12 * worse());
    problem_destroy(&p), problem_destroy(&q);
  }
}

/* [[d, 1], [1, d]]: a good matrix whether d is large or small, but not with the same pivots. */
static void klu_chooses_new_pivots_where_the_old_ones_fail(void **state) {
  (void)state;
  int colptr[] = {0, 2, 4}, row[] = {0, 1, 0, 1}, diagonal[] = {0, 3}, node[] = {0, 0};
  corot_csc csc = {2, 4, colptr, row, NULL, diagonal, node};
  linsol_plan plan = {.order = (int[]){1, 0}};
  const double d[] = {4, 3, 1e-14, 0, 5}; /* pivots on the diagonal, but for 1e-14 and 0 */
  const bool expected[] = {true, false, true, false, true};
  void *solver;
  assert_ok(corot_linsol_klu.create(&csc, &plan, &solver));
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

/* Without its row and column, a degree of freedom has no pivot; afterwards all is as before. The
   dof is free number 7 of a bar whose first layer, of four nodes, is held. */
static void a_singular_matrix_is_refused(void **state) {
  (void)state;
  enum { GONE = 7 };
  for (int k = 0; k < NSOLVER; k++) {
    problem p;
    if (!problem_create(&table[k], 1, 6, &p)) continue;
    set(&p, 1, 1e-2, 1e-4);
    const corot_csc *csc = p.s.csc;
    for (int j = 0; j < csc->n; j++)
      for (int i = csc->colptr[j]; i < csc->colptr[j + 1]; i++)
        if (j == GONE || csc->row[i] == GONE) p.s.value[i] = 0;
    if (is(&p, "klu"))
      assert_fails(factor(&p), COROT_ESINGULAR, "singular at degree of freedom 7 of node 6");
    else
      assert_fails(factor(&p), COROT_RETRY, "not positive definite");
    if (is(&p, "cholmod")) assert_non_null(strstr(corot_error(), "degree of freedom 7 of node 6"));
    if (is(&p, "pcg")) assert_non_null(strstr(corot_error(), "node 6"));
    set(&p, NAN, 0, 0);
    assert_int_not_equal(factor(&p), COROT_OK);
    set(&p, 1, 1e-2, 1e-4);
    assert_ok(factor(&p));
    assert_below(error(&p), 1e-12 * worse());
    problem_destroy(&p);
  }
}

/* A pivot that is mere rounding beside the others is none. */
static void a_vanishing_pivot_is_named(void **state) {
  (void)state;
  enum { GONE = 7 };
  for (int k = 0; k < NSOLVER; k++) {
    problem p;
    if (!problem_create(&table[k], 1, 6, &p)) continue;
    if (is(&p, "cholmod")) { /* klu scales the rows first */
      set(&p, 1, 1e-2, 1e-4);
      const corot_csc *csc = p.s.csc;
      for (int j = 0; j < csc->n; j++)
        for (int i = csc->colptr[j]; i < csc->colptr[j + 1]; i++) {
          if (j == GONE || csc->row[i] == GONE) p.s.value[i] = 0;
          if (j == GONE && csc->row[i] == GONE) p.s.value[i] = 1e-40;
        }
      assert_fails(factor(&p), COROT_ESINGULAR, "singular at degree of freedom 7 of node 6");
    }
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
  for (int k = 0; k < NSOLVER; k++) {
    linsol s;
    bool fresh;
    if (corot_linsol_create(model, &table[k], &s) == COROT_OK && !s.ops->iterations) {
      corot_csc_combine(model, s.csc, 0, 0, NULL, 1, (const double(*)[9])K, s.value);
      corot_status status = s.ops->factor(s.solver, s.value, &fresh);
      assert_true(status == COROT_ESINGULAR || status == COROT_RETRY);
      if (s.ops == &corot_linsol_klu) assert_int_equal(status, COROT_ESINGULAR);
      assert_non_null(strstr(corot_error(), "degree of freedom"));
    }
    corot_linsol_clear(&s);
  }
  free(K), free(u);
  drop_body(&free_body);
}

static void an_indefinite_matrix_is_for_klu_only(void **state) {
  (void)state;
  for (int large = 0; large < (order_of_test() == 1 ? 2 : 1); large++)
    for (int k = 0; k < NSOLVER; k++) {
      problem p;
      if (!problem_create(&table[k], large ? 5 : 1, large ? 20 : 3, &p)) continue;
      set(&p, -1e4, 0, 1); /* some modes have a frequency below 100/s */
      if (is(&p, "klu")) {
        assert_ok(factor(&p));
        assert_below(error(&p), 1e-9); /* its distance from a mode's frequency is luck */
      } else if (is(&p, "cholmod")) {
        assert_fails(factor(&p), COROT_RETRY, "not positive definite");
        set(&p, 1, 0, 1);
        assert_ok(factor(&p));
        assert_below(error(&p), 1e-11 * worse());
      }
      problem_destroy(&p);
    }
}

static void there_is_no_solution_without_a_factor(void **state) {
  (void)state;
  for (int k = 0; k < NSOLVER; k++) {
    problem p;
    if (!problem_create(&table[k], 1, 3, &p)) continue;
    set(&p, 1, 1e-2, 1e-4);
    assert_fails(p.s.ops->solve(p.s.solver, p.b), COROT_EINVAL, "there is no factor");
    assert_ok(factor(&p));
    assert_below(error(&p), 1e-12 * worse());
    set(&p, NAN, 0, 0);
    assert_int_not_equal(factor(&p), COROT_OK);
    assert_fails(p.s.ops->solve(p.s.solver, p.b), COROT_EINVAL, "there is no factor");
    problem_destroy(&p);
  }
}

/* The bound is on the residual, relative to the right-hand side. */
static void pcg_iterates_to_its_tolerance(void **state) {
  (void)state;
  const double tolerance[] = {1e-3, 1e-6, 1e-9};
  for (int k = 0; k < NSOLVER; k++) {
    long last = 0;
    if (strcmp(table[k].solver, "pcg") != 0) continue;
    for (int i = 0; i < 3; i++) {
      corot_linear_def def = table[k];
      def.tolerance = tolerance[i];
      problem p;
      if (!problem_create(&def, 4, 16, &p)) continue; /* large enough for levels */
      if (p.s.ops->iterations) {
        double *f = malloc(p.bar.n * sizeof *f);
        set(&p, 1, 1e-2, 1e-4);
        assert_ok(factor(&p));
        error(&p);
        long iterations = p.s.ops->iterations(p.s.solver);
        assert_true(iterations > last && iterations < p.bar.n);
        last = iterations;
        memcpy(f, p.b, p.bar.n * sizeof *f); /* residual: b - S y */
        memcpy(p.x, p.y, p.bar.n * sizeof *f);
        set(&p, 1, 1e-2, 1e-4);
        double residual = 0, size = 0;
        for (int j = 0; j < p.bar.n; j++) residual += (f[j] - p.b[j]) * (f[j] - p.b[j]);
        for (int j = 0; j < p.bar.n; j++) size += f[j] * f[j];
        assert_below(sqrt(residual / size), 1.01 * tolerance[i]);
        assert_above(sqrt(residual / size), 1e-3 * tolerance[i]);
        free(f);
        memset(p.b, 0, p.bar.n * sizeof *p.b);
        memset(p.x, 0, p.bar.n * sizeof *p.x);
        assert_true(error(&p) == 0);
      }
      problem_destroy(&p);
    }
  }
}

/* --- choices --- */

/* The lower triangle of a box's matrix. */
static corot_csc *box_matrix(int nx, int ny, int nz) {
  corot_box box = {.size = {0.1 * nx, 0.1 * ny, 0.1 * nz}, .cells = {nx, ny, nz}};
  corot_mesh *mesh;
  corot_csc *csc;
  assert_ok(corot_mesh_box(&box, &mesh));
  corot_fix fix = {"zmin", {true, true, true}};
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = &soft, def.nfix = 1, def.fix = &fix;
  body b = make_body(mesh, def);
  assert_ok(corot_csc_create(b.model, COROT_LOWER, &csc));
  drop_body(&b);
  return csc;
}

static const char *choice_of(const corot_linear_def *def, const corot_csc *csc) {
  linsol_plan plan = {0};
  assert_ok(corot_linsol_choose(def, csc, &plan));
  assert_non_null(plan.ops->create);
  assert_int_equal(strncmp(plan.name, plan.ops->name, strlen(plan.ops->name)), 0);
  assert_true((plan.order != NULL) || plan.ops->iterations);
  corot_linsol_plan_clear(&plan);
  return plan.name;
}

static bool built(const char *solver) {
  corot_linear_def def = corot_linear_defaults();
  def.solver = solver;
  corot_csc *csc = box_matrix(1, 1, 1);
  linsol_plan plan = {0};
  bool answer = corot_linsol_choose(&def, csc, &plan) == COROT_OK;
  corot_linsol_plan_clear(&plan), corot_csc_destroy(csc);
  return answer;
}

/* Slender bodies have little fill and many iterations, compact ones the opposite. */
static void auto_goes_by_shape_size_and_role(void **state) {
  (void)state;
  static const struct {
    int cells[3];
    corot_role role;
    const char *with, *without; /* cholmod; how the name begins */
  } cases[] = {
      {{1, 1, 8}, COROT_ROLE_DYNAMIC, "cholmod simplicial", "klu"},
      {{1, 1, 300}, COROT_ROLE_DYNAMIC, "cholmod simplicial", "klu"},
      {{4, 4, 4}, COROT_ROLE_DYNAMIC, "cholmod simplicial", "klu"},
      {{3, 3, 30}, COROT_ROLE_DYNAMIC, "cholmod simplicial", "klu"},
      {{7, 7, 7}, COROT_ROLE_DYNAMIC, "cholmod supernodal", "klu"},
      {{6, 6, 36}, COROT_ROLE_DYNAMIC, "cholmod supernodal", "klu"},
      {{14, 14, 14}, COROT_ROLE_DYNAMIC, "cholmod supernodal", "pcg"},
      {{1, 1, 8}, COROT_ROLE_STATIC, "cholmod simplicial", "klu"},
      {{3, 3, 30}, COROT_ROLE_STATIC, "cholmod simplicial", "klu"},
      {{8, 8, 8}, COROT_ROLE_STATIC, "pcg, incomplete-cholesky", "pcg, incomplete-cholesky"},
      {{20, 20, 20}, COROT_ROLE_STATIC, "pcg, amg", "pcg, amg"},
      {{6, 6, 36}, COROT_ROLE_STATIC, "pcg, amg", "pcg, amg"},
  };
  bool cholmod = built("cholmod");
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    const int *cells = cases[k].cells;
    corot_csc *csc = box_matrix(cells[0], cells[1], cells[2]);
    corot_linear_def def = corot_linear_defaults();
    def.role = cases[k].role;
    const char *name = choice_of(&def, csc);
    const char *expected = cholmod ? cases[k].with : cases[k].without;
    if (strncmp(name, expected, strlen(expected)) != 0)
      fail_msg("%d x %d x %d: %s, expected %s", cells[0], cells[1], cells[2], name, expected);
    corot_csc_destroy(csc);
  }
}

/* A machine on which iterations are dear takes factors, and the other way about. */
static void auto_goes_by_what_things_cost(void **state) {
  (void)state;
  corot_csc *csc = box_matrix(8, 8, 8);
  corot_linear_def def = corot_linear_defaults();
  corot_linear_costs costs = corot_linear_costs_usual();
  def.role = COROT_ROLE_STATIC, def.costs = &costs;
  costs.iterated *= 100, costs.cycled *= 100;
  assert_int_equal(strncmp(choice_of(&def, csc), corot_linsol_direct, strlen(corot_linsol_direct)),
                   0);
  costs.made *= 10000, costs.operation *= 10000;
  assert_string_equal(choice_of(&def, csc), "pcg, incomplete-cholesky");
  costs.iterated *= 10;
  assert_string_equal(choice_of(&def, csc), "pcg, amg");
  corot_csc_destroy(csc);
}

/* Found on small cubes here. On any machine a hundred entries cost more than a nanosecond, and amg,
   which smooths on top of a product, more than that product. */
static void costs_are_measured(void **state) {
  (void)state;
  static const int cells[] = {7, 10};
  corot_linear_costs c;
  assert_ok(corot_linear_costs_measure_on(cells, &c));
  assert_true(c.operation >= 0 && c.made >= 0 && c.operation + c.made > 0);
  const double measured[] = {c.solved, c.incomplete, c.iterated, c.aggregated, c.cycled};
  for (size_t k = 0; k < sizeof measured / sizeof *measured; k++)
    assert_true(measured[k] > 0.01 && isfinite(measured[k]));
  assert_true(c.cycled > c.iterated);
  assert_fails(corot_linear_costs_measure(NULL), COROT_EINVAL, "costs");
}

/* What is named is taken, and what is left open beside it is chosen. */
static void names_are_obeyed(void **state) {
  (void)state;
  corot_csc *csc = box_matrix(8, 8, 8);
  corot_linear_def def = corot_linear_defaults();
  def.solver = "klu", def.ordering = "amd";
  assert_string_equal(choice_of(&def, csc), "klu, amd");
  def.solver = "pcg";
  assert_string_equal(choice_of(&def, csc), "pcg, incomplete-cholesky");
  def.role = COROT_ROLE_STATIC;
  assert_string_equal(choice_of(&def, csc), "pcg, incomplete-cholesky");
  def.preconditioner = "block-jacobi";
  assert_string_equal(choice_of(&def, csc), "pcg, block-jacobi");
  if (built("cholmod")) {
    def.solver = "cholmod";
    assert_string_equal(choice_of(&def, csc), "cholmod supernodal, amd");
    def.factor = "simplicial";
    assert_string_equal(choice_of(&def, csc), "cholmod simplicial, amd");
  }
  corot_csc_destroy(csc);
}

static void other_names_are_refused(void **state) {
  (void)state;
  static const struct {
    corot_linear_def def;
    const char *words;
  } cases[] = {
      {{"umfpack", "auto", "auto", "auto", 1, 0, NULL, NULL},
       "no linear solver 'umfpack': auto, klu, cholmod or pcg"},
      {{NULL, "auto", "auto", "auto", 1, 0, NULL, NULL}, "no linear solver ''"},
      {{"klu", "colamd", "auto", "auto", 1, 0, NULL, NULL},
       "no ordering 'colamd': auto, amd or metis"},
      {{"klu", "auto", "ldl", "auto", 1, 0, NULL, NULL},
       "no factor 'ldl': auto, simplicial or supernodal"},
      {{"pcg", "auto", "auto", "ilu", 1, 0, NULL, NULL},
       "no preconditioner 'ilu': auto, block-jacobi, incomplete-cholesky, amg, hierarchical or "
       "multigrid"},
      {{"pcg", "auto", "auto", "auto", 0, 0, NULL, NULL}, "tolerance = 0 is not positive"},
      {{"auto", "auto", "auto", "auto", NAN, 0, NULL, NULL}, "is not positive"},
  };
  corot_csc *csc = box_matrix(1, 1, 1);
  linsol_plan plan = {0};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
    assert_fails(corot_linsol_choose(&cases[k].def, csc, &plan), COROT_EINVAL, cases[k].words);
  assert_null(plan.ops);
  corot_csc_destroy(csc);
}

static void orderings_keep_the_unknowns_of_a_node_together(void **state) {
  (void)state;
  corot_csc *csc = box_matrix(3, 2, 5);
  for (int k = 0; k < 2; k++) {
    corot_linear_def def = corot_linear_defaults();
    linsol_plan plan;
    def.solver = "klu", def.ordering = k ? "metis" : "amd";
    if (corot_linsol_choose(&def, csc, &plan) != COROT_OK) continue;
    bool *seen = calloc(csc->n, sizeof *seen);
    for (int i = 0; i < csc->n; i++) {
      int j = plan.order[i];
      assert_true(j >= 0 && j < csc->n && !seen[j]);
      seen[j] = true;
      if (i % 3) assert_int_equal(j, plan.order[i - 1] + 1); /* no node is partly held */
    }
    free(seen);
    corot_linsol_plan_clear(&plan);
  }
  corot_csc_destroy(csc);
}

static volatile sig_atomic_t terms;
static void count_term(int number) { terms += number == SIGTERM; }

/* A signal of the host's reaches the host at any moment of an order (some libraries of graphs take
   SIGTERM for themselves), the order is that of a call in peace, and what the host had installed
   stays as it was. */
static void an_order_leaves_signals_to_the_host(void **state) {
  (void)state;
  struct sigaction mine = {.sa_handler = count_term, .sa_flags = SA_RESTART}, before, after;
  struct sigevent event = {.sigev_notify = SIGEV_SIGNAL, .sigev_signo = SIGTERM};
  timer_t timer;
  corot_csc *csc = box_matrix(12, 12, 12);
  corot_linear_def def = {"klu", "metis", "auto", "auto", 1e-13, COROT_ROLE_DYNAMIC, NULL, NULL};
  linsol_plan peace, plan;
  if (corot_linsol_choose(&def, csc, &peace) != COROT_OK) {
    corot_csc_destroy(csc);
    skip();
  }
  sigaction(SIGTERM, &mine, &before);
  assert_int_equal(timer_create(CLOCK_MONOTONIC, &event, &timer), 0);
  for (int us = 500, n = 1; us < 40000; us = us * 5 / 4, n++) {
    struct itimerspec once = {.it_value = {.tv_nsec = us * 1000L}};
    timer_settime(timer, 0, &once, NULL);
    assert_ok(corot_linsol_choose(&def, csc, &plan));
    for (int k = 0; k < 10000 && terms < n; k++)
      nanosleep(&(struct timespec){.tv_nsec = 100000}, NULL);
    assert_int_equal(terms, n);
    assert_memory_equal(plan.order, peace.order, csc->n * sizeof *plan.order);
    corot_linsol_plan_clear(&plan);
    sigaction(SIGTERM, NULL, &after);
    assert_true(after.sa_handler == count_term && after.sa_flags & SA_RESTART);
    assert_false(after.sa_flags & SA_RESETHAND);
  }
  timer_delete(timer);
  sigaction(SIGTERM, &before, NULL);
  corot_linsol_plan_clear(&peace);
  corot_csc_destroy(csc);
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

/* Order, analysis, a factor, another one, a solution. */
static corot_status make(const corot_linear_def *def, const corot_csc *lower, problem *p) {
  bool fresh;
  linsol_plan plan = {0};
  void *solver = NULL;
  corot_status status = corot_linsol_choose(def, lower, &plan);
  if (!status) status = plan.ops->create(p->s.csc, &plan, &solver);
  for (int k = 0; k < 2 && !status; k++) status = plan.ops->factor(solver, p->s.value, &fresh);
  memcpy(p->y, p->b, p->bar.n * sizeof *p->y);
  if (!status) status = plan.ops->solve(solver, p->y);
  if (solver) plan.ops->destroy(solver);
  corot_linsol_plan_clear(&plan);
  return status;
}

static void failed_allocations_are_reported(void **state) {
  (void)state;
  const suitesparse_memory saved = suitesparse_memory_get();
  const suitesparse_memory failing = {failing_malloc, failing_calloc, failing_realloc,
                                      counting_free};
  for (int large = 0; large < (order_of_test() == 1 ? 2 : 1); large++)
    for (int s = 0; s < NSOLVER; s++) {
      problem p;
      if (strcmp(table[s].solver, "pcg") == 0) continue; /* its memory is not SuiteSparse's */
      if (!problem_create(&table[s], large ? 4 : 1, large ? 16 : 3, &p)) continue;
      corot_csc *lower;
      assert_ok(corot_csc_create(p.bar.model, COROT_LOWER, &lower));
      set(&p, 1, 1e-2, 1e-4);
      suitesparse_memory_set(failing);
      for (long k = 1;; k++) {
        memory.count = memory.live = 0, memory.fail_at = k;
        corot_status status = make(&table[s], lower, &p);
        assert_int_equal(memory.live, 0);
        if (status) {
          assert_int_equal(status, COROT_ENOMEM);
          if (!strstr(corot_error(), "memory")) fail_msg("%s: %s", p.s.name, corot_error());
          continue; /* or the solver could do without it, as where a shorter block will do */
        }
        assert_below(difference_of(p.bar.n, p.y, p.x), 1e-12 * worse());
        if (memory.count < k) break;
      }
      assert_true(memory.count > 10);
      suitesparse_memory_set(saved);
      corot_csc_destroy(lower);
      problem_destroy(&p);
    }
}

/* What a plan comes to on a bar of that many cells, with so much memory in the machine and for the
   process. */
static corot_status plan_within(int across, int along, double machine, double process,
                                const char *solver, linsol_plan *plan) {
  bar_def def = example2;
  def.cells[0] = def.cells[1] = across, def.cells[2] = along;
  bar b = bar_create(&def);
  corot_csc *csc;
  corot_linear_def linear = corot_linear_defaults();
  const corot_memory_limit limits = {machine, process, "the test"};
  linear.solver = solver, linear.factor = "simplicial";
  assert_ok(corot_csc_create(b.model, COROT_LOWER, &csc));
  corot_status status = corot_linsol_choose_within(&limits, &linear, csc, plan);
  corot_csc_destroy(csc);
  bar_destroy(&b);
  return status;
}

/* By the count of its entries, before it is made: 16 bytes each by columns, of some 100 000. */
static void a_factor_beyond_the_memory_is_refused_or_spared(void **state) {
  (void)state;
  linsol_plan plan = {0};
  assert_ok(plan_within(3, 12, 1e12, 1e12, "auto", &plan));
  assert_string_equal(plan.ops->name, corot_linsol_direct);
  assert_true(plan.by_cost);
  corot_linsol_plan_clear(&plan);
  /* chosen: within a third of the machine's memory, and within that of the process */
  const double machine[] = {3e6, 1e12}, process[] = {1e12, 1e6};
  for (int k = 0; k < 2; k++) {
    assert_ok(plan_within(3, 12, machine[k], process[k], "auto", &plan));
    assert_string_equal(plan.ops->name, "pcg");
    assert_true(plan.by_cost == (k == 0)); /* whether a direct solver may take its place: */
    assert_true(plan.most_iterations == 0 && plan.rival.factor == 0); /* never by its cost */
    corot_linsol_plan_clear(&plan);
  }
  /* asked for by name: within that of the process */
  assert_fails(plan_within(3, 12, 1e12, 1e6, corot_linsol_direct, &plan), COROT_ENOMEM,
               "and the test has 0.001; pcg, which makes none, needs");
  assert_non_null(strstr(corot_error(), corot_linsol_direct));
  assert_ok(plan_within(3, 12, 1e6, 1e12, corot_linsol_direct, &plan));
  corot_linsol_plan_clear(&plan);
  assert_ok(plan_within(3, 12, 1e6, 1e6, "pcg", &plan));
  corot_linsol_plan_clear(&plan);
}

/* Of a cube metis makes a smaller factor, but not one so much smaller. */
static void metis_is_not_asked_for_a_factor_that_nothing_makes_fit(void **state) {
  (void)state;
  linsol_plan plan = {0};
  assert_ok(plan_within(10, 10, 1e12, 1e12, "auto", &plan));
  if (built("cholmod")) assert_string_equal(plan.def.ordering, "metis");
  corot_linsol_plan_clear(&plan);
  assert_ok(plan_within(10, 10, 1e12, 1e6, "auto", &plan));
  assert_string_equal(plan.ops->name, "pcg");
  assert_string_equal(plan.def.ordering, "amd");
  corot_linsol_plan_clear(&plan);
}

static void the_machine_says_how_much_memory_there_is(void **state) {
  (void)state;
  corot_memory_limit m = corot_memory_limits();
  assert_true(m.machine > 1e6 && m.process > 1e6 && m.process <= m.machine);
  assert_non_null(m.what);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(solve_to_rounding),
      cmocka_unit_test(factors_with_old_and_new_pivots_agree),
      cmocka_unit_test(klu_chooses_new_pivots_where_the_old_ones_fail),
      cmocka_unit_test(a_singular_matrix_is_refused),
      cmocka_unit_test(a_vanishing_pivot_is_named),
      cmocka_unit_test(a_matrix_singular_to_rounding_is_refused),
      cmocka_unit_test(an_indefinite_matrix_is_for_klu_only),
      cmocka_unit_test(there_is_no_solution_without_a_factor),
      cmocka_unit_test(pcg_iterates_to_its_tolerance),
      cmocka_unit_test(auto_goes_by_shape_size_and_role),
      cmocka_unit_test(a_factor_beyond_the_memory_is_refused_or_spared),
      cmocka_unit_test(metis_is_not_asked_for_a_factor_that_nothing_makes_fit),
      cmocka_unit_test(the_machine_says_how_much_memory_there_is),
      cmocka_unit_test(auto_goes_by_what_things_cost),
      cmocka_unit_test(costs_are_measured),
      cmocka_unit_test(names_are_obeyed),
      cmocka_unit_test(other_names_are_refused),
      cmocka_unit_test(orderings_keep_the_unknowns_of_a_node_together),
      cmocka_unit_test(an_order_leaves_signals_to_the_host),
      cmocka_unit_test(failed_allocations_are_reported),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
