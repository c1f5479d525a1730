/* The body that an FMU is of: a scenario with its mesh and model, and what an importer may set of
   it before the start. */
#ifndef COROT_FMI_BODY_FMU_BODY_H
#define COROT_FMI_BODY_FMU_BODY_H

#include "app/folder/hash.h"
#include "app/probe/probe.h"

typedef struct body {
  scenario *scenario;       /* as its file says */
  scenario used;            /* the same with what has been set since; it owns nothing */
  corot_material *material; /* [used.model.nmaterial] as set */
  input_def *input;         /* [used.ninput] each of one point, at t = 0, with the value of */
  double *value;            /* [used.ninput] as set */
  corot_mesh *mesh;
  corot_refinement *refinement; /* or NULL */
  corot_model *model;
  probes *probes;
  bool built;    /* model and probes are those of the materials */
  hashes hashes; /* of the scenario and mesh as they were read */
} body;

/* Reads the scenario `path` and builds the model. The instantiation token of FMI is hashes.run:
   version of corot, scenario and mesh. On failure there is nothing to close. Failures as of
   scenario_read and scenario_build; COROT_EFORMAT: it asks for what no FMU has, as CHOLMOD. */
corot_status body_open(const char *path, body *b);

/* Takes one that is all zero. */
void body_close(body *b);

/* Makes model and probes anew if a material has changed: nothing may refer to the old ones. On
   failure those are still there, and wait to be made anew. COROT_EFORMAT: the materials make no
   sense. COROT_ENOMEM. */
corot_status body_build(body *b);

/* Back to what the scenario says, inputs included. */
void body_forget(body *b);

/* Why the equation of motion cannot be handed to an integrator outside, in words that follow "Model
   Exchange is not possible: "; NULL: it can. */
const char *body_no_exchange(const body *b);

/* Whether outputs of energies, or of the body's momenta, are among the probes: they want a ledger.
 */
bool body_wants_ledger(const body *b);

/* The value of input i at t = 0. */
double body_input_start(const body *b, int i);

/* The numbers of a material that can be set, k = 0 to BODY_MATERIAL - 1: key of a scenario, unit,
   meaning, and where it stands. */
enum { BODY_MATERIAL = 6 };
typedef struct material_number {
  const char *key, *unit, *about;
} material_number;
extern const material_number body_material_numbers[BODY_MATERIAL];
double *body_material_at(corot_material *material, int k);

#endif
