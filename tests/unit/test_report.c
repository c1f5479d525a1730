/* Reading back what a run leaves, and the page made of it, whatever the files hold. */
#include <corot/mesh.h>
#include <stdio.h>
#include <sys/stat.h>

#include "alloc.h"
#include "app/folder/read_csv.h"
#include "app/folder/write_vtu.h"
#include "app/folder/zlib_array.h"
#include "report/chart/precision.h"
#include "report/command/report.h"
#include "report/page/encode.h"
#include "report/page/thin.h"
#include "report/read/fields_file.h"
#include "report/read/surface.h"
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

/* By the divergence theorem, of what the triangles enclose: they wind outward. */
static double enclosed(const surface *s, const corot_mesh *mesh) {
  double volume = 0;
  for (int i = 0; i < s->ntri; i++) {
    const double *x[3];
    for (int k = 0; k < 3; k++) x[k] = mesh->x[s->node[s->corner[i][k]]];
    for (int k = 0; k < 3; k++) {
      int l = (k + 1) % 3, m = (k + 2) % 3;
      volume += x[0][k] * (x[1][l] * x[2][m] - x[1][m] * x[2][l]) / 6;
    }
  }
  return volume;
}

/* A cube and a plate one cell thick, whose sides must not fall together; triangles that replace
   some of a curved or cut corner enclose a little less, of the plate nothing at all. */
static void a_large_surface_is_thinned(void **state) {
  (void)state;
  static const corot_box boxes[] = {{{1, 1, 1}, {12, 12, 12}, {0}, COROT_BOX_KUHN},
                                    {{1, 1, 0.01}, {30, 30, 1}, {0}, COROT_BOX_KUHN}};
  for (int b = 0; b < 2; b++) {
    corot_mesh *mesh;
    surface s, whole;
    assert_ok(corot_mesh_box(&boxes[b], &mesh));
    const double(*x)[3] = (const double(*)[3])mesh->x;
    assert_ok(surface_create(mesh->nnode, mesh->ntet, (const int(*)[4])mesh->tet, &s));
    assert_ok(surface_create(mesh->nnode, mesh->ntet, (const int(*)[4])mesh->tet, &whole));
    int ntri = s.ntri;
    assert_ok(surface_thin(&s, x, mesh->nnode, ntri));
    assert_int_equal(s.ntri, ntri); /* it is no larger */
    assert_null(s.stands);
    assert_ok(surface_thin(&s, x, mesh->nnode, 500));
    assert_in_range(s.ntri, 150, 500);
    double volume = enclosed(&whole, mesh);
    assert_close(enclosed(&s, mesh), volume, 0.05, 0);

    /* each node has one that stands for it, which is near; inside there is none */
    double low = 1, high = 0;
    for (int i = 0; i < s.nnode; i++) {
      assert_int_equal(s.stands[s.node[i]], i);
      if (i > 0) assert_true(s.node[i] > s.node[i - 1]);
      low = fmin(low, x[s.node[i]][0]), high = fmax(high, x[s.node[i]][0]);
    }
    assert_true(low == 0 && high == 1);
    int inside = 0;
    for (int i = 0; i < mesh->nnode; i++) {
      inside += s.stands[i] < 0;
      for (int c = 0; c < 3 && s.stands[i] >= 0; c++)
        assert_close(x[s.node[s.stands[i]]][c], x[i][c], 0, 0.2);
    }
    assert_int_equal(inside, b == 0 ? 11 * 11 * 11 : 0);
    surface_free(&s);
    surface_free(&whole);
    corot_mesh_destroy(mesh);
  }
}

/* Three frames of a box, with values that tell where they are from. */
static void write_fields(const char *dir) {
  corot_mesh *mesh;
  vtu *w;
  assert_ok(corot_mesh_box(&(corot_box){{1, 1, 1}, {1, 1, 1}, {0}, COROT_BOX_KUHN}, &mesh));
  int material[6] = {0};
  assert_ok(vtu_create(dir, mesh, material, VTU_RAW, &w));
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

/* In [-1, 1], the same in each run. */
static double noise(uint64_t *seed) {
  *seed = *seed * 6364136223846793005u + 1442695040888963407u;
  return (double)(*seed >> 11) * 0x1p-52 - 1;
}

/* Numbers of which some repeat, in arrays of several blocks; frame k of either kind of file. */
static void write_large(const char *dir, const corot_mesh *mesh, vtu_data data) {
  int *material = calloc((size_t)mesh->ntet, sizeof *material);
  uint64_t seed = 1;
  vtu *w;
  assert_ok(vtu_create(dir, mesh, material, data, &w));
  vtu_fields v = vtu_arrays(w);
  for (int k = 0; k < 2; k++) {
    for (int i = 0; i < mesh->nnode; i++)
      for (int c = 0; c < 3; c++) v.displacement[i][c] = i % 3 ? noise(&seed) : k;
    for (int e = 0; e < mesh->ntet; e++) v.von_mises[e] = noise(&seed), v.det[e] = 1;
    assert_ok(vtu_write(w, k));
  }
  assert_ok(vtu_finish(w));
  vtu_destroy(w);
  free(material);
}

static void assert_same_frame(const fields *f, const fields *g, int k) {
  fields_frame a, b;
  size_t nnode = (size_t)f->nnode, ntet = (size_t)f->ntet;
  assert_ok(fields_frame_create(f, &a));
  assert_ok(fields_frame_create(g, &b));
  assert_ok(fields_read(f, k, &a));
  assert_ok(fields_read(g, k, &b));
  assert_memory_equal(a.displacement, b.displacement, nnode * sizeof *a.displacement);
  assert_memory_equal(a.velocity, b.velocity, nnode * sizeof *a.velocity);
  assert_memory_equal(a.frame, b.frame, ntet * sizeof *a.frame);
  assert_memory_equal(a.von_mises, b.von_mises, ntet * sizeof *a.von_mises);
  assert_memory_equal(a.det, b.det, ntet * sizeof *a.det);
  fields_frame_free(&a);
  fields_frame_free(&b);
}

static void compressed_fields_are_the_same_to_the_last_bit(void **state) {
  (void)state;
  char *dir = temporary_folder(), *raw = temporary_folder();
  corot_mesh *mesh;
  fields f, g;
  assert_ok(corot_mesh_box(&(corot_box){{1, 1, 1}, {22, 22, 22}, {0}, COROT_BOX_KUHN}, &mesh));
  assert_true(24 * (size_t)mesh->nnode > ZLIB_BLOCK);
  write_large(raw, mesh, VTU_RAW);
  write_large(dir, mesh, VTU_ZLIB);
  assert_ok(fields_open(raw, &f));
  assert_ok(fields_open(dir, &g));
  assert_int_equal(g.nframe, 2);
  assert_memory_equal(f.x, g.x, (size_t)f.nnode * sizeof *f.x);
  assert_memory_equal(f.tet, g.tet, (size_t)f.ntet * sizeof *f.tet);
  for (int k = 0; k < 2; k++) assert_same_frame(&f, &g, k);
  fields_close(&f);
  fields_close(&g);
  corot_mesh_destroy(mesh);
  remove_folder(dir);
  remove_folder(raw);
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

/* Each byte of a small file is changed in its turn, and the file is cut there: it is refused or
   read as it stands, where what has changed are values. */
static void damaged_compressed_fields_do_no_harm(void **state) {
  (void)state;
  char *dir = temporary_folder();
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&(corot_box){{1, 1, 1}, {1, 1, 1}, {0}, COROT_BOX_KUHN}, &mesh));
  write_large(dir, mesh, VTU_ZLIB);
  size_t size;
  const char *path = in(dir, "fields/fields_000000.vtu");
  char *good = slurp(path, &size);
  int refused = 0;
  for (size_t i = 0; i < size; i += i < 4096 ? 97 : 3) {
    for (int cut = 0; cut < 2; cut++) {
      fields f;
      fields_frame frame;
      good[i] ^= 0x41;
      put_bytes(path, good, cut ? i : size);
      good[i] ^= 0x41;
      corot_status status = fields_open(dir, &f);
      if (!status) {
        assert_ok(fields_frame_create(&f, &frame));
        status = fields_read(&f, 0, &frame);
        fields_frame_free(&frame);
        fields_close(&f);
      }
      refused += status != COROT_OK;
      assert_true(status == COROT_OK || status == COROT_EFORMAT || status == COROT_ENOMEM);
    }
  }
  assert_true(refused > 100);
  free(good);
  corot_mesh_destroy(mesh);
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

/* --- Long curves --- */

/* A long curve keeps its ends and its extremes wherever they are, the same in a part where points
   are dense (all but a hundredth of them in the first hundredth of x), and no more than is said. */
static void long_curves_are_thinned(void **state) {
  (void)state;
  enum { N = 100000 };
  double *x = malloc(N * sizeof *x), *y = malloc(N * sizeof *y);
  int *keep = malloc(THIN_MOST * sizeof *keep);
  for (int i = 0; i < N; i++) {
    x[i] = i < N - N / 100 ? 0.01 * i / N : 0.01 + 0.99 * (i - N + N / 100) / (N / 100.0);
    y[i] = i % 7;
  }
  y[12345] = 100, y[77777] = -100, y[N - 55] = 99, y[500] = NAN;
  int n = thin(N, x, y, keep);
  assert_true(n <= THIN_MOST && n > THIN_BINS);
  assert_int_equal(keep[0], 0);
  assert_int_equal(keep[n - 1], N - 1);
  int found = 0, sparse = 0;
  for (int k = 0; k < n; k++) {
    assert_true(k == 0 || keep[k] > keep[k - 1]);
    found += keep[k] == 12345 || keep[k] == 77777 || keep[k] == N - 55;
    sparse += keep[k] >= N - N / 100;
  }
  assert_int_equal(found, 3);
  assert_int_equal(sparse, N / 100); /* two to a piece, so that all are there */

  assert_int_equal(thin(THIN_MOST, x, y, keep), THIN_MOST); /* short: all of it */
  for (int i = 0; i < N; i++) x[i] = 1, y[i] = NAN;         /* and nothing to go by */
  n = thin(N, x, y, keep);
  assert_true(n <= THIN_MOST && keep[n - 1] == N - 1);
  free(x), free(y), free(keep);
}

/* --- What a page says --- */

static char *page_of(const char *dir) {
  assert_ok(report_write(dir, in(dir, "report.html")));
  return slurp(in(dir, "report.html"), NULL);
}

static void assert_says(const char *page, const char *text) {
  if (!strstr(page, text)) fail_msg("the page lacks: %s", text);
}

static void assert_silent(const char *page, const char *text) {
  if (strstr(page, text)) fail_msg("the page has: %s", text);
}

static void warnings_are_shown(void **state) {
  (void)state;
  static const struct {
    const char *result, *says;
  } is[] = {
      {"{\"warnings\": []}", "<p class=\"note\" id=\"warnings\">No warnings.</p>"},
      {"{\"warnings\": [\"a <b> & c\"]}", "<h3>1 warning</h3>\n<ul>\n<li>a &lt;b&gt; &amp; c</li>"},
      {"{\"warnings\": [{\"code\": \"<k>\", \"text\": \"t<\"}, {\"text\": \"u\"}, 3]}",
       "<h3>3 warnings</h3>\n<ul>\n<li>t&lt; <span class=\"code\">&lt;k&gt;</span></li>\n"
       "<li>u</li>\n<li></li>\n</ul>"},
  };
  char *dir = temporary_folder();
  for (size_t i = 0; i < sizeof is / sizeof *is; i++) {
    put_file(in(dir, "result.json"), is[i].result);
    char *page = page_of(dir);
    assert_says(page, is[i].says);
    assert_true(strstr(page, "id=\"warnings\"") <
                strstr(page, "class=\"lead\"")); /* near the top */
    free(page);
  }
  put_file(in(dir, "result.json"), "{}");
  char *page = page_of(dir);
  assert_silent(page, "arnings"); /* of a folder that has no list */
  free(page);
  remove_folder(dir);
}

static void extremes_are_shown(void **state) {
  (void)state;
  char *dir = temporary_folder();
  put_file(in(dir, "result.json"),
           "{\"extremes\": {\"<a>.ux\": {\"min\": {\"value\": -0.125, \"t\": 0.5}, \"max\": "
           "{\"value\": null, \"t\": null}}, \"kinetic\": {\"max\": {\"value\": 2e6, \"t\": 1}},"
           " \"odd\": 3}}");
  char *page = page_of(dir);
  assert_says(page,
              "&lt;a&gt;.ux [m]</th><td class=\"number\">-0.125</td>"
              "<td class=\"number\"><button type=\"button\" class=\"moment\" "
              "data-moment=\"0.5\">0.5</button></td><td class=\"number\"></td>"
              "<td class=\"number\"></td></tr>");
  assert_says(page,
              "kinetic [J]</th><td class=\"number\"></td><td class=\"number\"></td>"
              "<td class=\"number\">2e+06</td>");
  free(page);
  put_file(in(dir, "result.json"), "{\"extremes\": {}}");
  page = page_of(dir);
  assert_silent(page, "id=\"extremes\"");
  free(page);
  remove_folder(dir);
}

/* Where history.csv has a column it is drawn, not the coarser table; and a long one leaves the page
   small: 10 curves of at most 4000 points of 16 bytes, which base64 makes 4/3 of, are 0.9 MB. */
static void history_is_drawn_and_thinned(void **state) {
  (void)state;
  char *dir = temporary_folder();
  put_file(in(dir, "result.json"), "{}");
  put_file(in(dir, "probes.csv"), "t,a.ux,a.uy,a.uz\n0,1,1,1\n1,1,1,1\n");
  put_file(in(dir, "energy.csv"),
           "t,kinetic,elastic,dissipated,external_work,balance,frame_energy\n"
           "0,1,1,1,1,1,1\n1,1,1,1,1,1,1\n");
  char *coarse = page_of(dir);
  FILE *f = fopen(in(dir, "history.csv"), "w");
  assert_non_null(f);
  fputs("t,a.ux,a.uy,a.uz,kinetic,elastic,dissipated,external_work,balance,frame_energy\n", f);
  for (int i = 0; i <= 60000; i++)
    fprintf(f, "%.17g,%d,%d,1,%d,2,3,4,5,6\n", i / 60000.0, i % 11, i % 13, i % 17);
  fclose(f);
  char *fine = page_of(dir);
  assert_true(strlen(fine) > strlen(coarse) + 100000);
  assert_true(strlen(fine) < strlen(coarse) + 1000000);
  free(coarse), free(fine);

  put_file(in(dir, "history.csv"), "t,other\n0,1\n"); /* without the columns */
  char *page = page_of(dir);
  assert_says(page, "Displacement of a");
  assert_says(page, "id=\"balance\"");
  free(page);
  remove_folder(dir);
}

/* What is done to the box of write_fields, whose nodes are all on its surface. */
static void put_conditions(const char *dir, const char *more) {
  char text[2048];
  put_file(in(dir, "groups.json"),
           "{\"base\": {\"nodes\": [0, 1, 2, 3, 99, -1, \"x\"], \"faces\": [[0, 3, 1], [0, 2, 3]]},"
           " \"top\": {\"nodes\": [4, 5, 6, 7], \"faces\": [[4, 5, 7], [4, 7, 6]]}}");
  snprintf(text, sizeof text,
           "{\"t_end\": 2.0, %s \"scenario\": {\"boundary\": ["
           "{\"group\": \"base\", \"fix\": [\"x\", \"z\"]},"
           "{\"group\": \"top\", \"rotate\": {\"axis\": [0, 0, 1], \"rate\": 0.5}},"
           "{\"group\": \"<x-g>\", \"move\": {}}, 7],"
           "\"loads\": [{\"group\": \"top\", \"traction\": [1, 2, 3],"
           " \"amplitude\": [[0.25, 1], [0.5, 3], [0.5, 4]]},"
           "{\"gravity\": [0, 0, -9.81], \"amplitude\": {\"sine\": {}}},"
           "{\"group\": \"base\", \"force\": [0, 1, 0]}, {\"group\": \"base\", \"pressure\": 5}]}}",
           more);
  put_file(in(dir, "result.json"), text);
}

/* The frames are at 0, 0.5 and 1 s. */
static void supports_and_loads_are_drawn(void **state) {
  (void)state;
  char *dir = temporary_folder();
  write_fields(dir);
  put_conditions(dir, "");
  char *page = page_of(dir);
  assert_says(page,
              "{\"text\":\"base: x, z held\",\"moving\":false,\"held\":[1,0,1],"
              "\"nodes\":[0,1,2,3]}");
  assert_says(page,
              "{\"text\":\"top: turned about (0, 0, 1) at 0.5 rad/s\",\"moving\":true,"
              "\"held\":[1,1,1],\"nodes\":[4,5,6,7]}");
  assert_says(page,
              "{\"text\":\"\\u003cx-g\\u003e: moved\",\"moving\":true,\"held\":[1,1,1],"
              "\"nodes\":[]}");
  assert_says(page,
              "{\"text\":\"traction on top: (1, 2, 3) Pa\",\"whole\":false,\"vector\":[1,2,3],"
              "\"at\":[4,5,7,4,7,6],\"factor\":[1,4,4]}");
  assert_says(page,
              "\"whole\":true,\"vector\":[0,0,-9.8100000000000005],\"at\":[],\"factor\":null}");
  assert_says(page, "\"vector\":[0,1,0],\"at\":[0,0,0,1,1,1,2,2,2,3,3,3],\"factor\":[1,1,1]}");
  assert_says(page, "pressure on base: 5 Pa\",\"whole\":false,\"vector\":\"in\"");
  free(page);

  put_conditions(dir, "\"statics\": {},"); /* the loads of the end, times the load factor */
  page = page_of(dir);
  assert_says(page, "\"clock\":\"load factor\"");
  assert_says(page, "\"at\":[4,5,7,4,7,6],\"factor\":[0,1,2]}");
  free(page);

  unlink(in(dir, "groups.json")); /* as in folders of earlier versions */
  page = page_of(dir);
  assert_silent(page, "\"supports\"");
  free(page);
  remove_folder(dir);
}

/* A group of thousands of nodes has a few marks. */
static void large_groups_have_few_marks(void **state) {
  (void)state;
  char *dir = temporary_folder();
  corot_mesh *mesh;
  vtu *w;
  assert_ok(corot_mesh_box(&(corot_box){{1, 1, 1}, {20, 20, 20}, {0}}, &mesh));
  int *material = calloc((size_t)mesh->ntet, sizeof *material);
  assert_ok(vtu_create(dir, mesh, material, VTU_RAW, &w));
  assert_ok(vtu_write(w, 0));
  assert_ok(vtu_finish(w));
  vtu_destroy(w);
  put_conditions(dir, "");
  FILE *f = fopen(in(dir, "groups.json"), "w");
  assert_non_null(f);
  fputs("{\"base\": {\"nodes\": [0", f);
  for (int i = 1; i < mesh->nnode; i++) fprintf(f, ", %d", i);
  fputs("], \"faces\": []}}", f);
  fclose(f);
  char *page = page_of(dir), *nodes = strstr(page, "\"nodes\":[");
  assert_non_null(nodes);
  int n = 1;
  for (const char *s = nodes; *s && *s != ']'; s++) n += *s == ',';
  assert_in_range(n, 200, 600); /* the cubes at the surface of ten by ten by ten, 488 */
  free(page), free(material);
  corot_mesh_destroy(mesh);
  remove_folder(dir);
}

static void make_static(const char *dir) {
  write_fields(dir);
  put_conditions(dir,
                 "\"title\": \"s\", \"status\": \"failed\", \"reason\": \"why\","
                 " \"t_reached\": 1.0, \"energy\": {\"t\": 1, \"kinetic\": 0, \"elastic\": 2,"
                 " \"dissipated\": 0, \"external_work\": 2, \"balance\": 1e-3},"
                 " \"statistics\": {\"nstep\": 1},"
                 " \"extremes\": {\"a.ux\": {\"min\": {\"value\": 3, \"t\": 1}},"
                 " \"kinetic\": {\"max\": {\"value\": 0, \"t\": 0}}},"
                 " \"statics\": {\"tolerance\": 1e-10, \"reactions\": {\"base\": [-3, 1e-20, 0]},"
                 " \"steps\": [{\"factor\": 0.25, \"force\": 4, \"residual\": [1, 1e-5, 0]},"
                 " {\"factor\": 0.5, \"force\": 4, \"residual\": [1, 1e-12]}, 3]},");
  put_file(in(dir, "probes.csv"), "t,a.ux,a.uy,a.uz\n0,0,0,0\n0.5,1,0,3\n1,2,0,4\n");
  put_file(in(dir, "reactions.csv"), "t,base.fx,base.fy,base.fz\n0,0,0,0\n0.5,-1,0,0\n1,-3,0,0\n");
  put_file(in(dir, "energy.csv"),
           "t,kinetic,elastic,dissipated,external_work,balance,frame_energy\n"
           "0,0,0,0,0,0,0\n0.5,0,1,0,1,1e-3,0\n1,0,2,0,2,1e-3,0\n");
  put_file(in(dir, "steps.csv"),
           "t,h,order,error,newton,event,angle_max,angle_mean,frame_energy,reason\n"
           "0.5,0.5,0,0.1,2,,,,,\n1,0.5,0,0.2,1,,,,,\n");
}

static void an_equilibrium_has_a_page_of_its_own(void **state) {
  (void)state;
  char *dir = temporary_folder();
  make_static(dir);
  char *page = page_of(dir);
  assert_says(page, "<p class=\"kind\">corot static</p>");
  assert_says(page, "failed</b> at load factor 0.5: why");
  assert_says(page, "in 1 load step and");
  assert_says(page, "-3, 0, 0 N");
  assert_says(page, "data-moment=\"0.5\">0.5</button>");
  assert_says(page, "id=\"curve-0\"");
  assert_says(page, "id=\"reaction-0\"");
  assert_says(page, "id=\"residuals\"");
  assert_says(page,
              "\"note\":[\"load factor 0.25, iteration 0\",\"load factor 0.25, iteration 1\","
              "\"load factor 0.25, iteration 2\",\"\",\"load factor 0.5, iteration 0\",");
  static const char *const no[] = {"off balance", "id=\"balance\"", "id=\"error-estimate\"",
                                   "\"t [s]\"",   "kinetic",        "dissipated"};
  for (size_t i = 0; i < sizeof no / sizeof *no; i++) {
    char *scenario = strstr(page, "id=\"scenario\"");
    char *at = strstr(page, no[i]);
    assert_true(!at || at > scenario);
  }
  free(page);
  assert_above((double)assert_survives_failed_allocations(write_report, dir), 20);

  /* Whatever one byte of its files is, there is a report or a message. */
  static const char *const name[] = {"groups.json", "result.json", "reactions.csv"};
  srand(11);
  for (int trial = 0; trial < 150; trial++) {
    size_t size;
    char *good = slurp(in(dir, name[trial % 3]), &size), *bad = malloc(size);
    memcpy(bad, good, size);
    bad[(size_t)rand() % size] = (char)rand();
    put_bytes(in(dir, name[trial % 3]), bad, size);
    corot_status status = report_write(dir, in(dir, "report.html"));
    assert_true(status == COROT_OK || status == COROT_EFORMAT || status == COROT_EIO);
    put_bytes(in(dir, name[trial % 3]), good, size);
    free(good), free(bad);
  }
  remove_folder(dir);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(tables_are_read_back),
      cmocka_unit_test(data_are_encoded_for_scripts),
      cmocka_unit_test(a_surface_is_what_one_tet_has),
      cmocka_unit_test(a_large_surface_is_thinned),
      cmocka_unit_test(fields_are_read_back),
      cmocka_unit_test(foreign_fields_are_refused),
      cmocka_unit_test(compressed_fields_are_the_same_to_the_last_bit),
      cmocka_unit_test(damaged_compressed_fields_do_no_harm),
      cmocka_unit_test(text_of_files_is_never_markup),
      cmocka_unit_test(damaged_runs_do_no_harm),
      cmocka_unit_test(failed_allocations_are_survived),
      cmocka_unit_test(a_report_needs_a_run_or_a_study),
      cmocka_unit_test(long_curves_are_thinned),
      cmocka_unit_test(warnings_are_shown),
      cmocka_unit_test(extremes_are_shown),
      cmocka_unit_test(history_is_drawn_and_thinned),
      cmocka_unit_test(supports_and_loads_are_drawn),
      cmocka_unit_test(large_groups_have_few_marks),
      cmocka_unit_test(an_equilibrium_has_a_page_of_its_own),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
