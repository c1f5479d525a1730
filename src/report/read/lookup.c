/* Takes a path apart at its points. */
#include "lookup.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/folder/folder.h"
#include "app/text/json_text.h"

const json_t *lookup(const json_t *at, const char *path) {
  while (at && *path) {
    char key[64];
    size_t length = strcspn(path, ".");
    snprintf(key, sizeof key, "%.*s", (int)length, path);
    at = json_object_get(at, key);
    path += length + (path[length] == '.');
  }
  return at;
}

double lookup_number(const json_t *document, const char *path) {
  const json_t *value = lookup(document, path);
  return json_is_number(value) ? json_number_value(value) : NAN;
}

const char *lookup_text(const json_t *document, const char *path) {
  const char *text = json_string_value(lookup(document, path));
  return text ? text : "";
}

static corot_status load(const char *path, json_t **document) {
  json_error_t where;
  COROT_TRY(file_check_regular(path));
  json_text_starved(); /* from here on */
  json_t *root = json_load_file(path, JSON_REJECT_DUPLICATES, &where);
  if (!root && json_error_code(&where) == json_error_cannot_open_file)
    return corot_fail(COROT_EIO, "%s: %s", path, strerror(errno));
  if (json_text_starved()) {
    json_decref(root);
    return corot_fail(COROT_ENOMEM, "%s: out of memory", path);
  }
  if (!root)
    return corot_fail(COROT_EFORMAT, "%s:%d:%d: %s", path, where.line, where.column, where.text);
  if (!json_is_object(root)) {
    json_decref(root);
    return corot_fail(COROT_EFORMAT, "%s: not a map", path);
  }
  *document = root;
  return COROT_OK;
}

corot_status lookup_read(const char *dir, const char *name, json_t **document) {
  char *path = folder_path(dir, name);
  if (!path) return COROT_ENOMEM;
  corot_status status = load(path, document);
  free(path);
  return status;
}
