/* Conjugate gradients on meshes of order 2, which are one more level: of a mesh that is refined and
   then raised, and of one that is of order 2 from the beginning. */
#include "check.h"
#include "order_2.h"
#include "solid.h"
#include "solve/pencil/pencil.h"
#include "solver.h"

typedef struct family {
  corot_refinement *r;
  body b;
} family;

static const char *const preconditioners[] = {"hierarchical", "multigrid"};

/* Held at the base, and in one component on the side. */
static family make_body_of(corot_mesh *mesh, corot_refinement *r) {
  const corot_fix fix[] = {{"zmin", {true, true, true}}, {"xmax", {true, false, false}}};
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = &soft, def.nfix = 2, def.fix = fix;
  return (family){r, make_body(mesh, def)};
}

static corot_mesh *make_box(void) {
  const corot_box box = {.size = {1, 1, 2}, .cells = {1, 1, 2}};
  corot_mesh *m = NULL;
  assert_ok(corot_mesh_box(&box, &m));
  return m;
}

/* The box refined nlevel times, then raised. */
static family make_raised(int nlevel) {
  corot_mesh *box = make_box(), *fine, *mesh;
  corot_refinement *r;
  assert_ok(corot_mesh_refine(box, nlevel, COROT_DIAGONAL_CONSISTENT, &fine, &r));
  mesh = with_order(fine, 2);
  assert_ok(corot_refinement_raise(r, mesh));
  corot_mesh_destroy(box), corot_mesh_destroy(fine);
  return make_body_of(mesh, r);
}

/* The box raised, bent, then refined. */
static family make_curved(int nlevel) {
  const double c[3] = {0.1, 0.2, 0.05};
  corot_mesh *box = make_box(), *raised = with_order(box, 2), *mesh;
  corot_refinement *r;
  bend(raised, c);
  assert_ok(corot_mesh_refine(raised, nlevel, COROT_DIAGONAL_CONSISTENT, &mesh, &r));
  corot_mesh_destroy(box), corot_mesh_destroy(raised);
  return make_body_of(mesh, r);
}

static void drop_family(family *f) {
  drop_body(&f->b);
  corot_refinement_destroy(f->r);
}

/* The value is the number of iterations; x [n] solves (a M + b D + c K) x = rhs. */
static long solve(const family *f, const char *name, const double abc[3], double *x) {
  corot_linear_def def = corot_linear_defaults();
  def.solver = "klu";
  if (strcmp(name, "klu") != 0)
    def.solver = "pcg", def.preconditioner = name, def.tolerance = 1e-12, def.refinement = f->r;
  corot_pencil *p;
  int n = f->b.n;
  double *u = malloc(2 * (size_t)n * sizeof *u);
  uint64_t seed = 5;
  assert_non_null(u);
  for (int i = 0; i < 2 * n; i++) u[i] = 1e-3 * noise(&seed);
  assert_ok(corot_pencil_create(f->b.model, f->b.state, &def, &p));
  assert_ok(corot_pencil_assemble(p, 0, u, u + n));
  corot_pencil_combine(p, abc[0], abc[1], abc[2]);
  for (int i = 0; i < n; i++) u[i] = 1 + i % 3;
  assert_ok(corot_pencil_factor(p));
  assert_ok(corot_pencil_solve(p, u, x));
  corot_pencil_counts counts = corot_pencil_statistics(p);
  assert_int_equal(counts.nindefinite, 0);
  free(u), corot_pencil_destroy(p);
  return counts.niteration;
}

static const double steps[][3] = {{1, 1e-2, 1e-4}, {0, 0, 1}};

static void compare_with_klu(family f) {
  int n = f.b.n;
  double *x = malloc(2 * (size_t)n * sizeof *x), *y = x + n;
  assert_non_null(x);
  for (int s = 0; s < 2; s++) {
    solve(&f, "klu", steps[s], x);
    for (int k = 0; k < 2; k++) {
      solve(&f, preconditioners[k], steps[s], y);
      /* the condition number is some 1e4, the tolerance 1e-12 */
      for (int i = 0; i < n; i++) assert_close(y[i], x[i], 0, 1e-8 * norm_max(n, x));
    }
  }
  free(x), drop_family(&f);
}

static void they_solve_like_klu(void **state) {
  (void)state;
  for (int nlevel = 0; nlevel <= 1; nlevel++) compare_with_klu(make_raised(nlevel));
  compare_with_klu(make_curved(1));
}

/* As of linear tets: iterations after a V-cycle tend to a constant, after incomplete Cholesky they
   grow by the root of the condition number, twice a level. */
static void v_cycles_hardly_grow_from_level_to_level(void **state) {
  (void)state;
  long cycle[2], cholesky[2];
  for (int k = 0; k < 2; k++) {
    family f = make_raised(k + 1);
    double *x = malloc((size_t)f.b.n * sizeof *x);
    assert_non_null(x);
    cycle[k] = solve(&f, "multigrid", steps[1], x);
    cholesky[k] = solve(&f, "incomplete-cholesky", steps[1], x);
    free(x), drop_family(&f);
  }
  assert_below(cycle[1], 1.4 * cycle[0]);
  assert_above(cholesky[1], 1.6 * cholesky[0]);
  assert_below(2 * cycle[1], cholesky[1]);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(they_solve_like_klu),
      cmocka_unit_test(v_cycles_hardly_grow_from_level_to_level),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
