/* The formats of mesh files that are written, and how files are: beside what is there, first. */
#include "mesh_write.h"

#include <errno.h>
#include <stdarg.h>
#include <string.h>
#include <sys/stat.h>

#include "core/base/c_locale.h"

enum { PARTS_MAX = 3 };

/* A format: its files, which have the suffixes, and who writes them; of the first suffix that fits
   a path the row is taken. */
typedef struct mesh_format {
  const char *name;
  struct {
    const char *suffix;
    corot_status (*write)(corot_writing *w);
  } part[PARTS_MAX];
} mesh_format;

static const mesh_format formats[] = {
    {"gmsh", {{".msh", corot_write_gmsh_4}}},
    {"gmsh-2.2", {{".msh", corot_write_gmsh_2}}},
    {"vtu", {{".vtu", corot_write_vtu}}},
    {"vtk", {{".vtk", corot_write_vtk}}},
    {"tetgen",
     {{".node", corot_write_tetgen_node},
      {".ele", corot_write_tetgen_ele},
      {".face", corot_write_tetgen_face}}},
    {"medit", {{".mesh", corot_write_medit}}},
    {"abaqus", {{".inp", corot_write_inp}}},
};

enum { NFORMAT = sizeof formats / sizeof *formats };

/* --- What writers share --- */

int corot_writing_triangle(const corot_writing *w, const int tri[3], int v[6]) {
  for (int k = 0; k < 3; k++) {
    v[k] = tri[k];
    if (w->mesh->mid)
      v[3 + k] = w->edges.middle[corot_edges_find(&w->edges, tri[k], tri[(k + 1) % 3])];
  }
  return w->mesh->mid ? 6 : 3;
}

int corot_writing_tet(const corot_writing *w, int e, int v[10]) {
  memcpy(v, w->mesh->tet[e], sizeof *w->mesh->tet);
  if (!w->mesh->mid) return 4;
  memcpy(v + 4, w->mesh->mid[e], sizeof *w->mesh->mid);
  return 10;
}

static void mark_held(const corot_writing *w, const corot_group *g, char value, char *mark) {
  int v[10];
  for (int i = 0; i < g->ntri; i++) {
    int n = corot_writing_triangle(w, g->tri[i], v);
    for (int k = 0; k < n; k++) mark[v[k]] = value;
  }
  for (int i = 0; i < g->ntet; i++) {
    int n = corot_writing_tet(w, g->tet[i], v);
    for (int k = 0; k < n; k++) mark[v[k]] = value;
  }
}

int corot_writing_loose(const corot_writing *w, const corot_group *g, char *mark, int *loose) {
  int n = 0;
  mark_held(w, g, 1, mark);
  for (int i = 0; i < g->nnode; i++)
    if (!mark[g->node[i]]) loose[n++] = g->node[i];
  mark_held(w, g, 0, mark);
  return n;
}

corot_status corot_writing_lose(corot_writing *w, int count, const char *format, ...) {
  char text[700];
  va_list args;
  if (!w->report) return COROT_OK;
  va_start(args, format);
  vsnprintf(text, sizeof text, format, args);
  va_end(args);
  return corot_report_add(w->report, COROT_MENDED_LOST, count, text);
}

/* --- Files --- */

/* A new file beside `path`, with a name of its own: `temporary` [size]. */
static FILE *open_temporary(const char *path, char *temporary, size_t size) {
  FILE *f = NULL;
  for (int i = 0; i < 100 && !f; i++) {
    snprintf(temporary, size, "%s.tmp%d", path, i);
    f = fopen(temporary, "wx");
    if (!f && errno != EEXIST) return NULL;
  }
  return f;
}

/* A link, a device or a folder of that name stays what it is. */
static corot_status check_place(const char *path) {
  struct stat info;
  if (lstat(path, &info) != 0 || S_ISREG(info.st_mode)) return COROT_OK;
  return corot_fail(COROT_EIO, "%s: is not a regular file, and stays as it is", path);
}

/* A file that is to be: its name, and the one it has until all are written. */
typedef struct part {
  char *path, *temporary; /* malloc'd */
  bool written;
} part;

static corot_status name_part(const char *path, size_t stem, const char *suffix, part *p) {
  size_t size = stem + strlen(suffix) + 16;
  COROT_TRY(COROT_ALLOC(p->path, size));
  COROT_TRY(COROT_ALLOC(p->temporary, size));
  snprintf(p->path, size, "%.*s%s", (int)stem, path, suffix);
  return check_place(p->path);
}

static corot_status write_part(corot_writing *w, corot_status (*write)(corot_writing *w), part *p) {
  size_t size = strlen(p->path) + 16;
  w->file = open_temporary(p->path, p->temporary, size);
  if (!w->file) return corot_fail(COROT_EIO, "%s: %s", p->path, strerror(errno));
  p->written = true;
  corot_status status = write(w);
  int error = fflush(w->file) != 0 || ferror(w->file) ? errno : 0;
  if (fclose(w->file) != 0 && !error) error = errno;
  if (!status && error) return corot_fail(COROT_EIO, "%s: %s", p->path, strerror(error));
  return status;
}

static bool ends_with(const char *path, const char *suffix) {
  size_t n = strlen(path), m = strlen(suffix);
  return n > m && strcmp(path + n - m, suffix) == 0;
}

/* The length of a path without the suffix that it has of a format; all of it, if it has none. */
static size_t stem_of(const char *path, const mesh_format *f) {
  for (int i = 0; i < PARTS_MAX && f->part[i].write; i++)
    if (ends_with(path, f->part[i].suffix)) return strlen(path) - strlen(f->part[i].suffix);
  return strlen(path);
}

/* The whole name stays where a format has one file, whatever its suffix. */
static corot_status name_parts(const char *path, const mesh_format *f, part p[PARTS_MAX]) {
  if (!f->part[1].write) return name_part(path, strlen(path), "", &p[0]);
  for (int i = 0; i < PARTS_MAX && f->part[i].write; i++)
    COROT_TRY(name_part(path, stem_of(path, f), f->part[i].suffix, &p[i]));
  return COROT_OK;
}

static corot_status write_parts(corot_writing *w, const char *path, const mesh_format *f) {
  part p[PARTS_MAX] = {0};
  corot_status status = name_parts(path, f, p);
  for (int i = 0; i < PARTS_MAX && f->part[i].write && !status; i++)
    status = write_part(w, f->part[i].write, &p[i]);
  for (int i = 0; i < PARTS_MAX && p[i].written && !status; i++) {
    if (rename(p[i].temporary, p[i].path) == 0)
      p[i].written = false;
    else
      status = corot_fail(COROT_EIO, "%s: %s", p[i].path, strerror(errno));
  }
  for (int i = 0; i < PARTS_MAX; i++) {
    if (p[i].written) remove(p[i].temporary);
    free(p[i].path);
    free(p[i].temporary);
  }
  return status;
}

static corot_status write_mesh(const corot_mesh *mesh, const char *path, const mesh_format *f,
                               corot_mesh_report *report) {
  corot_writing w = {.mesh = mesh, .report = report};
  corot_status status = mesh->mid ? corot_edges_list(mesh, &w.edges) : COROT_OK;
  if (!status) {
    corot_c_locale locale = corot_c_locale_enter();
    status = write_parts(&w, path, f);
    corot_c_locale_leave(locale);
  }
  corot_edges_clear(&w.edges);
  free(w.tet_number);
  free(w.node_number);
  free(w.face_number);
  free(w.face);
  return status;
}

corot_status corot_mesh_write(const corot_mesh *mesh, const char *path) {
  static const mesh_format gmsh_2 = {"gmsh-2.2", {{".msh", corot_write_gmsh_2}}};
  COROT_TRY(COROT_GIVEN(mesh));
  COROT_TRY(COROT_GIVEN(path));
  return write_mesh(mesh, path, &gmsh_2, NULL);
}

/* --- Formats --- */

static const mesh_format *by_name(const char *name) {
  for (int i = 0; i < NFORMAT; i++)
    if (strcmp(formats[i].name, name) == 0) return &formats[i];
  char names[200] = "";
  for (int i = 0; i < NFORMAT; i++)
    snprintf(names + strlen(names), sizeof names - strlen(names), "%s%s", i ? ", " : "",
             formats[i].name);
  corot_fail(COROT_EINVAL, "there is no mesh format '%.40s' to write: %s", name, names);
  return NULL;
}

static const mesh_format *by_suffix(const char *path) {
  for (int i = 0; i < NFORMAT; i++)
    if (stem_of(path, &formats[i]) < strlen(path)) return &formats[i];
  corot_fail(COROT_EINVAL,
             "%s: the name does not tell the format: it may end in .msh, .vtu, .vtk, .node, .ele, "
             ".mesh or .inp, or the format be named",
             path);
  return NULL;
}

const char *corot_mesh_format(const char *format_name, const char *path) {
  if (COROT_GIVEN(path) != COROT_OK) return NULL;
  const mesh_format *f = format_name ? by_name(format_name) : by_suffix(path);
  return f ? f->name : NULL;
}

corot_status corot_mesh_write_as(const corot_mesh *mesh, const char *path, const char *format_name,
                                 corot_mesh_report **report) {
  corot_mesh_report *r = NULL;
  COROT_TRY(COROT_GIVEN(mesh));
  COROT_TRY(COROT_GIVEN(path));
  const mesh_format *f = format_name ? by_name(format_name) : by_suffix(path);
  if (!f) return COROT_EINVAL;
  if (report) COROT_TRY(COROT_ALLOC(r, 1));
  corot_status status = write_mesh(mesh, path, f, r);
  if (status)
    corot_mesh_report_destroy(r);
  else if (report)
    *report = r;
  return status;
}
