#include "json_file.h"

#include <app/folder.h>
#include <app/json_text.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

corot_status json_file_read(const char *path, json_t **out) {
  FILE *file = fopen(path, "re");
  if (!file) return corot_fail(COROT_EIO, "%s: cannot open it: %s", path, strerror(errno));
  json_error_t error;
  json_t *value = json_loadf(file, 0, &error);
  bool unread = ferror(file);
  fclose(file);
  if (unread) {
    json_decref(value);
    return corot_fail(COROT_EIO, "%s: cannot read it", path);
  }
  if (!value)
    return corot_fail(COROT_EFORMAT, "%s:%d:%d: %s", path, error.line, error.column, error.text);
  *out = value;
  return COROT_OK;
}

corot_status json_file_write(const char *dir, const char *name, const json_t *value) {
  char *path = folder_path(dir, name), *text = NULL;
  size_t size = 0;
  FILE *out = path ? open_memstream(&text, &size) : NULL;
  corot_status status = COROT_OK;
  if (out) json_text_write(value, out);
  if (!out || fclose(out) != 0)
    status = corot_fail(COROT_ENOMEM, "%s/%s: out of memory", dir, name);
  if (status == COROT_OK) status = file_replace_durably(path, text, size);
  free(text);
  free(path);
  return status;
}

json_t *json_file_real(double x) { return isfinite(x) ? json_real(x) : json_null(); }
