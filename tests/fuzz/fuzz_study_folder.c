/* Any bytes as one file of a study's folder that is sound otherwise: tables or a message, never a
   crash. The first byte chooses the file. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/folder/folder.h"
#include "app/scenario/scenario.h"
#include "report/command/report.h"
#include "scratch.h"
#include "small_run.h"
#include "study/execute/store.h"
#include "study/measure/collect.h"
#include "study/plan/json_file.h"
#include "study/tables/table_text.h"

int LLVMFuzzerInitialize(int *argc, char ***argv);
int LLVMFuzzerTestOneInput(const unsigned char *data, size_t size);

/* Two runs are a reference, and two are cells, the second of which failed. */
#define RUN "runs/0000000000000001/"
#define FAILED "runs/0000000000000003/"
static const char *const names[] = {
    "study.json",       "table.json",          RUN "result.json",
    RUN "timings.json", FAILED "failure.json", RUN "states.bin",
    RUN "energy.csv",   "report.html",         FAILED "result.json"};
enum { TABLE = 1, NAMES = sizeof names / sizeof *names };

static const char study_text[] =
    "{\"study\": \"s\", \"name\": \"s\", \"base\": \"%s\", \"corot\": \"0.1.0\",\n"
    " \"identity\": \"i\", \"cost\": \"cpu\", \"measure\": \"displacement\", \"repeat\": 1,\n"
    " \"columns\": [\"integrator.method\"],\n"
    " \"runs\": [{\"id\": \"0000000000000000\", \"hash\": \"0\", \"set\": []},\n"
    "  {\"id\": \"0000000000000001\", \"hash\": \"1\", \"set\": [\"integrator.method=ida\"]},\n"
    "  {\"id\": \"0000000000000002\", \"hash\": \"2\", \"set\": []},\n"
    "  {\"id\": \"0000000000000003\", \"hash\": \"3\", \"set\": []}],\n"
    " \"references\": [{\"runs\": [0, 2], \"methods\": [\"cvode\", \"ida\"], \"rtol\": 1e-6,\n"
    "  \"settings\": {}}],\n"
    " \"cells\": [{\"run\": 1, \"settings\": {\"integrator.method\": \"ida\"}, \"series\": "
    "\"ida\",\n"
    "  \"tolerance\": 1e-4, \"tolerance_key\": \"integrator.rtol\", \"reference\": 0},\n"
    "  {\"run\": 3, \"settings\": {}, \"series\": \"ida\", \"reference\": 0}]}\n";
static const char timings_text[] = "{\"hash\": \"1\", \"runs\": [{\"cpu\": 0.5, \"wall\": 0.5}]}\n";
static const char failure_text[] =
    "{\"hash\": \"3\", \"reason\": \"r\", \"exit_code\": 4,\n"
    " \"failure\": {\"kind\": \"integrator\", \"retry\": false}}\n";

static struct {
  char *data; /* NULL: there is no such file */
  size_t size;
} left[NAMES];

int LLVMFuzzerInitialize(int *argc, char ***argv) {
  (void)argc;
  (void)argv;
  scratch_make();
  small_mesh();
  require(folder_make(scratch_path(FAILED)) == COROT_OK, "no folder");
  small_run("runs/0000000000000000", "cvode", false, "0");
  small_run("runs/0000000000000001", "ida", false, "1");
  small_run("runs/0000000000000002", "ida", false, "2");
  char text[sizeof study_text + 600];
  snprintf(text, sizeof text, study_text, scratch_path("s.yaml"));
  scratch_write("study.json", text, strlen(text));
  scratch_write(RUN "timings.json", timings_text, strlen(timings_text));
  scratch_write(FAILED "failure.json", failure_text, strlen(failure_text));
  for (int k = 0; k < NAMES; k++) left[k].data = scratch_read(names[k], &left[k].size);
  return 0;
}

static bool is_clean(corot_status status) {
  return status == COROT_OK ||
         ((status == COROT_EFORMAT || status == COROT_EIO || status == COROT_EINVAL) &&
          *corot_error() != '\0');
}

/* Whether the solid of a result is small: collecting builds its mesh. */
static bool is_small(const char *name) {
  json_t *result = NULL;
  scenario *s = NULL;
  if (json_file_read(scratch_path(name), &result) != COROT_OK) return true;
  char *text = json_dumps(json_object_get(result, "scenario"), JSON_ENCODE_ANY);
  json_decref(result);
  bool small = !text || scenario_read_text(scratch_path("s.yaml"), text, strlen(text), 0, NULL, &s);
  if (s) {
    double cells = s->mesh_file ? 1 : (double)s->box.cells[0] * s->box.cells[1] * s->box.cells[2];
    small = cells <= 8 && s->refine <= 1;
  }
  scenario_destroy(s);
  free(text);
  return small;
}

static void check_runs(const manifest *m, const char *dir) {
  for (int i = 0; i < m->nrun && i < 8; i++) {
    run_record record;
    timings t;
    corot_status status = store_look(dir, &m->run[i], &record);
    require(is_clean(status), "a run");
    if (status == COROT_OK) run_record_free(&record);
    status = store_verify(dir, &m->run[i], &record);
    require(is_clean(status), "a run's files");
    if (status == COROT_OK) run_record_free(&record);
    status = timings_read(dir, &m->run[i], &t);
    require(is_clean(status), "timings");
    if (status == COROT_OK) timings_free(&t);
  }
}

/* The table as text and as a page. */
static void check_table(const char *dir) {
  json_t *table = NULL;
  FILE *nowhere = fopen("/dev/null", "w");
  require(nowhere, "no /dev/null");
  corot_status status = json_file_read(scratch_path("table.json"), &table);
  require(is_clean(status), "a table");
  if (status == COROT_OK) require(is_clean(table_print(table, nowhere)), "a table's text");
  json_decref(table);
  fclose(nowhere);
  require(is_clean(report_write(dir, scratch_path("page.html"))), "a study's report");
}

static void check_study(const char *dir) {
  manifest *m = NULL;
  corot_status status = manifest_read(dir, &m);
  require(is_clean(status), "a study");
  if (status != COROT_OK) return;
  check_runs(m, dir);
  FILE *remarks = fopen("/dev/null", "w");
  int ndamaged;
  require(remarks, "no /dev/null");
  status = collect_runs(m, dir, false, remarks, &ndamaged);
  require(is_clean(status), "a collection");
  fclose(remarks);
  if (status == COROT_OK) check_table(dir);
  store_lock lock;
  status = store_enter(dir, m, 1, 1, false, &lock);
  require(is_clean(status), "a lock");
  if (status == COROT_OK) store_leave(lock);
  manifest_destroy(m);
}

int LLVMFuzzerTestOneInput(const unsigned char *data, size_t size) {
  if (size == 0) return 0;
  int k = data[0] % NAMES;
  char dir[512];
  snprintf(dir, sizeof dir, "%s", scratch_path(""));
  dir[strlen(dir) - 1] = '\0';
  scratch_write(names[k], data + 1, size - 1);
  if (k == TABLE)
    check_table(dir);
  else if (is_small(RUN "result.json") && is_small(FAILED "result.json"))
    check_study(dir);
  if (left[k].data)
    scratch_write(names[k], left[k].data, left[k].size);
  else
    scratch_remove(names[k]);
  return 0;
}
