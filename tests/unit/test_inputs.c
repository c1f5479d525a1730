/* What drives a run, as a scenario says it: amplitudes of every kind, supports that they move,
   velocities to start with. */
#define TEST_NAME "inputs"
#include "scenario_text.h"

#include "alloc.h"
#include "app/folder/hash.h"
#include "app/text/json_text.h"
#include "solid.h"
#include "whole_run.h"

static const char *const methods[] = {"cvode", "ida", "arkode", "erk"};
enum { NMETHOD = 4 };

static const double pi = 3.14159265358979323846;

#define TABLE BINARY_DIR "/inputs.csv"

static scenario *accept_with(const char *text, int n, char *const *set) {
  scenario *s = NULL;
  assert_ok(scenario_read_text(FILE_NAME, text, strlen(text), n, set, &s));
  return s;
}

/* --- Forms ----------------------------------------------------------------------------------- */

static const char forms[] = MINIMAL
    "loads:\n"
    "  - {gravity: [1, 0, 0], amplitude: {sine: {frequency: 2, phase: 0.5, offset: -3}}}\n"
    "  - {gravity: [1, 0, 0], amplitude: {sine: {frequency: 4}}}\n"
    "  - {gravity: [1, 0, 0], amplitude: {smooth: [[0, 0], [1, 2], [3, 1]]}}\n"
    "  - {gravity: [1, 0, 0], amplitude: {file: inputs.csv}}\n"
    "  - {gravity: [1, 0, 0], amplitude: {smooth: {file: inputs.csv}}}\n"
    "  - {gravity: [1, 0, 0], amplitude: [[0, 0], [1, 1], [1, 0], [2, 1]]}\n"
    "boundary:\n"
    "  - {group: zmin, move: {direction: [1, 2, 3], amplitude: {smooth: [[0, 0], [1, 1]]}}}\n"
    "  - {group: zmin, translate: {velocity: [0, 0, 1]}}\n"
    "  - {group: zmax, move: {rotate: {axis: [0, 0, 2], center: [1, 2, 3], angle: 0.5},\n"
    "                         amplitude: [[0, 0], [1, 1]]}}\n"
    "start: [{from: rest, velocity: [1, 2, 3]},\n"
    "        {group: xmax, spin: {axis: [0, 3, 4], center: [5, 6, 7], rate: -2}}]\n";

/* Written as a spreadsheet would. */
static void put_table(void) {
  const char *text =
      "\xEF\xBB\xBF# measured\r\ntime [s], factor\r\n0,0\r\n\r\n0.5;1 # here\r\n 1.5 -1";
  write_file(TABLE, text, strlen(text));
}

static void check_points(const corot_amplitude *a, corot_curve curve, int n, const double (*p)[2]) {
  assert_int_equal(a->curve, curve);
  assert_int_equal(a->n, n);
  for (int i = 0; i < n; i++) assert_true(a->time[i] == p[i][0] && a->value[i] == p[i][1]);
}

static void check_forms(const scenario *s) {
  static const double list[][2] = {{0, 0}, {1, 2}, {3, 1}},
                      table[][2] = {{0, 0}, {0.5, 1}, {1.5, -1}};
  static const double jump[][2] = {{0, 0}, {1, 1}, {1, 0}, {2, 1}};
  const corot_amplitude *a = &s->load[0].amplitude;
  assert_int_equal(a->curve, COROT_CURVE_SINE);
  assert_true(a->frequency == 2 && a->phase == 0.5 && a->offset == -3);
  a = &s->load[1].amplitude;
  assert_true(a->frequency == 4 && a->phase == 0 && a->offset == 0);
  check_points(&s->load[2].amplitude, COROT_CURVE_SMOOTH, 3, list);
  check_points(&s->load[3].amplitude, COROT_CURVE_LINEAR, 3, table);
  check_points(&s->load[4].amplitude, COROT_CURVE_SMOOTH, 3, table);
  check_points(&s->load[5].amplitude, COROT_CURVE_LINEAR, 4, jump);
  const corot_motion *m = s->motion;
  assert_int_equal(s->nmotion, 3);
  assert_true(m[0].kind == COROT_MOVE && m[0].direction[1] == 2);
  assert_int_equal(m[0].amplitude.curve, COROT_CURVE_SMOOTH);
  assert_true(m[2].kind == COROT_TURN && m[2].axis[2] == 2 && m[2].center[0] == 1);
  assert_true(m[2].angle == 0.5 && m[2].amplitude.n == 2);
  assert_int_equal(s->nstart, 2);
  assert_false(s->start_at_equilibrium);
  assert_true(!s->start[0].group && s->start[0].velocity[1] == 2 && s->start[0].rate == 0);
  assert_string_equal(s->start[1].group, "xmax");
  assert_true(s->start[1].rate == -2 && s->start[1].center[2] == 7);
  assert_close(s->start[1].axis[2], 0.8, 1e-15, 0); /* of length one */
}

static char *resolved_text(const scenario *s) {
  char *text = NULL;
  size_t size = 0;
  FILE *stream = open_memstream(&text, &size);
  json_text_write(s->resolved, stream);
  fclose(stream);
  return text;
}

/* As YAML, and again from what the resolved scenario says, as YAML and as JSON. */
static void every_form_is_read_and_resolves_to_itself(void **state) {
  (void)state;
  put_table();
  scenario *s = accept(forms);
  check_forms(s);
  corot_mesh *mesh;
  corot_model *model;
  assert_ok(scenario_build(s, &mesh, NULL, &model));
  corot_model_destroy(model), corot_mesh_destroy(mesh);
  char *text = resolved_text(s);
  assert_non_null(strstr(text, "\"sha256\": \""));
  static const char *const name[] = {FILE_NAME, JSON_NAME};
  for (int i = 0; i < 2; i++) {
    scenario *again = NULL;
    assert_ok(read_as(name[i], text, &again));
    check_forms(again);
    assert_true(json_equal(s->resolved, again->resolved));
    scenario_destroy(again);
  }
  free(text);
  scenario_destroy(s);
}

/* A word stays a word, however it was written, so that the identity of a run does not change. */
static void a_word_to_start_with_resolves_to_a_word(void **state) {
  (void)state;
  static const struct {
    const char *text, *set, *word;
  } form[] = {{"", NULL, "rest"},
              {"start: equilibrium", NULL, "equilibrium"},
              {"start: {from: equilibrium}", NULL, "equilibrium"},
              {"start: equilibrium", "strain=green", "equilibrium"},
              {"start: equilibrium", "start.from=rest", "rest"}};
  for (size_t k = 0; k < sizeof form / sizeof *form; k++) {
    char text[512];
    snprintf(text, sizeof text, "%s%s", MINIMAL, form[k].text);
    scenario *s = accept_with(text, form[k].set != NULL, (char *const[]){(char *)form[k].set});
    const char *word = json_string_value(json_object_get(s->resolved, "start"));
    assert_non_null(word);
    assert_string_equal(word, form[k].word);
    assert_true(s->start_at_equilibrium == (strcmp(word, "rest") != 0));
    scenario_destroy(s);
  }
}

static void every_key_can_be_overridden(void **state) {
  (void)state;
  put_table();
  const char *const set[] = {"loads.0.amplitude.sine.frequency=7",
                             "loads.3.amplitude.smooth={file: inputs.csv}",
                             "loads.3.amplitude.file=null",
                             "loads.5.amplitude={sine: {frequency: 1}}",
                             "boundary.0.move.direction=[0, 0, 9]",
                             "boundary.2.move.rotate.angle=0.25",
                             "start.1.spin.rate=11"};
  scenario *s = accept_with(forms, 7, (char *const *)set);
  assert_true(s->load[0].amplitude.frequency == 7 && s->load[0].amplitude.phase == 0.5);
  assert_int_equal(s->load[3].amplitude.curve, COROT_CURVE_SMOOTH);
  assert_int_equal(s->load[5].amplitude.curve, COROT_CURVE_SINE);
  assert_true(s->motion[0].direction[2] == 9 && s->motion[2].angle == 0.25);
  assert_true(s->start[1].rate == 11);
  scenario_destroy(s);

  const char *const none[] = {"start.velocity=[0, 0, 2]", "start.spin={axis: [0, 0, 1], rate: 3}"};
  static const char *const text[] = {MINIMAL, MINIMAL "start: equilibrium"};
  for (int k = 0; k < 2; k++) {
    s = accept_with(text[k], 2, (char *const *)none);
    assert_int_equal(s->nstart, 1);
    assert_true(s->start[0].velocity[2] == 2 && s->start[0].rate == 3);
    assert_true(s->start_at_equilibrium == (k == 1));
    scenario_destroy(s);
  }
}

/* What is in the file is in the run's identity, where it is in the file is not. */
static void a_table_is_part_of_what_is_run(void **state) {
  (void)state;
  static const char text[] = MINIMAL "loads: [{gravity: [1, 0, 0], amplitude: {file: inputs.csv}}]";
  const char *content[] = {"0 0\n1 1\n", "0 0\n1 2\n"};
  const char mesh[HASH_SIZE] = "the same";
  hashes sum[2];
  char *first = NULL;
  for (int k = 0; k < 2; k++) {
    write_file(TABLE, content[k], strlen(content[k]));
    scenario *s = accept(text);
    assert_ok(hashes_with(s->resolved, mesh, &sum[k]));
    if (k == 0) first = resolved_text(s);
    scenario_destroy(s);
  }
  assert_string_not_equal(sum[0].run, sum[1].run);
  scenario *s = NULL; /* the table is no more what the resolved scenario was made with */
  assert_fails(read_as(FILE_NAME, first, &s), COROT_EFORMAT, "loads[0].amplitude.sha256: ");
  assert_non_null(strstr(corot_error(), "inputs.csv has another sum, "));
  free(first);
}

/* --- Refusals -------------------------------------------------------------------------------- */

static void tables_are_refused_with_their_place(void **state) {
  (void)state;
  static const struct {
    const char *table, *message;
  } bad[] = {
      {"", TABLE ":1:1: no points of time and value"},
      {"t v\n# nothing\n", TABLE ":1:1: no points of time and value"},
      {"0 0\n1 x\n",
       TABLE ":2:3: expected a value, a finite number in decimal, found x\n  1 x\n    ^"},
      {"t v\nt v\n", TABLE ":2:1: expected a time, a finite number in decimal, found t"},
      {"0 0\n1\n", TABLE ":2:2: expected a value, found the end of the line"},
      {"0 0\n1 2 3\n", TABLE ":2:5: expected two columns, time and value; here is more"},
      {"0 0\n1, 2, 3\n", TABLE ":2:5: expected two columns"},
      {"0 0\n1,,2\n", TABLE ":2:3: expected a value"},
      {"0 0\n2 1\n1 2\n", TABLE ":3:1: times must increase, but 1 follows 2"},
      {"0 0\n 1 1\n 1 2\n 1 3\n", TABLE ":4:2: the third point at 1: a jump has a value before"},
      {"0 nan\n", TABLE ":1:3: expected a value"},
      {"0 1e999\n", TABLE ":1:3: expected a value"},
      {"0 0\ninf 1\n", TABLE ":2:1: expected a time"},
      {"0,5 1,2\n", TABLE ":1:5: expected two columns"}, /* decimal commas */
  };
  static const char text[] = MINIMAL "loads: [{gravity: [1, 0, 0], amplitude: {file: inputs.csv}}]";
  for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
    scenario *s = NULL;
    write_file(TABLE, bad[k].table, strlen(bad[k].table));
    assert_fails(read_as(FILE_NAME, text, &s), COROT_EFORMAT, bad[k].message);
  }
  static const char smooth[] =
      MINIMAL "loads: [{gravity: [1, 0, 0], amplitude: {smooth: {file: inputs.csv}}}]";
  write_file(TABLE, "0 0\n1 1\n1 2\n", 12);
  scenario *s = NULL;
  assert_fails(read_as(FILE_NAME, smooth, &s), COROT_EFORMAT,
               TABLE ":3:1: the second point at 1: there are no jumps here");
  assert_int_equal(remove(TABLE), 0);
  refuse(text, "4:48: loads[0].amplitude.file: " TABLE ": No such file or directory");
  refuse(MINIMAL "loads: [{gravity: [1, 0, 0], amplitude: {file: .}}]",
         "4:48: loads[0].amplitude.file: " BINARY_DIR "/.: not a file");
}

#define MOVE MINIMAL "boundary: [{group: zmin, move: {direction: [1, 0, 0], amplitude: "
#define LOAD MINIMAL "loads: [{gravity: [0, 0, 1], amplitude: "

static void what_makes_no_sense_is_refused_where_it_stands(void **state) {
  (void)state;
  static const refusal r[] = {
      {LOAD "[[0, 0], [1, 1], [1, 2], [1, 3]]}]",
       "4:67: loads[0].amplitude[3][0]: the third point at 1: a jump has a value before"},
      {LOAD "{}}]", "4:30: loads[0].amplitude: sine or smooth or file is missing"},
      {LOAD "table.csv}]", "4:41: loads[0].amplitude: expected a list of [time, value], such as"},
      {LOAD "{sine: {}}}]", "4:42: loads[0].amplitude.sine: frequency is missing (periods per"},
      {LOAD "{sine: {frequency: -1}}}]", "4:60: loads[0].amplitude.sine.frequency: must be > 0"},
      {LOAD "{sine: {frequency: 1}, file: a}}]",
       "4:64: loads[0].amplitude.file: sine and file exclude each other"},
      {LOAD "{sine: {frequency: 1}, sha256: a}}]",
       "4:64: loads[0].amplitude.sha256: is for a file"},
      {LOAD "{spline: [[0, 1]]}}]",
       "4:42: loads[0].amplitude.spline: unknown key; did you mean smooth?"},
      {LOAD "{table: a}}]", "4:42: loads[0].amplitude.table: unknown key; did you mean file?"},
      {LOAD "{file: ''}}]", "4:48: loads[0].amplitude.file: the name is empty"},
      {LOAD "{smooth: [[0, 0], [1, 1], [1, 2]]}}]",
       "4:68: loads[0].amplitude.smooth[2][0]: the second point at 1: a smooth amplitude has no"},
      {LOAD "{smooth: [[0, 0], [100, 0], [100.01, 1], [100.02, 0]]}}]",
       "4:50: loads[0].amplitude.smooth: the spline through the amplitude's points swings out to"},
      {MOVE "[[0, 0], [1, 1], [1, 2]]}}]",
       "4:84: boundary[0].move.amplitude[2][0]: the second point at 1: a support cannot be in two"},
      {MOVE "[[0, 0.5], [1, 1]]}}]",
       "4:66: boundary[0].move.amplitude: is 0.5 at t = 0, and the support away from where"},
      {MOVE "{sine: {frequency: 1, phase: -1.5707963267948966}}}}]",
       "4:66: boundary[0].move.amplitude: is -1 at t = 0, and the support away from where it holds "
       "a body at rest: begin at 0 (a sine with this phase does with offset: 1), or with start: "},
      {MINIMAL "boundary: [{group: a, move: {direction: [1, 0, 0]}}]",
       "4:23: boundary[0].move: amplitude is missing"},
      {MINIMAL "boundary: [{group: a, move: {amplitude: [[0, 0]]}}]",
       "4:23: boundary[0].move: direction or rotate is missing"},
      {MINIMAL "boundary: [{group: a, move: {rotate: {axis: [0, 0, 0], angle: 1}, amplitude: "
               "[[0, 0]]}}]",
       "4:45: boundary[0].move.rotate.axis: [0, 0, 0] has no direction"},
      {MINIMAL "boundary:\n- {group: a, move: {direction: [1, 0, 0], amplitude: [[0, 0]]}}\n"
               "- {group: a, rotate: {axis: [0, 0, 1], rate: 1}}",
       "6:22: boundary[1].rotate: does not continue the other motion of a: it has to translate"},
      {MINIMAL "boundary: [{group: a, translate: {displacement: [1, 0, 0]}}]",
       "4:35: boundary[0].translate.displacement: unknown key; did you mean "
       "boundary[].move.direction?"},
      {MINIMAL "initial: {velocity: [1, 0, 0]}", "4:1: initial: unknown key; did you mean start?"},
      {MINIMAL "velocity: [1, 0, 0]", "4:1: velocity: unknown key; did you mean start.velocity?"},
      {MINIMAL "start: moving", "4:8: start: expected one of rest, equilibrium; found moving"},
      {MINIMAL "start: {}", "4:8: start: velocity or spin is missing"},
      {MINIMAL "start: {velocty: [1, 0, 0]}",
       "4:9: start.velocty: unknown key; did you mean veloc"},
      {MINIMAL "start: {spin: [0, 0, 1]}", "4:15: start.spin: expected a map"},
      {MINIMAL "start: {spin: {axis: [0, 0, 0], rate: 1}}",
       "4:22: start.spin.axis: [0, 0, 0] has no"},
      {MINIMAL "start: [{group: a, from: rest, velocity: [0, 0, 1]}]",
       "4:20: start[0].from: is for the whole body"},
      {MINIMAL "start: [{from: rest, velocity: [0, 0, 1]}, {from: rest, velocity: [0, 0, 1]}]",
       "4:45: start[1].from: is given twice"},
      {MINIMAL "start: [{from: rest}, {velocity: [0, 0, 1]}]",
       "4:9: start[0]: velocity or spin is"},
  };
  for (size_t k = 0; k < sizeof r / sizeof *r; k++) refuse(r[k].text, r[k].message);

  corot_mesh *mesh = NULL;
  corot_model *model = NULL;
  scenario *s = accept(MINIMAL "start: {group: zmix, velocity: [0, 0, 1]}");
  assert_fails(scenario_build(s, &mesh, NULL, &model), COROT_EFORMAT,
               "4:16: start.group: no group zmix; did you mean ");
  scenario_destroy(s);
}

/* At rest the support would stretch the body; an equilibrium takes it where it is. */
static void a_displaced_support_begins_in_equilibrium(void **state) {
  (void)state;
  char *dir = temporary_folder();
  answer a = run_text(dir, bar, (run_options){.quiet = true},
                      SET("boundary.0={group: base, move: {direction: [0, 0.3, 0], amplitude: "
                          "[[0, 1]]}}",
                          "loads=[]", "start=equilibrium", "time.output=0.5"));
  if (a.code != 0) fail_msg("%s", a.err);
  csv probes = read_csv(in(dir, "out/probes.csv"));
  for (int i = 0; i < probes.nrow; i++) assert_close(probes.x[i][2], 0.3, 1e-9, 0);
  free_csv(probes), forget(a), remove_folder(dir);
}

/* --- Memory that runs out -------------------------------------------------------------------- */

static corot_status make_scenario(void *context) {
  (void)context;
  scenario *s = NULL;
  COROT_TRY(scenario_read_text(FILE_NAME, forms, strlen(forms), 0, NULL, &s));
  corot_mesh *mesh = NULL;
  corot_model *model = NULL;
  corot_status status = scenario_build(s, &mesh, NULL, &model);
  scenario_destroy(s);
  COROT_TRY(status);
  corot_model_destroy(model);
  corot_mesh_destroy(mesh);
  return COROT_OK;
}

static void failed_allocations(void **state) {
  (void)state;
  put_table();
  assert_true(assert_survives_failed_allocations(make_scenario, NULL) >= 20);
}

/* --- Jumps ----------------------------------------------------------------------------------- */

/* A cube under an acceleration t mod 1: in each second the velocity grows by 1/2, and from k/2 the
   place by k/2 + 1/6. After ten: v = 5, u = 22.5 + 10/6. */
static const char saw_head[] =
    "mesh: {box: {size: [1, 1, 1], cells: [1, 1, 1]}}\n"
    "material: {E: 1.0e6, nu: 0.3, density: 1000}\n"
    "time: {end: 10, output: 1}\n"
    "probes: {p: {node: 0}}\n"
    "output: {fields: none, states: binary}\n";
static const double saw_u = 22.5 + 10. / 6, saw_p = 5000;

static char *saw(double width) {
  char *text = NULL;
  size_t size;
  FILE *out = open_memstream(&text, &size);
  fprintf(out, "%sloads: [{gravity: [1, 0, 0], amplitude: [[0, 0]", saw_head);
  for (int k = 1; k < 10; k++) fprintf(out, ", [%d, 1], [%.12g, 0]", k, k + width);
  fputs(", [10, 1]]}]\n", out);
  fclose(out);
  return text;
}

typedef struct ending {
  double u, momentum, balance, work;
  long steps;
} ending;

/* The last rows of a run. */
static ending run_to_end(const char *text, const char *const *set) {
  char *dir = temporary_folder();
  answer a = run_text(dir, text, (run_options){.quiet = true}, set);
  if (a.code != 0) fail_msg("%s: %s", set[0], a.err);
  csv probes = read_csv(in(dir, "out/probes.csv")), energy = read_csv(in(dir, "out/energy.csv"));
  csv steps = read_csv(in(dir, "out/steps.csv"));
  const double *row = energy.x[energy.nrow - 1];
  ending e = {.u = probes.x[probes.nrow - 1][1],
              .momentum = row[7],
              .balance = row[5],
              .work = row[4],
              .steps = steps.nrow};
  free_csv(probes), free_csv(energy), free_csv(steps), forget(a), remove_folder(dir);
  return e;
}

static const char *method_setting(const char *method) {
  static char text[64];
  snprintf(text, sizeof text, "integrator.method=%s", method);
  return text;
}

/* Runge-Kutta methods of order 4 integrate a polynomial of degree 3 without error; at a jump that
   they did not know they would err by the tolerance. BDF errs by the tolerance in each of some 45
   steps a second. The momentum, in which the error of the velocity stands alone, is the better. */
static void a_jump_is_the_limit_of_steep_ramps(void **state) {
  (void)state;
  char *jump = saw(0), *ramp = saw(1e-9);
  for (int m = 0; m < NMETHOD; m++) {
    const char *const *set = SET(method_setting(methods[m]), "integrator.rtol=1e-6");
    ending e = run_to_end(jump, set), steep = run_to_end(ramp, set);
    double bound = m < 2 ? 300 * 1e-6 : 1e-11;
    assert_close(e.u, saw_u, bound, 0);
    assert_close(e.momentum, saw_p, bound, 0);
    assert_close(e.work, 12500, bound, 0); /* of 1000 kg at 5 m/s */
    assert_below(fabs(e.balance), 2 * bound * 12500);
    assert_close(steep.u, e.u, fmax(2 * bound, 1e-8), 0);
  }
  free(jump), free(ramp);
}

/* At a constant step of which a second is a multiple or is not; the others take the law of each
   time: an error of a step's length at each jump at most. */
static void constant_steps_cross_a_jump(void **state) {
  (void)state;
  static const char *const method[] = {"backward-euler", "bdf2", "midpoint", "newmark"};
  static const char *const step[] = {"integrator.step=0.01", "integrator.step=0.0099"};
  char *jump = saw(0);
  for (int m = 0; m < 4; m++)
    for (int k = 0; k < 2; k++) {
      ending e = run_to_end(jump, SET(method_setting(method[m]), step[k]));
      assert_close(e.momentum, saw_p, 0, 1000 * 10 * 0.01);
      assert_close(e.u, saw_u, 0, 10 * 10 * 0.01);
    }
  free(jump);
}

/* A row at the very time of a jump is the limit from the left: nothing in it jumps but the load. */
static void rows_at_a_jump_are_continuous(void **state) {
  (void)state;
  char *dir = temporary_folder(), *jump = saw(0);
  answer a = run_text(dir, jump, (run_options){.quiet = true}, SET("integrator.method=arkode"));
  assert_int_equal(a.code, 0);
  csv probes = read_csv(in(dir, "out/probes.csv")), energy = read_csv(in(dir, "out/energy.csv"));
  for (int k = 0; k <= 10; k++) { /* u(k) is the sum of j/2 + 1/6 up to k */
    assert_close(probes.x[k][1], k * (k - 1) / 4. + k / 6., 1e-10, 1e-14);
    assert_close(energy.x[k][7], 500 * k, 1e-10, 1e-9);
    assert_close(energy.x[k][4], 125 * k * k, 1e-10, 1e-9);
  }
  free_csv(probes), free_csv(energy), forget(a), remove_folder(dir), free(jump);
}

/* --- Smooth amplitudes ----------------------------------------------------------------------- */

/* v = (1 - cos 2 pi t) / 2 pi, u = (t - sin(2 pi t) / 2 pi) / 2 pi. Six tets, so that erk is not
   held back by small ones. */
static const char swung[] =
    "mesh: {box: {size: [1, 1, 1], cells: [1, 1, 1], split: kuhn}}\n"
    "material: {E: 1.0e6, nu: 0.3, density: 1000}\n"
    "loads: [{gravity: [1, 0, 0], amplitude: {sine: {frequency: 1}}}]\n"
    "time: {end: 20, output: 1}\n"
    "probes: {p: {node: 0}}\n"
    "output: {fields: none}\n";

/* No stops: fewer steps than the sine has samples at 5 ms, which would stop each of them, and no
   more than four times as many as an integrator of that order needs where r is a polynomial. */
static void a_sine_needs_no_stops(void **state) {
  (void)state;
  static const double bound[] = {1e-2, 1e-2, 2e-3, 1e-5};
  static const long most[] = {1600, 1600, 200, 1100};
  for (int m = 0; m < NMETHOD; m++) {
    ending e = run_to_end(swung, SET(method_setting(methods[m])));
    assert_close(e.u, 20 / (2 * pi), bound[m], 0);
    assert_true(e.steps <= most[m]);
    assert_true(e.steps >= 80); /* four a period */
  }
}

/* A bump of 20 ms, sin^2, after 50 s in which nothing happens, and 50 s more: error control alone
   would step over it. Its impulse is half its length. */
static void a_bump_after_a_long_rest_is_not_passed_over(void **state) {
  (void)state;
  char *text = NULL;
  size_t size;
  FILE *out = open_memstream(&text, &size);
  fputs(
      "mesh: {box: {size: [1, 1, 1], cells: [1, 1, 1]}}\n"
      "material: {E: 1.0e6, nu: 0.3, density: 1000}\n"
      "time: {end: 100}\nprobes: {p: {node: 0}}\noutput: {fields: none}\n"
      "loads: [{gravity: [1, 0, 0], amplitude: {smooth: [",
      out);
  for (int i = 0; i <= 20; i++)
    fprintf(out, "%s[%.3f, %.17g]", i ? ", " : "", 50 + 0.001 * i, pow(sin(pi * i / 20), 2));
  fputs("]}}]\n", out);
  fclose(out);
  for (int m = 0; m < NMETHOD; m++) {
    ending e = run_to_end(text, SET(method_setting(methods[m]), "integrator.rtol=1e-6"));
    assert_close(e.momentum, 10, 1e-2, 0);
    assert_close(e.u, 0.01 * 49.99, 1e-2, 0);
  }
  free(text);
}

/* --- Supports -------------------------------------------------------------------------------- */

static const char shaken[] =
    "mesh: {box: {size: [0.1, 0.1, 0.4], cells: [1, 1, 4]}}\n"
    "material: {lambda: 1.0e5, mu: 1.0e4, density: 1000.0, damping: {lambda: 10.0, mu: 10.0}}\n"
    "time: {end: 2.0, output: 0.25}\n"
    "probes: {top: {point: [0.1, 0.1, 0.4]}}\n"
    "integrator: {method: arkode, rtol: 1.0e-7}\n"
    "output: {fields: none}\n";

#define SHAKEN_BY                                                              \
  "boundary=[{group: zmin, move: {direction: [0.02, 0, 0], amplitude: {sine: " \
  "{frequency: 1.5, phase: -1.5707963267948966, offset: 1}}}}]"

static void last_of(const char *const *set, double u[3], double *balance, double *work) {
  char *dir = temporary_folder();
  answer a = run_text(dir, shaken, (run_options){.quiet = true}, set);
  if (a.code != 0) fail_msg("%s: %s", set[0], a.err);
  csv probes = read_csv(in(dir, "out/probes.csv")), energy = read_csv(in(dir, "out/energy.csv"));
  for (int c = 0; c < 3; c++) u[c] = probes.x[probes.nrow - 1][1 + c];
  *balance = *work = 0;
  for (int i = 0; i < energy.nrow; i++) {
    *balance = fmax(*balance, fabs(energy.x[i][5]));
    *work = fmax(*work, fabs(energy.x[i][4]));
  }
  free_csv(probes), free_csv(energy), forget(a), remove_folder(dir);
}

/* Seen from its support, a shaken body is one that hangs still under the support's acceleration,
   the other way round: X = 0.02 (1 - cos w t), -X'' = -0.02 w^2 sin(w t + pi/2). For each strain
   measure that does not look where the body is, and the ledger closes. */
static void a_shaken_support_is_an_acceleration(void **state) {
  (void)state;
  double w = 2 * pi * 1.5, moved[3], still[3], balance, work;
  char strain[32], pull[200];
  snprintf(pull, sizeof pull,
           "loads=[{gravity: [%.17g, 0, 0], amplitude: {sine: {frequency: 1.5, phase: %.17g}}}]",
           -0.02 * w * w, pi / 2);
  for (int m = 0; m < NMEASURE; m++) {
    snprintf(strain, sizeof strain, "strain=%s", measures[m]);
    last_of(SET(SHAKEN_BY, strain), moved, &balance, &work);
    assert_above(work, 1e-3);
    if (strcmp(measures[m], "warp") != 0) /* whose force has no potential */
      assert_below(balance, 1e-6 * work);
    last_of(SET(pull, "boundary=[{group: zmin, fix: [x, y, z]}]", strain), still, &balance, &work);
    /* three periods: the support is back; 1e-7 of 0.05 m and as much of absolute tolerance a step
     */
    for (int c = 0; c < 3; c++) assert_close(moved[c], still[c], 0, 1e-6);
    assert_above(fabs(still[0]), 1e-3);
  }
}

/* The same path said in two ways, and one that is the sum of two. */
static void paths_can_be_said_in_two_ways(void **state) {
  (void)state;
  static const char *const pair[][2] = {
      {"boundary=[{group: zmin, rotate: {axis: [1, 0, 0], rate: 0.5, from: 0.25, to: 1.25}}]",
       "boundary=[{group: zmin, move: {rotate: {axis: [1, 0, 0], angle: 0.5}, amplitude: "
       "[[0.25, 0], [1.25, 1]]}}]"},
      {"boundary=[{group: zmin, translate: {velocity: [0.1, 0.2, 0], to: 1}}]",
       "boundary=[{group: zmin, move: {direction: [0.1, 0, 0], amplitude: [[0, 0], [1, 1]]}}, "
       "{group: zmin, move: {direction: [0, 0.1, 0], amplitude: [[0, 0], [1, 2]]}}]"},
  };
  for (int k = 0; k < 2; k++) {
    double u[2][3], balance, work;
    for (int i = 0; i < 2; i++) last_of(SET(pair[k][i]), u[i], &balance, &work);
    for (int c = 0; c < 3; c++) assert_close(u[1][c], u[0][c], 1e-9, 1e-12);
  }
}

/* --- Starts ---------------------------------------------------------------------------------- */

/* Later entries take the place of earlier ones; what a support holds is the support's. */
static void each_node_gets_the_velocity_said_last(void **state) {
  (void)state;
  scenario *s = accept(MINIMAL
                       "boundary: [{group: zmin, fix: [x]}]\n"
                       "start: [{velocity: [1, 2, 3]}, {group: zmax, velocity: [0, 0, 5], "
                       "spin: {axis: [0, 0, 2], center: [1, 1, 0], rate: 4}}]");
  corot_mesh *mesh;
  corot_model *model;
  assert_ok(scenario_build(s, &mesh, NULL, &model));
  int n = corot_model_ndof(model);
  double *u = calloc(2 * (size_t)n, sizeof *u), *v = u + n;
  const int(*dof)[3] = corot_model_dof(model);
  scenario_start(s, model, u, v);
  int seen = 0;
  for (int i = 0; i < mesh->nnode; i++) {
    const double *x = mesh->x[i];
    double turned[3] = {-4 * (x[1] - 1), 4 * (x[0] - 1), 5}, plain[3] = {1, 2, 3};
    for (int c = 0; c < 3; c++)
      if (dof[i][c] >= 0) {
        assert_close(v[dof[i][c]], (x[2] == 2 ? turned : plain)[c], 1e-15, 0);
        seen++;
      }
  }
  assert_int_equal(seen, n);
  assert_int_equal(n, 36 - 4);
  free(u), corot_model_destroy(model), corot_mesh_destroy(mesh), scenario_destroy(s);
}

#define THROWN                                                                              \
  "mesh: {box: {size: [0.3, 0.2, 0.1], cells: [3, 2, 1]}}\n"                                \
  "material: {E: 1.0e6, nu: 0.3, density: 1000}\n"                                          \
  "start: {velocity: [1, 0, 2], spin: {axis: [0, 0, 1], center: [0.1, 0.3, 0], rate: 2}}\n" \
  "loads: [{gravity: [0, 1, -9.81]}]\n"                                                     \
  "time: {end: 0.5}\n"

/* Momentum and moment of momentum about the origin, and the centre of mass. */
static void sums(const corot_model *model, const double *u, const double *v, double p[3],
                 double L[3], double centre[3]) {
  const corot_mesh *mesh = corot_model_mesh(model);
  const double *mass = corot_model_mass(model);
  double total = 0;
  for (int c = 0; c < 3; c++) p[c] = L[c] = centre[c] = 0;
  for (int n = 0; n < mesh->nnode; n++) {
    double m = mass[3 * n], x[3];
    for (int c = 0; c < 3; c++) x[c] = mesh->x[n][c] + u[3 * n + c];
    for (int c = 0; c < 3; c++) {
      int i = (c + 1) % 3, j = (c + 2) % 3;
      p[c] += m * v[3 * n + c];
      centre[c] += m * x[c];
      L[c] += m * (x[i] * v[3 * n + j] - x[j] * v[3 * n + i]);
    }
    total += m;
  }
  for (int c = 0; c < 3; c++) centre[c] /= total;
}

/* A body of mass m thrown at V + w x (X - C), under gravity g: its momentum is m (v + g t) with
   v the velocity of the centre, which flies along X + v t + g t^2 / 2, and the moment of momentum
   grows by the moment of gravity, (X t + v t^2 / 2) x m g. Of polar, hybrid and green: internal
   forces of the others have a moment once the body has turned. The errors are BDF's, 1e-6 in each
   of some hundred steps; those of Runge and Kutta's methods are of the orientation alone. */
static void a_thrown_body_flies_along_a_parabola(void **state) {
  (void)state;
  scenario *s = accept(THROWN);
  for (int k = 0; k < NMEASURE * NMETHOD; k++) {
    corot_mesh *mesh;
    corot_model *model;
    corot_state *now;
    corot_integrator *integrator;
    s->strain = measures[k % NMEASURE], s->integrator.method = methods[k / NMEASURE];
    s->integrator.rtol = 1e-6;
    assert_ok(scenario_build(s, &mesh, NULL, &model));
    assert_ok(corot_state_create(model, &now));
    int n = corot_model_ndof(model);
    double *u = calloc(2 * (size_t)n, sizeof *u), *v = u + n, p0[3], L0[3], x0[3], p[3], L[3], x[3];
    scenario_start(s, model, u, v);
    sums(model, u, v, p0, L0, x0);
    /* 6 kg, the centre at (0.15, 0.1, 0.05), w = 2 about z through (0.1, 0.3) */
    const double velocity[3] = {1 + 2 * 0.2, 2 * 0.05, 2}, g[3] = {0, 1, -9.81};
    for (int c = 0; c < 3; c++) assert_close(p0[c], 6 * velocity[c], 1e-13, 0);

    assert_ok(corot_integrator_create(&s->integrator, model, now, 0, u, v, &integrator));
    corot_step step = {0};
    while (step.t < 0.5) assert_ok(corot_integrator_step(integrator, 0.5, &step));
    assert_ok(corot_integrator_at(integrator, 0.5, u, v));
    sums(model, u, v, p, L, x);
    double t = 0.5, arm[3], way[3];
    bool keeps = k % NMEASURE >= 2, bdf = k / NMEASURE < 2;
    for (int c = 0; c < 3; c++) {
      arm[c] = x0[c] * t + velocity[c] * t * t / 2;
      way[c] = x0[c] + velocity[c] * t + g[c] * t * t / 2;
      assert_close(p[c], 6 * (velocity[c] + g[c] * t), 0, bdf ? 2e-3 : 1e-7);
      assert_close(x[c], way[c], 0, bdf ? 2e-4 : 1e-7);
    }
    for (int c = 0; keeps && c < 3; c++) {
      int i = (c + 1) % 3, j = (c + 2) % 3;
      assert_close(L[c], L0[c] + 6 * (arm[i] * g[j] - arm[j] * g[i]), 0, bdf ? 1e-3 : 1e-5);
    }
    corot_integrator_destroy(integrator), free(u), corot_state_destroy(now);
    corot_model_destroy(model), corot_mesh_destroy(mesh);
  }
  scenario_destroy(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_form_is_read_and_resolves_to_itself),
      cmocka_unit_test(a_word_to_start_with_resolves_to_a_word),
      cmocka_unit_test(every_key_can_be_overridden),
      cmocka_unit_test(a_table_is_part_of_what_is_run),
      cmocka_unit_test(tables_are_refused_with_their_place),
      cmocka_unit_test(what_makes_no_sense_is_refused_where_it_stands),
      cmocka_unit_test(a_displaced_support_begins_in_equilibrium),
      cmocka_unit_test(failed_allocations),
      cmocka_unit_test(a_jump_is_the_limit_of_steep_ramps),
      cmocka_unit_test(constant_steps_cross_a_jump),
      cmocka_unit_test(rows_at_a_jump_are_continuous),
      cmocka_unit_test(a_sine_needs_no_stops),
      cmocka_unit_test(a_bump_after_a_long_rest_is_not_passed_over),
      cmocka_unit_test(a_shaken_support_is_an_acceleration),
      cmocka_unit_test(paths_can_be_said_in_two_ways),
      cmocka_unit_test(each_node_gets_the_velocity_said_last),
      cmocka_unit_test(a_thrown_body_flies_along_a_parabola),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
