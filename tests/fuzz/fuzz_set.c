/* Any lines as overrides, `--set LINE`, of a small scenario: a scenario or a message, never a
   crash. What is accepted resolves to itself, and is the same with the overrides set one by one. */
#include <stdlib.h>
#include <string.h>

#include "app/config/config.h"
#include "app/scenario/scenario.h"
#include "resolved.h"
#include "scratch.h"

int LLVMFuzzerTestOneInput(const unsigned char *data, size_t size);

enum { MOST_LINES = 32 };

static const char base[] =
    "mesh: {box: {size: [1, 1, 1], cells: [1, 1, 1]}}\n"
    "groups: {a: {plane: {axis: x, at: 0}}}\n"
    "material: {mu: 1, nu: 0.25, density: 1}\n"
    "boundary: [{group: a, fix: [x, y, z]}]\n"
    "loads: [{gravity: [0, 0, -1]}]\n"
    "probes: {p: {point: [1, 1, 1]}}\n"
    "time: {end: 1}\n";

/* Cuts the text into lines. */
static int cut(char *text, char *line[MOST_LINES]) {
  int n = 0;
  while (text && n < MOST_LINES) {
    line[n++] = text;
    text = strchr(text, '\n');
    if (text) *text++ = '\0';
  }
  return n;
}

/* Each override as the command line takes it apart. False: one is no assignment, or does not fit.
 */
static bool check_apart(int n, char **line) {
  config *tree = NULL;
  require(config_read_text("base.yaml", base, strlen(base), &tree) == COROT_OK, "the base");
  corot_status status = COROT_OK;
  for (int i = 0; i < n && status == COROT_OK; i++) {
    const char *path = NULL;
    config_node *value = NULL;
    status = config_parse_assignment(tree, line[i], &path, &value);
    if (status == COROT_OK) {
      require(path && value && strncmp(path, line[i], strlen(path)) == 0, "a key");
      status = config_set(tree, path, value);
    }
    if (status == COROT_OK) {
      const config_node *set = config_find(tree->root, path);
      require(set && set->kind == value->kind && set->nchild == value->nchild, "a value");
    }
  }
  require(status == COROT_OK || (status == COROT_EFORMAT && *corot_error()), "no clean failure");
  config_destroy(tree);
  return status == COROT_OK;
}

int LLVMFuzzerTestOneInput(const unsigned char *data, size_t size) {
  char *text = malloc(size + 1), *line[MOST_LINES];
  require(text, "no memory");
  if (size) memcpy(text, data, size);
  text[size] = '\0';
  int n = cut(text, line);
  bool fits = check_apart(n, line);
  scenario *s = NULL;
  corot_status status = scenario_read_text("base.yaml", base, strlen(base), n, line, &s);
  require(status == COROT_EFORMAT || (status == COROT_OK && fits), "neither taken nor refused");
  if (status == COROT_OK) check_resolved(s);
  scenario_destroy(s);
  free(text);
  return 0;
}
