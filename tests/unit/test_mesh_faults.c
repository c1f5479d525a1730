/* Mesh files that are damaged, truncated or hostile: a message with the place, no crash. */
#include "check.h"
#include "core/mesh/read/mesh_read.h"
#include "mesh_text.h"
#include "temporary.h"

/* An edit of a sound file and the message it leads to. */
typedef struct fault {
  const char *from, *to, *message;
} fault;

static void assert_faults(const char *sound, size_t n, const fault *faults) {
  corot_mesh *m = NULL;
  assert_ok(corot_gmsh_parse("bad.msh", sound, strlen(sound), NULL, &m));
  corot_mesh_destroy(m);
  m = NULL;
  for (size_t i = 0; i < n; i++) {
    char *text = edit_text(sound, faults[i].from, faults[i].to);
    assert_fails(corot_gmsh_parse("bad.msh", text, strlen(text), NULL, &m), COROT_EFORMAT,
                 faults[i].message);
    assert_null(m);
    free(text);
  }
}

static const char sound_1[] =
    "$NOD\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$ENDNOD\n"
    "$ELM\n1\n7 4 1 1 4 1 2 3 4\n$ENDELM\n";

static void faults_of_format_1(void **state) {
  (void)state;
  static const fault faults[] = {
      {"7 4 1 1 4 1", "7 4 1 1 3 1", "bad.msh:10: element 7 has 3 nodes, but is a 4-node tet"},
      {"7 4 1 1 4 1", "7 5 1 1 8 1 1 1 1 1",
       "bad.msh: the file has 1 hexahedron beside 0 tets: only tets are supported; mesh.cut: true "
       "of "
       "a scenario, or --cut of corot mesh convert, cuts them into tets"},
      {"7 4 1 1 4 1", "7 17 1 1 20 1",
       "bad.msh:10: element 7 is a 20-node hexahedron: only tets of 4 or 10 nodes are supported, "
       "and "
       "other solids of first order, to be cut into tets"},
      {"$ENDELM", "$NOD", "bad.msh:11: expected $ENDELM, found '$NOD'"},
      {"$ENDELM\n", "$ENDELM\n$ELM\n0\n$ENDELM\n", "bad.msh:13: elements are listed twice"},
      {"$ENDELM\n", "$ENDELM\n$NOD\n0\n$ENDNOD\n", "bad.msh:13: nodes are listed twice"},
      {"$NOD\n4", "$ELM\n4", "bad.msh:2: elements are listed before nodes"},
      {"$NOD", "$NODES", "bad.msh:1: the section $NODES has no end"},
      {"$ELM", "$ELMS", "bad.msh:8: the section $ELMS has no end"},
  };
  assert_faults(sound_1, sizeof faults / sizeof *faults, faults);
}

static void a_node_in_no_tet_may_be_the_centre_of_an_arc(void **state) {
  (void)state;
  static const char text[] =
      "$NOD\n5\n9 5 5 5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$ENDNOD\n"
      "$ELM\n2\n7 4 0 1 4 1 2 3 4\n8 15 0 1 1 9\n$ENDELM\n";
  corot_mesh *m;
  assert_fails(corot_gmsh_parse("bad.msh", text, strlen(text), NULL, &m), COROT_EFORMAT,
               "bad.msh:3: node 9 is in no tet; with a physical group for the volume, gmsh");
}

static const char sound_2[] =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
    "$PhysicalNames\n2\n3 1 \"body\"\n2 4 \"skin\"\n$EndPhysicalNames\n"
    "$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n50 1 1 1\n$EndNodes\n"
    "$Elements\n3\n11 4 2 1 1 1 2 3 4\n12 4 2 1 1 2 3 4 50\n13 2 2 4 1 2 3 50\n$EndElements\n";

static void faults_of_format_2_syntax(void **state) {
  (void)state;
  static const fault faults[] = {
      {"2.2 0 8", "4.2 0 8", "bad.msh:2: gmsh format 4.2 is not supported: save it as 4.1 or 2.2"},
      {"2.2 0 8", "4 1 8", "bad.msh:2: format 4.0 is supported in ASCII only: save it as 4.1"},
      {"2.2 0 8", "two 0 8", "bad.msh:2: expected the version of the format, found 'two'"},
      {"2.2 0 8", "2.2 2 8", "the file type is 2, not 0 (ASCII) or 1 (binary)"},
      {"2.2 0 8", "2.2 0 4", "bad.msh:2: the size of a number is 4, not 8 bytes"},
      {"$EndMeshFormat\n", "$EndMeshFormat\n$MeshFormat\n", "a second file begins here"},
      {"$EndPhysicalNames\n", "$EndPhysicalNames\nrubbish\n",
       "bad.msh:9: expected a section that begins with $"},
      {"3 1 \"body\"", "4 1 \"body\"", "bad.msh:6: there is no physical group 1 of dimension 4"},
      {"3 1 \"body\"", "3 1 body", "bad.msh:6: expected a name in double quotes"},
      {"3 1 \"body\"", "3 1 \"body", "bad.msh:6: the name has no closing quote"},
      {"3 1 \"body\"", "3 1 \"\"", "bad.msh:6: a group needs a name"},
      {"3 1 \"body\"", "3 1 \"bo\tdy\"", "bad.msh:6: group 'bo"},
      {"3 1 \"body\"", "2 4 \"body\"",
       "bad.msh: physical group 4 of dimension 2 is named 'body' and 'skin'"},
      {"$PhysicalNames\n2", "$PhysicalNames\n-2", "bad.msh:5: the number of names is -2"},
      {"$Nodes\n5", "$Nodes\n-5", "bad.msh:10: the number of nodes is -5"},
      {"$Nodes\n5", "$Nodes\n2000000000",
       "bad.msh:10: the number of nodes is 2000000000, more than the rest of the file can hold"},
      {"$Nodes\n5", "$Nodes\n99999999999999999999", "the number of nodes is too large"},
      {"$Nodes\n5", "$Nodes\n9223372036854775808", "the number of nodes is too large"},
      {"$Nodes\n5", "$Nodes\n4", "bad.msh:15: expected $EndNodes, found '50'"},
      {"$Nodes\n5", "$Nodes\n6", "bad.msh:16: expected a node, found '$EndNodes'"},
      {"$Nodes\n5", "$Nodes\n5.0", "bad.msh:10: expected the number of nodes, found '5.0'"},
      {"$Nodes\n5\n", "$Nodes\n5 5\n", "bad.msh:10: '5' is too much on this line"},
      {"3 0 1 0\n", "3 0 1\n", "bad.msh:13: expected z, found the end of the line"},
      {"3 0 1 0\n", "3 0 1 0 0\n", "bad.msh:13: '0' is too much on this line"},
      {"3 0 1 0\n", "3 0 1x 0\n", "bad.msh:13: expected y, found '1x'"},
      {"3 0 1 0\n", "3 0 1,5 0\n", "bad.msh:13: expected y, found '1,5'"},
      {"3 0 1 0\n", "3 0 \x01\x80 0\n", "bad.msh:13: expected y, found '?\?'"},
      {"$Elements\n3", "$Elements\n-3", "bad.msh:18: the number of elements is -3"},
      {"$Elements\n3", "$Elements\n300", "bad.msh:18: the number of elements is 300, more than"},
      {"$Elements\n3", "$Elements\n2", "bad.msh:21: expected $EndElements, found '13'"},
      {"$Elements\n3", "$Elements\n4", "bad.msh:22: expected an element, found '$EndElements'"},
      {"12 4 2 1 1 2 3", "12 4 -2 1 1 2 3", "bad.msh:20: element 12 has -2 tags"},
      {"12 4 2 1 1 2 3 4 50", "12 4 2 1 1 2 3 4", "bad.msh:20: expected a node, found the end"},
      {"12 4 2 1 1 2 3 4 50", "12 4 2 1 1 2 3 4 50 1", "bad.msh:20: '1' is too much"},
      {"12 4 2 1 1 2 3 4 50", "12 4 2 1 1 2 3 4 3000000000", "node 3000000000 does not exist"},
      {"12 4 2 1 1 2 3 4 50", "12 4 2 1 1 2 3 4 30000000000000000000",
       "a node is too large: '3000"},
      {"12 4 2", "12 99 2", "bad.msh:20: element 12 is of type 99, which is unknown"},
      {"$Elements", "$elements", "bad.msh:17: the section $elements has no end"},
      {"$EndElements\n", "$EndElements\n$EndElements\n", "bad.msh:23: the section"},
      {"$EndNodes\n", "$EndNodes $Elements\n", "bad.msh:16: '$Elements' is too much on this line"},
  };
  assert_faults(sound_2, sizeof faults / sizeof *faults, faults);
}

static void faults_of_format_2_content(void **state) {
  (void)state;
  static const fault faults[] = {
      {"50 1 1 1\n", "2 1 1 1\n", "bad.msh:15: node 2 is defined a second time"},
      {"50 1 1 1\n", "-5 1 1 1\n", "bad.msh:15: node -5: the number of a node may not be negative"},
      {"50 1 1 1\n", "50 1D 1 1\n", "bad.msh:15: expected x, found '1D'"},
      {"50 1 1 1\n", "50 1D1x 1 1\n", "bad.msh:15: expected x, found '1D1x'"},
      {"50 1 1 1\n", "50 1 nan 1\n", "bad.msh:15: node 50: y is nan"},
      {"50 1 1 1\n", "50 -inf 1 1\n", "bad.msh:15: node 50: x is -inf"},
      {"50 1 1 1\n", "50 1 1 1e999\n", "bad.msh:15: node 50: z is inf"},
      {"2 3 4 50\n", "2 3 4 99\n", "bad.msh:20: element 12: node 99 does not exist"},
      {"2 3 4 50\n", "2 3 4 -1\n", "bad.msh:20: element 12: node -1 does not exist"},
      {"2 3 4 50\n", "2 3 4 2\n", "bad.msh:20: element 12 has node 2 twice"},
      {"2 3 4 50\n", "2 4 3 50\n", "bad.msh:20: element 12 is inverted: its volume is -0.33"},
      {"50 1 1 1\n", "50 1 0 0\n", "bad.msh:20: element 12 is flat: its volume is 0"},
      {"2 3 4 50\n", "1 2 3 4\n", "bad.msh:15: node 50 is in no tet"},
      {"$Elements\n3\n", "$Elements\n4\n14 4 2 1 1 2 1 3 4\n",
       "bad.msh:19: element 14 is inverted"},
      {"$Elements\n3\n", "$Elements\n4\n14 4 2 1 1 2 3 4 50\n",
       "bad.msh:21: elements 14 and 12 have the same nodes"},
      {"$Elements\n3\n", "$Elements\n4\n14 4 2 0 1 2 3 4 50\n",
       "bad.msh:21: elements 14 and 12 have the same nodes"},
      {"13 2 2 4 1 2 3 50", "13 2 2 4 1 1 2 50", "element 13: the triangle is no face of a tet"},
      {"13 2 2 4 1 2 3 50", "13 2 2 4 1 3 3 50", "element 13: the triangle is no face of a tet"},
      {"13 2 2 4 1 2 3 50", "13 9 2 4 1 2 3 50 1 2 4",
       "bad.msh:21: element 13 of a physical group is a 6-node triangle"},
      {"13 2 2 4 1 2 3 50", "13 3 2 4 1 2 3 50 1",
       "bad.msh:21: element 13 of a physical group is a 4-node quadrangle"},
      {"11 4 2 1 1 1 2 3 4", "11 11 2 1 1 1 2 3 4 1 2 3 4 1 2",
       "bad.msh:20: element 12 is a tet of 4 nodes, the tets before it have 10: orders do not mix"},
      {"$Elements\n3\n11 4 2 1 1 1 2 3 4\n12 4 2 1 1 2 3 4 50\n", "$Elements\n1\n",
       "bad.msh: the mesh has no tets"},
  };
  assert_faults(sound_2, sizeof faults / sizeof *faults, faults);
}

static void tets_of_several_groups_are_one(void **state) {
  (void)state;
  corot_mesh *m;
  char *text = edit_text(sound_2, "$Elements\n3\n", "$Elements\n4\n14 4 2 6 1 2 3 4 50\n");
  assert_ok(corot_gmsh_parse("good.msh", text, strlen(text), NULL, &m));
  assert_int_equal(m->ntet, 2);
  assert_int_equal(m->tet[0][0], 1); /* where it is first */
  assert_int_equal(corot_mesh_find_group(m, "6")->ntet, 1);
  assert_int_equal(corot_mesh_find_group(m, "body")->ntet, 2);
  corot_mesh_destroy(m);
  free(text);
}

static const char sound_4[] =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
    "$Entities\n1 0 1 1\n5 0 0 0 1 3 \n6 0 0 0 1 1 1 1 -2 0 \n8 0 0 0 1 1 1 2 1 3 1 6 \n"
    "$EndEntities\n"
    "$Nodes\n2 4 1 4\n0 5 0 1\n1\n0 0 0\n3 8 0 3\n2\n3\n4\n1 0 0\n0 1 0\n0 0 1\n$EndNodes\n"
    "$Elements\n3 3 1 3\n0 5 15 1\n1 1\n2 6 2 1\n2 1 2 3\n3 8 4 1\n3 1 2 3 4\n$EndElements\n";

static void faults_of_format_4(void **state) {
  (void)state;
  static const fault faults[] = {
      {"$MeshFormat\n4.1", "$MeshFormat\n4.0", "bad.msh:6: expected an entity's place, found the"},
      {"1 0 1 1\n", "1 0 1 -1\n", "bad.msh:5: a number of entities is -1"},
      {"1 0 1 1\n", "1 0 1 9999\n", "bad.msh:5: a number of entities is 9999, more than"},
      {"1 0 1 1\n", "1 0 1 2\n", "bad.msh:9: expected an entity, found '$EndEntities'"},
      {"5 0 0 0 1 3", "5 0 0 0 2 3", "bad.msh:6: expected a physical group, found the end"},
      {"5 0 0 0 1 3", "5 0 0 0 -1 3", "an entity's number of physical groups is -1"},
      {"1 -2 0 ", "1 -2 3 1 ", "bad.msh:7: expected an entity around an entity, found the end"},
      {"$EndEntities\n", "$EndEntities\n$Entities\n0 0 0 0\n$EndEntities\n",
       "entities are listed twice"},
      {"$EndElements\n", "$EndElements\n$Elements\n0 0 0 0\n$EndElements\n",
       "elements are listed twice"},
      {"$EndEntities", "$EndEntities\n$PartitionedEntities\n$EndPartitionedEntities",
       "bad.msh:11: expected the number of partitions, found '$EndPartitionedEntities'"},
      {"$EndEntities", "$EndEntities\n$PartitionedEntities\n1\n99\n",
       "bad.msh:12: the number of ghost entities is 99, more than"},
      {"$EndEntities", "$EndEntities\n$PartitionedEntities\n1\n0\n0 0 0 1\n8 3 1 2 1 ",
       "bad.msh:14: expected a partition, found the end of the line"},
      {"$EndEntities",
       "$EndEntities\n$PartitionedEntities\n1\n0\n0 0 0 1\n8 3 1 1 1 0 0 0 1 1 1 0 0\n",
       "entity 8 of dimension 3 is listed twice"},
      {"2 4 1 4", "2 3 1 4", "a block of 3 nodes where 2 are left"},
      {"2 4 1 4", "2 5 1 4", "the blocks have 4 nodes, not 5"},
      {"2 4 1 4", "1 4 1 4", "the blocks have 1 nodes, not 4"},
      {"2 4 1 4", "3 4 1 4", "expected the dimension of an entity, found '$EndNodes'"},
      {"2 4 1 4", "2 999 1 4", "bad.msh:11: the number of nodes is 999, more than"},
      {"3 8 0 3", "4 8 0 3", "bad.msh:15: an entity of dimension 4"},
      {"3 8 0 3", "3 8 1 3", "bad.msh:19: expected a parameter, found the end of the line"},
      {"2\n3\n4\n", "2\n1\n4\n", "bad.msh:20: node 1 is defined a second time"},
      {"3 3 1 3", "3 2 1 3", "a block of 1 elements where 0 are left"},
      {"3 3 1 3", "3 4 1 3", "1 of 4 elements are missing"},
      {"3 8 4 1", "3 9 4 1", "entity 9 of dimension 3 is not in $Entities"},
      {"3 8 4 1", "3 8 2 1", "element 3 is a 3-node triangle in an entity of dimension 3"},
      {"3 1 2 3 4\n", "3 1 2 3 1152921504606846976\n",
       "bad.msh:30: element 3: node 1152921504606846976 does not exist"},
      {"3 1 2 3 4\n", "3 2 1 3 4\n", "bad.msh:30: element 3 is inverted"},
  };
  assert_faults(sound_4, sizeof faults / sizeof *faults, faults);
}

static void one_entity_in_too_many_groups(void **state) {
  (void)state;
  char many[4000] = "5 0 0 0 300";
  corot_mesh *m = NULL;
  for (int i = 0; i < 300; i++) strcat(many, " 3");
  char *text = edit_text(sound_4, "5 0 0 0 1 3", many);
  assert_fails(corot_gmsh_parse("bad.msh", text, strlen(text), NULL, &m), COROT_EFORMAT,
               "bad.msh:6: entity 5 is in 300 physical groups, more than 256");
  free(text);
}

static void faults_of_tetgen(void **state) {
  (void)state;
  static const char node[] = "4 3 0 1\n0 0 0 0 0\n1 1 0 0 0\n2 0 1 0 7\n3 0 0 1 7\n";
  static const char ele[] = "1 4 1\n0 0 1 2 3 2\n";
  static const fault in_node[] = {
      {"4 3 0 1", "4 2 0 1", "m.node:1: the dimension is 2, not 3"},
      {"4 3 0 1", "0 3 0 1", "m.node:1: the file has no nodes"},
      {"4 3 0 1", "400 3 0 1", "m.node:1: the number of nodes is 400, more than"},
      {"4 3 0 1", "4 3 -1 1", "m.node:1: nodes with -1 attributes"},
      {"4 3 0 1", "4 3 0 2", "m.node:1: nodes with 0 attributes and 2 boundary markers"},
      {"4 3 0 1", "4 3 0 0", "m.node:2: '0' is too much on this line"},
      {"4 3 0 1", "3 3 0 1", "m.node:5: expected the end after 3 nodes"},
      {"4 3 0 1", "5 3 0 1", "m.node:6: expected a node, found the end of the file"},
      {"2 0 1 0 7", "3 0 1 0 7", "m.node:4: node 3 stands where 2 should"},
      {"0 0 0 0 0", "2 0 0 0 0", "m.node:2: the first node is 2, not 0 or 1"},
      {"2 0 1 0 7", "2 0 inf 0 7", "m.node:4: node 2: y is inf"},
      {"4 3 0 1\n0 0 0 0 0\n", "5 3 0 1\n0 0 0 0 0\n", "expected a node, found the end"},
  };
  static const fault in_ele[] = {
      {"1 4 1", "1 20 1", "m.ele:1: tets of 20 nodes: only 4 or 10 are supported"},
      {"1 4 1", "1 4 -1", "m.ele:1: tets with -1 attributes"},
      {"1 4 1", "9 4 1", "m.ele:1: the number of tets is 9, more than"},
      {"1 4 1", "0 4 1", "m.ele:2: expected the end after 0 tets"},
      {"0 1 2 3 2", "0 1 2 4 2", "m.ele:2: element 0: node 4 does not exist"},
      {"0 1 2 3 2", "0 1 2 3", "m.ele:2: expected an attribute, found the end of the line"},
      {"0 1 2 3 2", "0 1 2 3 nan", "m.ele:2: the region is nan"},
  };
  corot_mesh *m = NULL;
  assert_ok(corot_tetgen_parse(TEXT("m.node", node), TEXT("m.ele", ele), NULL, NULL, &m));
  assert_int_equal(m->ngroup, 2);
  corot_mesh_destroy(m);
  m = NULL;
  for (size_t i = 0; i < sizeof in_node / sizeof *in_node; i++) {
    char *text = edit_text(node, in_node[i].from, in_node[i].to);
    assert_fails(corot_tetgen_parse(TEXT("m.node", text), TEXT("m.ele", ele), NULL, NULL, &m),
                 COROT_EFORMAT, in_node[i].message);
    free(text);
  }
  for (size_t i = 0; i < sizeof in_ele / sizeof *in_ele; i++) {
    char *text = edit_text(ele, in_ele[i].from, in_ele[i].to);
    assert_fails(corot_tetgen_parse(TEXT("m.node", node), TEXT("m.ele", text), NULL, NULL, &m),
                 COROT_EFORMAT, in_ele[i].message);
    free(text);
  }
  assert_null(m);
}

static void files_that_are_no_meshes(void **state) {
  (void)state;
  char *dir = temporary_folder();
  corot_mesh *m = NULL;
  assert_fails(corot_mesh_read(in(dir, "no.msh"), &m), COROT_EIO, "no.msh: No such file");
  assert_fails(corot_mesh_read(dir, &m), COROT_EIO, "Is a directory");
  put_file(in(dir, "empty.msh"), "");
  assert_fails(corot_mesh_read(in(dir, "empty.msh"), &m), COROT_EFORMAT, "the file is empty");
  put_file(in(dir, "blank.node"), " \n\n");
  assert_fails(corot_mesh_read(in(dir, "blank.node"), &m), COROT_EFORMAT, "the file is empty");
  put_file(in(dir, "a.obj"), "v 0 0 0\n");
  assert_fails(corot_mesh_read(in(dir, "a.obj"), &m), COROT_EFORMAT, "not a mesh file");
  put_file(in(dir, "a.msh"), "$Foo\n$EndFoo\n");
  assert_fails(corot_mesh_read(in(dir, "a.msh"), &m), COROT_EFORMAT, "neither $MeshFormat nor");
  put_file(in(dir, "b.msh"), "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n");
  assert_fails(corot_mesh_read(in(dir, "b.msh"), &m), COROT_EFORMAT, "the file has no nodes");
  put_file(in(dir, "c.msh"), "$NOD\n0\n$ENDNOD\n");
  assert_fails(corot_mesh_read(in(dir, "c.msh"), &m), COROT_EFORMAT, "the file has no elements");
  put_file(in(dir, "a.node"), "4 3 0 0\n");
  assert_fails(corot_mesh_read(in(dir, "a.node"), &m), COROT_EIO, "a.ele: No such file");
  assert_fails(corot_mesh_read(DATA "hexahedron.msh", &m), COROT_EFORMAT,
               "hexahedron.msh: the file has 1 hexahedron beside 0 tets");
  assert_null(m);
  remove_folder(dir);
}

/* A status of a file that may be damaged in any way. */
static void assert_clean(corot_status status, corot_mesh *m) {
  if (status == COROT_OK) {
    assert_non_null(m);
    corot_mesh_destroy(m);
    return;
  }
  if (status != COROT_EFORMAT) fail_msg("status %d: %s", (int)status, corot_error());
  assert_null(m);
}

/* The first n bytes, in a block of just that size and a 0, where a sanitizer sees the end. */
static char *prefix(const char *data, size_t n) {
  char *p = malloc(n + 1);
  assert_non_null(p);
  memcpy(p, data, n);
  p[n] = 0;
  return p;
}

static void every_prefix_fails_cleanly(void **state) {
  (void)state;
  static const char *const files[] = {"two.msh1.msh",  "two.msh22.msh",  "two.msh22b.msh",
                                      "two.msh41.msh", "two.msh41b.msh", "two.msh22pb.msh",
                                      "two.msh41p.msh"};
  for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
    char path[1024];
    size_t size;
    snprintf(path, sizeof path, "%s%s", DATA, files[i]);
    char *data = slurp(path, &size);
    for (size_t n = 0; n < size; n++) {
      char *p = prefix(data, n);
      corot_mesh *m = NULL;
      corot_status status = corot_gmsh_parse("prefix", p, n, NULL, &m);
      if (n + 2 < size) assert_int_equal(status, COROT_EFORMAT);
      assert_clean(status, m);
      free(p);
    }
    free(data);
  }
}

static void every_tetgen_prefix_fails_cleanly(void **state) {
  (void)state;
  size_t node_size, ele_size;
  char *node = slurp(DATA "two.node", &node_size), *ele = slurp(DATA "two.ele", &ele_size);
  for (size_t n = 0; n < node_size; n++) {
    corot_mesh *m = NULL;
    char *p = prefix(node, n);
    corot_status status = corot_tetgen_parse(
        &(corot_mesh_text){"n", p, n}, &(corot_mesh_text){"e", ele, ele_size}, NULL, NULL, &m);
    assert_clean(status, m);
    free(p);
  }
  for (size_t n = 0; n < ele_size; n++) {
    corot_mesh *m = NULL;
    char *p = prefix(ele, n);
    corot_status status = corot_tetgen_parse(&(corot_mesh_text){"n", node, node_size},
                                             &(corot_mesh_text){"e", p, n}, NULL, NULL, &m);
    assert_clean(status, m);
    free(p);
  }
  free(node);
  free(ele);
}

/* Each 4-byte word of the binary files in turn is made huge, negative and zero. */
static void every_damaged_word_fails_cleanly(void **state) {
  (void)state;
  static const char *const files[] = {DATA "two.msh22b.msh", DATA "two.msh41b.msh"};
  static const unsigned char value[] = {0xff, 0x7f, 0x80, 0x00};
  for (int i = 0; i < 2; i++) {
    size_t size;
    char *data = slurp(files[i], &size);
    for (size_t at = 0; at + 4 <= size; at += 2)
      for (int v = 0; v < 4; v++) {
        char *p = prefix(data, size);
        corot_mesh *m = NULL;
        memset(p + at, value[v], 4);
        corot_status status = corot_gmsh_parse("damaged", p, size, NULL, &m);
        assert_clean(status, m);
        free(p);
      }
    free(data);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(faults_of_format_1),
      cmocka_unit_test(a_node_in_no_tet_may_be_the_centre_of_an_arc),
      cmocka_unit_test(faults_of_format_2_syntax),
      cmocka_unit_test(faults_of_format_2_content),
      cmocka_unit_test(tets_of_several_groups_are_one),
      cmocka_unit_test(faults_of_format_4),
      cmocka_unit_test(one_entity_in_too_many_groups),
      cmocka_unit_test(faults_of_tetgen),
      cmocka_unit_test(files_that_are_no_meshes),
      cmocka_unit_test(every_prefix_fails_cleanly),
      cmocka_unit_test(every_tetgen_prefix_fails_cleanly),
      cmocka_unit_test(every_damaged_word_fails_cleanly),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
