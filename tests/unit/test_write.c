/* The writers: tables, fields, result files. */
#include "alloc.h"
#include "app/folder/folder.h"
#include "app/folder/inventory.h"
#include "app/folder/write_csv.h"
#include "app/folder/write_vtu.h"
#include "app/run/outputs.h"
#include "app/run/schedule.h"
#include "temporary.h"

static void assert_file(const char *path, const char *expected) {
  char *text = slurp(path, NULL);
  assert_string_equal(text, expected);
  free(text);
}

static void folders_are_made_with_those_above(void **state) {
  (void)state;
  char *dir = temporary_folder();
  assert_ok(folder_make(in(dir, "a/b//c")));
  assert_ok(folder_make(in(dir, "a/b/c/")));
  assert_true(exists(in(dir, "a/b/c")));
  put_file(in(dir, "file"), "");
  assert_fails(folder_make(in(dir, "file/below")), COROT_EIO, "file");
  remove_folder(dir);
}

static void cleaning_leaves_files_of_others_alone(void **state) {
  (void)state;
  char *dir = temporary_folder();
  assert_ok(folder_make(in(dir, "fields")));
  const char *ours[] = {"result.json", "fields.pvd", "fields/fields_000000.vtu",
                        "fields/fields_1234567.vtu", "report.html"};
  const char *theirs[] = {"notes.txt", "fields/fields_.vtu", "fields/fields_old.vtu",
                          "fields/fields_000001.vtu.gz", "other.html"};
  for (int i = 0; i < 5; i++) {
    put_file(in(dir, ours[i]), "old");
    put_file(in(dir, theirs[i]), "old");
  }
  assert_ok(folder_clean(dir));
  for (int i = 0; i < 5; i++) {
    assert_false(exists(in(dir, ours[i])));
    assert_true(exists(in(dir, theirs[i])));
  }
  assert_ok(folder_clean(dir));
  remove_folder(dir);
}

static void a_file_is_replaced_as_a_whole_or_not_at_all(void **state) {
  (void)state;
  char *dir = temporary_folder();
  put_file(in(dir, "result.json"), "old");
  assert_int_equal(symlink("/dev/full", in(dir, "result.json.tmp")), 0);
  assert_fails(file_replace_durably(in(dir, "result.json"), "new\n", 4), COROT_EIO,
               "result.json.tmp: cannot write: No space left");
  assert_file(in(dir, "result.json"), "old");
  assert_false(exists(in(dir, "result.json.tmp")));

  assert_ok(file_replace_durably(in(dir, "result.json"), "new\n", 4));
  assert_file(in(dir, "result.json"), "new\n");
  assert_false(exists(in(dir, "result.json.tmp")));
  remove_folder(dir);
}

static void probes_have_a_column_a_component(void **state) {
  (void)state;
  char *dir = temporary_folder();
  const char *const name[] = {"tip.ux",        "tip.uy",        "tip.uz",
                              "a \"b\", c.ux", "a \"b\", c.uy", "a \"b\", c.uz"};
  const double x[] = {1, -2, 0.1, 1e300, -2.5e-308, 0};
  table *t = NULL;
  assert_ok(probes_open(dir, 6, name, &t));
  assert_ok(probes_row(t, 0.25, 6, x));
  assert_ok(table_close(t));
  assert_file(in(dir, "probes.csv"),
              "t,tip.ux,tip.uy,tip.uz,\"a \"\"b\"\", c.ux\",\"a \"\"b\"\", c.uy\","
              "\"a \"\"b\"\", c.uz\"\n"
              "0.25,1,-2,0.10000000000000001,1.0000000000000001e+300,-2.4999999999999998e-308,0\n");
  assert_ok(probes_open(dir, 0, NULL, &t));
  assert_ok(probes_row(t, 1, 0, x));
  assert_ok(table_close(t));
  assert_file(in(dir, "probes.csv"), "t\n1\n");
  remove_folder(dir);
}

static void rows_reach_the_disk_as_they_are_made(void **state) {
  (void)state;
  char *dir = temporary_folder();
  table *t = NULL;
  assert_ok(energy_open(dir, &t));
  const char *head =
      "t,kinetic,elastic,dissipated,external_work,balance,frame_energy,px,py,pz,lx,ly,lz\n";
  assert_file(in(dir, "energy.csv"), head);
  ledger row = {.t = 1,
                .kinetic = 2,
                .elastic = 3,
                .dissipated = 4,
                .external_work = 5,
                .balance = 6,
                .frame_energy = 7,
                .momentum = {8, 9, 10},
                .angular_momentum = {11, 12, 13}};
  assert_ok(energy_row(t, &row));
  char expected[256];
  snprintf(expected, sizeof expected, "%s1,2,3,4,5,6,7,8,9,10,11,12,13\n", head);
  assert_file(in(dir, "energy.csv"), expected);
  assert_ok(table_close(t));
  remove_folder(dir);
}

static void steps_name_what_happened(void **state) {
  (void)state;
  char *dir = temporary_folder();
  table *t = NULL;
  assert_ok(steps_open(dir, &t));
  step_row row = {.t = 1, .h = 0.5, .order = 2, .error = 0.25, .newton = 3};
  assert_ok(steps_add(t, &row));
  row.events = EVENT_KINK;
  assert_ok(steps_add(t, &row));
  row = (step_row){.t = 2,
                   .h = 1,
                   .order = 1,
                   .error = 0.5,
                   .newton = 1,
                   .update = {.reason = COROT_FRAMES_BY_CAP,
                              .change = {.angle_max = 0.5, .angle_mean = 0.125, .energy = -1}},
                   .events = EVENT_KINK | EVENT_FRAMES | EVENT_RESTART};
  assert_ok(steps_add(t, &row));
  assert_ok(table_close(t));
  assert_file(in(dir, "steps.csv"),
              "t,h,order,error,newton,event,angle_max,angle_mean,frame_energy,reason\n"
              "1,0.5,2,0.25,3,,,,,\n"
              "1,0.5,2,0.25,3,kink,,,,\n"
              "2,1,1,0.5,1,kink+frames+restart,0.5,0.125,-1,cap\n");
  remove_folder(dir);
}

static void comparisons_have_three_columns_a_measure(void **state) {
  (void)state;
  char *dir = temporary_folder();
  table *t = NULL;
  assert_ok(compare_open(dir, 2, (const char *const[]){"warp", "polar"}, &t));
  assert_ok(compare_row(t, 0, 2, (const force_error[]){{NAN, NAN, NAN}, {0, 0.5, -NAN}}));
  assert_ok(table_close(t));
  assert_file(in(dir, "compare.csv"),
              "t,warp.total,warp.pressure,warp.shear,polar.total,polar.pressure,polar.shear\n"
              "0,,,,0,0.5,\n");
  remove_folder(dir);
}

static void a_full_disk_is_named(void **state) {
  (void)state;
  char *dir = temporary_folder();
  assert_int_equal(symlink("/dev/full", in(dir, "steps.csv")), 0);
  table *t = NULL;
  assert_fails(steps_open(dir, &t), COROT_EIO, "steps.csv: cannot write: No space left");
  assert_null(t);
  assert_fails(steps_open(in(dir, "nowhere"), &t), COROT_EIO, "nowhere/steps.csv: cannot open it");
  remove_folder(dir);
}

/* Two tets that share a face. */
static const corot_mesh *two_tets(void) {
  static double x[5][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  static int tet[2][4] = {{0, 1, 2, 3}, {1, 2, 3, 4}};
  static const corot_mesh mesh = {.nnode = 5, .x = x, .ntet = 2, .tet = tet};
  return &mesh;
}

static void fill(vtu_fields f, double start) {
  for (int i = 0; i < 15; i++) (&f.displacement[0][0])[i] = start + i;
  for (int i = 0; i < 15; i++) (&f.velocity[0][0])[i] = start - i;
  for (int i = 0; i < 18; i++) (&f.frame[0][0])[i] = start + 100 + i;
  for (int i = 0; i < 12; i++) (&f.strain[0][0])[i] = start + 200 + i;
  for (int e = 0; e < 2; e++) f.von_mises[e] = start + 300 + e, f.det[e] = start + 400 + e;
}

/* The data of an array in the text of a .vtu file, read as the format has it: by its offset from
   the underscore. */
static const void *array_of(const char *file, size_t size, const char *name, uint64_t bytes) {
  char key[64];
  snprintf(key, sizeof key, "Name=\"%s\"", name);
  const char *entry = strstr(file, key);
  if (!entry) fail_msg("there is no array %s", name);
  const char *attribute = strstr(entry, "offset=\"");
  const char *data = strstr(file, "<AppendedData encoding=\"raw\">");
  assert_true(attribute && data);
  data = strchr(data, '_') + 1;
  data += strtoul(attribute + strlen("offset=\""), NULL, 10);
  uint64_t stored;
  memcpy(&stored, data, sizeof stored);
  assert_int_equal(stored, bytes);
  assert_true(data + 8 + bytes <= file + size);
  assert_int_equal((data - file) % 8, 0);
  return data + 8;
}

static void assert_counts_from(const void *data, int n, double start, double step) {
  for (int i = 0; i < n; i++) {
    double x;
    memcpy(&x, (const char *)data + 8 * i, sizeof x);
    assert_close(x, start + step * i, 0, 0);
  }
}

static void fields_read_back(void **state) {
  (void)state;
  char *dir = temporary_folder();
  vtu *w = NULL;
  assert_ok(vtu_create(dir, two_tets(), (const int[]){1, 0}, VTU_RAW, &w));
  fill(vtu_arrays(w), 1000);
  assert_ok(vtu_write(w, 0.125));
  assert_ok(vtu_finish(w));
  vtu_destroy(w);

  size_t size;
  char *file = slurp(in(dir, "fields/fields_000000.vtu"), &size);
  assert_non_null(strstr(file, "<Piece NumberOfPoints=\"5\" NumberOfCells=\"2\">"));
  const char *end = "\n</AppendedData>\n</VTKFile>\n";
  assert_memory_equal(file + size - strlen(end), end, strlen(end));
  assert_counts_from(array_of(file, size, "TimeValue", 8), 1, 0.125, 0);
  assert_counts_from(array_of(file, size, "displacement", 120), 15, 1000, 1);
  assert_counts_from(array_of(file, size, "velocity", 120), 15, 1000, -1);
  assert_counts_from(array_of(file, size, "frame", 144), 18, 1100, 1);
  assert_counts_from(array_of(file, size, "strain", 96), 12, 1200, 1);
  assert_counts_from(array_of(file, size, "von_mises", 16), 2, 1300, 1);
  assert_counts_from(array_of(file, size, "det", 16), 2, 1400, 1);
  assert_memory_equal(array_of(file, size, "material", 8), ((int32_t[]){1, 0}), 8);
  assert_memory_equal(array_of(file, size, "Points", 120), two_tets()->x, 120);
  assert_memory_equal(array_of(file, size, "connectivity", 32), two_tets()->tet, 32);
  assert_memory_equal(array_of(file, size, "offsets", 8), ((int32_t[]){4, 8}), 8);
  assert_memory_equal(array_of(file, size, "types", 2), "\12\12", 2);
  free(file);
  remove_folder(dir);
}

static void the_list_of_frames_is_whole_at_any_time(void **state) {
  (void)state;
  char *dir = temporary_folder(), expected[1024];
  const char *head =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n";
  const char *first = "<DataSet timestep=\"0\" file=\"fields/fields_000000.vtu\"/>\n";
  const char *second =
      "<DataSet timestep=\"0.10000000000000001\" file=\"fields/fields_000001.vtu\"/>\n";
  const char *tail = "</Collection>\n</VTKFile>\n";
  vtu *w = NULL;
  assert_ok(vtu_create(dir, two_tets(), (const int[]){0, 0}, VTU_RAW, &w));
  snprintf(expected, sizeof expected, "%s%s", head, tail);
  assert_file(in(dir, "fields.pvd"), expected);
  assert_ok(vtu_write(w, 0));
  snprintf(expected, sizeof expected, "%s%s%s", head, first, tail);
  assert_file(in(dir, "fields.pvd"), expected);
  assert_ok(vtu_write(w, 0.1));
  snprintf(expected, sizeof expected, "%s%s%s%s", head, first, second, tail);
  assert_file(in(dir, "fields.pvd"), expected);
  assert_false(exists(in(dir, "fields/frame.tmp")));

  /* A frame that does not fit is neither there nor listed. */
  assert_int_equal(symlink("/dev/full", in(dir, "fields/frame.tmp")), 0);
  assert_fails(vtu_write(w, 0.2), COROT_EIO, "fields/frame.tmp: cannot write: No space left");
  assert_false(exists(in(dir, "fields/fields_000002.vtu")));
  assert_file(in(dir, "fields.pvd"), expected);
  vtu_destroy(w);
  remove_folder(dir);
}

static void outputs_are_due_once_each(void **state) {
  (void)state;
  schedule s = {.end = 1.0, .output_step = 0.3, .near = 1e-12};
  double t, due[8];
  int n = 0;
  assert_true(schedule_take_output(&s, 0, &due[n++]));
  assert_false(schedule_take_output(&s, 0.29, &t));
  while (schedule_take_output(&s, 0.95, &t)) due[n++] = t; /* three in one step */
  assert_false(schedule_take_output(&s, 0.99, &t));
  assert_true(schedule_take_output(&s, 1.0, &due[n++]));
  assert_false(schedule_take_output(&s, 1.0, &t));
  assert_int_equal(n, 5);
  for (int i = 0; i < 4; i++) assert_close(due[i], i * 0.3, 0, 0);
  assert_close(due[4], 1.0, 0, 0);

  /* The end is a multiple but for rounding: 3 * 0.1 > 0.3. */
  s = (schedule){.end = 0.3, .output_step = 0.1, .near = 0.3e-12};
  for (n = 0; schedule_take_output(&s, 0.3, &t); n++) due[n] = t;
  assert_int_equal(n, 4);
  assert_close(due[3], 0.3, 0, 0);

  s = (schedule){.end = 2.0, .near = 2e-12};
  for (n = 0; schedule_take_output(&s, 2, &t); n++) due[n] = t;
  assert_int_equal(n, 2);
}

static void stops_are_kinks_and_the_end(void **state) {
  (void)state;
  double kink[] = {0.25, 0.3}, t;
  schedule s = {.end = 0.4, .nkink = 2, .kink = kink, .near = 0.4e-12};
  assert_close(schedule_stop(&s, 0.1), 0.1, 0, 0);
  assert_close(schedule_stop(&s, INFINITY), 0.25, 0, 0);
  assert_false(schedule_take_kink(&s, 0.2499, &t));
  assert_true(schedule_kink_before(&s, 0.26));
  assert_false(schedule_kink_before(&s, nextafter(0.25, 1))); /* that is the kink itself */
  assert_true(schedule_take_kink(&s, nextafter(0.25, 0), &t));
  assert_close(t, 0.25, 0, 0);
  assert_false(schedule_take_kink(&s, 0.25, &t));
  assert_close(schedule_stop(&s, INFINITY), 0.3, 0, 0);
  assert_true(schedule_take_kink(&s, 0.35, &t));
  assert_close(t, 0.3, 0, 0);
  assert_false(schedule_kink_before(&s, 1));

  assert_close(schedule_stop(&s, INFINITY), 0.4, 0, 0);
  assert_close(schedule_stop(&s, nextafter(0.4, 0)), 0.4, 0, 0); /* no step of a rounding */
  assert_false(schedule_over(&s, 0.3999));
  assert_true(schedule_over(&s, nextafter(0.4, 0)));
  assert_true(schedule_over(&s, 0.42));
}

/* A clock that adds up its steps misses the output times by rounding. */
static void an_output_is_due_but_for_rounding(void **state) {
  (void)state;
  schedule s = {.end = 1.0, .output_step = 0.3, .near = 1e-12};
  double t;
  assert_true(schedule_take_output(&s, 0, &t));
  assert_true(schedule_take_output(&s, nextafter(0.3, 0), &t));
  assert_close(t, 0.3, 0, 0);
  assert_false(schedule_take_output(&s, 0.3, &t));
}

/* A scenario made by hand, and what the objects under test are made from. */
typedef struct maker {
  const char *dir;
  scenario scenario;
  corot_model *model;
} maker;

static corot_status make_schedule(void *context) {
  maker *m = context;
  schedule *s = NULL;
  corot_status status = schedule_create(m->model, 2, 0.1, 0, NULL, &s);
  if (status == COROT_OK) assert_int_equal(s->nkink, 1);
  schedule_destroy(s);
  return status;
}

static corot_status make_outputs(void *context) {
  maker *m = context;
  outputs *o = NULL;
  corot_status status = outputs_open(&m->scenario, m->model, m->dir, &o);
  outputs_destroy(o);
  return status;
}

static void failed_allocations_are_survived(void **state) {
  (void)state;
  char *dir = temporary_folder();
  corot_box box = {.size = {1, 1, 1}, .cells = {1, 1, 1}};
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  corot_material material = {.lambda = 1, .mu = 1, .density = 1};
  corot_load load = {.kind = COROT_GRAVITY,
                     .value = {1, 0, 0},
                     .amplitude = {2, (const double[]){0, 1}, (const double[]){0, 1}}};
  corot_model_def def = corot_model_defaults();
  def.mesh = mesh;
  def.nmaterial = def.nload = 1;
  def.material = &material;
  def.load = &load;
  probe_def probe = {.name = (char *)"tip", .node = 7};
  maker m = {.dir = dir,
             .scenario = {.model = {.nmaterial = 1, .material = &material},
                          .nprobe = 1,
                          .probe = &probe,
                          .write_fields = true}};
  assert_ok(corot_model_create(&def, &m.model));

  assert_true(assert_survives_failed_allocations(make_schedule, &m) >= 2);
  assert_true(assert_survives_failed_allocations(make_outputs, &m) >= 10);
  m.scenario.compress_fields = true;
  assert_true(assert_survives_failed_allocations(make_outputs, &m) >= 12);
  m.scenario.write_fields = false;
  assert_true(assert_survives_failed_allocations(make_outputs, &m) >= 10);
  m.scenario.ncompare = 1;
  m.scenario.compare = (const char *const[]){"polar"};
  assert_true(assert_survives_failed_allocations(make_outputs, &m) >= 13);

  probe.node = 8;
  outputs *o = NULL;
  assert_fails(outputs_open(&m.scenario, m.model, dir, &o), COROT_EINVAL,
               "probe tip: node 8; the mesh's nodes are 0 to 7");
  corot_model_destroy(m.model);
  corot_mesh_destroy(mesh);
  remove_folder(dir);
}

/* Who adds a file to the outputs adds it to what a folder may hold. */
static void each_output_stands_in_the_inventory(void **state) {
  (void)state;
  const char *file;
  for (int i = 0; (file = outputs_file(i)); i++) {
    int k = 0;
    while (k < INVENTORY_SIZE && strcmp(inventory[k].name, file) != 0) k++;
    if (k == INVENTORY_SIZE) fail_msg("%s is not in the inventory", file);
    assert_true(inventory[k].cleaned && inventory[k].listed);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(folders_are_made_with_those_above),
      cmocka_unit_test(cleaning_leaves_files_of_others_alone),
      cmocka_unit_test(a_file_is_replaced_as_a_whole_or_not_at_all),
      cmocka_unit_test(each_output_stands_in_the_inventory),
      cmocka_unit_test(probes_have_a_column_a_component),
      cmocka_unit_test(rows_reach_the_disk_as_they_are_made),
      cmocka_unit_test(steps_name_what_happened),
      cmocka_unit_test(comparisons_have_three_columns_a_measure),
      cmocka_unit_test(a_full_disk_is_named),
      cmocka_unit_test(fields_read_back),
      cmocka_unit_test(the_list_of_frames_is_whole_at_any_time),
      cmocka_unit_test(outputs_are_due_once_each),
      cmocka_unit_test(stops_are_kinks_and_the_end),
      cmocka_unit_test(an_output_is_due_but_for_rounding),
      cmocka_unit_test(failed_allocations_are_survived),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
