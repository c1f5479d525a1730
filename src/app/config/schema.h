/* What a file may say: one table, from which come validation, defaults and documentation. */
#ifndef COROT_APP_CONFIG_SCHEMA_H
#define COROT_APP_CONFIG_SCHEMA_H

#include <stdio.h>

#include "config.h"

typedef enum schema_type {
  SCHEMA_MAP,         /* keys as the table says */
  SCHEMA_NAMED,       /* keys are names given by the user, "groups.NAME" */
  SCHEMA_NAMED_TEXTS, /* the same, of texts: "quantities.NAME" is one */
  SCHEMA_NAMED_SHORT, /* as SCHEMA_NAMED, or of one the value of its first key alone; of studies */
  SCHEMA_LIST,        /* entries are maps, "loads[]", or those of the path in `words` */
  SCHEMA_MAPS,        /* one map, or a list of such */
  SCHEMA_SHORT,       /* a map, or the value of its first key alone */
  SCHEMA_TEXT,
  SCHEMA_CHOICE,   /* one of `words` */
  SCHEMA_NUMBER,   /* or the one of `words`, which stands for 0 */
  SCHEMA_INTEGER,  /* the same */
  SCHEMA_DURATION, /* a number [s], or one with a unit: 30 s, 10 min, 2 h, 1 d */
  SCHEMA_VECTOR,   /* three numbers */
  SCHEMA_COUNTS,   /* three integers */
  SCHEMA_INTEGERS, /* any number of integers */
  SCHEMA_WORDS,    /* some of `words`, each once */
  SCHEMA_CURVE,    /* pairs of time and value, or a map */
  SCHEMA_STATES,   /* one of `words`, a map, or a list of maps */
  SCHEMA_TEXTS,    /* any number of texts; one may stand alone */
  SCHEMA_VALUES,   /* any number of values of any kind */
  SCHEMA_OPEN,     /* a map of keys that are not for this table to know */
  SCHEMA_OPENS,    /* a list of such */
} schema_type;

typedef enum schema_status {
  SCHEMA_OPTIONAL,
  SCHEMA_REQUIRED,
  SCHEMA_ONE_OF,      /* exactly one of the keys so marked in a map is given */
  SCHEMA_AT_MOST_ONE, /* one of the keys so marked, or none */
} schema_status;

typedef enum schema_range {
  SCHEMA_ANY,
  SCHEMA_POSITIVE,     /* > 0 */
  SCHEMA_NOT_NEGATIVE, /* >= 0 */
  SCHEMA_FRACTION,     /* > 0 and < 1 */
  SCHEMA_UNIT,         /* 0 to 1 */
  SCHEMA_ORDER,        /* 1 to 5 */
  SCHEMA_STAGE_ORDER,  /* 2 to 8 */
  SCHEMA_POISSON,      /* > -1 and < 0.5 */
} schema_range;

typedef struct schema_key {
  const char *path;
  schema_type type;
  schema_status status;
  schema_range range;
  const char *unit;     /* "" without one */
  const char *fallback; /* the default in YAML; NULL: none */
  const char *words;    /* "a|b|c", see schema_type */
  const char *doc;
} schema_key;

/* What people call a key, in maps of `path`, that has another name here. */
typedef struct schema_synonym {
  const char *path, *key, *name;
} schema_synonym;

/* In the order of a well-kept file, every parent before its children. */
typedef struct schema {
  const schema_key *key; /* [nkey] */
  int nkey;
  const schema_synonym *synonym; /* [nsynonym] */
  int nsynonym;
} schema;

/* The next key after `previous` (NULL: the first) in maps of this path ("" the root); NULL: no
   more. */
const schema_key *schema_child(const schema *table, const char *path, const schema_key *previous);

/* The key of that path; NULL: there is none. */
const schema_key *schema_find(const schema *table, const char *path);

/* The path of what a SCHEMA_LIST, SCHEMA_NAMED(_SHORT) or SCHEMA_MAPS holds. */
void schema_inside(const schema_key *key, size_t size, char *path);

/* Checks a tree against the table, notes the numbers in its nodes, drops keys without a value and
   fills in defaults. */
corot_status schema_apply(const schema *table, config *tree);

/* Writes single values that stand for a map (SCHEMA_SHORT, SCHEMA_STATES) as one, so that its other
   keys can be set. */
corot_status schema_expand(const schema *table, config *tree);

/* The table for people, narrowed to the keys that begin with `prefix`; returns the number of keys
   printed. */
int schema_print(const schema *table, const char *prefix, FILE *out);

/* What a range is: from `least` to `most`, which is in it unless it must be above or below. */
typedef struct schema_bounds {
  const char *words; /* "> 0"; "" for SCHEMA_ANY */
  double least, most;
  bool above, below;
} schema_bounds;

/* By schema_range. */
extern const schema_bounds schema_ranges[];

bool schema_in_range(double x, schema_range range);

#endif
