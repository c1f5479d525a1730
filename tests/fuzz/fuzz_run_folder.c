/* Any bytes as one file of a run's folder that is sound otherwise: a page or a message, never a
   crash. The first byte chooses the file, and whether the folder is of a motion or of an
   equilibrium. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/folder/folder_files.h"
#include "app/folder/folder_lock.h"
#include "app/folder/folder_owner.h"
#include "app/folder/states.h"
#include "app/scenario/curve_file.h"
#include "app/text/json_text.h"
#include "core/base/fault.h"
#include "core/model/amplitude.h"
#include "report/command/report.h"
#include "report/read/fields_file.h"
#include "report/run/budget_section.h"
#include "report/study/report_goal.h"
#include "scratch.h"
#include "small_run.h"

int LLVMFuzzerInitialize(int *argc, char ***argv);
int LLVMFuzzerTestOneInput(const unsigned char *data, size_t size);

enum { STILL = 0x80 }; /* of the first byte */

static const char *const names[] = {"result.json", "groups.json",
                                    "budget.json", "probes.csv",
                                    "energy.csv",  "history.csv",
                                    "steps.csv",   "compare.csv",
                                    "fields.pvd",  "fields/fields_000000.vtu",
                                    "states.bin",  ".lock-run",
                                    "curve.csv",   "fields/fields_000001.vtu",
                                    "report.html", "reactions.csv",
                                    "solve.json"};
enum { NAMES = sizeof names / sizeof *names };

/* What a run left, to be put back. */
static struct {
  char *data; /* NULL: there is no such file */
  size_t size;
} left[2][NAMES];

static const char *const dirs[2] = {"motion", "still"};

static const char *path_of(int still, int k) {
  static char path[128];
  snprintf(path, sizeof path, "%s/%s", dirs[still], names[k]);
  return path;
}

int LLVMFuzzerInitialize(int *argc, char ***argv) {
  (void)argc;
  (void)argv;
  scratch_make();
  small_mesh();
  for (int still = 0; still < 2; still++) {
    small_run(dirs[still], "cvode", still, NULL);
    for (int k = 0; k < NAMES; k++)
      left[still][k].data = scratch_read(path_of(still, k), &left[still][k].size);
  }
  return 0;
}

static bool is_clean(corot_status status) {
  return status == COROT_OK ||
         ((status == COROT_EFORMAT || status == COROT_EIO) && *corot_error() != '\0');
}

static void check_report(const char *dir) {
  char page[600];
  snprintf(page, sizeof page, "%s/report.html", dir);
  require(is_clean(report_write(dir, page)), "a report");
  require(is_clean(report_budget(dir, page)), "a budget's report");
  require(is_clean(report_goal(dir, page)), "the report of a goal");
}

static void check_result(const char *dir, const unsigned char *data, size_t size) {
  json_t *result = NULL;
  corot_status status = json_text_parse("result.json", (const char *)data, size, &result);
  require(is_clean(status), "a result");
  if (status != COROT_OK) return;
  require(is_clean(folder_check(dir, result)), "files by their sizes");
  require(is_clean(folder_verify(dir, result)), "files by their contents");
  json_decref(result);
}

static void check_owner(const char *dir) {
  bool ours;
  folder_lock lock;
  require(is_clean(folder_is_ours(dir, &ours)), "an owner");
  require(is_clean(folder_permit(dir, false)), "a permission");
  corot_status status = folder_enter(dir, &lock);
  require(is_clean(status), "a lock");
  if (status == COROT_OK) folder_leave(&lock);
}

static void check_states(const char *dir) {
  trajectory t;
  corot_status status = states_read(dir, &t);
  require(is_clean(status), "states");
  if (status != COROT_OK) return;
  for (int k = 0; k < t.count; k++) {
    require(k == 0 || states_t(&t, k) > states_t(&t, k - 1), "times in order");
    for (int i = 0; i < t.n; i++)
      require(isfinite(states_u(&t, k)[i]) && isfinite(states_v(&t, k)[i]), "finite states");
  }
  states_free(&t);
}

/* Every frame, which the report leaves out where there are many. */
static void check_fields(const char *dir) {
  fields f;
  corot_status status = fields_open(dir, &f);
  require(is_clean(status), "fields");
  if (status != COROT_OK) return;
  fields_frame frame;
  if (f.nframe > 0 && fields_frame_create(&f, &frame) == COROT_OK) {
    for (int i = 0; i < f.nframe && i < 16; i++)
      require(is_clean(fields_read(&f, i, &frame)), "a frame");
    fields_frame_free(&frame);
  }
  fields_close(&f);
}

static void check_curve(const char *path) {
  config *tree = calloc(1, sizeof *tree);
  require(tree, "no memory");
  config_source source = {.name = "s.yaml", .text = "", .size = 0};
  config_node *node = config_node_create(tree, CONFIG_SCALAR);
  require(node, "no memory");
  node->text = "curve.csv";
  node->source = &source;
  for (int smooth = 0; smooth < 2; smooth++) {
    curve c;
    amplitude made;
    corot_status status = curve_file_read(tree, node, path, &c);
    require(status == COROT_OK || status == COROT_EFORMAT, "a curve");
    if (status != COROT_OK) continue;
    corot_amplitude from = {.n = c.n, .time = c.time, .value = c.value};
    if (smooth) from.curve = COROT_CURVE_SMOOTH;
    status = corot_amplitude_create(&from, "load", 0, &made);
    require(status == COROT_OK || status == COROT_EINVAL, "an amplitude");
    if (status == COROT_EINVAL)
      require(curve_file_fail(tree, node, path, corot_fault_last().point, "bad") == COROT_EFORMAT,
              "a place in the file");
    for (int i = 1; status == COROT_OK && i < c.n; i++)
      require(c.time[i] > c.time[i - 1] || (!smooth && c.time[i] == c.time[i - 1]), "rising times");
    if (status == COROT_OK) corot_amplitude_clear(&made);
  }
  config_destroy(tree);
}

int LLVMFuzzerTestOneInput(const unsigned char *data, size_t size) {
  if (size == 0) return 0;
  int still = (data[0] & STILL) != 0, k = (data[0] & ~STILL) % NAMES;
  const char *name = names[k];
  char dir[512], path[128];
  snprintf(dir, sizeof dir, "%s", scratch_path(dirs[still]));
  snprintf(path, sizeof path, "%s", path_of(still, k));
  scratch_write(path, data + 1, size - 1);

  if (strcmp(name, "result.json") == 0) check_result(dir, data + 1, size - 1);
  if (strcmp(name, "states.bin") == 0)
    check_states(dir);
  else if (strcmp(name, "curve.csv") == 0)
    check_curve(scratch_path(path));
  else
    check_report(dir);
  if (strstr(name, "fields")) check_fields(dir);
  check_owner(dir);

  scratch_remove("motion/report.html");
  scratch_remove("still/report.html");
  if (left[still][k].data)
    scratch_write(path, left[still][k].data, left[still][k].size);
  else
    scratch_remove(path);
  return 0;
}
