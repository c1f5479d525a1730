/* The scenario is written out here; the program itself runs it. */
#include "small_run.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/run/run.h"
#include "app/run/static.h"
#include "app/text/json_text.h"
#include "scratch.h"

static const char node[] = "4 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n";
static const char ele[] = "1 4 0\n0 0 1 2 3\n";

static const char text[] =
    "mesh: {file: m.node}\n"
    "groups: {base: {nodes: [0, 1, 2]}, tip: {nodes: [3]}}\n"
    "material: {mu: 1, nu: 0.25, density: 1, damping: {mu: 0.1}}\n"
    "boundary: [{group: base, fix: [x, y, z]}]\n"
    "loads: [{group: tip, force: [0.01, 0, 0]}]\n"
    "time: {end: 0.5, output: 0.25}\n"
    "integrator: {method: %s}\n"
    "statics: {first_step: 0.5}\n"
    "compare: [warp]\n"
    "probes: {tip: {node: 3}}\n"
    "output: {fields: vtu, history: true, states: binary}\n";

void small_mesh(void) {
  scratch_write("m.node", node, strlen(node));
  scratch_write("m.ele", ele, strlen(ele));
}

/* What is replaced is not listed, and the run is that of the hash. */
static void open_up(const char *name, const char *hash) {
  size_t size;
  char *before = scratch_read(name, &size);
  json_t *result = NULL;
  require(before && json_text_parse(name, before, size, &result) == COROT_OK, "no result.json");
  json_object_del(result, "files");
  if (hash) json_object_set_new(json_object_get(result, "hashes"), "run", json_string(hash));
  char *after = json_text_dump(result, JSON_INDENT(1));
  require(after, "no memory");
  scratch_write(name, after, strlen(after));
  json_decref(result);
  free(after);
  free(before);
}

void small_run(const char *name, const char *method, bool still, const char *hash) {
  char scenario_text[sizeof text + 64], dir[256], result[300];
  scenario *s = NULL;
  snprintf(scenario_text, sizeof scenario_text, text, method);
  snprintf(dir, sizeof dir, "%s", scratch_path(name));
  corot_status status =
      scenario_read_text(scratch_path("s.yaml"), scenario_text, strlen(scenario_text), 0, NULL, &s);
  require(status == COROT_OK, "the small scenario");
  run_options options = {.dir = dir, .quiet = true};
  int code = still ? static_scenario(s, &options) : run_scenario(s, &options);
  require(code == 0, "the small run");
  scenario_destroy(s);
  snprintf(result, sizeof result, "%s/result.json", name);
  open_up(result, hash);
}
