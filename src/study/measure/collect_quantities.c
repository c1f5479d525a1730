/* Values of quantities out of results, and their errors against references and known values. */
#include "collect_quantities.h"

#include <math.h>
#include <stdlib.h>

#include "app/text/json_text.h"
#include "app/text/no_memory.h"

bool quantity_is_rated(const quantity_error *e) {
  return fabs(e->error) >= (e->known ? 1 : ERROR_FLOOR) * e->floor;
}

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

/* --- Known values --- */

bool quantities_are_known(const manifest *m) {
  bool known = false;
  for (int i = 0; i < m->nquantity; i++) known |= m->quantity[i].known;
  return known;
}

/* NaN where one of them is. */
static quantity_error total_of(const manifest *m, const quantity_error *off) {
  quantity_error total = {.known = quantities_are_known(m)};
  double most = 0;
  for (int i = 0; i < m->nquantity; i++) {
    if (!off[i].known) continue;
    double error = fabs(off[i].error);
    if (!(error <= total.error)) total.error = error; /* stays NaN: nothing is below it */
    if (isnan(error)) break;
    most = fmax(most, error + off[i].floor);
  }
  total.floor = most - total.error;
  return total;
}

corot_status quantities_rate(const manifest *m, const double *value, const double *reference,
                             const double *floor, quantity_error **out) {
  quantity_error *off = malloc(((size_t)m->nquantity + 1) * sizeof *off);
  double *error = NULL;
  corot_status status = off ? COROT_OK : no_memory();
  if (status == COROT_OK && reference) status = quantities_measure(m, value, reference, &error);
  for (int i = 0; status == COROT_OK && i < m->nquantity; i++) {
    const study_quantity *q = &m->quantity[i];
    off[i] = (quantity_error){.error = error ? error[i] : NAN, .floor = error ? floor[i] : NAN};
    if (q->known)
      off[i] = (quantity_error){true, (value[i] - q->value) / q->scale, q->within / q->scale};
  }
  if (status == COROT_OK) off[m->nquantity] = total_of(m, off);
  free(error);
  if (status == COROT_OK)
    *out = off;
  else
    free(off);
  return status;
}

const char *quantity_error_name(const manifest *m, int k) {
  return k < m->nquantity ? m->quantity[k].text : STUDY_TOTAL;
}

/* Whether error k is one that a row has; the total of nothing is none. */
static bool is_said(const manifest *m, const quantity_error *off, bool measured, int k) {
  return off[k].known || (measured && k < m->nquantity);
}

json_t *quantities_with_off(const manifest *m, const quantity_error *off, bool measured,
                            json_t *object) {
  for (int k = 0; k <= m->nquantity; k++)
    if (is_said(m, off, measured, k))
      object = json_text_with(object, quantity_error_name(m, k), json_text_real(off[k].error));
  return object;
}

json_t *quantities_with_unrated(const manifest *m, const quantity_error *off, bool measured,
                                json_t *list) {
  for (int k = 0; k <= m->nquantity; k++)
    if (is_said(m, off, measured, k) && !quantity_is_rated(&off[k]))
      list = json_text_push(list, json_string(quantity_error_name(m, k)));
  return list;
}

json_t *quantities_at_most(const manifest *m, const quantity_error *off) {
  json_t *object = json_object();
  for (int k = 0; k <= m->nquantity; k++) {
    double most = fabs(off[k].error) + off[k].floor;
    if (off[k].known && isfinite(most) && !quantity_is_rated(&off[k]))
      object = json_text_with(object, quantity_error_name(m, k), json_text_real(most));
  }
  return object;
}

json_t *quantities_known(const manifest *m) {
  json_t *list = json_array();
  for (int i = 0; i < m->nquantity; i++) {
    const study_quantity *q = &m->quantity[i];
    if (!q->known) continue;
    list = json_text_push(list, json_pack("{s:s, s:f, s:f, s:f}", "measure", q->text, "value",
                                          q->value, "within", q->within, "scale", q->scale));
  }
  return list;
}

/* --- As JSON --- */

json_t *quantities_values(const manifest *m, const double *value) {
  json_t *all = json_object();
  for (int i = 0; i < m->nquantity; i++)
    all = json_text_with(all, m->quantity[i].text, value ? json_text_real(value[i]) : json_null());
  return all;
}
