/* What a scenario amounts to, once mesh and model stand and the integrator has chosen. */
#ifndef COROT_APP_SCENARIO_FACTS_H
#define COROT_APP_SCENARIO_FACTS_H

#include "scenario.h"
#include "warnings.h"

typedef struct facts {
  corot_mesh *mesh;
  corot_refinement *refinement; /* or NULL */
  corot_model *model;
  corot_mesh_quality quality;
  corot_integrator_choice chosen;
  size_t bytes;          /* of model and state */
  double mass;           /* of the whole solid [kg] */
  corot_location *probe; /* [nprobe] of points and nodes */
  warnings warnings;
} facts;

/* Builds everything that a run would. On failure `f` holds what had been found. */
corot_status facts_find(const scenario *s, facts *f);

void facts_free(facts *f);

void facts_print(const scenario *s, const facts *f, FILE *out);

/* The caller's to json_decref; NULL: no memory. */
json_t *facts_json(const scenario *s, const facts *f);

/* The names and sizes of a mesh's groups; the same. */
json_t *facts_groups(const corot_mesh *mesh);

#endif
