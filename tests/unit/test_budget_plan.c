/* Which runs an error budget needs, for scenarios that make one approximation or another. */
#define TEST_NAME "test_budget_plan"
#include "scenario_text.h"
#include "study/budget/budget_plan.h"

static budget_plan plan_of(const char *text) {
  scenario *s = accept(text);
  budget_plan plan;
  budget_plan_make(s, s->order == 2 ? 2 : 1, &plan);
  scenario_destroy(s);
  return plan;
}

static void assert_kinds(const char *text, const char *names) {
  budget_plan plan = plan_of(text);
  char found[256] = "";
  for (int i = 0; i < plan.npart; i++) {
    if (i) strcat(found, ", ");
    strcat(found, budget_names[plan.part[i].kind]);
    assert_true(plan.part[i].nset > 0);
  }
  assert_string_equal(found, names);
}

static void parts_are_the_approximations_made(void **state) {
  (void)state;
  assert_kinds(MINIMAL "strain: green\n", "algebraic solver, time integration, space");
  assert_kinds(MINIMAL, "algebraic solver, time integration, strain measure, space");
  assert_kinds(MINIMAL "strain: green\nintegrator: {method: erk}\n", "time integration, space");
  assert_kinds(MINIMAL "strain: warp\nframes: {policy: hold, interval: 0.1}\n",
               "algebraic solver, time integration, frame age, frame rule, strain measure, space");
  assert_kinds(MINIMAL "strain: cauchy\nframes: {policy: step}\n",
               "algebraic solver, time integration, strain measure, space");
  assert_kinds("mesh: {box: {size: [1, 1, 2], cells: [1, 1, 2]}, refine: 1}\n" MATERIAL TIME
               "hierarchy: {coarse_strain: green}\nframes: {policy: step}\n",
               "algebraic solver, frame age, time integration, hierarchy, strain measure, space");
  assert_kinds("mesh: {box: {size: [1, 1, 2], cells: [1, 1, 2]}, order: 2}\n" MATERIAL TIME
               "hierarchy: {}\n",
               "algebraic solver, time integration, hierarchy, strain measure, space");
}

/* Fine steps in time would take the error of such frames away with that of time. */
static void frames_as_old_as_steps_come_before_time(void **state) {
  (void)state;
  static const char order[] =
      "algebraic solver, frame age, time integration, strain measure, space";
  assert_kinds(MINIMAL "frames: {policy: step}\n", order);
  assert_kinds(MINIMAL "frames: {policy: hold, max_angle: 0.1}\n", order);
  assert_kinds(MINIMAL "frames: {policy: hold, interval: 0.1}\n",
               "algebraic solver, time integration, frame age, strain measure, space");
}

/* All settings of the plan, one after the other, make scenarios; the last one has none of the
   approximations left. */
static void assert_settings_accepted(const char *text) {
  budget_plan plan = plan_of(text);
  char *list[(BUDGET_KINDS + 1) * BUDGET_SETTINGS];
  int n = 0;
  for (int i = 0; i < plan.npart; i++) {
    for (int k = 0; k < plan.part[i].nset; k++) list[n++] = plan.part[i].set[k];
    scenario *s = NULL;
    assert_ok(scenario_read_text("test.yaml", text, strlen(text), n, list, &s));
    if (plan.part[i].kind == BUDGET_TIME) {
      assert_true(corot_integrator_controls_error(s->integrator.method));
      assert_true(s->integrator.rtol <= 1e-6);
    }
    if (i == plan.npart - 1) {
      assert_string_equal(s->model.strain, "green");
      assert_true(!s->model.hierarchy && s->frames.frames == COROT_FRAMES_EXACT);
    }
    scenario_destroy(s);
    s = NULL; /* and each alone */
    assert_ok(scenario_read_text("test.yaml", text, strlen(text), plan.part[i].nset,
                                 list + n - plan.part[i].nset, &s));
    scenario_destroy(s);
  }
  for (int k = 0; k < plan.check.nset; k++) list[n++] = plan.check.set[k];
  scenario *s = NULL;
  assert_ok(scenario_read_text("test.yaml", text, strlen(text), n, list, &s));
  scenario_destroy(s);
}

static void settings_make_scenarios(void **state) {
  (void)state;
  static const char *const texts[] = {
      MINIMAL "frames: {policy: exact}\n",
      MINIMAL "strain: hybrid\nviscosity: objective\nframes: {policy: hold, max_angle: 0.1}\n",
      MINIMAL "integrator: {method: bdf3, step: 0.01, solution: linear}\nlinear_solver: pcg\n",
      MINIMAL "integrator: {method: arkode, order: 4, rtol: 1e-3, atol: {displacement: 1e-3}}\n",
      MINIMAL "integrator: {method: erk, atol: {velocity: 1e-3}}\nlinear_solver: klu\n",
      MINIMAL "integrator: {method: ida, rtol: 1e-9}\n",
      "mesh: {box: {size: [1, 1, 2], cells: [1, 1, 2]}, refine: 2}\n" MATERIAL TIME
      "hierarchy: {coarse_strain: green, frame_level: 1}\nframes: {policy: hold, interval: 0.1}\n",
      "mesh: {box: {size: [1, 1, 2], cells: [1, 1, 2]}, order: 2}\n" MATERIAL TIME
      "hierarchy: {coarse_strain: green}\nframes: {policy: hold, interval: 0.1}\n",
      MINIMAL "mass: lumped\n",
      "mesh: {box: {size: [1, 1, 2], cells: [1, 1, 2]}, refine: 1}\n" MATERIAL TIME
      "mass: lumped\nhierarchy: {coupling: one-way}\n",
  };
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
    print_message("%s", texts[i]);
    assert_settings_accepted(texts[i]);
  }
}

/* What replaces warp's frames, or a hierarchy, brings another viscous law by default. The part is
   to be of the frames or the hierarchy alone. */
static void the_viscous_law_is_no_part(void **state) {
  (void)state;
  static const char *const texts[] = {
      MINIMAL "strain: warp\n",
      "mesh: {box: {size: [1, 1, 2], cells: [1, 1, 2]}, refine: 1}\n" MATERIAL TIME
      "hierarchy: {}\n",
  };
  for (int k = 0; k < 2; k++) {
    budget_plan plan = plan_of(texts[k]);
    bool found = false;
    for (int i = 0; i < plan.npart; i++) {
      const budget_part *part = &plan.part[i];
      if (part->kind != BUDGET_FRAME_RULE && part->kind != BUDGET_HIERARCHY) continue;
      found = true;
      assert_int_equal(part->nset, 2);
      assert_string_equal(part->set[1], "viscosity=corotated");
    }
    assert_true(found);
  }
}

static void no_error_of_time_is_three_digits_less(void **state) {
  (void)state;
  static const struct {
    const char *text;
    double rtol;
  } cases[] = {
      {MINIMAL "integrator: {rtol: 1e-2}\n", 1e-6},
      {MINIMAL "integrator: {rtol: 1e-4}\n", 1e-7},
      {MINIMAL "integrator: {rtol: 1e-8}\n", 1e-10},
      {MINIMAL "integrator: {method: bdf2, step: 1}\n", 1e-6},
  };
  for (int i = 0; i < 4; i++) {
    scenario *s = accept(cases[i].text);
    assert_close(budget_tight_rtol(s), cases[i].rtol, 1e-12, 0);
    scenario_destroy(s);
  }
}

static void assert_part_accepted(const char *text, budget_part *part) {
  char *list[BUDGET_SETTINGS];
  scenario *s = NULL;
  for (int k = 0; k < part->nset; k++) list[k] = part->set[k];
  assert_ok(scenario_read_text("test.yaml", text, strlen(text), part->nset, list, &s));
  scenario_destroy(s);
}

/* Of an equilibrium there is no part of time, and none of frames that grow old. */
static void equilibria_have_no_time(void **state) {
  (void)state;
  static const struct {
    const char *text, *names;
  } cases[] = {
      {MINIMAL "strain: green\n", "algebraic solver, load steps, space"},
      {MINIMAL "strain: warp\nframes: {policy: hold, interval: 0.1}\n",
       "algebraic solver, load steps, frame rule, strain measure, space"},
      {MINIMAL "strain: hybrid\nviscosity: objective\nstatics: {min_step: 0.5, max_step: 0.5}\n",
       "algebraic solver, load steps, strain measure, space"},
  };
  for (int i = 0; i < 3; i++) {
    scenario *s = accept(cases[i].text);
    budget_plan plan;
    char found[256] = "";
    budget_plan_make_static(s, 1, &plan);
    for (int k = 0; k < plan.npart; k++) {
      if (k) strcat(found, ", ");
      strcat(found, budget_names[plan.part[k].kind]);
      assert_part_accepted(cases[i].text, &plan.part[k]);
    }
    assert_string_equal(found, cases[i].names);
    assert_int_equal(plan.check.nset, 0);
    assert_part_accepted(cases[i].text, &plan.algebra_check);
    assert_true(plan.algebra_check.nset > 0);
    scenario_destroy(s);
  }
}

/* Each try is a hundred times finer, as far as double precision goes. */
static void references_are_tightened_to_an_end(void **state) {
  (void)state;
  static const struct {
    const char *text;
    double rtol[3];
  } cases[] = {
      {MINIMAL "integrator: {method: newmark, step: 0.1}\n", {1e-8, 1e-10, 1e-11}},
      {MINIMAL "integrator: {rtol: 1e-8}\n", {1e-11, 0, 0}},
  };
  for (int i = 0; i < 2; i++) {
    scenario *s = accept(cases[i].text);
    for (int k = 0; k < 3; k++) {
      budget_part reference, check;
      assert_close(budget_plan_tighten(s, k + 1, &reference, &check), cases[i].rtol[k], 1e-12, 0);
      if (!(cases[i].rtol[k] > 0)) continue;
      assert_string_not_equal(reference.set[0], check.set[0]);
      assert_part_accepted(cases[i].text, &reference);
      assert_part_accepted(cases[i].text, &check);
    }
    scenario_destroy(s);
  }
}

/* Four-node tets are judged by ten-node ones, and these by their octasections. */
static void space_is_judged_by_what_is_better(void **state) {
  (void)state;
#define WITH(more) "mesh: {box: {size: [1, 1, 2], cells: [1, 1, 2]}" more "}\n" MATERIAL TIME
  static const struct {
    const char *text, *remedy;
    const char *set[2][3]; /* of the next level, and of the one after it; NULL: no more */
  } cases[] = {
      {WITH(""), "mesh.order 2", {{"mesh.order=2"}, {"mesh.order=2", "mesh.refine=1"}}},
      {WITH(", refine: 1"), "mesh.order 2", {{"mesh.order=2"}, {"mesh.order=2", "mesh.refine=2"}}},
      {WITH(", order: 1") "mass: lumped\n",
       "mesh.order 2",
       {{"mesh.order=2", "mass=consistent"}, {"mesh.order=2", "mesh.refine=1", "mass=consistent"}}},
      {WITH(", order: 2") "mass: lumped\n",
       "mesh.refine one more",
       {{"mesh.refine=1"}, {"mesh.refine=2"}}},
      {WITH(", order: 2, refine: 1"),
       "mesh.refine one more",
       {{"mesh.refine=2"}, {"mesh.refine=3"}}},
  };
#undef WITH
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    scenario *s = accept(cases[i].text);
    budget_plan plan;
    budget_plan_make(s, s->order == 2 ? 2 : 1, &plan);
    assert_string_equal(budget_remedy(&plan, BUDGET_SPACE, false), cases[i].remedy);
    for (int level = 1; level <= 2; level++) {
      const char *const *expected = cases[i].set[level - 1];
      budget_part part = {0};
      budget_plan_finer(&plan, s, level, &part);
      for (int k = 0; k < part.nset; k++) assert_string_equal(part.set[k], expected[k]);
      assert_true(part.nset == 3 || !expected[part.nset]);
      assert_part_accepted(cases[i].text, &part);
    }
    scenario_destroy(s);
  }
}

/* What takes hours is not done unasked. */
static void dear_levels_are_left_out(void **state) {
  (void)state;
  assert_true(budget_plan_affords(true, 1e6, 1e5) && budget_plan_affords(false, 2e7, 1e5));
  assert_false(budget_plan_affords(true, 1e7, 1e5) || budget_plan_affords(false, 1e8, 1e5));
  assert_false(budget_plan_affords(true, 1e6, 1e6) || budget_plan_affords(false, 1e6, 1e6));
  assert_false(budget_plan_affords(false, NAN, 1e5) || budget_plan_affords(false, 1e6, NAN));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(parts_are_the_approximations_made),
      cmocka_unit_test(frames_as_old_as_steps_come_before_time),
      cmocka_unit_test(settings_make_scenarios),
      cmocka_unit_test(the_viscous_law_is_no_part),
      cmocka_unit_test(no_error_of_time_is_three_digits_less),
      cmocka_unit_test(equilibria_have_no_time),
      cmocka_unit_test(references_are_tightened_to_an_end),
      cmocka_unit_test(space_is_judged_by_what_is_better),
      cmocka_unit_test(dear_levels_are_left_out),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
