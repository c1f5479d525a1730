/* The derivatives of probes' columns by the displacement, against differences of the columns over
   all degrees of freedom. */
#define TEST_NAME "probe_goal"
#include "alloc.h"
#include "app/probe/probe.h"
#include "scenario_text.h"
#include "solid.h"

/* A body, strained, and its probes. */
typedef struct scene {
  scenario *scenario;
  corot_mesh *mesh;
  corot_model *model;
  corot_state *state;
  int n;
  double *u, *v, (*x)[3];
  probes *probes;
  double *value;
} scene;

static void evaluate(scene *s, const double *u, double *value) {
  const ledger none = {0};
  corot_nodal(s->model, 0, u, NULL, s->x, NULL);
  const probe_moment now = {.state = s->state,
                            .u = u,
                            .v = s->v,
                            .displacement = (const double(*)[3])s->x,
                            .ledger = &none,
                            .still = true};
  assert_ok(probes_evaluate(s->probes, &now, value));
}

static scene open_scene(int order, const char *strain, const char *list) {
  char text[4000];
  scene s = {0};
  uint64_t seed = 3;
  snprintf(text, sizeof text,
           "mesh: {box: {size: [0.2, 0.1, 0.3], cells: [2, 1, 3]}, order: %d}\n"
           "strain: %s\n"
           "material: {lambda: 1.0e5, mu: 1.0e4, density: 1000}\n"
           "boundary: [{group: zmin, fix: [x, y, z]}, {group: zmax, fix: [y]}]\n"
           "time: {end: 1}\nprobes:\n%s",
           order, strain, list);
  s.scenario = accept(text);
  assert_ok(scenario_build(s.scenario, &s.mesh, NULL, &s.model));
  assert_ok(corot_state_create(s.model, &s.state));
  corot_state_stand_still(s.state, 0, 1);
  s.n = corot_model_ndof(s.model);
  s.u = calloc(2 * (size_t)s.n, sizeof *s.u), s.v = s.u + s.n;
  s.x = calloc((size_t)s.mesh->nnode, sizeof *s.x);
  for (int i = 0; i < s.n; i++) s.u[i] = 2e-3 * noise(&seed);
  assert_ok(probes_create(s.scenario, s.model, &s.probes));
  s.value = calloc((size_t)probes_ncolumn(s.probes) + 1, sizeof *s.value);
  evaluate(&s, s.u, s.value);
  return s;
}

static void close_scene(scene *s) {
  probes_destroy(s->probes);
  free(s->value), free(s->u), free(s->x);
  corot_state_destroy(s->state), corot_model_destroy(s->model), corot_mesh_destroy(s->mesh);
  scenario_destroy(s->scenario);
}

static corot_status find_goal(scene *s, int column, double *goal, bool *known) {
  const ledger none = {0};
  const probe_moment now = {.state = s->state,
                            .u = s->u,
                            .v = s->v,
                            .displacement = (const double(*)[3])s->x,
                            .ledger = &none,
                            .still = true};
  return probes_goal(s->probes, &now, column, goal, known);
}

static const char known[] =
    "  at: {point: [0.07, 0.04, 0.16]}\n"
    "  node: {node: 20}\n"
    "  length: {point: [0.07, 0.04, 0.16], of: displacement, component: magnitude}\n"
    "  mean: {group: zmax, of: displacement, take: mean}\n"
    "  sum: {group: xmax, of: displacement, take: sum}\n"
    "  far: {of: displacement, take: max, component: magnitude}\n"
    "  low: {group: zmax, of: displacement, take: min, component: z}\n"
    "  stress: {point: [0.07, 0.04, 0.16], of: stress}\n"
    "  at_node: {node: 20, of: von_mises}\n"
    "  one: {node: 20, of: principal, component: 1}\n"
    "  hard: {of: von_mises, take: max}\n"
    "  foot: {group: zmin, of: von_mises, take: max}\n";

/* Central differences over 1e-7 m: their second-order part is (1e-7 over the distance, 1e-4 or
   more, at which lengths and eigenvalues turn)^2, and rounding leaves 1e-16 of a strain of 1e-6, as
   of the steps of 1e-9 m, which are 1e-8 of an edge, 1e-8. A hundred times as much is allowed. */
static void a_goal_is_the_derivative_of_its_column(void **state) {
  (void)state;
  const double h = 1e-7;
  for (int m = 0; m < NMEASURE; m++)
    for (int order = 1; order <= 2; order++) {
      scene s = open_scene(order, measures[m], known);
      int n = probes_ncolumn(s.probes);
      double *goal = calloc((size_t)(n * s.n), sizeof *goal);
      double *up = calloc(2 * (size_t)n, sizeof *up), *down = up + n;
      for (int c = 0; c < n; c++) {
        bool is = false;
        assert_ok(find_goal(&s, c, goal + c * s.n, &is));
        assert_true(is);
      }
      for (int i = 0; i < s.n; i++) {
        double at = s.u[i];
        s.u[i] = at + h, evaluate(&s, s.u, up);
        s.u[i] = at - h, evaluate(&s, s.u, down);
        s.u[i] = at;
        for (int c = 0; c < n; c++)
          assert_close(goal[c * s.n + i], (up[c] - down[c]) / (2 * h), 0,
                       1e-5 * norm_max(s.n, goal + c * s.n));
      }
      /* the columns themselves are as they were */
      evaluate(&s, s.u, up);
      for (int c = 0; c < n; c++) assert_close(up[c], s.value[c], 0, 0);
      free(goal), free(up);
      close_scene(&s);
    }
}

/* What the whole body has a part in: no goal, and nothing in it. */
static void of_other_columns_there_is_none(void **state) {
  (void)state;
  scene s = open_scene(2, "polar",
                       "  whole: {group: zmax, of: stress, take: mean}\n"
                       "  hold: {group: zmin, of: reaction}\n"
                       "  energy: {of: elastic}\n"
                       "  size: {of: volume}\n");
  double *goal = calloc((size_t)s.n, sizeof *goal);
  for (int c = 0; c < probes_ncolumn(s.probes); c++) {
    bool is = true;
    goal[3] = 1;
    assert_ok(find_goal(&s, c, goal, &is));
    assert_false(is);
    assert_close(norm_max(s.n, goal), 0, 0, 0);
  }
  free(goal);
  close_scene(&s);
}

static scene *asked;

static corot_status ask(void *context) {
  double *goal = context;
  bool is;
  for (int c = 0; c < probes_ncolumn(asked->probes); c++) COROT_TRY(find_goal(asked, c, goal, &is));
  return COROT_OK;
}

static void failed_allocations_leave_nothing(void **state) {
  (void)state;
  scene s = open_scene(1, "polar", known);
  double *goal = calloc((size_t)s.n, sizeof *goal);
  asked = &s;
  assert_true(assert_survives_failed_allocations(ask, goal) > 8);
  free(goal);
  close_scene(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_goal_is_the_derivative_of_its_column),
      cmocka_unit_test(of_other_columns_there_is_none),
      cmocka_unit_test(failed_allocations_leave_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
