/* What the functions of the interface share. */
#include "instance.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "app/run/static.h"
#include "app/scenario/scenario_threads.h"
#include "app/text/no_memory.h"

/* --- Calls --- */

static const struct {
  mode mode;
  const char *name;
} modes[] = {
    {INSTANTIATED, "before fmi3EnterInitializationMode"},
    {INITIALIZATION, "in Initialization Mode"},
    {STEP, "in Step Mode"},
    {INTERMEDIATE, "in Intermediate Update Mode"},
    {EVENT, "in Event Mode"},
    {CONTINUOUS, "in Continuous-Time Mode"},
    {TERMINATED, "after fmi3Terminate"},
    {FAILED, "after the integration has failed: fmi3Reset or fmi3SetFMUState lead on"},
};

corot_status instance_allow(const instance *in, unsigned allowed) {
  if (in->mode & allowed) return COROT_OK;
  const char *where = "";
  for (size_t i = 0; i < sizeof modes / sizeof *modes; i++)
    if (modes[i].mode == in->mode) where = modes[i].name;
  return corot_fail(COROT_EINVAL, "is not allowed %s", where);
}

void instance_say(fmi3LogMessageCallback log, fmi3InstanceEnvironment environment,
                  fmi3Status status, const char *function, const char *message) {
  char text[1200];
  if (!log) return;
  snprintf(text, sizeof text, "%s: %s", function, message);
  log(environment, status, status == fmi3Discard ? "logStatusDiscard" : "logStatusError", text);
}

fmi3Status instance_told(const instance *in, const char *function, corot_status status) {
  if (status == COROT_OK) return fmi3OK;
  fmi3Status told = status == COROT_RETRY ? fmi3Discard : fmi3Error;
  instance_say(in->log, in->environment, told, function, corot_error());
  return told;
}

corot_status instance_given(const void *pointer, const char *name) {
  return pointer ? COROT_OK : corot_fail(COROT_EINVAL, "%s is NULL", name);
}

corot_status instance_variable(const instance *in, fmi3ValueReference reference,
                               const variable **found) {
  if (reference >= (fmi3ValueReference)in->variables.n)
    return corot_fail(COROT_EINVAL, "there is no variable of value reference %lu: there are %d",
                      (unsigned long)reference, in->variables.n);
  *found = &in->variables.all[reference];
  return COROT_OK;
}

/* --- The simulation --- */

void instance_unsettle(instance *in) {
  in->settled = in->seen = false;
  sight_clear(&in->sight);
  slopes_clear(&in->slopes);
  stepping_destroy(in->stepping);
  corot_state_destroy(in->state);
  corot_inputs_destroy(in->inputs);
  free(in->now.u);
  free(in->now.v);
  in->stepping = NULL, in->state = NULL, in->inputs = NULL;
  in->now = (moment){0};
}

corot_status instance_apply_input(instance *in, int i) {
  if (!in->inputs) return COROT_OK;
  const input_def *input = &in->body.used.input[i];
  double x = in->body.value[i];
  in->seen = false;
  if (input->of == INPUT_LOAD) return corot_inputs_set_load(in->inputs, input->index, x);
  return corot_inputs_set_material(in->inputs, input->index, &(corot_material_factors){x, x, x, x});
}

static corot_status make_inputs(instance *in) {
  if (in->body.used.ninput == 0) return COROT_OK;
  COROT_TRY(corot_inputs_create(in->body.model, &in->inputs));
  for (int i = 0; i < in->body.used.ninput; i++) {
    corot_status status = instance_apply_input(in, i);
    if (status == COROT_EINVAL)
      return corot_fail(status, "input %s: %s", in->body.used.input[i].name, corot_error());
    COROT_TRY(status);
  }
  return corot_state_use_inputs(in->state, in->inputs);
}

/* Where a run begins. */
static corot_status make_start(instance *in) {
  const body *b = &in->body;
  size_t n = (size_t)corot_model_ndof(b->model) + 1;
  in->now = (moment){.energy_at_start = NAN};
  in->now.u = calloc(n, sizeof *in->now.u);
  in->now.v = calloc(n, sizeof *in->now.v);
  if (!in->now.u || !in->now.v) return no_memory();
  if (b->used.start_at_equilibrium)
    COROT_TRY(static_start(&b->used, b->refinement, b->model, in->now.u));
  scenario_start(&b->used, b->model, in->now.u, in->now.v);
  return COROT_OK;
}

static corot_status settle(instance *in) {
  COROT_TRY(body_build(&in->body));
  COROT_TRY(corot_state_create(in->body.model, &in->state));
  COROT_TRY(scenario_share(&in->body.used, in->body.model, in->state));
  COROT_TRY(make_start(in));
  instance_enter(in);
  COROT_TRY(make_inputs(in));
  COROT_TRY(sight_create(&in->body, &in->sight));
  const stepping_def def = {&in->body, in->state, in->inputs, in->rtol, in->stop};
  if (!in->exchange) COROT_TRY(stepping_create(&def, &in->now, &in->stepping));
  return body_wants_ledger(&in->body) ? sight_look(&in->sight, in->state, &in->now) : COROT_OK;
}

corot_status instance_settle(instance *in) {
  if (in->settled) return COROT_OK;
  instance_unsettle(in);
  corot_status status = settle(in);
  if (status)
    instance_unsettle(in);
  else
    in->settled = true;
  return status;
}

corot_status instance_look(instance *in) {
  COROT_TRY(instance_settle(in));
  if (in->seen) return COROT_OK;
  COROT_TRY(sight_look(&in->sight, in->state, &in->now));
  in->seen = true;
  return COROT_OK;
}

corot_status instance_slopes(instance *in) {
  COROT_TRY(instance_settle(in));
  return in->slopes.body ? COROT_OK : slopes_create(&in->body, in->state, in->inputs, &in->slopes);
}

void instance_enter(instance *in) {
  const corot_model *m = in->body.model;
  double t = in->now.t, next = INFINITY;
  corot_model_kinks(m, in->settled ? in->entered : t, INFINITY, 1, &next);
  if (next <= t + 4 * DBL_EPSILON * fabs(t)) t = fmax(t, next);
  corot_state_enter(in->state, t);
  in->entered = t;
  in->next_kink = INFINITY;
  corot_model_kinks(m, t, INFINITY, 1, &in->next_kink);
}
