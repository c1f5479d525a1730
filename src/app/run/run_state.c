/* A run as bytes: from the time reached to the ends of its files. */
#include "integration.h"
#include "run_clock.h"
#include "run_inside.h"

static void exchange_frames(pack *p, frame_totals *f) {
  corot_pack_long(p, &f->count);
  for (int i = 0; i < FRAME_REASONS; i++) corot_pack_long(p, &f->by[i]);
  corot_pack_double(p, &f->angle_max);
  corot_pack_double(p, &f->angle_mean);
  corot_pack_double(p, &f->energy);
}

/* Times on the clock add up over the processes of a run. */
static void exchange_clocks(pack *p, run *r) {
  double s[] = {wall_clock() - r->wall_at_start, cpu_clock() - r->cpu_at_start, r->setup_s,
                r->frames_s, r->output_s};
  corot_pack_doubles(p, s, sizeof s / sizeof *s);
  if (!p->reading) return;
  r->wall_at_start -= s[0];
  r->cpu_at_start -= s[1];
  r->setup_s += s[2];
  r->frames_s += s[3];
  r->output_s += s[4];
}

/* All but the outputs and the integrator. */
static void exchange(pack *p, run *r) {
  corot_pack_double(p, &r->t);
  corot_pack_double(p, &r->before);
  corot_pack_double(p, &r->shown);
  corot_pack_long(p, &r->nstep);
  corot_pack_long(p, &r->nresume);
  exchange_frames(p, &r->frames);
  exchange_clocks(p, r);
  schedule_exchange(p, r->schedule);
  live_exchange(p, r->live);
}

corot_status run_pack(run *r, pack *p) {
  exchange(p, r);
  COROT_TRY(integration_exchange(p, r->integrator));
  return outputs_pack(r->outputs, p);
}

corot_status run_unpack(run *r, pack *p) {
  exchange(p, r);
  COROT_TRY(integration_exchange(p, r->integrator));
  COROT_TRY(outputs_resume(r->scenario, r->model, r->options->dir, p, &r->outputs));
  if (corot_pack_left(p) > 0)
    return corot_fail(COROT_EFORMAT, "%zu bytes are left of the state", corot_pack_left(p));
  return outputs_cut(r->outputs, r->options->dir);
}
