/* Meshes of order 2 refined: nested, of the same shape, groups and history; groups by nodes. */
#include <corot/hierarchy.h>
#include <corot/mesh.h>
#include <limits.h>

#include "alloc.h"
#include "check.h"
#include "core/mesh/mesh.h"
#include "order_2.h"
#include "solid.h"

/* From (-1, 0, 5) to (0, 2, 8), with groups of tets, faces, nodes. */
static corot_mesh *make_box(corot_box_split split) {
  const corot_box box = {{1, 2, 3}, {2, 1, 2}, {-1, 0, 5}, split};
  const double min[3] = {-1, 0, 5}, max[3] = {-0.5, 2, 6.5};
  corot_mesh *m = NULL;
  assert_ok(corot_mesh_box(&box, &m));
  assert_ok(corot_mesh_group_box(m, "cells", min, max, 0));
  assert_ok(corot_mesh_group_plane(m, "section", 2, 6.5, 0));
  assert_ok(corot_mesh_group_nodes(m, "some", 4, (int[]){0, 1, 4, 9}));
  return m;
}

static corot_mesh *refined(const corot_mesh *m, int nlevel, corot_diagonal diagonal,
                           corot_refinement **r) {
  corot_mesh *fine = NULL;
  assert_ok(corot_mesh_refine(m, nlevel, diagonal, &fine, r));
  return fine;
}

static void assert_same_history(const corot_refinement *a, const corot_refinement *b) {
  assert_int_equal(a->nlevel, b->nlevel);
  assert_same_ints(a->nlevel + 1, a->nnode, b->nnode);
  assert_same_ints(2 * (a->nnode[a->nlevel] - a->nnode[0]), a->parent, b->parent);
}

static void raising_and_refining_commute(void **state) {
  (void)state;
  for (int split = 0; split < 3; split++)
    for (int d = 0; d < 2; d++)
      for (int nlevel = 0; nlevel < 3; nlevel++) {
        corot_refinement *r = NULL, *r2 = NULL, *deeper = NULL;
        corot_mesh *m = make_box((corot_box_split)split), *raised = with_order(m, 2);
        corot_mesh *fine = refined(m, nlevel, (corot_diagonal)d, &r),
                   *fine_raised = with_order(fine, 2),
                   *raised_fine = refined(raised, nlevel, (corot_diagonal)d, &r2),
                   *octasected = refined(m, nlevel + 1, (corot_diagonal)d, &deeper);
        assert_same(raised_fine, fine_raised);
        assert_int_equal(octasected->nnode, fine_raised->nnode);
        assert_memory_equal(octasected->x, fine_raised->x,
                            (size_t)octasected->nnode * sizeof *octasected->x);
        for (int g = 0; g < m->ngroup; g++) {
          const corot_group *p = &octasected->group[g], *q = &fine_raised->group[g];
          assert_int_equal(p->nnode, q->nnode);
          assert_same_ints(p->nnode, p->node, q->node);
        }
        assert_ok(corot_refinement_raise(r, fine_raised));
        assert_same_history(r, deeper);
        assert_int_equal(r->ntet[nlevel], fine->ntet);
        assert_int_equal(r->ntet[nlevel + 1], fine->ntet);
        assert_int_equal(r2->nnode[0], raised->nnode);
        assert_same_ints(nlevel + 1, r2->nnode, r->nnode + 1);
        assert_same_ints(2 * (r2->nnode[nlevel] - r2->nnode[0]), r2->parent,
                         r->parent + (r2->nnode[0] - m->nnode));
        assert_same_ints(nlevel + 1, r2->ntet, r->ntet);
        corot_refinement_destroy(r), corot_refinement_destroy(r2), corot_refinement_destroy(deeper);
        corot_mesh_destroy(m), corot_mesh_destroy(raised), corot_mesh_destroy(fine);
        corot_mesh_destroy(fine_raised), corot_mesh_destroy(raised_fine);
        corot_mesh_destroy(octasected);
      }
}

/* sum_a l_a (2 l_a - 1) x_a + sum_ab 4 l_a l_b x_ab */
static void point_of(const corot_mesh *m, int e, const double l[4], double x[3]) {
  for (int i = 0; i < 3; i++) {
    x[i] = 0;
    for (int a = 0; a < 4; a++) x[i] += l[a] * (2 * l[a] - 1) * m->x[m->tet[e][a]][i];
    for (int k = 0; k < 6; k++)
      x[i] += 4 * l[corot_tet_edge[k][0]] * l[corot_tet_edge[k][1]] * m->x[m->mid[e][k]][i];
  }
}

static void nodes_of(const corot_mesh *m, int e, int node[10]) {
  for (int k = 0; k < 4; k++) node[k] = m->tet[e][k];
  for (int k = 0; k < 6; k++) node[4 + k] = m->mid[e][k];
}

/* Where node k of a tet is in it. */
static void coordinates(int k, double l[4]) {
  for (int i = 0; i < 4; i++) l[i] = k == i;
  if (k >= 4) l[corot_tet_edge[k - 4][0]] = l[corot_tet_edge[k - 4][1]] = 0.5;
}

/* The corners of a child are nodes of its parent; the ten nodes of the child have the barycentric
   coordinates in the parent that follow. */
static void assert_on_parent(const corot_mesh *m, const corot_mesh *fine, int c) {
  int parent[10], child[10];
  double corner[4][4], l[4], x[3];
  nodes_of(m, c / 8, parent);
  nodes_of(fine, c, child);
  for (int k = 0; k < 4; k++) {
    int at = 0;
    while (at < 10 && parent[at] != child[k]) at++;
    assert_true(at < 10);
    coordinates(at, corner[k]);
  }
  for (int k = 0; k < 10; k++) {
    double own[4];
    coordinates(k, own);
    for (int i = 0; i < 4; i++) {
      l[i] = 0;
      for (int a = 0; a < 4; a++) l[i] += own[a] * corner[a][i];
    }
    point_of(m, c / 8, l, x);
    /* roundings of the sum of ten terms, of coordinates up to 10 */
    for (int i = 0; i < 3; i++) assert_close(fine->x[child[k]][i], x[i], 1e-14, 1e-14);
  }
}

/* A mesh whose nodes on edges are all moved, and one that a bend has made curved. */
static corot_mesh *make_curved(int kind, uint64_t *seed) {
  corot_mesh *m = make_box((corot_box_split)(kind % 3)), *raised = with_order(m, 2);
  const double c[3] = {0.2, 0.1, 0.05};
  if (kind % 2)
    bend(raised, c);
  else
    for (int i = m->nnode; i < raised->nnode; i++)
      for (int k = 0; k < 3; k++) raised->x[i][k] += 0.03 * noise(seed);
  corot_mesh_destroy(m);
  return raised;
}

static void curved_stays_curved(void **state) {
  (void)state;
  uint64_t seed = 3;
  for (int kind = 0; kind < 6; kind++)
    for (int d = 0; d < 2; d++) {
      corot_mesh *m = make_curved(kind, &seed), *fine = refined(m, 1, (corot_diagonal)d, NULL),
                 *twice = refined(fine, 1, (corot_diagonal)d, NULL),
                 *both = refined(m, 2, (corot_diagonal)d, NULL), *again = NULL;
      for (int c = 0; c < fine->ntet; c++) assert_on_parent(m, fine, c);
      assert_memory_equal(fine->x, m->x, (size_t)m->nnode * sizeof *m->x);
      assert_close(corot_mesh_measure(fine).volume, corot_mesh_measure(m).volume, 1e-13, 0);
      assert_same(twice, both);
      int(*tet)[10] = malloc((size_t)fine->ntet * sizeof *tet); /* and is sound */
      assert_non_null(tet);
      for (int e = 0; e < fine->ntet; e++) nodes_of(fine, e, tet[e]);
      assert_ok(corot_mesh_create_order_2(fine->nnode, (const double(*)[3])fine->x, fine->ntet,
                                          (const int(*)[10])tet, &again));
      free(tet);
      corot_mesh_destroy(m), corot_mesh_destroy(fine), corot_mesh_destroy(twice);
      corot_mesh_destroy(both), corot_mesh_destroy(again);
    }
}

/* The same mesh with its nodes numbered backwards: parents, and groups, are the same nodes. */
static void any_numbers_will_do(void **state) {
  (void)state;
  corot_mesh *box = make_box(COROT_BOX_SYMMETRIC), *m = with_order(box, 2), *back, *plain, *fine;
  corot_refinement *r = NULL;
  assert_ok(corot_mesh_copy(m, &back));
  int n = m->nnode - 1;
  for (int i = 0; i <= n; i++) memcpy(back->x[i], m->x[n - i], sizeof *m->x);
  for (int e = 0; e < m->ntet; e++) {
    for (int k = 0; k < 4; k++) back->tet[e][k] = n - m->tet[e][k];
    for (int k = 0; k < 6; k++) back->mid[e][k] = n - m->mid[e][k];
  }
  for (int g = 0; g < m->ngroup; g++) {
    const corot_group *from = &m->group[g];
    corot_group *to = &back->group[g];
    for (int i = 0; i < from->nnode; i++) to->node[i] = n - from->node[from->nnode - 1 - i];
    for (int t = 0; t < from->ntri; t++)
      for (int k = 0; k < 3; k++) to->tri[t][k] = n - from->tri[t][k];
  }
  plain = refined(m, 1, COROT_DIAGONAL_SHORTEST, NULL);
  fine = refined(back, 1, COROT_DIAGONAL_SHORTEST, &r);
  assert_int_equal(fine->nnode, plain->nnode);
  for (int g = 0; g < m->ngroup; g++) {
    assert_int_equal(fine->group[g].nnode, plain->group[g].nnode);
    assert_int_equal(fine->group[g].ntri, plain->group[g].ntri);
    assert_int_equal(fine->group[g].ntet, plain->group[g].ntet);
  }
  for (int i = r->nnode[0]; i < r->nnode[1]; i++) {
    const int *p = r->parent[i - r->nnode[0]];
    assert_true(0 <= p[0] && p[0] < p[1] && p[1] < r->nnode[0]);
    for (int k = 0; k < 3; k++)
      assert_true(fine->x[i][k] == (fine->x[p[0]][k] + fine->x[p[1]][k]) / 2);
  }
  corot_refinement_destroy(r);
  corot_mesh_destroy(box), corot_mesh_destroy(m), corot_mesh_destroy(back);
  corot_mesh_destroy(plain), corot_mesh_destroy(fine);
}

/* A function that is linear on each tet has, at the nodes on edges, the mean of the ends: without
   detail on the raised level, the hierarchical basis gives just that. */
static void the_raised_level_takes_linear_functions(void **state) {
  (void)state;
  uint64_t seed = 9;
  corot_refinement *r = NULL;
  corot_mesh *m = make_box(COROT_BOX_KUHN), *fine = refined(m, 1, COROT_DIAGONAL_CONSISTENT, &r),
             *raised = with_order(fine, 2);
  double(*v)[3] = calloc((size_t)raised->nnode, sizeof *v);
  assert_non_null(v);
  assert_ok(corot_refinement_raise(r, raised));
  for (int i = 0; i < fine->nnode; i++)
    for (int k = 0; k < 3; k++) v[i][k] = noise(&seed);
  corot_hierarchy_apply(r, v);
  for (int e = 0; e < raised->ntet; e++)
    for (int k = 0; k < 6; k++)
      for (int i = 0; i < 3; i++) {
        const int *t = raised->tet[e], *end = corot_tet_edge[k];
        assert_close(v[raised->mid[e][k]][i], (v[t[end[0]]][i] + v[t[end[1]]][i]) / 2, 1e-15, 0);
      }
  free(v);
  corot_refinement_destroy(r);
  corot_mesh_destroy(m), corot_mesh_destroy(fine), corot_mesh_destroy(raised);
}

static void other_meshes_are_not_the_raised_one(void **state) {
  (void)state;
  corot_refinement *r = NULL;
  corot_mesh *m = make_box(COROT_BOX_KUHN), *fine = refined(m, 1, COROT_DIAGONAL_CONSISTENT, &r),
             *coarse_raised = with_order(m, 2), *raised = with_order(fine, 2);
  assert_fails(corot_refinement_raise(r, fine), COROT_EINVAL,
               "tets of order 1 are not its 192 ones raised");
  assert_fails(corot_refinement_raise(r, coarse_raised), COROT_EINVAL,
               "refinement: 24 tets of order 2 are not its 192 ones raised");
  int first = fine->nnode; /* its number and the next are exchanged */
  for (int i = 0; i < 6 * raised->ntet; i++) {
    int *m2 = &raised->mid[i / 6][i % 6];
    if (*m2 == first || *m2 == first + 1) *m2 = 2 * first + 1 - *m2;
  }
  assert_fails(corot_refinement_raise(r, raised), COROT_EINVAL,
               "refinement: the nodes on edges do not follow its");
  assert_int_equal(r->nlevel, 1);
  corot_refinement_destroy(r);
  corot_mesh_destroy(m), corot_mesh_destroy(fine), corot_mesh_destroy(coarse_raised);
  corot_mesh_destroy(raised);
}

static void refusals(void **state) {
  (void)state;
  corot_mesh *m = make_box(COROT_BOX_KUHN), *raised = with_order(m, 2), *fine = NULL;
  assert_fails(corot_mesh_refine(raised, 9, COROT_DIAGONAL_CONSISTENT, &fine, NULL), COROT_EINVAL,
               "refining 24 tets 9 times makes 3.22e+09, more than 214748364: at most 7");
  assert_null(fine);
  corot_mesh_destroy(m), corot_mesh_destroy(raised);
}

/* Groups of a raised mesh by plane, box and list are those that raising hands on. */
static void groups_by_place(void **state) {
  (void)state;
  const corot_box boxes[] = {{{1, 2, 3}, {2, 2, 2}, {-1, 0, 5}, COROT_BOX_KUHN},
                             {{1, 2, 3}, {1, 1, 1}, {-1, 0, 5}, COROT_BOX_KUHN},
                             {{1, 2, 3}, {3, 2, 1}, {-1, 0, 5}, COROT_BOX_SYMMETRIC}};
  const double min[3] = {-1, 0, 5}, max[3] = {-0.5, 1, 6.5}, all[3] = {0, 2, 8};
  for (int i = 0; i < 3; i++) {
    corot_mesh *m = NULL;
    assert_ok(corot_mesh_box(&boxes[i], &m));
    corot_mesh *direct = with_order(m, 2);
    for (int which = 0; which < 2; which++) {
      corot_mesh *at = which ? direct : m;
      assert_ok(corot_mesh_group_plane(at, "bottom", 2, 5, 0));
      assert_ok(corot_mesh_group_box(at, "cell", min, max, 0));
      assert_ok(corot_mesh_group_box(at, "all", min, all, 0));
      assert_ok(corot_mesh_group_nodes(at, "list", 5, (int[]){0, 1, 2, 3, 7}));
    }
    corot_mesh *raised = with_order(m, 2);
    assert_same(direct, raised);
    corot_mesh_destroy(m), corot_mesh_destroy(direct), corot_mesh_destroy(raised);
  }
}

/* One cell, whose space diagonal joins two sides of a surface that has no node inside. */
static void a_surface_stays_on_the_surface(void **state) {
  (void)state;
  const corot_box box = {{1, 1, 1}, {1, 1, 1}, {0, 0, 0}, COROT_BOX_KUHN};
  corot_mesh *m = NULL;
  assert_ok(corot_mesh_box(&box, &m));
  corot_mesh *raised = with_order(m, 2);
  assert_ok(corot_mesh_group_nodes(raised, "ends", 2, (int[]){0, 7}));
  assert_ok(corot_mesh_group_nodes(raised, "edge", 2, (int[]){0, 1}));
  assert_int_equal(corot_mesh_find_group(raised, "ends")->nnode, 2);
  assert_int_equal(corot_mesh_find_group(raised, "edge")->nnode, 3);
  corot_mesh_destroy(m), corot_mesh_destroy(raised);
}

static void listed_nodes_on_edges_belong(void **state) {
  (void)state;
  corot_mesh *m = make_box(COROT_BOX_KUHN), *raised = with_order(m, 2);
  int mid = raised->mid[0][5];
  assert_ok(corot_mesh_group_nodes(raised, "mid", 1, &mid));
  const corot_group *g = corot_mesh_find_group(raised, "mid");
  assert_int_equal(g->nnode, 1);
  assert_int_equal(g->node[0], mid);
  assert_int_equal(g->ntri + g->ntet, 0);
  /* a quarter of the way up there are nodes on edges alone */
  assert_fails(corot_mesh_group_plane(raised, "none", 2, 5.75, 0), COROT_EINVAL,
               "group 'none': no corner of a tet is there");
  corot_mesh_destroy(m), corot_mesh_destroy(raised);
}

static corot_status try_refine(void *with_history) {
  const corot_box box = {{1, 1, 1}, {1, 1, 1}, {0, 0, 0}, COROT_BOX_KUHN};
  corot_mesh *m = NULL, *raised = NULL, *fine = NULL;
  corot_refinement *r = NULL;
  COROT_TRY(corot_mesh_box(&box, &m));
  corot_status status = corot_mesh_change_order(m, 2, &raised);
  if (!status) status = corot_mesh_group_plane(raised, "plane", 0, 0, 0);
  if (!status)
    status =
        corot_mesh_refine(raised, 2, COROT_DIAGONAL_CONSISTENT, &fine, with_history ? &r : NULL);
  corot_mesh_destroy(m), corot_mesh_destroy(raised), corot_mesh_destroy(fine);
  corot_refinement_destroy(r);
  return status;
}

static corot_status try_raise(void *context) {
  const corot_box box = {{1, 1, 1}, {1, 1, 1}, {0, 0, 0}, COROT_BOX_KUHN};
  (void)context;
  corot_mesh *m = NULL, *fine = NULL, *raised = NULL;
  corot_refinement *r = NULL;
  COROT_TRY(corot_mesh_box(&box, &m));
  corot_status status = corot_mesh_refine(m, 1, COROT_DIAGONAL_CONSISTENT, &fine, &r);
  if (!status) status = corot_mesh_change_order(fine, 2, &raised);
  if (!status) status = corot_refinement_raise(r, raised);
  assert_true(!r || r->nlevel == (status ? 1 : 2));
  corot_mesh_destroy(m), corot_mesh_destroy(raised), corot_mesh_destroy(fine);
  corot_refinement_destroy(r);
  return status;
}

static void failed_allocations(void **state) {
  (void)state;
  int yes = 1;
  assert_true(assert_survives_failed_allocations(try_refine, NULL) >= 150);
  assert_true(assert_survives_failed_allocations(try_refine, &yes) >= 150);
  assert_true(assert_survives_failed_allocations(try_raise, NULL) >= 100);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(raising_and_refining_commute),
      cmocka_unit_test(curved_stays_curved),
      cmocka_unit_test(any_numbers_will_do),
      cmocka_unit_test(the_raised_level_takes_linear_functions),
      cmocka_unit_test(other_meshes_are_not_the_raised_one),
      cmocka_unit_test(refusals),
      cmocka_unit_test(groups_by_place),
      cmocka_unit_test(a_surface_stays_on_the_surface),
      cmocka_unit_test(listed_nodes_on_edges_belong),
      cmocka_unit_test(failed_allocations),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
