/* What probes are evaluated at, and where an extreme of theirs was. */
#ifndef COROT_APP_PROBE_PROBE_MOMENT_H
#define COROT_APP_PROBE_PROBE_MOMENT_H

#include "app/folder/write_csv.h"
#include "app/scenario/scenario.h"

/* A moment of a run, or an equilibrium of statics. */
typedef struct probe_moment {
  double t;                        /* [s] */
  corot_state *state;              /* for evaluations; with the frames of the moment */
  const double *u, *v;             /* [ndof] */
  const double (*displacement)[3]; /* [nnode] of all nodes */
  const ledger *ledger;            /* energies and momenta */
  bool still;                      /* statics: nothing moves, as in the state */
} probe_moment;

/* Where an extreme over a group or the body was, at rest. */
typedef struct probe_where {
  bool known;
  int node, tet; /* one of them; -1: the other */
  double x[3];   /* [m] */
} probe_where;

#endif
