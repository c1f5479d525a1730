/* What the files that check a mesh share. */
#ifndef COROT_CORE_MESH_MESH_CHECK_H
#define COROT_CORE_MESH_MESH_CHECK_H

#include "mesh.h"

#define FLAT 1e-12 /* a volume up to this times the longest edge cubed is none */

typedef struct check {
  const corot_mesh *mesh;
  const corot_mesh_names *names;
  corot_mesh_faults *faults;
  char *bad_node; /* [nnode] its coordinates are no numbers, or too large */
  char *bad_tet;  /* [ntet] 1: its corners are not four nodes, nothing more is asked of it; 2: its
                     volume is wrong, it is not asked on which side of a face it is */
} check;

static inline long long node_name(const check *c, int i) {
  return c->names->node_tag ? c->names->node_tag[i] : i;
}

static inline long long tet_name(const check *c, int e) {
  return c->names->tet_tag ? c->names->tet_tag[e] : e;
}

/* Notes that something is wrong with node or tet `index`. */
void corot_check_found(const check *c, corot_mesh_place place, int index, const char *format, ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 4, 5)))
#endif
    ;

/* Whether the nodes on the edges of a mesh of order 2 are there, and on one edge each. *sound: a
   tet's map can be asked for. COROT_ENOMEM. */
corot_status corot_check_middles(const check *c, bool *sound);

/* Whether tet e of order 2, whose longest edge is `edge`, is not turned inside out. */
void corot_check_map(const check *c, int e, double edge);

#endif
