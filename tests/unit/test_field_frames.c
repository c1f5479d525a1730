/* Which output times have a frame of fields: all of them, unless they take too much. */
#include "app/folder/write_vtu.h"
#include "app/run/outputs.h"
#include "app/scenario/field_frames.h"
#include "temporary.h"

static scenario every(int field_every, double t_end, double output_step) {
  return (scenario){
      .write_fields = true, .field_every = field_every, .t_end = t_end, .output_step = output_step};
}

/* Only the counts of the mesh are looked at: 161 bytes a tet, 72 a node, and the sizes. */
static const corot_mesh small = {.nnode = 100, .ntet = 1000},
                        large = {.nnode = 300000, .ntet = 2000000};

static void few_frames_are_all_there(void **state) {
  (void)state;
  scenario s = every(0, 1, 0.1);
  field_frames f = field_frames_of(&s, &small);
  char text[160];
  assert_int_equal(f.every, 1);
  assert_int_equal(f.n, 11);
  assert_int_equal(f.ntime, 11);
  assert_false(f.thinned);
  assert_true(f.bytes > 168200 && f.bytes < 168500);
  field_frames_words(&f, sizeof text, text);
  assert_string_equal(text, "");
  s.output_step = 0.3; /* the end is an output time */
  assert_int_equal(field_frames_of(&s, &small).n, 5);
  s.write_fields = false;
  assert_int_equal(field_frames_of(&s, &small).n, 0);
}

static void many_frames_are_thinned(void **state) {
  (void)state;
  scenario s = every(0, 1, 1e-4);
  field_frames f = field_frames_of(&s, &small);
  char text[160];
  assert_true(f.thinned);
  assert_int_equal(f.ntime, 10001);
  assert_true((double)f.n * f.bytes <= FIELDS_MOST);
  f.n = 1 + 10000 / (f.every - 1);
  assert_true((double)f.n * f.bytes > FIELDS_MOST); /* as many as there may be */
  f = field_frames_of(&s, &small);
  field_frames_words(&f, sizeof text, text);
  assert_string_equal(text,
                      "of every 17th output time and the last, 590 frames of 0.168 MB; "
                      "output.every: 1 writes all 10001");
  /* what one asks for is done */
  s.field_every = 1;
  assert_int_equal(field_frames_of(&s, &small).n, 10001);
  assert_false(field_frames_of(&s, &small).thinned);
  s.field_every = 3;
  assert_int_equal(field_frames_of(&s, &small).n, 3335);
}

static void the_first_and_the_last_are_there_in_any_case(void **state) {
  (void)state;
  scenario s = every(0, 1, 0.05);
  field_frames f = field_frames_of(&s, &large);
  assert_int_equal(f.every, 20);
  assert_int_equal(f.n, 2);
}

/* Moments of a run whose frames are thinned, and of equilibria, whose number nobody knows before.
 */
static void write_moments(const char *dir, bool still, int n, int *number) {
  corot_box box = {.size = {1, 1, 1}, .cells = {1, 1, 1}};
  corot_mesh *mesh;
  corot_model *model;
  corot_state *state;
  outputs *o;
  corot_material material = {.lambda = 1, .mu = 1, .density = 1};
  corot_model_def def = corot_model_defaults();
  scenario s = every(0, 1, 1e-6);
  double zero[24] = {0};
  s.model.nmaterial = def.nmaterial = 1, s.model.material = def.material = &material;
  s.model.strain = "polar";
  assert_ok(corot_mesh_box(&box, &mesh));
  def.mesh = mesh;
  assert_ok(corot_model_create(&def, &model));
  assert_ok(corot_state_create(model, &state));
  *number = field_frames_of(&s, mesh).every;
  assert_ok(outputs_open(&s, model, dir, &o));
  for (int k = 0; k <= n; k++) {
    instant now = {.t = k * 1e-6, .u = zero, .v = zero, .still = still};
    assert_ok(outputs_write(o, state, &now, k == n));
  }
  outputs_destroy(o);
  corot_state_destroy(state);
  corot_model_destroy(model);
  corot_mesh_destroy(mesh);
}

static void a_run_writes_these_and_no_others(void **state) {
  (void)state;
  char *dir = temporary_folder(), time[96];
  int number;
  write_moments(dir, false, 50, &number);
  assert_true(number > 2 && number < 50);
  char *list = slurp(in(dir, "fields.pvd"), NULL);
  snprintf(time, sizeof time, "timestep=\"%.17g\" file=\"fields/fields_000001.vtu\"",
           number * 1e-6);
  assert_non_null(strstr(list, time));
  snprintf(time, sizeof time, "timestep=\"%.17g\"", (number - 1) * 1e-6);
  assert_null(strstr(list, time));
  snprintf(time, sizeof time, "timestep=\"%.17g\"", 50 * 1e-6);
  assert_non_null(strstr(list, time));
  free(list);
  remove_folder(dir);
}

static void of_equilibria_each_is_written(void **state) {
  (void)state;
  char *dir = temporary_folder();
  int number;
  write_moments(dir, true, 3, &number);
  assert_true(exists(in(dir, "fields/fields_000003.vtu")));
  remove_folder(dir);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(few_frames_are_all_there),
      cmocka_unit_test(many_frames_are_thinned),
      cmocka_unit_test(the_first_and_the_last_are_there_in_any_case),
      cmocka_unit_test(a_run_writes_these_and_no_others),
      cmocka_unit_test(of_equilibria_each_is_written),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
