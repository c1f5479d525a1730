#include "schedule.h"

#include <math.h>
#include <stdlib.h>

void schedule_destroy(schedule *s) {
  if (!s) return;
  free(s->kink);
  free(s);
}

corot_status schedule_create(const corot_model *model, double end, double output_step,
                             double frame_interval, schedule **out) {
  schedule *s = malloc(sizeof *s);
  if (!s) return corot_fail(COROT_ENOMEM, "the times of the run: out of memory");
  *s = (schedule){
      .end = end,
      .output_step = output_step,
      .frame_interval = frame_interval,
      .nkink = corot_model_kinks(model, 0, end, 0, NULL),
      .near = 1e-12 * end,
      .next_frames = 1,
  };
  s->kink = malloc(((size_t)s->nkink + 1) * sizeof *s->kink);
  if (!s->kink) {
    schedule_destroy(s);
    return corot_fail(COROT_ENOMEM, "the kinks of the loads: out of memory");
  }
  corot_model_kinks(model, 0, end, s->nkink, s->kink);
  *out = s;
  return COROT_OK;
}

static double kink_time(const schedule *s) {
  return s->next_kink < s->nkink ? s->kink[s->next_kink] : INFINITY;
}

/* An update at the end would have no effect. */
static double frames_time(const schedule *s) {
  if (!(s->frame_interval > 0)) return INFINITY;
  double t = (double)s->next_frames * s->frame_interval;
  return t < s->end - s->near ? t : INFINITY;
}

double schedule_stop(const schedule *s) {
  double t = fmin(kink_time(s), frames_time(s));
  return t < s->end - s->near ? t : s->end;
}

bool schedule_take_kink(schedule *s, double t) {
  bool due = false;
  for (; kink_time(s) <= t + s->near; s->next_kink++) due = true;
  return due;
}

bool schedule_take_frames(schedule *s, double t) {
  bool due = false;
  for (; frames_time(s) <= t + s->near; s->next_frames++) due = true;
  return due;
}

bool schedule_take_output(schedule *s, double t, double *output) {
  if (s->next_output < 0) return false;
  double next = s->output_step > 0 ? (double)s->next_output * s->output_step : s->end;
  if (s->next_output == 0) next = 0;
  bool last = !(next < s->end - s->near);
  if (last) next = s->end;
  if (next > t) return false;
  s->next_output = last ? -1 : s->next_output + 1;
  *output = next;
  return true;
}
