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

/* What an element is beside a point, a line, a triangle or a tet. */
typedef enum corot_draft_kind {
  DRAFT_SIMPLEX,
  DRAFT_QUAD,
  DRAFT_PYRAMID, /* base 0 1 2 3, which winds inward as seen from below, apex 4 */
  DRAFT_PRISM,   /* triangles 0 1 2 and 3 4 5, one above the other */
  DRAFT_HEX,     /* quads 0 1 2 3 and 4 5 6 7, one above the other */
  DRAFT_KINDS    /* how many */
} corot_draft_kind;

typedef struct corot_draft_element {
  int64_t tag;
  size_t at;
  int dim;     /* 0 point, 1 line, 2 triangle or quad, 3 tet or another solid */
  int node[4]; /* indices of the corners, of solids with more than four the first; -1: there is no
                  such node, which has been noted */
  int middle;  /* where its other nodes begin in corot_draft.middle, from 1; 0: it has no others.
                  A simplex has them on its edges, another solid the rest of its corners */
  corot_draft_kind kind;
} corot_draft_element;

enum { NMIDDLE_MAX = 6 };

/* How many edges a simplex has, and how many corners an element. */
static inline int corot_draft_nedge(int dim) { return dim * (dim + 1) / 2; }
int corot_draft_ncorner(const corot_draft_element *e);

/* Where the k-th node of an element goes; those beyond `node` are in middle [NMIDDLE_MAX]. */
static inline int *corot_draft_slot(corot_draft_element *e, int *middle, int k) {
  int n = e->kind ? 4 : e->dim + 1;
  return k < n ? &e->node[k] : &middle[k - n];
}

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

/* How a file is read beside what is in it, and what has been mended. */
typedef struct corot_reading {
  bool mends;                /* what is only written down wrongly */
  bool cuts;                 /* solids other than tets, into tets */
  double merge;              /* nodes no further apart become one [m]; 0: none */
  double scale;              /* of the coordinates, to be metres; 0: as 1 */
  corot_mesh_report *report; /* what has been done; given if anything may be */
} corot_reading;

/* A face of a solid that has been cut. */
typedef struct corot_draft_quad {
  int v[4];    /* in turn, the lowest first: it is cut from v[0] to v[2] */
  int64_t tag; /* of the solid */
  size_t at;
} corot_draft_quad;

/* Zero is an empty draft. */
typedef struct corot_draft {
  const corot_reading *how; /* NULL: nothing is mended */
  corot_mesh_faults faults;
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
  int *middle; /* [nmiddle] indices or -1: of a tet on the edges 01 12 02 03 13 23, of a triangle 01
                * 12 20
                */

  size_t nquad, quad_room;
  corot_draft_quad *quad;

  size_t nmember, member_room;
  corot_draft_member *member; /* elements ascending */

  size_t nname, name_room;
  corot_draft_name *name;
} corot_draft;

void corot_draft_clear(corot_draft *d);

/* Notes what is wrong in the file, with the place before it. */
#define corot_draft_note(d, file, place, ...)                                                     \
  (corot_faults_tell(&(d)->faults) ? (void)corot_reader_fail(file, place, __VA_ARGS__) : (void)0, \
   corot_faults_add(&(d)->faults))

/* Room for n nodes, which the caller fills in; then the index of their tags. It is noted if a tag
   is negative or occurs twice. */
corot_status corot_draft_alloc_nodes(corot_draft *d, int n);
corot_status corot_draft_index_nodes(corot_draft *d);

/* How messages call an element: where faces have a file, they have numbers of their own. */
static inline const char *corot_draft_word(const corot_draft *d, const corot_draft_element *e) {
  return e->dim == 2 && d->face_file ? "face" : "element";
}

/* COROT_EFORMAT with the place of the element before the message. */
#define corot_draft_fail(d, element, ...) \
  corot_reader_fail(corot_draft_file(d, element), (element)->at, __VA_ARGS__)

/* The file that an element is in. */
static inline const corot_reader *corot_draft_file(const corot_draft *d,
                                                   const corot_draft_element *e) {
  return e->dim == 2 && d->face_file ? d->face_file : d->element_file;
}

/* The index of a node; -1 if there is none, which is noted with the element's name. */
void corot_draft_find_node(corot_draft *d, const corot_draft_element *element, int64_t tag,
                           int *index);

/* Whether some of its nodes do not exist. */
bool corot_draft_is_broken(const corot_draft *d, const corot_draft_element *e);

/* Appends a node, before the index is made. */
corot_status corot_draft_add_node(corot_draft *d, corot_draft_node node, const double x[3]);

/* Makes room for one more item of `size` bytes. */
corot_status corot_make_room(void **items, size_t n, size_t *room, size_t size);

/* Append; physical 0 is no group. COROT_EINVAL: not a name for a group. `middle`: the element's
   nodes beyond `node`, on edges or other corners, NULL if it has none. COROT_EFORMAT: a tet is not
   of the order of those before. */
corot_status corot_draft_add_element(corot_draft *d, const corot_draft_element *element,
                                     const int *middle);
corot_status corot_draft_add_member(corot_draft *d, int element, int physical);
corot_status corot_draft_add_name(corot_draft *d, int dim, int physical, const char *name);

/* Merges nodes, and cuts what is no simplex, as far as is asked for; notes what is left of solids
   other than tets. Adds to the report. */
corot_status corot_draft_merge(corot_draft *d);
corot_status corot_draft_cut(corot_draft *d);

/* Notes quads at which the tets on the other side have the other diagonal. */
void corot_draft_match_quads(corot_draft *d, int nface, const corot_face *face);

/* Notes lines and triangles in groups that are not of the order of the tets. */
void corot_draft_check_orders(corot_draft *d);

/* Notes tets that have the nodes on their edges in another order than is expected. */
void corot_draft_check_middles(corot_draft *d);

/* Finds the order in which all tets of a file list the nodes on their edges, where these are, and
   puts them into ours. COROT_EFORMAT: it is not one order. */
corot_status corot_draft_order_middles(corot_draft *d);

/* Turns all tets round if all are left-handed: of formats that do not say how a tet is wound. */
void corot_draft_turn_all(corot_draft *d);

/* Turns left-handed tets round, if that is asked for. */
corot_status corot_draft_turn(corot_draft *d);

/* Which elements become tets: tet[e] is the tet's number, or -1 for what is none. What is repeated
   for several groups is one, and what is there twice, if that is to be mended. */
corot_status corot_draft_number_tets(corot_draft *d, int *tet, int *ntet);

/* Drops the nodes that are in no solid, if that is asked for. */
corot_status corot_draft_drop_unused(corot_draft *d);

/* Adds a remark to the report; `count` things have been mended so. COROT_ENOMEM. */
corot_status corot_draft_remark(corot_draft *d, corot_mended what, int count, const char *format,
                                ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 4, 5)))
#endif
    ;

/* The first of the numbers that are shown of a list. */
typedef struct corot_draft_list {
  int n;
  char text[200];
} corot_draft_list;

/* Adds "7" to the list "1, 2"; beyond eight it is "...". */
void corot_draft_list_add(corot_draft_list *list, int64_t number);

/* The mesh that the draft describes, its groups in the order of their names, then the nameless
   ones by dimension and number. COROT_EFORMAT: it is not sound; all faults are told. */
corot_status corot_draft_finish(corot_draft *d, corot_mesh **mesh);

/* What a reader returns: `status`, where it is a failure with the faults that were noted before it.
 */
corot_status corot_draft_end(corot_draft *d, corot_status status);

/* The groups of a draft whose nodes and tets have become `mesh`. `face` are its sorted faces,
   `tet` [nelement] the tet that each element became. */
corot_status corot_draft_groups(corot_draft *d, const int *tet, const corot_face *face,
                                corot_mesh *mesh);

/* Places of nodes or elements by their numbers in a file. */
typedef struct corot_by_tag {
  int64_t tag;
  int index;
} corot_by_tag;

/* Ascending; equal numbers by their places. */
void corot_by_tag_sort(corot_by_tag *s, int n);

/* The first of the sorted numbers that is not below `tag`. */
int corot_by_tag_first(const corot_by_tag *s, int n, int64_t tag);

#endif
