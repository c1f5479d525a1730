/* FEBio's files of the formats 2.5, 3.0 and 4.0, of curved tets too; and with faults. */
#include <stdio.h>

#include "alloc.h"
#include "check.h"
#include "mesh_text.h"

#define TEXT_SIZE 4000

static const char nodes[] =
    "  <Nodes name=\"all\">\n"
    "    <node id=\"1\">0,0,0</node>\n"
    "    <node id=\"2\"> 1.0 , 0, 0</node>\n"
    "    <node id=\"3\">0,1D0,0</node><!-- <node id=\"3\"> -->\n"
    "    <node id=\"5000000000\">0,0,\n1</node>\n"
    "    <node id=\"9\">1,1,1</node>\n"
    "  </Nodes>\n";

static const char format_2[] =
    "<?xml version=\"1.0\"?>\n"
    "<febio_spec version=\"2.5\">\n"
    " <Material><material id=\"1\"><Surface>x</Surface></material></Material>\n"
    " <Geometry>\n"
    "%s"
    "  <Elements type=\"TET4G1\" mat=\"1\">\n"
    "    <elem id=\"1\">1,2,3,5000000000</elem>\n"
    "  </Elements>\n"
    "  <Elements type=\"tet4\" mat=\"2\" name=\"upper\">\n"
    "    <elem id=\"2\">2,3,5000000000,9</elem>\n"
    "  </Elements>\n"
    "  <Elements type=\"tri3\" mat=\"3\" name=\"shell\"><elem id=\"7\">1,2,3</elem></Elements>\n"
    "  <NodeSet name=\"ends\"><node id=\"1\"/><node id=\"9\"/></NodeSet>\n"
    "  <ElementSet name=\"both\"><elem id=\"1\"/><elem id=\"2\"/><elem id=\"7\"/></ElementSet>\n"
    "  <Surface name=\"push\"><tri3 id=\"1\">1,2,3</tri3></Surface>\n"
    "  <SurfacePair name=\"pair\"><master surface=\"push\"/></SurfacePair>\n"
    " </Geometry>\n"
    " <Boundary><NodeSet name=\"elsewhere\"><node id=\"77\"/></NodeSet></Boundary>\n"
    "</febio_spec>\n";

static const char format_3[] =
    "<febio_spec version=\"3.0\">\n <Mesh>\n%s"
    "  <Elements type=\"tet4\" name=\"material-1\">\n"
    "    <elem id=\"1\">1,2,3,5000000000</elem>\n  </Elements>\n"
    "  <Elements type=\"tet4\" name=\"upper\">\n"
    "    <elem id=\"2\">2,3,5000000000,9</elem>\n  </Elements>\n"
    "  <NodeSet name=\"ends\"><n id=\"1\"/><n id=\"9\"/></NodeSet>\n"
    "  <ElementSet name=\"both\"><e id=\"1\"/><e id=\"2\"/></ElementSet>\n"
    "  <Surface name=\"push\"><tri3 id=\"1\">1,2,3</tri3></Surface>\n </Mesh>\n</febio_spec>\n";

static const char format_4[] =
    "<febio_spec version=\"4.0\">\n <Mesh>\n%s"
    "  <Elements type=\"tet4\" name=\"material-1\">\n"
    "    <elem id=\"1\">1,2,3,5000000000</elem>\n  </Elements>\n"
    "  <Elements type=\"tet4\" name=\"upper\">\n"
    "    <elem id=\"2\">2,3,5000000000,9</elem>\n  </Elements>\n"
    "  <NodeSet name=\"ends\">1,\n <!-- and --> 9</NodeSet>\n"
    "  <ElementSet name=\"both\">1:2</ElementSet>\n"
    "  <Surface name=\"push\"><tri3 id=\"1\">1,2,3</tri3></Surface>\n"
    "  <PartList name=\"parts\">upper,material-1</PartList>\n"
    " </Mesh>\n <MeshDomains><SolidDomain name=\"upper\" "
    "mat=\"m\"/></MeshDomains>\n</febio_spec>\n";

static const char *sound(const char *format) {
  static char text[TEXT_SIZE];
  snprintf(text, sizeof text, format, nodes);
  return text;
}

static void assert_group(const corot_mesh *m, const char *name, int nnode, int ntri, int ntet) {
  const corot_group *g = corot_mesh_find_group(m, name);
  if (!g) fail_msg("there is no group %s", name);
  assert_int_equal(g->nnode, nnode);
  assert_int_equal(g->ntri, ntri);
  assert_int_equal(g->ntet, ntet);
}

static void every_format_has_the_same_mesh(void **state) {
  (void)state;
  static const char *const formats[] = {format_2, format_3, format_4};
  static const int second[4] = {1, 2, 3, 4};
  for (int i = 0; i < 3; i++) {
    corot_mesh *m = parse_text(sound(formats[i]));
    assert_int_equal(m->nnode, 5);
    assert_int_equal(m->ntet, 2);
    assert_memory_equal(m->tet[1], second, sizeof second);
    assert_true(m->x[2][1] == 1 && m->x[3][2] == 1);
    assert_group(m, "all", 5, 0, 0);
    assert_group(m, "material-1", 4, 0, 1);
    assert_group(m, "upper", 4, 0, 1);
    assert_group(m, "ends", 2, 0, 0);
    assert_group(m, "both", 5, 0, 2);
    assert_group(m, "push", 3, 1, 0);
    assert_int_equal(m->ngroup, 6);
    corot_mesh_destroy(m);
  }
}

/* The volume of tets with curved edges depends on the order of the nodes on them. */
static void curved_bodies_are_those_of_gmsh(void **state) {
  (void)state;
  corot_mesh *a = read_mesh(DATA "quarter.feb"), *b = read_mesh(DATA "quarter.msh");
  assert_int_equal(corot_mesh_order(a), 2);
  assert_int_equal(a->ntet, b->ntet);
  assert_close(corot_mesh_measure(a).volume, corot_mesh_measure(b).volume, 1e-12, 0);
  assert_group(a, "round", corot_mesh_find_group(b, "round")->nnode,
               corot_mesh_find_group(b, "round")->ntri, 0);
  corot_mesh_destroy(a);
  corot_mesh_destroy(b);
}

/* A hexahedron, and a quad at its bottom. */
static void other_solids_are_cut(void **state) {
  (void)state;
  static const char text[] =
      "<febio_spec version=\"3.0\"><Mesh><Nodes><node id=\"1\">0,0,0</node><node id=\"2\">1,0,0"
      "</node><node id=\"3\">1,1,0</node><node id=\"4\">0,1,0</node><node id=\"5\">0,0,1</node>"
      "<node id=\"6\">1,0,1</node><node id=\"7\">1,1,1</node><node id=\"8\">0,1,1</node></Nodes>"
      "<Elements type=\"hex8\" name=\"cube\"><elem id=\"1\">1,2,3,4,5,6,7,8</elem></Elements>"
      "<Surface name=\"bottom\"><quad4 id=\"1\">1,4,3,2</quad4></Surface></Mesh></febio_spec>";
  corot_mesh_report report = {0};
  const corot_reading how = {.mends = true, .cuts = true, .report = &report};
  corot_mesh *m = NULL;
  assert_fails(corot_mesh_parse("m.feb", text, strlen(text), NULL, &m), COROT_EFORMAT,
               "m.feb: the file has 1 hexahedron beside 0 tets: only tets are supported");
  assert_ok(corot_mesh_parse("m.feb", text, strlen(text), &how, &m));
  assert_close(corot_mesh_measure(m).volume, 1, 1e-14, 0);
  assert_group(m, "bottom", 4, 2, 0);
  corot_mesh_destroy(m);
  for (int i = 0; i < report.nremark; i++) free(report.remark[i].text);
  free(report.remark);
}

static void faults(void **state) {
  (void)state;
  static const text_fault table[] = {
      {"<node id=\"2\">", "<node>", "m.feb:7: <node> has no id"},
      {"<node id=\"2\">", "<node id=\"-2\">", "m.feb:7: node: id is '-2', not a whole number"},
      {"id=\"2\"> 1.0 ", "id=\"1\"> 1.0 ", "m.feb:7: node 1 is defined a second time"},
      {"> 1.0 , 0, 0<", "> 1.0 , 0<", "m.feb:7: expected z, found a tag"},
      {"> 1.0 , 0, 0<", "> 1.0 , 0, 0, 0<", "m.feb:7: node 2 has more numbers than it should"},
      {"> 1.0 , 0, 0<", "> 1.0 , nan, 0<", "m.feb:7: node 2: y is nan"},
      {"> 1.0 , 0, 0<", "> a , 0, 0<", "m.feb:7: expected x, found 'a'"},
      {"TET4G1", "tet15", "m.feb:13: elements of type 'tet15': only tet4 and tet10 are supported"},
      {"TET4G1", "tet4x", "m.feb:13: elements of type 'tet4x': only"},
      {"1,2,3,5000000000<", "1,2,3<", "m.feb:14: expected a node, found a tag"},
      {"1,2,3,5000000000<", "1,2,3,4,5<", "m.feb:14: element 1 has more numbers than it should"},
      {"1,2,3,5000000000<", "1,2,3,4<", "m.feb:14: element 1: node 4 does not exist"},
      {"1,2,3,5000000000<", "1,3,2,5000000000<", "m.feb:14: element 1 is inverted"},
      {"<elem id=\"2\">2", "<elem id=\"1\">2", "m.feb:17: element 1 is defined a second time"},
      {"<node id=\"9\"/>", "<node id=\"8\"/>", "m.feb:20: ends: node 8 does not exist"},
      {"<elem id=\"7\"/>", "<elem id=\"6\"/>", "m.feb:21: both: element 6 does not exist"},
      {"<node id=\"9\"/>", "<node_list>1</node_list>",
       "m.feb:20: <node_list> in a <NodeSet> is not supported: its members must be listed"},
      {"NodeSet name=\"ends\"", "NodeSet", "m.feb:20: <NodeSet> has no name"},
      {"<tri3 id=\"1\">1,2,3", "<tri3 id=\"1\">1,2,9",
       "m.feb:22: face 1: the triangle is no face of a tet"},
      {"<tri3 id=\"1\">1,2,3</tri3>", "<faces>1</faces>",
       "m.feb:22: <faces> in a <Surface> is not supported"},
      {"<Elements type=\"tet4\" mat=\"2\"", "<Part name=\"p\"/><Elements type=\"tet4\" mat=\"2\"",
       "m.feb:16: the mesh is made of parts and instances of them"},
      {"<Geometry>", "<Geometry from=\"other.feb\">",
       "m.feb:4: the mesh is in another file: read other.feb"},
      {"<Geometry>", "<Geo>", "m.feb: the file has no Nodes in a Mesh or Geometry"},
  };
  assert_text_faults("m.feb", sound(format_2), sizeof table / sizeof *table, table);
}

static void lists_may_have_steps(void **state) {
  (void)state;
  char *text = edit_text(sound(format_4), "1,\n <!-- and --> 9", "1:9:2, 2");
  corot_mesh *m = parse_text(text);
  assert_group(m, "ends", 4, 0, 0);
  corot_mesh_destroy(m);
  free(text);
  m = NULL;
  text = edit_text(sound(format_4), "1:2<", "2:1<");
  assert_fails(corot_mesh_parse("m.feb", text, strlen(text), NULL, &m), COROT_EFORMAT,
               "m.feb:19: from 2 to 1 by 1 is no range");
  free(text);
}

static void damage(void **state) {
  (void)state;
  const char *text = sound(format_4);
  assert_prefixes_fail_cleanly("m.feb", text, strlen(text));
  assert_damage_fails_cleanly("m.feb", text, strlen(text));
}

static void failed_allocations(void **state) {
  (void)state;
  assert_true(assert_survives_failed_allocations(try_read, (void *)(DATA "quarter.feb")) > 30);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_format_has_the_same_mesh),
      cmocka_unit_test(curved_bodies_are_those_of_gmsh),
      cmocka_unit_test(other_solids_are_cut),
      cmocka_unit_test(faults),
      cmocka_unit_test(lists_may_have_steps),
      cmocka_unit_test(damage),
      cmocka_unit_test(failed_allocations),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
