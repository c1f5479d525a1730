/* MFEM's and VegaFEM's files, by hand; and with faults. */
#include "alloc.h"
#include "check.h"
#include "mesh_text.h"

static corot_mesh *parse(const char *path, const char *text) {
  corot_mesh *m = NULL;
  assert_ok(corot_mesh_parse(path, text, strlen(text), NULL, &m));
  return m;
}

static void assert_group(const corot_mesh *m, const char *name, int nnode, int ntri, int ntet) {
  const corot_group *g = corot_mesh_find_group(m, name);
  assert_non_null(g);
  assert_int_equal(g->nnode, nnode);
  assert_int_equal(g->ntri, ntri);
  assert_int_equal(g->ntet, ntet);
}

/* Solids that a mending reading cuts; the volume that they have together. */
static void assert_cut(const char *text, int ntet, double volume) {
  corot_mesh_report report = {0};
  const corot_reading how = {.mends = true, .cuts = true, .report = &report};
  corot_mesh *m = NULL;
  assert_fails(corot_mesh_parse("m", text, strlen(text), NULL, &m), COROT_EFORMAT,
               "only tets are supported");
  assert_ok(corot_mesh_parse("m", text, strlen(text), &how, &m));
  assert_int_equal(m->ntet, ntet);
  assert_close(corot_mesh_measure(m).volume, volume, 1e-14, 0);
  assert_int_equal(report.nremark, 1);
  for (int i = 0; i < report.nremark; i++) free(report.remark[i].text);
  free(report.remark);
  corot_mesh_destroy(m);
}

static const char mfem[] =
    "MFEM mesh v1.0\n\n# a comment\ndimension\n3\n\nelements\n2\n1 4 0 1 2 3\n2 4 1 2 3 4\n\n"
    "boundary\n3\n7 2 0 2 1\n7 2 0 1 3\n8 2 1 2 4\n\n"
    "vertices\n5\n3\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1\n\nmfem_mesh_end\n";

static void mfem_has_attributes(void **state) {
  (void)state;
  corot_mesh *m = parse("m.mesh", mfem);
  assert_int_equal(m->ntet, 2);
  assert_memory_equal(m->tet[1], ((int[]){1, 2, 3, 4}), sizeof *m->tet);
  assert_int_equal(m->ngroup, 4);
  assert_group(m, "1", 4, 0, 1);
  assert_group(m, "2", 4, 0, 1);
  assert_group(m, "7", 4, 2, 0);
  assert_group(m, "8", 3, 1, 0);
  corot_mesh_destroy(m);
  assert_cut(
      "MFEM mesh v1.0\ndimension\n3\nelements\n3\n1 5 0 1 2 3 4 5 6 7\n1 7 4 5 6 7 8\n"
      "1 6 1 9 2 5 10 6\nboundary\n1\n4 3 0 3 2 1\nvertices\n11\n3\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
      "0 0 1\n1 0 1\n1 1 1\n0 1 1\n.5 .5 2\n2 .5 0\n2 .5 1\n",
      11, 1 + 1. / 3 + 0.5);
}

static void faults_of_mfem(void **state) {
  (void)state;
  static const text_fault table[] = {
      {"dimension\n3", "dimension\n2", "m.mesh:5: the dimension is 2, not 3"},
      {"1 4 0 1 2 3", "1 2 0 1 2", "m.mesh:9: element 1 is of shape 2, which there is not in 3"},
      {"1 4 0 1 2 3", "1 4 0 1 2", "m.mesh:9: expected a vertex, found the end of the line"},
      {"1 4 0 1 2 3", "1 4 0 1 2 3 4", "m.mesh:9: '4' is too much on this line"},
      {"2 4 1 2 3 4", "2 4 1 2 3 5", "m.mesh:10: element 2: node 5 does not exist"},
      {"2 4 1 2 3 4", "2 4 2 1 3 4", "m.mesh:10: element 2 is inverted"},
      {"7 2 0 2 1", "7 2 0 2 4", "m.mesh:14: face 1: the triangle is no face of a tet"},
      {"7 2 0 2 1", "7 2 0 2 9", "m.mesh:14: face 1: node 9 does not exist"},
      {"7 2 0 2 1", "7 3 0 2 1 4", "m.mesh:14: face 1 of a physical group is a 4-node quadrangle"},
      {"elements\n2", "elements\n3", "m.mesh:12: expected an attribute, found 'boundary'"},
      {"elements\n2", "elements\n200", "m.mesh:8: the number of elements is 200, more than"},
      {"boundary", "elements", "m.mesh:12: elements are listed twice"},
      {"elements", "Elements", "m.mesh: the file has no elements"},
      {"vertices\n5\n3", "vertices\n5\n2", "m.mesh:20: the dimension is 2, not 3"},
      {"vertices\n5\n3", "vertices\n6\n3", "m.mesh:27: expected x, found 'mfem_mesh_end'"},
      {"vertices\n5\n3", "Vertices\n5\n3", "m.mesh: the file has no vertices"},
      {"mfem_mesh_end", "vertices\n1", "m.mesh:27: vertices are listed twice"},
      {"vertices\n5\n3", "vertices\n5\n\nnodes\n",
       "m.mesh:21: the mesh is curved, by nodes of a finite element space, which is not supported: "
       "save "
       "it with vertices alone"},
      {"1 1 1\n", "1 1 nan\n", "m.mesh:25: node 4: z is nan"},
  };
  assert_text_faults("m.mesh", mfem, sizeof table / sizeof *table, table);
  assert_prefixes_fail_cleanly("m.mesh", mfem, sizeof mfem - 1);
  assert_damage_fails_cleanly("m.mesh", mfem, sizeof mfem - 1);
}

static const char veg[] =
    "# a comment\n*VERTICES\n5 3 0 0\n1 0 0 0\n2 1 0 0 9\n3 0 1 0\n\n4 0 0 1\n5 1 1 1\n\n"
    "*ELEMENTS\nTET\n2 4 0\n1 1 2 3 4\n2 2 3 4 5\n\n"
    "*MATERIAL steel\nENU, 1000, 2e11, 0.3\n\n*SET both\n1,\n2\n*SET one\n2\n*REGION\none, steel\n";

static void vega_has_sets(void **state) {
  (void)state;
  corot_mesh *m = parse("m.veg", veg);
  assert_int_equal(m->ntet, 2);
  assert_int_equal(m->ngroup, 2);
  assert_group(m, "both", 5, 0, 2);
  assert_group(m, "one", 4, 0, 1);
  assert_int_equal(m->group[1].tet[0], 1);
  corot_mesh_destroy(m);
  m = parse(
      "m", "*VERTICES\n4 3\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n*ELEMENTS\nTETS\n1 4\n0 0 1 2 3\n");
  assert_int_equal(m->nnode, 4); /* from 0 */
  corot_mesh_destroy(m);
  assert_cut(
      "*VERTICES\n8 3 0 0\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 1\n7 1 1 1\n"
      "8 0 1 1\n*ELEMENTS\nCUBIC\n1 8 0\n1 1 2 3 4 5 6 7 8\n",
      6, 1);
}

static void faults_of_vega(void **state) {
  (void)state;
  static const text_fault table[] = {
      {"5 3 0 0", "5 2 0 0", "m.veg:3: the dimension is 2, not 3"},
      {"5 3 0 0", "500 3 0 0", "m.veg:3: the number of vertices is 500, more than"},
      {"5 3 0 0", "6 3 0 0", "m.veg:11: expected a vertex, found '*ELEMENTS'"},
      {"2 1 0 0 9", "1 1 0 0 9", "m.veg:5: node 1 is defined a second time"},
      {"2 4 0", "2 10 0",
       "m.veg:13: elements of 10 vertices: only tets of 4 are supported, and cubes"},
      {"2 4 0", "3 4 0", "m.veg:17: expected an element, found '*MATERIAL'"},
      {"2 2 3 4 5", "3 2 3 4 5", "m.veg:15: element 3 stands where 2 should"},
      {"1 1 2 3 4", "7 1 2 3 4", "m.veg:14: element 7 stands where 1 should"},
      {"2 2 3 4 5", "2 2 3 4 6", "m.veg:15: element 2: node 6 does not exist"},
      {"2 2 3 4 5", "2 3 2 4 5", "m.veg:15: element 2 is inverted"},
      {"one\n2\n", "one\n3\n", "m.veg:24: element 3 does not exist"},
      {"one\n2\n", "one\nx\n", "m.veg:24: expected an element, found 'x'"},
      {"*SET one", "*SET", "m.veg:23: a group needs a name"},
      {"*MATERIAL", "*INCLUDE",
       "m.veg:17: *INCLUDE is not supported: put the text of that file here"},
      {"*ELEMENTS", "*SET", "m.veg:11: a *SET stands before *ELEMENTS"},
      {"*ELEMENTS", "*VERTICES", "m.veg:11: *VERTICES are listed twice"},
      {"*MATERIAL", "*ELEMENTS", "m.veg:17: *ELEMENTS are listed twice"},
  };
  assert_text_faults("m.veg", veg, sizeof table / sizeof *table, table);
  assert_prefixes_fail_cleanly("m.veg", veg, sizeof veg - 1);
  assert_damage_fails_cleanly("m.veg", veg, sizeof veg - 1);
}

static corot_status try_parse(void *context) {
  const char *text = context;
  corot_mesh *m = NULL;
  corot_status status = corot_mesh_parse("m.veg", text, strlen(text), NULL, &m);
  corot_mesh_destroy(m);
  return status;
}

static void failed_allocations(void **state) {
  (void)state;
  assert_true(assert_survives_failed_allocations(try_parse, (void *)mfem) > 10);
  assert_true(assert_survives_failed_allocations(try_parse, (void *)veg) > 10);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(mfem_has_attributes), cmocka_unit_test(faults_of_mfem),
      cmocka_unit_test(vega_has_sets),       cmocka_unit_test(faults_of_vega),
      cmocka_unit_test(failed_allocations),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
