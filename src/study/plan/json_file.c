/* Reading and writing of whole documents. */
#include "json_file.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/folder/folder.h"
#include "app/text/json_text.h"
#include "app/text/text_stream.h"

/* All of a file, the caller's to free: jansson's own reading takes it byte by byte. */
static corot_status read_text(FILE *file, const char *path, char **text, size_t *size) {
  long end = fseek(file, 0, SEEK_END) == 0 ? ftell(file) : -1;
  if (end < 0) return corot_fail(COROT_EIO, "%s: cannot read: %s", path, strerror(errno));
  rewind(file);
  *text = malloc((size_t)end + 1);
  if (!*text) return corot_fail(COROT_ENOMEM, "%s: out of memory", path);
  *size = fread(*text, 1, (size_t)end, file);
  if (ferror(file)) return corot_fail(COROT_EIO, "%s: cannot read: %s", path, strerror(errno));
  return COROT_OK;
}

corot_status json_file_read(const char *path, json_t **out) {
  COROT_TRY(file_check_regular(path));
  FILE *file = fopen(path, "re");
  if (!file) return corot_fail(COROT_EIO, "%s: cannot open it: %s", path, strerror(errno));
  char *text = NULL;
  size_t size = 0;
  corot_status status = read_text(file, path, &text, &size);
  fclose(file);
  if (status == COROT_OK) status = json_text_parse(path, text, size, out);
  free(text);
  return status;
}

corot_status json_file_write(const char *dir, const char *name, const json_t *value) {
  char *path = folder_path(dir, name), *text = NULL;
  size_t size = 0;
  FILE *out = path ? text_open(&text, &size) : NULL;
  corot_status status = COROT_OK;
  bool written = out && json_text_write(value, out) == COROT_OK && !json_text_starved();
  if (text_close(out) != 0 || !written)
    status = corot_fail(COROT_ENOMEM, "%s/%s: out of memory", dir, name);
  if (status == COROT_OK) status = file_replace_durably(path, text, size);
  free(text);
  free(path);
  return status;
}
