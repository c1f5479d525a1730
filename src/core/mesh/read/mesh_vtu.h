/* What the reader of VTK's XML files of unstructured grids shares with what decodes their arrays.
 */
#ifndef COROT_CORE_MESH_READ_MESH_VTU_H
#define COROT_CORE_MESH_READ_MESH_VTU_H

#include "mesh_vtk.h"
#include "xml_tags.h"

typedef enum corot_vtu_section {
  VTU_POINTS,
  VTU_CELLS,
  VTU_POINT_DATA,
  VTU_CELL_DATA
} corot_vtu_section;

/* A DataArray, as its tag has it. */
typedef struct corot_vtu_array {
  char name[VTK_NAME_MAX + 1];
  corot_vtu_section section;
  corot_xml_tag tag;
} corot_vtu_array;

typedef struct corot_vtu {
  corot_reader r;
  corot_draft d;
  corot_vtk_groups groups;
  int64_t npoint, ncell;
  bool swap, wide, compressed; /* the other byte order; lengths of 8 bytes; by zlib */
  bool appended_base64;
  size_t appended; /* where appended data begin; 0: there are none */
  size_t narray, array_room;
  corot_vtu_array *array;
} corot_vtu;

/* The numbers of an array, as double or int64_t: *n of them, which the caller frees. An array of
   reals that is asked for whole numbers is refused. COROT_EFORMAT, COROT_ENOMEM. */
corot_status corot_vtu_reals(const corot_vtu *v, const corot_vtu_array *a, double **value,
                             size_t *n);
corot_status corot_vtu_wholes(const corot_vtu *v, const corot_vtu_array *a, int64_t **value,
                              size_t *n);

#endif
