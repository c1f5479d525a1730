/* Ten-node tets: raised, lowered, made by hand; sound ones and others; their volume. */
#include <corot/mesh.h>
#include <limits.h>

#include "alloc.h"
#include "check.h"
#include "core/mesh/mesh.h"
#include "order_2.h"
#include "solid.h"

static const corot_box_split splits[] = {COROT_BOX_KUHN, COROT_BOX_ALTERNATING,
                                         COROT_BOX_SYMMETRIC};

/* With groups of every kind. */
static corot_mesh *make_box(corot_box_split split) {
  const corot_box box = {{1, 2, 3}, {2, 3, 2}, {-1, 0, 5}, split};
  const double min[3] = {-1, 0, 5}, max[3] = {-0.5, 1.4, 6.5};
  corot_mesh *m = NULL;
  assert_ok(corot_mesh_box(&box, &m));
  assert_ok(corot_mesh_group_box(m, "cells", min, max, 0));
  assert_ok(corot_mesh_group_nodes(m, "nodes", 4, (int[]){0, 1, 4, 13}));
  return m;
}

static void nodes_on_edges_are_those_of_octasection(void **state) {
  (void)state;
  for (int s = 0; s < 3; s++) {
    corot_mesh *m = make_box(splits[s]), *fine = NULL, *raised = with_order(m, 2);
    assert_int_equal(corot_mesh_order(m), 1);
    assert_int_equal(corot_mesh_order(raised), 2);
    assert_ok(corot_mesh_refine(m, 1, COROT_DIAGONAL_CONSISTENT, &fine, NULL));
    assert_int_equal(raised->nnode, fine->nnode);
    assert_memory_equal(raised->x, fine->x, (size_t)fine->nnode * sizeof *fine->x);
    assert_int_equal(raised->ntet, m->ntet);
    assert_same_ints(4 * m->ntet, raised->tet, m->tet);
    for (int e = 0; e < m->ntet; e++)
      for (int k = 0; k < 6; k++)
        for (int i = 0; i < 3; i++) {
          const int *v = m->tet[e], *end = corot_tet_edge[k];
          assert_true(raised->x[raised->mid[e][k]][i] ==
                      (m->x[v[end[0]]][i] + m->x[v[end[1]]][i]) / 2);
        }
    assert_int_equal(raised->ngroup, m->ngroup);
    for (int g = 0; g < m->ngroup; g++) {
      const corot_group *r = &raised->group[g], *f = &fine->group[g], *c = &m->group[g];
      assert_int_equal(r->nnode, f->nnode);
      assert_same_ints(r->nnode, r->node, f->node);
      assert_int_equal(r->ntri, c->ntri);
      assert_same_ints(3 * r->ntri, r->tri, c->tri);
      assert_int_equal(r->ntet, c->ntet);
      assert_same_ints(r->ntet, r->tet, c->tet);
    }
    corot_mesh_destroy(raised);
    corot_mesh_destroy(fine);
    corot_mesh_destroy(m);
  }
}

static void lowering_undoes_raising(void **state) {
  (void)state;
  for (int s = 0; s < 3; s++) {
    corot_mesh *m = make_box(splits[s]), *raised = with_order(m, 2), *lowered,
               *again = with_order(raised, 2), *same = with_order(m, 1);
    assert_ok(corot_mesh_group_nodes(raised, "between", 1, &raised->mid[0][0]));
    lowered = with_order(raised, 1); /* and a group of nothing else is gone */
    assert_same(lowered, m);
    assert_same(same, m);
    raised->ngroup--;
    assert_same(again, raised);
    raised->ngroup++;
    corot_mesh_destroy(m);
    corot_mesh_destroy(raised);
    corot_mesh_destroy(lowered);
    corot_mesh_destroy(again);
    corot_mesh_destroy(same);
  }
}

/* Corners and nodes on edges in any order of numbers. */
static void corners_close_up(void **state) {
  (void)state;
  static const int place[10] = {5, 0, 8, 3, 9, 1, 7, 2, 6, 4};
  const double corner[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  double x[10][3];
  int tet[1][10];
  for (int k = 0; k < 10; k++) {
    tet[0][k] = place[k];
    for (int i = 0; i < 3; i++)
      x[place[k]][i] =
          k < 4 ? corner[k][i]
                : (corner[corot_tet_edge[k - 4][0]][i] + corner[corot_tet_edge[k - 4][1]][i]) / 2;
  }
  corot_mesh *m = NULL;
  assert_ok(corot_mesh_create_order_2(10, (const double(*)[3])x, 1, (const int(*)[10])tet, &m));
  corot_mesh *low = with_order(m, 1);
  const int expected[4] = {2, 0, 3, 1};
  assert_int_equal(low->nnode, 4);
  assert_memory_equal(low->tet[0], expected, sizeof expected);
  for (int k = 0; k < 4; k++)
    assert_memory_equal(low->x[low->tet[0][k]], corner[k], sizeof *corner);
  corot_mesh_destroy(low);
  corot_mesh_destroy(m);
}

/* (1 + 2 a x)(1 + 2 b y)(1 + 2 c z) over the tet with corners 0, e_x, e_y, e_z, on which
   x^i y^j z^k has the integral i! j! k! / (i + j + k + 3)!. */
static void volume_of_a_curved_tet(void **state) {
  (void)state;
  const double x[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const int tet[1][4] = {{0, 1, 2, 3}};
  uint64_t seed = 5;
  corot_mesh *m = NULL;
  assert_ok(corot_mesh_create(4, x, 1, tet, &m));
  for (int trial = 0; trial < 20; trial++) {
    corot_mesh *raised = with_order(m, 2);
    double c[3];
    for (int k = 0; k < 3; k++) c[k] = 0.4 * noise(&seed);
    bend(raised, c);
    double volume = 1.0 / 6 + 2 * (c[0] + c[1] + c[2]) / 24 +
                    4 * (c[0] * c[1] + c[1] * c[2] + c[2] * c[0]) / 120 +
                    8 * c[0] * c[1] * c[2] / 720;
    corot_mesh_quality q = corot_mesh_measure(raised);
    assert_close(q.volume, volume, 1e-14, 0); /* rounding of a sum of five products */
    assert_close(q.volume_min, volume, 1e-14, 0);
    assert_close(q.volume_max, volume, 1e-14, 0);
    corot_mesh_destroy(raised);
  }
  corot_mesh_destroy(m);
}

/* Edges and shapes are those of the corners. */
static void measures_of_straight_ones_are_the_same(void **state) {
  (void)state;
  corot_mesh *m = make_box(COROT_BOX_SYMMETRIC), *raised = with_order(m, 2);
  corot_mesh_quality a = corot_mesh_measure(m), b = corot_mesh_measure(raised);
  assert_close(b.volume, a.volume, 1e-14, 0);
  assert_true(a.edge_min == b.edge_min && a.edge_max == b.edge_max);
  assert_true(a.dihedral_min == b.dihedral_min && a.dihedral_max == b.dihedral_max);
  assert_true(a.shape_min == b.shape_min && a.shape_mean == b.shape_mean);
  assert_int_equal(a.shape_worst, b.shape_worst);
  corot_mesh_destroy(m);
  corot_mesh_destroy(raised);
}

/* Two tets on either side of the face 1 2 3, with nodes 5 to 13 on their edges. */
static const double two_corner[5][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
static const int two_tet[2][10] = {{0, 1, 2, 3, 5, 8, 6, 7, 9, 11},
                                   {1, 2, 3, 4, 8, 11, 9, 10, 12, 13}};

static void place_two(double (*x)[3]) {
  memcpy(x, two_corner, sizeof two_corner);
  for (int e = 0; e < 2; e++)
    for (int k = 0; k < 6; k++)
      for (int i = 0; i < 3; i++)
        x[two_tet[e][4 + k]][i] = (two_corner[two_tet[e][corot_tet_edge[k][0]]][i] +
                                   two_corner[two_tet[e][corot_tet_edge[k][1]]][i]) /
                                  2;
}

/* A change of two_tet, or of a coordinate, and what is said of it. */
static const struct {
  int tet, k, v, node, c;
  double x;
  const char *message;
} faults[] = {
    {-1, 0, 0, 5, 2, NAN, "node 5: z is nan"},
    {0, 4, 14, -1, 0, 0, "tet 0: node 14 does not exist, the last is 13"},
    {1, 9, -1, -1, 0, 0, "tet 1: node -1 does not exist"},
    {0, 4, 3, -1, 0, 0, "tet 0: node 3 is on an edge of it, and the corner of a tet"},
    {0, 4, 4, -1, 0, 0, "tet 0: node 4 is on an edge of it, and the corner of a tet"},
    {0, 4, 8, -1, 0, 0, "tet 0 has node 8 on the edge 1 2; it is on 0 1, too"},
    {0, 4, 13, -1, 0, 0, "tet 1 has node 13 on the edge 3 4; it is on 0 1, too"},
    {0, 5, 14, -1, 0, 0, "tet 0: node 14 does not exist"},
    {0, 5, 10, -1, 0, 0, "tet 1 has node 8 on the edge 1 2, another 10"},
    {-1, 0, 0, 5, 1, 2,
     "tet 0: node 5 is far off, 2 from the middle of its edge 0 1, which is 1 lo"},
    {-1, 0, 0, 5, 0, 0.2,
     "tet 0: its midpoints turn it inside out: the determinant of its map is "
     "-0.2 at node 0"},
    {-1, 0, 0, 5, 0, 0.25,
     "tet 0: its midpoints turn it inside out: the determinant of its map is "
     "0 at node 0"},
    {-1, 0, 0, 13, 0, 1.05, "tet 1: its midpoints turn it inside out"},
};

static void unsound_ones_are_refused_by_name(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof faults / sizeof *faults; i++) {
    double x[14][3];
    int tet[2][10];
    corot_mesh *m = NULL;
    place_two(x);
    memcpy(tet, two_tet, sizeof tet);
    assert_ok(corot_mesh_create_order_2(14, (const double(*)[3])x, 2, (const int(*)[10])tet, &m));
    corot_mesh_destroy(m);
    m = NULL;
    if (faults[i].tet >= 0) tet[faults[i].tet][faults[i].k] = faults[i].v;
    if (faults[i].node >= 0) x[faults[i].node][faults[i].c] = faults[i].x;
    assert_fails(corot_mesh_create_order_2(14, (const double(*)[3])x, 2, (const int(*)[10])tet, &m),
                 COROT_EINVAL, faults[i].message);
    assert_null(m);
  }
}

/* Found by chance: the determinant is positive at the ten nodes. */
static void points_of_integration_count(void **state) {
  (void)state;
  const double x[10][3] = {{0, 0, 0},
                           {1, 0, 0},
                           {0, 1, 0},
                           {0, 0, 1},
                           {0.83, 0.27, -0.09},
                           {0.76, 0.17, -0.20},
                           {-0.22, 0.47, -0.39},
                           {0.02, 0.22, 0.10},
                           {0.75, 0.40, 0.94},
                           {-0.31, 0.83, 0.58}};
  const int tet[1][10] = {{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}};
  corot_mesh *m = NULL;
  assert_fails(corot_mesh_create_order_2(10, x, 1, tet, &m), COROT_EINVAL,
               "tet 0: its midpoints turn it inside out: the determinant of its map is -1.3");
  assert_non_null(strstr(corot_error(), "at a point of integration"));
}

static void other_orders_are_refused(void **state) {
  (void)state;
  corot_mesh *m = make_box(COROT_BOX_KUHN), *out = NULL;
  static const int order[] = {0, 3, -1, INT_MAX};
  for (int i = 0; i < 4; i++)
    assert_fails(corot_mesh_change_order(m, order[i], &out), COROT_EINVAL, "a mesh of order ");
  assert_null(out);
  corot_mesh_destroy(m);
}

static corot_status try_orders(void *context) {
  const corot_box box = {{1, 1, 1}, {1, 1, 1}, {0, 0, 0}, COROT_BOX_KUHN};
  (void)context;
  corot_mesh *m = NULL, *raised = NULL, *lowered = NULL;
  COROT_TRY(corot_mesh_box(&box, &m));
  corot_status status = corot_mesh_change_order(m, 2, &raised);
  if (!status) status = corot_mesh_change_order(raised, 1, &lowered);
  assert_true(!status == !!lowered);
  corot_mesh_destroy(m);
  corot_mesh_destroy(raised);
  corot_mesh_destroy(lowered);
  return status;
}

static corot_status try_create(void *context) {
  double x[14][3];
  (void)context;
  corot_mesh *m = NULL;
  place_two(x);
  corot_status status = corot_mesh_create_order_2(14, (const double(*)[3])x, 2, two_tet, &m);
  assert_true(!status == !!m);
  corot_mesh_destroy(m);
  return status;
}

static void failed_allocations(void **state) {
  (void)state;
  assert_true(assert_survives_failed_allocations(try_orders, NULL) >= 80);
  assert_true(assert_survives_failed_allocations(try_create, NULL) >= 12);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(nodes_on_edges_are_those_of_octasection),
      cmocka_unit_test(lowering_undoes_raising),
      cmocka_unit_test(corners_close_up),
      cmocka_unit_test(volume_of_a_curved_tet),
      cmocka_unit_test(measures_of_straight_ones_are_the_same),
      cmocka_unit_test(unsound_ones_are_refused_by_name),
      cmocka_unit_test(points_of_integration_count),
      cmocka_unit_test(other_orders_are_refused),
      cmocka_unit_test(failed_allocations),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
