/* A moment of a simulation, and what the probes are then: the same numbers, by the same calls, as
   the rows of a run. */
#ifndef COROT_FMI_BODY_MOMENT_H
#define COROT_FMI_BODY_MOMENT_H

#include "fmu_body.h"

typedef struct moment {
  double t;
  double *u, *v;                    /* [ndof] */
  double dissipated, external_work; /* from the start to t [J] */
  double frame_energy;              /* put in by frame updates so far [J] */
  double energy_at_start;           /* [J]; NaN until it is known */
} moment;

typedef struct sight {
  const body *body;
  double (*displacement)[3]; /* [nnode] scratch */
  double *value;             /* [ncolumn] of the outputs, as they were found last */
} sight;

/* COROT_ENOMEM. */
corot_status sight_create(const body *b, sight *s);
void sight_clear(sight *s);

/* Finds the outputs. `state` is that of the moment; where its start energy is not known, it is the
   start. COROT_RETRY: a tet is inverted. */
corot_status sight_look(sight *s, corot_state *state, moment *now);

#endif
