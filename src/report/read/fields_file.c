/* Finds the frames by the list in fields.pvd, and reads their arrays. */
#include "fields_file.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "app/folder/folder.h"
#include "app/folder/folder_files.h"
#include "core/mesh/read/reader.h"
#include "vtu.h"

void fields_close(fields *f) {
  free(f->t);
  free(f->file);
  free(f->text);
  free(f->x);
  free(f->tet);
  free(f->mid);
  *f = (fields){0};
}

void fields_frame_free(fields_frame *frame) {
  free(frame->displacement);
  free(frame->velocity);
  free(frame->frame);
  free(frame->von_mises);
  free(frame->det);
  free(frame->frame_at);
  free(frame->von_mises_at);
  free(frame->det_at);
  *frame = (fields_frame){0};
}

corot_status fields_frame_create(const fields *f, fields_frame *frame) {
  size_t nnode = (size_t)f->nnode, ntet = (size_t)f->ntet;
  fields_frame made = {
      .displacement = malloc(nnode * sizeof *made.displacement),
      .velocity = malloc(nnode * sizeof *made.velocity),
      .frame = malloc(ntet * sizeof *made.frame),
      .von_mises = malloc(ntet * sizeof *made.von_mises),
      .det = malloc(ntet * sizeof *made.det),
  };
  bool complete = made.displacement && made.velocity && made.frame && made.von_mises && made.det;
  if (complete && f->mid) {
    made.frame_at = malloc(ntet * sizeof *made.frame_at);
    made.von_mises_at = malloc(ntet * sizeof *made.von_mises_at);
    made.det_at = malloc(ntet * sizeof *made.det_at);
    complete = made.frame_at && made.von_mises_at && made.det_at;
  }
  if (!complete) {
    fields_frame_free(&made);
    return corot_fail(COROT_ENOMEM, "the fields of %d tets: out of memory", f->ntet);
  }
  *frame = made;
  return COROT_OK;
}

/* The text of an attribute, ended by a 0 in place of its closing quote; *at goes behind it. NULL:
   there is none. */
static char *take(char **at, const char *name) {
  char *value = strstr(*at, name);
  if (!value) return NULL;
  value += strlen(name);
  char *end = strchr(value, '"');
  if (!end) return NULL;
  *end = '\0';
  *at = end + 1;
  return value;
}

/* <DataSet timestep="T" file="fields/NAME"/> again and again. */
static corot_status parse_list(fields *f, const char *path) {
  size_t most = 0;
  for (const char *s = f->text; (s = strstr(s, "<DataSet ")); s++) most++;
  if (most > INT32_MAX) return corot_fail(COROT_EFORMAT, "%s: too many frames", path);
  f->t = malloc((most + 1) * sizeof *f->t);
  f->file = malloc((most + 1) * sizeof *f->file);
  if (!f->t || !f->file) return corot_fail(COROT_ENOMEM, "%s: out of memory", path);
  char *at = f->text;
  while ((size_t)f->nframe < most && (at = strstr(at, "<DataSet "))) {
    char *end, *t = take(&at, "timestep=\""), *file = t ? take(&at, "file=\"") : NULL;
    if (!file || strncmp(file, "fields/", 7) != 0 || strstr(file, ".."))
      return corot_fail(COROT_EFORMAT, "%s: entry %d is not as corot writes it", path, f->nframe);
    f->t[f->nframe] = strtod(t, &end);
    if (end == t || *end || !(f->t[f->nframe] - f->t[f->nframe] == 0))
      return corot_fail(COROT_EFORMAT, "%s: entry %d has the time '%s'", path, f->nframe, t);
    f->file[f->nframe++] = file;
  }
  return COROT_OK;
}

/* `per` nodes a tet, corners first. */
static corot_status take_nodes(fields *f, const vtu_file *file, int per, const int32_t *node) {
  for (size_t i = 0; i < (size_t)per * (size_t)f->ntet; i++) {
    size_t e = i / (size_t)per, k = i % (size_t)per;
    if (node[i] < 0 || node[i] >= f->nnode)
      return corot_fail(COROT_EFORMAT, "%s: tet %zu has node %d of %d", file->path, e, (int)node[i],
                        f->nnode);
    if (k < 4)
      f->tet[e][k] = node[i];
    else
      f->mid[e][k - 4] = node[i];
  }
  return COROT_OK;
}

static corot_status read_tets(fields *f, const vtu_file *file) {
  int order;
  COROT_TRY(vtu_order(file, &order));
  int per = order == 2 ? 10 : 4;
  size_t ntet = (size_t)f->ntet, n = (size_t)per * ntet;
  int32_t *node = malloc(n * sizeof *node);
  f->tet = malloc(ntet * sizeof *f->tet);
  if (order == 2) f->mid = malloc(ntet * sizeof *f->mid);
  corot_status status = COROT_OK;
  if (!node || !f->tet || (order == 2 && !f->mid))
    status = corot_fail(COROT_ENOMEM, "%s: out of memory", file->path);
  else
    status = vtu_array(file, "connectivity", "Int32", n * sizeof *node, node);
  if (status == COROT_OK) status = take_nodes(f, file, per, node);
  free(node);
  return status;
}

static corot_status read_mesh(fields *f, const vtu_file *file) {
  f->nnode = file->nnode;
  f->ntet = file->ntet;
  size_t bytes = (size_t)f->nnode * sizeof *f->x;
  f->x = malloc(bytes);
  if (!f->x) return corot_fail(COROT_ENOMEM, "%s: out of memory", file->path);
  COROT_TRY(vtu_array(file, "Points", "Float64", bytes, f->x));
  return read_tets(f, file);
}

static corot_status open_frame(const fields *f, int i, char **path, vtu_file *file) {
  char *made = folder_path(f->dir, f->file[i]);
  if (!made) return COROT_ENOMEM;
  corot_status status = vtu_open(made, file);
  if (status != COROT_OK) {
    free(made);
    return status;
  }
  *path = made;
  return COROT_OK;
}

static corot_status read_first(fields *f) {
  char *path;
  vtu_file file;
  COROT_TRY(open_frame(f, 0, &path, &file));
  corot_status status = read_mesh(f, &file);
  vtu_close(&file);
  free(path);
  return status;
}

static corot_status read_list(fields *f) {
  char *path = folder_path(f->dir, "fields.pvd");
  if (!path) return COROT_ENOMEM;
  bool there;
  size_t size;
  corot_status status = folder_look(path, &there);
  if (status == COROT_OK && there) {
    status = corot_file_load(path, &f->text, &size);
    if (status == COROT_OK) status = parse_list(f, path);
  }
  free(path);
  return status;
}

corot_status fields_open(const char *dir, fields *out) {
  fields f = {.dir = dir};
  corot_status status = read_list(&f);
  if (status == COROT_OK && f.nframe > 0) status = read_first(&f);
  if (status != COROT_OK) {
    fields_close(&f);
    return status;
  }
  *out = f;
  return COROT_OK;
}

static corot_status read_arrays(const fields *f, const vtu_file *file, fields_frame *frame) {
  size_t node = (size_t)f->nnode * sizeof(double), tet = (size_t)f->ntet * sizeof(double);
  if (file->nnode != f->nnode || file->ntet != f->ntet)
    return corot_fail(COROT_EFORMAT, "%s: not of the mesh of the first frame", file->path);
  COROT_TRY(vtu_array(file, "displacement", "Float64", 3 * node, frame->displacement));
  COROT_TRY(vtu_array(file, "velocity", "Float64", 3 * node, frame->velocity));
  COROT_TRY(vtu_array(file, "frame", "Float64", 9 * tet, frame->frame));
  COROT_TRY(vtu_array(file, "von_mises", "Float64", tet, frame->von_mises));
  COROT_TRY(vtu_array(file, "det", "Float64", tet, frame->det));
  if (!f->mid) return COROT_OK;
  COROT_TRY(vtu_array(file, "frame_points", "Float64", 36 * tet, frame->frame_at));
  COROT_TRY(vtu_array(file, "von_mises_points", "Float64", 4 * tet, frame->von_mises_at));
  return vtu_array(file, "det_points", "Float64", 4 * tet, frame->det_at);
}

corot_status fields_read(const fields *f, int i, fields_frame *frame) {
  char *path;
  vtu_file file;
  bool lost; /* which opening it says */
  if (f->result) COROT_TRY(folder_verify_file(f->dir, f->result, f->file[i], &lost));
  COROT_TRY(open_frame(f, i, &path, &file));
  corot_status status = read_arrays(f, &file, frame);
  vtu_close(&file);
  free(path);
  return status;
}
