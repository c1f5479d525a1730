/* A study's table as JSON; collect.h says what stands in it. */
#ifndef COROT_STUDY_MEASURE_COLLECT_JSON_H
#define COROT_STUDY_MEASURE_COLLECT_JSON_H

#include "collect_rows.h"

/* Errors by name: an object. NULL: no memory. */
json_t *errors_json(const yardstick *y, const errors *e);

/* The names of those that are not rated: a list. NULL: no memory. */
json_t *errors_unrated(const yardstick *y, const errors *e, const errors *floor);

/* The table of rows and references; `space` and `made_by` (the builds) go into it, and remain the
   caller's. *out is the caller's. */
corot_status collect_json(const manifest *m, const table_rows *t, json_t *space, json_t *made_by,
                          json_t **out);

#endif
