/* JSON in files that are never seen half-written. */
#ifndef COROT_STUDY_PLAN_JSON_FILE_H
#define COROT_STUDY_PLAN_JSON_FILE_H

#include <corot/base.h>
#include <jansson.h>
#include <stdbool.h>

/* COROT_EIO: it cannot be read; COROT_EFORMAT: it is not JSON. The caller's to json_decref. */
corot_status json_file_read(const char *path, json_t **out);

/* Puts DIR/NAME in place as a whole, on the disk when it returns. */
corot_status json_file_write(const char *dir, const char *name, const json_t *value);

#endif
