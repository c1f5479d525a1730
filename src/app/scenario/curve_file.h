/* A curve in a text file: two columns, time and value. */
#ifndef COROT_APP_SCENARIO_CURVE_FILE_H
#define COROT_APP_SCENARIO_CURVE_FILE_H

#include "app/config/config.h"
#include "app/folder/hash.h"

typedef struct curve {
  int n;
  const double *time, *value; /* [n] the tree's */
  char digest[HASH_SIZE];     /* SHA-256 of the file's bytes */
} curve;

/* Reads `path`, which `node` named. Columns are separated by blanks, a comma or a semicolon; #
   begins a comment; a first line whose first cell is no number is a header. Times must not fall,
   and at most two points stand at one time, with `jumps`; without, one. COROT_EFORMAT: a message
   with the file's line and column, or with those of `node` where there is no such file. */
corot_status curve_file_read(config *tree, const config_node *node, const char *path, bool jumps,
                             curve *out);

#endif
