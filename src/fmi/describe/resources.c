/* Finds the files in the resolved scenario, and gives them names. */
#define _XOPEN_SOURCE 700 /* realpath */
#include "resources.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "app/config/config.h"
#include "app/text/json_text.h"
#include "app/text/no_memory.h"
#include "core/mesh/read/mesh_inp.h"

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
  *made = (resource){.path = strdup(path), .name = strdup(name)};
  return made->path && made->name ? COROT_OK : no_memory();
}

/* --- Files that belong to a mesh --- */

/* NAME.node, NAME.ele and, if it is there, NAME.face are one mesh of TetGen's. */
static const char *const tetgen[] = {".node", ".ele", ".face"};
enum { TETGEN = sizeof tetgen / sizeof *tetgen };

static bool ends_with(const char *path, const char *suffix) {
  size_t n = strlen(path), m = strlen(suffix);
  return n > m && strcmp(path + n - m, suffix) == 0;
}

static corot_status add_companion(resources *r, const char *path, const char *name,
                                  const char *suffix) {
  char *file = malloc(strlen(path) + 8), *called = malloc(strlen(name) + 8);
  corot_status status = file && called ? COROT_OK : no_memory();
  if (!status) {
    strcpy(file, path), strcpy(strrchr(file, '.'), suffix);
    strcpy(called, name), strcpy(strrchr(called, '.'), suffix);
    if (access(file, F_OK) == 0) status = add(r, file, called);
  }
  free(file);
  free(called);
  return status;
}

static corot_status add_companions(resources *r, const char *path, const char *name) {
  if (!ends_with(path, tetgen[0]) && !ends_with(path, tetgen[1])) return COROT_OK;
  for (int k = 0; k < TETGEN; k++)
    if (!ends_with(path, tetgen[k])) COROT_TRY(add_companion(r, path, name, tetgen[k]));
  return COROT_OK;
}

/* An Abaqus file takes what it includes along: in its place. */
static corot_status expand_mesh(resource *mesh) {
  char *data;
  size_t size;
  corot_inp_text text = {0};
  COROT_TRY(corot_reader_load(mesh->path, &data, &size));
  corot_status status = COROT_OK;
  if (data[strspn(data, " \t\r\n")] == '*') {
    status = corot_inp_expand(mesh->path, data, size, &text);
    if (status == COROT_OK && text.npath > 0) {
      mesh->data = text.data, mesh->size = text.size;
      text.data = NULL;
    }
  }
  corot_inp_text_clear(&text);
  free(data);
  return status;
}

/* The name under which a file goes: its own, with a number before it where that is taken. */
static corot_status name_file(const scenario *s, resources *r, const char *path, char **name) {
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
  if (status == COROT_OK && s->mesh_file && strcmp(path, s->mesh_file) == 0)
    status = expand_mesh(&r->file[r->n - 1]);
  if (status == COROT_OK) status = add_companions(r, path, made);
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
  COROT_TRY(name_file(s, r, path, &name));
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
  if (fclose(out) != 0 || failed || !r->scenario || json_text_starved()) return no_memory();
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
    free(r->file[i].data);
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

static corot_status write_file(const char *dir, const char *name, const char *data, size_t size) {
  char *path = inside(dir, name);
  if (!path) return no_memory();
  unlink(path);
  FILE *out = fopen(path, "w");
  bool written = out && fwrite(data, 1, size, out) == size;
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
  if (!status) unlink(path);
  if (!status && symlink(target, path) != 0) status = refused(path);
  free(target);
  free(path);
  return status;
}

corot_status resources_lay_out(const resources *r, const char *dir) {
  if (mkdir(dir, 0777) != 0 && errno != EEXIST) return refused(dir);
  COROT_TRY(write_file(dir, scenario_name, r->scenario, strlen(r->scenario)));
  for (int i = 0; i < r->n; i++) {
    const resource *f = &r->file[i];
    COROT_TRY(f->data ? write_file(dir, f->name, f->data, f->size) : link_file(f, dir));
  }
  return COROT_OK;
}

/* By names alone: where there is no memory left, nothing is to be left on the disk. */
corot_status resources_take_away(const resources *r, const char *dir) {
  int fd = open(dir, O_RDONLY | O_DIRECTORY);
  bool gone = fd >= 0 && unlinkat(fd, scenario_name, 0) == 0;
  for (int i = 0; fd >= 0 && i < r->n; i++)
    if (unlinkat(fd, r->file[i].name, 0) != 0) gone = false;
  if (fd >= 0) close(fd);
  if (rmdir(dir) == 0 && gone) return COROT_OK;
  return corot_fail(COROT_EIO, "%s: cannot remove: %s", dir, strerror(errno));
}

void resources_abandon(const resources *r, const char *dir) {
  char reason[1024];
  snprintf(reason, sizeof reason, "%s", corot_error());
  if (resources_take_away(r, dir)) corot_fail(COROT_EIO, "%s", reason);
}
