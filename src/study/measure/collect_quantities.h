/* Quantities of a study: what its runs have found, and how far that is from their references', or
   from known values. */
#ifndef COROT_STUDY_MEASURE_COLLECT_QUANTITIES_H
#define COROT_STUDY_MEASURE_COLLECT_QUANTITIES_H

#include <jansson.h>

#include "errors.h"
#include "study/plan/manifest.h"

/* An error of a quantity, relative; NaN: not known. */
typedef struct quantity_error {
  bool known;   /* against a known value: signed, and of the whole run. Else against a reference */
  double error; /* (value - known) / scale, or |value - reference| / |reference| */
  double floor; /* how far off what it is held against may be */
} quantity_error;

/* Whether there is more to be said of it than what it is at most. A known value is a bound, and may
   be as far off as the error; what references are known by is an estimate (ERROR_FLOOR). */
bool quantity_is_rated(const quantity_error *e);

/* The value of that name in the result of a run; NaN: it has none. */
double quantity_found(const json_t *result, const char *name);

/* value [nquantity], the caller's to free, from the result of a run; NaN where it has none. */
corot_status quantities_read(const manifest *m, const json_t *result, double **value);

/* error [nquantity], the caller's to free: |value - reference| / |reference|; NaN where one of them
   is not known. */
corot_status quantities_measure(const manifest *m, const double *value, const double *reference,
                                double **error);

/* off [nquantity + 1], the caller's to free: the errors of all quantities, against known values
   where there are any, else against `reference` [nquantity], which is known by `floor`; NULL: there
   is none. The last is the total: the largest of those against known values, and a floor such that
   with it no such error can be larger. */
corot_status quantities_rate(const manifest *m, const double *value, const double *reference,
                             const double *floor, quantity_error **off);

/* Whether there is a known value. */
bool quantities_are_known(const manifest *m);

/* The name of error k: a quantity's text, or the total's. */
const char *quantity_error_name(const manifest *m, int k);

/* Adds errors [nquantity] by name to an object. */
json_t *quantities_with_errors(const manifest *m, const double *error, json_t *object);

/* The same of `off` [nquantity + 1], the total only if there are known values; without `measured`
   those against known values alone. And the names of those that are not rated, to a list. */
json_t *quantities_with_off(const manifest *m, const quantity_error *off, bool measured,
                            json_t *object);
json_t *quantities_with_unrated(const manifest *m, const quantity_error *off, bool measured,
                                json_t *list);

/* What errors against known values are at most, by name, of those that are not rated: an object. */
json_t *quantities_at_most(const manifest *m, const quantity_error *off);

/* Values by name: an object; value NULL: null for each. */
json_t *quantities_values(const manifest *m, const double *value);

/* What is known: a list of {measure, value, within, scale}. */
json_t *quantities_known(const manifest *m);

#endif
