/* Mesh files that are strings. */
#ifndef MESH_TEXT_H
#define MESH_TEXT_H

#include "check.h"
#include "core/mesh/read/mesh_read.h"

#define TEXT(path, text) (&(corot_mesh_text){path, text, strlen(text)})

/* What becomes of `text` when `from` is replaced once by `to`. */
static inline char *edit_text(const char *text, const char *from, const char *to) {
  const char *at = strstr(text, from);
  if (!at) fail_msg("'%s' is not in the text", from);
  size_t head = (size_t)(at - text), size = strlen(text) + strlen(to) + 1;
  char *edited = malloc(size);
  assert_non_null(edited);
  memcpy(edited, text, head);
  strcpy(edited + head, to);
  strcat(edited, at + strlen(from));
  return edited;
}

#endif
