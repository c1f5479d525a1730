/* Probes: what a scenario asks to be recorded of the motion, as columns of numbers. They are
   evaluated at the end of every step, and at every output time. */
#ifndef COROT_APP_PROBE_PROBE_H
#define COROT_APP_PROBE_PROBE_H

#include "app/folder/write_csv.h"
#include "app/scenario/scenario.h"

typedef struct probes probes;

/* A moment of a run, or an equilibrium of statics. */
typedef struct probe_moment {
  double t;                        /* [s] */
  corot_state *state;              /* for evaluations; with the frames of the moment */
  const double *u, *v;             /* [ndof] */
  const double (*displacement)[3]; /* [nnode] of all nodes */
  const ledger *ledger;            /* energies and momenta */
  bool still;                      /* statics: nothing moves, and the loads are `factor` times */
  double factor;                   /* those of the end of the scenario's time */
} probe_moment;

/* The scenario and the model must outlive them. COROT_EINVAL: a probe does not fit the mesh.
   COROT_ENOMEM. */
corot_status probes_create(const scenario *s, const corot_model *model, probes **out);

/* Takes NULL. */
void probes_destroy(probes *p);

/* Columns, in the order of the scenario: "corner.ux", "corner.uy", ... Names [ncolumn] and units
   live as long as the probes; a unit is "" for a pure number. */
int probes_ncolumn(const probes *p);
const char *const *probes_columns(const probes *p);
const char *probes_unit(const probes *p, int i);

/* What is known of one probe, i = 0 to probes_n - 1. */
typedef struct probe_facts {
  const char *name;
  int node;
  int first, ncolumn; /* its columns */
  const char *length; /* of a vector, what its length is called, as "u"; else NULL */
  bool moves;         /* its columns are a displacement */
} probe_facts;

int probes_n(const probes *p);
probe_facts probes_known(const probes *p, int i);

/* value [ncolumn] of a moment. COROT_RETRY: a tet is inverted, of whose stress or force a probe is.
 */
corot_status probes_evaluate(probes *p, const probe_moment *now, double *value);

#endif
