/* Directional derivatives: of the derivatives of states and of outputs, by states and by loads. */
#include <stdlib.h>
#include <string.h>

#include "app/text/no_memory.h"
#include "instance.h"

/* Lists of variables, with the numbers that belong to them. */
typedef struct question {
  const fmi3ValueReference *unknown, *known;
  size_t nunknown, nknown;
  const double *seed;
  double *sensitivity;
  size_t nseed, nsensitivity;
} question;

static corot_status check_count(const instance *in, const fmi3ValueReference *reference, size_t n,
                                size_t given, const char *what) {
  size_t count = 0;
  if (n > 0) COROT_TRY(instance_given(reference, what));
  for (size_t i = 0; i < n; i++) {
    const variable *v;
    COROT_TRY(instance_variable(in, reference[i], &v));
    count += (size_t)v->size;
  }
  if (count == given) return COROT_OK;
  return corot_fail(COROT_EINVAL, "the %s have %zu numbers, and there are %zu", what, count, given);
}

static corot_status check_question(const instance *in, const question *q) {
  COROT_TRY(check_count(in, q->known, q->nknown, q->nseed, "knowns"));
  COROT_TRY(check_count(in, q->unknown, q->nunknown, q->nsensitivity, "unknowns"));
  if (q->nseed > 0) COROT_TRY(instance_given(q->seed, "seed"));
  if (q->nsensitivity > 0) COROT_TRY(instance_given(q->sensitivity, "sensitivity"));
  for (size_t i = 0; i < q->nknown; i++) {
    const variable *v = &in->variables.all[q->known[i]];
    if (v->kind != VARIABLE_STATE && v->kind != VARIABLE_LOAD)
      return corot_fail(COROT_EINVAL,
                        "no derivative by %s: it is neither a state nor a continuous input",
                        v->name);
  }
  for (size_t i = 0; i < q->nunknown; i++) {
    const variable *v = &in->variables.all[q->unknown[i]];
    if (v->kind != VARIABLE_SLOPE && v->kind != VARIABLE_OUTPUT)
      return corot_fail(
          COROT_EINVAL,
          "no derivative of %s: it is neither an output nor the derivative of a state", v->name);
  }
  return COROT_OK;
}

/* Each known has its place; one that is named twice counts twice. */
static void find_direction(const instance *in, const question *q, direction *d) {
  const double *seed = q->seed;
  for (size_t i = 0; i < q->nknown; i++) {
    const variable *v = &in->variables.all[q->known[i]];
    double *to = v->kind == VARIABLE_LOAD ? d->load + v->index : v->index == 0 ? d->u : d->v;
    for (int k = 0; k < v->size; k++) to[k] += seed[k];
    seed += v->size;
  }
}

static bool asks_for(const instance *in, const question *q, variable_kind kind, int index) {
  for (size_t i = 0; i < q->nunknown; i++) {
    const variable *v = &in->variables.all[q->unknown[i]];
    if (v->kind == kind && (index < 0 || v->index == index)) return true;
  }
  return false;
}

static void answer(const instance *in, const question *q, const direction *d, const double *da,
                   const double *doutput) {
  double *to = q->sensitivity;
  for (size_t i = 0; i < q->nunknown; i++) {
    const variable *v = &in->variables.all[q->unknown[i]];
    const double *from = v->kind == VARIABLE_OUTPUT ? doutput + v->index
                         : v->index == 0            ? d->v
                                                    : da;
    memcpy(to, from, (size_t)v->size * sizeof *to);
    to += v->size;
  }
}

static corot_status differentiate(instance *in, const question *q) {
  COROT_TRY(check_question(in, q));
  COROT_TRY(instance_slopes(in));
  size_t n = (size_t)corot_model_ndof(in->body.model), nload = (size_t)in->body.used.ninput;
  size_t noutput = (size_t)in->variables.noutput;
  double *room = calloc(3 * n + nload + noutput + 1, sizeof *room);
  if (!room) return no_memory();
  direction d = {.u = room, .v = room + n, .load = room + 2 * n};
  double *da = d.load + nload, *doutput = da + n;
  find_direction(in, q, &d);
  corot_status status = COROT_OK;
  if (asks_for(in, q, VARIABLE_SLOPE, 1)) status = slopes_change(&in->slopes, &in->now, &d, da);
  if (!status && asks_for(in, q, VARIABLE_OUTPUT, -1)) {
    in->seen = false;
    status = slopes_of_outputs(&in->slopes, &in->sight, &in->now, &d, doutput);
  }
  if (!status) answer(in, q, &d, da, doutput);
  free(room);
  return status;
}

fmi3Status fmi3GetDirectionalDerivative(fmi3Instance instance_, const fmi3ValueReference unknown[],
                                        size_t nunknown, const fmi3ValueReference known[],
                                        size_t nknown, const fmi3Float64 seed[], size_t nseed,
                                        fmi3Float64 sensitivity[], size_t nsensitivity) {
  const question q = {unknown, known, nunknown, nknown, seed, sensitivity, nseed, nsensitivity};
  FMI3_CALL(instance_, INITIALIZATION | EVENT | CONTINUOUS | TERMINATED, differentiate(in, &q));
}
