/* What the readers of the gmsh formats share. */
#ifndef COROT_CORE_MESH_READ_MESH_GMSH_H
#define COROT_CORE_MESH_READ_MESH_GMSH_H

#include "mesh_draft.h"

/* A geometric entity of format 4 and the physical groups it is in. */
typedef struct corot_gmsh_entity {
  int dim, tag;
  int first, count; /* range of `physical` */
} corot_gmsh_entity;

typedef struct corot_gmsh {
  corot_reader r;
  corot_draft d;
  int version; /* 1, 2 or 4; 0: not known yet */
  bool is_4_0; /* version 4 is 4.0, not 4.1 */
  bool binary;
  bool has_nodes, has_elements, has_entities, has_partitions;

  size_t nentity, entity_room;
  corot_gmsh_entity *entity; /* [nentity] by dim, then tag */
  size_t nphysical, physical_room;
  int *physical; /* [nphysical] negative: reversed orientation */
} corot_gmsh;

/* A type of element. */
typedef struct corot_gmsh_type {
  int number, dim, nnode;
  const char *name;
} corot_gmsh_type;

/* Fails for a type that is not known, and for solids other than tets of 4 or 10 nodes. */
corot_status corot_gmsh_find_type(const corot_gmsh *g, const corot_draft_element *element,
                                  int number, const corot_gmsh_type **type);

/* Begins the numbers of a section, which are binary if the file is. */
corot_status corot_gmsh_start_data(corot_gmsh *g);

/* The number of a node or element: 8 bytes in format 4.1, 4 before, of any size in text. */
corot_status corot_gmsh_tag(corot_gmsh *g, const char *what, int64_t *tag);

/* Reads an element's nodes and, unless it is of a type to be ignored, adds it to the draft, as a
   member of the groups `physical` [n], 0 being none. */
corot_status corot_gmsh_add_element(corot_gmsh *g, corot_draft_element *element,
                                    const corot_gmsh_type *type, int n, const int *physical);

/* The sections, from behind their first line to before their last. */
corot_status corot_gmsh_nodes_2(corot_gmsh *g);            /* 1 and 2.2 */
corot_status corot_gmsh_parametric_nodes_2(corot_gmsh *g); /* 2.2 */
corot_status corot_gmsh_elements_1(corot_gmsh *g);
corot_status corot_gmsh_elements_2(corot_gmsh *g);
corot_status corot_gmsh_entities_4(corot_gmsh *g);
corot_status corot_gmsh_partitioned_entities_4(corot_gmsh *g);
corot_status corot_gmsh_nodes_4(corot_gmsh *g);
corot_status corot_gmsh_elements_4(corot_gmsh *g);

#endif
