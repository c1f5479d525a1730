/* What the parts of the reader of FEBio's .feb share. */
#ifndef COROT_CORE_MESH_READ_MESH_FEB_H
#define COROT_CORE_MESH_READ_MESH_FEB_H

#include "mesh_draft.h"
#include "xml_tags.h"

typedef enum corot_feb_of { FEB_NODES, FEB_ELEMENTS, FEB_FACES } corot_feb_of;

/* An element, or a face of a surface. */
typedef struct corot_feb_element {
  int64_t tag;
  size_t at;
  int dim; /* 2 or 3; 0: a shell or the like, which is left out */
  corot_draft_kind kind;
  int nnode;
  int64_t node[10]; /* [nnode] their numbers */
  int name;         /* of the group, from 1; 0: none */
  int index;        /* in the draft */
} corot_feb_element;

/* Members of a set: the numbers from `first` to `last` by `step`, or places in the file's order. */
typedef struct corot_feb_item {
  int name; /* from 1 */
  corot_feb_of of;
  size_t at;
  bool by_index;
  int64_t first, last, step;
} corot_feb_item;

typedef struct corot_feb_name {
  char text[COROT_GROUP_NAME_MAX + 1];
} corot_feb_name;

typedef struct corot_feb {
  corot_reader r;
  corot_draft d;
  size_t nelement, element_room;
  corot_feb_element *element;
  size_t nface, face_room;
  corot_feb_element *face;
  size_t nname, name_room;
  corot_feb_name *name;
  size_t nitem, item_room;
  corot_feb_item *item;
  size_t nmember; /* how many have been looked at */
} corot_feb;

/* Whether another number stands before the next tag; if so, goes there. */
bool corot_feb_more(corot_feb *f);

/* Such a number, and the comma behind it. */
corot_status corot_feb_long(corot_feb *f, const char *what, int64_t *value);

/* The number of a group's name, from 1; 0 if it is empty. COROT_EFORMAT, with the place of the tag:
   it is not a name for a group, or there are too many. */
corot_status corot_feb_add_name(corot_feb *f, const corot_xml_tag *tag, const char *text,
                                int *name);

corot_status corot_feb_add_item(corot_feb *f, corot_feb_item item);

/* The numbers and ranges, FIRST:LAST or FIRST:LAST:STEP, up to the next tag. */
corot_status corot_feb_read_list(corot_feb *f, corot_feb_of of, int name);

/* Sets and surfaces become members of the draft, in which all nodes and elements are. */
corot_status corot_feb_groups(corot_feb *f);

#endif
