/* When a state is packed, and when it is written. */
#include "run_checkpoint.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/folder/folder.h"
#include "app/folder/provenance.h"
#include "app/text/json_text.h"
#include "app/text/no_memory.h"
#include "app/text/say.h"
#include "run_clock.h"
#include "stop.h"

struct checkpoint {
  const scenario *scenario;
  const run_options *options;
  char *path, *program;
  char run[HASH_SIZE];
  pack kept, next;    /* complete; in the making */
  double t, t_next;   /* of these [s] */
  double t_written;   /* of the file [s]; NaN: there is none */
  double at;          /* on the clock, when the file was written, or the run began [s] */
  bool fails, judged; /* the last writing failed; the length of `steps` steps was looked at */
};

void checkpoint_destroy(checkpoint *c) {
  if (!c) return;
  corot_pack_clear(&c->kept);
  corot_pack_clear(&c->next);
  free(c->path);
  free(c->program);
  free(c);
}

static corot_status describe_program(char **text) {
  json_t *provenance = NULL;
  COROT_TRY(provenance_make(&provenance));
  *text = json_text_dump_plain(provenance, JSON_COMPACT | JSON_SORT_KEYS);
  json_decref(provenance);
  return *text ? COROT_OK : no_memory();
}

corot_status checkpoint_create(const scenario *s, const char run[HASH_SIZE],
                               const run_options *options, checkpoint **out) {
  *out = NULL;
  if (s->checkpoint_steps == 0) return COROT_OK;
  checkpoint *c = calloc(1, sizeof *c);
  if (!c) return no_memory();
  c->scenario = s;
  c->options = options;
  c->at = wall_clock();
  c->t = c->t_next = c->t_written = NAN;
  memcpy(c->run, run, HASH_SIZE);
  c->path = folder_path(options->dir, CHECKPOINT_NAME);
  corot_status status = c->path ? describe_program(&c->program) : COROT_ENOMEM;
  if (status == COROT_OK)
    *out = c;
  else
    checkpoint_destroy(c);
  return status;
}

bool checkpoint_is_due(const checkpoint *c, long nstep) {
  return c && nstep % c->scenario->checkpoint_steps == 0;
}

pack *checkpoint_begin(checkpoint *c, double t) {
  c->next.bytes = 0; /* the room of the one before the last is taken again */
  c->next.status = COROT_OK;
  c->t_next = t;
  checkpoint_file_begin(&c->next, c->run, c->program, t);
  return &c->next;
}

/* Which part of the run a kill may cost is not what was asked for. */
static void judge(checkpoint *c, double now) {
  const scenario *s = c->scenario;
  double took = now - c->at;
  if (c->judged) return;
  c->judged = true;
  if (c->options->quiet || s->checkpoint_every == 0 || took <= s->checkpoint_every) return;
  double fitting = (double)s->checkpoint_steps * s->checkpoint_every / took;
  say("%s: %ld steps took %.3g s, longer than checkpoint.every, %.3g s: a run that is killed loses "
      "up to so much; checkpoint.steps: %.0f would keep to it\n",
      s->path, s->checkpoint_steps, took, s->checkpoint_every, fmax(1, floor(fitting)));
}

static corot_status put_on_disk(const checkpoint *c, outputs *o) {
  COROT_TRY(outputs_synchronise(o));
  return file_renew_durably(c->path, c->kept.data, c->kept.bytes);
}

void checkpoint_write(checkpoint *c, outputs *o) {
  if (!c || c->kept.bytes == 0 || c->t == c->t_written) return;
  bool failed = put_on_disk(c, o) != COROT_OK;
  if (failed && !c->fails)
    say("%s: the checkpoint of t = %g s is not written: %s\n", c->scenario->path, c->t,
        corot_error());
  c->fails = failed;
  c->at = wall_clock();
  if (failed) return;
  c->t_written = c->t;
  stop_keep(NULL, 0);
}

corot_status checkpoint_keep(checkpoint *c, outputs *o) {
  COROT_TRY(checkpoint_file_seal(&c->next));
  pack before = c->kept;
  c->kept = c->next;
  c->t = c->t_next;
  stop_keep(c->kept.data, c->kept.bytes);
  c->next = before;
  double now = wall_clock();
  judge(c, now);
  if (now - c->at >= c->scenario->checkpoint_every) checkpoint_write(c, o);
  return COROT_OK;
}

void checkpoint_goes_on(checkpoint *c, double t) { c->t_written = t; }

double checkpoint_written(const checkpoint *c) { return c ? c->t_written : NAN; }

void checkpoint_remove(checkpoint *c) {
  if (!c || isnan(c->t_written)) return;
  unlink(c->path);
  c->t_written = NAN;
}
