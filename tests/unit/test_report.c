/* Reading back what a run leaves, and the page made of it, whatever the files hold. */
#include <app/read_csv.h>
#include <app/write_vtu.h>
#include <corot/mesh.h>
#include <report/encode.h>
#include <report/fields.h>
#include <report/precision.h>
#include <report/report.h>
#include <report/surface.h>
#include <stdio.h>
#include <sys/stat.h>

#include "alloc.h"
#include "temporary.h"

static void assert_cell(const csv *t, int row, int column, const char *expected) {
  assert_string_equal(t->cell[row * t->ncolumn + column], expected);
}

static void tables_are_read_back(void **state) {
  (void)state;
  char *dir = temporary_folder();
  put_file(in(dir, "t.csv"),
           "t,\"a,\"\"b\"\".ux\",event\r\n0,1.5,\n1e-3,,kink+frames\r\n2,nan,\"x\ny\"\n3,4");
  csv t;
  assert_ok(csv_read(dir, "t.csv", &t));
  assert_int_equal(t.ncolumn, 3);
  assert_int_equal(t.nrow, 3); /* the last is cut short */
  assert_int_equal(csv_find(&t, "a,\"b\".ux"), 1);
  assert_int_equal(csv_find(&t, "b"), -1);
  assert_cell(&t, 0, 2, "");
  assert_cell(&t, 1, 2, "kink+frames");
  assert_cell(&t, 2, 2, "x\ny");
  double *x;
  assert_ok(csv_numbers(&t, 0, &x));
  assert_true(x[0] == 0 && x[1] == 1e-3 && x[2] == 2);
  free(x);
  assert_ok(csv_numbers(&t, 1, &x));
  assert_true(x[0] == 1.5 && isnan(x[1]) && isnan(x[2]));
  free(x);
  assert_ok(csv_column(&t, "t", &x));
  assert_true(x[1] == 1e-3);
  free(x);
  assert_fails(csv_column(&t, "b", &x), COROT_EFORMAT, "no column b");
  csv_free(&t);

  assert_ok(csv_read_if_there(dir, "none.csv", &t));
  assert_int_equal(t.ncolumn, 0);
  assert_fails(csv_read(dir, "none.csv", &t), COROT_EIO, "none.csv");
  put_file(in(dir, "t.csv"), "t,a\n1,2\n1\n3,4\n");
  assert_fails(csv_read(dir, "t.csv", &t), COROT_EFORMAT, "row 2 has not the 2 cells");
  put_file(in(dir, "t.csv"), "t,a\n1,2,3\n");
  assert_fails(csv_read(dir, "t.csv", &t), COROT_EFORMAT, "row 1");
  put_file(in(dir, "t.csv"), "t,a");
  assert_fails(csv_read(dir, "t.csv", &t), COROT_EFORMAT, "cut short");
  put_file(in(dir, "t.csv"), "");
  assert_fails(csv_read(dir, "t.csv", &t), COROT_EFORMAT, "cut short");
  remove_folder(dir);
}

static void assert_encoded(void (*write)(FILE *out), const char *expected) {
  char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  write(out);
  fclose(out);
  assert_string_equal(text, expected);
  free(text);
}

static void some_doubles(FILE *out) { encode_doubles(2, (const double[]){1, -2.5}, out); }
static void some_words(FILE *out) { encode_words(3, (const uint16_t[]){1, 258, 65535}, out); }
static void a_hostile_text(FILE *out) { encode_text("</script>\"\\\n\x01\xff\xc3\xa9", out); }
static void no_number(FILE *out) { encode_number(NAN, out); }

/* Bytes and base64 by hand: 1.0 is 00 00 00 00 00 00 f0 3f. */
static void data_are_encoded_for_scripts(void **state) {
  (void)state;
  assert_encoded(some_doubles, "\"AAAAAAAA8D8AAAAAAAAEwA==\"");
  assert_encoded(some_words, "\"AQACAf//\"");
  assert_encoded(a_hostile_text, "\"\\u003c/script\\u003e\\u0022\\u005c\\u000a??\xc3\xa9\"");
  assert_encoded(no_number, "null");
}

/* The surface of a box is closed, winds outward, and has the box's volume in it. */
static void a_surface_is_what_one_tet_has(void **state) {
  (void)state;
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&(corot_box){{1, 2, 3}, {2, 2, 2}, {5, 5, 5}, COROT_BOX_KUHN}, &mesh));
  surface s;
  assert_ok(surface_create(mesh->nnode, mesh->ntet, (const int(*)[4])mesh->tet, &s));
  assert_int_equal(s.ntri, 6 * 4 * 2);
  assert_int_equal(s.nnode, 26);
  double volume = 0;
  for (int i = 0; i < s.ntri; i++) {
    double x[3][3];
    for (int k = 0; k < 3; k++) {
      int node = s.node[s.corner[i][k]];
      memcpy(x[k], mesh->x[node], sizeof x[k]);
      const int *tet = mesh->tet[s.tet[i]];
      assert_true(tet[0] == node || tet[1] == node || tet[2] == node || tet[3] == node);
    }
    for (int k = 0; k < 3; k++) { /* x . (y cross z) / 6 */
      int l = (k + 1) % 3, m = (k + 2) % 3;
      volume += x[0][k] * (x[1][l] * x[2][m] - x[1][m] * x[2][l]) / 6;
    }
  }
  assert_close(volume, 6, 1e-12, 0);
  surface_free(&s);
  corot_mesh_destroy(mesh);
}

/* Three frames of a box, with values that tell where they are from. */
static void write_fields(const char *dir) {
  corot_mesh *mesh;
  vtu *w;
  assert_ok(corot_mesh_box(&(corot_box){{1, 1, 1}, {1, 1, 1}, {0}, COROT_BOX_KUHN}, &mesh));
  int material[6] = {0};
  assert_ok(vtu_create(dir, mesh, material, &w));
  vtu_fields v = vtu_arrays(w);
  for (int k = 0; k < 3; k++) {
    for (int i = 0; i < mesh->nnode; i++)
      for (int c = 0; c < 3; c++)
        v.displacement[i][c] = 0.01 * k * (i + c), v.velocity[i][c] = 0.1 * k;
    for (int e = 0; e < mesh->ntet; e++) {
      for (int c = 0; c < 9; c++) v.frame[e][c] = c % 4 == 0;
      v.von_mises[e] = 100 * k + e;
      v.det[e] = 1 + 0.1 * k;
    }
    assert_ok(vtu_write(w, 0.5 * k));
  }
  assert_ok(vtu_finish(w));
  vtu_destroy(w);
  corot_mesh_destroy(mesh);
}

static void fields_are_read_back(void **state) {
  (void)state;
  char *dir = temporary_folder();
  fields f;
  assert_ok(fields_open(dir, &f));
  assert_int_equal(f.nframe, 0);
  write_fields(dir);
  assert_ok(fields_open(dir, &f));
  assert_int_equal(f.nframe, 3);
  assert_int_equal(f.nnode, 8);
  assert_int_equal(f.ntet, 6);
  assert_true(f.t[2] == 1.0 && f.x[7][2] == 1.0);
  fields_frame frame;
  assert_ok(fields_frame_create(&f, &frame));
  assert_ok(fields_read(&f, 2, &frame));
  assert_true(frame.displacement[7][2] == 0.01 * 2 * 9 && frame.velocity[0][0] == 0.1 * 2);
  assert_true(frame.von_mises[5] == 205 && frame.det[0] == 1 + 0.1 * 2 && frame.frame[3][8] == 1);
  fields_frame_free(&frame);
  fields_close(&f);
  remove_folder(dir);
}

static void put_bytes(const char *path, const char *bytes, size_t size) {
  FILE *f = fopen(path, "wb");
  assert_non_null(f);
  assert_int_equal(fwrite(bytes, 1, size, f), size);
  fclose(f);
}

/* Replaces `old` by as many bytes. */
static void replace(char *text, size_t size, const char *old, const char *new) {
  for (size_t i = 0; i + strlen(old) <= size; i++)
    if (memcmp(text + i, old, strlen(old)) == 0) {
      memcpy(text + i, new, strlen(new));
      return;
    }
  fail_msg("%s is not there", old);
}

static void foreign_fields_are_refused(void **state) {
  (void)state;
  static const char *const change[][2] = {
      {"LittleEndian\"", "BigEndian\"   "},           {"UInt64", "UInt32"},
      {"NumberOfPoints=\"8", "NumberOfPoints=\"9"},   {"NumberOfCells=\"6", "NumberOfCells=\"0"},
      {"Name=\"Points\"", "Name=\"Pointz\""},         {"encoding=\"raw\"", "encoding=\"row\""},
      {"Name=\"connectivity", "Name=\"konnectivity"},
  };
  char *dir = temporary_folder();
  write_fields(dir);
  size_t size;
  char *good = slurp(in(dir, "fields/fields_000000.vtu"), &size);
  fields f;
  for (size_t i = 0; i < sizeof change / sizeof *change; i++) {
    char *bad = malloc(size);
    memcpy(bad, good, size);
    replace(bad, size, change[i][0], change[i][1]);
    put_bytes(in(dir, "fields/fields_000000.vtu"), bad, size);
    assert_fails(fields_open(dir, &f), COROT_EFORMAT, "fields_000000.vtu: ");
    free(bad);
  }
  put_bytes(in(dir, "fields/fields_000000.vtu"), good, size - 200);
  assert_fails(fields_open(dir, &f), COROT_EFORMAT, "");
  unlink(in(dir, "fields/fields_000000.vtu"));
  assert_fails(fields_open(dir, &f), COROT_EIO, "fields_000000.vtu: ");
  put_file(in(dir, "fields.pvd"), "<DataSet timestep=\"0\" file=\"fields/../../etc/passwd\"/>");
  assert_fails(fields_open(dir, &f), COROT_EFORMAT, "entry 0");
  put_file(in(dir, "fields.pvd"), "<DataSet timestep=\"soon\" file=\"fields/a.vtu\"/>");
  assert_fails(fields_open(dir, &f), COROT_EFORMAT, "the time 'soon'");
  put_file(in(dir, "fields.pvd"), "<DataSet timestep=\"0\" file=\"fields/a.vtu");
  assert_fails(fields_open(dir, &f), COROT_EFORMAT, "entry 0");
  free(good);
  remove_folder(dir);
}

static void make_run(const char *dir) {
  write_fields(dir);
  put_file(in(dir, "result.json"),
           "{\"title\": \"</script><x-t>'&\\\"\", \"status\": \"failed\", \"reason\": "
           "\"<x-r>why</x-r>\","
           " \"t_reached\": 1.0, \"t_end\": 2.0, \"strain\": \"polar\","
           " \"mesh\": {\"tets\": 6, \"nodes\": 8, \"dofs\": 24}, \"statistics\": {\"nst\": 2},"
           " \"timings\": {\"force\": 0.5, \"wall\": 0.5, \"cpu\": 0.5}, \"scenario\": {\"a\": "
           "\"<x-s>\"}}");
  put_file(in(dir, "probes.csv"),
           "t,\"<x-p>.ux\",<x-p>.uy,<x-p>.uz\n0,0,0,0\n0.5,1,2,3\n1,2,3,4\n");
  put_file(in(dir, "energy.csv"),
           "t,kinetic,elastic,dissipated,external_work,balance,frame_energy\n"
           "0,0,0,0,0,0,0\n0.5,1,2,3,6,0,0\n");
  put_file(in(dir, "steps.csv"),
           "t,h,order,error,newton,event,angle_max,angle_mean,frame_energy,reason\n"
           "0.5,0.5,1,0.1,2,,,,,\n1,0.5,2,0.2,2,frames,0.1,0.1,0,step\n");
  put_file(in(dir, "budget.json"),
           "{\"first\": \"<x-b>\", \"total\": 2, \"parts\": [{\"part\": \"time\","
           " \"pair\": \"a, b\", \"error\": 1}, {\"part\": \"space\"}, 3]}");
}

/* What stands in the files is text, and ends no script. */
static void text_of_files_is_never_markup(void **state) {
  (void)state;
  char *dir = temporary_folder();
  make_run(dir);
  assert_ok(report_write(dir, in(dir, "report.html")));
  char *page = slurp(in(dir, "report.html"), NULL);
  assert_null(strstr(page, "<x-"));
  int open = 0, close = 0, figures = 0;
  for (const char *s = page; (s = strstr(s, "<script")); s++) open++;
  for (const char *s = page; (s = strstr(s, "</script>")); s++) close++;
  for (const char *s = page; (s = strstr(s, "<figure ")); s++) figures++;
  /* the probe, four of the steps that vary and one of frames, two of energy, less the balance,
     which is zero but shown; the body */
  assert_int_equal(figures, 1 + 5 + 2 + 1);
  assert_int_equal(open, figures + 1);
  assert_int_equal(close, figures + 1);
  assert_non_null(strstr(page, "&lt;x-r&gt;why"));
  free(page);
  remove_folder(dir);
}

/* Whatever one byte of a run's files is, there is a report or a message. */
static void damaged_runs_do_no_harm(void **state) {
  (void)state;
  static const char *const name[] = {"fields/fields_000001.vtu", "fields.pvd", "result.json",
                                     "steps.csv", "budget.json"};
  char *dir = temporary_folder();
  make_run(dir);
  srand(7);
  for (int trial = 0; trial < 300; trial++) {
    const char *path = in(dir, name[trial % 5]);
    size_t size;
    char *good = slurp(path, &size), *bad = malloc(size);
    memcpy(bad, good, size);
    size_t at = (size_t)rand() % (size < 2600 ? size : 2600); /* the header, of fields */
    bad[at] = (char)rand();
    put_bytes(in(dir, name[trial % 5]), bad, trial % 7 ? size : at);
    corot_status status = report_write(dir, in(dir, "report.html"));
    assert_true(status == COROT_OK || status == COROT_EFORMAT || status == COROT_EIO);
    put_bytes(in(dir, name[trial % 5]), good, size);
    free(good);
    free(bad);
  }
  remove_folder(dir);
}

static corot_status write_report(void *dir) { return report_write(dir, in(dir, "report.html")); }

static corot_status write_diagram(void *dir) {
  study_table t;
  COROT_TRY(study_table_read(dir, &t));
  corot_status status =
      precision_write(&(precision){.table = &t, .cost = t.cost, .error = t.measure}, in(dir, "p"));
  study_table_free(&t);
  return status;
}

static void failed_allocations_are_survived(void **state) {
  (void)state;
  char *dir = temporary_folder();
  make_run(dir);
  assert_above((double)assert_survives_failed_allocations(write_report, dir), 20);
  put_file(in(dir, "table.json"),
           "{\"title\": \"t\", \"cost\": \"rhs\", \"measure\": \"velocity\", \"cells\": ["
           "{\"id\": \"a\", \"series\": \"s\", \"status\": \"done\", \"tolerance\": 1e-3,"
           " \"cost\": {\"rhs\": 10}, \"error\": {\"velocity\": 1e-2}}]}");
  assert_above((double)assert_survives_failed_allocations(write_report, dir), 10);
  assert_above((double)assert_survives_failed_allocations(write_diagram, dir), 10);
  static const char *const suffix[] = {"p.svg", "p.csv", "p.gp", "p.py"};
  for (int i = 0; i < 4; i++) assert_true(exists(in(dir, suffix[i])));
  remove_folder(dir);
}

static void a_report_needs_a_run_or_a_study(void **state) {
  (void)state;
  char *dir = temporary_folder();
  assert_fails(report_write(dir, in(dir, "report.html")), COROT_EIO, "no result.json of a run");
  assert_false(exists(in(dir, "report.html")));
  put_file(in(dir, "result.json"), "{}");
  assert_ok(report_write(dir, in(dir, "report.html"))); /* nothing is known: nothing is said */
  put_file(in(dir, "result.json"), "[]");
  assert_fails(report_write(dir, in(dir, "report.html")), COROT_EFORMAT, "result.json: not a map");
  put_file(in(dir, "result.json"), "{");
  assert_fails(report_write(dir, in(dir, "report.html")), COROT_EFORMAT, "result.json:1:");
  remove_folder(dir);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(tables_are_read_back),
      cmocka_unit_test(data_are_encoded_for_scripts),
      cmocka_unit_test(a_surface_is_what_one_tet_has),
      cmocka_unit_test(fields_are_read_back),
      cmocka_unit_test(foreign_fields_are_refused),
      cmocka_unit_test(text_of_files_is_never_markup),
      cmocka_unit_test(damaged_runs_do_no_harm),
      cmocka_unit_test(failed_allocations_are_survived),
      cmocka_unit_test(a_report_needs_a_run_or_a_study),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
