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
   begins a comment; a first line whose first cell is no number is a header. COROT_EFORMAT: a
   message with the file's line and column, or with those of `node` where there is no such file.
   Whether the points make an amplitude is for the core to say. */
corot_status curve_file_read(config *tree, const config_node *node, const char *path, curve *out);

/* COROT_EFORMAT with the line and column of a point, counted from 0, of the file that `node` names
   in the scenario `scenario_path`, and this reason. */
corot_status curve_file_fail(config *tree, const config_node *node, const char *scenario_path,
                             int point, const char *reason);

#endif
