/* A mesh as a file states it: tags instead of indices, elements of all dimensions in one list,
   nothing known to be sound. The readers fill a draft, which then becomes a mesh. */
#ifndef COROT_CORE_MESH_READ_MESH_DRAFT_H
#define COROT_CORE_MESH_READ_MESH_DRAFT_H

#include "core/mesh/mesh.h"
#include "reader.h"

typedef struct corot_draft_node {
  int64_t tag; /* its number in the file */
  size_t at;   /* its place in the file */
} corot_draft_node;

typedef struct corot_draft_element {
  int64_t tag;
  size_t at;
  int dim;     /* 0 point, 1 line, 2 triangle, 3 tet: dim + 1 corners */
  int node[4]; /* indices of the corners */
  int middle;  /* where its nodes on edges begin in corot_draft.middle, from 1; 0: it has none */
} corot_draft_element;

enum { NMIDDLE_MAX = 6 };

/* How many edges an element has. */
static inline int corot_draft_nedge(int dim) { return dim * (dim + 1) / 2; }

/* That an element is in a group, which is known by its elements' dimension and a number. */
typedef struct corot_draft_member {
  int element;
  int physical; /* not 0; negative: the element's orientation is reversed in this group */
} corot_draft_member;

typedef struct corot_draft_name {
  int dim, physical; /* of the group, physical > 0 */
  int order;         /* among the names */
  char text[COROT_GROUP_NAME_MAX + 1];
} corot_draft_name;

/* Zero is an empty draft. */
typedef struct corot_draft {
  const corot_reader *node_file, *element_file; /* for messages */
  const corot_reader *face_file; /* of triangles; NULL: they are in the file of the elements */
  bool repeats;                  /* an element in several groups is listed once for each */
  bool raises;             /* triangles may lack the nodes on their edges, which the tets have */
  const char *unused_hint; /* if there are no groups: why a node may be in no tet */

  int nnode;
  size_t node_room, x_room; /* of nodes that are added one by one */
  double (*x)[3];
  corot_draft_node *node;   /* [nnode] */
  corot_draft_node *by_tag; /* [nnode] ascending tags, `at` being the index; NULL: tags are
                               consecutive */

  size_t nelement, element_room;
  corot_draft_element *element;
  int order; /* of the tets; 0: there is none yet */

  size_t nmiddle, middle_room;
  int *middle; /* [nmiddle] indices: of a tet on the edges 01 12 02 03 13 23, of a triangle 01 12 20
                */

  size_t nmember, member_room;
  corot_draft_member *member; /* elements ascending */

  size_t nname, name_room;
  corot_draft_name *name;
} corot_draft;

void corot_draft_clear(corot_draft *d);

/* Room for n nodes, which the caller fills in; then the index of their tags.
   COROT_EFORMAT: a tag is negative or occurs twice. */
corot_status corot_draft_alloc_nodes(corot_draft *d, int n);
corot_status corot_draft_index_nodes(corot_draft *d);

/* How messages call an element: where faces have a file, they have numbers of their own. */
static inline const char *corot_draft_word(const corot_draft *d, const corot_draft_element *e) {
  return e->dim == 2 && d->face_file ? "face" : "element";
}

/* COROT_EFORMAT with the place of the element before the message. */
#define corot_draft_fail(d, element, ...)                                                       \
  corot_reader_fail((element)->dim == 2 && (d)->face_file ? (d)->face_file : (d)->element_file, \
                    (element)->at, __VA_ARGS__)

/* The index of a node. COROT_EFORMAT, naming the element, if there is none. */
corot_status corot_draft_find_node(const corot_draft *d, const corot_draft_element *element,
                                   int64_t tag, int *index);

/* Appends a node, before the index is made. */
corot_status corot_draft_add_node(corot_draft *d, corot_draft_node node, const double x[3]);

/* Makes room for one more item of `size` bytes. */
corot_status corot_make_room(void **items, size_t n, size_t *room, size_t size);

/* Append; physical 0 is no group. COROT_EINVAL: not a name for a group. `middle`: the element's
   nodes on edges, NULL if it is of order 1. COROT_EFORMAT: a tet is not of the order of those
   before. */
corot_status corot_draft_add_element(corot_draft *d, const corot_draft_element *element,
                                     const int *middle);
corot_status corot_draft_add_member(corot_draft *d, int element, int physical);
corot_status corot_draft_add_name(corot_draft *d, int dim, int physical, const char *name);

/* Whether all lines and triangles in groups are of the order of the tets. COROT_EFORMAT. */
corot_status corot_draft_check_orders(const corot_draft *d);

/* Whether the nodes on the tets' edges are in the order that is expected. COROT_EFORMAT. */
corot_status corot_draft_check_middles(const corot_draft *d);

/* Finds the order in which all tets of a file list the nodes on their edges, where these are, and
   puts them into ours. COROT_EFORMAT: it is not one order. */
corot_status corot_draft_order_middles(corot_draft *d);

/* The mesh that the draft describes, its groups in the order of their names, then the nameless
   ones by dimension and number. COROT_EFORMAT: it is not sound. */
corot_status corot_draft_finish(corot_draft *d, corot_mesh **mesh);

/* The groups of a draft whose nodes and tets have become `mesh`. `face` are its sorted faces,
   `tet` [nelement] the tet that each element became. */
corot_status corot_draft_groups(corot_draft *d, const int *tet, const corot_face *face,
                                corot_mesh *mesh);

#endif
