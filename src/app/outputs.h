/* The files of a run that grow with it: probes.csv, energy.csv, steps.csv, compare.csv,
   states.bin, fields. */
#ifndef COROT_APP_OUTPUTS_H
#define COROT_APP_OUTPUTS_H

#include "scenario.h"
#include "write_csv.h"

typedef struct outputs outputs;

/* What the run knows of one moment. */
typedef struct instant {
  double t;
  const double *u, *v;              /* [n] */
  double dissipated, external_work; /* from the start to t [J] */
  double frame_energy;              /* put in by frame updates so far [J] */
  bool still;                       /* nothing moves, whatever supports do at t */
} instant;

/* Makes `dir`, removes what an earlier run left there, and begins the files. Scenario and model
   must outlive the outputs. */
corot_status outputs_open(const scenario *s, const corot_model *model, const char *dir,
                          outputs **out);

/* Adds a row to probes.csv, energy.csv and compare.csv, a record to states.bin, and a frame to the fields if it is their
   turn (every scenario.field_every times, and the `last`). Where an evaluation fails nothing is
   written. The energy balance is taken against the first instant. */
corot_status outputs_write(outputs *o, corot_state *state, const instant *now, bool last);

/* Adds a row to steps.csv. */
corot_status outputs_step(outputs *o, const step_row *row);

/* The moment written last: energies, and u and v of each probe. */
ledger outputs_ledger(const outputs *o);
int outputs_nprobe(const outputs *o);
const char *outputs_probe(const outputs *o, int i, int *node, double u[3], double v[3]);

/* Closes the files and reports an error that shows up on closing; what was written last remains
   readable. */
corot_status outputs_close(outputs *o);

/* Takes NULL. */
void outputs_destroy(outputs *o);

#endif
