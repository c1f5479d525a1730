/* Scenario files: every accepted form, overrides, the resolved scenario, mesh and model. */
#define TEST_NAME "scenario"
#include "scenario_text.h"

#include "alloc.h"
#include "app/config/schema.h"
#include "app/text/json_text.h"
#include "app/text/suggest.h"

/* --- Defaults and accepted forms --- */

static void defaults(void **state) {
  (void)state;
  scenario *s = accept(MINIMAL);
  corot_integrator_def d = corot_integrator_defaults(), *i = &s->integrator;
  assert_string_equal(i->method, d.method);
  assert_string_equal(i->linear.solver, d.linear.solver);
  assert_close(i->rtol, d.rtol, 0, 0);
  assert_close(i->atol_displacement, d.atol_displacement, 0, 0);
  assert_close(i->atol_velocity, d.atol_velocity, 0, 0);
  assert_int_equal(i->max_order, d.max_order);
  assert_int_equal(i->max_steps, d.max_steps);
  assert_close(i->first_step, d.first_step, 0, 0);
  assert_close(i->min_step, d.min_step, 0, 0);
  assert_close(i->max_step, d.max_step, 0, 0);
  assert_int_equal(i->tangent, d.tangent);
  assert_int_equal(i->reassembly, d.reassembly);
  assert_int_equal(i->refactorisation, d.refactorisation);
  assert_close(i->gamma_change, d.gamma_change, 0, 0);
  assert_close(i->linear.tolerance, d.linear.tolerance, 0, 0);
  assert_close(i->step, d.step, 0, 0);
  assert_int_equal(i->solution, d.solution);
  assert_close(i->newton_tolerance, d.newton_tolerance, 0, 0);
  assert_int_equal(i->newton_iterations, d.newton_iterations);
  assert_close(i->spectral_radius, d.spectral_radius, 0, 0);

  assert_string_equal(s->title, "");
  assert_string_equal(s->model.strain, "polar");
  assert_int_equal(s->model.viscosity, COROT_VISCOSITY_AUTO);
  assert_int_equal(s->model.dilatation, COROT_DILATATION_LOCAL);
  assert_close(s->model.dilatation_local, corot_model_defaults().dilatation_local, 0, 0);
  assert_string_equal(s->frame_policy, "exact");
  assert_int_equal(s->frames.frames, COROT_FRAMES_EXACT);
  assert_int_equal(s->frames.history, COROT_HISTORY_AUTO);
  assert_int_equal(
      s->model.nfix + s->model.nmotion + s->model.nload + s->nprobe + s->ngroup + s->ncompare, 0);
  assert_close(s->t_end, 2, 0, 0);
  assert_close(s->output_step, 0.02, 0, 0);
  assert_true(s->write_fields);
  assert_int_equal(s->field_every, 0);
  assert_null(s->mesh_file);
  assert_int_equal(s->box.cells[2], 2);
  assert_close(s->box.size[2], 2, 0, 0);
  scenario_destroy(s);
}

static const char everything[] =
    "title: all of it\n"
    "mesh: {box: {size: [.5, 1., 2], cells: [1, 2, 3], origin: [-1, 0, 1e-1], split: kuhn},\n"
    "       refine: 0}\n"
    "groups:\n"
    "  base: {plane: {axis: z, at: 0.1}}\n"
    "  tip:  {box: {min: [-1, 0, 2], max: [1, 1, 3]}}\n"
    "  some: {nodes: [3, 5]}\n"
    "material: {lambda: 1.0e+5, mu: 1e4, density: 5.E2, damping: {lambda: 3, mu: 4, mass: 5}}\n"
    "strain: hybrid\n"
    "viscosity: objective\n"
    "dilatation: {name: nodal, local: 2.5}\n"
    "frames: {policy: hold, interval: 0.25, max_angle: 0.125, history: restart}\n"
    "boundary:\n"
    "  - {group: base, fix: [x, z]}\n"
    "  - {group: tip, rotate: {axis: [0, 2, 0], center: [1, 2, 3], rate: -4, from: 1, to: 2}}\n"
    "  - {group: some, translate: {velocity: [5, 6, 7], from: 3}}\n"
    "loads:\n"
    "  - {group: tip, traction: [1, 2, 3], amplitude: [[0, 0], [10, 1]]}\n"
    "  - {gravity: [0, 0, -9.81]}\n"
    "  - {group: tip, pressure: 50}\n"
    "  - {group: some, force: [7, 8, 9], amplitude: [[1, 2]]}\n"
    "time: {end: 4, output: 0.5}\n"
    "integrator: {method: cvode, rtol: 1e-6, atol: {displacement: 1e-7, velocity: 1e-5},\n"
    "  max_order: 5, max_steps: 1e6, first_step: 1e-3, min_step: 1e-9, max_step: 0.1,\n"
    "  jacobian: {tangent: exact, reassembly: 3, refactorisation: 4, gamma_change: 0.5},\n"
    "  solution: linear, newton: {tolerance: 1e-7, iterations: 9}, spectral_radius: 0.25}\n"
    "linear_solver: {name: pcg, tolerance: 1e-3}\n"
    "start: equilibrium\n"
    "statics: {frames: held, tolerance: 1e-8, max_iterations: 33, first_step: 0.5,\n"
    "  min_step: 1e-3, max_step: 0.75}\n"
    "compare: [polar, cauchy]\n"
    "probes:\n"
    "  corner: {point: [1, 2, 3]}\n"
    "  n-17_b: {node: 17}\n"
    "output: {fields: none, every: 7}\n";

static void all_keys(void **state) {
  (void)state;
  scenario *s = accept(everything);
  assert_string_equal(s->title, "all of it");
  assert_close(s->box.size[0], 0.5, 0, 0);
  assert_close(s->box.origin[2], 0.1, 0, 0);
  assert_int_equal(s->ngroup, 3);
  assert_string_equal(s->group[0].name, "base");
  assert_int_equal(s->group[0].kind, GROUP_PLANE);
  assert_int_equal(s->group[0].axis, 2);
  assert_close(s->group[0].at, 0.1, 0, 0);
  assert_int_equal(s->group[1].kind, GROUP_BOX);
  assert_close(s->group[1].max[2], 3, 0, 0);
  assert_int_equal(s->group[2].kind, GROUP_NODES);
  assert_int_equal(s->group[2].nnode, 2);
  assert_int_equal(s->group[2].node[1], 5);
  assert_close(s->model.material[0].lambda, 1e5, 0, 0);
  assert_close(s->model.material[0].mu, 1e4, 0, 0);
  assert_close(s->model.material[0].density, 500, 0, 0);
  assert_close(s->model.material[0].damping_lambda, 3, 0, 0);
  assert_close(s->model.material[0].damping_mu, 4, 0, 0);
  assert_close(s->model.material[0].damping_mass, 5, 0, 0);
  assert_null(s->model.material[0].group);
  assert_int_equal(s->model.viscosity, COROT_OBJECTIVE);
  assert_int_equal(s->model.dilatation, COROT_DILATATION_NODAL);
  assert_close(s->model.dilatation_local, 2.5, 0, 0);
  assert_string_equal(s->frame_policy, "hold");
  assert_int_equal(s->frames.frames, COROT_FRAMES_HELD);
  assert_close(s->frames.interval, 0.25, 0, 0);
  assert_close(s->frames.max_angle, 0.125, 0, 0);
  assert_int_equal(s->frames.history, COROT_HISTORY_RESTART);
  assert_int_equal(s->ncompare, 3);
  assert_string_equal(s->compare[0], "polar");
  assert_string_equal(s->compare[1], "cauchy");
  assert_string_equal(s->compare[2], "hybrid"); /* the run's own */
  scenario_destroy(s);
}

static void all_keys_of_statics(void **state) {
  (void)state;
  scenario *s = accept(everything);
  assert_true(s->start_at_equilibrium);
  assert_string_equal(s->statics.linear.solver, "pcg");
  assert_int_equal(s->statics.frames, COROT_FRAMES_HELD);
  assert_close(s->statics.tolerance, 1e-8, 0, 0);
  assert_int_equal(s->statics.max_iterations, 33);
  assert_close(s->statics.first_step, 0.5, 0, 0);
  assert_close(s->statics.min_step, 1e-3, 0, 0);
  assert_close(s->statics.max_step, 0.75, 0, 0);
  scenario_destroy(s);
}

static void all_keys_of_boundary(void **state) {
  (void)state;
  scenario *s = accept(everything);
  assert_int_equal(s->model.nfix, 1);
  assert_true(s->model.fix[0].component[0] && !s->model.fix[0].component[1] &&
              s->model.fix[0].component[2]);
  assert_int_equal(s->model.nmotion, 2);
  const corot_motion *m = s->model.motion;
  assert_int_equal(m[0].kind, COROT_ROTATE);
  assert_string_equal(m[0].group, "tip");
  assert_close(m[0].axis[1], 2, 0, 0);
  assert_close(m[0].center[2], 3, 0, 0);
  assert_close(m[0].rate, -4, 0, 0);
  assert_close(m[0].from, 1, 0, 0);
  assert_close(m[0].to, 2, 0, 0);
  assert_int_equal(m[1].kind, COROT_TRANSLATE);
  assert_string_equal(m[1].group, "some");
  assert_close(m[1].velocity[1], 6, 0, 0);
  assert_close(m[1].from, 3, 0, 0);
  assert_true(m[1].to == INFINITY);
  scenario_destroy(s);
}

static void all_keys_of_loads_and_run(void **state) {
  (void)state;
  scenario *s = accept(everything);
  assert_int_equal(s->model.nload, 4);
  assert_int_equal(s->model.load[0].kind, COROT_TRACTION);
  assert_string_equal(s->model.load[0].group, "tip");
  assert_close(s->model.load[0].value[1], 2, 0, 0);
  assert_int_equal(s->model.load[0].amplitude.n, 2);
  assert_close(s->model.load[0].amplitude.time[1], 10, 0, 0);
  assert_close(s->model.load[0].amplitude.value[1], 1, 0, 0);
  assert_int_equal(s->model.load[1].kind, COROT_GRAVITY);
  assert_null(s->model.load[1].group);
  assert_close(s->model.load[1].value[2], -9.81, 0, 0);
  assert_int_equal(s->model.load[1].amplitude.n, 0);
  assert_int_equal(s->model.load[2].kind, COROT_PRESSURE);
  assert_close(s->model.load[2].value[0], 50, 0, 0);
  assert_int_equal(s->model.load[3].kind, COROT_FORCE);
  assert_string_equal(s->model.load[3].group, "some");
  assert_close(s->model.load[3].value[2], 9, 0, 0);
  assert_close(s->model.load[3].amplitude.value[0], 2, 0, 0);
  corot_integrator_def *i = &s->integrator;
  assert_close(i->rtol, 1e-6, 0, 0);
  assert_close(i->atol_displacement, 1e-7, 0, 0);
  assert_close(i->atol_velocity, 1e-5, 0, 0);
  assert_int_equal(i->max_order, 5);
  assert_int_equal(i->max_steps, 1000000);
  assert_close(i->min_step, 1e-9, 0, 0);
  assert_int_equal(i->tangent, COROT_TANGENT_EXACT);
  assert_int_equal(i->refactorisation, 4);
  assert_int_equal(i->solution, COROT_SOLUTION_LINEAR);
  assert_close(i->newton_tolerance, 1e-7, 0, 0);
  assert_int_equal(i->newton_iterations, 9);
  assert_close(i->spectral_radius, 0.25, 0, 0);
  assert_string_equal(i->linear.solver, "pcg");
  assert_close(i->linear.tolerance, 1e-3, 0, 0);
  assert_int_equal(s->probe[0].node, -1);
  assert_close(s->probe[0].point[1], 2, 0, 0);
  assert_string_equal(s->probe[1].name, "n-17_b");
  assert_int_equal(s->probe[1].node, 17);
  assert_false(s->write_fields);
  assert_int_equal(s->field_every, 7);
  scenario_destroy(s);
}

static void frame_policies(void **state) {
  (void)state;
  scenario *s = accept(MINIMAL "frames: {policy: step, history: keep}\n");
  assert_int_equal(s->frames.frames, COROT_FRAMES_HELD);
  assert_true(s->frames.every_step);
  assert_int_equal(s->frames.history, COROT_HISTORY_KEEP);
  scenario_destroy(s);
  s = accept(MINIMAL "frames: {policy: extrapolate, max_angle: 0.5}\n");
  assert_int_equal(s->frames.frames, COROT_FRAMES_EXTRAPOLATED);
  assert_close(s->frames.max_angle, 0.5, 0, 0);
  assert_close(s->frames.interval, 0, 0, 0);
  assert_false(s->frames.every_step);
  scenario_destroy(s);
}

static void methods_of_constant_step(void **state) {
  (void)state;
  static const char *const method[] = {
      "backward-euler", "bdf2", "bdf3", "midpoint", "newmark", "hht", "generalized-alpha"};
  for (int k = 0; k < 7; k++) {
    char text[512];
    snprintf(text, sizeof text, MINIMAL "integrator: {method: %s, step: 0.25}\n", method[k]);
    scenario *s = accept(text);
    assert_string_equal(s->integrator.method, method[k]);
    assert_close(s->integrator.step, 0.25, 0, 0);
    scenario_destroy(s);
  }
}

static void comparisons(void **state) {
  (void)state;
  scenario *s = accept(MINIMAL "compare: [polar, warp]\n");
  assert_int_equal(s->ncompare, 2); /* the run's own is there already */
  scenario_destroy(s);
  s = accept(MINIMAL "compare: [cauchy]\nstrain: green\n");
  assert_int_equal(s->ncompare, 1); /* green is what the others are compared with */
  scenario_destroy(s);
}

static void material_forms(void **state) {
  (void)state;
  scenario *s = accept(MESH TIME "material: {E: 260, nu: 0.3, density: 1}\n");
  assert_close(s->model.material->mu, 100, 1e-15, 0);
  assert_close(s->model.material->lambda, 150, 1e-15, 0);
  scenario_destroy(s);

  s = accept(MESH TIME "material: {mu: 100, nu: 0.3, density: 1}\n");
  assert_close(s->model.material->lambda, 150, 1e-15, 0);
  json_t *material = json_object_get(s->resolved, "material");
  assert_close(json_real_value(json_object_get(material, "lambda")), 150, 1e-15, 0);
  assert_null(json_object_get(material, "nu"));
  scenario_destroy(s);

  s = accept(MESH TIME
             "material:\n"
             "  - {group: hard, E: 2, nu: 0, density: 1}\n"
             "  - {lambda: 1, mu: 2, density: 3}\n");
  assert_int_equal(s->model.nmaterial, 2);
  assert_string_equal(s->model.material[0].group, "hard");
  assert_close(s->model.material[0].mu, 1, 0, 0);
  assert_null(s->model.material[1].group);
  assert_close(s->model.material[1].density, 3, 0, 0);
  scenario_destroy(s);
}

/* What was left empty is as if it were not there; anchors repeat a value. */
static void yaml_features(void **state) {
  (void)state;
  scenario *s = accept("%YAML 1.1\n---\n" MINIMAL "loads:\nboundary: null\nstrain: ~\n");
  assert_int_equal(s->model.nload, 0);
  assert_string_equal(s->model.strain, "polar");
  scenario_destroy(s);

  s = accept(MINIMAL
             "groups: {a: {nodes: [0]}}\n"
             "loads:\n"
             "  - {gravity: [0, 0, -1], amplitude: &ramp [[0, 0], [1, 1]]}\n"
             "  - {gravity: [1, 0, 0], amplitude: *ramp}\n");
  assert_int_equal(s->model.load[1].amplitude.n, 2);
  scenario_destroy(s);

  s = accept("# comment\r\n" MESH MATERIAL "title: \"caf\xC3\xA9\"\r\n" TIME);
  assert_string_equal(s->title, "caf\xC3\xA9");
  scenario_destroy(s);
}

static void json_files(void **state) {
  (void)state;
  static const char text[] =
      "{\n\t\"mesh\": {\"box\": {\"size\": [1, 1, 2], \"cells\": [1, 1, 2]}},\n"
      "\t\"material\": {\"lambda\": 1E5, \"mu\": 1e4, \"density\": 1000.0},\n"
      "\t\"time\": {\"end\": 2.0}\n}\n";
  scenario *s = NULL;
  assert_ok(read_as(JSON_NAME, text, &s));
  assert_close(s->model.material->lambda, 1e5, 0, 0);
  scenario_destroy(s);
  s = accept(text); /* under any name */
  assert_close(s->t_end, 2, 0, 0);
  scenario_destroy(s);
  s = NULL;
  assert_fails(read_as(JSON_NAME, "{\"mesh\": 'x'}\n", &s), COROT_EFORMAT, TEST_NAME ".json:1:");
  assert_fails(read_as(JSON_NAME, "{\"tme\": {}}", &s), COROT_EFORMAT, TEST_NAME ".json:1:2: tme:");
}

static void mesh_path(void **state) {
  (void)state;
  scenario *s = accept("mesh: {file: sub/bar.msh}\n" MATERIAL TIME);
  assert_string_equal(s->mesh_file, BINARY_DIR "/sub/bar.msh");
  scenario_destroy(s);
  s = accept("mesh: {file: /tmp/bar.msh}\n" MATERIAL TIME);
  assert_string_equal(s->mesh_file, "/tmp/bar.msh");
  scenario_destroy(s);
}

/* --- Overrides --- */

static corot_status override(const char *text, const char *assignment, scenario **s) {
  char copy[256];
  snprintf(copy, sizeof copy, "%s", assignment);
  char *list[] = {copy};
  write_file(FILE_NAME, text, strlen(text));
  return scenario_read(FILE_NAME, 1, list, s);
}

static void overrides(void **state) {
  (void)state;
  scenario *s = NULL;
  assert_ok(override(MINIMAL, "integrator.rtol=1e-6", &s)); /* a map that was not there */
  assert_close(s->integrator.rtol, 1e-6, 0, 0);
  scenario_destroy(s);
  assert_ok(override(everything, "loads.0.traction=[1, 0, 0]", &s));
  assert_close(s->model.load[0].value[1], 0, 0, 0);
  assert_int_equal(s->model.load[0].amplitude.n, 2);
  scenario_destroy(s);
  assert_ok(override(everything, "loads=[]", &s));
  assert_int_equal(s->model.nload, 0);
  scenario_destroy(s);
  assert_ok(override(everything, "material={E: 2, nu: 0, density: 1}", &s));
  assert_close(s->model.material->mu, 1, 0, 0);
  scenario_destroy(s);
  assert_ok(override(everything, "title=a=b", &s));
  assert_string_equal(s->title, "a=b");
  scenario_destroy(s);
  assert_ok(override(everything, "title=", &s));
  assert_string_equal(s->title, "");
  scenario_destroy(s);
  assert_ok(override(everything, "frames=null", &s));
  assert_string_equal(s->frame_policy, "exact");
  scenario_destroy(s);
  assert_ok(override(everything, "frames.policy=exact", &s)); /* an interval may be left there */
  assert_string_equal(s->frame_policy, "exact");
  assert_close(s->frames.interval, 0, 0, 0);
  scenario_destroy(s);
  assert_ok(override(everything, "linear_solver=klu", &s));
  assert_string_equal(s->integrator.linear.solver, "klu");
  assert_close(s->integrator.linear.tolerance, 1e-10, 0, 0);
  scenario_destroy(s);
}

static void overrides_in_order(void **state) {
  (void)state;
  char *list[] = {(char[]){"mesh.box=null"}, (char[]){"mesh.file=a.msh"},
                  (char[]){"mesh.file=b.msh"}};
  scenario *s = NULL;
  write_file(FILE_NAME, MINIMAL, strlen(MINIMAL));
  assert_ok(scenario_read(FILE_NAME, 3, list, &s));
  assert_string_equal(s->mesh_file, BINARY_DIR "/b.msh");
  scenario_destroy(s);
}

/* What was given by its name alone is a map when another of its keys is set. */
static void overrides_of_short_forms(void **state) {
  (void)state;
  char *list[] = {(char[]){"linear_solver=pcg"}, (char[]){"linear_solver.tolerance=1e-6"},
                  (char[]){"dilatation=nodal"}, (char[]){"dilatation.local=2"}};
  scenario *s = NULL;
  write_file(FILE_NAME, MINIMAL, strlen(MINIMAL));
  assert_ok(scenario_read(FILE_NAME, 4, list, &s));
  assert_string_equal(s->integrator.linear.solver, "pcg");
  assert_close(s->integrator.linear.tolerance, 1e-6, 0, 0);
  assert_true(s->model.dilatation == COROT_DILATATION_NODAL && s->model.dilatation_local == 2);
  scenario_destroy(s);
  list[1] = (char[]){"linear_solver=klu"}; /* the whole of it */
  assert_ok(scenario_read(FILE_NAME, 4, list, &s));
  assert_string_equal(s->integrator.linear.solver, "klu");
  assert_close(s->integrator.linear.tolerance, 1e-10, 0, 0);
  scenario_destroy(s);
}

/* The name of the mesh file alone, and the unit that it is in. */
static void mesh_in_short(void **state) {
  (void)state;
  scenario *s = NULL;
  assert_ok(override(MINIMAL, "mesh=a.msh", &s));
  assert_string_equal(s->mesh_file, BINARY_DIR "/a.msh");
  assert_close(s->scale, 0, 0, 0);
  scenario_destroy(s);
  assert_ok(override(MINIMAL, "mesh={file: a.msh, unit: in}", &s));
  assert_close(s->scale, 0.0254, 0, 0);
  scenario_destroy(s);
  assert_ok(override(MINIMAL, "mesh={file: a.msh, scale: 0.5}", &s));
  assert_close(s->scale, 0.5, 0, 0);
  scenario_destroy(s);
}

static void bad_overrides(void **state) {
  (void)state;
  static const refusal r[] = {
      {"integrator.rtol=-1",
       "--set integrator.rtol=-1: integrator.rtol: must be > 0, < 1, found -1"},
      {"integrator.rtoll=1",
       "--set integrator.rtoll=1: integrator.rtoll: unknown key; did you mean"},
      {"integrator.rtol", "--set integrator.rtol: expected KEY=VALUE"},
      {"=1", "--set =1: expected KEY=VALUE"},
      {"a..b=1", "--set a..b=1: a key is empty"},
      {"loads.4.traction=[1, 0, 0]",
       "loads is a list of 4; \"4\" is no entry of it, they are numbered"},
      {"loads.-1.traction=1", "\"-1\" is no entry"},
      {"loads.x=1", "\"x\" is no entry"},
      {"strain.x=1", "--set strain.x=1: strain is a single value, not a map"},
      {"integrator.rtol=[1", "--set integrator.rtol=[1: flow sequence without a closing bracket"},
      {"material.nu=0.3", "material: give lambda and mu, or E and nu, or mu and nu"},
      {"title=\xff", "is not text in UTF-8"},
  };
  for (size_t i = 0; i < sizeof r / sizeof *r; i++) {
    scenario *s = NULL;
    assert_fails(override(everything, r[i].text, &s), COROT_EFORMAT, r[i].message);
  }
}

/* --- The resolved scenario --- */

static json_t *resolve(const char *text) {
  scenario *s = accept(text);
  json_t *resolved = json_incref(s->resolved);
  scenario_destroy(s);
  return resolved;
}

/* Read again, it is the same, and nothing is left to default. */
static void resolved_is_a_fixed_point(void **state) {
  (void)state;
  static const char *const text[] = {
      MINIMAL, everything,
      MESH TIME "material: {E: 7, nu: 0.3, density: 1}\ntitle: \"5 \\\" \\n\""};
  for (int i = 0; i < 3; i++) {
    json_t *first = resolve(text[i]);
    FILE *file = fopen(FILE_NAME ".resolved", "w");
    assert_non_null(file);
    json_text_write(first, file);
    fclose(file);
    scenario *s = NULL;
    assert_ok(scenario_read(FILE_NAME ".resolved", 0, NULL, &s));
    assert_true(json_equal(first, s->resolved));
    scenario_destroy(s);
    json_decref(first);
  }
}

static void resolved_values(void **state) {
  (void)state;
  json_t *r = resolve(MINIMAL);
  char *text = json_dumps(r, JSON_COMPACT | JSON_REAL_PRECISION(15));
  assert_non_null(text);
  assert_string_equal(
      text,
      "{\"title\":\"\",\"mesh\":{\"box\":{\"size\":[1.0,1.0,2.0],\"cells\":[1,1,2],\"origin\":[0.0,"
      "0.0,0.0],\"split\":\"kuhn\"},\"refine\":0,\"diagonal\":\"shortest\"},\"groups\":{},"
      "\"material\":{\"lambda\":100000.0,"
      "\"mu\":10000.0,\"density\":1000.0,\"damping\":{\"lambda\":0.0,\"mu\":0.0,\"mass\":0.0}},"
      "\"mass\":\"auto\",\"strain\":\"polar\",\"dilatation\":{\"name\":\"local\",\"local\":1.0},"
      "\"viscosity\":\"auto\",\"frames\":{\"policy\":"
      "\"exact\","
      "\"history\":\"auto\"},\"boundary\":[],"
      "\"loads\":[],\"time\":{\"end\":2.0,\"output\":0.02},\"integrator\":{\"method\":\"cvode\","
      "\"solution\":\"newton\",\"newton\":{\"tolerance\":1e-9,\"iterations\":50},"
      "\"spectral_radius\":0.8,"
      "\"rtol\":0.0001,\"atol\":{\"displacement\":\"auto\",\"velocity\":\"auto\"},\"max_order\":"
      "\"auto\",\"order\":\"auto\",\"predictor\":\"auto\",\"max_steps\":\"none\",\"first_step\":"
      "\"auto\",\"min_step\":\"none\",\"max_step\":"
      "\"none\",\"jacobian\":{\"tangent\":\"auto\",\"reassembly\":\"auto\",\"refactorisation\":"
      "\"auto\","
      "\"gamma_change\":\"auto\",\"convergence\":\"auto\"}},\"linear_solver\":{\"name\":\"auto\","
      "\"ordering\":\"auto\",\"factor\":\"auto\",\"preconditioner\":\"auto\",\"tolerance\":1e-10},"
      "\"start\":\"rest\",\"statics\":{\"frames\":\"exact\",\"tolerance\":1e-10,"
      "\"max_iterations\":20,\"first_step\":1.0,\"min_step\":0.0001,\"max_step\":1.0},"
      "\"probes\":{},\"output\":{\"fields\":"
      "\"vtu\",\"every\":\"auto\",\"compression\":\"none\",\"history\":true,\"states\":\"none\","
      "\"space_error\":\"auto\"}}");
  free(text);
  json_decref(r);
}

static void numbers_as_text(void **state) {
  (void)state;
  static const struct {
    double x;
    const char *text;
  } n[] = {
      {1e-6, "1.0e-06"},
      {0.1, "0.1"},
      {5, "5.0"},
      {1e20, "1.0e+20"},
      {-2.5e-9, "-2.5e-09"},
      {0, "0.0"},
      {1.0 / 3, "0.3333333333333333"},
      {0.1 + 0.2, "0.30000000000000004"},
  };
  for (size_t i = 0; i < sizeof n / sizeof *n; i++) {
    char text[48];
    json_text_number(n[i].x, sizeof text, text);
    assert_string_equal(text, n[i].text);
    assert_true(strtod(text, NULL) == n[i].x);
  }
}

/* --- Scenario and mesh --- */

static void build(const char *text, corot_mesh **mesh, corot_model **model) {
  scenario *s = accept(text);
  corot_refinement *refinement;
  assert_ok(scenario_build(s, mesh, &refinement, model));
  corot_refinement_destroy(refinement);
  scenario_destroy(s);
}

static void builds(void **state) {
  (void)state;
  corot_mesh *mesh = NULL;
  corot_model *model = NULL;
  build(MINIMAL
        "groups: {base: {plane: {axis: z, at: 0}}, tip: {box: {min: [0, 0, 2], max: [1, 1, 2]}},"
        " two: {nodes: [0, 1]}}\n"
        "boundary: [{group: base, fix: [x, y, z]}]\n"
        "loads: [{group: tip, traction: [0, 0, 1]}]\n"
        "strain: green\n",
        &mesh, &model);
  assert_int_equal(mesh->nnode, 12);
  assert_int_equal(mesh->ntet, 12);
  assert_int_equal(corot_mesh_find_group(mesh, "base")->nnode, 4);
  assert_int_equal(corot_mesh_find_group(mesh, "tip")->ntri, 2);
  assert_int_equal(corot_mesh_find_group(mesh, "two")->nnode, 2);
  assert_int_equal(corot_model_ndof(model), 24);
  assert_string_equal(corot_model_strain(model), "green");
  corot_model_destroy(model);
  corot_mesh_destroy(mesh);
}

/* The default law is that of the measure in the end, whatever a file said before it was overridden;
   under a hierarchy it is the corotated one. */
static void the_viscous_law_follows_the_measure(void **state) {
  (void)state;
  static const struct {
    const char *set[2];
    corot_viscosity law;
  } table[] = {
      {{"strain=polar", "mesh.refine=1"}, COROT_OBJECTIVE},
      {{"strain=hybrid", "mesh.refine=0"}, COROT_OBJECTIVE},
      {{"strain=green", "mesh.refine=0"}, COROT_COROTATED},
      {{"strain=warp", "mesh.refine=0"}, COROT_COROTATED},
      {{"strain=polar", "viscosity=corotated"}, COROT_COROTATED},
      {{"mesh.refine=1", "hierarchy={coarse_strain: green}"}, COROT_COROTATED},
      {{"mesh.refine=0", "hierarchy={coarse_strain: polar}"}, COROT_COROTATED},
  };
  const char *text = MINIMAL "strain: polar\n";
  for (size_t k = 0; k < sizeof table / sizeof *table; k++) {
    scenario *s = NULL;
    corot_mesh *mesh = NULL;
    corot_model *model = NULL;
    corot_refinement *refinement = NULL;
    assert_ok(scenario_read_text("a.yaml", text, strlen(text), 2, (char *const *)table[k].set, &s));
    assert_ok(scenario_build(s, &mesh, &refinement, &model));
    assert_int_equal(corot_model_viscosity(model), table[k].law);
    corot_model_destroy(model), corot_refinement_destroy(refinement), corot_mesh_destroy(mesh);
    scenario_destroy(s);
  }
}

/* Bounds may be met. */
static void steps_at_their_bounds(void **state) {
  (void)state;
  static const char *const texts[] = {
      MINIMAL "integrator: {min_step: 0.5, max_step: 0.5}\n",
      MINIMAL "integrator: {first_step: 0.5, max_step: 0.5}\n",
      MINIMAL "integrator: {min_step: 0.5, first_step: 0.5, max_step: 0.5}\n",
      MINIMAL "statics: {min_step: 0.5, max_step: 0.5}\n",
      MINIMAL "statics: {first_step: 0.5, max_step: 0.5}\n",
      MINIMAL "statics: {first_step: 1, max_step: 1, min_step: 1}\n",
      MINIMAL "groups: {a: {box: {min: [0, 0, 1], max: [1, 0, 1]}}}\n",
      MINIMAL "integrator: {method: hht, step: 0.1, spectral_radius: 0.5}\n",
      MINIMAL "integrator: {method: hht, step: 0.1, spectral_radius: 1}\n",
      MINIMAL "integrator: {method: arkode, order: 5}\n",
      MINIMAL "integrator: {method: erk, order: 8}\n",
      MINIMAL "integrator: {method: cvode, max_order: 5}\n",
      MESH MATERIAL "time: {end: 2, output: 2}\n",
      "mesh: {box: {size: [1, 1, 2], cells: [1, 1, 2]}, refine: 1}\n" MATERIAL TIME
      "hierarchy: {frame_level: 1}\n",
  };
  for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
    print_message("%s", texts[k]);
    scenario_destroy(accept(texts[k]));
  }
}

/* Two cells across are six tets each by every split; one is cut in halves by the default. */
static void boxes_are_split_as_named(void **state) {
  (void)state;
  static const struct {
    const char *split;
    int ntet;
  } table[] = {{"", 6 * 2 * 2 * 8},
               {", split: symmetric", 6 * 2 * 2 * 8},
               {", split: alternating", 6 * 2 * 7},
               {", split: kuhn", 6 * 2 * 7}};
  for (size_t k = 0; k < sizeof table / sizeof *table; k++) {
    char text[512];
    corot_mesh *mesh = NULL;
    corot_model *model = NULL;
    snprintf(text, sizeof text,
             "mesh: {box: {size: [1, 1, 4], cells: [1, 2, 7]%s}}\n" MATERIAL TIME, table[k].split);
    build(text, &mesh, &model);
    assert_int_equal(mesh->ntet, table[k].ntet);
    corot_model_destroy(model), corot_mesh_destroy(mesh);
  }
}

static void builds_motions_and_loads(void **state) {
  (void)state;
  corot_mesh *mesh = NULL;
  corot_model *model = NULL;
  build(MINIMAL
        "boundary:\n"
        "- {group: zmin, rotate: {axis: [0, 0, 1], rate: 1, to: 0.5}}\n"
        "- {group: zmin, rotate: {axis: [0, 0, 2], rate: -1, from: 0.5}}\n"
        "- {group: zmax, fix: [z]}\n"
        "loads: [{group: zmax, pressure: 1}, {group: xmin, force: [0, 0, 1]}]\n"
        "viscosity: objective\n",
        &mesh, &model);
  double kink[4];
  assert_int_equal(corot_model_ndof(model), 36 - 12 - 4);
  assert_int_equal(corot_model_kinks(model, 0, 2, 4, kink), 1);
  assert_close(kink[0], 0.5, 0, 0);
  corot_model_destroy(model);
  corot_mesh_destroy(mesh);
}

static void builds_averages_of_the_dilatation(void **state) {
  (void)state;
  static const struct {
    const char *key;
    bool wider;
  } table[] = {{"", false},
               {"dilatation: local\n", false},
               {"dilatation: nodal\n", true},
               {"dilatation: {name: nodal, local: 9.9}\n", true},
               {"dilatation: {name: nodal, local: 10}\n", false}}; /* lambda is 10 mu */
  for (int k = 0; k < 5; k++) {
    char text[500];
    corot_mesh *mesh = NULL;
    corot_model *model = NULL;
    snprintf(text, sizeof text, "%s%s", MINIMAL, table[k].key);
    build(text, &mesh, &model);
    /* 12 nodes, 33 edges; averages couple all but the corners farthest apart */
    int narrow = 12 + 33, nblock = corot_model_nblock(model);
    assert_true(table[k].wider ? nblock > narrow : nblock == narrow);
    corot_model_destroy(model);
    corot_mesh_destroy(mesh);
  }
}

static void build_refusals(void **state) {
  (void)state;
  write_file(BINARY_DIR "/garbage.msh", "garbage\n", 8);
  static const refusal r[] = {
      {"mesh: {file: none.msh}\n" MATERIAL TIME, "1:14: mesh.file: " BINARY_DIR "/none.msh"},
      {"mesh: {file: garbage.msh}\n" MATERIAL TIME, "1:14: mesh.file: " BINARY_DIR "/garbage.msh"},
      {"mesh: {box: {size: [1, 1, 1], cells: [2e9, 2e9, 2e9]}}\n" MATERIAL TIME,
       "1:13: mesh.box: "},
      {MINIMAL "groups: {a: {plane: {axis: x, at: 7}}}", "4:10: groups.a: "},
      {MINIMAL "groups: {a: {nodes: [12]}}", "4:10: groups.a: "},
      {MINIMAL "groups: {xmin: {nodes: [1]}}", "4:10: groups.xmin: "},
      {MINIMAL "boundary: [{group: zmim, fix: [x]}]",
       "4:20: boundary[0].group: no group zmim; did you mean zmin?"},
      {MINIMAL "loads: [{group: wombat, traction: [0, 0, 1]}]",
       "4:17: loads[0].group: no group wombat; there are: xmin, xmax, ymin, ymax, zmin, zmax"},
      {MINIMAL "groups: {a: {nodes: [1]}}\nloads: [{group: a, traction: [0, 0, 1]}]",
       "5:17: loads[0].group: group 'a' has no faces for a traction to act on"},
      {MESH TIME "material: [{group: zmin, mu: 1, nu: 0, density: 1}]",
       "3:20: material[0].group: group 'zmin' has no tets for a material to fill"},
      {MESH TIME "groups: {a: {box: {min: [0, 0, 0], max: [1, 1, 1]}}}\n"
                 "material: [{group: a, mu: 1, nu: 0, density: 1}]",
       "4:1: material: "},
      {MESH TIME
       "groups: {a: {box: {min: [0, 0, 0], max: [1, 1, 2]}}, b: {plane: {axis: z, at: 0}},"
       "c: {box: {min: [0, 0, 0], max: [1, 1, 1]}}}\n"
       "material:\n- {group: a, mu: 1, nu: 0, density: 1}\n"
       "- {group: c, mu: 1, nu: 0, density: 1}",
       "6:11: material[1].group: tet 0 belongs to materials 0 and 1; see material[0]"},
      {MINIMAL "boundary:\n- {group: zmin, translate: {velocity: [0, 0, 1]}}\n"
               "- {group: zmaks, fix: [x]}",
       "6:11: boundary[1].group: no group zmaks; did you mean zmax?"},
      {MINIMAL "groups: {a: {nodes: [1]}}\nloads: [{group: a, pressure: 1}]",
       "5:17: loads[0].group: group 'a' has no faces for a pressure to act on (1 nodes, 0 tets)"},
      {MINIMAL "boundary:\n- {group: zmin, fix: [x]}\n- {group: xmin, rotate: {axis: [0, 0, 1], "
               "rate: 1}}",
       "6:11: boundary[1].group: node 0 of group 'xmin' is already held in x: it is in 'zmin', "
       "too; "
       "see boundary[0]"},
      {MINIMAL "boundary:\n- {group: zmin, translate: {velocity: [0, 0, 1]}}\n"
               "- {group: zmin, fix: [y]}",
       "5:11: boundary[0].group: node 0 of group 'zmin' is already held in y: it is in 'zmin', "
       "too; "
       "see boundary[1]"},
      {MINIMAL "boundary:\n- {group: zmin, translate: {velocity: [0, 0, 1]}}\n"
               "- {group: xmax, translate: {velocity: [0, 0, 1]}}",
       "6:11: boundary[1].group: node 1 of group 'xmax' is already held in x: it is in 'zmin', "
       "too; "
       "see boundary[0]"},
      {MINIMAL "groups: {a: {box: {min: [0, 0, 0], max: [1, 1, 2]}}}\n"
               "boundary: [{group: a, fix: [x, y]}, {group: a, fix: [z]}]",
       "5:1: boundary: all components of all 12 nodes are held: nothing can move"},
      {MINIMAL "probes: {a: {node: 12}}", "4:20: probes.a.node: the mesh has 12 nodes"},
  };
  refuse_builds(r, sizeof r / sizeof *r);
}

/* --- Memory that runs out --- */

static corot_status make_scenario(void *context) {
  (void)context;
  char *list[] = {(char[]){"integrator.rtol=1e-5"}, (char[]){"material={E: 1, nu: 0, density: 1}"}};
  scenario *s = NULL;
  COROT_TRY(scenario_read(FILE_NAME, 2, list, &s));
  scenario_destroy(s);
  return COROT_OK;
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
  write_file(FILE_NAME, everything, strlen(everything));
  assert_true(assert_survives_failed_allocations(make_scenario, NULL) >= 4);

  scenario *s = accept(MINIMAL
                       "groups: {base: {plane: {axis: z, at: 0}}, two: {nodes: [0, 1]}}\n"
                       "boundary: [{group: base, fix: [x, y, z]}]\n");
  assert_true(assert_survives_failed_allocations(build_scenario, s) >= 10);
  scenario_destroy(s);
}

/* --- The table itself --- */

/* Parents before children, no path twice, every required key has a meaning. */
static void schema_is_sound(void **state) {
  (void)state;
  for (int i = 0; i < scenario_schema.nkey; i++) {
    const schema_key *k = &scenario_schema.key[i];
    assert_true(schema_find(&scenario_schema, k->path) == k);
    assert_true(*k->doc);
    if (k->status != SCHEMA_OPTIONAL) assert_null(k->fallback);
    if (k->type == SCHEMA_CHOICE) assert_non_null(k->words);
  }
  int n = 0;
  for (const schema_key *k = NULL; (k = schema_child(&scenario_schema, "material.damping", k));)
    n++;
  assert_int_equal(n, 3);
}

static void schema_as_text(void **state) {
  (void)state;
  FILE *file = tmpfile();
  assert_non_null(file);
  assert_int_equal(schema_print(&scenario_schema, "", file), scenario_schema.nkey);
  assert_int_equal(schema_print(&scenario_schema, "material.damping", file), 4);
  assert_int_equal(schema_print(&scenario_schema, "loads.gravity", file), 1);
  assert_int_equal(schema_print(&scenario_schema, "loads[]", file), 15);
  assert_int_equal(schema_print(&scenario_schema, "mat", file), 0);
  fclose(file);
  json_t *text = schema_json();
  assert_non_null(text);
  json_t *material = json_object_get(json_object_get(text, "properties"), "material");
  assert_int_equal(json_array_size(json_object_get(material, "anyOf")), 2);
  json_decref(text);
}

static void suggestions(void **state) {
  (void)state;
  static const char *const word[] = {"run", "check", "schema", "mesh"};
  assert_string_equal(suggest("chekc", 4, word), "check");
  assert_string_equal(suggest("shema", 4, word), "schema");
  assert_string_equal(suggest("RUN", 4, word), "run");
  assert_null(suggest("x", 4, word));
  assert_null(suggest("wombat", 4, word));
  assert_int_equal(suggest_distance("", "abc"), 3);
  assert_int_equal(suggest_distance("ab", "ba"), 1);
}

/* Whether "a|b|c" has the word. */
static bool offers(const char *words, const char *word) {
  size_t n = strlen(word);
  for (const char *w = words; w; w = strchr(w, '|'), w = w ? w + 1 : NULL)
    if (strncmp(w, word, n) == 0 && (w[n] == '|' || w[n] == '\0')) return true;
  return false;
}

static int count_of(const char *words) {
  int n = 1;
  for (; *words; words++) n += *words == '|';
  return n;
}

/* A file may name each measure and method that the libraries have, and no other. */
static void choices_are_the_rows_of_the_tables(void **state) {
  (void)state;
  static const char *const measured[] = {"strain", "hierarchy.coarse_strain"};
  int n = 0;
  for (int k = 0; k < 2; k++) {
    const char *words = schema_find(&scenario_schema, measured[k])->words;
    for (n = 0; corot_strain_traits(n); n++)
      assert_true(offers(words, corot_strain_traits(n)->name));
    assert_int_equal(count_of(words), n);
  }
  const char *words = schema_find(&scenario_schema, "integrator.method")->words;
  for (n = 0; corot_method_at(n); n++) assert_true(offers(words, corot_method_at(n)->name));
  assert_int_equal(count_of(words), n);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(defaults),
      cmocka_unit_test(all_keys),
      cmocka_unit_test(all_keys_of_loads_and_run),
      cmocka_unit_test(all_keys_of_statics),
      cmocka_unit_test(all_keys_of_boundary),
      cmocka_unit_test(frame_policies),
      cmocka_unit_test(methods_of_constant_step),
      cmocka_unit_test(comparisons),
      cmocka_unit_test(material_forms),
      cmocka_unit_test(yaml_features),
      cmocka_unit_test(json_files),
      cmocka_unit_test(mesh_path),
      cmocka_unit_test(overrides),
      cmocka_unit_test(overrides_in_order),
      cmocka_unit_test(overrides_of_short_forms),
      cmocka_unit_test(mesh_in_short),
      cmocka_unit_test(bad_overrides),
      cmocka_unit_test(resolved_is_a_fixed_point),
      cmocka_unit_test(resolved_values),
      cmocka_unit_test(numbers_as_text),
      cmocka_unit_test(builds),
      cmocka_unit_test(the_viscous_law_follows_the_measure),
      cmocka_unit_test(steps_at_their_bounds),
      cmocka_unit_test(boxes_are_split_as_named),
      cmocka_unit_test(builds_motions_and_loads),
      cmocka_unit_test(builds_averages_of_the_dilatation),
      cmocka_unit_test(build_refusals),
      cmocka_unit_test(failed_allocations),
      cmocka_unit_test(schema_is_sound),
      cmocka_unit_test(schema_as_text),
      cmocka_unit_test(suggestions),
      cmocka_unit_test(choices_are_the_rows_of_the_tables),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
