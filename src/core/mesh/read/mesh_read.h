/* The parsers of mesh files, which work on files in memory. */
#ifndef COROT_CORE_MESH_READ_MESH_READ_H
#define COROT_CORE_MESH_READ_MESH_READ_H

#include "mesh_draft.h"

/* `path` is what messages call the file; data[size] must be 0. The locale must be C. */
corot_status corot_gmsh_parse(const char *path, const char *data, size_t size, corot_mesh **mesh);
corot_status corot_tetgen_parse(const char *node_path, const char *node_data, size_t node_size,
                                const char *ele_path, const char *ele_data, size_t ele_size,
                                corot_mesh **mesh);

#endif
