/* The same members as the structure's, in JSON. */
#include "costs_file.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/folder/folder.h"
#include "app/text/json_text.h"
#include "app/text/no_memory.h"
#include "app/text/text_stream.h"
#include "plain_file.h"

static const char *const names[] = {"operation", "made",       "solved", "incomplete",
                                    "iterated",  "aggregated", "cycled"};
enum { NNAME = sizeof names / sizeof *names };
_Static_assert(NNAME * sizeof(double) == sizeof(corot_linear_costs), "a cost has no name");

corot_status costs_file_path(char **path) {
  const char *config = getenv("XDG_CONFIG_HOME"), *home = getenv("HOME");
  bool given = config && config[0] == '/'; /* others are to be ignored, says the standard */
  *path = NULL;
  if (!given && !(home && home[0])) return COROT_OK;
  size_t size = strlen(given ? config : home) + sizeof "/.config/corot/costs.json";
  *path = malloc(size);
  if (!*path) return no_memory();
  snprintf(*path, size, "%s%s/corot/costs.json", given ? config : home, given ? "" : "/.config");
  return COROT_OK;
}

/* --- Reading --------------------------------------------------------------------------------- */

static corot_status take(const char *path, const json_t *object, corot_linear_costs *costs) {
  double value[NNAME];
  for (int k = 0; k < NNAME; k++) {
    const json_t *member = json_object_get(object, names[k]);
    value[k] = json_is_number(member) ? json_number_value(member) : NAN;
    if (!(value[k] >= 0 && isfinite(value[k])))
      return corot_fail(COROT_EFORMAT,
                        "%s: %s is not a number of nanoseconds; measure anew by 'corot tune', or "
                        "remove the file",
                        path, names[k]);
  }
  memcpy(costs, value, sizeof value);
  return COROT_OK;
}

static corot_status read_from(const char *path, corot_linear_costs *costs, bool *found) {
  char *text = NULL;
  size_t size;
  json_t *object = NULL;
  COROT_TRY(folder_look(path, found));
  if (!*found) return COROT_OK;
  COROT_TRY(plain_file_load(path, &text, &size));
  corot_status status = json_text_parse(path, text, size, &object);
  free(text);
  if (!status) status = take(path, object, costs);
  json_decref(object);
  return status;
}

corot_status costs_file_read(corot_linear_costs *costs, bool *found) {
  char *path;
  *found = false;
  COROT_TRY(costs_file_path(&path));
  corot_status status = path ? read_from(path, costs, found) : COROT_OK;
  free(path);
  return status;
}

/* --- Writing --------------------------------------------------------------------------------- */

static corot_status print(const corot_linear_costs *costs, char **text, size_t *size) {
  double value[NNAME];
  memcpy(value, costs, sizeof value);
  FILE *out = text_open(text, size);
  if (!out) return no_memory();
  fputs("{\n", out);
  for (int k = 0; k < NNAME; k++)
    fprintf(out, "  \"%s\": %.4g%s\n", names[k], value[k], k < NNAME - 1 ? "," : "");
  fputs("}\n", out);
  if (text_close(out) == 0) return COROT_OK;
  free(*text);
  return no_memory();
}

static corot_status make_folder_of(const char *path) {
  char *folder = strdup(path);
  if (!folder) return no_memory();
  *strrchr(folder, '/') = 0;
  corot_status status = folder_make(folder);
  free(folder);
  return status;
}

corot_status costs_file_write(const char *path, const corot_linear_costs *costs) {
  char *text;
  size_t size;
  COROT_TRY(make_folder_of(path));
  COROT_TRY(print(costs, &text, &size));
  corot_status status = file_replace_durably(path, text, size);
  free(text);
  return status;
}
