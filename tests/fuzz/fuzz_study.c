/* Any bytes as a study file over a small scenario: a study or a message, never a crash. The first
   byte chooses YAML or JSON. What its cells set reads back as it was, as text and in a scenario. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/config/config.h"
#include "study/plan/study.h"

int LLVMFuzzerInitialize(int *argc, char ***argv);
int LLVMFuzzerTestOneInput(const unsigned char *data, size_t size);

/* libfyaml 0.7.12 loses its buffer of a very long token that ends in an error. */
const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void) { return "leak:libfyaml\n"; }

enum { MOST_CELLS = 8 }; /* looked at closely, of each study */

static const char base[] =
    "mesh: {box: {size: [1, 1, 1], cells: [1, 1, 1]}}\n"
    "material: {mu: 1, nu: 0.25, density: 1}\n"
    "time: {end: 1}\n";

static char folder[] = "/tmp/fuzz_study_XXXXXX", scenario_path[64];

static void remove_folder(void) {
  unlink(scenario_path);
  rmdir(folder);
}

int LLVMFuzzerInitialize(int *argc, char ***argv) {
  (void)argc;
  (void)argv;
  if (!mkdtemp(folder)) abort();
  snprintf(scenario_path, sizeof scenario_path, "%s/b", folder);
  FILE *file = fopen(scenario_path, "w");
  if (!file || fputs(base, file) < 0 || fclose(file) != 0) abort();
  return atexit(remove_folder);
}

static void check_text(const setting *set) {
  config *tree = calloc(1, sizeof *tree);
  const char *text;
  if (!tree || study_value_text(tree, set->value, &text)) abort();
  config_source source = {.name = "text", .text = text, .size = strlen(text)};
  config_node *again = NULL;
  if (config_parse(tree, &source, false, &again) || !again ||
      !study_same_value(set->value, again)) {
    fprintf(stderr, "%s: %s\n%s\n", set->key, text, corot_error());
    abort();
  }
  config_destroy(tree);
}

static void check_cell(const cell *c) {
  for (int i = 0; i < c->nset; i++) check_text(&c->set[i]);
  scenario *s = NULL;
  scenario_read_with(scenario_path, c->nset, c->set, &s);
  scenario_destroy(s);
}

int LLVMFuzzerTestOneInput(const unsigned char *data, size_t size) {
  if (size == 0) return 0;
  char path[64];
  snprintf(path, sizeof path, "%s/f.%s", folder, data[0] & 1 ? "json" : "yaml");
  study *s = NULL;
  if (study_read_text(path, (const char *)data + 1, size - 1, &s)) return 0;
  for (int i = 0; i < s->ncell && i < MOST_CELLS; i++) check_cell(&s->cell[i]);
  study_destroy(s);
  return 0;
}
