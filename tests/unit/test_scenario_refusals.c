/* Scenario files that are refused, each with the place the message points at. */
#define TEST_NAME "refusals"
#include "scenario_text.h"

static void refuse_all(int n, const refusal *r) {
  for (int i = 0; i < n; i++) refuse(r[i].text, r[i].message);
}

static void unknown_keys(void **state) {
  (void)state;
  static const refusal r[] = {
      {MINIMAL "integrator: {rtoll: 1e-4}",
       "4:14: integrator.rtoll: unknown key; did you mean rtol?"
       "\n  integrator: {rtoll: 1e-4}\n               ^"},
      {MINIMAL "Strain: polar", "4:1: Strain: unknown key; did you mean strain?"},
      {MINIMAL "rtol: 1e-4", "4:1: rtol: unknown key here; did you mean integrator.rtol?"},
      {MINIMAL "wombat: 1", "4:1: wombat: unknown key; known here: title, mesh, groups, material"},
      {MINIMAL "loads:\n- {gravity: [0, 0, 1], amplitud: 1}",
       "5:24: loads[0].amplitud: unknown key; did you mean amplitude?"},
      {MINIMAL "probes: {a: {nod: 1}}", "4:14: probes.a.nod: unknown key; did you mean node?"},
      {MESH TIME "material: {mu: 1, nu: 0, density: 1, damping: {mv: 1}}",
       "3:48: material.damping.mv: unknown key; did you mean mu?"},
      {MINIMAL "title: a\ntitle: b", "5:1: title: given twice"},
      {MINIMAL "? [a, b]\n: 1", "4:3: a key must be a word"},
  };
  refuse_all(sizeof r / sizeof *r, r);
}

static void wrong_types(void **state) {
  (void)state;
  static const refusal r[] = {
      {MINIMAL "integrator: 3", "4:13: integrator: expected a map, found 3"},
      {MINIMAL "integrator: {rtol: abc}", "4:20: integrator.rtol: expected a number, found abc"},
      {MINIMAL "integrator: {rtol: \"1e-4\"}",
       "4:20: integrator.rtol: expected a number (without quotes), found the text \"1e-4\""},
      {MINIMAL "integrator: {rtol: [1]}", "4:20: integrator.rtol: expected a number, found a list"},
      {MINIMAL "time: 1", "4:1: time: given twice"},
      {MESH MATERIAL "time: {end: 0x10}", "3:13: time.end: expected a finite number in decimal"},
      {MESH MATERIAL "time: {end: 0o10}", "3:13: time.end: expected"},
      {MESH MATERIAL "time: {end: 010}", "3:13: time.end: expected"},
      {MESH MATERIAL "time: {end: 1_000}", "3:13: time.end: expected"},
      {MESH MATERIAL "time: {end: .inf}", "3:13: time.end: expected"},
      {MESH MATERIAL "time: {end: .nan}", "3:13: time.end: expected"},
      {MESH MATERIAL "time: {end: 1e999}", "3:13: time.end: expected a finite number"},
      {MESH MATERIAL "time: {end: 1e}", "3:13: time.end: expected"},
      {MESH MATERIAL "time: {end: .}", "3:13: time.end: expected"},
      {MESH MATERIAL "time: {end: !!float 1}", "3:21: tags (\"!\") mean nothing here"},
      {MINIMAL "output: {every: 1.5}", "4:17: output.every: expected a whole number, found 1.5"},
      {MINIMAL "output: {every: 3e9}", "4:17: output.every: must be at most 2147483647"},
      {MINIMAL "title: [a]", "4:8: title: expected text, found a list of 1"},
      {MINIMAL "loads: {gravity: [0, 0, 1]}", "4:8: loads: expected a list of maps"},
      {MINIMAL "loads: [1]", "4:9: loads[0]: expected a map, found 1"},
      {MINIMAL "loads: [{gravity: [0, 1]}]",
       "4:19: loads[0].gravity: expected three numbers, such as [0.0, 0.0, -9.81], found a list of "
       "2"},
      {MINIMAL "loads: [{gravity: [0, 1, z]}]",
       "4:26: loads[0].gravity[2]: expected a number, found z"},
      {MINIMAL "groups: [a]", "4:9: groups: expected a map of names"},
      {MINIMAL "groups: {a: {nodes: []}}",
       "4:21: groups.a.nodes: expected a list of whole numbers"},
      {MINIMAL "groups: {a: {nodes: [-1]}}", "4:22: groups.a.nodes[0]: must be >= 0, found -1"},
      {MINIMAL "boundary: [{group: a, fix: x}]",
       "4:28: boundary[0].fix: expected a list of words, such as [x, y, z], found x"},
      {MINIMAL "boundary: [{group: a, fix: [w]}]",
       "4:29: boundary[0].fix[0]: expected one of x, y, z; found w"},
      {MINIMAL "boundary: [{group: a, fix: [x, x]}]", "4:32: boundary[0].fix[1]: x is given twice"},
      {MINIMAL "strain: [polar]",
       "4:9: strain: expected cauchy, green, polar, warp, hybrid, found"},
      {MINIMAL "strain: polr", "4:9: strain: unknown: polr; did you mean polar?"},
      {MINIMAL "strain: neohooke",
       "4:9: strain: expected one of cauchy, green, polar, warp, hybrid"},
  };
  refuse_all(sizeof r / sizeof *r, r);
}

static void out_of_range(void **state) {
  (void)state;
  static const refusal r[] = {
      {MINIMAL "integrator: {rtol: 0}", "4:20: integrator.rtol: must be > 0, < 1, found 0"},
      {MINIMAL "integrator: {rtol: -1e-4}", "4:20: integrator.rtol: must be > 0"},
      {MINIMAL "integrator: {rtol: 1}", "4:20: integrator.rtol: must be > 0, < 1"},
      {MINIMAL "integrator: {atol: {velocity: 0}}", "4:31: integrator.atol.velocity: must be > 0"},
      {MINIMAL "integrator: {atol: {velocity: x}}",
       "4:31: integrator.atol.velocity: expected a number or auto, found x"},
      {MINIMAL "integrator: {max_order: 6}", "4:25: integrator.max_order: must be 1 to 5, found 6"},
      {MINIMAL "integrator: {max_steps: 0}", "4:25: integrator.max_steps: must be > 0"},
      {MINIMAL "integrator: {min_step: 2, max_step: 1}",
       "4:24: integrator.min_step: larger than max_step"},
      {MINIMAL "integrator: {method: bdf2, step: 0}", "4:34: integrator.step: must be > 0, found"},
      {MINIMAL "integrator: {method: newmark, step: -1}", "4:37: integrator.step: must be > 0"},
      {MINIMAL "integrator: {newton: {tolerance: 0}}",
       "4:34: integrator.newton.tolerance: must be > 0"},
      {MINIMAL "integrator: {spectral_radius: 1.5}",
       "4:31: integrator.spectral_radius: must be 0 to 1, found 1.5"},
      {MINIMAL "linear_solver: {tolerance: 1}",
       "4:28: linear_solver.tolerance: must be > 0, < 1, found 1"},
      {MINIMAL "frames: {policy: hold, interval: 0}",
       "4:34: frames.interval: must be > 0, found 0"},
      {MINIMAL "frames: {policy: hold, interval: -0.5}",
       "4:34: frames.interval: must be > 0, found -0.5"},
      {MINIMAL "frames: {policy: hold, max_angle: 0}", "4:35: frames.max_angle: must be > 0"},
      {MINIMAL "frames: {policy: extrapolate, max_angle: -1}",
       "4:42: frames.max_angle: must be > 0, found -1"},
      {MINIMAL "boundary: [{group: a, rotate: {axis: [0, 0, 0], rate: 1}}]",
       "4:38: boundary[0].rotate.axis: the axis has no direction: it is [0, 0, 0]"},
      {MINIMAL "boundary: [{group: a, rotate: {axis: [0, 0, 1], rate: 1, from: -1}}]",
       "4:64: boundary[0].rotate.from: must be >= 0"},
      {MINIMAL "boundary: [{group: a, rotate: {axis: [0, 0, 1], rate: 1, to: never}}]",
       "4:62: boundary[0].rotate.to: expected a number or end, found never"},
      {MINIMAL "boundary: [{group: a, translate: {velocity: [0, 0, 1], from: 2, to: 2}}]",
       "4:69: boundary[0].translate.to: it goes from t = 2 to t = 2 s: to must be later than from"},
      {MESH TIME "material: {mu: 1, nu: 0, density: 1, damping: {mass: -1}}",
       "3:54: material.damping.mass: must be >= 0"},
      {MINIMAL "integrator: {first_step: 2, max_step: 1}",
       "4:26: integrator.first_step: larger than max_step"},
      {MESH MATERIAL "time: {end: 0}", "3:13: time.end: must be > 0, found 0"},
      {MESH MATERIAL "time: {end: 1, output: -1}", "3:24: time.output: must be > 0"},
      {MESH TIME "material: {lambda: 1, mu: 1, density: -5}",
       "3:39: material.density: must be > 0, found -5"},
      {MESH TIME "material: {E: 1, nu: 0.5, density: 1}",
       "3:22: material.nu: must be > -1, < 0.5, found 0.5"},
      {MESH TIME "material: {E: 1, nu: -1, density: 1}", "3:22: material.nu: must be > -1"},
      {MESH TIME "material: {lambda: -1, mu: 1, density: 1}",
       "3:20: material.lambda: 3 lambda + 2 mu must be > 0"},
      {MESH TIME "material: {lambda: 1, mu: 0, density: 1}", "3:27: material.mu: must be > 0"},
      {MESH TIME "material: {mu: 1, nu: 0, density: 1, damping: {mu: -1}}",
       "3:52: material.damping.mu: must be >= 0"},
      {"mesh: {box: {size: [1, 0, 1], cells: [1, 1, 1]}}\n" MATERIAL TIME,
       "1:24: mesh.box.size[1]: must be > 0"},
      {"mesh: {box: {size: [1, 1, 1], cells: [1, 0, 1]}}\n" MATERIAL TIME,
       "1:42: mesh.box.cells[1]: must be > 0"},
      {"mesh: {file: a.msh, refine: -1}\n" MATERIAL TIME,
       "1:29: mesh.refine: must be >= 0, found -1"},
      {"mesh: {file: a.msh, refine: 0.5}\n" MATERIAL TIME, "1:29: mesh.refine: expected a whole"},
      {MINIMAL "loads: [{gravity: [0, 0, 1], amplitude: [[1, 0], [0, 1]]}]",
       "4:51: loads[0].amplitude[1][0]: the amplitude's times do not increase at point 1: 0 "
       "follows 1"},
      {MINIMAL "loads: [{gravity: [0, 0, 1], amplitude: [[0, 0, 1]]}]",
       "4:42: loads[0].amplitude[0]: expected a pair [time, value]"},
      {MINIMAL "loads: [{gravity: [0, 0, 1], amplitude: []}]",
       "4:41: loads[0].amplitude: expected"},
      {MINIMAL "groups: {a: {box: {min: [0, 0, 1], max: [1, 1, 0]}}}",
       "4:19: groups.a.box: min is larger than max"},
      {MINIMAL "probes: {a b: {node: 1}}", "4:10: probes.a b: the name of a probe is made of"},
      {MINIMAL "probes: {\"a,b\": {node: 1}}", "probes.a,b: the name of a probe"},
  };
  for (size_t i = 0; i + 1 < sizeof r / sizeof *r; i++) refuse(r[i].text, r[i].message);
  scenario *s = NULL;
  const refusal *last = &r[sizeof r / sizeof *r - 1];
  assert_fails(read_as(FILE_NAME, last->text, &s), COROT_EFORMAT, last->message);
}

static void keys_together(void **state) {
  (void)state;
  static const refusal r[] = {
      {MATERIAL TIME, "1:1: mesh is missing"},
      {MESH TIME, "1:1: material is missing"},
      {MESH MATERIAL, "1:1: time is missing"},
      {MESH MATERIAL "time: {output: 1}", "3:1: time: end is missing"},
      {"mesh: {refine: 0}\n" MATERIAL TIME, "1:1: mesh: file or box is missing"},
      {"mesh: {file: a.msh, box: {size: [1, 1, 1], cells: [1, 1, 1]}}\n" MATERIAL TIME,
       "1:21: mesh.box: file and box exclude each other"},
      {"mesh: {file: \"\"}\n" MATERIAL TIME, "1:14: mesh.file: the name is empty"},
      {"mesh: \"\"\n" MATERIAL TIME, "1:7: mesh.file: the name is empty"},
      {"mesh: {file: a.msh, unit: mm, scale: 2}\n" MATERIAL TIME,
       "1:31: mesh.scale: mesh.unit and mesh.scale exclude each other"},
      {"mesh: {file: a.msh, unit: inch}\n" MATERIAL TIME,
       "1:27: mesh.unit: expected one of m, km, cm, mm, um, nm, in, ft; found inch"},
      {"mesh: {file: a.msh, scale: 0}\n" MATERIAL TIME, "1:28: mesh.scale: must be > 0"},
      {"mesh: {box: {size: [1, 1, 1], cells: [1, 1, 1]}, unit: mm}\n" MATERIAL TIME,
       "1:50: mesh.unit: a mesh.file has a unit; a box is in metres"},
      {MESH TIME "material: {lambda: 1, mu: 1}", "3:1: material: density is missing"},
      {MESH TIME "material: {lambda: 1, nu: 0, density: 1}",
       "3:1: material: give lambda and mu, or"},
      {MESH TIME "material: {lambda: 1, mu: 1, nu: 0, density: 1}", "3:1: material: give lambda"},
      {MESH TIME "material: {E: 1, density: 1}", "3:1: material: give lambda and mu, or"},
      {MESH TIME "material: []", "3:11: material: expected a map or a list of maps"},
      {MESH TIME "material:\n- {mu: 1, nu: 0, density: 1}\n- {mu: 1, nu: 0, density: 1}",
       "5:3: material[1]: group is missing"},
      {MESH TIME
       "material:\n- {group: a, mu: 1, nu: 0, density: 1}\n- {group: a, mu: 1, nu: 0, density: 1}",
       "5:11: material[1].group: group 'a' has a material already; see material[0]"},
      {MINIMAL "frames: {policy: hold}",
       "4:18: frames.policy: hold needs frames.interval or frames.max_angle"},
      {MINIMAL "frames: {policy: extrapolate}",
       "4:18: frames.policy: extrapolate needs frames.interval or frames.max_angle"},
      {MINIMAL "frames: {policy: step, interval: 1}",
       "4:24: frames.interval: has no effect with policy: step"},
      {MINIMAL "frames: {policy: step, max_angle: 1}",
       "4:24: frames.max_angle: has no effect with policy: step"},
      {MINIMAL "frames: {interval: 1}",
       "4:10: frames.interval: has an effect with policy: hold or extrapolate only"},
      {MINIMAL "frames: {max_angle: 0.1}",
       "4:10: frames.max_angle: has an effect with policy: hold or extrapolate only"},
      {MINIMAL "viscosity: objective\nstrain: green",
       "4:12: viscosity: the objective viscous law needs a polar frame, not strain green"},
      {MINIMAL "dilatation: nodel", "4:13: dilatation.name: unknown: nodel; did you mean nodal?"},
      {MINIMAL "dilatation: {name: nodal, local: -1}",
       "4:34: dilatation.local: must be >= 0, found -1"},
      {MINIMAL "integrator: {method: newmark}",
       "4:22: integrator.method: newmark needs integrator.step"},
      {MINIMAL "integrator: {step: 0.1}", "4:14: integrator.step: cvode chooses its own steps"},
      {MINIMAL "integrator: {method: hht, step: 0.1, spectral_radius: 0.4}",
       "4:55: integrator.spectral_radius: must be 0.5 to 1 for hht, found 0.4"},
      {MINIMAL "linear_solver: klo", "4:16: linear_solver.name: unknown: klo; did you mean klu?"},
      {MINIMAL "linear_solver: [klu]", "4:16: linear_solver: expected a map, found a list of 1"},
      {MINIMAL "compare: [green]",
       "4:11: compare[0]: expected one of cauchy, warp, polar, hybrid; found green"},
      {MINIMAL "compare: [warp, warp]", "4:17: compare[1]: warp is given twice"},
      {MINIMAL "compare: warp", "4:10: compare: expected a list of words, such as [cauchy, warp,"},
      {MINIMAL "boundary: [{group: a, rotate: {rate: 1}}]",
       "4:23: boundary[0].rotate: axis is missing"},
      {MINIMAL "boundary: [{group: a, rotate: {axis: [0, 0, 1]}}]",
       "4:23: boundary[0].rotate: rate is missing"},
      {MINIMAL "boundary: [{group: a, translate: {}}]",
       "4:23: boundary[0].translate: velocity is missing"},
      {MINIMAL "boundary: [{group: a, fix: [x], translate: {velocity: [0, 0, 1]}}]",
       "4:33: boundary[0].translate: fix and translate exclude each other"},
      {MINIMAL "boundary: [{fix: [x]}]", "4:12: boundary[0]: group is missing"},
      {MINIMAL "boundary: [{group: a}]",
       "4:12: boundary[0]: fix or rotate or translate or move is missing"},
      {MINIMAL "loads: [{group: a}]",
       "4:9: loads[0]: traction or gravity or pressure or force is missing"},
      {MINIMAL "loads: [{traction: [0, 0, 1]}]", "4:9: loads[0]: group is missing"},
      {MINIMAL "loads: [{pressure: 1}]",
       "4:9: loads[0]: group is missing, on which the pressure acts"},
      {MINIMAL "loads: [{force: [0, 0, 1]}]",
       "4:9: loads[0]: group is missing, on which the force acts"},
      {MINIMAL "loads: [{group: a, gravity: [0, 0, 1]}]", "4:10: loads[0].group: gravity acts on"},
      {MINIMAL "loads: [{traction: [0, 0, 1], gravity: [0, 0, 1]}]",
       "4:31: loads[0].gravity: traction and gravity exclude each other"},
      {MINIMAL "groups: {a: {}}",
       "4:10: groups.a: plane or box or sphere or cylinder or half_space or normal or near or "
       "union or "
       "intersection or difference or nodes is missing"},
      {MINIMAL "groups: {a: {plane: {axis: x}}}", "4:14: groups.a.plane: at is missing"},
      {MINIMAL "probes: {a: {node: 1, point: [0, 0, 0]}}",
       "4:14: probes.a.node: point and node exclude each other"},
  };
  refuse_all(sizeof r / sizeof *r, r);
}

/* Motions of one group follow one another. */
static void motions_together(void **state) {
  (void)state;
#define FIRST \
  MINIMAL "boundary:\n- {group: a, rotate: {axis: [0, 0, 1], rate: 1, from: 1, to: 2}}\n"
  static const refusal r[] = {
      {FIRST "- {group: a, rotate: {axis: [0, 0, 1], rate: 1, from: 1.5}}",
       "6:22: boundary[1].rotate: group 'a' is already moving from t = 1 to t = 2 s; see "
       "boundary[0]"},
      {FIRST "- {group: a, rotate: {axis: [0, 0, 1], rate: 1, to: 1.5}}",
       "6:22: boundary[1].rotate: group 'a' is already moving from t = 1 to t = 2 s; see "
       "boundary[0]"},
      {FIRST "- {group: a, rotate: {axis: [0, 1, 0], rate: 1, from: 2}}",
       "6:22: boundary[1].rotate: does not continue the other motion of a: it has to turn about"},
      {FIRST "- {group: a, rotate: {axis: [0, 0, 1], center: [1, 0, 0], rate: 1, from: 2}}",
       "6:22: boundary[1].rotate: does not continue the other motion of a"},
      {FIRST "- {group: a, translate: {velocity: [0, 1, 0], from: 2}}",
       "6:25: boundary[1].translate: does not continue the other motion of a: it has to turn"},
  };
#undef FIRST
  refuse_all(sizeof r / sizeof *r, r);
}

/* Rules of the core, of entries by their place in the file whatever their place in the model. */
static void rules_of_the_model(void **state) {
  (void)state;
  static const refusal r[] = {
      {MESH TIME
       "material:\n- {group: a, mu: 1, nu: 0, density: 1}\n- {lambda: -1, mu: 1, density: 1}",
       "5:12: material[1].lambda: 3 lambda + 2 mu must be > 0"},
      {MESH TIME "material: {mu: 1.0e-320, nu: -0.9, density: 1.0e-320}\nviscosity: objective\n"
                 "strain: warp",
       "4:12: viscosity: the objective viscous law needs a polar frame, not strain warp"},
      {MINIMAL "boundary:\n- {group: zmax, fix: [x]}\n"
               "- {group: zmin, translate: {velocity: [0, 0, 1], from: 2, to: 1}}",
       "6:63: boundary[1].translate.to: it goes from t = 2 to t = 1 s"},
      {MINIMAL "boundary:\n- {group: zmax, fix: [x]}\n"
               "- {group: a, move: {direction: [1, 0, 0], amplitude: {smooth: [[0, 0], [0, 1]]}}}",
       "6:73: boundary[1].move.amplitude.smooth[1][0]: the amplitude has two points at t = 0"},
  };
  refuse_all(sizeof r / sizeof *r, r);
}

static void methods_and_their_orders(void **state) {
  (void)state;
  static const refusal r[] = {
      {MINIMAL "integrator: {method: cvode, max_order: 6}",
       "4:40: integrator.max_order: must be 1 to 5, found 6"},
      {MINIMAL "integrator: {method: arkode, max_order: 4}",
       "4:30: integrator.max_order: arkode has one order: see integrator.order"},
      {MINIMAL "integrator: {method: arkode, order: 6}",
       "4:37: integrator.order: must be 2 to 5 for arkode, found 6"},
      {MINIMAL "integrator: {method: erk, order: 9}",
       "4:34: integrator.order: must be 2 to 8, found 9"},
      {MINIMAL "integrator: {method: erk, order: 4, table: ARKODE_ZONNEVELD_5_3_4}",
       "4:37: integrator.table: has an order of its own: give order or table"},
      {MINIMAL "integrator: {order: 4}",
       "4:14: integrator.order: cvode has none: see integrator.max_order"},
      {MINIMAL "integrator: {table: ARKODE_ZONNEVELD_5_3_4}",
       "4:14: integrator.table: cvode has none"},
      {MINIMAL "integrator: {method: erk, predictor: 1}",
       "4:27: integrator.predictor: erk has none"},
      {MINIMAL "integrator: {method: ida, jacobian: {gamma_change: 1.5}}",
       "4:52: integrator.jacobian.gamma_change: must be < 1 for ida, found 1.5"},
      {MINIMAL "integrator: {method: ida, step: 0.1}",
       "4:27: integrator.step: ida chooses its own steps; see first_step, max_step"},
  };
  for (size_t i = 0; i < sizeof r / sizeof *r; i++) {
    scenario *s = NULL;
    assert_fails(read_as(FILE_NAME, r[i].text, &s), COROT_EFORMAT, r[i].message);
  }
}

static void malformed(void **state) {
  (void)state;
  static const refusal r[] = {
      {"", " the file is empty"},
      {"# nothing\n", " the file is empty"},
      {"- 1\n", "1:1: expected a map of keys and values"},
      {"hello\n", "1:1: expected a map"},
      {"~\n", "1:1: expected a map"},
      {"a: 1\n---\nb: 2\n", "1:4: a second document begins after this"},
      {"a: [1, 2\n", "2:1: flow sequence without a closing bracket"},
      {"a: 1\n\tb: 2\n", "1:4: invalid multiline plain key"},
      {"a: \xff\n", " byte 3 (0xFF) is not text in UTF-8"},
      {"a: \xed\xa0\x80\n", " byte 3 (0xED) is not text"},
      {"a: \xc0\xaf\n", " byte 3 (0xC0) is not text"},
      {"a: \xe2\x82", " byte 3 (0xE2) is not text"},
      {"a: \x01\n", " byte 3 (0x01) is not text"},
      {"a: *b\n", "1:5: no anchor &b stands before this"},
      {"a: &b [*b]\n", "no anchor &b stands before this"},
      {"*b : 1\n", "a key must be a word"},
  };
  for (size_t i = 0; i < sizeof r / sizeof *r; i++) {
    scenario *s = NULL;
    assert_fails(read_as(FILE_NAME, r[i].text, &s), COROT_EFORMAT, r[i].message);
  }
  scenario *s = NULL;
  write_file(FILE_NAME, "a: 1\0b", 6);
  assert_fails(scenario_read(FILE_NAME, 0, NULL, &s), COROT_EFORMAT, "byte 4 (0x00)");
  assert_fails(scenario_read("/nowhere/a.yaml", 0, NULL, &s), COROT_EIO,
               "/nowhere/a.yaml: No such");
  assert_fails(scenario_read("/", 0, NULL, &s), COROT_EIO, "/: ");
}

/* Nothing grows beyond its bounds, whatever the file says. */
static void hostile(void **state) {
  (void)state;
  scenario *s = NULL;
  size_t size = (16 << 20) + 1;
  char *text = malloc(size);
  assert_non_null(text);
  memset(text, '#', size);
  write_file(FILE_NAME, text, size);
  assert_fails(scenario_read(FILE_NAME, 0, NULL, &s), COROT_EFORMAT, "larger than 16 MiB");

  memset(text, '[', 10000);
  write_file(FILE_NAME, text, 10000);
  assert_fails(scenario_read(FILE_NAME, 0, NULL, &s), COROT_EFORMAT,
               "nested deeper than 32 levels");

  size_t used = (size_t)sprintf(text, "a: &a [1,1,1,1,1,1,1,1,1,1]\n");
  for (char c = 'b'; c < 'k'; c++)
    used +=
        (size_t)sprintf(text + used, "%c: &%c [*%c,*%c,*%c,*%c,*%c,*%c,*%c,*%c,*%c,*%c]\n", c, c,
                        c - 1, c - 1, c - 1, c - 1, c - 1, c - 1, c - 1, c - 1, c - 1, c - 1);
  write_file(FILE_NAME, text, used);
  assert_fails(scenario_read(FILE_NAME, 0, NULL, &s), COROT_EFORMAT, "more than 1000000 values");

  used = 0;
  for (int i = 0; i < 10001; i++) used += (size_t)sprintf(text + used, "k%d: 1\n", i);
  write_file(FILE_NAME, text, used);
  assert_fails(scenario_read(FILE_NAME, 0, NULL, &s), COROT_EFORMAT, "more than 10000 keys");
  free(text);
}

/* A long line is cut to a window, tabs become blanks, and the caret stays under the place. */
static void excerpts(void **state) {
  (void)state;
  char text[600] = MINIMAL "title: {a: '";
  size_t n = strlen(text);
  memset(text + n, 'x', 400);
  strcpy(text + n + 400, "', \xC3\xA9: 1}\n");
  refuse(text, "4:8: title: expected text, found a map\n  title: {a: 'xxx");
  assert_true(strlen(corot_error()) < strlen(FILE_NAME) + 200);

  refuse(MINIMAL "output: {\"\xC3\xA9\": 1, fields:\tpng}",
         "4:10: output.\xC3\xA9: unknown key; known here: fields, every");
  refuse(MINIMAL "title: \"\xC3\xA9\" \noutput: {fields:\tpng}",
         "5:18: output.fields: expected one of vtu, none; found png\n"
         "  output: {fields: png}\n"
         "                   ^");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(unknown_keys),
      cmocka_unit_test(wrong_types),
      cmocka_unit_test(out_of_range),
      cmocka_unit_test(keys_together),
      cmocka_unit_test(motions_together),
      cmocka_unit_test(rules_of_the_model),
      cmocka_unit_test(methods_and_their_orders),
      cmocka_unit_test(malformed),
      cmocka_unit_test(hostile),
      cmocka_unit_test(excerpts),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
