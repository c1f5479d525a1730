#include "save.h"

#include <stdlib.h>

#include "folder.h"

corot_status save_text(const char *path, save_writer *write, const void *what) {
  char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  if (!out) return corot_fail(COROT_ENOMEM, "%s: out of memory", path);
  write(what, out);
  int failed = ferror(out);
  failed |= fclose(out);
  corot_status status = failed ? corot_fail(COROT_ENOMEM, "%s: out of memory", path)
                               : file_replace_durably(path, text, size);
  free(text);
  return status;
}
