/* MEDIT's files as gmsh writes them, see data/make, and as others do; and with faults. */
#include "alloc.h"
#include "check.h"
#include "mesh_text.h"
#include "temporary.h"

/* The bodies are those of the gmsh files, of curved tets too, whose volume depends on the order of
   the nodes on edges; the references are gmsh's numbers of entities. */
static void bodies_are_those_of_gmsh(void **state) {
  (void)state;
  static const char *const files[][2] = {{DATA "two.mesh", DATA "two.msh41.msh"},
                                         {DATA "quarter.mesh", DATA "quarter.msh"}};
  for (int i = 0; i < 2; i++) {
    corot_mesh *a = read_mesh(files[i][0]), *b = read_mesh(files[i][1]);
    assert_int_equal(a->nnode, b->nnode);
    assert_int_equal(a->ntet, b->ntet);
    assert_int_equal(corot_mesh_order(a), i + 1);
    assert_close(corot_mesh_measure(a).volume, corot_mesh_measure(b).volume, 1e-12, 0);
    corot_mesh_destroy(a);
    corot_mesh_destroy(b);
  }
}

static void references_become_groups(void **state) {
  (void)state;
  static const char *const names[] = {"surface-1", "26", "48", "volume-1", "2"};
  corot_mesh *m = read_mesh(DATA "two.mesh");
  assert_int_equal(m->ngroup, 5);
  for (int g = 0; g < 5; g++) {
    assert_string_equal(m->group[g].name, names[g]);
    assert_int_equal(m->group[g].ntri, g < 3 ? 4 : 0);
    assert_int_equal(m->group[g].ntet, g < 3 ? 0 : 24);
  }
  corot_mesh_destroy(m);
}

static const char sound[] =
    "MeshVersionFormatted 2\nDimension 3\n"
    "Vertices\n5\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n1 1 1 7\n"
    "Edges\n1\n1 2 4\n"
    "Triangles\n3\n1 2 3 9\n2 3 5 8\n1 2 4 0\n"
    "Tetrahedra\n2\n1 2 3 4 1\n2 3 4 5 0\n"
    "RequiredVertices\n1\n1\nEnd\n";

/* Values need no lines of their own; what is not needed, or is behind the end, does not matter. */
static void lines_do_not_matter(void **state) {
  (void)state;
  corot_mesh *a = parse_text(sound),
             *b = parse_text(
                 "MeshVersionFormatted\n1 # single\nDimension\n3 Vertices 5 0 0 0 0 1 0 0\n0\n"
                 "0 1 0 0 # the third\n0 0 1.D0 0 1 1 1 7\r\nRidges 1\n1\nTriangles 2 1 2 3 9 "
                 "2 3\n5\n8 Tetrahedra 2 1 2 3 4 1 2 3 4 5 0 Hexahedra 0 End x Vertices");
  assert_int_equal(a->ngroup, 3);
  assert_string_equal(a->group[0].name, "8");
  assert_string_equal(a->group[2].name, "1");
  assert_int_equal(b->ngroup, 3);
  assert_memory_equal(a->x, b->x, 5 * sizeof *a->x);
  assert_memory_equal(a->tet, b->tet, 2 * sizeof *a->tet);
  corot_mesh_destroy(a);
  corot_mesh_destroy(b);
}

/* Triangles with their corners only, on ten-node tets. */
static void triangles_take_the_nodes_on_their_edges(void **state) {
  (void)state;
  corot_mesh *m = parse_text(
      "MeshVersionFormatted 2 Dimension 3 Vertices 10 0 0 0 0 2 0 0 0 0 2 0 0 0 0 2 0 1 0 0 0 "
      "1 1 0 0 0 1 0 0 0 0 1 0 1 0 1 0 0 1 1 0 TetrahedraP2 1 1 2 3 4 5 6 7 8 9 10 0 "
      "Triangles 1 1 2 3 5 TrianglesP2 1 1 2 4 5 9 8 6");
  const int bottom[6] = {0, 1, 2, 4, 5, 6}, front[6] = {0, 1, 3, 4, 7, 8};
  assert_int_equal(m->ngroup, 2);
  assert_int_equal(m->group[0].nnode, 6);
  assert_memory_equal(m->group[0].node, bottom, sizeof bottom);
  assert_memory_equal(m->group[1].node, front, sizeof front);
  corot_mesh_destroy(m);
}

static void faults(void **state) {
  (void)state;
  static const text_fault table[] = {
      {"Dimension 3", "Dimension 2", "m.mesh:2: the dimension is 2, not 3"},
      {"Vertices\n5", "Vertices\n-5", "m.mesh:4: the number of vertices is -5"},
      {"Vertices\n5", "Vertices\n2000000000",
       "m.mesh:4: the number of vertices is 2000000000, more"},
      {"Vertices\n5", "Vertices\n4", "m.mesh:9: expected a keyword"},
      {"Vertices\n5", "Vertices\n6", "m.mesh:10: expected x, found 'Edges'"},
      {"Vertices", "Nodes", "m.mesh:14: Triangles are listed before Vertices"},
      {"1 1 1 7", "1 nan 1 7", "m.mesh:9: node 5: y is nan"},
      {"1 1 1 7", "1 1 1 7 Vertices 0", "m.mesh:9: Vertices are listed twice"},
      {"Triangles\n3", "Triangles\n300", "m.mesh:14: the number of elements is 300, more"},
      {"1 2 3 9", "1 2 6 9", "m.mesh:15: face 1: node 6 does not exist"},
      {"1 2 3 9", "1 2 5 9", "m.mesh:15: face 1: the triangle is no face of a tet"},
      {"1 2 3 9", "1 2 3 -9", "m.mesh:15: the reference is -9: groups have numbers up to"},
      {"2 3 4 5 0", "3 2 4 5 0", "m.mesh:21: element 2 is inverted"},
      {"2 3 4 5 0", "2 3 4 0 0", "m.mesh:21: element 2: node 0 does not exist"},
      {"2 3 4 5 0", "2 3 4 5", "m.mesh:22: expected a reference, found 'RequiredVertices'"},
      {"Tetrahedra\n2\n", "Hexahedra 1 1 1 1 1 1 1 1 1 0 Tetrahedra\n2\n",
       "m.mesh: the file has 1 hexahedron beside 2 tets: only tets are supported"},
      {"Tetrahedra\n2\n", "HexahedraQ2 1 1 Tetrahedra\n2\n",
       "m.mesh:18: the file has HexahedraQ2: only tets of 4 or 10 nodes are supported, and other "
       "solids "
       "of first order, to be cut into tets"},
      {"Tetrahedra", "Tetra", "m.mesh: the file has no Tetrahedra"},
      {"Tetrahedra\n2", "BezierBasis 1\nTetrahedra\n2",
       "m.mesh:18: the nodes of second order are control points of Bezier's"},
      {"Tetrahedra\n2", "TrianglesP2Ordering 6 2 0 0 0 2 0 0 0 2 1 1 0 1 1 0 1 0 1\nTetrahedra\n2",
       "m.mesh:18: the order of nodes does not have each of the 6 corners and edges of a triangle"},
  };
  corot_mesh *m = NULL;
  assert_text_faults("m.mesh", sound, sizeof table / sizeof *table, table);
  assert_fails(corot_mesh_parse("m.mesh", "MeshVersionFormatted 2 End", 26, NULL, &m),
               COROT_EFORMAT, "m.mesh: the file has no Vertices");
}

static void damage(void **state) {
  (void)state;
  assert_prefixes_fail_cleanly("m.mesh", sound, sizeof sound - 1);
  assert_damage_fails_cleanly("m.mesh", sound, sizeof sound - 1);
}

static void failed_allocations(void **state) {
  (void)state;
  assert_true(assert_survives_failed_allocations(try_read, (void *)(DATA "two.mesh")) > 30);
  assert_true(assert_survives_failed_allocations(try_read, (void *)(DATA "quarter.mesh")) > 30);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(bodies_are_those_of_gmsh),
      cmocka_unit_test(references_become_groups),
      cmocka_unit_test(lines_do_not_matter),
      cmocka_unit_test(triangles_take_the_nodes_on_their_edges),
      cmocka_unit_test(faults),
      cmocka_unit_test(damage),
      cmocka_unit_test(failed_allocations),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
