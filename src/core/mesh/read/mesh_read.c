/* Which format a mesh file has. */
#include "mesh_read.h"

#include <string.h>

#include "core/base/c_locale.h"

static bool has_suffix(const char *path, const char *suffix) {
  size_t n = strlen(path), m = strlen(suffix);
  return n >= m && strcmp(path + n - m, suffix) == 0;
}

/* The path with the last `cut` characters replaced. */
static corot_status change_suffix(const char *path, size_t cut, const char *suffix, char **other) {
  size_t n = strlen(path) - cut;
  COROT_TRY(COROT_ALLOC(*other, n + strlen(suffix) + 1));
  memcpy(*other, path, n);
  strcpy(*other + n, suffix);
  return COROT_OK;
}

/* A TetGen mesh, of which one of the two files has been loaded. */
static corot_status read_tetgen(const char *path, const char *data, size_t size,
                                corot_mesh **mesh) {
  bool is_node = has_suffix(path, ".node");
  char *other, *other_data;
  size_t other_size;
  COROT_TRY(change_suffix(path, is_node ? 5 : 4, is_node ? ".ele" : ".node", &other));
  corot_status status = corot_file_load(other, &other_data, &other_size);
  if (!status) {
    status = is_node ? corot_tetgen_parse(path, data, size, other, other_data, other_size, mesh)
                     : corot_tetgen_parse(other, other_data, other_size, path, data, size, mesh);
    free(other_data);
  }
  free(other);
  return status;
}

static corot_status read_any(const char *path, const char *data, size_t size, corot_mesh **mesh) {
  size_t blank = strspn(data, " \t\r\n");
  if (blank == size) return corot_fail(COROT_EFORMAT, "%s: the file is empty", path);
  if (data[blank] == '$') return corot_gmsh_parse(path, data, size, mesh);
  if (has_suffix(path, ".node") || has_suffix(path, ".ele"))
    return read_tetgen(path, data, size, mesh);
  return corot_fail(COROT_EFORMAT,
                    "%s: not a mesh file: gmsh files begin with $MeshFormat or $NOD, TetGen files "
                    "are called NAME.node and NAME.ele",
                    path);
}

corot_status corot_mesh_read(const char *path, corot_mesh **mesh) {
  char *data;
  size_t size;
  COROT_TRY(COROT_GIVEN(path));
  COROT_TRY(COROT_GIVEN(mesh));
  COROT_TRY(corot_file_load(path, &data, &size));
  corot_c_locale locale = corot_c_locale_enter();
  corot_status status = read_any(path, data, size, mesh);
  corot_c_locale_leave(locale);
  free(data);
  return status;
}
