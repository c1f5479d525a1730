/* A folder for one test, and files in it. */
#ifndef TEMPORARY_H
#define TEMPORARY_H

#include <dirent.h>
#include <stdbool.h>
#include <stdio.h>
#include <unistd.h>

#include "check.h"

/* A new empty folder; its name is the caller's to give to remove_folder. */
static inline char *temporary_folder(void) {
  const char *base = getenv("TMPDIR");
  char name[1024];
  snprintf(name, sizeof name, "%s/corot-test-XXXXXX", base ? base : "/tmp");
  assert_non_null(mkdtemp(name));
  char *path = malloc(strlen(name) + 1);
  assert_non_null(path);
  return strcpy(path, name);
}

static inline void remove_entries(const char *path) {
  DIR *d = opendir(path);
  if (!d) return;
  for (struct dirent *entry; (entry = readdir(d));) {
    if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0) continue;
    size_t size = strlen(path) + strlen(entry->d_name) + 2;
    char *below = malloc(size);
    assert_non_null(below);
    snprintf(below, size, "%s/%s", path, entry->d_name);
    if (unlink(below) != 0) remove_entries(below);
    free(below);
  }
  closedir(d);
  rmdir(path);
}

/* With all that is in it. */
static inline void remove_folder(char *path) {
  remove_entries(path);
  free(path);
}

/* DIR/NAME in a buffer that is overwritten by the eighth call from here. */
static inline const char *in(const char *dir, const char *name) {
  static char path[8][2048];
  static int turn;
  turn = (turn + 1) % 8;
  snprintf(path[turn], sizeof path[turn], "%s/%s", dir, name);
  return path[turn];
}

static inline bool exists(const char *path) { return access(path, F_OK) == 0; }

/* The whole file and a terminator; the caller's to free. Fails the test where there is none. */
static inline char *slurp(const char *path, size_t *size) {
  FILE *f = fopen(path, "rb");
  if (!f) fail_msg("%s: cannot open it", path);
  fseek(f, 0, SEEK_END);
  long length = ftell(f);
  rewind(f);
  char *text = malloc((size_t)length + 1);
  assert_non_null(text);
  assert_int_equal(fread(text, 1, (size_t)length, f), length);
  text[length] = '\0';
  fclose(f);
  if (size) *size = (size_t)length;
  return text;
}

static inline void put_file(const char *path, const char *text) {
  FILE *f = fopen(path, "wb");
  assert_non_null(f);
  fputs(text, f);
  fclose(f);
}

#endif
