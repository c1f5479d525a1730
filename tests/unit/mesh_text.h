/* Mesh files, of the folder data and as strings. */
#ifndef MESH_TEXT_H
#define MESH_TEXT_H

#include "check.h"
#include "core/mesh/read/mesh_read.h"

#define DATA SOURCE_DIR "/tests/unit/data/"

#define TEXT(path, text) (&(corot_mesh_text){path, text, strlen(text)})

static inline corot_mesh *read_mesh(const char *path) {
  corot_mesh *m = NULL;
  assert_ok(corot_mesh_read(path, &m));
  return m;
}

/* A text of whatever format. */
static inline corot_mesh *parse_text(const char *text) {
  corot_mesh *m = NULL;
  assert_ok(corot_mesh_parse("text", text, strlen(text), NULL, &m));
  return m;
}

/* Reads the file, for tests of allocations that fail. */
static inline corot_status try_read(void *path) {
  corot_mesh *m = NULL;
  corot_status status = corot_mesh_read(path, &m);
  assert_true(!status == !!m);
  corot_mesh_destroy(m);
  return status;
}

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

/* Every beginning of a text is read, or refused with a message; each in a block of just its size,
   where a sanitizer sees what reads past it. */
static inline void assert_prefixes_fail_cleanly(const char *path, const char *text, size_t size) {
  for (size_t n = 0; n <= size; n++) {
    corot_mesh *m = NULL;
    char *prefix = malloc(n + 1);
    assert_non_null(prefix);
    memcpy(prefix, text, n);
    prefix[n] = 0;
    corot_status status = corot_mesh_parse(path, prefix, n, NULL, &m);
    if (status && status != COROT_EFORMAT) fail_msg("status %d: %s", (int)status, corot_error());
    assert_true(!status == !!m);
    corot_mesh_destroy(m);
    free(prefix);
  }
}

/* The same where each byte in turn is another. */
static inline void assert_damage_fails_cleanly(const char *path, const char *text, size_t size) {
  static const char other[] = {'9', '-', ' ', ',', '\n', 0, (char)0xff};
  char *copy = malloc(size + 1);
  assert_non_null(copy);
  memcpy(copy, text, size + 1);
  for (size_t at = 0; at < size; at++)
    for (size_t k = 0; k < sizeof other; k++) {
      corot_mesh *m = NULL;
      copy[at] = other[k];
      corot_status status = corot_mesh_parse(path, copy, size, NULL, &m);
      copy[at] = text[at];
      if (status && status != COROT_EFORMAT) fail_msg("status %d: %s", (int)status, corot_error());
      assert_true(!status == !!m);
      corot_mesh_destroy(m);
    }
  free(copy);
}

/* Edits of a sound text, and the messages that they lead to. */
typedef struct text_fault {
  const char *from, *to, *message;
} text_fault;

static inline void assert_text_faults(const char *path, const char *sound, size_t n,
                                      const text_fault *fault) {
  corot_mesh *m = NULL;
  assert_ok(corot_mesh_parse(path, sound, strlen(sound), NULL, &m));
  corot_mesh_destroy(m);
  m = NULL;
  for (size_t i = 0; i < n; i++) {
    char *text = edit_text(sound, fault[i].from, fault[i].to);
    assert_fails(corot_mesh_parse(path, text, strlen(text), NULL, &m), COROT_EFORMAT,
                 fault[i].message);
    assert_null(m);
    free(text);
  }
}

#endif
