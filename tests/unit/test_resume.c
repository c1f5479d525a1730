/* What a checkpoint consists of: files that are cut back and go on, what is packed of a run on its
   way, and the file itself, of which no bit may be another. */
#include <math.h>

#include "alloc.h"
#include "app/folder/checkpoint_file.h"
#include "app/folder/folder.h"
#include "app/folder/write_csv.h"
#include "app/folder/write_vtu.h"
#include "app/quantity/meter.h"
#include "app/run/schedule.h"
#include "temporary.h"

/* --- Tables --- */

static const char *const column[] = {"tip.ux"};

static void add_rows(table *t, int from, int to) {
  for (int i = from; i < to; i++) assert_ok(probes_row(t, i, 1, &(double){sin(i)}));
}

/* A table of seven rows, packed behind the fourth. */
static pack packed_table(const char *dir) {
  table *t = NULL;
  pack p = {0};
  assert_ok(probes_open(dir, 1, column, &t));
  add_rows(t, 0, 4);
  assert_ok(table_pack(t, &p));
  add_rows(t, 4, 7);
  assert_ok(table_close(t));
  return p;
}

static void assert_same_files(const char *one, const char *other) {
  size_t n, m;
  char *a = slurp(one, &n), *b = slurp(other, &m);
  assert_int_equal(n, m);
  assert_memory_equal(a, b, n);
  free(a);
  free(b);
}

static void a_table_goes_on_from_the_row_it_had(void **state) {
  (void)state;
  char *dir = temporary_folder(), *whole = temporary_folder();
  table *t = NULL;
  assert_ok(probes_open(whole, 1, column, &t));
  add_rows(t, 0, 9);
  assert_ok(table_close(t));

  pack p = packed_table(dir), from = corot_pack_reader(p.data, p.bytes);
  char *before = slurp(in(dir, "probes.csv"), NULL);
  assert_ok(table_resume(dir, "probes.csv", &from, &t));
  char *after = slurp(in(dir, "probes.csv"), NULL);
  assert_string_equal(before, after); /* it is only looked at */
  assert_int_equal(corot_pack_left(&from), 0);
  assert_ok(table_cut(t));
  add_rows(t, 4, 9);
  assert_ok(table_synchronise(t));
  assert_ok(table_close(t));
  assert_same_files(in(dir, "probes.csv"), in(whole, "probes.csv"));
  free(before);
  free(after);
  corot_pack_clear(&p);
  remove_folder(whole);
  remove_folder(dir);
}

static void a_table_that_is_other_is_refused(void **state) {
  (void)state;
  char *dir = temporary_folder();
  pack p = packed_table(dir), from = corot_pack_reader(p.data, p.bytes);
  const char *path = in(dir, "probes.csv");
  table *t = NULL;
  char *text = slurp(path, NULL), *digit = strstr(text, "1,");
  *digit = '2';
  put_file(path, text);
  assert_fails(table_resume(dir, "probes.csv", &from, &t), COROT_EFORMAT,
               "probes.csv: is not what it was at the checkpoint");
  text[20] = '\0';
  put_file(path, text);
  from.at = 0;
  assert_fails(table_resume(dir, "probes.csv", &from, &t), COROT_EFORMAT,
               "probes.csv: has 20 bytes; it had ");
  assert_int_equal(unlink(path), 0);
  from.at = 0;
  assert_fails(table_resume(dir, "probes.csv", &from, &t), COROT_EFORMAT,
               "probes.csv: is not there, and was at the checkpoint");
  assert_int_equal(symlink("/dev/null", path), 0);
  from.at = 0;
  assert_fails(table_resume(dir, "probes.csv", &from, &t), COROT_EIO,
               "probes.csv: is not a regular file");
  from.at = 0, from.bytes = 12;
  assert_fails(table_resume(dir, "probes.csv", &from, &t), COROT_EINVAL, "cut short");
  free(text);
  corot_pack_clear(&p);
  remove_folder(dir);
}

/* --- Fields --- */

static const corot_mesh *two_tets(void) {
  static double x[][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  static int tet[][4] = {{0, 1, 2, 3}, {1, 2, 3, 4}};
  static corot_mesh mesh = {.nnode = 5, .ntet = 2, .x = x, .tet = tet};
  return &mesh;
}

static void frames_since_are_taken_away_and_others_stay(void **state) {
  (void)state;
  char *dir = temporary_folder(), *whole = temporary_folder();
  const int material[] = {0, 1};
  const char *theirs[] = {"fields/fields_.vtu", "fields/fields_old.vtu", "fields/notes.txt"};
  vtu *w = NULL;
  pack p = {0};
  assert_ok(vtu_create(whole, two_tets(), material, VTU_RAW, &w));
  for (int i = 0; i < 3; i++) assert_ok(vtu_write(w, i));
  assert_ok(vtu_finish(w));
  vtu_destroy(w);

  assert_ok(vtu_create(dir, two_tets(), material, VTU_RAW, &w));
  for (int i = 0; i < 6; i++) {
    assert_ok(vtu_write(w, i));
    if (i == 1) assert_ok(vtu_pack(w, &p));
  }
  assert_ok(vtu_synchronise(w));
  vtu_destroy(w);
  put_file(in(dir, "fields/fields_000009.vtu"), "ours, beyond a gap");
  for (int i = 0; i < 3; i++) put_file(in(dir, theirs[i]), "mine");

  pack from = corot_pack_reader(p.data, p.bytes);
  assert_ok(vtu_resume(dir, two_tets(), material, VTU_RAW, &from, &w));
  assert_true(exists(in(dir, "fields/fields_000005.vtu")));
  assert_ok(vtu_cut(w));
  for (int i = 2; i < 10; i++) {
    char name[40];
    snprintf(name, sizeof name, "fields/fields_%06d.vtu", i);
    assert_false(exists(in(dir, name)));
  }
  assert_true(exists(in(dir, "fields/fields_000001.vtu")));
  for (int i = 0; i < 3; i++) assert_true(exists(in(dir, theirs[i])));
  assert_ok(vtu_write(w, 2));
  vtu_destroy(w);
  assert_same_files(in(dir, "fields.pvd"), in(whole, "fields.pvd"));

  put_file(in(dir, "fields/fields_000001.vtu"), "cut");
  from.at = 0;
  assert_fails(vtu_resume(dir, two_tets(), material, VTU_RAW, &from, &w), COROT_EFORMAT,
               "fields_000001.vtu: is not what it was at the checkpoint");
  corot_pack_clear(&p);
  remove_folder(whole);
  remove_folder(dir);
}

/* Of these no two are as long: their sizes are known together. */
static void compressed_frames_go_on_and_others_are_refused(void **state) {
  (void)state;
  char *dir = temporary_folder();
  const int material[] = {0, 1};
  vtu *w = NULL;
  pack p = {0};
  assert_ok(vtu_create(dir, two_tets(), material, VTU_ZLIB, &w));
  for (int i = 0; i < 4; i++) {
    vtu_arrays(w).displacement[i][0] = 0.1 * (i + 1); /* each frame a few bytes longer */
    assert_ok(vtu_write(w, i));
    if (i == 1) assert_ok(vtu_pack(w, &p));
  }
  vtu_destroy(w);
  pack from = corot_pack_reader(p.data, p.bytes);
  assert_ok(vtu_resume(dir, two_tets(), material, VTU_ZLIB, &from, &w));
  assert_ok(vtu_cut(w));
  assert_false(exists(in(dir, "fields/fields_000002.vtu")));
  assert_ok(vtu_write(w, 2));
  vtu_destroy(w);
  assert_true(exists(in(dir, "fields/fields_000002.vtu")));

  put_file(in(dir, "fields/fields_000001.vtu"), "cut");
  from.at = 0;
  assert_fails(vtu_resume(dir, two_tets(), material, VTU_ZLIB, &from, &w), COROT_EFORMAT,
               "fields: the frames are not what they were at the checkpoint");
  corot_pack_clear(&p);
  remove_folder(dir);
}

/* --- Quantities and times --- */

static const char *const texts[] = {
    "max(x)",
    "min(x, 0.3, 1.7)",
    "mean(x, 0.2, end)",
    "integral(abs(x))",
    "amplitude(x)",
    "period(x)",
    "x@1.05",
    "x@end",
    "when(max(x))",
};
enum { NTEXT = sizeof texts / sizeof *texts, NROW = 40 };

static meter *new_meter(void) {
  static const char *const name[] = {"x"};
  quantity q[NTEXT];
  meter *m;
  size_t at;
  for (int i = 0; i < NTEXT; i++) {
    assert_ok(quantity_parse(texts[i], &q[i], &at));
    assert_ok(quantity_resolve(&q[i], 1, name, &at));
  }
  assert_ok(meter_create(NTEXT, q, 2, &m));
  return m;
}

/* Every other row has its slope; there is a break. */
static void add_row(meter *m, int k) {
  double t = 2.0 * k / NROW, x = sin(9 * t) + t, rate = 9 * cos(9 * t) + 1;
  meter_row(m, t, &x, k % 2 ? &rate : NULL);
  if (k == NROW / 3) meter_break(m);
}

static void a_meter_that_is_read_back_measures_the_same(void **state) {
  (void)state;
  meter *whole = new_meter();
  for (int k = 0; k <= NROW; k++) add_row(whole, k);
  meter_close(whole);
  for (int cut = 0; cut <= NROW; cut++) {
    meter *before = new_meter(), *after = new_meter();
    pack p = {0};
    for (int k = 0; k < cut; k++) add_row(before, k);
    meter_exchange(&p, before);
    pack from = corot_pack_reader(p.data, p.bytes);
    meter_exchange(&from, after);
    assert_ok(corot_pack_status(&from));
    assert_int_equal(corot_pack_left(&from), 0);
    for (int k = cut; k <= NROW; k++) add_row(after, k);
    meter_close(after);
    for (int i = 0; i < NTEXT; i++) {
      quantity_value a = meter_value(whole, i), b = meter_value(after, i);
      assert_true(a.known && b.known);
      assert_close(b.value, a.value, 0, 0);
      assert_true(a.t == b.t || (a.t != a.t && b.t != b.t));
    }
    corot_pack_clear(&p);
    meter_destroy(before);
    meter_destroy(after);
  }
  meter_destroy(whole);
}

static void a_schedule_that_is_read_back_has_the_same_times_left(void **state) {
  (void)state;
  double kinks[] = {0.25, 0.5, 0.75}, more[] = {0.25, 0.5, 0.75, 0.8}, due;
  schedule one = {.end = 1, .output_step = 0.1, .nkink = 3, .kink = kinks, .near = 1e-12};
  schedule other = one, third = one;
  pack p = {0};
  assert_true(schedule_take_kink(&one, 0.3, &due));
  for (int i = 0; i < 4; i++) assert_true(schedule_take_output(&one, 0.3, &due));
  schedule_exchange(&p, &one);
  pack from = corot_pack_reader(p.data, p.bytes);
  schedule_exchange(&from, &other);
  assert_ok(corot_pack_status(&from));
  assert_close(schedule_stop(&other, INFINITY), 0.5, 0, 0);
  assert_true(schedule_take_output(&other, 1, &due));
  assert_close(due, 4 * 0.1, 0, 0);
  third.nkink = 4, third.kink = more;
  from.at = 0;
  schedule_exchange(&from, &third);
  assert_fails(corot_pack_status(&from), COROT_EINVAL, "the number of kinks is 3, not 4");
  corot_pack_clear(&p);
}

/* --- The file --- */

static const char run_hash[HASH_SIZE] =
    "0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef";

static pack sealed(void) {
  pack p = {0};
  checkpoint_file_begin(&p, run_hash, "{\"corot\":\"1\"}", 0.25);
  corot_pack_double(&p, &(double){42});
  assert_ok(checkpoint_file_seal(&p));
  return p;
}

static void a_file_reads_back(void **state) {
  (void)state;
  char *dir = temporary_folder();
  pack p = sealed();
  const char *path = in(dir, CHECKPOINT_NAME);
  bool stands = true;
  assert_ok(checkpoint_file_stands(dir, &stands));
  assert_false(stands);
  assert_ok(file_renew_durably(path, p.data, p.bytes));
  assert_ok(checkpoint_file_stands(dir, &stands));
  assert_true(stands);
  checkpoint_file f;
  double x = 0;
  assert_ok(checkpoint_file_read(path, &f));
  assert_string_equal(f.run, run_hash);
  assert_string_equal(json_string_value(json_object_get(f.program, "corot")), "1");
  assert_close(f.t, 0.25, 0, 0);
  corot_pack_double(&f.state, &x);
  assert_close(x, 42, 0, 0);
  assert_int_equal(corot_pack_left(&f.state), 0);
  checkpoint_file_free(&f);
  corot_pack_clear(&p);
  remove_folder(dir);
}

static void no_bit_may_be_another_and_no_byte_be_missing(void **state) {
  (void)state;
  char *dir = temporary_folder();
  pack p = sealed();
  const char *path = in(dir, CHECKPOINT_NAME), *other = in(dir, "other.tmp");
  checkpoint_file f;
  for (size_t at = 0; at < p.bytes; at++)
    for (int bit = 0; bit < 8; bit++) {
      p.data[at] ^= (unsigned char)(1 << bit);
      assert_ok(file_replace(path, other, p.data, p.bytes));
      assert_int_equal(checkpoint_file_read(path, &f), COROT_EFORMAT);
      assert_non_null(strstr(corot_error(), path));
      p.data[at] ^= (unsigned char)(1 << bit);
    }
  for (size_t size = 0; size < p.bytes; size++) {
    assert_ok(file_replace(path, other, p.data, size));
    assert_int_equal(checkpoint_file_read(path, &f), COROT_EFORMAT);
  }
  corot_pack_clear(&p);
  remove_folder(dir);
}

/* --- Without memory --- */

static corot_status read_again(void *context) {
  checkpoint_file f;
  COROT_TRY(checkpoint_file_read(context, &f));
  checkpoint_file_free(&f);
  return COROT_OK;
}

static corot_status write_again(void *context) {
  (void)context;
  pack p = {0};
  checkpoint_file_begin(&p, run_hash, "{}", 0);
  corot_status status = checkpoint_file_seal(&p);
  corot_pack_clear(&p);
  return status;
}

typedef struct again {
  const char *dir;
  pack table, fields;
} again;

static corot_status resume_again(void *context) {
  again *a = context;
  pack from = corot_pack_reader(a->table.data, a->table.bytes);
  table *t = NULL;
  vtu *w = NULL;
  COROT_TRY(table_resume(a->dir, "probes.csv", &from, &t));
  from = corot_pack_reader(a->fields.data, a->fields.bytes);
  corot_status status = vtu_resume(a->dir, two_tets(), (const int[]){0, 0}, VTU_RAW, &from, &w);
  if (status == COROT_OK) vtu_destroy(w);
  corot_status closed = table_close(t);
  return status == COROT_OK ? closed : status;
}

static void no_allocation_may_fail_unnoticed(void **state) {
  (void)state;
  char *dir = temporary_folder();
  pack p = sealed();
  const char *path = in(dir, CHECKPOINT_NAME);
  assert_ok(file_renew_durably(path, p.data, p.bytes));
  assert_survives_failed_allocations(read_again, (void *)path);
  assert_survives_failed_allocations(write_again, NULL);
  again a = {.dir = dir, .table = packed_table(dir)};
  vtu *w = NULL;
  assert_ok(vtu_create(dir, two_tets(), (const int[]){0, 0}, VTU_RAW, &w));
  assert_ok(vtu_write(w, 0));
  assert_ok(vtu_pack(w, &a.fields));
  vtu_destroy(w);
  assert_survives_failed_allocations(resume_again, &a);
  corot_pack_clear(&a.table);
  corot_pack_clear(&a.fields);
  corot_pack_clear(&p);
  remove_folder(dir);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_table_goes_on_from_the_row_it_had),
      cmocka_unit_test(a_table_that_is_other_is_refused),
      cmocka_unit_test(frames_since_are_taken_away_and_others_stay),
      cmocka_unit_test(compressed_frames_go_on_and_others_are_refused),
      cmocka_unit_test(a_meter_that_is_read_back_measures_the_same),
      cmocka_unit_test(a_schedule_that_is_read_back_has_the_same_times_left),
      cmocka_unit_test(a_file_reads_back),
      cmocka_unit_test(no_bit_may_be_another_and_no_byte_be_missing),
      cmocka_unit_test(no_allocation_may_fail_unnoticed),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
