/* Abaqus' and CalculiX' files: as gmsh writes them, see data/make; in the ways that the manuals
   allow; and with faults. */
#include "alloc.h"
#include "check.h"
#include "mesh_text.h"
#include "temporary.h"

static const corot_group *group(const corot_mesh *m, const char *name) {
  const corot_group *g = corot_mesh_find_group(m, name);
  if (!g) fail_msg("there is no group %s", name);
  return g;
}

/* The body is that of the gmsh file, of curved tets too, whose volume depends on the order of the
   nodes on edges; sets of triangles have their faces, and sets of tets their tets. */
static void bodies_are_those_of_gmsh(void **state) {
  (void)state;
  static const char *const files[][2] = {{DATA "two.inp", DATA "two.msh41.msh"},
                                         {DATA "quarter.inp", DATA "quarter.msh"}};
  for (int i = 0; i < 2; i++) {
    corot_mesh *a = read_mesh(files[i][0]), *b = read_mesh(files[i][1]);
    assert_int_equal(a->nnode, b->nnode);
    assert_int_equal(a->ntet, b->ntet);
    assert_int_equal(corot_mesh_order(a), i + 1);
    assert_close(corot_mesh_measure(a).volume, corot_mesh_measure(b).volume, 1e-12, 0);
    for (int g = 0; g < b->ngroup; g++) {
      const corot_group *q = &b->group[g];
      if (q->ntri + q->ntet == 0) continue; /* sets of lines make no group */
      const corot_group *p = group(a, q->name);
      assert_int_equal(p->ntri, q->ntri);
      assert_int_equal(p->ntet, q->ntet);
      assert_int_equal(p->nnode, q->nnode);
    }
    corot_mesh_destroy(a);
    corot_mesh_destroy(b);
  }
}

static const char sound[] =
    "*Heading\n a body of two tets, * and , do not matter here\n"
    "** a comment\n*Node, nset = All\n1, 0, 0, 0\n 2, 1.D0,\n3, , 1., 0\n** in between\n4,0,0,1.\n"
    "5, 1, 1, 1\n"
    "*Element, type=C3D4, elset=Body\n11, 1,2,\n3,4\n12, 2, 3, 4, 5\n"
    "*nset, nset=low\n1, 2, 3,\n*NSET,\nNSET=\"ends of it\", GENERATE\n1, 5, 4\n"
    "*ELSET, ELSET=low\n11\n*Elset, elset=both\nlow, 12\n"
    "*SURFACE, NAME=skin\nBODY, S1\n11, s2\n*Surface, type=node, name=points\nLOW,\n5, 1.\n"
    "*Step\n*Node print, nset=all\nU\n*End step\n";

static void sets_and_surfaces_become_groups(void **state) {
  (void)state;
  corot_mesh *m = parse_text(sound);
  assert_int_equal(m->ngroup, 7);
  assert_int_equal(m->ntet, 2);
  assert_close(corot_mesh_measure(m).volume, 0.5, 1e-15, 0);
  assert_int_equal(group(m, "All")->nnode, 5);
  assert_int_equal(group(m, "Body")->ntet, 2);
  assert_int_equal(group(m, "low")->ntet, 1);
  assert_int_equal(group(m, "low")->nnode, 4); /* of the nodes and of the tet */
  assert_int_equal(group(m, "ends of it")->nnode, 2);
  assert_int_equal(group(m, "both")->ntet, 2);
  assert_int_equal(group(m, "points")->nnode, 4);
  const corot_group *skin = group(m, "skin");
  assert_int_equal(skin->ntri, 3);
  assert_int_equal(skin->nnode, 4); /* one is between the tets */
  corot_mesh_destroy(m);
}

/* Face k of an element has the nodes that the manuals say, at order 2 those on its edges, too. */
static void faces_of_elements(void **state) {
  (void)state;
  static const int corner[4][3] = {{0, 1, 2}, {0, 1, 3}, {1, 2, 3}, {0, 2, 3}};
  for (int k = 0; k < 4; k++) {
    char text[600];
    snprintf(text, sizeof text,
             "*NODE\n1,0,0,0\n2,2,0,0\n3,0,2,0\n4,0,0,2\n5,1,0,0\n6,1,1,0\n7,0,1,0\n8,0,0,1\n"
             "9,1,0,1\n10,0,1,1\n*ELEMENT, TYPE=C3D10M\n1,1,2,3,4,5,6,7,8,9,\n10\n"
             "*SURFACE, NAME=face, TYPE=ELEMENT\n1, S%d\n",
             k + 1);
    corot_mesh *m = parse_text(text);
    assert_int_equal(corot_mesh_order(m), 2);
    const corot_group *g = group(m, "face");
    assert_int_equal(g->ntri, 1);
    assert_int_equal(g->nnode, 6);
    assert_memory_equal(g->node, corner[k], sizeof corner[k]);
    corot_mesh_destroy(m);
  }
}

/* One part and one instance that stays where it is: names of the assembly have its name before
   them, and internal sets make no groups. */
static void a_file_of_one_part(void **state) {
  (void)state;
  corot_mesh *m = parse_text(
      "*Part, name=Part-1\n*Node\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n"
      "*Element, type=C3D4\n1,1,2,3,4\n*End Part\n*Assembly, name=A\n"
      "*Instance, name=Part-1-1, part=Part-1\n0., 0., 0.\n*End Instance\n"
      "*Elset, elset=_S_S1, internal, instance=Part-1-1\n1,\n"
      "*Nset, nset=fix\nPart-1-1.2, part-1-1.3\n"
      "*Surface, type=ELEMENT, name=S\n_S_S1, S1\n*End Assembly\n");
  assert_int_equal(m->ngroup, 2);
  assert_int_equal(group(m, "fix")->nnode, 2);
  assert_int_equal(group(m, "S")->ntri, 1);
  corot_mesh_destroy(m);
}

/* Files are looked for beside the one that includes them; messages name the file and its line. */
static void included_files(void **state) {
  (void)state;
  char *dir = temporary_folder(), command[1024];
  corot_mesh *m = NULL;
  snprintf(command, sizeof command, "mkdir '%s'", in(dir, "sub"));
  assert_int_equal(system(command), 0);
  put_file(in(dir, "m.inp"), "*INCLUDE, INPUT=sub/n.inp\n*ELEMENT, TYPE=C3D4\n1,1,2,3,4\n");
  put_file(in(dir, "sub/n.inp"),
           "*NODE\n1,0,0,0\n*include, input = \"rest.inp\"\n3,0,1,0\n4,0,0,1");
  put_file(in(dir, "sub/rest.inp"), "2,1,0,0");
  assert_ok(corot_mesh_read(in(dir, "m.inp"), &m));
  assert_int_equal(m->nnode, 4);
  corot_mesh_destroy(m);
  m = NULL;
  put_file(in(dir, "sub/rest.inp"), "** one\n2,x,0,0");
  assert_fails(corot_mesh_read(in(dir, "m.inp"), &m), COROT_EFORMAT,
               "sub/rest.inp:2: expected x, found 'x'");
  put_file(in(dir, "sub/rest.inp"), "2,1,0,0\n");
  put_file(in(dir, "m.inp"), "*INCLUDE, INPUT=sub/n.inp\n*ELEMENT, TYPE=C3D4\n1,1,2,3,9\n");
  assert_fails(corot_mesh_read(in(dir, "m.inp"), &m), COROT_EFORMAT,
               "m.inp:3: element 1: node 9 does not exist");
  put_file(in(dir, "m.inp"), "*NODE\n*INCLUDE, INPUT=m.inp\n");
  assert_fails(corot_mesh_read(in(dir, "m.inp"), &m), COROT_EFORMAT,
               "m.inp:2: files include each other too often");
  put_file(in(dir, "m.inp"), "*INCLUDE, INPUT=none.inp\n");
  assert_fails(corot_mesh_read(in(dir, "m.inp"), &m), COROT_EFORMAT, "m.inp:1: the included file");
  put_file(in(dir, "m.inp"), "*INCLUDE, INPUT=/dev/zero\n");
  assert_fails(corot_mesh_read(in(dir, "m.inp"), &m), COROT_EFORMAT, "m.inp:1: the included file");
  put_file(in(dir, "m.inp"), "\n*INCLUDE\n");
  assert_fails(corot_mesh_read(in(dir, "m.inp"), &m), COROT_EFORMAT, "m.inp:2: expected *INCLUDE");
  assert_null(m);
  remove_folder(dir);
}

static void faults(void **state) {
  (void)state;
  static const text_fault table[] = {
      {"*Heading\n", "*Heading\n*Node, system=C\n", "m.inp:2: coordinates of SYSTEM=C are not"},
      {"*Node,", "*Nodes,", "m.inp: the file has no *NODE"},
      {"5, 1, 1, 1\n", "5, 1, 1, nan\n", "m.inp:10: node 5: z is nan"},
      {"5, 1, 1, 1\n", "5, 1 1, 1\n", "m.inp:10: expected a comma"},
      {"5, 1, 1, 1\n", "4, 1, 1, 1\n", "m.inp:10: node 4 is defined a second time"},
      {"5, 1, 1, 1\n", "-5, 1, 1, 1\n", "m.inp:10: node -5: the number of a node may not"},
      {"*Element, type=C3D4,", "*Element,", "m.inp:11: *ELEMENT has no TYPE"},
      {"type=C3D4,", "type=C3D20R,",
       "m.inp:11: elements of type C3D20R: only C3D4 and C3D10 are supported, and C3D5, C3D6 and "
       "C3D8, "
       "to be cut into tets"},
      {"type=C3D4,", "type=T3D2,", "m.inp: the file has no *ELEMENT of type C3D4 or C3D10"},
      {"12, 2, 3, 4, 5", "12, 2, 3, 4, 6", "m.inp:14: element 12: node 6 does not exist"},
      {"12, 2, 3, 4, 5", "12, 3, 2, 4, 5", "m.inp:14: element 12 is inverted"},
      {"12, 2, 3, 4, 5", "12, 2, 3, 4, 5, 6", "m.inp:14: element 12 has more than 4 nodes"},
      {"12, 2, 3, 4, 5", "12, 2, 3, 4", "m.inp:15: expected a node, found the end of the data"},
      {"12, 2, 3, 4, 5", "11, 2, 3, 4, 5", "m.inp:14: element 11 is defined a second time"},
      {"1, 2, 3,\n", "1, 2, 7,\n", "m.inp:16: node 7 does not exist"},
      {"1, 2, 3,\n", "1, 2, no,\n", "m.inp:16: there is no node set 'no' before this line"},
      {"low, 12", "high, 12", "m.inp:23: there is no element set 'high' before this line"},
      {"nset=low", "elset=low", "m.inp:15: *NSET has no name: NSET=NAME"},
      {"1, 5, 4", "1, 5, 0", "m.inp:19: from 1 to 5 by 0 is no range"},
      {"BODY, S1", "BODY", "is in surface skin, which does not say with which face, S1 to S4"},
      {"BODY, S1", "BODY, S7", "m.inp:25: expected a face, S1 to S6, found 'S7'"},
      {"BODY, S1", "BODY, S5", "is in surface skin, which does not say with which face, S1 to S4"},
      {"NAME=skin", "NAME=skin, COMBINE=UNION", "m.inp:24: surface skin: only surfaces of faces"},
      {"*Step", "*NGEN\n1,2\n*Step", "*NGEN makes nodes or elements: let them be written out"},
      {"*Step", "*PART, NAME=a\n*PART, NAME=b\n*Step", "a second part: only one is supported"},
      {"*Step", "*INSTANCE, NAME=a\n1.,0.,0.\n*Step", "the instance is moved"},
  };
  corot_mesh *m = NULL;
  assert_text_faults("m.inp", sound, sizeof table / sizeof *table, table);
  assert_fails(corot_mesh_parse("m.inp", "** only\n1", 9, NULL, &m), COROT_EFORMAT,
               "m.inp:2: expected a keyword");
}

/* Sets of sets: what doubles with each one ends, as no item is taken twice for one group. */
static void sets_of_sets_end(void **state) {
  (void)state;
  char text[4000] =
      "*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n*ELEMENT,TYPE=C3D4\n1,1,2,3,4\n"
      "*NSET,NSET=s0\n1,2\n";
  for (int i = 1; i < 60; i++) {
    char line[64];
    snprintf(line, sizeof line, "*NSET,NSET=s%d\ns%d,s%d\n", i, i - 1, i - 1);
    strcat(text, line);
  }
  corot_mesh *m = parse_text(text);
  assert_int_equal(m->ngroup, 60);
  assert_int_equal(group(m, "s59")->nnode, 2);
  corot_mesh_destroy(m);
}

static void damage(void **state) {
  (void)state;
  assert_prefixes_fail_cleanly("m.inp", sound, sizeof sound - 1);
  assert_damage_fails_cleanly("m.inp", sound, sizeof sound - 1);
}

static void failed_allocations(void **state) {
  (void)state;
  char *dir = temporary_folder();
  assert_true(assert_survives_failed_allocations(try_read, (void *)(DATA "two.inp")) > 30);
  put_file(in(dir, "sound.inp"), sound);
  put_file(in(dir, "m.inp"), "*INCLUDE, INPUT=sound.inp\n");
  assert_true(assert_survives_failed_allocations(try_read, (void *)in(dir, "m.inp")) > 30);
  remove_folder(dir);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(bodies_are_those_of_gmsh), cmocka_unit_test(sets_and_surfaces_become_groups),
      cmocka_unit_test(faces_of_elements),        cmocka_unit_test(a_file_of_one_part),
      cmocka_unit_test(included_files),           cmocka_unit_test(faults),
      cmocka_unit_test(sets_of_sets_end),         cmocka_unit_test(damage),
      cmocka_unit_test(failed_allocations),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
