/* Names from the settings of cells, and links by these names. */
#include "run_names.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "app/folder/folder.h"
#include "app/text/json_text.h"

/* Adds a text with what may stand in a name. */
static size_t append(char name[RUN_NAME], size_t used, const char *text) {
  static const char plain[] =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._+=,-";
  for (; *text && used + 1 < RUN_NAME; text++)
    name[used++] = (char)(strchr(plain, *text) ? *text : '_');
  name[used] = '\0';
  return used;
}

static size_t append_value(char name[RUN_NAME], size_t used, const json_t *value) {
  char number[64];
  if (json_is_string(value)) return append(name, used, json_string_value(value));
  if (json_is_number(value)) {
    snprintf(number, sizeof number, "%.6g", json_number_value(value));
    return append(name, used, number);
  }
  char *text = json_text_dump_plain(value, JSON_COMPACT);
  if (text) used = append(name, used, text);
  free(text);
  return used;
}

static const char *last_part(const char *key) {
  const char *dot = strrchr(key, '.');
  return dot ? dot + 1 : key;
}

/* Its last part, unless another column has the same. */
static const char *short_key(const manifest *m, const char *key) {
  int count = 0;
  for (int i = 0; i < m->ncolumn; i++)
    count += strcmp(last_part(m->column[i]), last_part(key)) == 0;
  return count > 1 ? key : last_part(key);
}

void cell_name(const manifest *m, int index, char name[RUN_NAME]) {
  const char *key;
  json_t *value;
  size_t used = 0;
  name[0] = '\0';
  json_object_foreach((json_t *)m->cell[index].settings, key, value) {
    if (used > 0) used = append(name, used, ",");
    used = append(name, used, short_key(m, key));
    used = append_value(name, append(name, used, "="), value);
  }
}

void reference_name(const manifest *m, int reference, int which, char name[RUN_NAME]) {
  char number[32];
  snprintf(number, sizeof number, "reference-%d-", reference);
  append(name, append(name, 0, number), m->reference[reference].method[which]);
}

void run_name(const manifest *m, int run, char name[RUN_NAME]) {
  append(name, 0, m->run[run].id);
  for (int i = 0; i < m->ncell; i++)
    if (m->cell[i].run == run) {
      cell_name(m, i, name);
      return;
    }
  for (int i = 0; i < m->nreference; i++)
    for (int k = 0; k < 2; k++)
      if (m->reference[i].run[k] == run) reference_name(m, i, k, name);
}

/* --- Links --- */

static bool is_right(const char *path, const char *target) {
  char text[64];
  ssize_t size = readlink(path, text, sizeof text);
  return size == (ssize_t)strlen(target) && memcmp(text, target, (size_t)size) == 0;
}

static void link_one(const char *dir, const char *name, const study_run *run) {
  char target[64];
  struct stat info;
  char *path = folder_path(dir, name);
  snprintf(target, sizeof target, "../runs/%s", run->id);
  if (path && symlink(target, path) != 0 && errno == EEXIST && !is_right(path, target) &&
      lstat(path, &info) == 0 && S_ISLNK(info.st_mode) && unlink(path) == 0 &&
      symlink(target, path) != 0)
    errno = 0; /* a convenience only */
  free(path);
}

void names_link(const manifest *m, const char *dir) {
  char name[RUN_NAME];
  char *names = folder_path(dir, "names");
  if (names && (mkdir(names, 0777) == 0 || errno == EEXIST)) {
    for (int i = 0; i < m->ncell; i++) {
      cell_name(m, i, name);
      link_one(names, name, &m->run[m->cell[i].run]);
    }
    for (int i = 0; i < 2 * m->nreference; i++) {
      reference_name(m, i / 2, i % 2, name);
      link_one(names, name, &m->run[m->reference[i / 2].run[i % 2]]);
    }
  }
  free(names);
}
