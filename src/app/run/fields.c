/* A frame every so many moments, and of the last. */
#include "fields.h"

#include <stdlib.h>
#include <string.h>

#include "app/folder/write_groups.h"
#include "app/folder/write_vtu.h"
#include "app/scenario/field_frames.h"

typedef struct fields {
  const corot_model *model;
  int every; /* moments; of equilibria, whose number is not known before, each if nobody says */
  bool thinned;
  vtu *file;
} fields;

static bool wants_fields(const scenario *s) { return s->write_fields; }

void fields_number_materials(const corot_model_def *def, const corot_mesh *mesh, int *material) {
  for (int i = 0; i < def->nmaterial; i++)
    if (!def->material[i].group)
      for (int e = 0; e < mesh->ntet; e++) material[e] = i;
  for (int i = 0; i < def->nmaterial; i++) {
    const char *name = def->material[i].group;
    const corot_group *group = name ? corot_mesh_find_group(mesh, name) : NULL;
    for (int k = 0; group && k < group->ntet; k++) material[group->tet[k]] = i;
  }
}

static corot_status close_fields(void *writer) {
  fields *f = writer;
  corot_status status = f->file ? vtu_finish(f->file) : COROT_OK;
  vtu_destroy(f->file);
  free(f);
  return status;
}

static corot_status begin(fields *f, const writer_source *source) {
  const corot_mesh *mesh = corot_model_mesh(f->model);
  int *material = calloc((size_t)mesh->ntet, sizeof *material);
  if (!material) return corot_fail(COROT_ENOMEM, "%s/fields: out of memory", source->dir);
  fields_number_materials(&source->scenario->model, mesh, material);
  vtu_data data = source->scenario->compress_fields ? VTU_ZLIB : VTU_RAW;
  corot_status status = source->from
                            ? vtu_resume(source->dir, mesh, material, data, source->from, &f->file)
                            : vtu_create(source->dir, mesh, material, data, &f->file);
  free(material);
  COROT_TRY(status);
  return source->from ? COROT_OK : groups_write(source->dir, source->scenario->resolved, mesh);
}

static corot_status open_fields(const writer_source *source, void **writer) {
  const field_frames frames = field_frames_of(source->scenario, corot_model_mesh(source->model));
  fields *f = calloc(1, sizeof *f);
  if (!f) return corot_fail(COROT_ENOMEM, "%s/fields: out of memory", source->dir);
  *f = (fields){.model = source->model, .every = frames.every, .thinned = frames.thinned};
  corot_status status = begin(f, source);
  if (status != COROT_OK) {
    close_fields(f);
    return status;
  }
  *writer = f;
  return COROT_OK;
}

static corot_status pack_fields(void *writer, pack *p) {
  return vtu_pack(((fields *)writer)->file, p);
}

static corot_status synchronise_fields(void *writer) {
  return vtu_synchronise(((fields *)writer)->file);
}

static corot_status cut_fields(void *writer) { return vtu_cut(((fields *)writer)->file); }

static bool is_due(const fields *f, const moment *now) {
  bool each = now->still && f->thinned;
  return now->last || each || now->number % f->every == 0;
}

static corot_status evaluate_fields(void *writer, const moment *now) {
  fields *f = writer;
  if (!is_due(f, now)) return COROT_OK;
  vtu_fields value = vtu_arrays(f->file);
  corot_element_fields of_tets = {
      .frame = value.frame,
      .strain = value.strain,
      .von_mises = value.von_mises,
      .det = value.det,
      .frame_at = value.frame_at,
      .strain_at = value.strain_at,
      .von_mises_at = value.von_mises_at,
      .det_at = value.det_at,
  };
  return corot_elements(f->model, now->state, now->t, now->u, &of_tets);
}

static corot_status write_fields(void *writer, const moment *now) {
  fields *f = writer;
  if (!is_due(f, now)) return COROT_OK;
  vtu_fields value = vtu_arrays(f->file);
  size_t nnode = (size_t)corot_model_mesh(f->model)->nnode;
  memcpy(value.displacement, now->displacement, nnode * sizeof *value.displacement);
  memcpy(value.velocity, now->velocity, nnode * sizeof *value.velocity);
  return vtu_write(f->file, now->t);
}

const writer_ops fields_writer = {
    .file = "fields.pvd",
    .wanted = wants_fields,
    .open = open_fields,
    .evaluate = evaluate_fields,
    .moment = write_fields,
    .pack = pack_fields,
    .synchronise = synchronise_fields,
    .cut = cut_fields,
    .close = close_fields,
};
