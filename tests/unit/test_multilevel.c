/* Conjugate gradients on a refined mesh: the matrices of its levels, and the preconditioners made
   of them. */
#include <corot/hierarchy.h>

#include "alloc.h"
#include "solid.h"
#include "solve/linsol/iterative/linsol_coarse.h"
#include "solve/linsol/iterative/linsol_multilevel.h"
#include "solve/pencil/pencil.h"
#include "solver.h"

/* A refined body with its matrix, in blocks. */
typedef struct family {
  corot_mesh *coarse;
  corot_refinement *r;
  body b;
  corot_pencil *pencil;
  node_matrix A;
} family;

typedef struct support {
  const char *name;
  int axis; /* nodes at `at` in it */
  double at;
  bool component[3];
} support;

/* Held where the body begins; in two components on a plane of level 1, so that some of its nodes
   have free parents; in one of them where no node is held else. */
static const support supports[] = {{"base", 2, 0, {true, true, true}},
                                   {"waist", 2, 1.5, {true, false, true}},
                                   {"side", 0, 1, {true, false, false}}};
enum { NSUPPORT = sizeof supports / sizeof *supports };

static const corot_box long_box = {.size = {1, 1, 2}, .cells = {1, 1, 2}};

static corot_pencil *pencil_of(const body *b, const corot_linear_def *def) {
  corot_pencil *p;
  double *u = malloc(2 * b->n * sizeof *u);
  uint64_t seed = 5;
  for (int i = 0; i < 2 * b->n; i++) u[i] = 1e-3 * noise(&seed);
  assert_ok(corot_pencil_create(b->model, b->state, def, &p));
  assert_ok(corot_pencil_assemble(p, 0, u, u + b->n));
  corot_pencil_combine(p, 1, 1e-2, 1e-4);
  free(u);
  return p;
}

static family make_family_with(int nlevel, int nsupport, corot_model_def def) {
  family f = {0};
  corot_mesh *mesh;
  corot_fix fix[NSUPPORT];
  assert_ok(corot_mesh_box(&long_box, &f.coarse));
  assert_ok(corot_mesh_refine(f.coarse, nlevel, COROT_DIAGONAL_CONSISTENT, &mesh, &f.r));
  for (int k = 0; k < nsupport; k++) {
    const support *s = &supports[k];
    assert_ok(corot_mesh_group_plane(mesh, s->name, s->axis, s->at, 0));
    fix[k] = (corot_fix){s->name, {s->component[0], s->component[1], s->component[2]}};
  }
  def.nmaterial = 1, def.material = &soft, def.nfix = nsupport, def.fix = fix;
  f.b = make_body(mesh, def);
  f.pencil = pencil_of(&f.b, SOLVER("pcg"));
  assert_ok(corot_nodes_create(f.pencil->csc, false, &f.A));
  corot_nodes_keep(&f.A);
  corot_nodes_load(&f.A, f.pencil->csc, f.pencil->S);
  return f;
}

static family make_family(int nlevel, int nsupport) {
  return make_family_with(nlevel, nsupport, corot_model_defaults());
}

static void drop_family(family *f) {
  corot_nodes_clear(&f->A);
  corot_pencil_destroy(f->pencil);
  drop_body(&f->b);
  corot_refinement_destroy(f->r);
  corot_mesh_destroy(f->coarse);
}

static corot_linear_def pcg_on(const family *f, const char *preconditioner) {
  corot_linear_def def = corot_linear_defaults();
  def.solver = "pcg", def.preconditioner = preconditioner, def.tolerance = 1e-12;
  def.refinement = f->r;
  return def;
}

/* --- the matrices of the levels --- */

static double entry(const galerkin_level *level, int i, int j) {
  int row = i / 3, column = j / 3;
  if (row < column) return entry(level, j, i);
  int block = corot_galerkin_find(level, row, column);
  bool there = row == column;
  for (int k = level->colptr[column]; k < level->colptr[column + 1]; k++)
    there |= level->row[k] == row;
  return there ? level->value[9 * block + 3 * (j % 3) + i % 3] : 0;
}

/* The field on the finest level of a value 1 at one component of level l, by way of the nodes of
   the mesh: held ones stay zero. */
static void interpolate(const family *f, int l, int component, double *x) {
  int nnode = f->b.mesh->nnode;
  const int(*dof)[3] = corot_model_dof(f->b.model);
  double(*v)[3] = calloc(nnode, sizeof *v);
  memset(x, 0, 3 * f->A.n * sizeof *x);
  for (int i = 0; i < nnode; i++)
    for (int c = 0; c < 3; c++) {
      if (dof[i][c] < 0) continue;
      int slot = f->A.slot[dof[i][c]];
      if (i < f->r->nnode[l]) {
        v[i][c] = slot == component;
      } else {
        const int *p = f->r->parent[i - f->r->nnode[0]];
        v[i][c] = (v[p[0]][c] + v[p[1]][c]) / 2;
      }
      x[slot] = v[i][c];
    }
  free(v);
}

static void levels_have_the_matrices_of_their_interpolants(void **state) {
  (void)state;
  for (int nsupport = 0; nsupport <= NSUPPORT; nsupport++) {
    family f = make_family(2, nsupport);
    galerkin g;
    assert_ok(corot_galerkin_create(f.pencil->csc, &f.A, f.r, &g));
    corot_galerkin_load(&g);
    corot_galerkin_load(&g); /* and nothing is left from the first time */
    int n = 3 * f.A.n;
    double *x = malloc(3 * n * sizeof *x), *y = x + n, *Ax = y + n, largest = 0;
    for (int l = 0; l < 2; l++)
      for (int j = 0; j < 3 * g.level[l].n; j += l ? 7 : 1) {
        interpolate(&f, l, j, x);
        corot_nodes_multiply(&f.A, x, Ax);
        for (int i = 0; i < 3 * g.level[l].n; i += l ? 5 : 1) {
          interpolate(&f, l, i, y);
          double expected = inner(n, y, Ax);
          largest = fmax(largest, fabs(expected));
          assert_close(entry(&g.level[l], i, j), expected, 0, 1e-13 * largest);
        }
      }
    assert_above(largest, 0);
    free(x), corot_galerkin_clear(&g), drop_family(&f);
  }
}

/* Those of the stiffness of a coarse mesh: its edges. */
static void coarse_matrices_are_as_sparse_as_their_meshes(void **state) {
  (void)state;
  family f = make_family(2, 0);
  galerkin g;
  assert_ok(corot_galerkin_create(f.pencil->csc, &f.A, f.r, &g));
  assert_int_equal(g.level[0].n, f.coarse->nnode);
  assert_int_equal(g.level[0].colptr[g.level[0].n], f.r->nnode[1] - f.r->nnode[0]);
  assert_int_equal(g.level[1].colptr[g.level[1].n], f.r->nnode[2] - f.r->nnode[1]);
  corot_galerkin_clear(&g), drop_family(&f);
}

/* --- the preconditioners --- */

static const multilevel_ops *const preconditioners[] = {&corot_hierarchical_basis,
                                                        &corot_multigrid};
enum { NPRECONDITIONER = 2, FEW = 10 };

/* `most`: unknowns of level 0 that are factored, more being left to aggregates; 0: all there are.
 */
static linsol_plan plan_of(const family *f, int most) {
  return (linsol_plan){
      .def.refinement = f->r, .most_direct = most, .x = (const double(*)[3])f->b.mesh->x};
}

static void *factored(const family *f, const multilevel_ops *ops, int most) {
  void *made;
  linsol_plan plan = plan_of(f, most);
  assert_ptr_equal(corot_multilevel_find(ops->name), ops);
  assert_ok(ops->create(f->pencil->csc, &f->A, &plan, &made));
  assert_ok(ops->factor(made));
  return made;
}

static void check_symmetry(const family *f, const multilevel_ops *ops, int most) {
  void *M = factored(f, ops, most);
  int n = 3 * f->A.n;
  double *x = calloc(4 * n, sizeof *x), *y = x + n, *Mx = y + n, *My = Mx + n;
  uint64_t seed = 3;
  for (int k = 0; k < 10; k++) {
    for (int i = 0; i < f->b.n; i++) x[f->A.slot[i]] = noise(&seed), y[f->A.slot[i]] = noise(&seed);
    assert_ok(ops->apply(M, x, Mx));
    assert_ok(ops->apply(M, y, My));
    double scale = sqrt(inner(n, x, Mx) * inner(n, y, My));
    assert_true(inner(n, x, Mx) > 0 && inner(n, y, My) > 0);
    assert_close(inner(n, x, My), inner(n, y, Mx), 0, 1e-13 * scale);
    assert_ok(ops->apply(M, x, x)); /* in place */
    assert_memory_equal(x, Mx, n * sizeof *x);
  }
  double left = inner(n, Mx, Mx);
  for (int i = 0; i < f->b.n; i++) left -= pow(Mx[f->A.slot[i]], 2);
  assert_close(left, 0, 0, 1e-13 * inner(n, Mx, Mx)); /* held components stay zero */
  free(x), ops->destroy(M);
}

static void they_are_symmetric_and_positive(void **state) {
  (void)state;
  for (int nsupport = 0; nsupport <= NSUPPORT; nsupport++) {
    family f = make_family(2, nsupport);
    for (int k = 0; k < NPRECONDITIONER; k++)
      for (int most = 0; most <= FEW; most += FEW) check_symmetry(&f, preconditioners[k], most);
    drop_family(&f);
  }
}

/* M = T'^-1 D T^-1, by the public transformations; where nothing is held, they are ours. */
static void the_basis_is_inverted_as_its_definition_says(void **state) {
  (void)state;
  family f = make_family(2, 0);
  galerkin g;
  assert_ok(corot_galerkin_create(f.pencil->csc, &f.A, f.r, &g));
  corot_galerkin_load(&g);
  void *M = factored(&f, &corot_hierarchical_basis, 0);
  int nnode = f.A.n, n0 = f.r->nnode[0];
  double(*x)[3] = malloc(3 * nnode * sizeof *x), (*y)[3] = x + nnode, (*r)[3] = y + nnode;
  double *all = x[0], *values = y[0];
  uint64_t seed = 4;
  for (int i = 0; i < 3 * nnode; i++) all[i] = noise(&seed);
  memcpy(y, x, nnode * sizeof *x);
  corot_hierarchy_solve(f.r, y);
  memset(r, 0, nnode * sizeof *r);
  for (int i = 0, l = 0; i < nnode; i++) {
    while (i >= f.r->nnode[l]) l++;
    int first = l ? 3 * i : 0, last = l ? 3 * i + 3 : 3 * n0;
    for (int c = 0; c < 3; c++)
      for (int j = first; j < last; j++) r[i][c] += entry(&g.level[l], 3 * i + c, j) * values[j];
  }
  corot_hierarchy_solve_transposed(f.r, r);
  assert_ok(corot_hierarchical_basis.apply(M, r[0], values));
  for (int i = 0; i < 3 * nnode; i++) /* the condition number of T and D is some 1e3 */
    assert_close(values[i], all[i], 0, 1e-12);
  free(x), corot_hierarchical_basis.destroy(M), corot_galerkin_clear(&g), drop_family(&f);
}

/* Of x' A x, the part that is left after x has lost M^-1 A x: less than all of it, so that the
   V-cycles of aggregates stand for the factor of level 0. */
static double left_by(const family *f, const multilevel_ops *ops, int most) {
  void *M = factored(f, ops, most);
  node_matrix *A = (node_matrix *)&f->A;
  int n = 3 * A->n;
  double *x = calloc(3 * n, sizeof *x), *Ax = x + n, *y = Ax + n, left = 0;
  uint64_t seed = 3;
  for (int i = 0; i < f->b.n; i++) x[A->slot[i]] = noise(&seed);
  for (int k = 0; k < 30; k++) { /* what is left longest is left in the end */
    corot_nodes_multiply(A, x, Ax);
    double before = inner(n, x, Ax);
    assert_ok(ops->apply(M, Ax, y));
    for (int i = 0; i < n; i++) x[i] -= y[i];
    corot_nodes_multiply(A, x, Ax);
    left = inner(n, x, Ax) / before;
  }
  free(x), ops->destroy(M);
  return left;
}

static void aggregates_stand_for_a_factor_of_level_0(void **state) {
  (void)state;
  for (int nsupport = 0; nsupport <= NSUPPORT; nsupport++) {
    family f = make_family(2, nsupport);
    double direct = left_by(&f, &corot_multigrid, 0), cycle = left_by(&f, &corot_multigrid, FEW);
    assert_above(cycle, 0);
    assert_below(cycle, fmax(1.5 * direct, 0.5));
    drop_family(&f);
  }
}

static corot_status make_with_aggregates(void *context) {
  const family *f = context;
  linsol_plan plan = plan_of(f, FEW);
  void *made;
  COROT_TRY(corot_multigrid.create(f->pencil->csc, &f->A, &plan, &made));
  corot_multigrid.destroy(made);
  return COROT_OK;
}

static void aggregates_of_level_0_can_fail(void **state) {
  (void)state;
  family f = make_family(2, 1);
  assert_true(assert_survives_failed_allocations(make_with_aggregates, &f) > 40);
  void *M = factored(&f, &corot_multigrid, FEW);
  corot_pencil_combine(f.pencil, -200, 0, 1);
  corot_nodes_load(&f.A, f.pencil->csc, f.pencil->S);
  assert_fails(corot_multigrid.factor(M), COROT_RETRY, "pcg, level 0: ");
  corot_multigrid.destroy(M), drop_family(&f);
}

/* --- as part of a solver --- */

/* b -> x by KLU and by conjugate gradients, of a M + b D + c K. */
static long compare_with_klu(const family *f, const corot_linear_def *def, const double abc[3]) {
  corot_pencil *klu = pencil_of(&f->b, SOLVER("klu")), *pcg = pencil_of(&f->b, def);
  int n = f->b.n;
  double *b = malloc(3 * n * sizeof *b), *x = b + n, *y = x + n;
  uint64_t seed = 8;
  for (int i = 0; i < n; i++) b[i] = noise(&seed);
  corot_pencil_combine(klu, abc[0], abc[1], abc[2]);
  corot_pencil_combine(pcg, abc[0], abc[1], abc[2]);
  assert_ok(corot_pencil_factor(klu));
  assert_ok(corot_pencil_factor(pcg));
  assert_ok(corot_pencil_solve(klu, b, x));
  assert_ok(corot_pencil_solve(pcg, b, y));
  /* the condition number is 1e4 at the most, the tolerance 1e-12 */
  for (int i = 0; i < n; i++) assert_close(y[i], x[i], 0, 1e-8 * norm_max(n, x));
  corot_pencil_counts counts = corot_pencil_statistics(pcg);
  assert_int_equal(counts.nindefinite, 0);
  free(b), corot_pencil_destroy(klu), corot_pencil_destroy(pcg);
  return counts.niteration;
}

static void compare_both_with_klu(const family *f, const double abc[3]) {
  for (int k = 0; k < NPRECONDITIONER; k++) {
    corot_linear_def def = pcg_on(f, preconditioners[k]->name);
    compare_with_klu(f, &def, abc);
  }
}

static const double dynamic_step[] = {1, 1e-2, 1e-4}, stiffness[] = {0, 0, 1};

static void they_solve_like_klu(void **state) {
  (void)state;
  for (int nlevel = 1; nlevel <= 2; nlevel++)
    for (int nsupport = 0; nsupport <= NSUPPORT; nsupport++) {
      family f = make_family(nlevel, nsupport);
      compare_both_with_klu(&f, dynamic_step);
      if (nsupport > 0) compare_both_with_klu(&f, stiffness);
      drop_family(&f);
    }
}

static void without_levels_they_are_exact(void **state) {
  (void)state;
  for (int nsupport = 0; nsupport <= 1; nsupport++) {
    family f = make_family(0, nsupport);
    for (int k = 0; k < NPRECONDITIONER; k++) {
      corot_linear_def def = pcg_on(&f, preconditioners[k]->name);
      assert_int_equal(compare_with_klu(&f, &def, dynamic_step), 1);
    }
    drop_family(&f);
  }
}

static long iterations_of(const family *f, const char *preconditioner) {
  corot_linear_def def = pcg_on(f, preconditioner);
  corot_pencil *p = pencil_of(&f->b, &def);
  double *x = malloc(f->b.n * sizeof *x);
  for (int i = 0; i < f->b.n; i++) x[i] = 1 + i % 3;
  corot_pencil_combine(p, 0, 0, 1);
  assert_ok(corot_pencil_factor(p));
  assert_ok(corot_pencil_solve(p, x, x));
  long iterations = corot_pencil_statistics(p).niteration;
  free(x), corot_pencil_destroy(p);
  return iterations;
}

/* From level to level the condition number of the stiffness grows four times, after incomplete
   Cholesky as well; after a V-cycle it tends to a constant. Iterations grow by its root. */
static void iterations_of_v_cycles_hardly_grow_from_level_to_level(void **state) {
  (void)state;
  long cycle[2], cholesky[2];
  for (int k = 0; k < 2; k++) {
    family f = make_family(k + 2, 1);
    cycle[k] = iterations_of(&f, "multigrid");
    cholesky[k] = iterations_of(&f, "incomplete-cholesky");
    drop_family(&f);
  }
  assert_below(cycle[1], 1.4 * cycle[0]);
  assert_above(cholesky[1], 1.8 * cholesky[0]);
  assert_below(4 * cycle[1], cholesky[1]);
}

/* Averages couple nodes two tets apart, and a consistent mass all neighbours. */
static void wider_patterns_are_no_obstacle(void **state) {
  (void)state;
  corot_model_def model = corot_model_defaults();
  model.dilatation = COROT_DILATATION_NODAL;
  family f = make_family_with(1, 2, model);
  compare_both_with_klu(&f, stiffness);
  drop_family(&f);
  model = corot_model_defaults();
  model.mass = COROT_MASS_CONSISTENT;
  f = make_family_with(1, 2, model);
  compare_both_with_klu(&f, dynamic_step);
  drop_family(&f);
}

/* Of a model with a measure of its own on level 0, which couples the nodes of level 0. */
static void hierarchical_models_are_solved_as_well(void **state) {
  (void)state;
  corot_mesh *coarse, *mesh;
  corot_refinement *r;
  corot_hierarchy_def hierarchy = corot_hierarchy_defaults();
  assert_ok(corot_mesh_box(&long_box, &coarse));
  assert_ok(corot_mesh_refine(coarse, 1, COROT_DIAGONAL_CONSISTENT, &mesh, &r));
  corot_fix fix = {"zmin", {true, true, true}};
  corot_model_def model = corot_model_defaults();
  hierarchy.refinement = r, hierarchy.coarse_strain = "green";
  model.hierarchy = &hierarchy;
  model.nmaterial = 1, model.material = &soft, model.nfix = 1, model.fix = &fix;
  family f = {.coarse = coarse, .r = r, .b = make_body(mesh, model)};
  compare_both_with_klu(&f, stiffness);
  drop_body(&f.b);
  corot_refinement_destroy(r);
  corot_mesh_destroy(coarse);
}

/* Only the nodes of level 1 are free: there is no level 0 to be solved. */
static void a_wholly_held_level_0_is_left_out(void **state) {
  (void)state;
  corot_box box = {.size = {1, 1, 1}, .cells = {1, 1, 1}};
  family f = {0};
  corot_mesh *mesh;
  int corner[8] = {0, 1, 2, 3, 4, 5, 6, 7};
  assert_ok(corot_mesh_box(&box, &f.coarse));
  assert_ok(corot_mesh_refine(f.coarse, 1, COROT_DIAGONAL_CONSISTENT, &mesh, &f.r));
  assert_ok(corot_mesh_group_nodes(mesh, "corners", 8, corner));
  corot_fix fix = {"corners", {true, true, true}};
  corot_model_def model = corot_model_defaults();
  model.nmaterial = 1, model.material = &soft, model.nfix = 1, model.fix = &fix;
  f.b = make_body(mesh, model);
  compare_both_with_klu(&f, stiffness);
  drop_body(&f.b);
  corot_refinement_destroy(f.r);
  corot_mesh_destroy(f.coarse);
}

/* K - w^2 M, w above the lowest frequencies of level 0, then above all. */
static void check_indefinite(const family *f, const char *preconditioner) {
  corot_linear_def def = pcg_on(f, preconditioner);
  def.role = COROT_ROLE_STATIC;
  corot_pencil *p = pencil_of(&f->b, &def);
  corot_pencil_combine(p, -200, 0, 1);
  assert_fails(corot_pencil_factor(p), COROT_RETRY, "pcg, level 0: ");
  assert_non_null(strstr(corot_error(), "the matrix is not positive definite"));
  corot_pencil_combine(p, -1e9, 0, 1);
  assert_fails(corot_pencil_factor(p), COROT_RETRY, "pcg: the matrix is not positive definite");
  assert_int_equal(corot_pencil_statistics(p).nindefinite, 2);
  double *x = calloc(f->b.n, sizeof *x);
  x[0] = 1;
  assert_fails(corot_pencil_solve(p, x, x), COROT_EINVAL, "there is no factor");
  corot_pencil_combine(p, 1, 1e-2, 1e-4);
  assert_ok(corot_pencil_factor(p));
  assert_ok(corot_pencil_solve(p, x, x));
  free(x), corot_pencil_destroy(p);
}

static void an_indefinite_matrix_is_found_out(void **state) {
  (void)state;
  family f = make_family(2, 1);
  for (int k = 0; k < NPRECONDITIONER; k++) check_indefinite(&f, preconditioners[k]->name);
  drop_family(&f);
}

static void what_does_not_fit_is_refused(void **state) {
  (void)state;
  family f = make_family(1, 1), g = make_family(2, 1);
  corot_pencil *p;
  corot_linear_def def = pcg_on(&f, "hierarchical");
  def.refinement = NULL;
  assert_fails(corot_pencil_create(f.b.model, f.b.state, &def, &p), COROT_EINVAL,
               "preconditioner hierarchical: the mesh has no refinement");
  def.refinement = g.r;
  assert_fails(corot_pencil_create(f.b.model, f.b.state, &def, &p), COROT_EINVAL,
               "the refinement is of 225 nodes, the mesh has 45");
  def.refinement = f.r;
  int parent = f.r->parent[3][1];
  f.r->parent[3][1] = 20;
  assert_fails(corot_pencil_create(f.b.model, f.b.state, &def, &p), COROT_EINVAL,
               "node 15 of level 1 has the parents");
  f.r->parent[3][1] = parent;
  def.solver = "klu", def.refinement = NULL; /* where it is not asked for */
  assert_ok(corot_pencil_create(f.b.model, f.b.state, &def, &p));
  corot_pencil_destroy(p), drop_family(&f), drop_family(&g);
}

typedef struct making {
  const family *f;
  const char *preconditioner;
} making;

static corot_status make_solver(void *context) {
  const making *m = context;
  corot_linear_def def = pcg_on(m->f, m->preconditioner);
  linsol s;
  corot_status status = corot_linsol_create(m->f->b.model, &def, &s);
  corot_linsol_clear(&s);
  return status;
}

/* The refinement may go as soon as the solver is there. */
static void check_memory(family *f, const char *preconditioner) {
  making m = {f, preconditioner};
  corot_linear_def def = pcg_on(f, preconditioner);
  assert_true(assert_survives_failed_allocations(make_solver, &m) > 40);
  corot_pencil *p = pencil_of(&f->b, &def);
  double *x = calloc(f->b.n, sizeof *x);
  corot_refinement_destroy(f->r);
  f->r = NULL;
  alloc_fail_at(0);
  for (int k = 0; k < 3; k++) {
    x[k] = 1;
    corot_pencil_combine(p, 1, 1e-2, 1e-4);
    assert_ok(corot_pencil_factor(p));
    assert_ok(corot_pencil_solve(p, x, x));
  }
  assert_int_equal(alloc_count(), 0);
  free(x), corot_pencil_destroy(p);
}

static void memory_is_of_creation_only(void **state) {
  (void)state;
  for (int k = 0; k < NPRECONDITIONER; k++) {
    family f = make_family(2, NSUPPORT);
    check_memory(&f, preconditioners[k]->name);
    drop_family(&f);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(levels_have_the_matrices_of_their_interpolants),
      cmocka_unit_test(coarse_matrices_are_as_sparse_as_their_meshes),
      cmocka_unit_test(they_are_symmetric_and_positive),
      cmocka_unit_test(the_basis_is_inverted_as_its_definition_says),
      cmocka_unit_test(aggregates_stand_for_a_factor_of_level_0),
      cmocka_unit_test(aggregates_of_level_0_can_fail),
      cmocka_unit_test(they_solve_like_klu),
      cmocka_unit_test(without_levels_they_are_exact),
      cmocka_unit_test(iterations_of_v_cycles_hardly_grow_from_level_to_level),
      cmocka_unit_test(wider_patterns_are_no_obstacle),
      cmocka_unit_test(hierarchical_models_are_solved_as_well),
      cmocka_unit_test(a_wholly_held_level_0_is_left_out),
      cmocka_unit_test(an_indefinite_matrix_is_found_out),
      cmocka_unit_test(what_does_not_fit_is_refused),
      cmocka_unit_test(memory_is_of_creation_only),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
