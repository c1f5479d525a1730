/* Scenarios with mesh.refine: what it does to groups and probes, and how far it may go. */
#define TEST_NAME "test_scenario_refine"
#include "alloc.h"
#include "app/scenario/refine.h"
#include "check.h"
#include "scenario_text.h"

/* MINIMAL refined so many times, with nothing else said of the mesh. */
#define REFINED(times) \
  "mesh: {box: {size: [1, 1, 2], cells: [1, 1, 2], split: kuhn}, refine: " times "}\n" MATERIAL TIME

static void build(const char *text, corot_mesh **mesh, corot_model **model) {
  scenario *s = accept(text);
  corot_refinement *refinement;
  assert_ok(scenario_build(s, mesh, &refinement, model));
  corot_refinement_destroy(refinement);
  scenario_destroy(s);
}

static void groups_are_those_of_the_refined_mesh(void **state) {
  (void)state;
  corot_mesh *mesh = NULL;
  corot_model *model = NULL;
  build(REFINED("2")
        "groups: {base: {plane: {axis: z, at: 0}}, tip: {box: {min: [0, 0, 1.75], max: [1, 1, 2]}},"
        " slice: {plane: {axis: z, at: 0.25}}, top: {nodes: [8, 9, 10, 11]}, corner: {nodes: [3]}}\n"
        "boundary: [{group: base, fix: [x, y, z]}]\n"
        "loads: [{group: top, traction: [0, 0, 1]}]\n",
        &mesh, &model);
  assert_int_equal(mesh->ntet, 12 * 64);
  assert_int_equal(mesh->nnode, 5 * 5 * 9);
  assert_int_equal(corot_mesh_find_group(mesh, "base")->nnode, 25);
  assert_int_equal(corot_mesh_find_group(mesh, "zmin")->ntri, 32);
  assert_int_equal(corot_mesh_find_group(mesh, "tip")->nnode, 50);
  assert_int_equal(corot_mesh_find_group(mesh, "tip")->ntet, 16 * 6);
  assert_int_equal(corot_mesh_find_group(mesh, "slice")->nnode, 25); /* of new nodes alone */
  assert_int_equal(corot_mesh_find_group(mesh, "top")->nnode, 25);
  assert_int_equal(corot_mesh_find_group(mesh, "top")->ntri, 32);
  assert_int_equal(corot_mesh_find_group(mesh, "corner")->nnode, 1);
  assert_int_equal(corot_model_ndof(model), 3 * (225 - 25));
  corot_model_destroy(model);
  corot_mesh_destroy(mesh);
}

static void refine_0_changes_nothing(void **state) {
  (void)state;
  corot_mesh *mesh[2] = {NULL};
  corot_model *model[2] = {NULL};
  build(MINIMAL, &mesh[0], &model[0]);
  build(REFINED("0"), &mesh[1], &model[1]);
  assert_int_equal(mesh[0]->nnode, mesh[1]->nnode);
  assert_int_equal(mesh[0]->ntet, mesh[1]->ntet);
  assert_memory_equal(mesh[0]->x, mesh[1]->x, (size_t)mesh[0]->nnode * sizeof *mesh[0]->x);
  assert_memory_equal(mesh[0]->tet, mesh[1]->tet, (size_t)mesh[0]->ntet * sizeof *mesh[0]->tet);
  for (int i = 0; i < 2; i++) {
    corot_model_destroy(model[i]);
    corot_mesh_destroy(mesh[i]);
  }
}

static void refusals_of_a_build(void **state) {
  (void)state;
  static const refusal r[] = {
      {REFINED("9"), "1:71: mesh.refine: refining 12 tets 9 times makes 1.61e+09, "},
      {REFINED("2147483647"), "1:71: mesh.refine: refining 12 tets 2147483647 times makes inf, "},
      {REFINED("1") "groups: {a: {nodes: [12]}}",
       "4:10: groups.a: group 'a': node 12 does not exist, the last is 11"},
      {REFINED("1") "groups: {a: {plane: {axis: z, at: 0.25}}}",
       "4:10: groups.a: group 'a': no node is there"},
      {REFINED("1") "probes: {a: {node: 45}}", "4:20: probes.a.node: the mesh has 45 nodes"},
  };
  refuse_builds(r, sizeof r / sizeof *r);
}

static int blocks_of(const char *text) {
  corot_mesh *mesh = NULL;
  corot_model *model = NULL;
  build(text, &mesh, &model);
  int nblock = corot_model_nblock(model);
  corot_model_destroy(model);
  corot_mesh_destroy(mesh);
  return nblock;
}

static void hierarchies(void **state) {
  (void)state;
  static const struct {
    const char *text, *strain;
  } h[] = {
      {REFINED("2") "hierarchy: {}\n", "green+polar"},
      {REFINED("1") "strain: warp\nhierarchy: {coarse_strain: polar, force: paper}\n",
       "polar+warp"},
      {REFINED("2") "strain: cauchy\nhierarchy: {coarse_strain: green, frame_level: 2}\n",
       "green+cauchy"},
      {REFINED("0") "strain: warp\nhierarchy: {coarse_strain: hybrid}\n", "hybrid"},
  };
  for (size_t i = 0; i < sizeof h / sizeof *h; i++) {
    corot_mesh *mesh = NULL;
    corot_model *model = NULL;
    build(h[i].text, &mesh, &model);
    assert_string_equal(corot_model_strain(model), h[i].strain);
    corot_model_destroy(model);
    corot_mesh_destroy(mesh);
  }
  /* the nodes of level 0 are neighbours in the matrices only where they couple the levels */
  int mean = blocks_of(REFINED("1") "hierarchy: {}\n");
  assert_int_equal(blocks_of(REFINED("1") "hierarchy: {coupling: mean}\n"), mean);
  assert_int_equal(blocks_of(REFINED("1")), mean);
  int coupled = blocks_of(REFINED("1") "hierarchy: {coupling: nodes}\n");
  assert_above(coupled, mean);
  assert_int_equal(blocks_of(REFINED("1") "hierarchy: {coupling: one-way}\n"), coupled);
  refuse(REFINED("1") "mass: consistent\nhierarchy: {coupling: one-way}\n",
         "4:7: mass: a consistent mass would couple the finer nodes of a one-way hierarchy");
  refuse(REFINED("1") "loads: [{group: zmax, pressure: 1.0}]\nhierarchy: {coupling: one-way}\n",
         "4:33: loads[0].pressure: pressure on group 'zmax': it follows the fine surface, which "
         "level");
  refuse(REFINED("1") "hierarchy: {frame_level: 2}\n",
         "4:26: hierarchy.frame_level: frame level 2, where the levels are 0 to 1");
  refuse(REFINED("1") "strain: green\nhierarchy: {}\n",
         "4:9: strain: strain green is not linear in a given frame");
  refuse(REFINED("1") "strain: warp\nhierarchy: {}\n",
         "5:1: hierarchy.force: strain warp has no conservative force: use polar, or the");
  refuse(REFINED("1") "strain: warp\nhierarchy: {force: paper, frame_level: 1}\n",
         "5:40: hierarchy.frame_level: frame level 1, but warp frames depend on the edges");
  refuse(REFINED("1") "viscosity: objective\nhierarchy: {}\n",
         "4:12: viscosity: under a hierarchy the viscous law must be the corotated one");
  refuse(REFINED("1") "dilatation: nodal\nhierarchy: {}\n",
         "4:13: dilatation.name: dilatations averaged at nodes are not provided for in");
  refuse(REFINED("1") "hierarchy: {coarse_strain: gren}\n",
         "4:28: hierarchy.coarse_strain: unknown: gren; did you mean green?");
}

static void a_refinement_is_handed_to_whom_it_concerns(void **state) {
  (void)state;
  static const struct {
    const char *text;
    int nlevel; /* 0: none */
  } r[] = {
      {REFINED("2") "linear_solver: {name: pcg, preconditioner: hierarchical}\n", 2},
      {REFINED("1") "linear_solver: {preconditioner: multigrid}\nhierarchy: {}\n", 1},
      {REFINED("1") "linear_solver: pcg\n", 0},
      {REFINED("1") "hierarchy: {}\n", 0},
  };
  for (size_t i = 0; i < sizeof r / sizeof *r; i++) {
    corot_mesh *mesh = NULL;
    corot_refinement *refinement = NULL;
    corot_model *model = NULL;
    scenario *s = accept(r[i].text);
    assert_ok(scenario_build(s, &mesh, &refinement, &model));
    assert_int_equal(refinement ? refinement->nlevel : 0, r[i].nlevel);
    if (refinement) assert_int_equal(refinement->nnode[r[i].nlevel], mesh->nnode);
    corot_refinement_destroy(refinement);
    corot_model_destroy(model);
    corot_mesh_destroy(mesh);
    scenario_destroy(s);
  }
  refuse(REFINED("0") "linear_solver: {name: pcg, preconditioner: hierarchical}\n",
         "4:44: linear_solver.preconditioner: hierarchical needs mesh.refine");
  refuse(MINIMAL "linear_solver: {preconditioner: multigrid}\n",
         "4:33: linear_solver.preconditioner: multigrid needs mesh.refine");
}

static void memory_is_counted(void **state) {
  (void)state;
  assert_ok(refine_fits(1000, 2, 64000 * 50));
  assert_fails(
      refine_fits(1000, 2, 64000 * 50 - 1), COROT_EINVAL,
      "refining 1000 tets 2 times makes 6.4e+04, which need 0.0032 GB of memory, and there "
      "are 0.0032: at most 1");
  assert_fails(refine_fits(1000, 5, 1e9), COROT_EINVAL,
               "makes 3.28e+07, which need 1.64 GB of memory, and there are 1: at most 4");
  assert_ok(refine_fits(1000, 30, INFINITY));

  /* and with all that a run has beside the mesh */
  corot_memory_limit memory = {1e9, 64000 * 500, "the test"};
  assert_ok(run_fits(1000, 1, 2, &memory));
  memory.process -= 1;
  assert_fails(run_fits(1000, 1, 2, &memory), COROT_EINVAL,
               "refining 1000 tets 2 times makes 6.4e+04, 6.4e+04 tets of order 1 need at least "
               "0.032 GB of memory in a run, and the test has 0.032");
  assert_fails(run_fits(1000000, 2, 0, &memory), COROT_EINVAL,
               "1e+06 tets of order 2 need at least 3.4 GB of memory in a run, and the test has");
  assert_null(strstr(corot_error(), "refining"));
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
  scenario *s = accept(REFINED("1") "groups: {two: {nodes: [0, 1]}}\n");
  assert_true(assert_survives_failed_allocations(build_scenario, s) >= 50);
  scenario_destroy(s);
  s = accept(REFINED("1") "hierarchy: {}\nlinear_solver: {preconditioner: hierarchical}\n");
  assert_true(assert_survives_failed_allocations(build_scenario, s) >= 90);
  scenario_destroy(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(groups_are_those_of_the_refined_mesh),
      cmocka_unit_test(refine_0_changes_nothing),
      cmocka_unit_test(refusals_of_a_build),
      cmocka_unit_test(hierarchies),
      cmocka_unit_test(a_refinement_is_handed_to_whom_it_concerns),
      cmocka_unit_test(memory_is_counted),
      cmocka_unit_test(failed_allocations),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
