/* Study files: axes, grids, cells, and the runs they are planned as. */
#include "alloc.h"
#include "study_text.h"

/* "a=1 b=2 [series] | ..." of all cells, in their order. */
static const char *cells_of(const study *s) {
  static char text[4096];
  size_t used = 0;
  text[0] = '\0';
  for (int i = 0; i < s->ncell; i++) {
    const cell *c = &s->cell[i];
    for (int k = 0; k < c->nplace; k++) {
      const char *value;
      assert_ok(study_value_text(s->tree, c->place[k].value, &value));
      used += (size_t)snprintf(text + used, sizeof text - used, "%s=%s ", c->place[k].key, value);
    }
    used += (size_t)snprintf(text + used, sizeof text - used, "[%s]%s", c->series,
                             i + 1 < s->ncell ? " | " : "");
  }
  return text;
}

static void expect_cells(const char *lines, const char *expected) {
  char *dir = temporary_folder();
  study *s = accept_study(dir, lines);
  assert_string_equal(cells_of(s), expected);
  study_destroy(s);
  remove_folder(dir);
}

static void axes_of_every_kind(void **state) {
  (void)state;
  expect_cells("axes: [{key: strain, values: [polar, green]}]",
               "strain=green [green] | strain=polar [polar]");
  expect_cells("axes: [{key: integrator.rtol, log: {from: 1e-2, to: 1e-4, per_decade: 1}}]",
               "integrator.rtol=1e-2 [all] | integrator.rtol=0.001 [all] | "
               "integrator.rtol=1e-4 [all]");
  expect_cells("axes: [{key: integrator.rtol, log: {from: 0.1, to: 0.02, per_decade: 2}}]",
               "integrator.rtol=0.1 [all] | integrator.rtol=0.03162 [all]");
  expect_cells("axes: [{key: time.end, log: {from: 1, to: 4, points: 3}}]\ntolerance: time.end",
               "time.end=4 [all] | time.end=2 [all] | time.end=1 [all]");
  expect_cells("axes: [{zip: {strain: [polar, warp], time.end: [1, 2]}}]",
               "strain=polar time.end=1 [polar, end 1] | strain=warp time.end=2 [warp, end 2]");
  expect_cells(
      "axes: [{name: how, variants: [{label: two words, set: {strain: polar}},\n"
      "                              {label: b, set: {mesh: null}}]}]",
      "how=b [b] | how=two words [two words]");
  expect_cells("axes: [{key: mesh.box.cells, values: [[1, 1, 2], [1, 1, 1]]}]",
               "mesh.box.cells=[1, 1, 1] [cells [1, 1, 1]] | "
               "mesh.box.cells=[1, 1, 2] [cells [1, 1, 2]]");
}

static void grids_stand_beside_each_other(void **state) {
  (void)state;
  expect_cells(
      "axes: [{key: strain, values: [green]}]\n"
      "grids:\n"
      "  - axes: [{key: integrator.rtol, values: [1e-2, 1e-3]}]\n"
      "  - set: {integrator.method: bdf2}\n"
      "    axes: [{key: integrator.step, values: [0.5]}]\n"
      "  - axes: [{key: integrator.rtol, values: [0.001]}]\n",
      "integrator.rtol=1e-2 strain=green [green] | "
      "integrator.rtol=1e-3 strain=green [green] | "
      "integrator.step=0.5 strain=green [green]");
}

static void excluded_and_grouped(void **state) {
  (void)state;
  const char axes[] =
      "axes: [{key: strain, values: [green, polar]}, {key: integrator.max_order, values: [1, 2]},\n"
      "       {key: integrator.rtol, values: [1e-2, 1e-3]}]\n"
      "exclude: [{integrator.rtol: 0.01, strain: green}, {integrator.max_order: 1, strain: "
      "polar}]\n"
      "group: strain\n";
  expect_cells(axes,
               "integrator.max_order=1 integrator.rtol=1e-3 strain=green [green] | "
               "integrator.max_order=2 integrator.rtol=1e-3 strain=green [green] | "
               "integrator.max_order=2 integrator.rtol=1e-2 strain=polar [polar] | "
               "integrator.max_order=2 integrator.rtol=1e-3 strain=polar [polar]");
}

static void the_order_of_axes_does_not_matter(void **state) {
  (void)state;
  char *dir = temporary_folder();
  const char *order[] = {
      "axes: [{key: strain, values: [green, polar]}, {key: integrator.rtol, values: [1e-2, 1e-3]}]",
      "axes: [{key: integrator.rtol, values: [0.001, 1.0e-2]}, {key: strain, values: [polar, "
      "green]}]",
  };
  manifest *m[2] = {planned(dir, order[0]), planned(dir, order[1])};
  assert_int_equal(m[0]->ncell, 4);
  assert_int_equal(m[0]->nrun, 4 + 4);
  for (int i = 0; i < 4; i++) {
    assert_string_equal(m[0]->run[m[0]->cell[i].run].hash, m[1]->run[m[1]->cell[i].run].hash);
    assert_string_equal(m[0]->cell[i].series, m[1]->cell[i].series);
  }
  manifest_destroy(m[0]);
  manifest_destroy(m[1]);
  remove_folder(dir);
}

/* Of one solid: the solution's settings are replaced, the others kept, unless they are set. */
static void references_belong_to_solids(void **state) {
  (void)state;
  char *dir = temporary_folder();
  const char axes[] =
      "axes: [{key: strain, values: [green, polar]}, {key: integrator.rtol, values: [1e-2, "
      "1e-8]},\n"
      "       {key: linear_solver, values: [klu, cholmod]}]\n";
  manifest *m = planned(dir, axes);
  assert_int_equal(m->nreference, 2);
  assert_int_equal(m->nrun, 8 + 4);
  assert_close(m->reference[0].rtol, 1e-10, 1e-12, 0); /* a hundredth of the tightest */
  const study_run *run = &m->run[m->reference[0].run[1]];
  assert_string_equal(run->set[1], "strain=green");
  assert_string_equal(run->set[2], "integrator={method: arkode, rtol: 1e-10}");
  for (int i = 0; i < m->ncell; i++)
    assert_int_equal(m->cell[i].reference, strstr(m->cell[i].series, "polar") != NULL);
  manifest_destroy(m);

  char text[512];
  snprintf(text, sizeof text,
           "%sreference: {rtol: 1e-7, methods: [ida, erk], set: {strain: green}}", axes);
  m = planned(dir, text);
  assert_int_equal(m->nreference, 1);
  assert_string_equal(m->reference[0].method[1], "erk");
  assert_close(m->reference[0].rtol, 1e-7, 1e-12, 0);
  manifest_destroy(m);
  m = planned(dir, "axes: [{key: strain, values: [green]}]\nreference: none");
  assert_int_equal(m->nreference, 0);
  assert_int_equal(m->cell[0].reference, -1);
  manifest_destroy(m);
  remove_folder(dir);
}

/* ~ and null are one value; 1 and "1" are two, and null none of them. */
static void values_are_what_they_mean(void **state) {
  (void)state;
  char *dir = temporary_folder();
  manifest *m = planned(dir,
                        "axes: [{key: title, values: [~, null, \"null\", \"1\", 1, 1.0]}]\n"
                        "exclude: [{title: 1e0}]\n"
                        "reference: none");
  assert_int_equal(m->ncell, 3);
  assert_true(json_is_null(json_object_get(m->cell[0].settings, "title")) +
                  json_is_null(json_object_get(m->cell[1].settings, "title")) +
                  json_is_null(json_object_get(m->cell[2].settings, "title")) ==
              1);
  manifest_destroy(m);
  remove_folder(dir);
}

static void equal_runs_are_one(void **state) {
  (void)state;
  char *dir = temporary_folder();
  manifest *m = planned(dir,
                        "axes: [{name: m, variants: [{label: as is, set: {}},\n"
                        "                            {label: said, set: {strain: polar}}]}]\n"
                        "reference: none");
  assert_int_equal(m->ncell, 2);
  assert_int_equal(m->nrun, 1);
  manifest_destroy(m);
  remove_folder(dir);
}

static void as_read_from_its_file(void **state) {
  (void)state;
  char *dir = temporary_folder();
  manifest *m = planned(dir, "axes: [{key: integrator.rtol, values: [1e-2, 1e-3]}]\nrepeat: 3");
  manifest *again = NULL;
  assert_ok(manifest_write(m, dir));
  assert_ok(manifest_read(dir, &again));
  assert_true(json_equal(m->root, again->root));
  assert_int_equal(again->repeat, 3);
  assert_close(again->cell[1].tolerance, 1e-3, 0, 0);
  manifest_destroy(m);
  manifest_destroy(again);

  char *text = slurp(in(dir, "study.json"), NULL);
  const char *damage[][2] = {
      {"\"run\": 1", "\"run\": 7"},
      {"\"reference\": 0", "\"reference\": 1"},
      {"\"id\"", "\"ix\""},
      {"\"series\": \"all\"", "\"series\": 3"},
      {"\"methods\": [\"cvode\", \"arkode\"]", "\"methods\": [\"cvode\"]"},
      {"\"set\": [", "\"set\": [1, "},
      {"\"identity\"", "\"identify\""},
  };
  for (size_t i = 0; i < sizeof damage / sizeof *damage; i++) {
    char *at = strstr(text, damage[i][0]), other[16384];
    assert_non_null(at);
    snprintf(other, sizeof other, "%.*s%s%s", (int)(at - text), text, damage[i][1],
             at + strlen(damage[i][0]));
    put_file(in(dir, "study.json"), other);
    assert_fails(manifest_read(dir, &again), COROT_EFORMAT, "not the description of a study");
  }
  free(text);
  remove_folder(dir);
}

/* --- Measures --- */

static bool has_set(const study_run *run, const char *set) {
  for (int i = 0; i < run->nset; i++)
    if (strcmp(run->set[i], set) == 0) return true;
  return false;
}

/* The first compares; every run, and every reference, is asked for all quantities. */
static void quantities_are_asked_of_all_runs(void **state) {
  (void)state;
  char *dir = temporary_folder();
  manifest *m = planned(dir,
                        "axes: [{key: integrator.rtol, values: [1e-2, 1e-3]}]\n"
                        "set: {quantities: {own: corner.uy@end}}\n"
                        "measure: [max( corner.ux ), energy, \"mean(elastic, 0, 0.5)\",\n"
                        "          max(corner.ux)]\n");
  assert_string_equal(m->measure, "max(corner.ux)");
  assert_int_equal(m->nquantity, 2); /* one was there already */
  assert_string_equal(m->quantity[1].text, "mean(elastic, 0, 0.5)");
  assert_string_equal(m->quantity[1].name, "mean_elastic_0_0_5");
  for (int i = 0; i < m->nrun; i++) {
    assert_true(has_set(&m->run[i], "quantities.max_corner_ux=\"max( corner.ux )\""));
    assert_true(has_set(&m->run[i], "quantities.mean_elastic_0_0_5=\"mean(elastic, 0, 0.5)\""));
    scenario *s = NULL;
    assert_ok(scenario_read(m->base, m->run[i].nset, (char *const *)m->run[i].set, &s));
    assert_int_equal(s->nquantity, 3); /* with the base's */
    scenario_destroy(s);
  }
  assert_null(json_object_get(m->reference[0].settings, "quantities.max_corner_ux"));
  manifest_destroy(m);

  m = planned(dir, "axes: [{key: integrator.rtol, values: [1e-2]}]\nmeasure: corner.ux@end\n");
  assert_string_equal(m->measure, "corner.ux@end");
  manifest_destroy(m);
  m = planned(dir, "axes: [{key: integrator.rtol, values: [1e-2]}]\nmeasure: velocity\n");
  assert_string_equal(m->measure, "velocity");
  assert_int_equal(m->nquantity, 0);
  manifest_destroy(m);
  remove_folder(dir);
}

/* With its place in the study file, before anything runs. */
static void wrong_measures_are_refused(void **state) {
  (void)state;
  static const struct {
    const char *measure, *words;
  } wrong[] = {
      {"[displacment]",
       "study.yaml:4:11: measure[0]: displacment is no measure; did you mean "
       "displacement?\n  measure: [displacment]\n            ^"},
      {"tips",
       "4:10: measure: tips is no measure: expected displacement, velocity, energy, "
       "mixed, or a quantity such as max(corner.ux)"},
      {"[energy, max(corner.ux]", "4:32: measure[1]: a ) is missing at the end"},
      {"max(cornr.ux)",
       "4:14: quantities.max_cornr_ux: there is no column cornr.ux; did you mean "
       "corner.ux?"},
      {"'max(corner.ux, 0, 2)'", "4:29: quantities.max_corner_ux_0_2: t = 2 s is after the run"},
      {"[]", "expected a text, or a list"},
  };
  char *dir = temporary_folder();
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    char lines[256];
    study *s = NULL;
    manifest *m = NULL;
    snprintf(lines, sizeof lines, "axes: [{key: integrator.rtol, values: [1e-2]}]\nmeasure: %s\n",
             wrong[i].measure);
    corot_status status = study_of(dir, lines, &s);
    if (status == COROT_OK) status = plan_study(s, &m);
    assert_int_equal(status, COROT_EFORMAT);
    if (!strstr(corot_error(), wrong[i].words))
      fail_msg("'%s' lacks '%s'", corot_error(), wrong[i].words);
    study_destroy(s);
  }
  remove_folder(dir);
}

/* --- Memory --- */

static corot_status plan_once(void *dir) {
  static const char lines[] =
      "study: which\nbase: model.yaml\n"
      "axes: [{key: strain, values: [green, polar]},\n"
      "       {key: integrator.rtol, log: {from: 1e-2, to: 1e-3, per_decade: 1}}]\n"
      "measure: [max(corner.ux), energy]\n";
  study *s = NULL;
  manifest *m = NULL;
  corot_status status = study_read_text(in(dir, "study.yaml"), lines, sizeof lines - 1, &s);
  if (status == COROT_OK) status = plan_study(s, &m);
  manifest_destroy(m);
  study_destroy(s);
  return status;
}

static void failed_allocations(void **state) {
  (void)state;
  char *dir = temporary_folder();
  put_file(in(dir, "model.yaml"), FREE_CUBE);
  assert_survives_failed_allocations(plan_once, dir);
  remove_folder(dir);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(axes_of_every_kind),
      cmocka_unit_test(grids_stand_beside_each_other),
      cmocka_unit_test(excluded_and_grouped),
      cmocka_unit_test(the_order_of_axes_does_not_matter),
      cmocka_unit_test(references_belong_to_solids),
      cmocka_unit_test(values_are_what_they_mean),
      cmocka_unit_test(equal_runs_are_one),
      cmocka_unit_test(as_read_from_its_file),
      cmocka_unit_test(quantities_are_asked_of_all_runs),
      cmocka_unit_test(wrong_measures_are_refused),
      cmocka_unit_test(failed_allocations),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
