/* result.json: everything about a run that is one number or one word. Some of it:

     warnings  [{code, text}, ...], see warnings.h
     quantities  what the scenario asks for, see quantities.h
     probes    at the end, see probes_json in app/probe/probe.h
     extremes  {NAME: {min: {value, t}, max: {value, t}}, ...} over all steps (of statics, over the
               load steps): the columns of the probes; PROBE.u (v, a), the length of a displacement
               (velocity, acceleration); and the energies under their names in energy.csv [J]. With
               "at": {node or tet, x}, the place, where a probe takes the largest or smallest
     observed  what the outcome's warnings are made from, warning or not:
       displacement  the largest of a node at an output time [m]
       period        of the motion, see history.h [s]; null: it does not swing
       energy_error  the largest balance over the largest energy; null: statics
       strained      the part of the volume strained beyond STRAIN_LIMIT, when that was largest
       turned        the part turned beyond TURN_LIMIT, when the turn was largest; of cauchy
       stress_jumps  corot_stress_jumps when the elastic energy was largest
     space_error what the mesh leaves out of the displacement when the elastic energy was largest,
   see corot/space.h, if left_out is null, else the reason why it is not known: relative      error
   / displacement error         root of its mean square over the body's mass [m] displacement  the
   same of the displacement with the error added [m] t             the time of that moment [s]
       indefinite    the tangent was not positive definite, so that stress has no part in it
       probes        {NAME: [x, y, z]}: to be added to the displacement of each [m]
     resumed    how often the run went on from a checkpoint; only of one that makes them. Its times
                on the clock are those of all its processes, less what was lost between them
     provenance what it was made by, see provenance.h */
#ifndef COROT_APP_RUN_RESULT_H
#define COROT_APP_RUN_RESULT_H

#include "app/folder/hash.h"
#include "app/scenario/warnings.h"
#include "failure.h"
#include "outputs.h"
#include "result_statics.h"

/* All updates of held or extrapolated frames. */
typedef struct frame_totals {
  long count, by[FRAME_REASONS];
  double angle_max, angle_mean; /* the largest and the mean turn of a frame [rad] */
  double energy;                /* put in [J] */
} frame_totals;

/* What a run has to say when it is over. */
typedef struct run_summary {
  const char *status; /* "ok", "failed", "interrupted" */
  const char *reason; /* NULL: ok */
  int exit_code;
  run_failure failure;
  double t_reached; /* [s] */
  const corot_model *model;
  size_t state_bytes;
  int threads;
  corot_statistics statistics;
  corot_integrator_choice chosen;
  frame_totals frames;
  const statics_summary *statics; /* NULL: a run; else `statistics` has the timings only, `chosen`
                                     and `frames` nothing */
  double setup_s, frames_s, output_s, wall_s, cpu_s; /* [s] */
  hashes hashes;
  const warnings *warnings;
  const observed *seen;
  long nresume; /* how often the run went on from a checkpoint; -1: it makes none */
} run_summary;

/* The caller's to json_decref. */
corot_status result_make(const scenario *s, const outputs *o, const run_summary *run, json_t **out);

/* Parts of result.json; NULL: no memory. */
json_t *result_versions(void);
json_t *result_mesh(const scenario *s, const corot_model *model);

/* The text of it, as it stands in the file; the caller's to free. */
corot_status result_text(const json_t *result, char **text);

/* Puts DIR/result.json in place as a whole. */
corot_status result_write(const char *dir, const char *text);

#endif
