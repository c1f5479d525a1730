/* Scenarios with mesh.order: what it does to boxes and files, groups and levels, and what it
 * refuses. */
#define TEST_NAME "test_scenario_order"
#include "alloc.h"
#include "check.h"
#include "order_2.h"
#include "scenario_text.h"

#define DATA SOURCE_DIR "/tests/unit/data/"
#define BOX(more) \
  "mesh: {box: {size: [1, 1, 2], cells: [1, 1, 2], split: kuhn}, " more "}\n" MATERIAL TIME
#define READ(name, more) "mesh: {file: '" DATA name "'" more "}\n" MATERIAL TIME

static corot_mesh *build(const char *text, corot_refinement **refinement) {
  scenario *s = accept(text);
  corot_mesh *mesh = NULL;
  corot_model *model = NULL;
  corot_refinement *r = NULL;
  assert_ok(scenario_build(s, &mesh, &r, &model));
  if (refinement)
    *refinement = r;
  else
    corot_refinement_destroy(r);
  corot_model_destroy(model);
  scenario_destroy(s);
  return mesh;
}

static void the_order_is_that_of_the_file_or_as_said(void **state) {
  (void)state;
  static const struct {
    const char *text;
    int order, nnode, ntet;
  } c[] = {
      {BOX("refine: 0"), 1, 12, 12},
      {BOX("order: 1"), 1, 12, 12},
      {BOX("order: 2"), 2, 45, 12},
      {BOX("order: 2, refine: 1"), 2, 225, 96},
      {READ("two.msh41.msh", ""), 1, 23, 48},
      {READ("two.msh41.msh", ", order: 2"), 2, 113, 48},
      {READ("two_2.msh41.msh", ""), 2, 113, 48},
      {READ("two_2.msh41.msh", ", order: 2"), 2, 113, 48},
      {READ("two_2.msh41.msh", ", order: 1"), 1, 23, 48},
      {READ("two_2.msh41.msh", ", order: 1, refine: 1"), 1, 113, 384},
  };
  for (size_t i = 0; i < sizeof c / sizeof *c; i++) {
    corot_mesh *m = build(c[i].text, NULL);
    assert_int_equal(corot_mesh_order(m), c[i].order);
    assert_int_equal(m->nnode, c[i].nnode);
    assert_int_equal(m->ntet, c[i].ntet);
    corot_mesh_destroy(m);
  }
}

/* A file of order 2 stays curved when it is refined; raised from its corners it is not. */
static void curved_files_stay_curved(void **state) {
  (void)state;
  corot_mesh *file = build(READ("quarter.msh", ""), NULL),
             *fine = build(READ("quarter.msh", ", refine: 1"), NULL),
             *low = build(READ("quarter.msh", ", order: 1"), NULL);
  double volume = corot_mesh_measure(file).volume;
  assert_close(corot_mesh_measure(fine).volume, volume, 1e-13, 0); /* rounding */
  assert_below(corot_mesh_measure(low).volume, 0.99 * volume);
  corot_mesh_destroy(file), corot_mesh_destroy(fine), corot_mesh_destroy(low);
}

/* Groups by place are of the final mesh, groups by number and their heirs of the first. */
static void groups_know_nodes_on_edges(void **state) {
  (void)state;
  static const char groups[] =
      "groups: {base: {plane: {axis: z, at: 0}}, top: {nodes: [8, 9, 10, 11]}, one: {nodes: [3]}}\n"
      "boundary: [{group: base, fix: [x, y, z]}]\n";
  static const struct {
    const char *mesh;
    int base, top, ntri;
  } c[] = {{BOX("order: 1"), 4, 4, 2},
           {BOX("order: 2"), 9, 9, 2},
           {BOX("order: 2, refine: 1"), 25, 25, 8}};
  for (int i = 0; i < 3; i++) {
    char text[2000];
    snprintf(text, sizeof text, "%s%s", c[i].mesh, groups);
    corot_mesh *m = build(text, NULL);
    assert_int_equal(corot_mesh_find_group(m, "base")->nnode, c[i].base);
    assert_int_equal(corot_mesh_find_group(m, "top")->nnode, c[i].top);
    assert_int_equal(corot_mesh_find_group(m, "top")->ntri, c[i].ntri);
    assert_int_equal(corot_mesh_find_group(m, "one")->nnode, 1);
    corot_mesh_destroy(m);
  }
}

/* Order 2 is one more level for the preconditioners that use levels. */
static void order_2_is_a_level(void **state) {
  (void)state;
  static const struct {
    const char *text;
    int nlevel;
  } c[] = {
      {BOX("order: 2") "linear_solver: {preconditioner: multigrid}\n", 1},
      {BOX("order: 2, refine: 1") "linear_solver: {preconditioner: hierarchical}\n", 2},
      {READ("two_2.msh41.msh", "") "linear_solver: {preconditioner: multigrid}\n", 1},
      {READ("two_2.msh41.msh", ", order: 2") "linear_solver: {preconditioner: hierarchical}\n", 1},
      {READ("two_2.msh41.msh", ", refine: 1") "linear_solver: {preconditioner: multigrid}\n", 2},
  };
  for (size_t i = 0; i < sizeof c / sizeof *c; i++) {
    corot_refinement *r = NULL;
    corot_mesh *m = build(c[i].text, &r);
    assert_non_null(r);
    assert_int_equal(r->nlevel, c[i].nlevel);
    assert_int_equal(r->nnode[r->nlevel], m->nnode);
    assert_int_equal(r->ntet[r->nlevel], m->ntet);
    corot_refinement_destroy(r);
    corot_mesh_destroy(m);
  }
}

/* It is the last level of a hierarchy, too. */
static void order_2_is_the_finest_level_of_a_hierarchy(void **state) {
  (void)state;
  static const struct {
    const char *text, *strain;
    corot_mass mass;
  } c[] = {
      {BOX("order: 2") "hierarchy: {}\n", "green+polar", COROT_MASS_CONSISTENT},
      {BOX("order: 2") "hierarchy: {frame_level: 1}\n", "green+polar", COROT_MASS_CONSISTENT},
      {BOX("order: 2") "strain: warp\nhierarchy: {coarse_strain: hybrid, force: paper}\n",
       "hybrid+warp", COROT_MASS_CONSISTENT},
      {BOX("order: 2, refine: 1") "hierarchy: {coupling: nodes, frame_level: 2}\n", "green+polar",
       COROT_MASS_CONSISTENT},
      {BOX("order: 2") "hierarchy: {coupling: one-way}\n", "green+polar", COROT_MASS_LUMPED},
      {READ("two.msh41.msh", ", order: 2") "hierarchy: {}\n", "green+polar", COROT_MASS_CONSISTENT},
      {READ("two_2.msh41.msh", ", order: 1") "hierarchy: {}\n", "green", COROT_MASS_LUMPED},
  };
  for (size_t i = 0; i < sizeof c / sizeof *c; i++) {
    scenario *s = accept(c[i].text);
    corot_mesh *mesh = NULL;
    corot_model *model = NULL;
    assert_ok(scenario_build(s, &mesh, NULL, &model));
    assert_string_equal(corot_model_strain(model), c[i].strain);
    assert_int_equal(corot_model_mass_kind(model), c[i].mass);
    corot_model_destroy(model);
    corot_mesh_destroy(mesh);
    scenario_destroy(s);
  }
}

static void refusals(void **state) {
  (void)state;
  static const refusal read[] = {
      {BOX("order: 3"), "1:70: mesh.order: order 3: tets are of order 1, with four nodes, or 2"},
      {BOX("order: 0"), "1:70: mesh.order: "},
      {BOX("order: two"), "1:70: mesh.order: "},
      {BOX("order: 1.5"), "1:70: mesh.order: "},
      {BOX("order: 1") "linear_solver: {preconditioner: multigrid}\n",
       "4:33: linear_solver.preconditioner: multigrid needs mesh.refine"},
      {BOX("order: 2") "hierarchy: {frame_level: 2}\n",
       "4:26: hierarchy.frame_level: frame level 2, where the levels are 0 to 1"},
      {BOX("order: 2") "mass: consistent\nhierarchy: {coupling: one-way}\n",
       "4:7: mass: a consistent mass would couple the finer nodes of a one-way hierarchy"},
      {BOX("order: 2") "dilatation: element\nhierarchy: {}\n",
       "4:13: dilatation.name: averages of the dilatation are not provided for in a hierarchy"},
  };
  for (size_t i = 0; i < sizeof read / sizeof *read; i++) refuse(read[i].text, read[i].message);
  static const refusal built[] = {
      {READ("two_2.msh41.msh", ", refine: 1") "hierarchy: {}\n",
       "hierarchy: level 0 has to be of four-node tets, and the file's have ten nodes already"},
      {READ("two_2.msh41.msh", ", order: 2") "hierarchy: {}\n",
       "hierarchy: level 0 has to be of four-node tets, and the file's have ten nodes already: "
       "mesh.order: 1"},
      {READ("two.msh41.msh", "") "linear_solver: {preconditioner: multigrid}\n",
       "4:33: linear_solver.preconditioner: multigrid needs mesh.refine"},
      {BOX("order: 2") "groups: {a: {plane: {axis: z, at: 0.5}}}",
       "4:10: groups.a: group 'a': no corner of a tet is there"},
      {BOX("order: 2") "probes: {a: {node: 45}}", "4:20: probes.a.node: the mesh has 45 nodes"},
  };
  refuse_builds(built, sizeof built / sizeof *built);
}

/* A key that is not given is not in the resolved scenario, so that runs keep their hashes. */
static void the_default_is_not_resolved(void **state) {
  (void)state;
  scenario *plain = accept(MINIMAL), *said = accept(BOX("order: 2"));
  assert_null(json_object_get(json_object_get(plain->resolved, "mesh"), "order"));
  assert_int_equal(
      json_integer_value(json_object_get(json_object_get(said->resolved, "mesh"), "order")), 2);
  scenario_destroy(plain);
  scenario_destroy(said);
}

static corot_status build_scenario(void *context) {
  corot_mesh *mesh = NULL;
  corot_refinement *refinement = NULL;
  corot_model *model = NULL;
  COROT_TRY(scenario_build(context, &mesh, &refinement, &model));
  corot_refinement_destroy(refinement);
  corot_model_destroy(model);
  corot_mesh_destroy(mesh);
  return COROT_OK;
}

static void failed_allocations(void **state) {
  (void)state;
  scenario *s =
      accept(BOX("order: 2, refine: 1") "linear_solver: {preconditioner: multigrid}\n"
                                        "groups: {base: {plane: {axis: z, at: 0}}}\n");
  assert_true(assert_survives_failed_allocations(build_scenario, s) >= 150);
  scenario_destroy(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_order_is_that_of_the_file_or_as_said),
      cmocka_unit_test(curved_files_stay_curved),
      cmocka_unit_test(groups_know_nodes_on_edges),
      cmocka_unit_test(order_2_is_a_level),
      cmocka_unit_test(order_2_is_the_finest_level_of_a_hierarchy),
      cmocka_unit_test(refusals),
      cmocka_unit_test(the_default_is_not_resolved),
      cmocka_unit_test(failed_allocations),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
