/* Mesh files as gmsh and TetGen write them. See data/make. */
#include <locale.h>

#include "alloc.h"
#include "check.h"
#include "core/mesh/read/mesh_read.h"
#include "mesh_text.h"
#include "temporary.h"

static corot_mesh *parse(const char *text) {
  corot_mesh *m = NULL;
  assert_ok(corot_gmsh_parse("text", text, strlen(text), NULL, &m));
  return m;
}

static void assert_same_group(const corot_group *p, const corot_group *q) {
  assert_int_equal(p->nnode, q->nnode);
  assert_int_equal(p->ntri, q->ntri);
  assert_int_equal(p->ntet, q->ntet);
  assert_memory_equal(p->node, q->node, (size_t)p->nnode * sizeof *p->node);
  if (p->ntri) assert_memory_equal(p->tri, q->tri, (size_t)p->ntri * sizeof *p->tri);
  if (p->ntet) assert_memory_equal(p->tet, q->tet, (size_t)p->ntet * sizeof *p->tet);
}

/* Equal to the bit; names are compared only if `named`. */
static void assert_same_mesh(const corot_mesh *a, const corot_mesh *b, bool named) {
  assert_int_equal(a->nnode, b->nnode);
  assert_int_equal(a->ntet, b->ntet);
  assert_int_equal(a->ngroup, b->ngroup);
  assert_memory_equal(a->x, b->x, (size_t)a->nnode * sizeof *a->x);
  assert_memory_equal(a->tet, b->tet, (size_t)a->ntet * sizeof *a->tet);
  for (int g = 0; g < a->ngroup; g++) {
    assert_same_group(&a->group[g], &b->group[g]);
    if (named) assert_string_equal(a->group[g].name, b->group[g].name);
  }
}

static const char *const gmsh_files[] = {
    DATA "two.msh41.msh",  DATA "two.msh41b.msh",  DATA "two.msh22.msh",  DATA "two.msh22b.msh",
    DATA "two.msh41p.msh", DATA "two.msh41pb.msh", DATA "two.msh22p.msh", DATA "two.msh22pb.msh",
    DATA "two.msh40.msh",  DATA "two.msh40p.msh",  DATA "two.msh1.msh",
};
enum { NFILE = sizeof gmsh_files / sizeof *gmsh_files };

static void all_gmsh_formats_give_the_same_mesh(void **state) {
  (void)state;
  corot_mesh *first = read_mesh(gmsh_files[0]);
  for (int i = 1; i < NFILE; i++) {
    corot_mesh *m = read_mesh(gmsh_files[i]);
    assert_same_mesh(first, m, i < NFILE - 1); /* format 1 has no names */
    corot_mesh_destroy(m);
  }
  assert_int_equal(first->nnode, 23);
  assert_int_equal(first->ntet, 48);
  assert_close(corot_mesh_measure(first).volume, 2, 1e-14, 0);
  assert_close(first->x[18][0], 0.5000000000000001, 0, 0);
  corot_mesh_destroy(first);
}

static double area_z(const corot_mesh *m, const char *name) {
  const corot_group *g = corot_mesh_find_group(m, name);
  double sum = 0;
  assert_non_null(g);
  assert_int_equal(g->ntri, 4);
  for (int t = 0; t < g->ntri; t++) {
    const double *a = m->x[g->tri[t][0]], *b = m->x[g->tri[t][1]], *c = m->x[g->tri[t][2]];
    sum += ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2;
  }
  return sum;
}

static void physical_groups_become_groups(void **state) {
  (void)state;
  static const char *const names[] = {"tip", "edge", "base", "middle", "top", "lower", "all"};
  corot_mesh *m = read_mesh(DATA "two.msh41.msh");
  assert_int_equal(m->ngroup, 7);
  for (int g = 0; g < 7; g++) assert_string_equal(m->group[g].name, names[g]);
  assert_int_equal(m->group[0].nnode, 1);
  assert_int_equal(m->group[0].node[0], 1);
  assert_int_equal(m->group[1].nnode, 3);
  assert_int_equal(m->group[5].ntet, 24);
  assert_int_equal(m->group[6].ntet, 48);
  assert_int_equal(m->group[6].nnode, 23);
  /* outward at both ends, although the file has both upward; downward, reversed, between */
  assert_close(area_z(m, "base"), -1, 1e-15, 0);
  assert_close(area_z(m, "top"), 1, 1e-15, 0);
  assert_close(area_z(m, "middle"), -1, 1e-15, 0);
  corot_mesh_destroy(m);
}

static void nameless_groups_are_called_by_their_numbers(void **state) {
  (void)state;
  static const char *const names[] = {"point-1", "line-2",   "surface-1", "surface-2",
                                      "7",       "volume-1", "volume-2"};
  corot_mesh *m = read_mesh(DATA "two.msh1.msh");
  assert_int_equal(m->ngroup, 7);
  for (int g = 0; g < 7; g++) assert_string_equal(m->group[g].name, names[g]);
  corot_mesh_destroy(m);
}

#define FORMAT_2 "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
#define FORMAT_4 "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
#define NODES_2 "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n"

static void names_join_and_empty_ones_go(void **state) {
  (void)state;
  corot_mesh *m = parse(
      FORMAT_2
      "$PhysicalNames\n4\n0 9 \"empty\"\n3 2 \"body of \xc3\xa9\"\n2 1 \"skin\"\n0 3 \"skin\"\n"
      "$EndPhysicalNames\n" NODES_2
      "$Elements\n5\n1 4 2 2 1 1 2 3 4\n2 2 2 1 1 1 2 3\n3 2 2 1 1 3 1 2\n4 15 2 3 1 4\n"
      "5 15 0 3\n$EndElements\n");
  assert_int_equal(m->ngroup, 2);
  assert_string_equal(m->group[0].name, "body of \xc3\xa9");
  assert_string_equal(m->group[1].name, "skin");
  assert_int_equal(m->group[1].nnode, 4);
  assert_int_equal(m->group[1].ntri, 1); /* listed twice */
  const int outward[3] = {0, 2, 1};
  assert_memory_equal(m->group[1].tri[0], outward, sizeof outward);
  corot_mesh_destroy(m);
}

static void layout_and_foreign_sections_do_not_matter(void **state) {
  (void)state;
  corot_mesh *a = parse(FORMAT_2 NODES_2 "$Elements\n1\n1 4 2 0 1 1 2 3 4\n$EndElements\n");
  corot_mesh *b = parse(
      "\n$Comments\nany $thing: $EndComment \n$EndComments\n\n$MeshFormat\r\n2.2  0\t8 \r\n"
      "$EndMeshFormat\r\n$Nodes\r\n\r\n4\r\n7 -0e0 0. 0\r\n0 1.0E+0 0 0\r\n"
      "  900 0 10.e-1 0\n5 0 0 +1\n$EndNodes\n$NodeData\n1\n\"u\"\n$EndNodeData\n"
      "$Elements\n1\n77 4 4 0 1 1 1 7 0 900 5\n$EndElements");
  assert_int_equal(b->ngroup, 0);
  b->x[0][0] = 0; /* it is -0 */
  assert_same_mesh(a, b, true);
  corot_mesh_destroy(b);

  b = parse(FORMAT_4
            "$Nodes\n2 4 1 1152921504606846976\n3 1 0 1\n1152921504606846976\n0 0 0\n"
            "3 1 0 3\n2\n30\n4\n1 0 0\n0 1 0\n0 0 1\n$EndNodes\n"
            "$Elements\n1 1 1 1\n3 1 4 1\n9000000000 1152921504606846976 2 30 4\n"
            "$EndElements\n");
  assert_same_mesh(a, b, true);
  corot_mesh_destroy(b);
  corot_mesh_destroy(a);
}

/* A node for each of a mesh's nodes, at the same place, in another order. */
static void assert_same_shape(const corot_mesh *a, const corot_mesh *b) {
  assert_int_equal(a->nnode, b->nnode);
  assert_int_equal(a->ntet, b->ntet);
  assert_int_equal(a->ngroup, b->ngroup);
  assert_close(corot_mesh_measure(a).volume, corot_mesh_measure(b).volume, 1e-12, 0);
  for (int g = 0; g < a->ngroup; g++) {
    assert_string_equal(a->group[g].name, b->group[g].name);
    assert_int_equal(a->group[g].nnode, b->group[g].nnode);
    assert_int_equal(a->group[g].ntri, b->group[g].ntri);
    assert_int_equal(a->group[g].ntet, b->group[g].ntet);
  }
}

/* Partitions are put together again: their groups are those of the whole, and what separates them
   is in no group. */
static void partitioned_meshes_are_whole(void **state) {
  (void)state;
  static const char *const files[][2] = {{DATA "two.parts.msh", DATA "two.msh41.msh"},
                                         {DATA "two.partsb.msh", DATA "two.msh41.msh"},
                                         {DATA "two_2.parts.msh", DATA "two_2.msh41.msh"}};
  for (int i = 0; i < 3; i++) {
    corot_mesh *parts = read_mesh(files[i][0]), *whole = read_mesh(files[i][1]);
    assert_same_shape(parts, whole);
    corot_mesh_destroy(parts);
    corot_mesh_destroy(whole);
  }
}

/* One tet, spelled in the ways that are met in the wild, comes out the same. */
static void spellings(void **state) {
  (void)state;
  static const char plain[] = FORMAT_2 NODES_2 "$Elements\n1\n1 4 2 0 1 1 2 3 4\n$EndElements\n";
  char *dir = temporary_folder(), cr[sizeof plain], *text;
  corot_mesh *a = parse(plain);
  strcpy(cr, plain);
  for (char *c = cr; *c; c++)
    if (*c == '\n') *c = '\r';
  char *const spelled[] = {
      edit_text(plain, "$Mesh", "\xef\xbb\xbf$Mesh"),
      edit_text(cr, "$Mesh", "\r\r$Mesh"),
      edit_text(plain, "2 1 0 0", "2 10.0D-1 0D0 +0.d+00"),
      edit_text(plain, "1 4 2 0 1 1 2 3 4", "9000000000 4 2 0 1 1 2 3 4"),
  };
  for (int i = 0; i < 4; i++) {
    put_file(in(dir, "a.msh"), spelled[i]);
    corot_mesh *b = read_mesh(in(dir, "a.msh"));
    assert_same_mesh(a, b, true);
    corot_mesh_destroy(b);
    free(spelled[i]);
  }
  text = edit_text(plain, "4 0 0 1\n", "3000000000 0 0 1\n");
  char *large = edit_text(text, "1 2 3 4\n", "1 2 3 3000000000\n");
  corot_mesh *b = parse(large);
  assert_same_mesh(a, b, true);
  corot_mesh_destroy(a);
  corot_mesh_destroy(b);
  free(text);
  free(large);
  put_file(in(dir, "a.msh"), "\xff\xfe$");
  assert_fails(corot_mesh_read(in(dir, "a.msh"), &a), COROT_EFORMAT,
               "a.msh: the text is UTF-16: save it as UTF-8 or ASCII");
  remove_folder(dir);
}

static void other_elements_outside_groups_are_ignored(void **state) {
  (void)state;
  corot_mesh *m =
      parse(FORMAT_2 NODES_2
            "$Elements\n4\n1 3 2 0 1 1 2 3 4\n2 8 2 0 1 1 2 3\n3 2 2 0 1 1 2 3\n4 4 2 0 1 1 2 3 4\n"
            "$EndElements\n");
  assert_int_equal(m->ntet, 1);
  assert_int_equal(m->ngroup, 0);
  corot_mesh_destroy(m);
}

/* A file made byte by byte, in this machine's byte order or the other. */
typedef struct bytes {
  char data[2048];
  size_t n;
  bool swap;
} bytes;

static void put(bytes *b, const void *value, size_t n) {
  for (size_t i = 0; i < n; i++) b->data[b->n++] = ((const char *)value)[b->swap ? n - 1 - i : i];
}

static void put_text(bytes *b, const char *text) {
  memcpy(b->data + b->n, text, strlen(text));
  b->n += strlen(text);
}

static void put_int(bytes *b, int32_t v) { put(b, &v, sizeof v); }

static void put_long(bytes *b, int64_t v) { put(b, &v, sizeof v); }

static void put_node(bytes *b, int i) {
  for (int k = 1; k < 4; k++) {
    double x = i == k;
    put(b, &x, sizeof x);
  }
}

static void put_format(bytes *b, const char *version) {
  put_text(b, "$MeshFormat\n");
  put_text(b, version);
  put_text(b, " 1 8\n");
  put_int(b, 1);
  put_text(b, "\n$EndMeshFormat\n$Nodes\n");
}

/* Counts and coordinates have bytes that look like blanks and ends of lines. */
static void put_mesh_2(bytes *b) {
  put_format(b, "2.2");
  put_text(b, "4\n");
  for (int i = 0; i < 4; i++) {
    put_int(b, 9 + i);
    put_node(b, i);
  }
  put_text(b, "\n$EndNodes\n$Elements\n2\n");
  const int32_t tet[] = {4, 1, 2, 10, 32, 13, 9, 10, 11, 12}, point[] = {15, 1, 2, 33, 13, 1, 9};
  for (int i = 0; i < 10; i++) put_int(b, tet[i]);
  for (int i = 0; i < 7; i++) put_int(b, point[i]);
  put_text(b, "\n$EndElements\n");
}

static void put_mesh_4(bytes *b) {
  put_format(b, "4.1");
  put_long(b, 1), put_long(b, 4), put_long(b, 9), put_long(b, 12);
  put_int(b, 3), put_int(b, 1), put_int(b, 0), put_long(b, 4);
  for (int i = 0; i < 4; i++) put_long(b, 9 + i);
  for (int i = 0; i < 4; i++) put_node(b, i);
  put_text(b, "\n$EndNodes\n$Elements\n");
  put_long(b, 1), put_long(b, 1), put_long(b, 10), put_long(b, 10);
  put_int(b, 3), put_int(b, 1), put_int(b, 4), put_long(b, 1);
  put_long(b, 10);
  for (int i = 0; i < 4; i++) put_long(b, 9 + i);
  put_text(b, "\n$EndElements\n");
}

static void binary_of_either_byte_order(void **state) {
  (void)state;
  for (int swap = 0; swap < 2; swap++)
    for (int version = 2; version <= 4; version += 2) {
      bytes b = {.swap = swap};
      corot_mesh *m;
      version == 2 ? put_mesh_2(&b) : put_mesh_4(&b);
      assert_ok(corot_gmsh_parse("bytes", b.data, b.n, NULL, &m));
      assert_int_equal(m->ntet, 1);
      assert_close(m->x[2][1], 1, 0, 0);
      assert_int_equal(m->tet[0][3], 3);
      assert_int_equal(m->ngroup, version == 2 ? 2 : 0);
      if (version == 2) assert_string_equal(m->group[1].name, "32");
      corot_mesh_destroy(m);
    }
}

static void tetgen_by_either_path(void **state) {
  (void)state;
  static const char *const names[] = {"region-1", "region-2", "marker-5", "marker-6"};
  corot_mesh *a = read_mesh(DATA "two.node"), *b = read_mesh(DATA "two.ele");
  assert_same_mesh(a, b, true);
  assert_int_equal(a->nnode, 12);
  assert_int_equal(a->ntet, 12);
  assert_close(corot_mesh_measure(a).volume, 2, 1e-14, 0);
  assert_int_equal(a->ngroup, 4);
  for (int g = 0; g < 4; g++) assert_string_equal(a->group[g].name, names[g]);
  assert_int_equal(a->group[0].ntet, 6);
  const int low[4] = {0, 1, 2, 3};
  assert_int_equal(a->group[2].nnode, 4);
  assert_memory_equal(a->group[2].node, low, sizeof low);
  corot_mesh_destroy(a);
  corot_mesh_destroy(b);
}

static corot_status parse_tetgen(const char *node, const char *ele, corot_mesh **m) {
  return corot_tetgen_parse(TEXT("m.node", node), TEXT("m.ele", ele), NULL, NULL, m);
}

static void tetgen_numbers_from_1_and_either_hand(void **state) {
  (void)state;
  const char *node = "# five nodes\n\n5 3\n1 0 0 0\n2 1 0 0 # x\n3 0 1 0\n4 0 0 1\n5 1 1 1\n";
  corot_mesh *m = NULL;
  assert_ok(parse_tetgen(node, "2 4 0\n1 1 2 3 4\n2 2 3 4 5\n# end", &m));
  assert_int_equal(m->tet[1][3], 4);
  assert_int_equal(m->ngroup, 0);
  corot_mesh_destroy(m);
  assert_ok(parse_tetgen(node, "2 4\n1 1 2 4 3\n2 2 3 5 4\n", &m)); /* all left-handed */
  assert_int_equal(m->tet[0][0], 1);
  assert_int_equal(m->tet[0][1], 0);
  corot_mesh_destroy(m);
  assert_fails(parse_tetgen(node, "2 4\n1 1 2 3 4\n2 2 3 5 4\n", &m), COROT_EFORMAT,
               "m.ele:3: element 2 is inverted");
}

/* Sets a locale that writes 1,5 for 1.5: one that is installed, or else one made in `dir`. */
static bool set_comma_locale(const char *dir) {
  static const char *const names[] = {"de_DE.UTF-8", "de_DE.utf8", "de_DE", "fr_FR.UTF-8"};
  char command[2048];
  for (int i = 0; i < 4; i++)
    if (setlocale(LC_ALL, names[i])) return true;
  snprintf(command, sizeof command, "localedef -i de_DE -f UTF-8 '%s/de_DE.UTF-8' 2>/dev/null",
           dir);
  return system(command) == 0 && setenv("LOCPATH", dir, 1) == 0 && setlocale(LC_ALL, names[0]);
}

static void numbers_do_not_depend_on_the_locale(void **state) {
  (void)state;
  char *dir = temporary_folder(), half[8];
  corot_mesh *a = NULL, *b = NULL;
  if (!set_comma_locale(dir)) {
    remove_folder(dir);
    skip();
  }
  snprintf(half, sizeof half, "%.1f", 0.5);
  corot_status status = corot_mesh_read(gmsh_files[0], &a);
  if (!status) status = corot_mesh_write(a, in(dir, "two.msh"));
  if (!status) status = corot_mesh_read(in(dir, "two.msh"), &b);
  setlocale(LC_ALL, "C");
  assert_ok(status);
  assert_string_equal(half, "0,5");
  assert_same_mesh(a, b, true);
  corot_mesh_destroy(a);
  corot_mesh_destroy(b);
  remove_folder(dir);
}

static void failed_allocations(void **state) {
  (void)state;
  for (int i = 0; i < NFILE; i++)
    assert_true(assert_survives_failed_allocations(try_read, (void *)gmsh_files[i]) > 40);
  assert_true(assert_survives_failed_allocations(try_read, (void *)(DATA "two.node")) > 30);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(all_gmsh_formats_give_the_same_mesh),
      cmocka_unit_test(physical_groups_become_groups),
      cmocka_unit_test(nameless_groups_are_called_by_their_numbers),
      cmocka_unit_test(names_join_and_empty_ones_go),
      cmocka_unit_test(layout_and_foreign_sections_do_not_matter),
      cmocka_unit_test(partitioned_meshes_are_whole),
      cmocka_unit_test(spellings),
      cmocka_unit_test(other_elements_outside_groups_are_ignored),
      cmocka_unit_test(binary_of_either_byte_order),
      cmocka_unit_test(tetgen_by_either_path),
      cmocka_unit_test(tetgen_numbers_from_1_and_either_hand),
      cmocka_unit_test(numbers_do_not_depend_on_the_locale),
      cmocka_unit_test(failed_allocations),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
