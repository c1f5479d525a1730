/* Scenarios with groups by shape and groups made of others: in any order, on the refined mesh, and
   what is refused with its place. */
#define TEST_NAME "test_scenario_groups"
#include "alloc.h"
#include "scenario_text.h"

static corot_mesh *built(const char *text) {
  corot_mesh *mesh = NULL;
  corot_model *model = NULL;
  scenario *s = accept(text);
  assert_ok(scenario_build(s, &mesh, NULL, &model));
  corot_model_destroy(model);
  scenario_destroy(s);
  return mesh;
}

/* 1 x 1 x 2 m in cells of half a metre. */
#define REFINED \
  "mesh: {box: {size: [1, 1, 2], cells: [1, 1, 2], split: kuhn}, refine: 1}\n" MATERIAL TIME

static void groups_of_every_kind(void **state) {
  (void)state;
  static const struct {
    const char *name;
    int nnode, ntri, ntet;
  } expected[] = {
      {"ball", 4, 0, 0},    {"pipe", 5, 0, 0},     {"half", 27, 40, 48}, {"top", 9, 8, 0},
      {"near", 18, 24, 24}, {"either", 15, 12, 0}, {"edge", 3, 0, 0},    {"rest", 6, 8, 0},
      {"last", 6, 12, 24},  {"first", 9, 8, 0},
  };
  corot_mesh *m = built(REFINED
                        "groups:\n"
                        "  last: {difference: [near, edge, rest, xmax]}\n"
                        "  either: {union: [edge, top, rest, xmin0]}\n"
                        "  xmin0: {intersection: [xmin, low]}\n"
                        "  low: {box: {min: [0, 0, 0], max: [1, 1, 0.5]}}\n"
                        "  edge: {intersection: [top, xmin]}\n"
                        "  rest: {difference: [top, edge]}\n"
                        "  ball: {sphere: {center: [0, 0, 0], radius: 0.5}}\n"
                        "  pipe: {cylinder: {from: [0, 0, 0], to: [0, 0, 2], radius: 0.1}}\n"
                        "  half: {half_space: {point: [0, 0, 1], normal: [0, 0, 2]}}\n"
                        "  top: {normal: {direction: [0, 0, 1]}}\n"
                        "  near: {near: {group: top, distance: 0.5}}\n"
                        "  first: {union: [top, top]}\n"
                        "loads: [{group: rest, pressure: 100}]\n");
  for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
    const corot_group *g = corot_mesh_find_group(m, expected[i].name);
    assert_non_null(g);
    if (g->nnode != expected[i].nnode || g->ntri != expected[i].ntri || g->ntet != expected[i].ntet)
      fail_msg("%s has %d nodes, %d faces, %d tets", g->name, g->nnode, g->ntri, g->ntet);
  }
  corot_mesh_destroy(m);
}

/* A resolved scenario says the same. */
static void groups_are_resolved(void **state) {
  (void)state;
  scenario *s = accept(MINIMAL
                       "groups: {top: {normal: {direction: [0, 0, 1]}}, "
                       "both: {union: [top, xmin]}, by: {near: {group: both, distance: 1}}}\n");
  char *text = json_dumps(json_object_get(s->resolved, "groups"), JSON_COMPACT | JSON_SORT_KEYS);
  assert_string_equal(text,
                      "{\"both\":{\"union\":[\"top\",\"xmin\"]},"
                      "\"by\":{\"near\":{\"distance\":1.0,\"group\":\"both\"}},"
                      "\"top\":{\"normal\":{\"angle\":0.01,\"direction\":[0.0,0.0,1.0]}}}");
  free(text);
  scenario_destroy(s);
}

static void what_is_wrong_is_refused(void **state) {
  (void)state;
  static const refusal texts[] = {
      {MINIMAL "groups: {a: {union: [xmin]}}",
       "4:21: groups.a.union: two groups or more are wanted, such as [xmin, another]"},
      {MINIMAL "groups: {a: {difference: xmin}}",
       "4:26: groups.a.difference: two groups or more are wanted"},
      {MINIMAL "groups: {a: {union: []}}", "4:21: groups.a.union: expected a text, or a list"},
      {MINIMAL "groups: {a: {union: [a, xmin]}}", "4:10: groups.a: is made of itself: a of a"},
      {MINIMAL "groups: {d: {union: [a, b]}, a: {near: {group: b, distance: 1}},\n"
               "  b: {union: [xmin, c]}, c: {difference: [a, xmin]}}",
       "4:30: groups.a: is made of itself: a of b of c of a"},
      {MINIMAL "groups: {a: {sphere: {center: [0, 0, 0], radius: 0}}}",
       "4:50: groups.a.sphere.radius: must be > 0, found 0"},
      {MINIMAL "groups: {a: {sphere: {center: [0, 0, 0]}}}",
       "4:14: groups.a.sphere: radius is missing"},
      {MINIMAL "groups: {a: {spher: {center: [0, 0, 0]}}}",
       "4:14: groups.a.spher: unknown key; did you mean sphere?"},
      {MINIMAL "groups: {a: {minus: [xmin, xmax]}}",
       "4:14: groups.a.minus: unknown key; did you mean difference?"},
      {MINIMAL "groups: {a: {near: {group: xmin, distance: -1}}}",
       "4:44: groups.a.near.distance: must be >= 0, found -1"},
  };
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) refuse(texts[i].text, texts[i].message);
  static const refusal builds[] = {
      {MINIMAL "groups: {a: {sphere: {center: [0, 0, 3], radius: 0.5}}}",
       "4:10: groups.a: group 'a': no node is there (tolerance 2.44949e-06): the nearest is node 8 "
       "at (0, 0, 2), 0.5 outside"},
      {MINIMAL "groups: {a: {normal: {direction: [1, 1, 0]}}}",
       "4:10: groups.a: group 'a': no face of the boundary has its normal within 0.01 rad of"},
      {MINIMAL "groups: {a: {normal: {direction: [1, 1, 0], angle: 5}}}",
       "4:10: groups.a: group 'a': the angle is 5 rad"},
      {MINIMAL "groups: {a: {half_space: {point: [0, 0, 0], normal: [0, 0, 0]}}}",
       "4:10: groups.a: group 'a': the normal has the length 0"},
      {MINIMAL "groups: {a: {intersection: [xmin, xmax]}}",
       "4:10: groups.a: group 'a' has no nodes: none of the 6 of group 'xmin' is in group 'xmax'"},
      {MINIMAL "groups: {a: {union: [xmin, xmxa]}}",
       "4:28: groups.a.union[1]: no group xmxa; did you mean xm"},
      {MINIMAL "groups: {a: {near: {group: tpo, distance: 1}}, top: {union: [xmin, ymin]}}",
       "4:28: groups.a.near.group: no group tpo; did you mean top?"},
      {MINIMAL "groups: {a: {near: {group: wing, distance: 1}}, c: {plane: {axis: z, at: 0}}}",
       "4:28: groups.a.near.group: no group wing; there are: xmin, xmax, ymin, ymax, zmin, zmax, "
       "c"},
  };
  refuse_builds(builds, sizeof builds / sizeof *builds);
}

/* A long chain, each link made of the next: no recursion, and quick. */
static void chains_may_be_long(void **state) {
  (void)state;
  enum { LINKS = 300 };
  static char text[64 * LINKS + 400];
  size_t used = (size_t)snprintf(text, sizeof text, "%s", MINIMAL "groups:\n");
  for (int i = 0; i < LINKS; i++)
    used += (size_t)snprintf(text + used, sizeof text - used, "  g%d: {union: [g%d, zmin]}\n", i,
                             i + 1);
  snprintf(text + used, sizeof text - used, "  g%d: {plane: {axis: x, at: 0}}\n", LINKS);
  corot_mesh *m = built(text);
  assert_int_equal(corot_mesh_find_group(m, "g0")->nnode, 6 + 4 - 2);
  corot_mesh_destroy(m);
}

static corot_status try_building(void *context) {
  scenario *s = NULL;
  corot_mesh *mesh = NULL;
  corot_model *model = NULL;
  COROT_TRY(scenario_read(context, 0, NULL, &s));
  corot_status status = scenario_build(s, &mesh, NULL, &model);
  corot_model_destroy(model), corot_mesh_destroy(mesh);
  scenario_destroy(s);
  return status;
}

static void failed_allocations_leave_nothing(void **state) {
  (void)state;
  static const char text[] = MINIMAL
      "groups: {c: {union: [a, b]}, a: {plane: {axis: z, at: 0}}, b: {near: {group: a, "
      "distance: 1}}}\n";
  write_file(FILE_NAME, text, strlen(text));
  char path[] = FILE_NAME;
  assert_true(assert_survives_failed_allocations(try_building, path) > 50);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(groups_of_every_kind),
      cmocka_unit_test(groups_are_resolved),
      cmocka_unit_test(what_is_wrong_is_refused),
      cmocka_unit_test(chains_may_be_long),
      cmocka_unit_test(failed_allocations_leave_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
