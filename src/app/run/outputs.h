/* The files of a run that grow with it: probes.csv, energy.csv, history.csv, steps.csv,
   compare.csv, reactions.csv, states.bin, fields. Each is a writer (writer.h). */
#ifndef COROT_APP_RUN_OUTPUTS_H
#define COROT_APP_RUN_OUTPUTS_H

#include "app/scenario/warnings.h"
#include "history.h"
#include "space.h"
#include "steps_kept.h"

typedef struct outputs outputs;

/* What the run knows of one moment. */
typedef struct instant {
  double t;
  const double *u, *v;              /* [n] */
  double dissipated, external_work; /* from the start to t [J] */
  double frame_energy;              /* put in by frame updates so far [J] */
  bool still;                       /* nothing moves, whatever supports do at t */
} instant;

/* Makes `dir`, removes what an earlier run left there, and begins the files that runs and statics
   have in common. Scenario and model must outlive the outputs. */
corot_status outputs_open(const scenario *s, const corot_model *model, const char *dir,
                          outputs **out);

/* Begins those that only one of them has: history.csv if the scenario wants it, reactions.csv. Call
   this before the first instant is written. */
corot_status outputs_open_run(outputs *o, const char *dir);
corot_status outputs_open_statics(outputs *o, const char *dir);

/* Adds a row to probes.csv, energy.csv, compare.csv and reactions.csv, a record to states.bin, and
   a frame to the fields if it is their turn (every scenario.field_every times, and the `last`).
   Where an evaluation fails nothing is written. The energy balance is taken against the first
   instant, with which the history begins; one that is still (statics) enters it as well. */
corot_status outputs_write(outputs *o, corot_state *state, const instant *now, bool last);

/* Adds the end of a step to the history; `e` are the energies of that instant. Call this after the
   first instant was written, and before later ones up to this are. */
corot_status outputs_history(outputs *o, corot_state *state, const instant *now,
                             const corot_energies *e);

/* Adds a row to steps.csv, if the step has one (steps_kept.h); and what it has, once it is closed.
 */
corot_status outputs_step(outputs *o, const step_row *row);
steps_count outputs_steps(const outputs *o);

/* The name of each file, i = 0, 1, ...; NULL beyond the last. */
const char *outputs_file(int i);

/* How many moments were written. */
long outputs_count(const outputs *o);

/* The moment written last: energies, and the probes (probes_json). */
ledger outputs_ledger(const outputs *o);
json_t *outputs_probes(const outputs *o);
const probes *outputs_recorded(const outputs *o); /* the probes */

/* The forces of the supports at the moment written last: reactions_last, and as that before the
   outputs are closed; NULL without reactions.csv. */
json_t *outputs_reactions(const outputs *o);

/* The quantities of the scenario, once the outputs are closed: the part of result.json
   (quantities.h); how many have no value, and a warning for each. */
json_t *outputs_quantities(const outputs *o);
void outputs_tell(const outputs *o); /* a line for each on stderr */
int outputs_unanswered(const outputs *o);
corot_status outputs_warn(const outputs *o, warnings *w);

/* Extremes of probes and energies: history_extremes. */
json_t *outputs_extremes(const outputs *o);

/* What is beyond small strains, of which a measure of small strains may be wrong: a principal
   stretch that is off one by more than this, and a turn by more than this [rad]. */
#define STRAIN_LIMIT 0.2
#define TURN_LIMIT 0.1

/* What the outputs have seen of the motion. */
typedef struct observed observed;
struct observed {
  history_facts history;
  double displacement;        /* the largest of a node at the moments written [m] */
  corot_deformation strained; /* of these and the one of most elastic energy, the most strained, */
  corot_deformation turned;   /* the most turned (of cauchy, else there are no turns), */
  corot_deformation inverted; /* and that with the smallest det F */
  double t_strained, t_turned, t_inverted; /* [s] */
  double jumps;     /* of the stress when the elastic energy was largest: corot_stress_jumps */
  space_seen space; /* of the same moment; set by run_warn_after, to be cleared by space_clear */
};

/* All zero if no moment was written. COROT_ENOMEM. */
corot_status outputs_observed(const outputs *o, corot_state *state, observed *out);

/* Packs what the outputs are at a checkpoint, all that they have handed to the system included.
   Failures as of corot_pack_status, and of files that cannot be written to. */
corot_status outputs_pack(outputs *o, pack *p);

/* What the files have is on the disk. */
corot_status outputs_synchronise(outputs *o);

/* In the place of outputs_open and outputs_open_run: the outputs of a checkpoint, whose files in
   `dir` are looked at only. COROT_EFORMAT: one of them lacks what it had. Then outputs_cut takes
   away what was written since, and the result and the page of the run that was cut. */
corot_status outputs_resume(const scenario *s, const corot_model *model, const char *dir, pack *p,
                            outputs **out);
corot_status outputs_cut(outputs *o, const char *dir);

/* Closes the files and reports an error that shows up on closing; what was written last remains
   readable. */
corot_status outputs_close(outputs *o);

/* Takes NULL. */
void outputs_destroy(outputs *o);

#endif
