/* Files of ten-node tets as gmsh and TetGen write them, see data/make; and with faults. */
#include "alloc.h"
#include "check.h"
#include "core/mesh/mesh.h"
#include "core/mesh/read/mesh_read.h"
#include "mesh_text.h"
#include "order_2.h"
#include "temporary.h"

/* The names of format 1 are numbers. */
static void forget_names(corot_mesh *m) {
  for (int g = 0; g < m->ngroup; g++) m->group[g].name[0] = 0;
}

static void assert_straight(const corot_mesh *m) {
  for (int e = 0; e < m->ntet; e++)
    for (int k = 0; k < 6; k++)
      for (int i = 0; i < 3; i++) {
        const int *v = m->tet[e], *end = corot_tet_edge[k];
        /* gmsh places nodes on curves by a search to some 1e-12 */
        assert_close(m->x[m->mid[e][k]][i], (m->x[v[end[0]]][i] + m->x[v[end[1]]][i]) / 2, 0,
                     1e-11);
      }
}

static const char *const gmsh_files[] = {
    DATA "two_2.msh41.msh",  DATA "two_2.msh41b.msh", DATA "two_2.msh22.msh",
    DATA "two_2.msh22b.msh", DATA "two_2.msh40.msh",  DATA "two_2.msh1.msh",
};
enum { NFILE = sizeof gmsh_files / sizeof *gmsh_files };

static void all_gmsh_formats_give_the_same_mesh(void **state) {
  (void)state;
  corot_mesh *first = read_mesh(gmsh_files[0]);
  assert_int_equal(corot_mesh_order(first), 2);
  assert_int_equal(first->ntet, 48);
  assert_straight(first);
  assert_close(corot_mesh_measure(first).volume, 2, 1e-11, 0);
  for (int i = 1; i < NFILE; i++) {
    corot_mesh *m = read_mesh(gmsh_files[i]);
    if (i == NFILE - 1) {
      forget_names(first);
      forget_names(m);
    }
    for (int n = 0; n < m->nnode; n++) /* text has 16 digits */
      for (int k = 0; k < 3; k++) {
        assert_close(m->x[n][k], first->x[n][k], 1e-15, 0);
        m->x[n][k] = first->x[n][k];
      }
    assert_same(first, m);
    corot_mesh_destroy(m);
  }
  corot_mesh_destroy(first);
}

/* The corners, triangles and tets of groups are those of the file of order 1, and the nodes on
   edges are those that the raised file has. */
static void groups_are_those_of_the_raised_file(void **state) {
  (void)state;
  static const char *const pairs[][2] = {
      {DATA "two.msh41.msh", DATA "two_2.msh41.msh"},
      {DATA "two.msh22b.msh", DATA "two_2.msh22b.msh"},
      {DATA "two.node", DATA "two_2.node"},
  };
  for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
    corot_mesh *one = read_mesh(pairs[i][0]), *two = read_mesh(pairs[i][1]);
    corot_mesh *raised = with_order(one, 2), *lowered = with_order(two, 1);
    assert_int_equal(lowered->nnode, one->nnode);
    assert_int_equal(lowered->ntet, one->ntet);
    assert_int_equal(two->ngroup, raised->ngroup);
    for (int g = 0; g < two->ngroup; g++) {
      const corot_group *p = &two->group[g], *q = &raised->group[g];
      assert_string_equal(p->name, q->name);
      assert_int_equal(p->nnode, q->nnode);
      assert_int_equal(p->ntri, q->ntri);
      assert_int_equal(p->ntet, q->ntet);
    }
    assert_same_groups(lowered, one);
    corot_mesh_destroy(one);
    corot_mesh_destroy(two);
    corot_mesh_destroy(raised);
    corot_mesh_destroy(lowered);
  }
}

static void tetgen_order_is_recognised(void **state) {
  (void)state;
  corot_mesh *m = read_mesh(DATA "two_2.ele");
  assert_int_equal(corot_mesh_order(m), 2);
  assert_int_equal(m->ntet, 12);
  assert_straight(m);
  assert_close(corot_mesh_measure(m).volume, 2, 1e-14, 0);
  corot_mesh_destroy(m);
}

/* The round side is a parabola in each element: the volume is off by less than a hundredth of what
   it is with straight edges, and the nodes of the group are at radius 1. */
static void curved_edges(void **state) {
  (void)state;
  corot_mesh *m = read_mesh(DATA "quarter.msh"), *straight = with_order(m, 1);
  const double exact = acos(-1) / 4;
  double off = fabs(corot_mesh_measure(m).volume - exact),
         off_straight = fabs(corot_mesh_measure(straight).volume - exact);
  assert_above(off_straight, 0.01);
  assert_below(off, off_straight / 100);
  const corot_group *round = corot_mesh_find_group(m, "round"),
                    *body = corot_mesh_find_group(m, "body"),
                    *arc = corot_mesh_find_group(m, "arc");
  assert_int_equal(body->nnode, m->nnode);
  int corners = corot_mesh_find_group(straight, "round")->nnode; /* Euler: edges = V + F - 1 */
  assert_int_equal(round->nnode, 2 * corners + round->ntri - 1);
  for (int i = 0; i < round->nnode; i++) /* gmsh's roundings */
    assert_close(hypot(m->x[round->node[i]][0], m->x[round->node[i]][1]), 1, 1e-12, 0);
  for (int i = 0; i < arc->nnode; i++)
    assert_close(hypot(m->x[arc->node[i]][0], m->x[arc->node[i]][1]), 1, 1e-12, 0);
  assert_int_equal(arc->nnode % 2, 1);
  corot_mesh_destroy(m);
  corot_mesh_destroy(straight);
}

static void writing_and_reading_give_the_same_mesh(void **state) {
  (void)state;
  static const char *const files[] = {DATA "two_2.msh41.msh", DATA "two_2.ele", DATA "quarter.msh",
                                      DATA "quadratic.msh"};
  char *dir = temporary_folder();
  for (int i = 0; i < 4; i++) {
    corot_mesh *m = read_mesh(files[i]), *again;
    const double c[3] = {0.1, 0.07, 0.03};
    bend(m, c);
    assert_ok(corot_mesh_write(m, in(dir, "m.msh")));
    again = read_mesh(in(dir, "m.msh"));
    assert_same(m, again);
    corot_mesh_destroy(m);
    corot_mesh_destroy(again);
  }
  remove_folder(dir);
}

static const char sound[] =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
    "$Nodes\n14\n1 0 0 0\n2 2 0 0\n3 0 2 0\n4 0 0 2\n5 1 0 0\n6 1 1 0\n7 0 1 0\n8 0 0 1\n"
    "9 0 1 1\n10 1 0 1\n50 2 2 2\n51 2 1 1\n52 1 2 1\n53 1 1 2\n$EndNodes\n"
    "$Elements\n4\n11 11 2 1 1 1 2 3 4 5 6 7 8 9 10\n12 11 2 1 1 2 3 4 50 6 9 10 51 53 52\n"
    "13 9 2 4 1 2 3 50 6 52 51\n14 8 2 5 1 1 2 5\n$EndElements\n";

static const struct {
  const char *from, *to, *message;
} faults[] = {
    {"12 11 2 1 1 2 3 4 50 6 9 10 51 53 52", "12 4 2 1 1 2 3 4 50",
     "bad.msh:24: element 12 is a tet of 4 nodes, the tets before it have 10: orders do not mix"},
    {"11 11 2 1 1 1 2 3 4 5 6 7 8 9 10", "11 4 2 1 1 1 2 3 4",
     "bad.msh:24: element 12 is a tet of 10 nodes, the tets before it have 4: orders do not mix"},
    {"13 9 2 4 1 2 3 50 6 52 51", "13 2 2 4 1 2 3 50",
     "bad.msh:25: element 13 of a physical group is a 3-node triangle, but the tets have 10 nodes: "
     "orders do not mix"},
    {"14 8 2 5 1 1 2 5", "14 1 2 5 1 1 2",
     "bad.msh:26: element 14 of a physical group is a 2-node line, but the tets have 10 nodes: or"},
    {"8 9 10\n", "8 10 9\n",
     "bad.msh:23: element 11: node 9 is on the edge 3 4, in the place of the node on 2 4: the "
     "order of its nodes is not known"},
    {"51 53 52\n", "51 52 53\n",
     "bad.msh:24: element 12: node 53 is on the edge 4 50, in the place"},
    {"8 9 10\n", "8 9\n", "bad.msh:23: expected a node, found the end of the line"},
    {"8 9 10\n", "8 9 99\n", "bad.msh:23: element 11: node 99 does not exist"},
    {"8 9 10\n", "8 9 1\n", "bad.msh:23: element 11: node 1 is on an edge of it, and the corner"},
    {"8 9 10\n", "8 9 9\n", "bad.msh:23: element 11 has node 9 on the edge 3 4; it is on 2 4, too"},
    {"53 1 1 2\n", "53 1 1 9\n",
     "bad.msh:24: element 12: node 53 is far off, 7 from the middle of its edge 4 50, which is "
     "2.8"},
    {"53 1 1 2\n", "53 1.6 1.6 2\n",
     "bad.msh:24: element 12: its midpoints turn it inside out: the determinant of its map is"},
    {"6 52 51\n", "52 6 51\n", "bad.msh:25: element 13 has node 52 on the edge 2 3, the tets have"},
    {"53 1 1 2\n", "53 1 1 2\n54 1 1 1\n", "bad.msh:20: expected $EndNodes"},
    {"$Nodes\n14\n", "$Nodes\n15\n99 1 1 1\n", "bad.msh:6: node 99 is in no tet"},
};

static void faults_are_told_with_their_place(void **state) {
  (void)state;
  corot_mesh *m = NULL;
  assert_ok(corot_gmsh_parse("good.msh", sound, strlen(sound), NULL, &m));
  assert_int_equal(corot_mesh_find_group(m, "4")->nnode, 6);
  assert_int_equal(corot_mesh_find_group(m, "4")->ntri, 1);
  assert_int_equal(corot_mesh_find_group(m, "5")->nnode, 3);
  corot_mesh_destroy(m);
  m = NULL;
  for (size_t i = 0; i < sizeof faults / sizeof *faults; i++) {
    char *text = edit_text(sound, faults[i].from, faults[i].to);
    assert_fails(corot_gmsh_parse("bad.msh", text, strlen(text), NULL, &m), COROT_EFORMAT,
                 faults[i].message);
    assert_null(m);
    free(text);
  }
}

/* A ten-node tet that format 2.2 repeats for a second group is one; other elements outside groups
   do not matter. */
static void repeated_tets_are_one(void **state) {
  (void)state;
  char *text = edit_text(sound, "$Elements\n4\n",
                         "$Elements\n7\n1 11 2 6 1 1 2 3 4 5 6 7 8 9 10\n2 2 2 0 1 1 2 3\n"
                         "3 9 2 0 1 1 2 3 5 6 4\n");
  corot_mesh *m = NULL;
  assert_ok(corot_gmsh_parse("good.msh", text, strlen(text), NULL, &m));
  assert_int_equal(m->ntet, 2);
  assert_int_equal(corot_mesh_find_group(m, "6")->nnode, 10);
  assert_int_equal(corot_mesh_find_group(m, "1")->nnode, 14);
  corot_mesh_destroy(m);
  free(text);
}

static const char node[] =
    "10 3 0 1\n0 0 0 0 3\n1 2 0 0 3\n2 0 2 0 3\n3 0 0 2 0\n4 1 0 0 0\n5 1 1 0 0\n6 0 1 0 0\n"
    "7 0 0 1 0\n8 1 0 1 0\n9 0 1 1 0\n";

static void tetgen_files_in_any_order(void **state) {
  (void)state;
  static const char *const good[] = {
      "1 10 0\n0 0 1 2 3 4 5 6 7 8 9\n", "1 10 0\n0 0 1 2 3 9 8 7 6 5 4\n",
      "1 10 0\n0 0 1 2 3 9 7 4 5 8 6\n", "1 10 0\n0 1 0 2 3 9 7 4 5 8 6\n"};
  for (int i = 0; i < 4; i++) { /* the last is left-handed */
    corot_mesh *m = NULL;
    assert_ok(corot_tetgen_parse(TEXT("m.node", node), TEXT("m.ele", good[i]), NULL, NULL, &m));
    assert_straight(m);
    assert_int_equal(corot_mesh_find_group(m, "marker-3")->nnode, 6); /* three with the marker */
    corot_mesh_destroy(m);
  }
}

static void faults_of_tetgen(void **state) {
  (void)state;
  static const char *const bad[][2] = {
      {"1 10 0\n0 0 1 2 3 4 5 6 7 8 8\n",
       "m.ele:2: element 0: its last six nodes are not on an edge"},
      {"1 10 0\n0 0 1 2 3 4 5 6 7 8\n", "m.ele:2: expected a node, found the end of the line"},
      {"1 10 0\n0 0 1 2 3 4 5 6 7 8 10\n", "m.ele:2: element 0: node 10 does not exist"},
      {"1 10 0\n0 0 1 2 3 4 5 6 7 8 3\n", "m.ele:2: element 0"},
      {"2 10 0\n0 0 1 2 3 4 5 6 7 8 9\n1 0 1 2 3 5 4 6 7 8 9\n",
       "m.ele:3: element 1 has the nodes on its edges in another order than the first one"},
      {"1 4 0\n0 0 1 2 3\n", "m.node:6: node 4 is in no tet"},
  };
  corot_mesh *m = NULL;
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
    assert_fails(corot_tetgen_parse(TEXT("m.node", node), TEXT("m.ele", bad[i][0]), NULL, NULL, &m),
                 COROT_EFORMAT, bad[i][1]);
  assert_null(m);
}

static void failed_allocations(void **state) {
  (void)state;
  const char *files[] = {DATA "two_2.msh22.msh", DATA "two_2.msh41.msh", DATA "two_2.ele"};
  for (int i = 0; i < 3; i++)
    assert_true(assert_survives_failed_allocations(try_read, (void *)files[i]) >= 20);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(all_gmsh_formats_give_the_same_mesh),
      cmocka_unit_test(groups_are_those_of_the_raised_file),
      cmocka_unit_test(tetgen_order_is_recognised),
      cmocka_unit_test(curved_edges),
      cmocka_unit_test(writing_and_reading_give_the_same_mesh),
      cmocka_unit_test(faults_are_told_with_their_place),
      cmocka_unit_test(repeated_tets_are_one),
      cmocka_unit_test(tetgen_files_in_any_order),
      cmocka_unit_test(faults_of_tetgen),
      cmocka_unit_test(failed_allocations),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
