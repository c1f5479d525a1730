/* MEDIT's binary files: of every version and byte order, with faults, and one by meshio. */
#include "alloc.h"
#include "check.h"
#include "mesh_text.h"

/* --- A writer --- */

typedef struct bytes {
  int version;
  bool swap;
  size_t n;
  char data[60000];
} bytes;

static void put(bytes *b, const void *value, size_t n) {
  const char *from = value;
  assert_true(b->n + n <= sizeof b->data);
  for (size_t i = 0; i < n; i++) b->data[b->n++] = from[b->swap ? n - 1 - i : i];
}

static void put_code(bytes *b, int code) { put(b, &code, sizeof code); }

static void put_whole(bytes *b, int64_t value) {
  int narrow = (int)value;
  if (b->version < 4)
    put(b, &narrow, sizeof narrow);
  else
    put(b, &value, sizeof value);
}

static void put_real(bytes *b, double value) {
  float single = (float)value;
  if (b->version == 1)
    put(b, &single, sizeof single);
  else
    put(b, &value, sizeof value);
}

static size_t place_size(const bytes *b) { return b->version < 3 ? 4 : 8; }

/* The code and room for the place of the next section, to be set by end_section. */
static size_t begin_section(bytes *b, int code) {
  const int64_t none = 0;
  put_code(b, code);
  put(b, &none, place_size(b));
  return b->n - place_size(b);
}

static void end_section(bytes *b, size_t at) {
  int64_t next = (int64_t)b->n;
  int narrow = (int)next;
  size_t end = b->n;
  b->n = at;
  if (b->version < 3)
    put(b, &narrow, sizeof narrow);
  else
    put(b, &next, sizeof next);
  b->n = end;
}

static void begin_file(bytes *b, int version, bool swap) {
  *b = (bytes){.version = version, .swap = swap};
  put_code(b, 1);
  put_code(b, version);
  size_t at = begin_section(b, 3);
  put_code(b, 3);
  end_section(b, at);
}

static void put_vertices(bytes *b, int n, const double (*x)[3]) {
  size_t at = begin_section(b, 4);
  put_whole(b, n);
  for (int i = 0; i < n; i++) {
    for (int k = 0; k < 3; k++) put_real(b, x[i][k]);
    put_whole(b, 0);
  }
  end_section(b, at);
}

/* n times `width` whole numbers. */
static void put_list(bytes *b, int code, int n, int width, const int *value) {
  size_t at = begin_section(b, code);
  put_whole(b, n);
  for (int i = 0; i < n * width; i++) put_whole(b, value[i]);
  end_section(b, at);
}

static void put_end(bytes *b) {
  size_t at = begin_section(b, 54);
  (void)at;
}

/* Two tets, triangles in groups 8 and 9 and in none, a tet in group 1; edges do not matter. */
static void put_two_tets(bytes *b, int version, bool swap) {
  static const double x[5][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  static const int edges[] = {1, 2, 4}, triangles[] = {1, 2, 3, 9, 2, 3, 5, 8, 1, 2, 4, 0},
                   tets[] = {1, 2, 3, 4, 1, 2, 3, 4, 5, 0};
  begin_file(b, version, swap);
  put_vertices(b, 5, x);
  put_list(b, 5, 1, 3, edges);
  put_list(b, 6, 3, 4, triangles);
  put_list(b, 8, 2, 5, tets);
  put_end(b);
}

static corot_status parse(const bytes *b, size_t n, corot_mesh **m) {
  char *exact = malloc(n + 1); /* so that a sanitizer sees what reads past it */
  assert_non_null(exact);
  memcpy(exact, b->data, n);
  exact[n] = 0;
  corot_status status = corot_mesh_parse("m.meshb", exact, n, NULL, m);
  free(exact);
  return status;
}

/* --- Statements --- */

static void every_version_and_byte_order_is_read(void **state) {
  (void)state;
  static const int second[4] = {1, 2, 3, 4};
  for (int version = 1; version <= 4; version++)
    for (int swap = 0; swap < 2; swap++) {
      bytes b;
      corot_mesh *m = NULL;
      put_two_tets(&b, version, swap);
      assert_ok(parse(&b, b.n, &m));
      assert_int_equal(m->nnode, 5);
      assert_int_equal(m->ntet, 2);
      assert_memory_equal(m->tet[1], second, sizeof second);
      assert_true(m->x[4][0] == 1 && m->x[3][2] == 1);
      assert_int_equal(m->ngroup, 3);
      assert_string_equal(m->group[0].name, "8");
      assert_string_equal(m->group[1].name, "9");
      assert_string_equal(m->group[2].name, "1");
      assert_int_equal(m->group[2].ntet, 1);
      corot_mesh_destroy(m);
    }
}

static void what_meshio_writes_is_what_gmsh_wrote(void **state) {
  (void)state;
  corot_mesh *a = read_mesh(DATA "two.meshb"), *b = read_mesh(DATA "two.mesh");
  assert_int_equal(a->nnode, b->nnode);
  assert_int_equal(a->ntet, b->ntet);
  assert_memory_equal(a->x, b->x, (size_t)a->nnode * sizeof *a->x);
  assert_memory_equal(a->tet, b->tet, (size_t)a->ntet * sizeof *a->tet);
  assert_int_equal(a->ngroup, b->ngroup);
  for (int g = 0; g < a->ngroup; g++) {
    assert_string_equal(a->group[g].name, b->group[g].name);
    assert_int_equal(a->group[g].ntri, b->group[g].ntri);
    assert_int_equal(a->group[g].ntet, b->group[g].ntet);
  }
  corot_mesh_destroy(a);
  corot_mesh_destroy(b);
}

/* Lists the tets of a mesh of order 2, the k-th number of each being that of node order[k]. */
static void put_curved(bytes *b, const corot_mesh *m, const int order[10]) {
  int *tet = malloc((size_t)m->ntet * 11 * sizeof *tet);
  assert_non_null(tet);
  for (int e = 0; e < m->ntet; e++) {
    for (int k = 0; k < 10; k++)
      tet[11 * e + k] = 1 + (order[k] < 4 ? m->tet[e][order[k]] : m->mid[e][order[k] - 4]);
    tet[11 * e + 10] = 3;
  }
  put_list(b, 30, m->ntet, 11, tet);
  free(tet);
}

/* The file says in which order the nodes stand, or they stand as in the text format. The volume of
   tets with curved edges depends on it: exactly the same tets are expected. */
static void orders_of_nodes_are_heeded(void **state) {
  (void)state;
  static const int plain[10] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9},
                   other[10] = {4, 0, 9, 5, 1, 8, 6, 2, 7, 3};
  static const int coordinates[10][4] = {{2, 0, 0, 0}, {0, 2, 0, 0}, {0, 0, 2, 0}, {0, 0, 0, 2},
                                         {1, 1, 0, 0}, {0, 1, 1, 0}, {1, 0, 1, 0}, {1, 0, 0, 1},
                                         {0, 1, 0, 1}, {0, 0, 1, 1}};
  corot_mesh *m = read_mesh(DATA "quarter.msh");
  for (int said = 0; said < 2; said++) {
    static bytes b;
    int ordering[10][4];
    corot_mesh *back = NULL;
    for (int k = 0; k < 10; k++) memcpy(ordering[k], coordinates[other[k]], sizeof *ordering);
    begin_file(&b, 2, false);
    put_vertices(&b, m->nnode, (const double(*)[3])m->x);
    if (said) put_list(&b, 133, 10, 4, ordering[0]);
    put_curved(&b, m, said ? other : plain);
    put_end(&b);
    assert_ok(parse(&b, b.n, &back));
    assert_memory_equal(back->tet, m->tet, (size_t)m->ntet * sizeof *m->tet);
    assert_memory_equal(back->mid, m->mid, (size_t)m->ntet * sizeof *m->mid);
    assert_true(corot_mesh_measure(back).volume == corot_mesh_measure(m).volume);
    corot_mesh_destroy(back);
  }
  corot_mesh_destroy(m);
}

/* Sections of no use may have any content; a place of 0 is the end. */
static void other_sections_are_passed_over(void **state) {
  (void)state;
  static const double x[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  static const int tet[5] = {1, 2, 3, 4, 0};
  bytes b;
  corot_mesh *m = NULL;
  begin_file(&b, 3, false);
  put_vertices(&b, 4, x);
  size_t at = begin_section(&b, 999);
  put(&b, "any", 3);
  end_section(&b, at);
  put_code(&b, 8);
  put(&b, &(int64_t){0}, 8);
  put_whole(&b, 1);
  for (int i = 0; i < 5; i++) put_whole(&b, tet[i]);
  put(&b, "rest", 4);
  assert_ok(parse(&b, b.n, &m));
  assert_int_equal(m->ntet, 1);
  corot_mesh_destroy(m);
}

static void precision_is_heeded(void **state) {
  (void)state;
  static const float x[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  static const int tet[5] = {1, 2, 3, 4, 0};
  bytes b;
  corot_mesh *m = NULL;
  begin_file(&b, 2, false);
  size_t at = begin_section(&b, 155);
  put_whole(&b, 32);
  end_section(&b, at);
  at = begin_section(&b, 4);
  put_whole(&b, 4);
  for (int i = 0; i < 4; i++) {
    for (int k = 0; k < 3; k++) put(&b, &x[i][k], sizeof x[i][k]);
    put_whole(&b, 0);
  }
  end_section(&b, at);
  put_list(&b, 8, 1, 5, tet);
  put_end(&b);
  assert_ok(parse(&b, b.n, &m));
  assert_close(corot_mesh_measure(m).volume, 1. / 6, 1e-15, 0);
  corot_mesh_destroy(m);
}

/* What becomes of the file when the whole number at `at` is another. */
static void assert_refused(bytes *b, size_t at, int value, const char *message) {
  corot_mesh *m = NULL;
  int was;
  memcpy(&was, b->data + at, sizeof was);
  memcpy(b->data + at, &value, sizeof value);
  assert_fails(parse(b, b->n, &m), COROT_EFORMAT, message);
  assert_null(m);
  memcpy(b->data + at, &was, sizeof was);
}

/* Version 2: the dimension is at 16, Vertices at 20, their count at 28, 28 bytes each; Edges at
   172; Triangles at 196, their count at 204; Tetrahedra at 256, their count at 264. */
static void faults(void **state) {
  (void)state;
  bytes b;
  put_two_tets(&b, 2, false);
  assert_refused(&b, 16, 2, "m.meshb: byte 16: the dimension is 2, not 3");
  assert_refused(&b, 28, -5, "m.meshb: byte 28: the number of vertices is -5");
  assert_refused(&b, 28, 2000000000,
                 "m.meshb: byte 28: the number of vertices is 2000000000, more");
  assert_refused(&b, 24, 7, "m.meshb: byte 24: the next section is at byte 7, of");
  assert_refused(&b, 24, 70000, "the file has been cut short, or is damaged");
  assert_refused(&b, 20, 40, "m.meshb: byte 204: Triangles are listed before Vertices");
  assert_refused(&b, 196, 4, "m.meshb: byte 204: Vertices are listed twice");
  assert_refused(&b, 208, 77, "m.meshb: byte 208: face 1: node 77 does not exist");
  assert_refused(&b, 220, -9, "m.meshb: byte 208: the reference is -9");
  assert_refused(&b, 256, 54, "m.meshb: the file has no Tetrahedra");
  assert_refused(&b, 256, 97, "m.meshb: byte 264: the file has TetrahedraP4: only tets of 4 or 10");
  assert_refused(&b, 268, 99, "m.meshb: byte 268: element 1: node 99 does not exist");
  assert_refused(&b, 196, 125, "m.meshb: byte 204: the nodes of second order are control points");
  assert_refused(&b, 196, 133, "m.meshb: byte 204: the order of nodes does not have each");
  assert_refused(&b, 196, 155, "m.meshb: byte 204: reals of 3 bits are not known");
}

/* The first 20 bytes say what the rest is: no text that begins so is of another format. */
static void damage(void **state) {
  (void)state;
  bytes b;
  put_two_tets(&b, 4, true);
  assert_prefixes_fail_cleanly("m.meshb", b.data, b.n);
  b.data[b.n] = 0;
  assert_damage_fails_cleanly("m.meshb", b.data, b.n);
}

static void failed_allocations(void **state) {
  (void)state;
  assert_true(assert_survives_failed_allocations(try_read, (void *)(DATA "two.meshb")) > 30);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_version_and_byte_order_is_read),
      cmocka_unit_test(what_meshio_writes_is_what_gmsh_wrote),
      cmocka_unit_test(orders_of_nodes_are_heeded),
      cmocka_unit_test(other_sections_are_passed_over),
      cmocka_unit_test(precision_is_heeded),
      cmocka_unit_test(faults),
      cmocka_unit_test(damage),
      cmocka_unit_test(failed_allocations),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
