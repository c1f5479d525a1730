/* The boundary faces of TetGen, whose markers become groups. See data/make. */
#include "alloc.h"
#include "check.h"
#include "mesh_text.h"
#include "temporary.h"

static double area(const corot_mesh *m, const corot_group *g) {
  double sum[3] = {0};
  for (int t = 0; t < g->ntri; t++) {
    const double *a = m->x[g->tri[t][0]], *b = m->x[g->tri[t][1]], *c = m->x[g->tri[t][2]];
    for (int k = 0; k < 3; k++) {
      int i = (k + 1) % 3, j = (k + 2) % 3;
      sum[k] += ((b[i] - a[i]) * (c[j] - a[j]) - (b[j] - a[j]) * (c[i] - a[i])) / 2;
    }
  }
  return sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
}

/* Each side of the cube is a group of two triangles, at order 2 with the nodes on their edges,
   whether the file lists them or not; node markers are groups of their own. */
static void faces_become_groups_by_their_markers(void **state) {
  (void)state;
  static const char *const files[] = {DATA "sides.ele", DATA "sides.node", DATA "sides_2.ele"};
  for (int i = 0; i < 3; i++) {
    corot_mesh *m = NULL;
    assert_ok(corot_mesh_read(files[i], &m));
    assert_int_equal(m->ngroup, 7);
    for (int g = 0; g < 6; g++) {
      char name[32];
      snprintf(name, sizeof name, "face-%d", g + 1);
      assert_string_equal(m->group[g].name, name);
      assert_int_equal(m->group[g].ntri, 2);
      assert_int_equal(m->group[g].nnode, corot_mesh_order(m) == 1 ? 4 : 9);
      assert_int_equal(m->group[g].ntet, 0);
      assert_close(area(m, &m->group[g]), 1, 1e-15, 0);
    }
    assert_string_equal(m->group[6].name, "marker-9");
    assert_int_equal(m->group[6].ntri, 0);
    corot_mesh_destroy(m);
  }
}

static const char node[] = "4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n";
static const char ele[] = "1 4 0\n1 1 2 3 4\n";

static corot_status parse(const char *face, corot_mesh **m) {
  return corot_tetgen_parse(TEXT("m.node", node), TEXT("m.ele", ele), TEXT("m.face", face), NULL,
                            m);
}

/* Faces without a marker, and files without markers, make no groups; two tets may follow. */
static void faces_without_markers(void **state) {
  (void)state;
  static const struct {
    const char *text;
    int ngroup;
  } table[] = {
      {"1 0\n1 1 2 3\n", 0},
      {"1\n1 1 2 3 7\n", 0},
      {"2 1\n1 1 2 3 0\n2 1 2 4 -3\n", 1},
      {"1 1\n1 1 2 3 8 0 -1\n", 1},
      {"# of a cube\n\n0 1 # none\n", 0},
  };
  for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
    corot_mesh *m = NULL;
    assert_ok(parse(table[i].text, &m));
    assert_int_equal(m->ngroup, table[i].ngroup);
    if (i == 2) assert_string_equal(m->group[0].name, "face--3");
    if (i == 3) assert_string_equal(m->group[0].name, "face-8");
    corot_mesh_destroy(m);
  }
}

static void faults_of_faces(void **state) {
  (void)state;
  static const char *const bad[][2] = {
      {"", "m.face:1: expected the number of faces, found the end of the file"},
      {"9 1\n1 1 2 3 1\n", "m.face:1: the number of faces is 9, more than"},
      {"1 2\n1 1 2 3 1\n", "m.face:1: faces with 2 boundary markers"},
      {"1 1\n1 1 2 3\n", "m.face:2: expected a marker, found the end"},
      {"1 1\n1 1 2 3 1 0 0 0 0 0 0\n", "m.face:2: '0' is too much on this line"},
      {"1 1\n1 1 2 5 1\n", "m.face:2: face 1: node 5 does not exist"},
      {"1 1\n7 1 2 2 1\n", "m.face:2: face 7: the triangle is no face of a tet"},
      {"1 1\n1 1 2 3 1.5\n", "m.face:2: expected a number, found '1.5'"},
      {"1 1\n1 1 2 3 1\n2 1 2 4 1\n", "m.face:3: expected the end after 1 faces"},
      {"2 1 # of four\n1 1 2 3 1\n", "m.face:3: expected a face, found the end of the file"},
  };
  corot_mesh *m = NULL;
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
    assert_fails(parse(bad[i][0], &m), COROT_EFORMAT, bad[i][1]);
  assert_null(m);
}

/* Only a missing file is no file. */
static void a_file_of_faces_that_cannot_be_read(void **state) {
  (void)state;
  char *dir = temporary_folder(), name[1024];
  corot_mesh *m = NULL;
  put_file(in(dir, "m.node"), node);
  put_file(in(dir, "m.ele"), ele);
  assert_ok(corot_mesh_read(in(dir, "m.ele"), &m));
  corot_mesh_destroy(m);
  m = NULL;
  snprintf(name, sizeof name, "mkdir '%s'", in(dir, "m.face"));
  assert_int_equal(system(name), 0);
  assert_fails(corot_mesh_read(in(dir, "m.ele"), &m), COROT_EIO, "m.face: Is a directory");
  assert_null(m);
  remove_folder(dir);
}

static void failed_allocations(void **state) {
  (void)state;
  assert_true(assert_survives_failed_allocations(try_read, (void *)(DATA "sides.node")) > 30);
  assert_true(assert_survives_failed_allocations(try_read, (void *)(DATA "sides_2.ele")) > 30);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(faces_become_groups_by_their_markers),
      cmocka_unit_test(faces_without_markers),
      cmocka_unit_test(faults_of_faces),
      cmocka_unit_test(a_file_of_faces_that_cannot_be_read),
      cmocka_unit_test(failed_allocations),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
