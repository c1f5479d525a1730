/* Loads FMUs by dlopen. */
#include "importer.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "temporary.h"

const char *fmu_path(const char *name) {
  static char path[4][4096];
  static int next;
  char *made = path[next++ % 4];
  snprintf(made, sizeof path[0], FMUS "/%s", name);
  return made;
}

static char *join(const char *a, const char *b) {
  char *text = malloc(strlen(a) + strlen(b) + 1);
  assert_non_null(text);
  return strcat(strcpy(text, a), b);
}

/* The value of an attribute from `at` on, up to the end of the element. */
static void attribute(const char *at, const char *name, size_t size, char *value) {
  char key[80];
  snprintf(key, sizeof key, " %s=\"", name);
  const char *found = strstr(at, key), *end = strchr(at, '>');
  if (!found || found > end) fail_msg("no attribute %s in %.60s", name, at);
  found += strlen(key);
  snprintf(value, size, "%.*s", (int)strcspn(found, "\""), found);
}

static void find_function(void *library, const char *name, void *function) {
  void *found = dlsym(library, name);
  if (!found) fail_msg("the FMU has no %s", name);
  memcpy(function, &found, sizeof found);
}

static void open_library(fmu *f) {
  char path[4096];
#if defined(__aarch64__)
  const char *platform = "aarch64-linux";
#else
  const char *platform = "x86_64-linux";
#endif
  snprintf(path, sizeof path, "%s/binaries/%s/%s.so", f->folder, platform, f->identifier);
  f->library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
  if (!f->library) fail_msg("%s", dlerror());
#define FIND(name) find_function(f->library, "fmi3" #name, &f->name);
  FMU_FUNCTIONS(FIND)
#undef FIND
}

fmu *fmu_load(const char *folder) {
  fmu *f = calloc(1, sizeof *f);
  assert_non_null(f);
  f->folder = join(folder, "");
  f->resources = join(folder, "/resources/");
  char *path = join(folder, "/modelDescription.xml");
  f->description = slurp(path, NULL);
  free(path);
  attribute(strstr(f->description, "<fmiModelDescription"), "instantiationToken", sizeof f->token,
            f->token);
  attribute(strstr(f->description, "<CoSimulation"), "modelIdentifier", sizeof f->identifier,
            f->identifier);
  open_library(f);
  return f;
}

void fmu_unload(fmu *f) {
  dlclose(f->library);
  free(f->folder);
  free(f->resources);
  free(f->description);
  free(f);
}

/* --- Variables --- */

static const char *find_variable(const fmu *f, const char *name) {
  char key[256];
  snprintf(key, sizeof key, "<Float64 name=\"%s\"", name);
  const char *found = strstr(f->description, key);
  if (!found) fail_msg("there is no variable %s", name);
  return found;
}

fmi3ValueReference fmu_reference(const fmu *f, const char *name) {
  char text[32];
  attribute(find_variable(f, name), "valueReference", sizeof text, text);
  return (fmi3ValueReference)strtoul(text, NULL, 10);
}

size_t fmu_size(const fmu *f, const char *name) {
  static const char dimension[] = "><Dimension start=\"";
  const char *end = strchr(find_variable(f, name), '>');
  if (strncmp(end, dimension, strlen(dimension)) != 0) return 1;
  return strtoul(end + strlen(dimension), NULL, 10);
}

double fmu_get(const fmu *f, fmi3Instance instance, const char *name) {
  double value = 0;
  fmi3ValueReference reference = fmu_reference(f, name);
  assert_int_equal(f->GetFloat64(instance, &reference, 1, &value, 1), fmi3OK);
  return value;
}

void fmu_set(const fmu *f, fmi3Instance instance, const char *name, double value) {
  fmi3ValueReference reference = fmu_reference(f, name);
  assert_int_equal(f->SetFloat64(instance, &reference, 1, &value, 1), fmi3OK);
}

/* --- Instances --- */

void fmu_take_message(fmi3InstanceEnvironment environment, fmi3Status status, fmi3String category,
                      fmi3String message) {
  fmu_log *log = environment;
  log->count++;
  log->status = status;
  snprintf(log->category, sizeof log->category, "%s", category);
  snprintf(log->message, sizeof log->message, "%s", message);
}

fmi3Instance fmu_simulation(const fmu *f, fmu_log *log) {
  fmi3Instance made = f->InstantiateCoSimulation("one", f->token, f->resources, false, true, false,
                                                 false, NULL, 0, log, fmu_take_message, NULL);
  if (!made) fail_msg("%s", log->message);
  return made;
}

fmi3Instance fmu_exchange(const fmu *f, fmu_log *log) {
  fmi3Instance made = f->InstantiateModelExchange("one", f->token, f->resources, false, true, log,
                                                  fmu_take_message);
  if (!made) fail_msg("%s", log->message);
  return made;
}

double fmu_step(const fmu *f, fmi3Instance instance, double t, double step) {
  fmi3Boolean event = true, terminate = true, early = true;
  double last = -1;
  assert_int_equal(f->DoStep(instance, t, step, true, &event, &terminate, &early, &last), fmi3OK);
  assert_false(event || terminate);
  return last;
}

/* --- Tables --- */

static int count_of(const char *text, char c) {
  int n = 0;
  for (; *text; text++) n += *text == c;
  return n;
}

fmu_table fmu_read_table(const char *path) {
  char *text = slurp(path, NULL), *line = strchr(text, '\n');
  *line = '\0';
  fmu_table t = {.ncolumn = count_of(text, ',') + 1, .nrow = count_of(line + 1, '\n')};
  t.name = calloc((size_t)t.ncolumn, sizeof *t.name);
  t.value = calloc((size_t)(t.ncolumn * t.nrow), sizeof *t.value);
  assert_true(t.name && t.value);
  char *word = text;
  for (int c = 0; c < t.ncolumn; c++) {
    size_t length = strcspn(word, ",\r");
    word[length] = '\0';
    t.name[c] = join(word, "");
    word += length + 1;
  }
  word = line + 1;
  for (int i = 0; i < t.ncolumn * t.nrow; i++) t.value[i] = strtod(word, &word), word++;
  free(text);
  return t;
}

void fmu_free_table(fmu_table *t) {
  for (int c = 0; c < t->ncolumn; c++) free(t->name[c]);
  free(t->name);
  free(t->value);
}
