/* A YAML or JSON document as a tree of maps, lists and scalars, each with the place where it was
   written, so that whatever is wrong with it can be said with file, line and column. */
#ifndef COROT_APP_CONFIG_CONFIG_H
#define COROT_APP_CONFIG_CONFIG_H

#include <corot/base.h>
#include <stdbool.h>
#include <stddef.h>

/* What a node was read from: a file, or one --set argument. */
typedef struct config_source {
  const char *name; /* begins each message */
  const char *text; /* [size] */
  size_t size;
  bool lines; /* messages give line and column, and show the line */
} config_source;

typedef enum config_kind { CONFIG_SCALAR, CONFIG_LIST, CONFIG_MAP } config_kind;

typedef struct config_node {
  config_kind kind;
  bool quoted;                 /* scalar in quotes: text, never a number */
  const char *key;             /* in a map; NULL elsewhere */
  const char *text;            /* of a scalar */
  double number;               /* of a scalar that the schema has found to be a number */
  const config_source *source; /* NULL: a default */
  size_t key_at, at;           /* where key and value begin, in bytes from the source's start */
  struct config_node *parent, *child, *last, *next;
  int nchild;
} config_node;

/* Limits of a file, and of a --set argument, so that no text can take all time or memory. */
enum {
  CONFIG_MOST_MIB = 16,
  CONFIG_MOST_LEVELS = 32,
  CONFIG_MOST_VALUES = 1000000, /* maps and lists are values, too; aliases count unfolded */
  CONFIG_MOST_KEYS = 10000,     /* of one map: probes, groups */
  CONFIG_MOST_FAULTS = 10,      /* told at once */
};

/* A tree, and the memory of everything that was read into it. */
typedef struct config {
  struct config_block *block; /* see config_alloc */
  long nnode;                 /* of all trees read into it */
  config_node *root;
  struct config_faults *faults; /* NULL: none */
} config;

/* Reads a file; JSON if its name ends in ".json", otherwise YAML (of which JSON is nearly a part).
   COROT_EIO: it cannot be read; COROT_EFORMAT: it is not one well-formed document with a map at
   its root. */
corot_status config_read(const char *path, config **tree);

/* The same from memory. `path` begins the messages. */
corot_status config_read_text(const char *path, const char *text, size_t size, config **tree);

/* Takes NULL. */
void config_destroy(config *tree);

/* Replaces or adds the value at a path: "KEY.PATH=VALUE", VALUE in YAML, entries of lists by their
   number ("loads.0.traction=[1, 0, 0]"). */
corot_status config_override(config *tree, const char *assignment);

/* The two sides of "KEY.PATH=VALUE"; nothing is set. */
corot_status config_parse_assignment(config *tree, const char *assignment, const char **path,
                                     config_node **value);

/* As config_override, with a value that has been read already; its texts, and the source it names
   in messages, must outlive the tree. */
corot_status config_set(config *tree, const char *path, const config_node *value);

/* The node at a path of keys and list indices ("loads.0.group"); NULL: there is none. */
config_node *config_find(config_node *node, const char *path);

/* A scalar that stands for nothing: empty, ~ or null, without quotes. */
bool config_is_null(const config_node *node);

/* Whether a text is a number as config_parse_number() wants it. */
bool config_is_decimal(const char *text);

/* The number a scalar spells, as in JSON and YAML, in decimal only; false: it spells none, or one
   that is not finite. */
bool config_parse_number(const config_node *node, double *number);

/* Zeroed memory that lives as long as the tree; NULL: there is none. */
void *config_alloc(config *tree, size_t count, size_t size);

/* A copy of the text [length]. */
char *config_copy(config *tree, const char *text, size_t length);

/* `file` as seen from the folder of the file `path`; NULL: no memory. */
const char *config_beside(config *tree, const char *path, const char *file);

/* A new node without a place. NULL: no memory. */
config_node *config_node_create(config *tree, config_kind kind);

/* A scalar without a place, under `key` at the end of a map. */
corot_status config_add_text(config *tree, config_node *map, const char *key, const char *text);
corot_status config_add_number(config *tree, config_node *map, const char *key, double number);

/* Appends to a list or map. */
void config_append(config_node *parent, config_node *node);

/* Takes a node out of its parent. */
void config_remove(config_node *node);

/* Parses `text` as a value. NULL in *node stands for an empty text. */
corot_status config_parse(config *tree, const config_source *source, bool json, config_node **node);

/* Fail with COROT_EFORMAT and "FILE:LINE:COLUMN: KEY.PATH: ...", the line, and a caret under the
   node's value, or its key where the key is what is wrong. */
corot_status config_fail(const config_node *node, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
corot_status config_fail_key(const config_node *node, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* The same for a place in a source. */
corot_status config_fail_at(const config_source *source, size_t at, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* What is wrong with a file is told all at once: reading goes on after a fault where that makes
   sense.

   Of a step in reading: keeps corot_error() of COROT_EFORMAT and COROT_EINVAL, and returns
   COROT_OK, so that the next step is taken; returns any other status as it is. */
corot_status config_keep(config *tree, corot_status status);

/* COROT_OK: nothing was kept. COROT_EFORMAT, with the messages of the first CONFIG_MOST_FAULTS, in
   the order of their places, those of --set last, and how many more there are. What was kept is
   forgotten. */
corot_status config_kept(config *tree);

/* Of config_fail: the last failure is about this place. */
void config_failed_at(const config_source *source, size_t at);

/* Writes the keys and indices that lead to a node, "loads[0].group", cut to fit. */
void config_path(const config_node *node, size_t size, char *path);

#endif
