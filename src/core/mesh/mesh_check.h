/* What the files that check a mesh share. */
#ifndef COROT_CORE_MESH_MESH_CHECK_H
#define COROT_CORE_MESH_MESH_CHECK_H

#include "mesh.h"

#define FLAT 1e-12 /* a volume up to this times the longest edge cubed is none */

typedef struct check {
  const corot_mesh *mesh;
  const corot_mesh_names *names;
  corot_mesh_place *place;
} check;

static inline long long node_name(const check *c, int i) {
  return c->names->node_tag ? c->names->node_tag[i] : i;
}

static inline long long tet_name(const check *c, int e) {
  return c->names->tet_tag ? c->names->tet_tag[e] : e;
}

/* Remembers where the fault is; the value is what is being checked, for messages. */
static inline const char *at_node(const check *c, int i) {
  *c->place = (corot_mesh_place){PLACE_NODE, i};
  return "node";
}

static inline const char *at_tet(const check *c, int e) {
  *c->place = (corot_mesh_place){PLACE_TET, e};
  return c->names->tet;
}

/* Whether the nodes on the edges of a mesh of order 2 are there, and on one edge each. */
corot_status corot_check_middles(const check *c);

/* Whether tet e of order 2, whose longest edge is `edge`, is not turned inside out. */
corot_status corot_check_map(const check *c, int e, double edge);

#endif
