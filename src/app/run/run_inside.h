/* Inside of a run: what its loop and its checkpoints share. */
#ifndef COROT_APP_RUN_RUN_INSIDE_H
#define COROT_APP_RUN_RUN_INSIDE_H

#include <corot/integrate.h>

#include "app/folder/folder_lock.h"
#include "live.h"
#include "outputs.h"
#include "progress.h"
#include "result.h"
#include "resume.h"
#include "run_checkpoint.h"
#include "schedule.h"

typedef struct run {
  const scenario *scenario;
  const run_options *options;
  corot_mesh *mesh;
  corot_refinement *refinement; /* or NULL */
  corot_model *model;
  corot_state *state;
  live *live;
  corot_integrator *integrator;
  corot_frame_clock *clock;
  schedule *schedule;
  outputs *outputs;
  hashes hashes;
  checkpoint *checkpoint; /* NULL: none is made */
  resume resume;          /* what there is to go on from */
  progress progress;
  double *u, *v;       /* [n] scratch */
  double t;            /* reached [s]; at a constant step, it may pass the end */
  double before;       /* where the last step began [s] */
  double shown;        /* time of the last row of the tables [s]; -1: there is none */
  long nstep, nresume; /* steps so far; how often it has gone on from a checkpoint */
  frame_totals frames;
  run_failure failure;
  folder_lock lock;
  warnings warnings;
  observed seen;                                                   /* in the end */
  double wall_at_start, cpu_at_start, setup_s, frames_s, output_s; /* [s] */
} run;

/* The whole of a run as bytes. Its integrator begins anew, whether these are written to a file or
   not. */
corot_status run_pack(run *r, pack *p);

/* The run as it was, with the outputs of then: nothing in the folder is changed before all is known
   to fit; then its files are cut back. */
corot_status run_unpack(run *r, pack *p);

#endif
