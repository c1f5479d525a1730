/* Conjugate gradients on meshes of order 2, which are one more level: of a mesh that is refined and
   then raised, and of one that is of order 2 from the beginning, whose corners are a level below,
   however its nodes are numbered. */
#include "alloc.h"
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

/* A copy of a mesh without its groups, node i being number i * step modulo their count. */
static corot_mesh *shuffled(const corot_mesh *m, int step) {
  int n = m->nnode, (*tet)[10] = malloc((size_t)m->ntet * sizeof *tet);
  double(*x)[3] = malloc((size_t)n * sizeof *x);
  corot_mesh *out = NULL;
  assert_true(tet && x);
  for (int i = 0; i < n; i++) memcpy(x[i * step % n], m->x[i], sizeof *x);
  for (int e = 0; e < m->ntet; e++)
    for (int k = 0; k < 10; k++) tet[e][k] = (k < 4 ? m->tet[e][k] : m->mid[e][k - 4]) * step % n;
  assert_ok(
      corot_mesh_create_order_2(n, (const double(*)[3])x, m->ntet, (const int(*)[10])tet, &out));
  free(tet), free(x);
  return out;
}

/* The box raised, as a file might have it: corners and nodes on edges mixed, of 45. */
static corot_mesh *make_mixed(void) {
  corot_mesh *box = make_box(), *raised = with_order(box, 2), *m = shuffled(raised, 7);
  assert_int_equal(m->nnode, 45);
  assert_ok(corot_mesh_group_plane(m, "zmin", 2, 0, 0));
  assert_ok(corot_mesh_group_plane(m, "xmax", 0, 1, 0));
  corot_mesh_destroy(box), corot_mesh_destroy(raised);
  return m;
}

/* That refined, with its corners a level below. */
static family make_lowered(int nlevel) {
  corot_mesh *coarse = make_mixed(), *mesh;
  corot_refinement *r;
  assert_ok(corot_mesh_refine(coarse, nlevel, COROT_DIAGONAL_CONSISTENT, &mesh, &r));
  assert_ok(corot_refinement_lower(r, coarse));
  assert_int_equal(r->nlevel, nlevel + 1);
  corot_mesh_destroy(coarse);
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
  for (int nlevel = 0; nlevel <= 1; nlevel++) compare_with_klu(make_lowered(nlevel));
}

/* Of a mesh with straight edges each node is in the middle of its parents, which are of coarser
   levels; every node is there once. */
static void nodes_are_in_the_middle_of_their_parents(void **state) {
  (void)state;
  for (int nlevel = 0; nlevel <= 2; nlevel++) {
    family f = make_lowered(nlevel);
    const corot_refinement *r = f.r;
    const double(*x)[3] = (const double(*)[3])f.b.mesh->x;
    int n = r->nnode[r->nlevel], *seen = calloc((size_t)n, sizeof *seen);
    assert_int_equal(n, f.b.mesh->nnode);
    assert_int_equal(r->nnode[0], 12);
    for (int i = 0; i < n; i++) seen[r->node[i]]++;
    for (int i = 0; i < n; i++) assert_int_equal(seen[i], 1);
    for (int l = 1; l <= r->nlevel; l++)
      for (int i = r->nnode[l - 1]; i < r->nnode[l]; i++) {
        const int *p = r->parent[i - r->nnode[0]];
        assert_true(0 <= p[0] && p[0] < p[1] && p[1] < r->nnode[l - 1]);
        for (int c = 0; c < 3; c++)
          assert_close(x[r->node[i]][c], (x[r->node[p[0]]][c] + x[r->node[p[1]]][c]) / 2, 0, 1e-15);
      }
    free(seen), drop_family(&f);
  }
}

/* Nodes that stand as raising puts them give the levels that raising gives. */
static void raised_meshes_are_lowered_to_what_they_were(void **state) {
  (void)state;
  family f = make_raised(0);
  corot_refinement *r;
  corot_mesh *copy;
  assert_ok(corot_mesh_refine(f.b.mesh, 0, COROT_DIAGONAL_CONSISTENT, &copy, &r));
  assert_ok(corot_refinement_lower(r, copy));
  assert_int_equal(r->nlevel, f.r->nlevel);
  assert_same_ints(2, r->nnode, f.r->nnode);
  assert_same_ints(2, r->ntet, f.r->ntet);
  assert_same_ints(2 * (r->nnode[1] - r->nnode[0]), r->parent, f.r->parent);
  for (int i = 0; i < r->nnode[1]; i++) assert_int_equal(r->node[i], i);
  corot_refinement_destroy(r), corot_mesh_destroy(copy);
  drop_family(&f);
}

/* The order of Gauss & Seidel's sweeps is another, so that counts are not quite the same. */
static void the_order_of_the_nodes_hardly_matters(void **state) {
  (void)state;
  family raised = make_raised(0), lowered = make_lowered(0);
  double *x = malloc((size_t)raised.b.n * sizeof *x);
  assert_int_equal(raised.b.n, lowered.b.n);
  assert_non_null(x);
  for (int k = 0; k < 2; k++) {
    long expected = solve(&raised, preconditioners[k], steps[1], x);
    assert_close((double)solve(&lowered, preconditioners[k], steps[1], x), (double)expected, 0.2,
                 0);
  }
  free(x), drop_family(&raised), drop_family(&lowered);
}

static void what_has_no_corners_below_is_refused(void **state) {
  (void)state;
  family f = make_raised(0), g = make_lowered(0);
  corot_mesh *box = make_box();
  assert_fails(corot_refinement_lower(f.r, box), COROT_EINVAL,
               "a mesh of order 1 are not its level 0");
  assert_fails(corot_refinement_lower(f.r, f.b.mesh), COROT_EINVAL,
               "45 nodes of a mesh of order 2");
  assert_fails(corot_refinement_lower(g.r, g.b.mesh), COROT_EINVAL,
               "45 nodes of a mesh of order 2");
  corot_hierarchy_def h = corot_hierarchy_defaults();
  corot_model_def def = corot_model_defaults();
  corot_model *model;
  h.refinement = g.r;
  def.mesh = g.b.mesh, def.hierarchy = &h, def.nmaterial = 1, def.material = &soft;
  assert_fails(corot_model_create(&def, &model), COROT_EINVAL, "of the corners of ten-node tets");
  corot_mesh_destroy(box);
  drop_family(&f), drop_family(&g);
}

static corot_status lower_and_solve(void *context) {
  const family *f = context;
  corot_mesh *mesh = NULL;
  corot_refinement *r = NULL;
  corot_pencil *p = NULL;
  corot_linear_def def = corot_linear_defaults();
  def.solver = "pcg", def.preconditioner = "multigrid";
  corot_status status = corot_mesh_refine(f->b.mesh, 0, COROT_DIAGONAL_CONSISTENT, &mesh, &r);
  if (!status) status = corot_refinement_lower(r, mesh);
  def.refinement = r;
  if (!status) status = corot_pencil_create(f->b.model, f->b.state, &def, &p);
  corot_pencil_destroy(p);
  corot_refinement_destroy(r);
  corot_mesh_destroy(mesh);
  return status;
}

static void failed_allocations(void **state) {
  (void)state;
  family f = make_lowered(0);
  assert_true(assert_survives_failed_allocations(lower_and_solve, &f) > 40);
  drop_family(&f);
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
      cmocka_unit_test(nodes_are_in_the_middle_of_their_parents),
      cmocka_unit_test(raised_meshes_are_lowered_to_what_they_were),
      cmocka_unit_test(the_order_of_the_nodes_hardly_matters),
      cmocka_unit_test(what_has_no_corners_below_is_refused),
      cmocka_unit_test(failed_allocations),
      cmocka_unit_test(v_cycles_hardly_grow_from_level_to_level),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
