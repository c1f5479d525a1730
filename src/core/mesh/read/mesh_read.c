/* Which format a mesh file has. */
#include "mesh_read.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>

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

/* A file of a TetGen mesh: its path and what is in it, both to be freed. */
typedef struct companion {
  char *path, *data;
  size_t size;
} companion;

static corot_status load(const char *path, size_t cut, const char *suffix, companion *c) {
  COROT_TRY(change_suffix(path, cut, suffix, &c->path));
  return corot_reader_load(c->path, &c->data, &c->size);
}

/* The same, but it may be missing: `data` is NULL then. */
static corot_status load_if_there(const char *path, size_t cut, const char *suffix, companion *c) {
  struct stat info;
  COROT_TRY(change_suffix(path, cut, suffix, &c->path));
  if (stat(c->path, &info) != 0 && errno == ENOENT) return COROT_OK;
  return corot_reader_load(c->path, &c->data, &c->size);
}

/* A TetGen mesh, of which one of the files has been loaded: NAME.node or NAME.ele. */
static corot_status read_tetgen(const char *path, const char *data, size_t size,
                                const corot_reading *how, corot_mesh **mesh) {
  bool is_node = has_suffix(path, ".node");
  size_t cut = is_node ? 5 : 4;
  companion other = {0}, face = {0};
  corot_status status = load(path, cut, is_node ? ".ele" : ".node", &other);
  if (!status) status = load_if_there(path, cut, ".face", &face);
  if (!status) {
    const corot_mesh_text given = {path, data, size}, found = {other.path, other.data, other.size},
                          faces = {face.path, face.data, face.size};
    status = corot_tetgen_parse(is_node ? &given : &found, is_node ? &found : &given,
                                face.data ? &faces : NULL, how, mesh);
  }
  free(other.path);
  free(other.data);
  free(face.path);
  free(face.data);
  return status;
}

/* `text` is where the file's first character stands that is not blank; there are `size` bytes, and
   a 0 behind them. */
static bool is_gmsh(const char *path, const char *text, size_t size) {
  (void)path, (void)size;
  return *text == '$';
}

/* Comments may come first. */
static bool is_medit(const char *path, const char *text, size_t size) {
  (void)size;
  static const char word[] = "MeshVersionFormatted";
  return strncmp(text, word, sizeof word - 1) == 0 ||
         (has_suffix(path, ".mesh") && *text == '#' && strstr(text, word));
}

/* A 1 of four bytes and a version, both of one byte order. */
static bool is_medit_binary(const char *path, const char *text, size_t size) {
  (void)path;
  if (size < 8) return false;
  const char *version = text[0] ? text + 4 : text + 7;
  static const char zeros[3] = {0};
  bool little = text[0] == 1 && memcmp(text + 1, zeros, 3) == 0 && memcmp(text + 5, zeros, 3) == 0,
       big = text[3] == 1 && memcmp(text, zeros, 3) == 0 && memcmp(text + 4, zeros, 3) == 0;
  return (little || big) && *version >= 1 && *version <= 4;
}

static bool is_inp(const char *path, const char *text, size_t size) {
  (void)path, (void)size;
  return *text == '*';
}

static bool is_vtk(const char *path, const char *text, size_t size) {
  (void)path, (void)size;
  return strncmp(text, "# vtk DataFile", 14) == 0;
}

static bool is_vtu(const char *path, const char *text, size_t size) {
  (void)path, (void)size;
  return *text == '<' && strstr(text, "<VTKFile");
}

static bool is_feb(const char *path, const char *text, size_t size) {
  (void)path, (void)size;
  return *text == '<' && strstr(text, "<febio_spec");
}

/* Comments may come first. */
static bool is_vol(const char *path, const char *text, size_t size) {
  (void)size;
  return strncmp(text, "mesh3d", 6) == 0 ||
         (has_suffix(path, ".vol") && *text == '#' && strstr(text, "mesh3d"));
}

static bool is_mfem(const char *path, const char *text, size_t size) {
  (void)path, (void)size;
  return strncmp(text, "MFEM mesh v1.", 13) == 0;
}

/* Comments may come first, and VegaFEM's other keywords. */
static bool is_veg(const char *path, const char *text, size_t size) {
  (void)size;
  return strncmp(text, "*VERTICES", 9) == 0 ||
         (has_suffix(path, ".veg") && (*text == '#' || *text == '*') && strstr(text, "*VERTICES"));
}

static bool is_tetgen(const char *path, const char *text, size_t size) {
  (void)text, (void)size;
  return has_suffix(path, ".node") || has_suffix(path, ".ele");
}

/* The formats; what is first recognized decides. */
static const struct {
  bool (*recognize)(const char *path, const char *text, size_t size);
  corot_status (*parse)(const char *path, const char *data, size_t size, const corot_reading *how,
                        corot_mesh **mesh);
} formats[] = {
    {is_gmsh, corot_gmsh_parse},   {is_vtk, corot_vtk_parse},
    {is_medit, corot_medit_parse}, {is_medit_binary, corot_medit_binary_parse},
    {is_veg, corot_veg_parse},     {is_inp, corot_inp_parse},
    {is_vtu, corot_vtu_parse},     {is_feb, corot_feb_parse},
    {is_vol, corot_vol_parse},     {is_mfem, corot_mfem_parse},
    {is_tetgen, read_tetgen},
};

corot_status corot_mesh_parse(const char *path, const char *data, size_t size,
                              const corot_reading *how, corot_mesh **mesh) {
  const char *text = data + strspn(data, " \t\r\n");
  if (text == data + size) return corot_fail(COROT_EFORMAT, "%s: the file is empty", path);
  for (size_t i = 0; i < sizeof formats / sizeof *formats; i++)
    if (formats[i].recognize(path, text, (size_t)(data + size - text)))
      return formats[i].parse(path, data, size, how, mesh);
  return corot_fail(COROT_EFORMAT,
                    "%s: not a mesh file: gmsh files begin with $MeshFormat or $NOD, MEDIT files "
                    "with MeshVersionFormatted, or a 1 and a version if they are binary, Abaqus "
                    "files with *, VTK files with # vtk "
                    "DataFile or have a tag VTKFile, FEBio files have a tag febio_spec, Netgen "
                    "files with mesh3d, MFEM files with "
                    "MFEM mesh v1, VegaFEM files with *VERTICES, TetGen files are called "
                    "NAME.node and NAME.ele",
                    path);
}

static corot_status read_file(const char *path, const corot_reading *how, corot_mesh **mesh) {
  char *data;
  size_t size;
  COROT_TRY(corot_reader_load(path, &data, &size));
  corot_c_locale locale = corot_c_locale_enter();
  corot_status status = corot_mesh_parse(path, data, size, how, mesh);
  corot_c_locale_leave(locale);
  free(data);
  return status;
}

corot_status corot_mesh_read(const char *path, corot_mesh **mesh) {
  COROT_TRY(COROT_GIVEN(path));
  COROT_TRY(COROT_GIVEN(mesh));
  return read_file(path, NULL, mesh);
}

corot_status corot_mesh_read_mended(const char *path, const corot_mending *mending,
                                    corot_mesh **mesh, corot_mesh_report **report) {
  corot_mesh_report *r;
  corot_mesh *m;
  COROT_TRY(COROT_GIVEN(path));
  COROT_TRY(COROT_GIVEN(mesh));
  COROT_TRY(COROT_GIVEN(report));
  if (mending && !(mending->merge >= 0 && mending->merge <= 1e100))
    return corot_fail(COROT_EINVAL, "merge is %g, not >= 0", mending->merge);
  if (mending && !(mending->scale >= 0 && mending->scale <= 1e100))
    return corot_fail(COROT_EINVAL, "scale is %g, not >= 0", mending->scale);
  COROT_TRY(COROT_ALLOC(r, 1));
  const corot_reading how = {.mends = true,
                             .cuts = mending && mending->cut,
                             .merge = mending ? mending->merge : 0,
                             .scale = mending ? mending->scale : 0,
                             .report = r};
  corot_status status = read_file(path, &how, &m);
  if (status) {
    corot_mesh_report_destroy(r);
    return status;
  }
  *mesh = m;
  *report = r;
  return COROT_OK;
}
