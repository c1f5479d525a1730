/* The parsers of mesh files, which work on files in memory. */
#ifndef COROT_CORE_MESH_READ_MESH_READ_H
#define COROT_CORE_MESH_READ_MESH_READ_H

#include "mesh_draft.h"

/* A file in memory, `path` being what messages call it; data[size] must be 0. */
typedef struct corot_mesh_text {
  const char *path, *data;
  size_t size;
} corot_mesh_text;

/* A file that has been loaded, of the format that it has; others that it needs are looked for
   beside it. The locale must be C. */
corot_status corot_mesh_parse(const char *path, const char *data, size_t size,
                              const corot_reading *how, corot_mesh **mesh);

/* The formats. */
corot_status corot_gmsh_parse(const char *path, const char *data, size_t size,
                              const corot_reading *how, corot_mesh **mesh);
corot_status corot_inp_parse(const char *path, const char *data, size_t size,
                             const corot_reading *how, corot_mesh **mesh);
corot_status corot_medit_parse(const char *path, const char *data, size_t size,
                               const corot_reading *how, corot_mesh **mesh);
corot_status corot_medit_binary_parse(const char *path, const char *data, size_t size,
                                      const corot_reading *how, corot_mesh **mesh);
corot_status corot_vtu_parse(const char *path, const char *data, size_t size,
                             const corot_reading *how, corot_mesh **mesh);
corot_status corot_feb_parse(const char *path, const char *data, size_t size,
                             const corot_reading *how, corot_mesh **mesh);
corot_status corot_mfem_parse(const char *path, const char *data, size_t size,
                              const corot_reading *how, corot_mesh **mesh);
corot_status corot_veg_parse(const char *path, const char *data, size_t size,
                             const corot_reading *how, corot_mesh **mesh);
corot_status corot_vol_parse(const char *path, const char *data, size_t size,
                             const corot_reading *how, corot_mesh **mesh);
corot_status corot_vtk_parse(const char *path, const char *data, size_t size,
                             const corot_reading *how, corot_mesh **mesh);

/* `face` may be NULL: there are no boundary faces. */
corot_status corot_tetgen_parse(const corot_mesh_text *node, const corot_mesh_text *ele,
                                const corot_mesh_text *face, const corot_reading *how,
                                corot_mesh **mesh);

#endif
