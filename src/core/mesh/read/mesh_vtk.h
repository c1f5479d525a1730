/* What the readers of VTK's formats share. */
#ifndef COROT_CORE_MESH_READ_MESH_VTK_H
#define COROT_CORE_MESH_READ_MESH_VTK_H

#include "mesh_draft.h"

/* A type of cell: dimension 0 is left out, a solid without nodes is refused. */
typedef struct corot_vtk_type {
  int number, dim, nnode;
  corot_draft_kind kind;
} corot_vtk_type;

corot_vtk_type corot_vtk_find_type(int type);

/* A group that is an array of 0 and 1, called group:NAME. */
typedef struct corot_vtk_group {
  char name[COROT_GROUP_NAME_MAX + 1];
  bool of_points;
  int first;    /* group of that name */
  char *member; /* [ncell] or [npoint] */
} corot_vtk_group;

/* What is known of the groups of a file. */
typedef struct corot_vtk_groups {
  int *number; /* [ncell] of the array of numbers that become groups; NULL: there is none */
  size_t n, room;
  corot_vtk_group *group;
} corot_vtk_groups;

enum { VTK_NAME_MAX = 6 + 3 * COROT_GROUP_NAME_MAX };

/* Whether an array of that name has a group, whose name it is then, or has their numbers. */
bool corot_vtk_is_group(const char *array, char name[COROT_GROUP_NAME_MAX + 1]);
bool corot_vtk_has_numbers(const char *array);

/* Adds a group, with zeroed `member` [n]. */
corot_status corot_vtk_add_group(corot_vtk_groups *g, const char *name, bool of_points, int n);

/* Names the groups in the draft, and adds the points that are in some. */
corot_status corot_vtk_begin_groups(const corot_vtk_groups *g, corot_draft *d);

void corot_vtk_groups_clear(corot_vtk_groups *g);

/* Adds cell `number`, of `node` [n], to the draft; a surface only as a member of groups.
 * COROT_EFORMAT: it is a solid of another type, or has another number of nodes. */
corot_status corot_vtk_add_cell(corot_draft *d, int number, size_t at, int type, int64_t n,
                                const int64_t *node, const corot_vtk_groups *groups);

#endif
