/* Conjugate gradients with algebraic multigrid: aggregates, the prolongator, the coarse matrices,
   and the preconditioner made of them. */
#include "alloc.h"
#include "solid.h"
#include "solve/linsol/iterative/linsol_aggregate.h"
#include "solve/linsol/iterative/linsol_multilevel.h"
#include "solve/linsol/iterative/linsol_project.h"
#include "solve/pencil/pencil.h"
#include "solver.h"

static const double step[] = {1, 1e-1, 1e-2}, stiffness[] = {0, 0, 1};

/* --- bodies --- */

/* How a body is held: wholly where z is least, in two components at an edge of it, in one at its
   side; or not at all. */
typedef enum holding { FREE, CLAMPED, GUIDED, NHOLDING } holding;

static body make(corot_mesh *mesh, holding how) {
  static const corot_fix fix[] = {{"zmin", {true, true, true}}, {"xmin", {true, false, false}}};
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = &soft;
  def.nfix = how == FREE ? 0 : how == CLAMPED ? 1 : 2, def.fix = fix;
  return make_body(mesh, def);
}

static body make_box(int nx, int ny, int nz, holding how) {
  corot_box box = {.size = {0.1 * nx, 0.1 * ny, 0.1 * nz}, .cells = {nx, ny, nz}};
  return make(box_of_order(&box), how);
}

/* Of cells that make it as many nodes at either order, enough for two levels at the least. */
static body large_box(holding how) {
  return order_of_test() == 1 ? make_box(8, 6, 10, how) : make_box(4, 3, 5, how);
}

static corot_pencil *pencil_by(const body *b, const corot_linear_def *def, const double abc[3]) {
  corot_pencil *p;
  double *u = calloc(2 * b->n, sizeof *u);
  assert_ok(corot_pencil_create(b->model, b->state, def, &p));
  assert_ok(corot_pencil_assemble(p, 0, u, u + b->n));
  corot_pencil_combine(p, abc[0], abc[1], abc[2]);
  free(u);
  return p;
}

static corot_linear_def pcg_with(const char *preconditioner, double tolerance) {
  corot_linear_def def = *SOLVER_TO("pcg", tolerance);
  def.preconditioner = preconditioner;
  return def;
}

static corot_pencil *pencil_of(const body *b, const double abc[3]) {
  corot_linear_def def = pcg_with("amg", 1e-12);
  return pencil_by(b, &def, abc);
}

/* --- aggregates --- */

/* Every node with a neighbour is in one of them, and is a neighbour of one that is in it with all
   its neighbours, or of such a neighbour: they hang together. */
static void check_aggregates(const graph_rows *g) {
  int *aggregate = malloc(2 * (g->n + 1) * sizeof *aggregate), *size = aggregate + g->n + 1, count;
  assert_ok(corot_aggregate(g, aggregate, &count));
  memset(size, 0, (g->n + 1) * sizeof *size);
  for (int i = 0; i < g->n; i++) {
    bool lonely = g->rowptr[i] == g->rowptr[i + 1], with_another = false;
    assert_true(lonely ? aggregate[i] == -1 : aggregate[i] >= 0 && aggregate[i] < count);
    if (lonely) continue;
    size[aggregate[i]]++;
    for (int k = g->rowptr[i]; k < g->rowptr[i + 1]; k++)
      with_another |= aggregate[g->col[k]] == aggregate[i];
    assert_true(with_another);
  }
  for (int a = 0; a < count; a++) assert_true(size[a] > 0);
  int *first = malloc((count + 1) * sizeof *first), *node = malloc((g->n + 1) * sizeof *node);
  corot_aggregate_sort(g->n, aggregate, count, first, node);
  for (int a = 0; a < count; a++) {
    assert_int_equal(first[a + 1] - first[a], size[a]);
    for (int p = first[a]; p < first[a + 1]; p++) {
      assert_int_equal(aggregate[node[p]], a);
      assert_true(p == first[a] || node[p] > node[p - 1]);
    }
  }
  int *rowptr, *col;
  assert_ok(corot_aggregate_graph(g, aggregate, count, &rowptr, &col));
  char *joined = calloc((size_t)count * count + 1, 1); /* 1: by nodes, 2: by the graph */
  for (int i = 0; i < g->n; i++)
    for (int k = g->rowptr[i]; k < g->rowptr[i + 1]; k++)
      if (aggregate[i] != aggregate[g->col[k]])
        joined[aggregate[i] * count + aggregate[g->col[k]]] |= 1;
  for (int a = 0; a < count; a++)
    for (int k = rowptr[a]; k < rowptr[a + 1]; k++) {
      assert_true(k == rowptr[a] || col[k] > col[k - 1]);
      joined[a * count + col[k]] |= 2;
    }
  for (int k = 0; k < count * count; k++) assert_true(joined[k] == 0 || joined[k] == 3);
  free(aggregate), free(first), free(node), free(rowptr), free(col), free(joined);
}

static void aggregates_cover_what_has_neighbours(void **state) {
  (void)state;
  /* a string of four beads, one bead alone, a pair */
  const int rowptr[] = {0, 1, 3, 5, 6, 6, 7, 8}, col[] = {1, 0, 2, 1, 3, 2, 6, 5};
  check_aggregates(&(graph_rows){7, rowptr, col});
  check_aggregates(&(graph_rows){0, rowptr, col});
  body b = large_box(CLAMPED);
  corot_pencil *p = pencil_of(&b, step);
  node_matrix A;
  block_rows R;
  assert_ok(corot_nodes_create(p->csc, false, &A));
  assert_ok(corot_rows_create(&A, &R));
  check_aggregates(&(graph_rows){R.n, R.rowptr, R.col});
  corot_rows_clear(&R), corot_nodes_clear(&A), corot_pencil_destroy(p), drop_body(&b);
}

/* --- matrices by rows --- */

/* A body's matrix, scaled, with the prolongator and the matrix of one level below. */
typedef struct pair {
  body b;
  corot_pencil *pencil;
  node_matrix A;
  block_rows rows, coarse;
  prolongator P;
  projection project;
  double *B;      /* [3 A.n][6] the rigid motions, scaled */
  double largest; /* eigenvalue, from above */
} pair;

/* (C' B)_i of three translations and three rotations, held components being zero. */
static void list_motions(const pair *p, double (*B)[6]) {
  memset(B, 0, 3 * p->A.n * sizeof *B);
  for (int i = 0; i < p->b.n; i++) {
    int slot = p->A.slot[i], c = slot % 3;
    const double *x = p->b.mesh->x[p->pencil->csc->node[i]];
    B[slot][c] = 1;
    for (int a = 0; a < 3; a++) /* e_a times x */
      if (a != c) B[slot][3 + a] = (c - a + 3) % 3 == 1 ? -x[(a + 2) % 3] : x[(a + 1) % 3];
  }
  for (int i = 0; i < p->A.n; i++) {
    double whole[3][6], *C = p->A.C + 9 * i;
    memcpy(whole, B + 3 * i, sizeof whole);
    for (int r = 0; r < 3; r++)
      for (int k = 0; k < 6; k++)
        B[3 * i + r][k] = C[r] * whole[0][k] + C[3 + r] * whole[1][k] + C[6 + r] * whole[2][k];
  }
}

/* *p: the rows refer to the matrix in it. */
static void make_pair(holding how, const double abc[3], pair *p) {
  *p = (pair){.b = large_box(how)};
  int at, count;
  p->pencil = pencil_of(&p->b, abc);
  assert_ok(corot_nodes_create(p->pencil->csc, false, &p->A));
  corot_nodes_load(&p->A, p->pencil->csc, p->pencil->S);
  assert_true(corot_nodes_jacobi(&p->A, &at));
  assert_ok(corot_rows_create(&p->A, &p->rows));
  corot_rows_load(&p->rows);
  double *work[3];
  for (int k = 0; k < 3; k++) work[k] = corot_rows_vector(p->A.n, 3);
  p->largest = 1.1 * corot_rows_largest(&p->rows, NULL, 10, work);
  for (int k = 0; k < 3; k++) free(work[k]);
  int *aggregate = malloc(p->A.n * sizeof *aggregate);
  graph_rows g = {p->A.n, p->rows.rowptr, p->rows.col};
  assert_ok(corot_aggregate(&g, aggregate, &count));
  assert_ok(corot_prolong_create(&p->rows, aggregate, count, &p->P));
  assert_ok(corot_project_create(&p->rows, &p->P, &p->project, &p->coarse));
  p->B = malloc(18 * p->A.n * sizeof *p->B);
  list_motions(p, (double(*)[6])p->B);
  memcpy(p->P.T, p->B, 18 * p->A.n * sizeof *p->B);
  corot_prolong_split(&p->P);
  corot_prolong_smooth(&p->rows, p->largest, &p->P);
}

static void drop_pair(pair *p) {
  corot_rows_clear(&p->rows), corot_rows_clear(&p->coarse);
  corot_prolong_clear(&p->P), corot_project_clear(&p->project);
  corot_nodes_clear(&p->A), corot_pencil_destroy(p->pencil), drop_body(&p->b);
  free(p->B);
}

static void rows_are_the_matrix(void **state) {
  (void)state;
  for (int h = 0; h < NHOLDING; h++) {
    pair p;
    make_pair(h, step, &p);
    int n = 3 * p.A.n;
    double *x = corot_rows_vector(p.A.n, 3), *y = calloc(2 * n, sizeof *y), *z = y + n;
    uint64_t seed = 2;
    for (int i = 0; i < n; i++) x[i] = noise(&seed);
    corot_nodes_multiply(&p.A, x, z);
    corot_rows_subtract(&p.rows, 0, p.rows.n, x, y);
    /* single precision rounds each of some 15 or 40 blocks by 6e-8 at the most */
    for (int i = 0; i < n; i++) assert_close(-y[i], z[i], 0, 3e-7 * norm_max(n, z));
    free(x), free(y), drop_pair(&p);
  }
}

/* By many steps of the power method. Blocks of four or ten nodes bound it: that of an element by
   the trace, and those of a matrix by its elements'. */
static void the_largest_eigenvalue_is_found(void **state) {
  (void)state;
  for (int k = 0; k < 2; k++) {
    pair p;
    make_pair(CLAMPED, k ? step : stiffness, &p);
    int n = 3 * p.A.n;
    double *x = corot_rows_vector(p.A.n, 3), *y = calloc(n, sizeof *y), found = 0;
    uint64_t seed = 2;
    for (int i = 0; i < n; i++) x[i] = noise(&seed);
    for (int t = 0; t < 400; t++) {
      memset(y, 0, n * sizeof *y);
      corot_rows_subtract(&p.rows, 0, p.rows.n, x, y);
      found = sqrt(inner(n, y, y) / inner(n, x, x));
      for (int i = 0; i < n; i++) x[i] = -y[i] / norm_max(1, &found);
    }
    assert_below(found, p.largest);               /* with its margin of a tenth, it is a bound */
    assert_below(p.largest, 1.1 * 1.001 * found); /* and without, it is from below */
    assert_below(found, order_of_test() == 1 ? 4 : 10);
    free(x), free(y), drop_pair(&p);
  }
}

/* --- the prolongator --- */

/* y = P x, or x = P' y. */
static void prolong(const pair *p, const double *x, double *y) {
  memset(y, 0, 3 * p->A.n * sizeof *y);
  corot_prolong_add(&p->P, 0, p->P.n, x, y);
}

/* P R = B - omega A B. Of a stiffness that nothing holds, A B is zero: the rigid motions are what
   they are. */
static void rigid_motions_are_reproduced(void **state) {
  (void)state;
  for (int h = 0; h < NHOLDING; h++)
    for (int k = 0; k < 2; k++) {
      pair p;
      make_pair(h, k ? step : stiffness, &p);
      int n = 3 * p.A.n, ncoarse = p.P.ncoarse;
      double *b = corot_rows_vector(p.A.n, 3), *x = corot_rows_vector(ncoarse, 6);
      double *y = calloc(2 * n, sizeof *y), *Ab = y + n;
      for (int mode = 0; mode < 6; mode++) {
        for (int i = 0; i < n; i++) b[i] = p.B[6 * i + mode];
        for (int i = 0; i < 6 * ncoarse; i++) x[i] = p.P.R[6 * i + mode];
        prolong(&p, x, y);
        corot_nodes_multiply(&p.A, b, Ab);
        if (h == FREE && k == 0) assert_below(norm_max(n, Ab), 1e-12 * norm_max(n, b));
        for (int i = 0; i < n; i++)
          assert_close(y[i], b[i] - 4.0 / 3 / p.largest * Ab[i], 0, 1e-12 * norm_max(n, b));
      }
      free(b), free(x), free(y), drop_pair(&p);
    }
}

static void the_columns_of_an_aggregate_are_orthonormal(void **state) {
  (void)state;
  for (int h = 0; h < NHOLDING; h++) {
    pair p;
    make_pair(h, step, &p);
    for (int a = 0; a < p.P.ncoarse; a++)
      for (int j = 0; j < 6; j++)
        for (int k = 0; k < 6; k++) {
          double sum = 0;
          bool there = p.P.R[36 * a + 7 * j] > 0 && p.P.R[36 * a + 7 * k] > 0;
          for (int q = p.P.first[a]; q < p.P.first[a + 1]; q++)
            for (int r = 0; r < 3; r++) {
              const double *row = p.P.T + 6 * (3 * p.P.node[q] + r);
              sum += row[j] * row[k];
            }
          assert_close(sum, there && j == k, 0, 1e-12);
        }
    drop_pair(&p);
  }
}

static void restriction_is_transposed_prolongation(void **state) {
  (void)state;
  pair p;
  make_pair(GUIDED, step, &p);
  int n = 3 * p.A.n, ncoarse = 6 * p.P.ncoarse;
  double *x = corot_rows_vector(p.P.ncoarse, 6), *y = corot_rows_vector(p.A.n, 3);
  double *Px = calloc(n, sizeof *Px), *Py = calloc(ncoarse, sizeof *Py);
  uint64_t seed = 6;
  for (int t = 0; t < 5; t++) {
    for (int i = 0; i < n; i++) y[i] = noise(&seed);
    for (int i = 0; i < ncoarse; i++) x[i] = noise(&seed);
    prolong(&p, x, Px);
    corot_prolong_restrict(&p.P, 0, p.P.ncoarse, y, Py);
    assert_close(inner(n, y, Px), inner(ncoarse, x, Py), 0,
                 1e-13 * sqrt(inner(n, y, y) * inner(n, Px, Px)));
  }
  free(x), free(y), free(Px), free(Py), drop_pair(&p);
}

/* Once P is scaled, P' A P has the identity on its diagonal, or a one where nothing depends on an
   unknown. Twice, so that nothing is left from the first time. */
static void the_coarse_matrix_is_the_projected_one(void **state) {
  (void)state;
  for (int h = 0; h < NHOLDING; h++) {
    pair p;
    make_pair(h, step, &p);
    for (int t = 0; t < 2; t++) {
      memcpy(p.P.T, p.B, 18 * p.A.n * sizeof *p.B);
      corot_prolong_split(&p.P);
      corot_prolong_smooth(&p.rows, p.largest, &p.P);
      assert_int_equal(corot_project_load(&p.rows, &p.project, &p.P, &p.coarse), -1);
    }
    int n = 3 * p.A.n, ncoarse = 6 * p.P.ncoarse;
    double *x = corot_rows_vector(p.P.ncoarse, 6), *Px = corot_rows_vector(p.A.n, 3);
    double *y = calloc(2 * ncoarse, sizeof *y), *z = y + ncoarse, *APx = calloc(n, sizeof *APx);
    for (int j = 0; j < ncoarse; j += 11) {
      memset(x, 0, ncoarse * sizeof *x), memset(y, 0, ncoarse * sizeof *y);
      x[j] = 1;
      prolong(&p, x, Px);
      corot_nodes_multiply(&p.A, Px, APx);
      corot_prolong_restrict(&p.P, 0, p.P.ncoarse, APx, z);
      corot_rows_subtract(&p.coarse, 0, p.coarse.n, x, y);
      bool dead = norm_max(n, Px) == 0;
      for (int i = 0; i < ncoarse; i++) assert_close(y[i], dead && i == j ? -1 : -z[i], 0, 1e-13);
      assert_close(y[j], -1, 0, 1e-15);
    }
    free(x), free(y), free(Px), free(APx), drop_pair(&p);
  }
}

/* --- the preconditioner --- */

static void it_is_symmetric_and_positive(void **state) {
  (void)state;
  for (int h = 0; h < NHOLDING; h++)
    for (int k = h == FREE; k < 2; k++) {
      pair p;
      make_pair(h, k ? step : stiffness, &p);
      linsol_plan plan = {.x = (const double(*)[3])p.b.mesh->x};
      void *M;
      assert_ptr_equal(corot_multilevel_find("amg"), &corot_amg);
      assert_ok(corot_amg.create(p.pencil->csc, &p.A, &plan, &M));
      assert_ok(corot_amg.factor(M));
      int n = 3 * p.A.n;
      double *x = malloc(4 * n * sizeof *x), *y = x + n, *Mx = y + n, *My = Mx + n;
      uint64_t seed = 3;
      for (int t = 0; t < 10; t++) {
        for (int i = 0; i < 2 * n; i++) x[i] = noise(&seed);
        assert_ok(corot_amg.apply(M, x, Mx));
        assert_ok(corot_amg.apply(M, y, My));
        double scale = sqrt(inner(n, x, Mx) * inner(n, y, My));
        assert_true(inner(n, x, Mx) > 0 && inner(n, y, My) > 0);
        assert_close(inner(n, x, My), inner(n, y, Mx), 0, 1e-12 * scale);
        assert_ok(corot_amg.apply(M, x, x)); /* in place */
        assert_memory_equal(x, Mx, n * sizeof *x);
      }
      free(x), corot_amg.destroy(M), drop_pair(&p);
    }
}

/* b -> x by a direct solver and by ours. */
static long compare_with_direct(const body *b, const double abc[3]) {
  corot_pencil *direct = pencil_by(b, SOLVER(corot_linsol_direct), abc), *amg = pencil_of(b, abc);
  double *f = malloc(3 * b->n * sizeof *f), *x = f + b->n, *y = x + b->n;
  uint64_t seed = 8;
  for (int i = 0; i < b->n; i++) f[i] = noise(&seed);
  assert_string_equal(corot_pencil_solver(amg), "pcg, amg");
  assert_ok(corot_pencil_factor(direct));
  assert_ok(corot_pencil_factor(amg));
  assert_ok(corot_pencil_solve(direct, f, x));
  assert_ok(corot_pencil_solve(amg, f, y));
  /* the condition number is 1e4 or so, the tolerance 1e-12 */
  for (int i = 0; i < b->n; i++) assert_close(y[i], x[i], 0, 1e-7 * norm_max(b->n, x));
  long iterations = corot_pencil_statistics(amg).niteration;
  free(f), corot_pencil_destroy(direct), corot_pencil_destroy(amg);
  return iterations;
}

static void it_solves_like_a_direct_solver(void **state) {
  (void)state;
  for (int h = 0; h < NHOLDING; h++) {
    body b = large_box(h);
    assert_above(compare_with_direct(&b, step), 1); /* there are levels */
    if (h != FREE) compare_with_direct(&b, stiffness);
    drop_body(&b);
  }
}

/* What is small enough is left to the direct solver altogether. */
static void of_few_nodes_it_is_exact(void **state) {
  (void)state;
  for (int h = 0; h < NHOLDING; h++) {
    body b = make_box(2, 1, 2, h);
    assert_int_equal(compare_with_direct(&b, step), 1);
    drop_body(&b);
  }
}

/* Two boxes that do not touch, and some tets by themselves, in one mesh. */
static void parts_are_no_obstacle(void **state) {
  (void)state;
  body one = order_of_test() == 1 ? make_box(7, 7, 7, FREE) : make_box(4, 3, 4, FREE);
  const corot_mesh *m = one.mesh;
  enum { NTET = 5 };
  int order = order_of_test(), nnode = 2 * m->nnode + 4 * NTET, ntet = 2 * m->ntet + NTET;
  if (order == 2) skip(); /* such a mesh is made of corners here */
  double(*x)[3] = malloc(nnode * sizeof *x);
  int(*tet)[4] = malloc(ntet * sizeof *tet);
  for (int i = 0; i < 2 * m->nnode; i++)
    for (int c = 0; c < 3; c++) x[i][c] = m->x[i % m->nnode][c] + (i >= m->nnode) * 2;
  for (int e = 0; e < 2 * m->ntet; e++)
    for (int k = 0; k < 4; k++) tet[e][k] = m->tet[e % m->ntet][k] + (e >= m->ntet) * m->nnode;
  for (int k = 0; k < 4 * NTET; k++) {
    double *at = x[2 * m->nnode + k];
    at[0] = -1 + (k % 4 == 1), at[1] = k / 4 + 0.5 * (k % 4 == 2), at[2] = 0.5 * (k % 4 == 3);
    tet[2 * m->ntet + k / 4][k % 4] = 2 * m->nnode + k;
  }
  corot_mesh *mesh;
  assert_ok(corot_mesh_create(nnode, (const double(*)[3])x, ntet, (const int(*)[4])tet, &mesh));
  body b = make(mesh, FREE);
  assert_below(compare_with_direct(&b, step), 40); /* to 1e-12 */
  free(x), free(tet), drop_body(&b), drop_body(&one);
}

/* Layers a thousand times as stiff as the others. */
static void several_materials_are_no_obstacle(void **state) {
  (void)state;
  corot_box box = {.size = {0.8, 0.6, 1}, .cells = {8, 6, 10}};
  if (order_of_test() == 2) box = (corot_box){.size = {0.8, 0.6, 1}, .cells = {4, 3, 5}};
  corot_mesh *mesh = box_of_order(&box);
  int *list = malloc(mesh->ntet * sizeof *list), n = 0;
  for (int e = 0; e < mesh->ntet; e++) {
    double z = 0;
    for (int k = 0; k < 4; k++) z += mesh->x[mesh->tet[e][k]][2] / 4;
    if ((int)(5 * z) % 2) list[n++] = e;
  }
  assert_ok(corot_mesh_group_tets(mesh, "stiff", n, list));
  corot_material material[] = {soft, soft};
  material[1].group = "stiff", material[1].lambda *= 1e3, material[1].mu *= 1e3;
  corot_fix fix = {"zmin", {true, true, true}};
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 2, def.material = material, def.nfix = 1, def.fix = &fix;
  body b = make_body(mesh, def);
  compare_with_direct(&b, stiffness);
  free(list), drop_body(&b);
}

/* A factor of new values is that of a solver which has seen no others, to the last bit. */
static void a_factor_depends_on_no_other(void **state) {
  (void)state;
  body b = large_box(CLAMPED);
  corot_pencil *one = pencil_of(&b, step), *two = pencil_of(&b, stiffness);
  double *x = calloc(2 * b.n, sizeof *x), *y = x + b.n;
  x[0] = y[0] = 1;
  assert_ok(corot_pencil_factor(one));
  corot_pencil_combine(one, 0, 0, 1);
  assert_ok(corot_pencil_factor(one));
  assert_ok(corot_pencil_factor(two));
  assert_ok(corot_pencil_solve(one, x, x));
  assert_ok(corot_pencil_solve(two, y, y));
  assert_memory_equal(x, y, b.n * sizeof *x);
  free(x), corot_pencil_destroy(one), corot_pencil_destroy(two), drop_body(&b);
}

/* --- iterations --- */

static long iterations_of(const body *b, const char *preconditioner, const double abc[3]) {
  corot_linear_def def = pcg_with(preconditioner, 1e-8);
  corot_pencil *p = pencil_by(b, &def, abc);
  double *x = malloc(b->n * sizeof *x);
  for (int i = 0; i < b->n; i++) x[i] = 1 + i % 3;
  assert_ok(corot_pencil_factor(p));
  assert_ok(corot_pencil_solve(p, x, x));
  long iterations = corot_pencil_statistics(p).niteration;
  free(x), corot_pencil_destroy(p);
  return iterations;
}

static const corot_material firm = {.lambda = 1.5e5, .mu = 1.0e5, .density = 1000}; /* nu = 0.3 */

static body make_firm(corot_mesh *mesh) {
  corot_fix fix = {"zmin", {true, true, true}};
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = &firm, def.nfix = 1, def.fix = &fix;
  return make_body(mesh, def);
}

/* Of n, 8 n and 64 n unknowns, the last some 28 000, of cubes and of bars; after incomplete
   Cholesky they double each time. */
static void iterations_hardly_grow_with_the_mesh(void **state) {
  (void)state;
  if (order_of_test() == 2) skip(); /* these are enough */
  static const double long_step[] = {1, 1e-1, 1e-2};
  for (int slender = 0; slender < 2; slender++)
    for (int k = 0; k < 2; k++) {
      long amg[3], cholesky[3];
      for (int level = 0; level < 3; level++) {
        int n = (slender ? 3 : 5) << level;
        corot_box box = {.size = {1, 1, 1}, .cells = {n, n, n}};
        if (slender) box.size[2] = 6, box.cells[2] = 6 * n;
        corot_mesh *mesh;
        assert_ok(corot_mesh_box(&box, &mesh));
        body b = make_firm(mesh);
        amg[level] = iterations_of(&b, "amg", k ? long_step : stiffness);
        cholesky[level] = iterations_of(&b, "incomplete-cholesky", k ? long_step : stiffness);
        drop_body(&b);
      }
      assert_true(amg[1] <= 20 && amg[2] <= 24);
      assert_below(amg[2], 1.5 * amg[1]);
      assert_below(4 * amg[2], cholesky[2]);
    }
}

/* The rigid motions are those of the body where it is: that it has turned does not matter. */
static void a_turned_body_takes_no_more_iterations(void **state) {
  (void)state;
  corot_box box = {.size = {0.5, 0.4, 3}, .cells = {5, 4, 30}};
  if (order_of_test() == 2) box = (corot_box){.size = {0.5, 0.4, 3}, .cells = {2, 2, 15}};
  body b = make(box_of_order(&box), FREE);
  corot_linear_def def = pcg_with("amg", 1e-8);
  corot_pencil *p = pencil_by(&b, &def, step);
  double Q[9], (*u)[3] = malloc(b.mesh->nnode * sizeof *u);
  double *free_u = malloc(3 * b.n * sizeof *free_u), *f = free_u + b.n, *x = f + b.n;
  long before = 0, iterations[2];
  rotation((double[]){1, 2, 0.5}, 1.7, Q);
  for (int i = 0; i < b.n; i++) f[i] = 1 + i % 3;
  for (int k = 0; k < 2; k++) {
    for (int i = 0; i < b.mesh->nnode; i++) {
      apply(Q, b.mesh->x[i], u[i]);
      for (int c = 0; c < 3; c++) u[i][c] = k * (u[i][c] - b.mesh->x[i][c]);
    }
    to_dofs(&b, (const double(*)[3])u, free_u);
    assert_ok(corot_pencil_assemble(p, 0, free_u, NULL));
    corot_pencil_combine(p, 1, 0, 1); /* a long step */
    assert_ok(corot_pencil_factor(p));
    assert_ok(corot_pencil_solve(p, f, x));
    iterations[k] = corot_pencil_statistics(p).niteration - before;
    before += iterations[k];
  }
  assert_above(iterations[0], 5);
  assert_below(iterations[1], 1.2 * iterations[0]);
  free(u), free(free_u), corot_pencil_destroy(p), drop_body(&b);
}

/* --- failures --- */

/* K - w^2 M, w above the lowest frequencies, then above all. */
static void an_indefinite_matrix_is_found_out(void **state) {
  (void)state;
  body b = large_box(CLAMPED);
  corot_linear_def def = pcg_with("amg", 1e-10);
  def.role = COROT_ROLE_STATIC;
  corot_pencil *p = pencil_by(&b, &def, stiffness);
  corot_pencil_combine(p, -300, 0, 1);
  assert_fails(corot_pencil_factor(p), COROT_RETRY, "pcg, level 1: ");
  assert_non_null(strstr(corot_error(), "the matrix is not positive definite"));
  corot_pencil_combine(p, -1e9, 0, 1);
  assert_fails(corot_pencil_factor(p), COROT_RETRY, "pcg: the matrix is not positive definite");
  corot_pencil_combine(p, NAN, 0, 1);
  assert_fails(corot_pencil_factor(p), COROT_RETRY, "pcg: the matrix is not positive definite");
  assert_int_equal(corot_pencil_statistics(p).nindefinite, 3);
  double *x = calloc(b.n, sizeof *x);
  x[0] = 1;
  assert_fails(corot_pencil_solve(p, x, x), COROT_EINVAL, "there is no factor");
  corot_pencil_combine(p, 1, 1e-2, 1e-4);
  assert_ok(corot_pencil_factor(p));
  assert_ok(corot_pencil_solve(p, x, x));
  free(x), corot_pencil_destroy(p), drop_body(&b);
}

static corot_status make_solver(void *context) {
  corot_linear_def def = pcg_with("amg", 1e-10);
  linsol s;
  corot_status status = corot_linsol_create(context, &def, &s);
  corot_linsol_clear(&s);
  return status;
}

static void memory_is_of_creation_only(void **state) {
  (void)state;
  body b = large_box(GUIDED);
  assert_true(assert_survives_failed_allocations(make_solver, b.model) > 60);
  corot_pencil *p = pencil_of(&b, step);
  double *x = calloc(b.n, sizeof *x);
  alloc_fail_at(0);
  for (int k = 0; k < 3; k++) {
    x[k] = 1;
    corot_pencil_combine(p, 1, 1e-2, 1e-4);
    assert_ok(corot_pencil_factor(p));
    assert_ok(corot_pencil_solve(p, x, x));
  }
  assert_int_equal(alloc_count(), 0);
  free(x), corot_pencil_destroy(p), drop_body(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(aggregates_cover_what_has_neighbours),
      cmocka_unit_test(rows_are_the_matrix),
      cmocka_unit_test(the_largest_eigenvalue_is_found),
      cmocka_unit_test(rigid_motions_are_reproduced),
      cmocka_unit_test(the_columns_of_an_aggregate_are_orthonormal),
      cmocka_unit_test(restriction_is_transposed_prolongation),
      cmocka_unit_test(the_coarse_matrix_is_the_projected_one),
      cmocka_unit_test(it_is_symmetric_and_positive),
      cmocka_unit_test(it_solves_like_a_direct_solver),
      cmocka_unit_test(of_few_nodes_it_is_exact),
      cmocka_unit_test(parts_are_no_obstacle),
      cmocka_unit_test(several_materials_are_no_obstacle),
      cmocka_unit_test(a_factor_depends_on_no_other),
      cmocka_unit_test(iterations_hardly_grow_with_the_mesh),
      cmocka_unit_test(a_turned_body_takes_no_more_iterations),
      cmocka_unit_test(an_indefinite_matrix_is_found_out),
      cmocka_unit_test(memory_is_of_creation_only),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
