/* VTK's legacy files as gmsh and meshio write them, see data/make; and with faults. */
#include "alloc.h"
#include "check.h"
#include "mesh_text.h"
#include "temporary.h"

/* ASCII and binary, of version 2.0 and 5.1: the bodies are those of the gmsh files, of curved tets
   too, whose volume depends on the order of the nodes on edges. */
static void bodies_are_those_of_gmsh(void **state) {
  (void)state;
  static const char *const files[][2] = {{DATA "two.vtk", DATA "two.msh41.msh"},
                                         {DATA "two.vtkb.vtk", DATA "two.msh41.msh"},
                                         {DATA "quarter.vtk", DATA "quarter.msh"},
                                         {DATA "quarter.vtk51b.vtk", DATA "quarter.msh"}};
  for (int i = 0; i < 4; i++) {
    corot_mesh *a = read_mesh(files[i][0]), *b = read_mesh(files[i][1]);
    assert_int_equal(a->nnode, b->nnode);
    assert_int_equal(a->ntet, b->ntet);
    assert_int_equal(corot_mesh_order(a), i / 2 + 1);
    assert_close(corot_mesh_measure(a).volume, corot_mesh_measure(b).volume, 1e-12, 0);
    corot_mesh_destroy(a);
    corot_mesh_destroy(b);
  }
}

/* gmsh's numbers of groups. */
static void arrays_of_cells_become_groups(void **state) {
  (void)state;
  static const char *const names[] = {"surface-1", "7", "volume-1", "2"}; /* -2 is none */
  for (int i = 0; i < 2; i++) {
    corot_mesh *m = read_mesh(i ? DATA "two.vtkb.vtk" : DATA "two.vtk");
    assert_int_equal(m->ngroup, 4);
    for (int g = 0; g < 4; g++) {
      assert_string_equal(m->group[g].name, names[g]);
      assert_int_equal(m->group[g].ntri, g < 2 ? 4 : 0);
      assert_int_equal(m->group[g].ntet, g < 2 ? 0 : 24);
    }
    corot_mesh_destroy(m);
  }
}

/* meshio keeps the numbers of physical groups, and repeats what is in several. */
static void repeated_cells_are_one(void **state) {
  (void)state;
  corot_mesh *a = read_mesh(DATA "two.vtk51.vtk"), *b = read_mesh(DATA "two.msh22.msh");
  assert_int_equal(a->ntet, 48);
  assert_memory_equal(a->tet, b->tet, 48 * sizeof *a->tet);
  assert_int_equal(corot_mesh_find_group(a, "volume-2")->ntet,
                   corot_mesh_find_group(b, "all")->ntet);
  corot_mesh_destroy(a);
  corot_mesh_destroy(b);
}

static const char sound[] =
    "# vtk DataFile Version 3.0\na title, BINARY or not\nASCII\nDATASET UNSTRUCTURED_GRID\n"
    "POINTS 5 float\n0 0 0 1 0 0 0 1 0\n0 0 1\n1 1 1\n\n"
    "CELLS 4 18\n4 0 1 2 3\n4 1 2 3 4\n3 0 1 2\n2 0 1\n"
    "CELL_TYPES 4\n10\n10 5\n3\n"
    "CELL_DATA 4\nSCALARS size double\nLOOKUP_TABLE default\n1 2 3 4\nFIELD FieldData 2\n"
    "temperature 2 4 float\n1 2 3 4 5 6 7 8\nMETADATA\nINFORMATION 0\n\n"
    "gmsh:physical 1 4 int\n7 -1 8 9\n"
    "POINT_DATA 5\nVECTORS u double\n1 2 3\n";

static void values_stand_on_any_line(void **state) {
  (void)state;
  corot_mesh *m = NULL;
  assert_ok(corot_mesh_parse("text", sound, strlen(sound), NULL, &m));
  assert_int_equal(m->ntet, 2);
  assert_close(corot_mesh_measure(m).volume, 0.5, 1e-15, 0);
  assert_int_equal(m->ngroup, 2);
  assert_string_equal(m->group[0].name, "8");
  assert_int_equal(m->group[0].ntri, 1);
  assert_string_equal(m->group[1].name, "7");
  assert_int_equal(m->group[1].ntet, 1);
  corot_mesh_destroy(m);
}

static void faults(void **state) {
  (void)state;
  static const text_fault table[] = {
      {"ASCII", "ascii", "m.vtk:3: expected ASCII, found 'ascii'"},
      {"UNSTRUCTURED_GRID", "POLYDATA", "m.vtk:4: only a DATASET UNSTRUCTURED_GRID has tets"},
      {"POINTS 5", "POINTS 5000", "m.vtk:5: the number of points is 5000, more than"},
      {"POINTS 5 float", "POINTS 5 int", "m.vtk:5: points of type int"},
      {"POINTS 5 float", "POINTS 5 real", "m.vtk:5: expected a type of numbers"},
      {"1 1 1\n", "1 inf 1\n", "m.vtk:8: node 4: y is inf"},
      {"CELLS 4 18", "CELLS 4 15", "cell 3 has 2 nodes where 1 numbers are left"},
      {"CELLS 4 18", "CELLS 4 1800", "m.vtk:10: the number of nodes of cells is 1800, more"},
      {"4 1 2 3 4", "4 1 2 3 5", "m.vtk:10: element 1: node 5 does not exist"},
      {"4 1 2 3 4", "4 2 1 3 4", "m.vtk:10: element 1 is inverted"},
      {"CELL_TYPES 4", "CELL_TYPES 3", "m.vtk:15: 3 types of 4 cells"},
      {"10 5", "25 5", "m.vtk:10: cell 1 is a solid of type 25: only tets of 4 or 10 nodes"},
      {"10 5", "12 5", "m.vtk:10: cell 1 has 4 nodes, but is of type 12"},
      {"10 5", "24 5", "m.vtk:10: cell 1 has 4 nodes, but is of type 24"},
      {"CELL_TYPES 4\n10\n10 5\n3\n", "POINT_DATA 5\n", "m.vtk: the file lacks CELL_TYPES"},
  };
  assert_text_faults("m.vtk", sound, sizeof table / sizeof *table, table);
}

static void damage(void **state) {
  (void)state;
  assert_prefixes_fail_cleanly("m.vtk", sound, sizeof sound - 1);
  assert_damage_fails_cleanly("m.vtk", sound, sizeof sound - 1);
  size_t size;
  char *binary = slurp(DATA "two.vtkb.vtk", &size);
  assert_prefixes_fail_cleanly("b.vtk", binary, size);
  assert_damage_fails_cleanly("b.vtk", binary, size);
  free(binary);
}

static void failed_allocations(void **state) {
  (void)state;
  assert_true(assert_survives_failed_allocations(try_read, (void *)(DATA "two.vtkb.vtk")) > 30);
  assert_true(assert_survives_failed_allocations(try_read, (void *)(DATA "quarter.vtk51b.vtk")) >
              20);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(bodies_are_those_of_gmsh),
      cmocka_unit_test(arrays_of_cells_become_groups),
      cmocka_unit_test(repeated_cells_are_one),
      cmocka_unit_test(values_stand_on_any_line),
      cmocka_unit_test(faults),
      cmocka_unit_test(damage),
      cmocka_unit_test(failed_allocations),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
