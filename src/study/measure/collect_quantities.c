/* Values of quantities out of results, and their errors. */
#include "collect_quantities.h"

#include <math.h>
#include <stdlib.h>

#include "app/text/json_text.h"
#include "app/text/no_memory.h"

double quantity_found(const json_t *result, const char *name) {
  const json_t *found = json_object_get(json_object_get(result, "quantities"), name);
  const json_t *value = json_object_get(found, "value");
  return json_is_number(value) ? json_number_value(value) : NAN;
}

corot_status quantities_read(const manifest *m, const json_t *result, double **value) {
  double *x = malloc(((size_t)m->nquantity + 1) * sizeof *x);
  if (!x) return no_memory();
  for (int i = 0; i < m->nquantity; i++) x[i] = quantity_found(result, m->quantity[i].name);
  *value = x;
  return COROT_OK;
}

corot_status quantities_measure(const manifest *m, const double *value, const double *reference,
                                double **error) {
  double *e = malloc(((size_t)m->nquantity + 1) * sizeof *e);
  if (!e) return no_memory();
  for (int i = 0; i < m->nquantity; i++) {
    double off = fabs(value[i] - reference[i]);
    e[i] = off == off ? error_relative(off, fabs(reference[i])) : NAN;
  }
  *error = e;
  return COROT_OK;
}

json_t *quantities_with_errors(const manifest *m, const double *error, json_t *object) {
  for (int i = 0; i < m->nquantity; i++)
    object = json_text_with(object, m->quantity[i].text, json_text_real(error[i]));
  return object;
}

json_t *quantities_with_unrated(const manifest *m, const double *error, const double *floor,
                                json_t *list) {
  for (int i = 0; i < m->nquantity; i++)
    if (!(error[i] >= ERROR_FLOOR * floor[i]))
      list = json_text_push(list, json_string(m->quantity[i].text));
  return list;
}

json_t *quantities_values(const manifest *m, const double *value) {
  json_t *all = json_object();
  for (int i = 0; i < m->nquantity; i++)
    all = json_text_with(all, m->quantity[i].text, value ? json_text_real(value[i]) : json_null());
  return all;
}
