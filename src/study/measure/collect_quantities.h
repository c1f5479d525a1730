/* Quantities of a study: what its runs have found, and how far that is from their references'. */
#ifndef COROT_STUDY_MEASURE_COLLECT_QUANTITIES_H
#define COROT_STUDY_MEASURE_COLLECT_QUANTITIES_H

#include <jansson.h>

#include "errors.h"
#include "study/plan/manifest.h"

/* The value of that name in the result of a run; NaN: it has none. */
double quantity_found(const json_t *result, const char *name);

/* value [nquantity], the caller's to free, from the result of a run; NaN where it has none. */
corot_status quantities_read(const manifest *m, const json_t *result, double **value);

/* error [nquantity], the caller's to free: |value - reference| / |reference|; NaN where one of them
   is not known. */
corot_status quantities_measure(const manifest *m, const double *value, const double *reference,
                                double **error);

/* Adds errors by name to an object, and the names of those that are not rated to a list. */
json_t *quantities_with_errors(const manifest *m, const double *error, json_t *object);
json_t *quantities_with_unrated(const manifest *m, const double *error, const double *floor,
                                json_t *list);

/* Values by name: an object; value NULL: null for each. */
json_t *quantities_values(const manifest *m, const double *value);

#endif
