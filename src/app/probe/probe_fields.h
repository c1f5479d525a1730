/* The fields of a moment that probes take their numbers from: each is found once for all probes,
   and only if one of them needs it. */
#ifndef COROT_APP_PROBE_PROBE_FIELDS_H
#define COROT_APP_PROBE_PROBE_FIELDS_H

#include <corot/solve.h>

#include "probe_moment.h"

enum {
  NEEDS_VELOCITY = 1,
  NEEDS_ACCELERATION = 2,
  NEEDS_INTERNAL = 4,
  NEEDS_VISCOUS = 8, /* apart from the internal ones */
  NEEDS_INERTIAL = 16,
  NEEDS_LOAD = 32,
  NEEDS_MOMENTUM = 64,
};

typedef struct probe_fields {
  const corot_model *model;
  unsigned needs;
  corot_mass_solver *mass;
  double *a, *momentum;                      /* [ndof] acceleration; M v */
  double (*velocity)[3], (*acceleration)[3]; /* [nnode] */
  corot_nodal_forces forces;                 /* [nnode] */
  bool of_tets;                              /* some field of the tets is needed */
  corot_element_fields tets;
} probe_fields;

/* After the model and the needs are set. COROT_ENOMEM. */
corot_status probe_fields_create(probe_fields *f);
void probe_fields_clear(probe_fields *f);

/* The rows of a quantity of the tets, means of each or at its points [4 ntet]: *stride doubles
   each. A field that is not there yet is made; NULL: no memory. */
const double *probe_fields_rows(probe_fields *f, probe_of of, bool points, int *stride);

/* COROT_RETRY: a tet is inverted. */
corot_status probe_fields_find(probe_fields *f, const probe_moment *now);

#endif
