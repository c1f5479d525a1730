/* Outputs and kinks, merged as they come. */
#include "schedule.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

void schedule_destroy(schedule *s) {
  if (!s) return;
  free(s->kink);
  free(s);
}

static int compare(const void *a, const void *b) {
  double p = *(const double *)a, q = *(const double *)b;
  return (p > q) - (p < q);
}

/* Ascending, each once. */
static void merge(schedule *s) {
  int n = 0;
  qsort(s->kink, (size_t)s->nkink, sizeof *s->kink, compare);
  for (int i = 0; i < s->nkink; i++)
    if (i == 0 || s->kink[i] != s->kink[i - 1]) s->kink[n++] = s->kink[i];
  s->nkink = n;
}

corot_status schedule_create(const corot_model *model, double end, double output_step, int nchange,
                             const double *change, schedule **out) {
  int nkink = corot_model_kinks(model, 0, end, 0, NULL);
  schedule *s = malloc(sizeof *s);
  if (!s) return corot_fail(COROT_ENOMEM, "the times of the run: out of memory");
  *s = (schedule){
      .end = end,
      .output_step = output_step,
      .nkink = nkink + nchange,
      .near = 1e-12 * end,
  };
  s->kink = malloc(((size_t)s->nkink + 1) * sizeof *s->kink);
  if (!s->kink) {
    schedule_destroy(s);
    return corot_fail(COROT_ENOMEM, "the kinks of loads and motions: out of memory");
  }
  corot_model_kinks(model, 0, end, nkink, s->kink);
  for (int i = 0; i < nchange; i++) s->kink[nkink + i] = change[i];
  merge(s);
  *out = s;
  return COROT_OK;
}

void schedule_exchange(pack *p, schedule *s) {
  corot_pack_same(p, (uint64_t)s->nkink, "the number of kinks");
  corot_pack_int(p, &s->next_kink);
  corot_pack_long(p, &s->next_output);
}

static double kink_time(const schedule *s) {
  return s->next_kink < s->nkink ? s->kink[s->next_kink] : INFINITY;
}

double schedule_stop(const schedule *s, double other) {
  double t = fmin(kink_time(s), other);
  return t < s->end - s->near ? t : s->end;
}

bool schedule_over(const schedule *s, double t) { return t >= s->end - s->near; }

bool schedule_kink_before(const schedule *s, double t) { return kink_time(s) < t - s->near; }

bool schedule_take_kink(schedule *s, double t, double *kink) {
  if (!(kink_time(s) <= t + 4 * DBL_EPSILON * t)) return false;
  *kink = s->kink[s->next_kink++];
  return true;
}

bool schedule_take_output(schedule *s, double t, double *output) {
  if (s->next_output < 0) return false;
  double next = s->output_step > 0 ? (double)s->next_output * s->output_step : s->end;
  if (s->next_output == 0) next = 0;
  bool last = !(next < s->end - s->near);
  if (last) next = s->end;
  if (next > t + s->near) return false;
  s->next_output = last ? -1 : s->next_output + 1;
  *output = next;
  return true;
}
