/* Sums of trajectories: what an extrapolation in the mesh is made of. */
#include "states_sum.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/text/no_memory.h"

static size_t record_length(const trajectory *t) { return 1 + 2 * (size_t)t->n; }

bool states_same_time(double s, double t, double end) { return fabs(s - t) <= 1e-9 * end; }

corot_status states_places(const trajectory *like, const trajectory *other, int **at) {
  int *place = malloc(((size_t)like->n + 1) * sizeof *place);
  if (!place) return no_memory();
  for (int i = 0, k = 0; i < like->n; i++) {
    while (k < other->n && other->place[k] < like->place[i]) k++;
    if (k == other->n || other->place[k] != like->place[i]) {
      free(place);
      return corot_fail(COROT_EINVAL, "the reference has no free component %d of node %d",
                        like->place[i] % 3, like->place[i] / 3);
    }
    place[i] = k;
  }
  *at = place;
  return COROT_OK;
}

static corot_status add_term(trajectory *sum, double factor, const trajectory *term) {
  int *at;
  COROT_TRY(states_places(sum, term, &at));
  corot_status status = COROT_OK;
  double end = sum->count > 0 ? states_t(sum, sum->count - 1) : 0;
  for (int k = 0, j = 0; k < sum->count && status == COROT_OK; k++) {
    double t = states_t(sum, k);
    while (j < term->count && states_t(term, j) < t && !states_same_time(states_t(term, j), t, end))
      j++;
    if (j == term->count || !states_same_time(states_t(term, j), t, end)) {
      status = corot_fail(COROT_EINVAL, "there is no state at t = %g s", t);
      break;
    }
    double *u = sum->record + (size_t)k * record_length(sum) + 1, *v = u + sum->n;
    for (int i = 0; i < sum->n; i++) {
      u[i] += factor * states_u(term, j)[at[i]];
      v[i] += factor * states_v(term, j)[at[i]];
    }
  }
  free(at);
  return status;
}

corot_status states_sum(const trajectory *like, int nterm, const double *factor,
                        const trajectory *const *term, trajectory *out) {
  trajectory sum = {.n = like->n, .count = like->count};
  size_t length = record_length(like);
  sum.place = malloc(((size_t)like->n + 1) * sizeof *sum.place);
  sum.record = calloc((size_t)like->count * length + 1, sizeof *sum.record);
  corot_status status = sum.place && sum.record ? COROT_OK : no_memory();
  if (status == COROT_OK) {
    memcpy(sum.place, like->place, (size_t)like->n * sizeof *sum.place);
    for (int k = 0; k < like->count; k++) sum.record[(size_t)k * length] = states_t(like, k);
  }
  for (int i = 0; i < nterm && status == COROT_OK; i++) status = add_term(&sum, factor[i], term[i]);
  if (status == COROT_OK)
    *out = sum;
  else
    states_free(&sum);
  return status;
}

void states_keep_last(trajectory *t) {
  if (t->count < 2) return;
  size_t length = record_length(t);
  memmove(t->record, t->record + (size_t)(t->count - 1) * length, length * sizeof *t->record);
  t->count = 1;
}
