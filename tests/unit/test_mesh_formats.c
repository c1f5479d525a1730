/* Mesh files in every format that is written: read again, they are the same mesh. */
#include "alloc.h"
#include "check.h"
#include "mesh_text.h"
#include "temporary.h"

#include <sys/stat.h>

static const char *const keeps_all[] = {"m.msh", "m.vtu", "m.vtk", "m.inp"};
static const char *const bodies[] = {DATA "two.msh22.msh", DATA "two_2.msh41.msh",
                                     DATA "quarter.msh", DATA "sides_2.ele", DATA "two.vtk"};
enum { NBODY = sizeof bodies / sizeof *bodies };

static corot_mesh *written(const corot_mesh *m, const char *path, const char *format, int nremark) {
  corot_mesh *back;
  corot_mesh_report *r, *ignored;
  assert_ok(corot_mesh_write_as(m, path, format, &r));
  assert_int_equal(r->nremark, nremark);
  corot_mesh_report_destroy(r);
  assert_ok(corot_mesh_read_mended(path, NULL, &back, &ignored));
  assert_int_equal(ignored->nremark, 0);
  corot_mesh_report_destroy(ignored);
  return back;
}

static void assert_same_body(const corot_mesh *a, const corot_mesh *b) {
  assert_int_equal(a->nnode, b->nnode);
  assert_int_equal(a->ntet, b->ntet);
  assert_memory_equal(a->x, b->x, (size_t)a->nnode * sizeof *a->x);
  assert_memory_equal(a->tet, b->tet, (size_t)a->ntet * sizeof *a->tet);
  assert_true(!a->mid == !b->mid);
  if (a->mid) assert_memory_equal(a->mid, b->mid, (size_t)a->ntet * sizeof *a->mid);
}

/* A triangle may begin with another of its corners. */
static void assert_same_triangle(const int a[3], const int b[3]) {
  int k = 0;
  while (k < 2 && b[k] != a[0]) k++;
  for (int i = 0; i < 3; i++) assert_int_equal(a[i], b[(k + i) % 3]);
}

static void assert_same_group(const corot_group *a, const corot_group *b) {
  assert_int_equal(a->nnode, b->nnode);
  assert_int_equal(a->ntri, b->ntri);
  assert_int_equal(a->ntet, b->ntet);
  assert_memory_equal(a->node, b->node, (size_t)a->nnode * sizeof *a->node);
  for (int i = 0; i < a->ntri; i++) assert_same_triangle(a->tri[i], b->tri[i]);
  if (a->ntet) assert_memory_equal(a->tet, b->tet, (size_t)a->ntet * sizeof *a->tet);
}

static void assert_same_mesh(const corot_mesh *a, const corot_mesh *b) {
  assert_same_body(a, b);
  assert_int_equal(a->ngroup, b->ngroup);
  for (int g = 0; g < a->ngroup; g++) {
    assert_string_equal(a->group[g].name, b->group[g].name);
    assert_same_group(&a->group[g], &b->group[g]);
  }
}

static void bodies_and_groups_come_back(void **state) {
  (void)state;
  char *dir = temporary_folder();
  for (int i = 0; i < NBODY; i++) {
    corot_mesh *m = read_mesh(bodies[i]);
    for (size_t k = 0; k < sizeof keeps_all / sizeof *keeps_all; k++) {
      corot_mesh *back = written(m, in(dir, keeps_all[k]), NULL, 0);
      assert_same_mesh(m, back);
      corot_mesh_destroy(back);
    }
    corot_mesh_destroy(m);
  }
  remove_folder(dir);
}

/* Coordinates that decimals of fewer than 17 digits do not have. */
static void coordinates_keep_every_bit(void **state) {
  (void)state;
  static const double x[4][3] = {
      {1. / 3, -0.0, 5e-324}, {1e99, 0.1, 2. / 3}, {0.1 + 0.2, 1e99, 1e-300}, {3.3, 7e22, 1e99}};
  static const int tet[1][4] = {{0, 1, 2, 3}};
  static const char *const names[] = {"m.msh", "m.vtu", "m.vtk", "m.inp", "m.ele", "m.mesh"};
  char *dir = temporary_folder();
  corot_mesh *m;
  assert_ok(corot_mesh_create(4, x, 1, tet, &m));
  for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
    corot_mesh *back = written(m, in(dir, names[k]), NULL, 0);
    assert_same_body(m, back);
    corot_mesh_destroy(back);
  }
  corot_mesh_destroy(m);
  remove_folder(dir);
}

static void numbers_take_the_place_of_names(void **state) {
  (void)state;
  char *dir = temporary_folder();
  corot_mesh *m =
      read_mesh(DATA "two.msh22.msh"); /* its volumes, and its point and edge, overlap */
  corot_mesh_report *r;
  assert_ok(corot_mesh_write_as(m, in(dir, "m.node"), NULL, &r));
  static const char *const tetgen[] = {
      "the file has numbers in the place of the names of groups of nodes: tip is 1, edge is 2",
      "group edge lacks 1 of its nodes in the file, which has one number for each: groups before "
      "it "
      "have them",
      "the file has numbers in the place of the names of groups of tets: lower is 1, all is 2",
      "group all lacks 24 of its tets in the file, which has one number for each: groups before it "
      "have them",
      "the file has numbers in the place of the names of groups of triangles: base is 1, middle is "
      "2, "
      "top is 3"};
  assert_int_equal(r->nremark, 5);
  for (int i = 0; i < 5; i++) {
    assert_int_equal(r->remark[i].what, COROT_MENDED_LOST);
    assert_string_equal(r->remark[i].text, tetgen[i]);
  }
  corot_mesh_report_destroy(r);
  corot_mesh *back = read_mesh(in(dir, "m.ele"));
  assert_same_body(m, back);
  assert_same_group(corot_mesh_find_group(back, "face-2"), corot_mesh_find_group(m, "middle"));
  assert_same_group(corot_mesh_find_group(back, "region-1"), corot_mesh_find_group(m, "lower"));
  assert_same_group(corot_mesh_find_group(back, "marker-1"), corot_mesh_find_group(m, "tip"));
  corot_mesh_destroy(back);

  assert_ok(corot_mesh_write_as(m, in(dir, "m.mesh"), NULL, &r));
  assert_int_equal(r->nremark, 5);
  assert_string_equal(r->remark[4].text,
                      "3 nodes of group edge are of no triangle or tet of it, and left out: MEDIT "
                      "files have no groups of nodes");
  corot_mesh_report_destroy(r);
  back = read_mesh(in(dir, "m.mesh"));
  assert_same_body(m, back);
  assert_same_group(corot_mesh_find_group(back, "surface-2"), corot_mesh_find_group(m, "middle"));
  corot_mesh_destroy(back);
  corot_mesh_destroy(m);
  remove_folder(dir);
}

/* What TetGen or MEDIT have called so keeps its number. */
static void names_that_are_numbers_stay(void **state) {
  (void)state;
  char *dir = temporary_folder();
  static const char *const files[][2] = {{DATA "sides.ele", "m.ele"},
                                         {DATA "sides_2.ele", "m.node"},
                                         {DATA "two.mesh", "m.mesh"},
                                         {DATA "quarter.mesh", "n.mesh"}};
  for (int i = 0; i < 4; i++) {
    corot_mesh *m = read_mesh(files[i][0]), *back = written(m, in(dir, files[i][1]), NULL, 0);
    assert_same_mesh(m, back);
    corot_mesh_destroy(back);
    corot_mesh_destroy(m);
  }
  remove_folder(dir);
}

/* Names that a format has to spell in another way. */
static void names_of_any_characters(void **state) {
  (void)state;
  char *dir = temporary_folder();
  corot_mesh *m;
  const corot_box box = {.size = {1, 1, 1}, .cells = {1, 1, 1}};
  static const int node[2] = {0, 5};
  assert_ok(corot_mesh_box(&box, &m));
  assert_ok(corot_mesh_group_nodes(m, "a <b> & 'c' 100%41", 2, node));
  assert_ok(corot_mesh_group_tets(m, "\xc3\xa4, b ", 2, node));
  for (int k = 0; k < 3; k++) {
    corot_mesh *back = written(m, in(dir, keeps_all[k]), NULL, 0);
    assert_same_mesh(m, back);
    corot_mesh_destroy(back);
  }
  corot_mesh_report *r;
  assert_ok(corot_mesh_write_as(m, in(dir, "m.inp"), NULL, &r));
  assert_int_equal(r->nremark, 1);
  assert_string_equal(r->remark[0].text, "group \xc3\xa4, b  is called \xc3\xa4_ b_ in the file");
  corot_mesh_report_destroy(r);
  assert_ok(corot_mesh_group_nodes(m, "XMIN", 2, node));
  assert_fails(
      corot_mesh_write_as(m, in(dir, "n.inp"), NULL, NULL), COROT_EINVAL,
      "groups 'xmin' and 'XMIN' would be one in an Abaqus file: call one of them something "
      "else");
  assert_true(access(in(dir, "n.inp"), F_OK) != 0);
  corot_mesh_destroy(m);
  remove_folder(dir);
}

static void the_suffix_or_a_name_says_which_format(void **state) {
  (void)state;
  char *dir = temporary_folder();
  corot_mesh *m = read_mesh(DATA "two.msh22.msh");
  assert_string_equal(corot_mesh_format(NULL, "a.msh"), "gmsh");
  assert_string_equal(corot_mesh_format(NULL, "a.ele"), "tetgen");
  assert_string_equal(corot_mesh_format("gmsh-2.2", "a.vtk"), "gmsh-2.2");
  assert_null(corot_mesh_format(NULL, "a.stl"));
  assert_fails(corot_mesh_write_as(m, in(dir, "a.stl"), NULL, NULL), COROT_EINVAL,
               "a.stl: the name does not tell the format: it may end in .msh, .vtu, .vtk, .node, "
               ".ele, .mesh or .inp, or the format be named");
  assert_fails(corot_mesh_write_as(m, in(dir, ".msh"), "stl", NULL), COROT_EINVAL,
               "there is no mesh format 'stl' to write: gmsh, gmsh-2.2, vtu, vtk, tetgen, medit, "
               "abaqus");
  corot_mesh *back = written(m, in(dir, "any.name"), "vtk", 0);
  assert_same_mesh(m, back);
  corot_mesh_destroy(back);
  corot_mesh_destroy(m);
  remove_folder(dir);
}

/* Of the three files of TetGen none is new where one cannot be written. */
static void what_cannot_be_written_is_left_alone(void **state) {
  (void)state;
  char *dir = temporary_folder();
  corot_mesh *m = read_mesh(DATA "two.msh22.msh");
  assert_fails(corot_mesh_write_as(m, in(dir, "none/a.vtu"), NULL, NULL), COROT_EIO, "none/a.vtu");
  assert_int_equal(mkdir(in(dir, "a.face"), 0700), 0);
  assert_fails(corot_mesh_write_as(m, in(dir, "a.node"), NULL, NULL), COROT_EIO,
               "a.face: is not a regular file, and stays as it is");
  assert_true(access(in(dir, "a.node"), F_OK) != 0);
  corot_mesh_destroy(m);
  remove_folder(dir);
}

typedef struct writing {
  const corot_mesh *mesh;
  const char *path;
} writing;

static corot_status try_write(void *context) {
  const writing *w = context;
  corot_mesh_report *r = NULL;
  corot_status status = corot_mesh_write_as(w->mesh, w->path, NULL, &r);
  assert_true(!status == !!r);
  corot_mesh_report_destroy(r);
  return status;
}

static void failed_allocations(void **state) {
  (void)state;
  static const char *const names[] = {"m.msh", "m.vtu", "m.vtk", "m.inp", "m.ele", "m.mesh"};
  char *dir = temporary_folder(), path[1024];
  corot_mesh *m = read_mesh(DATA "two_2.msh41.msh");
  for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
    snprintf(path, sizeof path, "%s", in(dir, names[k]));
    writing w = {m, path};
    assert_true(assert_survives_failed_allocations(try_write, &w) > 5);
  }
  corot_mesh_destroy(m);
  remove_folder(dir);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(bodies_and_groups_come_back),
      cmocka_unit_test(coordinates_keep_every_bit),
      cmocka_unit_test(numbers_take_the_place_of_names),
      cmocka_unit_test(names_that_are_numbers_stay),
      cmocka_unit_test(names_of_any_characters),
      cmocka_unit_test(the_suffix_or_a_name_says_which_format),
      cmocka_unit_test(what_cannot_be_written_is_left_alone),
      cmocka_unit_test(failed_allocations),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
