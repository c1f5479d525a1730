/* What is mended in mesh files, what is not, and that all that is wrong is told at once. */
#include <math.h>

#include "alloc.h"
#include "check.h"
#include "mesh_text.h"
#include "temporary.h"

/* A text, mended; *report is the caller's. */
static corot_status mend(const char *text, bool cuts, double merge, corot_mesh **m,
                         corot_mesh_report **report) {
  corot_mesh_report *r = calloc(1, sizeof *r);
  assert_non_null(r);
  const corot_reading how = {.mends = true, .cuts = cuts, .merge = merge, .report = r};
  *m = NULL;
  corot_status status = corot_mesh_parse("m.msh", text, strlen(text), &how, m);
  *report = r;
  return status;
}

static corot_mesh *mended(const char *text, bool cuts, double merge, int nremark,
                          const char *const *remark) {
  corot_mesh *m;
  corot_mesh_report *r;
  assert_ok(mend(text, cuts, merge, &m, &r));
  assert_int_equal(r->nremark, nremark);
  for (int i = 0; i < nremark; i++) assert_string_equal(r->remark[i].text, remark[i]);
  corot_mesh_report_destroy(r);
  return m;
}

static void refused(const char *text, bool cuts, const char *message) {
  corot_mesh *m;
  corot_mesh_report *r;
  assert_fails(mend(text, cuts, 0, &m, &r), COROT_EFORMAT, message);
  assert_null(m);
  corot_mesh_report_destroy(r);
}

#define HEAD "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
#define CORNERS "1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n"

/* --- Nodes --- */

static const char arc[] = HEAD
    "$PhysicalNames\n3\n0 1 \"centre\"\n1 2 \"axis\"\n3 3 \"body\"\n$EndPhysicalNames\n"
    "$Nodes\n7\n90 9 9 9\n" CORNERS
    "91 8 nan 8\n$EndNodes\n"
    "$Elements\n4\n1 15 2 1 1 90\n2 1 2 2 1 90 1\n3 4 2 3 1 1 2 3 4\n4 4 2 3 1 2 3 4 5\n"
    "$EndElements\n";

static void nodes_in_no_tet_are_left_out(void **state) {
  (void)state;
  static const char *const remarks[] = {
      "2 nodes of the mesh file are in no tet and are left out (90, 91 in the file); the others "
      "are "
      "numbered without them",
      "group centre of the mesh file has none but nodes that are in no tet, and is left out"};
  corot_mesh *m = mended(arc, false, 0, 2, remarks);
  assert_int_equal(m->nnode, 5);
  assert_close(m->x[4][2], 1, 0, 0);
  assert_int_equal(m->tet[0][0], 0);
  assert_int_equal(m->ngroup, 2);
  assert_string_equal(m->group[0].name, "axis"); /* it has lost one node, and has another */
  assert_int_equal(m->group[0].nnode, 1);
  assert_int_equal(m->group[0].node[0], 0);
  assert_int_equal(corot_mesh_find_group(m, "body")->nnode, 5);
  corot_mesh_destroy(m);
}

static void many_numbers_are_cut_short(void **state) {
  (void)state;
  static const char *const remark[] = {
      "10 nodes of the mesh file are in no tet and are left out (11, 12, 13, 14, 15, 16, 17, 18, "
      "... "
      "in the file); the others are numbered without them"};
  char text[1000];
  snprintf(text, sizeof text, "%s$Nodes\n15\n%s", HEAD, CORNERS);
  for (int i = 11; i < 21; i++) snprintf(text + strlen(text), 100, "%d 0 0 %d\n", i, i);
  strcat(text, "$EndNodes\n$Elements\n2\n1 4 2 3 1 1 2 3 4\n2 4 2 3 1 2 3 4 5\n$EndElements\n");
  corot_mesh_destroy(mended(text, false, 0, 1, remark));
}

static void a_sound_file_has_no_remarks(void **state) {
  (void)state;
  static const char *const files[] = {DATA "two.msh22.msh", DATA "two_2.msh41b.msh",
                                      DATA "two.ele",       DATA "two.vtk51.vtk",
                                      DATA "quarter.inp",   DATA "two.mesh"};
  for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
    corot_mesh *a, *b = read_mesh(files[i]);
    corot_mesh_report *r;
    assert_ok(corot_mesh_read_mended(files[i], NULL, &a, &r));
    assert_int_equal(r->nremark, 0);
    assert_int_equal(a->nnode, b->nnode);
    assert_memory_equal(a->x, b->x, (size_t)a->nnode * sizeof *a->x);
    assert_memory_equal(a->tet, b->tet, (size_t)a->ntet * sizeof *a->tet);
    assert_int_equal(a->ngroup, b->ngroup);
    corot_mesh_report_destroy(r);
    corot_mesh_destroy(a);
    corot_mesh_destroy(b);
  }
}

/* Two tets that touch at a face, each with nodes of its own. */
static const char apart[] = HEAD
    "$Nodes\n8\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n12 1 1e-7 0\n13 0 1 1e-7\n14 -1e-7 0 1\n5 1 1 "
    "1\n$EndNodes\n"
    "$Elements\n3\n1 4 2 3 1 1 2 3 4\n2 4 2 4 1 12 13 14 5\n3 2 2 5 1 12 13 14\n$EndElements\n";

static void nodes_at_one_place_are_merged_on_request(void **state) {
  (void)state;
  static const char *const remark[] = {
      "3 nodes of the mesh file are merged with others within 1e-06 m (12, 13, 14 in the file)"};
  corot_mesh *m = mended(apart, false, 0, 0, NULL);
  assert_int_equal(m->nnode, 8);
  corot_mesh_destroy(m);
  m = mended(apart, false, 1e-6, 1, remark);
  assert_int_equal(m->nnode, 5);
  assert_memory_equal(m->tet[1], ((int[]){1, 2, 3, 4}), sizeof *m->tet);
  assert_close(m->x[1][1], 0, 0, 0); /* the first of those that become one */
  assert_int_equal(corot_mesh_find_group(m, "5")->ntri, 1);
  assert_int_equal(corot_mesh_find_group(m, "4")->node[0], 1);
  corot_mesh_destroy(m);

  corot_mesh_report *r;
  assert_fails(mend(apart, false, 3, &m, &r), COROT_EFORMAT, "element 1 has node 1 twice");
  corot_mesh_report_destroy(r);
  assert_fails(corot_mesh_read_mended("x", &(corot_mending){.merge = -1}, &m, &r), COROT_EINVAL,
               "merge is -1, not >= 0");
}

/* --- Tets --- */

static const char flipped[] = HEAD
    "$Nodes\n5\n" CORNERS
    "$EndNodes\n"
    "$Elements\n4\n11 4 2 1 1 1 3 2 4\n12 4 2 1 1 2 3 4 5\n13 4 2 2 1 5 3 2 4\n14 2 2 3 1 2 3 4\n"
    "$EndElements\n";

static void left_handed_tets_are_turned_round(void **state) {
  (void)state;
  static const char *const remarks[] = {
      "1 left-handed tet of the mesh file is turned round (element 11)",
      "1 tet of the mesh file is there before, with the same corners, and counts once (element "
      "13)"};
  corot_mesh *m = mended(flipped, false, 0, 2, remarks), *again;
  assert_int_equal(m->ntet, 2);
  assert_memory_equal(m->tet[0], ((int[]){2, 0, 1, 3}), sizeof *m->tet);
  assert_int_equal(corot_mesh_find_group(m, "1")->ntet, 2);
  assert_int_equal(corot_mesh_find_group(m, "2")->tet[0], 1); /* that of the first */
  assert_ok(corot_mesh_create(m->nnode, (const double(*)[3])m->x, m->ntet, (const int(*)[4])m->tet,
                              &again));
  corot_mesh_destroy(again);
  corot_mesh_destroy(m);
}

/* Of a curved body every third tet is mirrored in its order of nodes: it becomes what it was. */
static void ten_node_tets_are_turned_with_the_nodes_on_their_edges(void **state) {
  (void)state;
  static const int mirrored[10] = {1, 0, 2, 3, 4, 6, 5, 8, 7, 9};
  corot_mesh *m = read_mesh(DATA "quarter.msh"), *back;
  corot_mesh_report *r;
  double volume = corot_mesh_measure(m).volume;
  char *dir = temporary_folder();
  for (int e = 0; e < m->ntet; e += 3) {
    int v[10], w[10];
    memcpy(v, m->tet[e], sizeof m->tet[e]);
    memcpy(v + 4, m->mid[e], sizeof m->mid[e]);
    for (int k = 0; k < 10; k++) w[k] = v[mirrored[k]];
    memcpy(m->tet[e], w, sizeof m->tet[e]);
    memcpy(m->mid[e], w + 4, sizeof m->mid[e]);
  }
  assert_ok(corot_mesh_write(m, in(dir, "m.msh")));
  assert_fails(corot_mesh_read(in(dir, "m.msh"), &back), COROT_EFORMAT, "\nand 12 more");
  assert_ok(corot_mesh_read_mended(in(dir, "m.msh"), NULL, &back, &r));
  assert_int_equal(r->nremark, 1);
  assert_int_equal(r->remark[0].what, COROT_MENDED_TURNED);
  assert_int_equal(r->remark[0].count, 22);
  assert_close(corot_mesh_measure(back).volume, volume, 1e-14, 0);
  corot_mesh_report_destroy(r);
  corot_mesh_destroy(back);
  corot_mesh_destroy(m);
  remove_folder(dir);
}

/* --- What cannot be mended --- */

static void all_faults_are_told_at_once(void **state) {
  (void)state;
  static const char text[] = HEAD
      "$Nodes\n9\n" CORNERS
      "6 inf 0 0\n7 2 0 0\n8 0 0 -1\n9 -1 -1 1\n$EndNodes\n"
      "$Elements\n7\n1 4 2 1 1 1 2 3 4\n2 4 2 1 1 2 3 4 5\n3 4 2 1 1 1 2 7 4\n4 4 2 1 1 1 2 3 99\n"
      "5 4 2 1 1 1 2 3 6\n6 4 2 1 1 8 2 1 3\n7 4 2 1 1 1 2 2 3\n$EndElements\n";
  static const char told[] =
      "m.msh:21: element 4: node 99 does not exist\n"
      "m.msh:11: node 6: x is inf\n"
      "m.msh:24: element 7 has node 2 twice\n"
      "m.msh:20: element 3 is flat: its volume is 0, its longest edge 2.23607\n"
      "m.msh:23: elements 1, 5 and 6 share the face 1 2 3";
  refused(text, false, told);
  assert_string_equal(corot_error(), told); /* node 9 is in no tet, which is mended */
  corot_mesh *m;
  assert_fails(corot_mesh_parse("m.msh", text, strlen(text), NULL, &m), COROT_EFORMAT,
               "m.msh:14: node 9 is in no tet\nm.msh:23: elements 1, 5 and 6 share the face");
}

/* In the order of the file, and no more than ten. */
static void more_than_ten_are_counted(void **state) {
  (void)state;
  char text[2000];
  snprintf(text, sizeof text, "%s$Nodes\n5\n%s$EndNodes\n$Elements\n14\n", HEAD, CORNERS);
  for (int i = 1; i <= 13; i++)
    snprintf(text + strlen(text), 100, "%d 4 2 1 1 1 2 3 %d\n", i, 50 + i);
  strcat(text, "14 4 2 1 1 1 2 3 4\n$EndElements\n");
  refused(text, false, "m.msh:14: element 1: node 51 does not exist\nm.msh:15: element 2: node 52");
  refused(text, false, "m.msh:23: element 10: node 60 does not exist\nand 3 more");
  assert_null(strstr(corot_error(), "61"));
}

/* Three tets that overlap stay refused when they are turned. */
static void a_tet_on_the_wrong_side_is_refused(void **state) {
  (void)state;
  refused(HEAD
          "$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 .1 .1 .1\n$EndNodes\n"
          "$Elements\n2\n1 4 2 1 1 1 2 3 4\n2 4 2 1 1 1 2 3 5\n$EndElements\n",
          false, "m.msh:15: elements 1 and 2 overlap: they are on the same side of the face 1 2 3");
}

static void a_host_is_told_all_faults_too(void **state) {
  (void)state;
  static const double x[5][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {2, 0, 0}};
  static const int tet[3][4] = {{0, 1, 2, 3}, {0, 2, 1, 4}, {0, 1, 4, 3}};
  corot_mesh *m;
  assert_fails(corot_mesh_create(5, x, 3, tet, &m), COROT_EINVAL,
               "tet 1 is flat: its volume is 0, its longest edge 2.23607\n"
               "tet 2 is flat: its volume is 0, its longest edge 2.23607");
}

/* --- Other cells --- */

static double area(const corot_mesh *m) {
  int ntri, (*tri)[3];
  double sum = 0;
  assert_ok(corot_mesh_boundary(m, &ntri, &tri));
  for (int i = 0; i < ntri; i++) {
    double a[3], b[3], n[3];
    for (int k = 0; k < 3; k++) {
      a[k] = m->x[tri[i][1]][k] - m->x[tri[i][0]][k];
      b[k] = m->x[tri[i][2]][k] - m->x[tri[i][0]][k];
    }
    for (int k = 0; k < 3; k++)
      n[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
    sum += sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) / 2;
  }
  free(tri);
  return sum;
}

/* A file in millimetres; the tolerance of merging is in metres. */
static void coordinates_become_metres(void **state) {
  (void)state;
  corot_mesh *a = read_mesh(DATA "two.msh22.msh"), *b = NULL;
  corot_mesh_report *r;
  assert_ok(corot_mesh_read_mended(DATA "two.msh22.msh",
                                   &(corot_mending){.scale = 1e-3, .merge = 1e-4}, &b, &r));
  assert_int_equal(r->nremark, 0);
  for (int i = 0; i < 3 * a->nnode; i++)
    assert_true(b->x[i / 3][i % 3] == 1e-3 * a->x[i / 3][i % 3]);
  corot_mesh_report_destroy(r);
  corot_mesh_destroy(b);
  assert_fails(corot_mesh_read_mended(DATA "two.msh22.msh", &(corot_mending){.scale = -1}, &b, &r),
               COROT_EINVAL, "scale is -1, not >= 0");
  assert_fails(
      corot_mesh_read_mended(DATA "two.msh22.msh", &(corot_mending){.scale = 1e100}, &b, &r),
      COROT_EFORMAT, "node 9: z is 2e+100");
  corot_mesh_destroy(a);
}

/* As gmsh writes them in each format: the skin has the area of the body's, so all faces match. */
static void cells_of_all_kinds_are_cut(void **state) {
  (void)state;
  static const char *const files[] = {DATA "cells.msh", DATA "cells.msh22b.msh", DATA "cells.vtk"};
  for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
    corot_mesh *m = NULL;
    corot_mesh_report *r;
    assert_fails(
        corot_mesh_read(files[i], &m), COROT_EFORMAT,
        ": the file has 4 pyramids, 28 prisms and 8 hexahedra beside 107 tets: only tets are "
        "supported; mesh.cut: true of a scenario, or --cut of corot mesh convert, cuts them "
        "into tets");
    assert_fails(corot_mesh_read_mended(files[i], NULL, &m, &r), COROT_EFORMAT, "8 hexahedra");
    assert_ok(corot_mesh_read_mended(files[i], &(corot_mending){.cut = 1}, &m, &r));
    assert_int_equal(r->nremark, 1);
    assert_int_equal(r->remark[0].count, 140);
    assert_string_equal(r->remark[0].text,
                        "4 pyramids, 28 prisms and 8 hexahedra of the mesh file are cut into 140 "
                        "tets, each face by the diagonal from its corner of the lowest number");
    assert_int_equal(m->ntet, 247);
    assert_close(corot_mesh_measure(m).volume, 2.5, 1e-13, 0);
    assert_close(area(m), 12, 1e-13, 0);
    corot_mesh_report_destroy(r);
    corot_mesh_destroy(m);
  }
}

static void groups_of_cells_are_groups_of_their_tets(void **state) {
  (void)state;
  for (int i = 0; i < 2; i++) {
    corot_mesh *m;
    corot_mesh_report *r;
    assert_ok(corot_mesh_read_mended(i ? DATA "cells.msh22b.msh" : DATA "cells.msh",
                                     &(corot_mending){.cut = 1}, &m, &r));
    assert_int_equal(corot_mesh_find_group(m, "lower")->ntet, 48);
    assert_int_equal(corot_mesh_find_group(m, "all")->ntet, 247);
    assert_int_equal(corot_mesh_find_group(m, "top")->ntri, 14);
    assert_int_equal(corot_mesh_find_group(m, "bottom")->ntri, 8); /* of 4 quads */
    assert_int_equal(corot_mesh_find_group(m, "side")->ntri, 8);
    corot_mesh_report_destroy(r);
    corot_mesh_destroy(m);
  }
}

/* A hexahedron with a pyramid on its top and a prism at its side, on which a tet stands. */
static const char mixed_medit[] =
    "MeshVersionFormatted 2\nDimension 3\nVertices 12\n"
    "0 0 0 0 1 0 0 0 1 1 0 0 0 1 0 0 0 0 1 0 1 0 1 0 1 1 1 0 0 1 1 0 .5 .5 2 0 2 .5 0 0 2 .5 1 0 "
    "1.3 "
    ".5 2 0\n"
    "Quadrilaterals 2 1 2 3 4 7 5 6 7 8 0\nHexahedra 1 1 2 3 4 5 6 7 8 1\nPyramids 1 5 6 7 8 9 2\n"
    "Prisms 1 2 10 3 6 11 7 1\nTetrahedra 1 6 11 7 12 2\nEnd\n";

static const char mixed_inp[] =
    "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n9,.5,.5,2\n"
    "10,2,.5,0\n11,2,.5,1\n12,1.3,.5,2\n"
    "*ELEMENT,TYPE=C3D8R,ELSET=E\n1,1,2,3,4,5,6,7,8\n*ELEMENT,TYPE=C3D5\n2,5,6,7,8,9\n"
    "*ELEMENT,TYPE=C3D6,ELSET=E\n3,2,10,3,6,11,7\n*ELEMENT,TYPE=C3D4\n4,6,11,7,12\n"
    "*ELEMENT,TYPE=S4,ELSET=BASE\n5,1,2,3,4\n"
    "*SURFACE,NAME=HEX\n1,S1\n1,S3\n1,S5\n1,S6\n*SURFACE,NAME=PRISM\n3,S1\n3,S3\n3,S4\n"
    "*SURFACE,NAME=PYRAMID\n2,S2\n2,S3\n2,S4\n2,S5\n*SURFACE,NAME=INSIDE\n1,S2\n1,S4\n2,S1\n3,S2\n"
    "3,S5\n";

static corot_mesh *read_mixed(const char *text) {
  static const char *const remark[] = {
      "1 pyramid, 1 prism and 1 hexahedron of the mesh file are cut into 11 tets, each face by the "
      "diagonal from its corner of the lowest number"};
  refused(text, false, "m.msh: the file has 1 pyramid, 1 prism and 1 hexahedron beside 1 tet: ");
  corot_mesh *m = mended(text, true, 0, 1, remark);
  assert_int_equal(m->ntet, 12);
  assert_close(corot_mesh_measure(m).volume, 2, 1e-14, 0);
  return m;
}

/* Faces of Abaqus' solids are on the surface, or between two of them, by their numbers. */
static void cells_of_other_formats_are_cut(void **state) {
  (void)state;
  static const struct {
    const char *name;
    int ntri, ntet;
  } groups[] = {{"E", 0, 9},     {"BASE", 2, 0},    {"HEX", 8, 0},
                {"PRISM", 5, 0}, {"PYRAMID", 4, 0}, {"INSIDE", 5, 0}};
  corot_mesh *a = read_mixed(mixed_medit), *b = read_mixed(mixed_inp);
  assert_close(area(a), area(b), 1e-14, 0);
  assert_int_equal(corot_mesh_find_group(a, "1")->ntet, 9);
  assert_int_equal(corot_mesh_find_group(a, "2")->ntet, 3);
  assert_int_equal(corot_mesh_find_group(a, "7")->ntri, 2);
  for (size_t i = 0; i < sizeof groups / sizeof *groups; i++) {
    const corot_group *g = corot_mesh_find_group(b, groups[i].name);
    assert_non_null(g);
    assert_int_equal(g->ntri, groups[i].ntri);
    assert_int_equal(g->ntet, groups[i].ntet);
  }
  corot_mesh_destroy(a);
  corot_mesh_destroy(b);
}

/* A small generator of permutations: the same every time. */
static unsigned next_random(unsigned *seed) { return *seed = *seed * 1664525u + 1013904223u; }

/* n^3 hexahedra whose nodes are numbered by chance: whatever the numbers, faces match. */
static void faces_match_however_nodes_are_numbered(void **state) {
  (void)state;
  enum { N = 3, M = N + 1 };
  unsigned seed = 1;
  for (int turn = 0; turn < 20; turn++) {
    int number[M * M * M];
    char *text = malloc(20000);
    assert_non_null(text);
    for (int i = 0; i < M * M * M; i++) number[i] = i + 1;
    for (int i = M * M * M - 1; i > 0; i--) {
      int j = (int)((next_random(&seed) >> 8) % (unsigned)(i + 1)), swap = number[i];
      number[i] = number[j];
      number[j] = swap;
    }
    strcpy(text, HEAD "$Nodes\n64\n");
    for (int tag = 1; tag <= M * M * M; tag++) /* numbers ascend: the place in the file decides */
      for (int i = 0; i < M * M * M; i++)
        if (number[i] == tag)
          sprintf(text + strlen(text), "%d %d %d %d\n", tag, i % M, i / M % M, i / M / M);
    strcat(text, "$EndNodes\n$Elements\n27\n");
    for (int c = 0; c < N * N * N; c++) {
      int a = c % N + M * (c / N % N + M * (c / N / N));
      const int v[8] = {a,         a + 1,         a + 1 + M,         a + M,
                        a + M * M, a + 1 + M * M, a + 1 + M + M * M, a + M + M * M};
      sprintf(text + strlen(text), "%d 5 2 1 1", c + 1);
      for (int k = 0; k < 8; k++) sprintf(text + strlen(text), " %d", number[v[k]]);
      strcat(text, "\n");
    }
    strcat(text, "$EndElements\n");
    corot_mesh *m;
    corot_mesh_report *r;
    assert_ok(mend(text, true, 0, &m, &r));
    assert_int_equal(m->ntet, 6 * N * N * N);
    assert_close(corot_mesh_measure(m).volume, N * N * N, 1e-13, 0);
    assert_close(area(m), 6 * N * N, 1e-13, 0);
    corot_mesh_report_destroy(r);
    corot_mesh_destroy(m);
    free(text);
  }
}

#define CUBE \
  "$Nodes\n8\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 1\n7 1 1 1\n8 0 1 1\n$EndNodes\n"

#define CUBE_AND_TIP                                                                               \
  "$Nodes\n9\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 1\n7 1 1 1\n8 0 1 1\n9 .5 .4 2\n" \
  "$EndNodes\n"

/* Left-handed as VTK has prisms, and with corners that are one. */
static void the_hand_of_a_cell_does_not_matter(void **state) {
  (void)state;
  static const struct {
    const char *element;
    int ntet;
    double volume;
  } cells[] = {
      {"1 5 2 1 1 1 2 3 4 5 6 7 8", 6, 1},      {"1 5 2 1 1 5 6 7 8 1 2 3 4", 6, 1},
      {"1 6 2 1 1 1 2 3 5 6 7", 3, 0.5},        {"1 6 2 1 1 5 6 7 1 2 3", 3, 0.5},
      {"1 7 2 1 1 1 2 3 4 7", 2, 1. / 3},       {"1 7 2 1 1 4 3 2 1 7", 2, 1. / 3},
      {"1 5 2 1 1 1 2 3 3 5 6 7 7", 3, 0.5}, /* a prism */
      {"1 5 2 1 1 1 2 3 3 5 5 5 5", 1, 1. / 6},
  };
  for (size_t i = 0; i < sizeof cells / sizeof *cells; i++) {
    char text[500];
    corot_mesh *m;
    corot_mesh_report *r;
    snprintf(text, sizeof text, HEAD CUBE "$Elements\n1\n%s\n$EndElements\n", cells[i].element);
    assert_ok(mend(text, true, 0, &m, &r));
    assert_int_equal(m->ntet, cells[i].ntet);
    assert_close(corot_mesh_measure(m).volume, cells[i].volume, 1e-14, 0);
    corot_mesh_report_destroy(r);
    corot_mesh_destroy(m);
  }
}

static void cells_that_are_none_are_refused(void **state) {
  (void)state;
#define ONE(element) HEAD CUBE "$Elements\n1\n" element "\n$EndElements\n"
  refused(ONE("1 5 2 1 1 1 2 3 4 7 8 5 6"), true,
          "m.msh:17: element 1 is a hexahedron that is folded: ");
  refused(ONE("1 5 2 1 1 1 2 2 1 1 2 2 1"), true,
          "m.msh:17: element 1 is a hexahedron of too few different corners");
  /* tets stand on the top of a cube, on halves by either diagonal */
  refused(
      HEAD CUBE_AND_TIP
      "$Elements\n3\n1 5 2 1 1 1 2 3 4 5 6 7 8\n2 4 2 1 1 5 6 8 9\n3 4 2 1 1 6 7 8 9\n"
      "$EndElements\n",
      true,
      "m.msh:18: element 1: tets at its face 5 6 7 8 have the other diagonal: they do not match "
      "without pyramids between");
  static const char *const remark[] = {
      "1 hexahedron of the mesh file is cut into 6 tets, each face by the diagonal from its corner "
      "of "
      "the lowest number"};
  corot_mesh_destroy(mended(HEAD CUBE_AND_TIP
                            "$Elements\n3\n1 5 2 1 1 1 2 3 4 5 6 7 8\n2 4 2 1 1 5 6 7 9\n"
                            "3 4 2 1 1 5 7 8 9\n$EndElements\n",
                            true, 0, 1, remark));
  refused(ONE("1 6 2 1 1 1 2 3 5 6 9"), true, "m.msh:17: element 1: node 9 does not exist");
  refused(
      ONE("1 12 2 1 1 1"), true,
      "m.msh:17: element 1 is a 27-node hexahedron: only tets of 4 or 10 nodes are supported, and "
      "other solids of first order, to be cut into tets");
  refused(HEAD CUBE "$Elements\n2\n1 4 2 1 1 1 2 3 5\n2 3 2 1 1 1 2 3 4\n$EndElements\n", false,
          "m.msh:18: element 2 of a physical group is a 4-node quadrangle: mesh.cut: true of a "
          "scenario, or --cut of corot mesh convert, cuts it into triangles");
  refused(HEAD CUBE
          "$Elements\n2\n1 5 2 1 1 1 2 3 4 5 6 7 8\n2 11 2 1 1 1 2 3 4 5 6 7 8 1 2\n"
          "$EndElements\n",
          true,
          "m.msh:18: element 2 is a tet of 10 nodes, the tets before it have 4: orders do not mix");
}

/* --- Memory --- */

static corot_status try_mended(void *path) {
  corot_mesh *m = NULL;
  corot_mesh_report *r = NULL;
  corot_status status = corot_mesh_read_mended(path, &(corot_mending){1, 1e-9}, &m, &r);
  assert_true(!status == !!m && !m == !r);
  corot_mesh_destroy(m);
  corot_mesh_report_destroy(r);
  return status;
}

static void failed_allocations(void **state) {
  (void)state;
  char *dir = temporary_folder();
  char path[1024];
  snprintf(path, sizeof path, "%s", in(dir, "m.msh"));
  const char *const texts[] = {arc, apart, flipped};
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
    put_file(path, texts[i]);
    assert_true(assert_survives_failed_allocations(try_mended, path) > 20);
  }
  assert_true(assert_survives_failed_allocations(try_mended, (void *)(DATA "cells.msh")) > 20);
  remove_folder(dir);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(nodes_in_no_tet_are_left_out),
      cmocka_unit_test(many_numbers_are_cut_short),
      cmocka_unit_test(a_sound_file_has_no_remarks),
      cmocka_unit_test(nodes_at_one_place_are_merged_on_request),
      cmocka_unit_test(left_handed_tets_are_turned_round),
      cmocka_unit_test(ten_node_tets_are_turned_with_the_nodes_on_their_edges),
      cmocka_unit_test(all_faults_are_told_at_once),
      cmocka_unit_test(more_than_ten_are_counted),
      cmocka_unit_test(a_tet_on_the_wrong_side_is_refused),
      cmocka_unit_test(a_host_is_told_all_faults_too),
      cmocka_unit_test(coordinates_become_metres),
      cmocka_unit_test(cells_of_all_kinds_are_cut),
      cmocka_unit_test(groups_of_cells_are_groups_of_their_tets),
      cmocka_unit_test(cells_of_other_formats_are_cut),
      cmocka_unit_test(faces_match_however_nodes_are_numbered),
      cmocka_unit_test(the_hand_of_a_cell_does_not_matter),
      cmocka_unit_test(cells_that_are_none_are_refused),
      cmocka_unit_test(failed_allocations),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
