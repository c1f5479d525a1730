/* What the parts of the reader of Abaqus' .inp share. */
#ifndef COROT_CORE_MESH_READ_MESH_INP_H
#define COROT_CORE_MESH_READ_MESH_INP_H

#include "mesh_draft.h"

/* A text with the files that it includes in place of the lines that say so. */
typedef struct corot_inp_text {
  char *data;
  size_t size, room;
  size_t npiece, piece_room;
  corot_reader_piece *piece; /* where the text changes from file to file; paths in `path` */
  size_t npath, path_room;
  char **path;
} corot_inp_text;

corot_status corot_inp_expand(const char *path, const char *data, size_t size,
                              corot_inp_text *text);
void corot_inp_text_clear(corot_inp_text *text);

/* Whether two words are the same but for their case. */
bool corot_inp_same(const char *a, const char *b);

/* "*WORD, KEY=VALUE, KEY": words and keys in capitals, values as they are, without quotes. */
typedef struct corot_inp_keyword {
  size_t at;
  char word[40];
  int nparam;
  struct {
    char key[24], value[COROT_GROUP_NAME_MAX + 1];
  } param[16];
} corot_inp_keyword;

typedef struct corot_inp_element {
  int64_t tag;
  size_t at;
  int dim; /* 2 or 3 */
  corot_draft_kind kind;
  int nnode;
  int64_t node[10]; /* [nnode] their numbers */
  int index;        /* of a tet in the draft */
} corot_inp_element;

typedef enum corot_inp_kind { INP_NODES, INP_ELEMENTS, INP_FACES } corot_inp_kind;

/* Members of a set or surface. */
typedef struct corot_inp_item {
  int name;
  corot_inp_kind kind;
  size_t at;
  int other;                 /* the set whose members are meant; -1: those below are */
  bool by_index;             /* of places in the file's order, not of numbers */
  int64_t first, last, step; /* the same number, unless generated */
  int face;                  /* of a tet, from 1; 0: not said */
} corot_inp_item;

typedef struct corot_inp_name {
  char text[COROT_GROUP_NAME_MAX + 1];
  bool internal; /* makes no group */
} corot_inp_name;

typedef struct corot_inp {
  corot_reader r;
  corot_draft d;
  corot_inp_keyword k;
  bool has_part;
  char instance[COROT_GROUP_NAME_MAX + 1];
  size_t nelement, element_room;
  corot_inp_element *element;
  size_t nname, name_room;
  corot_inp_name *name; /* those that differ by more than case */
  size_t nitem, item_room;
  corot_inp_item *item;
  size_t nmember; /* how many have been looked at */
} corot_inp;

/* The value of a key: NULL if it is not there, empty if it has none. */
const char *corot_inp_param(const corot_inp *f, const char *key);

/* Goes past the rest of the line and comments; whether a line of data follows. */
bool corot_inp_next_line(corot_inp *f);

/* A number, and the comma behind it; on the next line if this one has no more. */
corot_status corot_inp_long(corot_inp *f, const char *what, int64_t *value);

/* Adds an item to the set or surface of that name. */
corot_status corot_inp_add(corot_inp *f, const char *name, corot_inp_item item);

/* *NSET, *ELSET and *SURFACE. */
corot_status corot_inp_read_set(corot_inp *f, corot_inp_kind kind);
corot_status corot_inp_read_surface(corot_inp *f);

/* The groups of a draft that has the nodes and tets. */
corot_status corot_inp_groups(corot_inp *f);

#endif
