/* *INCLUDE: the text of an Abaqus file with that of the files it includes. */
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "mesh_inp.h"

enum { DEPTH_MAX = 8, FILES_MAX = 200 };

bool corot_inp_same(const char *a, const char *b) {
  for (;; a++, b++) {
    char p = *a >= 'a' && *a <= 'z' ? (char)(*a - 32) : *a,
         q = *b >= 'a' && *b <= 'z' ? (char)(*b - 32) : *b;
    if (p != q) return false;
    if (!p) return true;
  }
}

static corot_status append(corot_inp_text *t, const char *from, size_t n) {
  if (t->size + n + 1 > t->room) {
    size_t more = 2 * t->room > t->size + n + 1 ? 2 * t->room : t->size + n + 1;
    char *p = realloc(t->data, more);
    if (!p) return corot_fail(COROT_ENOMEM, "out of memory: %zu bytes for a file", more);
    t->data = p;
    t->room = more;
  }
  if (n > 0) memcpy(t->data + t->size, from, n);
  t->size += n;
  t->data[t->size] = 0;
  return COROT_OK;
}

/* What is appended from now on is from that line of that file. */
static corot_status begin_piece(corot_inp_text *t, const char *path, long line) {
  void *items = t->piece;
  COROT_TRY(corot_make_room(&items, t->npiece, &t->piece_room, sizeof *t->piece));
  t->piece = items;
  t->piece[t->npiece++] = (corot_reader_piece){t->size, path, line};
  return COROT_OK;
}

/* A path relative to the folder of the file that names it; the text owns it. */
static corot_status join(corot_inp_text *t, const char *base, const char *name, size_t n,
                         const char **path) {
  const char *slash = strrchr(base, '/');
  size_t folder = slash && name[0] != '/' ? (size_t)(slash - base) + 1 : 0;
  void *items = t->path;
  char *p;
  COROT_TRY(corot_make_room(&items, t->npath, &t->path_room, sizeof *t->path));
  t->path = items;
  COROT_TRY(COROT_ALLOC(p, folder + n + 1));
  memcpy(p, base, folder);
  memcpy(p + folder, name, n);
  t->path[t->npath++] = p;
  *path = p;
  return COROT_OK;
}

/* The name behind INPUT= on the line from `line` to `end`: its length, 0 if it is none. */
static size_t find_input(const char *line, const char *end, const char **name) {
  const char *p = memchr(line, '=', (size_t)(end - line));
  if (!p) return 0;
  for (p++; p < end && strchr(" \t\"'", *p);) p++;
  while (end > p && strchr(" \t\r\"',", end[-1])) end--;
  *name = p;
  return (size_t)(end - p);
}

static corot_status expand(corot_inp_text *t, const char *path, const char *data, size_t size,
                           int depth);

static corot_status include(corot_inp_text *t, const char *path, long number, const char *line,
                            const char *end, int depth) {
  const char *name, *included;
  char *data;
  size_t size, n = find_input(line, end, &name);
  struct stat info;
  if (n == 0)
    return corot_fail(COROT_EFORMAT, "%s:%ld: expected *INCLUDE, INPUT=FILE", path, number);
  if (depth == DEPTH_MAX || t->npath == FILES_MAX)
    return corot_fail(COROT_EFORMAT, "%s:%ld: files include each other too often", path, number);
  COROT_TRY(join(t, path, name, n, &included));
  if (stat(included, &info) != 0 || !S_ISREG(info.st_mode))
    return corot_fail(COROT_EFORMAT, "%s:%ld: the included file '%s' does not exist", path, number,
                      included);
  COROT_TRY(corot_reader_load(included, &data, &size));
  corot_status status = expand(t, included, data, size, depth + 1);
  free(data);
  return status;
}

static bool is_include(const char *line, const char *end) {
  char word[9];
  while (line < end && (*line == ' ' || *line == '\t')) line++;
  if (end - line < 8) return false;
  memcpy(word, line, 8);
  word[8] = 0;
  return corot_inp_same(word, "*INCLUDE");
}

static corot_status expand(corot_inp_text *t, const char *path, const char *data, size_t size,
                           int depth) {
  const char *end = data + size, *done = data, *next;
  long number = 1;
  COROT_TRY(begin_piece(t, path, 1));
  for (const char *line = data; line < end; line = next, number++) {
    const char *stop = memchr(line, '\n', (size_t)(end - line));
    next = stop ? stop + 1 : end;
    if (!is_include(line, next)) continue;
    COROT_TRY(append(t, done, (size_t)(line - done)));
    COROT_TRY(include(t, path, number, line, stop ? stop : end, depth));
    COROT_TRY(begin_piece(t, path, number + 1));
    done = next;
  }
  COROT_TRY(append(t, done, (size_t)(end - done)));
  return append(t, "\n", 1);
}

corot_status corot_inp_expand(const char *path, const char *data, size_t size,
                              corot_inp_text *text) {
  return expand(text, path, data, size, 0);
}

void corot_inp_text_clear(corot_inp_text *text) {
  for (size_t i = 0; i < text->npath; i++) free(text->path[i]);
  free(text->path);
  free(text->piece);
  free(text->data);
  memset(text, 0, sizeof *text);
}
