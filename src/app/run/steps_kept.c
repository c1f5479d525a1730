/* The rows that are kept of many steps. */
#include "steps_kept.h"

bool thin_keeps(long number, unsigned events) {
  long every = 1;
  while (number / every > THIN_FROM) every *= 10;
  return number % every == 0 || (events & (EVENT_KINK | EVENT_RESTART | EVENT_FAILED |
                                           EVENT_REJECTED | EVENT_CHECKPOINT)) != 0;
}

void step_row_exchange(pack *p, step_row *row) {
  corot_frame_event *e = &row->update;
  int events = (int)row->events, reason = (int)e->reason;
  double *const number[] = {
      &row->t,          &row->h, &row->error, &e->change.angle_max, &e->change.angle_mean,
      &e->change.energy};
  for (size_t i = 0; i < sizeof number / sizeof *number; i++) corot_pack_double(p, number[i]);
  corot_pack_int(p, &row->order);
  corot_pack_int(p, &row->newton);
  corot_pack_int(p, &events);
  corot_pack_int(p, &reason);
  corot_pack_bool(p, &e->restarted);
  row->events = (unsigned)events;
  e->reason = (corot_frame_reason)reason;
}

const char *thin_rule(const steps_count *count) {
  if (count->rows == count->steps) return "every step";
  return "every step up to 10000, every 10th up to 100000, every 100th up to 1000000 and so on, "
         "and "
         "kinks, restarts, failures, refused steps and the last one always";
}
