/* Finds the files in the resolved scenario, and gives them names. */
#define _XOPEN_SOURCE 700 /* realpath */
#include "resources.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/config/config.h"
#include "app/text/json_text.h"
#include "app/text/no_memory.h"

static const char scenario_name[] = "scenario.json";

/* --- Names --- */

static const char *base_of(const char *path) {
  const char *slash = strrchr(path, '/');
  return slash ? slash + 1 : path;
}

static bool is_taken(const resources *r, const char *name) {
  if (strcmp(name, scenario_name) == 0) return true;
  for (int i = 0; i < r->n; i++)
    if (strcmp(r->file[i].name, name) == 0) return true;
  return false;
}

static corot_status add(resources *r, const char *path, const char *name) {
  if (r->n == r->room) {
    int room = r->room ? 2 * r->room : 8;
    resource *file = realloc(r->file, (size_t)room * sizeof *file);
    if (!file) return no_memory();
    r->file = file;
    r->room = room;
  }
  resource *made = &r->file[r->n++];
  *made = (resource){strdup(path), strdup(name)};
  return made->path && made->name ? COROT_OK : no_memory();
}

/* TetGen's meshes are two files of one name: the other one, if this is of the kind; else NULL. */
static const char *other_suffix(const char *path) {
  size_t n = strlen(path);
  if (n > 5 && strcmp(path + n - 5, ".node") == 0) return ".ele";
  if (n > 4 && strcmp(path + n - 4, ".ele") == 0) return ".node";
  return NULL;
}

static corot_status add_other(resources *r, const char *path, const char *name) {
  const char *suffix = other_suffix(path);
  if (!suffix) return COROT_OK;
  char *file = malloc(strlen(path) + 8), *called = malloc(strlen(name) + 8);
  corot_status status = file && called ? COROT_OK : no_memory();
  if (!status) {
    strcpy(file, path), strcpy(strrchr(file, '.'), suffix);
    strcpy(called, name), strcpy(strrchr(called, '.'), suffix);
    status = add(r, file, called);
  }
  free(file);
  free(called);
  return status;
}

/* The name under which a file goes: its own, with a number before it where that is taken. */
static corot_status name_file(resources *r, const char *path, char **name) {
  const char *base = base_of(path);
  size_t size = strlen(base) + 16;
  for (int i = 0; i < r->n; i++)
    if (strcmp(r->file[i].path, path) == 0) {
      *name = strdup(r->file[i].name);
      return *name ? COROT_OK : no_memory();
    }
  char *made = malloc(size);
  if (!made) return no_memory();
  snprintf(made, size, "%s", base);
  for (int k = 2; is_taken(r, made); k++) snprintf(made, size, "%d_%s", k, base);
  corot_status status = add(r, path, made);
  if (status == COROT_OK) status = add_other(r, path, made);
  if (status)
    free(made);
  else
    *name = made;
  return status;
}

/* --- The scenario --- */

static corot_status take_file(const scenario *s, json_t *object, const char *key, resources *r) {
  char *name;
  const char *path =
      config_beside(s->source, s->path, json_string_value(json_object_get(object, key)));
  if (!path) return no_memory();
  COROT_TRY(name_file(r, path, &name));
  int failed = json_object_set_new(object, key, json_text_string(name));
  free(name);
  return failed ? no_memory() : COROT_OK;
}

/* Whatever is called `file` and is a text; and the marks of the mesh. */
static corot_status take_files(const scenario *s, json_t *value, resources *r) {
  const char *key;
  json_t *inside;
  void *next;
  size_t i;
  json_array_foreach(value, i, inside) COROT_TRY(take_files(s, inside, r));
  json_object_foreach_safe(value, next, key, inside) {
    bool file = strcmp(key, "file") == 0 || strcmp(key, "marks") == 0;
    if (file && json_is_string(inside))
      COROT_TRY(take_file(s, value, key, r));
    else
      COROT_TRY(take_files(s, inside, r));
  }
  return COROT_OK;
}

static corot_status find(const scenario *s, json_t *copy, resources *r) {
  if (!copy) return no_memory();
  json_object_del(copy, "quantities"); /* names there are free, and their values texts */
  json_object_del(copy, "compare");
  json_object_del(copy, "output");
  COROT_TRY(take_files(s, copy, r));
  size_t size;
  FILE *out = open_memstream(&r->scenario, &size);
  if (!out) return no_memory();
  corot_status status = json_text_write(copy, out);
  fputc('\n', out);
  bool failed = ferror(out);
  if (fclose(out) != 0 || failed || json_text_starved()) return no_memory();
  return status;
}

corot_status resources_find(const scenario *s, resources *r) {
  *r = (resources){0};
  json_t *copy = json_deep_copy(s->resolved);
  corot_status status = find(s, copy, r);
  json_decref(copy);
  if (status) resources_clear(r);
  return status;
}

void resources_clear(resources *r) {
  for (int i = 0; i < r->n; i++) {
    free(r->file[i].path);
    free(r->file[i].name);
  }
  free(r->file);
  free(r->scenario);
  *r = (resources){0};
}

/* --- On the disk --- */

static corot_status refused(const char *path) {
  return corot_fail(COROT_EIO, "%s: cannot write: %s", path, strerror(errno));
}

/* DIR/NAME; the caller's. NULL: no memory. */
static char *inside(const char *dir, const char *name) {
  size_t size = strlen(dir) + strlen(name) + 2;
  char *path = malloc(size);
  if (path) snprintf(path, size, "%s/%s", dir, name);
  return path;
}

static corot_status write_scenario(const resources *r, const char *dir) {
  char *path = inside(dir, scenario_name);
  if (!path) return no_memory();
  FILE *out = fopen(path, "w");
  bool written = out && fputs(r->scenario, out) != EOF;
  if (out && fclose(out) != 0) written = false;
  corot_status status = written ? COROT_OK : refused(path);
  free(path);
  return status;
}

static corot_status link_file(const resource *file, const char *dir) {
  char *target = realpath(file->path, NULL), *path = inside(dir, file->name);
  corot_status status = path ? COROT_OK : no_memory();
  if (!status && !target)
    status = corot_fail(COROT_EIO, "%s: cannot read: %s", file->path, strerror(errno));
  if (!status && symlink(target, path) != 0) status = refused(path);
  free(target);
  free(path);
  return status;
}

corot_status resources_lay_out(const resources *r, const char *dir) {
  COROT_TRY(write_scenario(r, dir));
  for (int i = 0; i < r->n; i++) COROT_TRY(link_file(&r->file[i], dir));
  return COROT_OK;
}

/* By names alone: where there is no memory left, nothing is to be left on the disk. */
void resources_take_away(const resources *r, const char *dir) {
  int fd = open(dir, O_RDONLY | O_DIRECTORY);
  if (fd >= 0) {
    unlinkat(fd, scenario_name, 0);
    for (int i = 0; i < r->n; i++) unlinkat(fd, r->file[i].name, 0);
    close(fd);
  }
  rmdir(dir);
}
