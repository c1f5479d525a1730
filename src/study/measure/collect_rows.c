/* The one measure that rows are compared by. */
#include "collect_rows.h"

double row_error(const table_rows *t, const table_row *r) {
  int k = t->measure - ERROR_PROBES;
  return k < 0 ? r->error.of[t->measure].max : r->quantity_error[k];
}

double row_floor(const table_rows *t, const table_reference *r) {
  int k = t->measure - ERROR_PROBES;
  return k < 0 ? r->floor.of[t->measure].max : r->quantity_floor[k];
}

bool row_is_rated(const table_rows *t, const table_row *r, const table_reference *reference) {
  return row_error(t, r) >= ERROR_FLOOR * row_floor(t, reference);
}
