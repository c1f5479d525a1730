/* Scenarios with mesh.marks: what the file makes of the mesh, its groups and levels, what is wrong
   with one. */
#define TEST_NAME "test_scenario_marks"
#include "alloc.h"
#include "app/folder/hash.h"
#include "app/scenario/marks_file.h"
#include "check.h"
#include "order_2.h"
#include "scenario_text.h"

#define MARKS BINARY_DIR "/test_scenario_marks.txt"
/* MINIMAL with more said of the mesh, of 12 tets. */
#define BOX(more) \
  "mesh: {box: {size: [1, 1, 2], cells: [1, 1, 2], split: kuhn}, " more "}\n" MATERIAL TIME
#define MARKED "marks: test_scenario_marks.txt"

static void write_marks(const char *text) { write_file(MARKS, text, strlen(text)); }

static void build(const char *text, corot_mesh **mesh, corot_refinement **refinement) {
  scenario *s = accept(text);
  corot_model *model = NULL;
  assert_ok(scenario_build(s, mesh, refinement, &model));
  corot_model_destroy(model);
  scenario_destroy(s);
}

static corot_mesh *built(const char *text) {
  corot_mesh *mesh = NULL;
  build(text, &mesh, NULL);
  return mesh;
}

/* The box, octasected so often, cut where it is marked. */
static corot_mesh *by_hand(int nlevel, int nmark, const int *mark) {
  const corot_box box = {{1, 1, 2}, {1, 1, 2}, {0}, COROT_BOX_KUHN};
  corot_mesh *m = NULL, *fine = NULL, *cut = NULL;
  assert_ok(corot_mesh_box(&box, &m));
  assert_ok(corot_mesh_refine(m, nlevel, COROT_DIAGONAL_SHORTEST, &fine, NULL));
  assert_ok(corot_mesh_refine_marked(fine, nmark, mark, &cut, NULL));
  corot_mesh_destroy(m), corot_mesh_destroy(fine);
  return cut;
}

static void lines_are_passes(void **state) {
  (void)state;
  const int first[] = {0, 7}, second[] = {20};
  static const char *const text[] = {"0 7\n20\n",
                                     "\xEF\xBB\xBF"
                                     "7\t0  # of the box\r\n\n# then\n   \n20",
                                     "007 0 0 7#\n20 20 20\n"};
  corot_mesh *once = by_hand(0, 2, first), *twice = NULL;
  assert_ok(corot_mesh_refine_marked(once, 1, second, &twice, NULL));
  for (size_t i = 0; i < sizeof text / sizeof *text; i++) {
    write_marks(text[i]);
    corot_mesh *m = built(BOX(MARKED));
    assert_same(m, twice);
    corot_mesh_destroy(m);
  }
  corot_mesh_destroy(once), corot_mesh_destroy(twice);
  /* nothing in it changes nothing */
  write_marks("# no passes\n\n");
  corot_mesh *m = built(BOX(MARKED)), *plain = built(MINIMAL);
  assert_same(m, plain);
  corot_mesh_destroy(m), corot_mesh_destroy(plain);
}

/* After mesh.refine, before mesh.order. */
static void marks_stand_between_refine_and_order(void **state) {
  (void)state;
  write_marks("95\n");
  corot_mesh *m = built(BOX("refine: 1, " MARKED)),
             *raised = built(BOX(MARKED ", refine: 1, order: 2")),
             *expected = by_hand(1, 1, (int[]){95}), *both = with_order(expected, 2);
  assert_same(m, expected);
  assert_same(raised, both);
  corot_mesh_destroy(m), corot_mesh_destroy(raised);
  corot_mesh_destroy(expected), corot_mesh_destroy(both);
}

/* Groups by numbers are inherited, those by place are of the mesh that is cut. */
static void groups(void **state) {
  (void)state;
  write_marks("0 1 2 3 4 5\n");
  corot_mesh *m = built(BOX(
      MARKED) "groups: {base: {plane: {axis: z, at: 0}}, foot: {nodes: [0, 1, 2, 3]}, "
              "half: {plane: {axis: x, at: 0.5}}}\n"
              "loads: [{group: foot, traction: [0, 0, 1]}]\n");
  const corot_group *base = corot_mesh_find_group(m, "base"),
                    *foot = corot_mesh_find_group(m, "foot");
  assert_int_equal(base->nnode, 9);
  assert_int_equal(base->nnode, foot->nnode);
  assert_same_ints(base->nnode, base->node, foot->node);
  assert_int_equal(base->ntri, foot->ntri);
  assert_true(corot_mesh_find_group(m, "half")->nnode > 0); /* of new nodes alone */
  corot_mesh_destroy(m);
}

/* A preconditioner by levels sees those that are left: the corners of ten-node tets. */
static void levels(void **state) {
  (void)state;
  static const char *const text[] = {
      BOX(MARKED ", order: 2") "linear_solver: {preconditioner: multigrid}\n",
      BOX(MARKED ", order: 2, refine: 1") "linear_solver: {preconditioner: hierarchical}\n"};
  write_marks("0\n");
  for (int i = 0; i < 2; i++) {
    corot_mesh *m = NULL;
    corot_refinement *r = NULL;
    build(text[i], &m, &r);
    assert_non_null(r);
    assert_int_equal(r->nlevel, 1);
    assert_int_equal(r->nnode[1], m->nnode);
    corot_refinement_destroy(r);
    corot_mesh_destroy(m);
  }
  refuse(BOX("refine: 1, " MARKED) "linear_solver: {preconditioner: multigrid}\n",
         "4:33: linear_solver.preconditioner: multigrid needs mesh.refine without mesh.marks, or "
         "ten-node tets");
  refuse(BOX("refine: 1, " MARKED) "hierarchy: {}\n",
         "4:1: hierarchy: its levels cut every tet, and mesh.marks only some: give one of them");
}

/* Whether two scenarios are the same run. */
static void identify(const char *text, hashes *h) {
  scenario *s = accept(text);
  corot_mesh *mesh = NULL;
  corot_model *model = NULL;
  assert_ok(scenario_build(s, &mesh, NULL, &model));
  assert_ok(hashes_of(s->resolved, mesh, h));
  corot_model_destroy(model);
  corot_mesh_destroy(mesh);
  scenario_destroy(s);
}

static void the_content_is_part_of_the_identity(void **state) {
  (void)state;
  hashes first, second, again;
  write_marks("0\n");
  identify(BOX(MARKED), &first);
  write_marks("5\n");
  identify(BOX(MARKED), &second);
  write_marks("5 # commented\n");
  identify(BOX(MARKED), &again);
  assert_string_not_equal(first.run, second.run);
  assert_string_equal(second.run, again.run);
}

static void refusals(void **state) {
  (void)state;
  static const struct {
    const char *text, *message;
  } r[] = {
      {"0\n12\n1000\n", "test_scenario_marks.txt:3:1: tet 1000 does not exist: the mesh has "},
      {"0 12\n",
       "test_scenario_marks.txt:1:3: tet 12 does not exist: the mesh has 12 here, and the last "
       "is 11"},
      {"# one\n 0 99999999999999999999\n",
       "test_scenario_marks.txt:2:4: tet 99999999999999999999 does"},
      {"4294967296", "test_scenario_marks.txt:1:1: tet 4294967296 does not exist"},
      {"0 -1\n", "test_scenario_marks.txt:1:3: expected the number of a tet, found -1"},
      {"0 1.0\n", "test_scenario_marks.txt:1:3: expected the number of a tet, found 1.0"},
      {"0, 1\n", "test_scenario_marks.txt:1:1: expected the number of a tet, found 0,"},
      {"0\n\n tet\n", "test_scenario_marks.txt:3:2: expected the number of a tet, found tet"},
  };
  for (size_t i = 0; i < sizeof r / sizeof *r; i++) {
    write_marks(r[i].text);
    refuse_builds(&(refusal){BOX(MARKED), r[i].message}, 1);
  }
  refuse_builds(&(refusal){BOX("marks: none.txt"), "1:70: mesh.marks: " BINARY_DIR "/none.txt"}, 1);
  refuse_builds(&(refusal){BOX("marks: ."), "1:70: mesh.marks: " BINARY_DIR "/.: not a file"}, 1);
  refuse(BOX("marks: ''"), "1:70: mesh.marks: the name is empty");
}

static corot_status build_scenario(void *context) {
  corot_mesh *mesh = NULL;
  corot_model *model = NULL;
  COROT_TRY(scenario_build(context, &mesh, NULL, &model));
  corot_model_destroy(model);
  corot_mesh_destroy(mesh);
  return COROT_OK;
}

static void failed_allocations(void **state) {
  (void)state;
  write_marks("0\n3\n");
  scenario *s = accept(BOX(MARKED));
  assert_true(assert_survives_failed_allocations(build_scenario, s) >= 100);
  scenario_destroy(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(lines_are_passes),
      cmocka_unit_test(marks_stand_between_refine_and_order),
      cmocka_unit_test(groups),
      cmocka_unit_test(levels),
      cmocka_unit_test(the_content_is_part_of_the_identity),
      cmocka_unit_test(refusals),
      cmocka_unit_test(failed_allocations),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
