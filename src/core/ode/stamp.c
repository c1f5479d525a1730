/* What has changed of a state, and what a change of its materials does to the body. */
#include "stamp.h"

#include "state.h"

state_stamp corot_state_stamp(const corot_state *s) {
  state_stamp stamp = {.frames = s->changes};
  stamp.inputs = s->inputs != NULL;
  if (!s->inputs) return stamp;
  stamp.feedback = s->inputs->feedback.force != NULL;
  stamp.moves = s->inputs->npath > 0;
  stamp.loads = s->inputs->loads;
  stamp.paths = s->inputs->paths;
  stamp.matrices = s->inputs->matrices;
  return stamp;
}

bool corot_inputs_may_hold(const corot_inputs *inputs) { return inputs && inputs->feedback.blocks; }

void corot_materials_settle(corot_state *s) {
  s->in_use = true;
  if (s->inputs) s->inputs->pending = false;
}

/* Of the body displaced by u, in the frames in use, with what deforms now. */
static corot_status elastic_energy(const corot_model *m, corot_state *s, double t, const double *u,
                                   double *energy) {
  const instant now = corot_state_at(s, t);
  double power;
  return corot_system_energy(system_of(m, s), &s->system, age_of(s, t),
                             corot_state_displace(m, s, &now, u), NULL, energy, &power);
}

corot_status corot_materials_gain(const corot_model *m, corot_state *s, double t, const double *u,
                                  double *gain) {
  corot_inputs *in = s->inputs;
  *gain = 0;
  if (!in || !in->pending) return COROT_OK;
  double before, after;
  other_system *other = in->other;
  in->other = in->before;
  corot_status status = elastic_energy(m, s, t, u, &before);
  in->other = other;
  if (!status) status = elastic_energy(m, s, t, u, &after);
  if (status) return status;
  in->pending = false;
  *gain = after - before;
  return COROT_OK;
}
