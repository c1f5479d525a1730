/* A stream in memory, written to its file when it is complete. */
#include "save.h"

#include <stdlib.h>

#include "app/folder/folder.h"
#include "app/text/json_text.h"
#include "app/text/text_stream.h"

corot_status save_text(const char *path, save_writer *write, const void *what) {
  char *text = NULL;
  size_t size = 0;
  FILE *out = text_open(&text, &size);
  if (!out) return corot_fail(COROT_ENOMEM, "%s: out of memory", path);
  json_text_starved(); /* from here on */
  corot_status status = write(what, out);
  int failed = json_text_starved();
  failed |= text_close(out);
  if (status == COROT_OK && failed) status = corot_fail(COROT_ENOMEM, "%s: out of memory", path);
  if (status == COROT_OK) status = file_replace_durably(path, text, size);
  free(text);
  return status;
}
