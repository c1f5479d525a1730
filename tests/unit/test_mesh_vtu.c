/* VTK's XML files and Netgen's as meshio writes them, and VTK's in all their encodings, see
   data/make; and with faults. */
#include "alloc.h"
#include "check.h"
#include "core/mesh/read/inflate.h"
#include "mesh_text.h"
#include "temporary.h"

static const char *const encoded[] = {
    DATA "encoded.ascii.vtu",  DATA "encoded.binary.big.vtu",   DATA "encoded.zlib.vtu",
    DATA "encoded.raw.vtu",    DATA "encoded.raw.zlib.big.vtu", DATA "encoded.base64.vtu",
    DATA "encoded.stored.vtu", DATA "encoded.base64.zlib.vtu",  DATA "encoded.binary.vtu"};
enum { NENCODED = sizeof encoded / sizeof *encoded };

static void assert_same(const corot_mesh *a, const corot_mesh *b, double tolerance) {
  assert_int_equal(a->nnode, b->nnode);
  assert_int_equal(a->ntet, b->ntet);
  for (int i = 0; i < 3 * a->nnode; i++)
    assert_close(a->x[i / 3][i % 3], b->x[i / 3][i % 3], 0, tolerance);
  assert_memory_equal(a->tet, b->tet, (size_t)a->ntet * sizeof *a->tet);
  assert_int_equal(a->ngroup, b->ngroup);
  for (int g = 0; g < a->ngroup; g++) {
    assert_string_equal(a->group[g].name, b->group[g].name);
    assert_int_equal(a->group[g].nnode, b->group[g].nnode);
    assert_int_equal(a->group[g].ntri, b->group[g].ntri);
    assert_int_equal(a->group[g].ntet, b->group[g].ntet);
  }
}

/* To the last bit, but for the last, which has floats. */
static void every_encoding_is_the_same_mesh(void **state) {
  (void)state;
  corot_mesh *a = read_mesh(encoded[0]);
  assert_int_equal(a->ntet, 3);
  assert_close(a->x[5][0], 1. / 3, 0, 0);
  assert_int_equal(corot_mesh_find_group(a, "a b")->ntet, 1);
  assert_int_equal(corot_mesh_find_group(a, "skin")->ntri, 2);
  assert_int_equal(corot_mesh_find_group(a, "tip")->node[0], 5);
  for (int i = 1; i < NENCODED; i++) {
    corot_mesh *b = read_mesh(encoded[i]);
    assert_same(a, b, i + 1 == NENCODED ? 1e-7 : 0);
    corot_mesh_destroy(b);
  }
  corot_mesh_destroy(a);
}

/* Curved tets, whose volume depends on the order of the nodes on edges, and solids that are cut. */
static void bodies_are_those_of_legacy_files(void **state) {
  (void)state;
  corot_mesh *a = read_mesh(DATA "quarter.vtk"), *b = read_mesh(DATA "quarter.vtu"),
             *c = read_mesh(DATA "quarter.vol");
  assert_same(a, b, 0);
  assert_memory_equal(a->mid, b->mid, (size_t)a->ntet * sizeof *a->mid);
  assert_int_equal(c->ntet, a->ntet);
  assert_int_equal(c->nnode, a->nnode);
  assert_close(corot_mesh_measure(c).volume, corot_mesh_measure(a).volume, 1e-14, 0);
  assert_int_equal(corot_mesh_find_group(c, "cd0_1")->ntet, a->ntet);
  assert_int_equal(corot_mesh_find_group(c, "cd1_1")->nnode, a->group[0].nnode);
  corot_mesh_destroy(a);
  corot_mesh_destroy(b);
  corot_mesh_destroy(c);

  corot_mesh_report *r;
  assert_ok(corot_mesh_read_mended(DATA "cells.vol", &(corot_mending){.cut = 1}, &a, &r));
  assert_int_equal(a->ntet, 247);
  assert_close(corot_mesh_measure(a).volume, 2.5, 1e-13, 0);
  assert_int_equal(r->remark[0].count, 140);
  corot_mesh_report_destroy(r);
  corot_mesh_destroy(a);
}

/* --- VTK --- */

static const char sound[] =
    "<?xml version='1.0'?>\n<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\">\n"
    "<UnstructuredGrid><Piece NumberOfPoints=\"5\" NumberOfCells=\"3\">\n"
    "<CellData Scalars=\"a > b\"><DataArray type=\"Int32\" Name=\"gmsh:physical\" "
    "format=\"ascii\">\n"
    "7 7 8</DataArray></CellData>\n"
    "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" Name='p &amp; q' "
    "format=\"ascii\">\n"
    "0 0 0 1 0 0\n0 1 0 0 0 1 1 1 1</DataArray></Points>\n"
    "<Cells><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">\n"
    "0 1 2 3 1 2 3 4 0 1 3</DataArray>\n"
    "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">4 8 11</DataArray>\n"
    "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">10 10 5</DataArray></Cells>\n"
    "</Piece></UnstructuredGrid></VTKFile>\n";

static void faults_of_vtu(void **state) {
  (void)state;
  static const text_fault table[] = {
      {"\"UnstructuredGrid\"", "\"PolyData\"",
       "m.vtu:2: the file is of type 'PolyData': only an UnstructuredGrid has tets"},
      {"byte_order", "compressor=\"vtkLZ4DataCompressor\" byte_order",
       "m.vtu:2: the data are compressed by vtkLZ4DataCompressor: only vtkZLibDataCompressor is"},
      {"</Piece>", "</Piece><Piece/>",
       "m.vtu:13: the file has several pieces: merge them into one"},
      {"\"5\"", "\"6\"", "m.vtu:6: array p & q has 15 numbers, not 18"},
      {"\"5\"", "\"five\"", "m.vtu:3: Piece: NumberOfPoints is 'five', not a whole number"},
      {"\"5\"", "\"9999999999\"", "m.vtu:3: 9999999999 points and 3 cells are too many"},
      {"NumberOfCells=\"3\"", "NumberOfCells=\"2\"", "array gmsh:physical has 3 numbers, not 2"},
      {"Float64", "Float16", "m.vtu:6: array p & q: the type 'Float16' is not known"},
      {"Float64", "Int32", "m.vtu:6: array p & q: it is of whole numbers"},
      {"\"Int64\" Name=\"c", "\"Float64\" Name=\"c",
       "m.vtu:9: array connectivity: it is of reals, not of whole numbers"},
      {"<Points>", "<Point>", "m.vtu: the file lacks Points"},
      {"\"offsets\"", "\"ends\"", "m.vtu: the file lacks offsets"},
      {"4 8 11", "4 3 11", "m.vtu:11: cell 1: its offset is 3"},
      {"4 8 11", "4 8 12", "m.vtu:11: cell 2: its offset is 12"},
      {"1 2 3 4 0", "1 2 3 5 0", "m.vtu:11: element 1: node 5 does not exist"},
      {"1 1 1<", "1 1 one<", "m.vtu:8: expected a number, found 'one'"},
      {"1 1 1<", "1 1 nan<", "m.vtu:6: node 4: z is nan"},
      {"10 10 5", "10 25 5", "m.vtu:11: cell 1 is a solid of type 25: only tets of 4 or 10 nodes"},
      {"10 10 5", "10 12 5", "m.vtu:11: cell 1 has 4 nodes, but is of type 12"},
      {"Name=\"types\" format=\"ascii\"", "Name=\"types\" format=\"text\"",
       "m.vtu:12: array types: the format is 'text', not ascii, binary or appended"},
      {"Name=\"types\" format=\"ascii\"", "Name=\"types\" format=\"appended\"",
       "m.vtu:12: array types: there are no appended data"},
      {"Name=\"types\" format=\"ascii\">10 10 5", "Name=\"types\" format=\"binary\">AwAAAAoK????",
       "m.vtu:12: array types: the data are cut off, or no base64"},
      {"Name=\"types\" format=\"ascii\">10 10 5", "Name=\"types\" format=\"binary\">////fwoK",
       "m.vtu:12: array types: the data are longer than the file"},
      {"Name=\"types\" format=\"ascii\">10 10 5",
       "Name=\"types\" format=\"binary\">AwA=", "m.vtu:12: array types: the data are cut off"},
      {"</VTKFile>", "<AppendedData encoding=\"raw\">", "m.vtu:13: AppendedData have no beginning"},
      {"</VTKFile>", "<AppendedData encoding=\"hex\">_",
       "m.vtu:13: AppendedData: the encoding is 'hex', not base64 or raw"},
      {"</VTKFile>", "<a b=\"", "m.vtu:13: a tag has no end"},
  };
  assert_text_faults("m.vtu", sound, sizeof table / sizeof *table, table);
}

static void damaged_vtu(void **state) {
  (void)state;
  assert_prefixes_fail_cleanly("m.vtu", sound, sizeof sound - 1);
  assert_damage_fails_cleanly("m.vtu", sound, sizeof sound - 1);
  for (int i = 1; i < NENCODED; i += 2) {
    size_t size;
    char *text = slurp(encoded[i], &size);
    assert_prefixes_fail_cleanly("e.vtu", text, size);
    assert_damage_fails_cleanly("e.vtu", text, size);
    free(text);
  }
}

/* "hello hello hello hello\n" by zlib; what is damaged is noticed, by the sum at the latest. */
static void inflation(void **state) {
  (void)state;
  static const unsigned char packed[] = {0x78, 0x9c, 0xcb, 0x48, 0xcd, 0xc9, 0xc9, 0x57, 0xc8,
                                         0x40, 0x27, 0xb9, 0x00, 0x70, 0xbe, 0x08, 0xbb};
  unsigned char text[25], copy[sizeof packed];
  assert_true(corot_inflate(packed, sizeof packed, text, 24));
  assert_memory_equal(text, "hello hello hello hello\n", 24);
  assert_false(corot_inflate(packed, sizeof packed, text, 23));
  assert_false(corot_inflate(packed, sizeof packed, text, 25));
  for (size_t n = 0; n < sizeof packed; n++) assert_false(corot_inflate(packed, n, text, 24));
  for (size_t at = 0; at < sizeof packed; at++)
    for (int bit = 0; bit < 8; bit++) {
      memcpy(copy, packed, sizeof copy);
      copy[at] ^= (unsigned char)(1 << bit);
      bool whole = corot_inflate(copy, sizeof copy, text, 24);
      assert_true(!whole || memcmp(text, "hello hello hello hello\n", 24) == 0);
    }
}

/* --- Netgen --- */

static const char netgen[] =
    "# a comment\nmesh3d\n\ndimension\n3\n\ngeomtype\n11\n\n# surfnr bcnr domin domout np p1 p2 "
    "p3\n"
    "surfaceelementsgi\n2\n3 2 1 0 3 1 3 2 9 9 9\n3 1 1 0 3 1 2 4 1 1 1\n\n"
    "# matnr np p1 p2 p3 p4\nvolumeelements\n2\n1 4 1 3 2 4\n2 4 2 4 3 5\n\n"
    "edgesegmentsgi2\n1\n1 0 1 2 0 0 1 1 1 0 1 1\n\n"
    "points\n5\n0 0 0\n1 0 0\n 0 1 0\n0 0 1\n1 1 1\n\n"
    "materials\n1\n1 steel # 5\n\nbcnames\n2\n1 default\n2 hot side\n\n\nendmesh\n\n\nrubbish";

static void netgen_has_names(void **state) {
  (void)state;
  static const struct {
    const char *name;
    int ntri, ntet;
  } groups[] = {{"steel # 5", 0, 1}, {"default", 1, 0}, {"hot side", 1, 0}, {"2", 0, 1}};
  corot_mesh *m = NULL;
  assert_ok(corot_mesh_parse("m.vol", netgen, strlen(netgen), NULL, &m));
  assert_int_equal(m->ntet, 2);
  assert_memory_equal(m->tet[0], ((int[]){0, 1, 2, 3}), sizeof *m->tet);
  assert_int_equal(m->ngroup, 4);
  for (int i = 0; i < 4; i++) {
    const corot_group *g = corot_mesh_find_group(m, groups[i].name);
    assert_non_null(g);
    assert_int_equal(g->ntri, groups[i].ntri);
    assert_int_equal(g->ntet, groups[i].ntet);
  }
  corot_mesh_destroy(m);
}

static void faults_of_netgen(void **state) {
  (void)state;
  static const text_fault table[] = {
      {"points\n5", "points\n500", "m.vol:27: the number of points is 500, more than"},
      {"points\n5", "points\n6", "m.vol:34: expected x, found 'materials'"},
      {"points", "Points", "m.vol: the file has no points"},
      {"volumeelements", "elements", "m.vol: the file has no volumeelements"},
      {"volumeelements\n2", "volumeelements\n3",
       "m.vol:22: expected the number of a material, found"},
      {"\nendmesh", "\npoints\n1\n", "points are listed twice"},
      {"\nendmesh", "\nvolumeelements\n1\n", "elements are listed twice"},
      {"2 4 2 4 3 5", "2 4 2 4 3 6", "m.vol:20: element 2: node 6 does not exist"},
      {"2 4 2 4 3 5", "2 4 2 3 4 5", "m.vol:20: element 2 is inverted"},
      {"2 4 2 4 3 5", "2 20 2 4 3 5",
       "m.vol:20: element 2 is a solid of 20 nodes: only tets of 4 or 10 nodes are supported, and "
       "other "
       "solids of first order, to be cut into tets"},
      {"3 1 3 2 9", "3 1 3 5 9", "m.vol:13: face 1: the triangle is no face of a tet"},
      {"3 1 3 2 9", "4 1 3 2 4", "m.vol:13: face 1 of a physical group is a 4-node quadrangle"},
      {"1 1 1\n\nmat", "1 1 inf\n\nmat", "m.vol:32: node 5: z is inf"},
  };
  assert_text_faults("m.vol", netgen, sizeof table / sizeof *table, table);
  assert_prefixes_fail_cleanly("m.vol", netgen, sizeof netgen - 1);
  assert_damage_fails_cleanly("m.vol", netgen, sizeof netgen - 1);
}

static void failed_allocations(void **state) {
  (void)state;
  assert_true(assert_survives_failed_allocations(try_read, (void *)(DATA "quarter.vtu")) > 20);
  assert_true(assert_survives_failed_allocations(try_read, (void *)(DATA "encoded.raw.vtu")) > 20);
  assert_true(assert_survives_failed_allocations(try_read, (void *)(DATA "quarter.vol")) > 10);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_encoding_is_the_same_mesh),
      cmocka_unit_test(bodies_are_those_of_legacy_files),
      cmocka_unit_test(faults_of_vtu),
      cmocka_unit_test(damaged_vtu),
      cmocka_unit_test(inflation),
      cmocka_unit_test(netgen_has_names),
      cmocka_unit_test(faults_of_netgen),
      cmocka_unit_test(failed_allocations),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
