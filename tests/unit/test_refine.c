/* Octasection: volumes, shapes, faces that match, refusals. */
#include <corot/mesh.h>
#include <limits.h>

#include "alloc.h"
#include "check.h"
#include "core/mesh/refine/mesh_refine.h"
#include "solid.h"

/* A tet with no symmetry; the first is right-handed as it stands. */
static const double odd_x[4][3] = {{0, 0, 0}, {1.1, 0.2, -0.1}, {0.3, 0.9, 0.15}, {-0.2, 0.4, 1.3}};

static corot_mesh *make_tet(const double x[4][3], const int node[4]) {
  corot_mesh *m = NULL;
  assert_ok(corot_mesh_create(4, x, 1, (const int(*)[4])node, &m));
  return m;
}

static corot_mesh *make_box(int nx, int ny, int nz) {
  const corot_box box = {{1, 2, 3}, {nx, ny, nz}, {-1, 0, 5}, COROT_BOX_KUHN};
  corot_mesh *m = NULL;
  assert_ok(corot_mesh_box(&box, &m));
  return m;
}

static corot_mesh *refined(const corot_mesh *m, int nlevel, corot_diagonal diagonal) {
  corot_mesh *fine = NULL;
  assert_ok(corot_mesh_refine(m, nlevel, diagonal, &fine, NULL));
  return fine;
}

/* A box with its nodes moved and the nodes of each tet in any right-handed order. */
static corot_mesh *make_rough(uint64_t *seed) {
  corot_mesh *box = make_box(2, 2, 3), *m = NULL;
  for (int i = 0; i < box->nnode; i++)
    for (int k = 0; k < 3; k++) box->x[i][k] += 0.08 * noise(seed);
  for (int e = 0; e < box->ntet; e++)
    for (int turns = (int)(6 + 6 * noise(seed)); turns > 0; turns--) {
      int *v = box->tet[e], first = turns % 2, swap = v[first];
      v[first] = v[first + 1];
      v[first + 1] = v[first + 2];
      v[first + 2] = swap;
    }
  assert_ok(corot_mesh_create(box->nnode, (const double(*)[3])box->x, box->ntet,
                              (const int(*)[4])box->tet, &m));
  corot_mesh_destroy(box);
  return m;
}

static void one_tet(void **state) {
  (void)state;
  corot_mesh *m = make_tet(odd_x, (int[]){0, 1, 2, 3}), *fine = NULL;
  corot_refinement *r = NULL;
  assert_ok(corot_mesh_refine(m, 1, COROT_DIAGONAL_CONSISTENT, &fine, &r));
  const int parent[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
  const int tet[8][4] = {{0, 4, 5, 6}, {8, 1, 4, 7}, {5, 7, 2, 9}, {9, 6, 8, 3},
                         {4, 5, 6, 8}, {7, 4, 8, 5}, {5, 6, 8, 9}, {8, 5, 9, 7}};
  assert_int_equal(r->nlevel, 1);
  assert_int_equal(r->nnode[0], 4);
  assert_int_equal(r->nnode[1], 10);
  assert_int_equal(r->ntet[0], 1);
  assert_int_equal(r->ntet[1], 8);
  assert_memory_equal(r->parent, parent, sizeof parent);
  assert_int_equal(fine->nnode, 10);
  assert_int_equal(fine->ntet, 8);
  assert_memory_equal(fine->tet, tet, sizeof tet);
  assert_memory_equal(fine->x, odd_x, sizeof odd_x);
  corot_refinement_destroy(r);
  corot_mesh_destroy(fine);
  corot_mesh_destroy(m);
}

static void zero_levels_copy(void **state) {
  (void)state;
  corot_mesh *m = make_box(1, 2, 1), *fine = NULL;
  corot_refinement *r = NULL;
  assert_ok(corot_mesh_refine(m, 0, COROT_DIAGONAL_SHORTEST, &fine, &r));
  assert_int_equal(fine->nnode, m->nnode);
  assert_int_equal(fine->ntet, m->ntet);
  assert_int_equal(fine->ngroup, 6);
  assert_memory_equal(fine->x, m->x, (size_t)m->nnode * sizeof *m->x);
  assert_memory_equal(fine->tet, m->tet, (size_t)m->ntet * sizeof *m->tet);
  assert_int_equal(r->nlevel, 0);
  assert_int_equal(r->nnode[0], m->nnode);
  assert_int_equal(r->ntet[0], m->ntet);
  corot_refinement_destroy(r);
  corot_refinement_destroy(NULL);
  corot_mesh_destroy(fine);
  corot_mesh_destroy(m);
}

/* Nodes: those of the level before, then the middles of their edges, each edge once, ascending. */
static void assert_history(const corot_mesh *m, const corot_mesh *fine, const corot_refinement *r) {
  assert_memory_equal(fine->x, m->x, (size_t)m->nnode * sizeof *m->x);
  assert_int_equal(r->nnode[0], m->nnode);
  assert_int_equal(r->nnode[r->nlevel], fine->nnode);
  for (int l = 1; l <= r->nlevel; l++) {
    assert_int_equal(r->ntet[l], 8 * r->ntet[l - 1]);
    for (int i = r->nnode[l - 1]; i < r->nnode[l]; i++) {
      const int *p = r->parent[i - r->nnode[0]];
      assert_true(0 <= p[0] && p[0] < p[1] && p[1] < r->nnode[l - 1]);
      if (i > r->nnode[l - 1]) {
        const int *q = p - 2;
        assert_true(q[0] < p[0] || (q[0] == p[0] && q[1] < p[1]));
      }
      for (int k = 0; k < 3; k++)
        assert_true(fine->x[i][k] == (fine->x[p[0]][k] + fine->x[p[1]][k]) / 2);
    }
  }
}

/* The first four children of a tet are its corners; all have an eighth of its volume. */
static void assert_children(const corot_mesh *m, const corot_mesh *fine, int nlevel) {
  int n = 1 << (3 * nlevel);
  for (int e = 0; e < fine->ntet; e++) {
    double volume = corot_tet_volume((const double(*)[3])m->x, m->tet[e / n]) / n;
    assert_close(corot_tet_volume((const double(*)[3])fine->x, fine->tet[e]), volume, 1e-12, 0);
  }
  for (int e = 0; e < m->ntet; e++)
    for (int k = 0, c = e; k < 4; k++, c = e) {
      for (int l = 0; l < nlevel; l++) c = 8 * c + k;
      assert_int_equal(fine->tet[c][k], m->tet[e][k]);
    }
}

/* Sound, and the only free faces are the children of those that were free: all others are shared.
 */
static void assert_conforming(const corot_mesh *m, const corot_mesh *fine, int nlevel) {
  corot_mesh *again = NULL;
  int ncoarse, nfine, (*coarse)[3], (*tri)[3];
  assert_ok(corot_mesh_create(fine->nnode, (const double(*)[3])fine->x, fine->ntet,
                              (const int(*)[4])fine->tet, &again));
  assert_ok(corot_mesh_boundary(m, &ncoarse, &coarse));
  assert_ok(corot_mesh_boundary(again, &nfine, &tri));
  assert_int_equal(nfine, ncoarse << (2 * nlevel));
  free(coarse);
  free(tri);
  corot_mesh_destroy(again);
}

static void rough_meshes(void **state) {
  (void)state;
  uint64_t seed = 3;
  for (int d = 0; d < 2; d++)
    for (int nlevel = 1; nlevel <= 3; nlevel++) {
      corot_mesh *m = make_rough(&seed), *fine = NULL;
      corot_refinement *r = NULL;
      assert_ok(corot_mesh_refine(m, nlevel, (corot_diagonal)d, &fine, &r));
      assert_history(m, fine, r);
      assert_children(m, fine, nlevel);
      assert_conforming(m, fine, nlevel);
      corot_refinement_destroy(r);
      corot_mesh_destroy(fine);
      corot_mesh_destroy(m);
    }
}

/* The lengths of the edges in ascending order, in units of the cube root of the volume: equal for
   similar tets. */
static void shape_of(const corot_mesh *m, int e, double length[6]) {
  static const int end[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
  const int *v = m->tet[e];
  double unit = cbrt(corot_tet_volume((const double(*)[3])m->x, v));
  for (int i = 0; i < 6; i++) {
    const double *a = m->x[v[end[i][0]]], *b = m->x[v[end[i][1]]];
    double l = hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]) / unit;
    int at = i;
    for (; at > 0 && length[at - 1] > l; at--) length[at] = length[at - 1];
    length[at] = l;
  }
}

#define MANY 1000

static int count_shapes(const corot_mesh *m) {
  static double known[MANY][6];
  int n = 0;
  for (int e = 0; e < m->ntet && n < MANY; e++) {
    shape_of(m, e, known[n]);
    bool found = false;
    for (int s = 0; s < n && !found; s++) {
      found = true;
      for (int i = 0; i < 6; i++) found = found && fabs(known[s][i] - known[n][i]) < 1e-9;
    }
    n += !found;
  }
  return n;
}

/* Of Bey's children; the shortest diagonals of the same tets give more. */
static void at_most_three_shapes(void **state) {
  (void)state;
  uint64_t seed = 11;
  for (int trial = 0; trial < 10; trial++) {
    double x[4][3];
    for (int i = 0; i < 4; i++)
      for (int k = 0; k < 3; k++) x[i][k] = odd_x[i][k] + 0.2 * noise(&seed);
    corot_mesh *m = make_tet((const double(*)[3])x, (int[]){0, 1, 2, 3});
    for (int nlevel = 1; nlevel <= 4; nlevel++) {
      corot_mesh *fine = refined(m, nlevel, COROT_DIAGONAL_CONSISTENT);
      assert_int_equal(count_shapes(fine), 3);
      corot_mesh_destroy(fine);
    }
    corot_mesh *fine = refined(m, 4, COROT_DIAGONAL_SHORTEST);
    assert_true(count_shapes(fine) > 3);
    corot_mesh_destroy(fine);
    corot_mesh_destroy(m);
  }
}

/* Whatever the order of its nodes, a tet is cut along the shortest diagonal: that from edge 01 to
   edge 23 here. All four tets around it have it as an edge. */
static void shortest_diagonal(void **state) {
  (void)state;
  static const int even[12][4] = {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 0, 3, 2},
                                  {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 0, 1, 3}, {2, 1, 3, 0},
                                  {2, 3, 0, 1}, {3, 0, 2, 1}, {3, 1, 0, 2}, {3, 2, 1, 0}};
  const double x[4][3] = {{-2, 0, -0.1}, {2, 0.2, -0.2}, {0.1, 2.2, 0.3}, {0, -2.1, 0.1}};
  for (int i = 0; i < 12; i++) {
    corot_mesh *m = make_tet(x, even[i]), *fine = refined(m, 1, COROT_DIAGONAL_SHORTEST);
    for (int e = 4; e < 8; e++) {
      int ends = 0;
      for (int k = 0; k < 4; k++) ends += fine->tet[e][k] == 4 || fine->tet[e][k] == 9;
      assert_int_equal(ends, 2);
    }
    corot_mesh_destroy(fine);
    corot_mesh_destroy(m);
  }
}

static int compare_keys(const void *a, const void *b) { return memcmp(a, b, 4 * sizeof(int)); }

/* The tets of a box in terms of its lattice of n[0] x n[1] x n[2] cells, in an order of their own.
 */
static int (*lattice_tets(const corot_mesh *m, const int n[3]))[4] {
  int(*key)[4] = calloc((size_t)m->ntet, sizeof *key);
  corot_mesh_quality q = corot_mesh_measure(m);
  assert_non_null(key);
  for (int e = 0; e < m->ntet; e++)
    for (int k = 0; k < 4; k++) {
      int place = 0;
      for (int c = 2; c >= 0; c--) {
        double at = (m->x[m->tet[e][k]][c] - q.min[c]) / (q.max[c] - q.min[c]) * n[c];
        assert_close(at, round(at), 0, 1e-9);
        place = place * (n[c] + 1) + (int)round(at);
      }
      int i = k;
      for (; i > 0 && key[e][i - 1] > place; i--) key[e][i] = key[e][i - 1];
      key[e][i] = place;
    }
  qsort(key, (size_t)m->ntet, sizeof *key, compare_keys);
  return key;
}

/* So a mesh may be written, read and refined further. */
static void levels_may_be_made_one_by_one(void **state) {
  (void)state;
  uint64_t seed = 17;
  for (int d = 0; d < 2; d++) {
    corot_mesh *m = make_rough(&seed), *once = refined(m, 1, (corot_diagonal)d);
    corot_mesh *twice = refined(once, 1, (corot_diagonal)d),
               *both = refined(m, 2, (corot_diagonal)d);
    assert_int_equal(twice->nnode, both->nnode);
    assert_int_equal(twice->ntet, both->ntet);
    assert_memory_equal(twice->x, both->x, (size_t)both->nnode * sizeof *both->x);
    assert_memory_equal(twice->tet, both->tet, (size_t)both->ntet * sizeof *both->tet);
    corot_mesh_destroy(m);
    corot_mesh_destroy(once);
    corot_mesh_destroy(twice);
    corot_mesh_destroy(both);
  }
}

/* Along either diagonal: where others are as short, the consistent one is taken. */
static void boxes_become_boxes(void **state) {
  (void)state;
  for (int d = 0; d < 2; d++) {
    const corot_box cube = {{1, 1, 1}, {1, 2, 1}, {0, 0, 0}, COROT_BOX_KUHN},
                    fine_cube = {{1, 1, 1}, {4, 8, 4}, {0, 0, 0}, COROT_BOX_KUHN};
    corot_mesh *m, *same;
    assert_ok(corot_mesh_box(&cube, &m));
    assert_ok(corot_mesh_box(&fine_cube, &same));
    corot_mesh *fine = refined(m, 2, (corot_diagonal)d);
    int(*a)[4] = lattice_tets(fine, fine_cube.cells), (*b)[4] = lattice_tets(same, fine_cube.cells);
    assert_int_equal(fine->nnode, same->nnode);
    assert_int_equal(fine->ntet, same->ntet);
    assert_memory_equal(a, b, (size_t)fine->ntet * sizeof *a);
    free(a);
    free(b);
    corot_mesh_destroy(fine);
    corot_mesh_destroy(same);
    corot_mesh_destroy(m);
  }
}

static void refusals(void **state) {
  (void)state;
  corot_mesh *m = make_box(1, 1, 1), *fine = NULL;
  corot_refinement *r = NULL;
  assert_fails(corot_mesh_refine(m, -1, COROT_DIAGONAL_CONSISTENT, &fine, &r), COROT_EINVAL,
               "a mesh cannot be refined -1 times");
  assert_fails(corot_mesh_refine(m, 9, COROT_DIAGONAL_CONSISTENT, &fine, &r), COROT_EINVAL,
               "refining 6 tets 9 times makes 8.05e+08, more than 536870911: at most 8");
  assert_fails(corot_mesh_refine(m, INT_MAX, COROT_DIAGONAL_CONSISTENT, &fine, &r), COROT_EINVAL,
               "makes inf");
  assert_fails(corot_mesh_refine(m, 1, (corot_diagonal)2, &fine, &r), COROT_EINVAL,
               "there is no diagonal 2");
  corot_mesh_destroy(m);

  /* nearly flat, and the consistent diagonal is ten times as long as the shortest */
  const double x[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 0.1, 0}, {1, 0.1, 1.2e-10}};
  m = make_tet(x, (int[]){0, 1, 2, 3});
  assert_fails(corot_mesh_refine(m, 2, COROT_DIAGONAL_CONSISTENT, &fine, &r), COROT_EINVAL,
               "at refinement 1, tet 4 is flat: its volume is 2.5e-13, its longest edge 1");
  assert_null(fine);
  assert_null(r);
  fine = refined(m, 2, COROT_DIAGONAL_SHORTEST);
  corot_mesh_destroy(fine);
  corot_mesh_destroy(m);
}

static corot_status try_refine(void *with_history) {
  corot_mesh *m = NULL, *fine = NULL;
  corot_refinement *r = NULL;
  const corot_box box = {{1, 1, 1}, {1, 1, 1}, {0, 0, 0}, COROT_BOX_KUHN};
  COROT_TRY(corot_mesh_box(&box, &m));
  corot_status status =
      corot_mesh_refine(m, 2, COROT_DIAGONAL_CONSISTENT, &fine, with_history ? &r : NULL);
  assert_true(!status == !!fine);
  assert_true((!status && with_history) == !!r);
  corot_mesh_destroy(m);
  corot_mesh_destroy(fine);
  corot_refinement_destroy(r);
  return status;
}

/* Each tet has six sides, which are counted before an edge is known: nothing is read of the mesh.
 */
static void more_sides_than_an_int_counts_are_refused(void **state) {
  (void)state;
  const corot_mesh vast = {.nnode = 4, .ntet = INT_MAX / 6 + 1};
  corot_edges edges = {0};
  assert_fails(corot_edges_list(&vast, &edges), COROT_EINVAL,
               "357913942 tets are too many to list their edges: at most 357913941");
  assert_true(edges.n == 0 && !edges.end && !edges.tet);
}

static void failed_allocations(void **state) {
  (void)state;
  int yes = 1;
  assert_true(assert_survives_failed_allocations(try_refine, NULL) >= 80);
  assert_true(assert_survives_failed_allocations(try_refine, &yes) >= 80);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(one_tet),
      cmocka_unit_test(zero_levels_copy),
      cmocka_unit_test(rough_meshes),
      cmocka_unit_test(at_most_three_shapes),
      cmocka_unit_test(shortest_diagonal),
      cmocka_unit_test(levels_may_be_made_one_by_one),
      cmocka_unit_test(boxes_become_boxes),
      cmocka_unit_test(refusals),
      cmocka_unit_test(more_sides_than_an_int_counts_are_refused),
      cmocka_unit_test(failed_allocations),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
