#include "save.h"

#include <stdlib.h>

#include "folder.h"
#include "json_text.h"

corot_status save_text(const char *path, save_writer *write, const void *what) {
  char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  if (!out) return corot_fail(COROT_ENOMEM, "%s: out of memory", path);
  json_text_starved(); /* from here on */
  corot_status status = write(what, out);
  int failed = ferror(out) || json_text_starved();
  failed |= fclose(out) || !text; /* with no memory to fit it in, it says nothing */
  if (status == COROT_OK && failed) status = corot_fail(COROT_ENOMEM, "%s: out of memory", path);
  if (status == COROT_OK) status = file_replace_durably(path, text, size);
  free(text);
  return status;
}
