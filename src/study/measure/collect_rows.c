/* The one measure that rows are compared by. */
#include "collect_rows.h"

#include <math.h>

/* The error of a quantity that rows are compared by; NULL: it is a norm, or there is none. */
static const quantity_error *off(const table_rows *t, const table_row *r) {
  int k = t->measure - ERROR_PROBES;
  return k < 0 || !r->off ? NULL : &r->off[k];
}

bool row_is_of_known(const table_rows *t, const table_row *r) {
  const quantity_error *e = off(t, r);
  return e && e->known;
}

bool row_has_error(const table_rows *t, const table_row *r) {
  return r->measured || row_is_of_known(t, r);
}

double row_error(const table_rows *t, const table_row *r) {
  const quantity_error *e = off(t, r);
  return e ? fabs(e->error) : r->error.of[t->measure].max;
}

double row_floor(const table_rows *t, const table_row *r) {
  const quantity_error *e = off(t, r);
  return e ? e->floor : t->reference[r->cell->reference].floor.of[t->measure].max;
}

bool row_is_rated(const table_rows *t, const table_row *r) {
  const quantity_error *e = off(t, r);
  return e ? quantity_is_rated(e) : row_error(t, r) >= ERROR_FLOOR * row_floor(t, r);
}
