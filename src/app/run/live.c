/* Windows of inputs, from one of their points to the next. */
#include "live.h"

#include <stdlib.h>

#include "app/text/no_memory.h"

struct live {
  const scenario *scenario;
  corot_inputs *inputs; /* NULL: there are none */
  int *window;          /* [ninput] the last point that was reached; -1: none */
};

void live_destroy(live *l) {
  if (!l) return;
  corot_inputs_destroy(l->inputs);
  free(l->window);
  free(l);
}

corot_inputs *live_inputs(const live *l) { return l->inputs; }

int live_times(const live *l, double end, int max, double *time) {
  int n = 0;
  for (int i = 0; i < l->scenario->ninput; i++) {
    const corot_amplitude *a = &l->scenario->input[i].values;
    for (int k = 0; k < a->n; k++) {
      if (!(a->time[k] > 0 && a->time[k] < end)) continue;
      if (n < max) time[n] = a->time[k];
      n++;
    }
  }
  return n;
}

/* The last point at t or before it, from an earlier one on; -1: the first comes later. */
static int go_on(const corot_amplitude *a, int k, double t) {
  while (k + 1 < a->n && a->time[k + 1] <= t) k++;
  return k;
}

static corot_status enter_window(corot_inputs *inputs, const input_def *in, int k) {
  const corot_amplitude *a = &in->values;
  double value = a->value[k < 0 ? 0 : k];
  if (in->of == INPUT_MATERIAL)
    return corot_inputs_set_material(inputs, in->index,
                                     &(corot_material_factors){value, value, value, value});
  if (k < 0 || k + 1 == a->n) return corot_inputs_set_load(inputs, in->index, value);
  return corot_inputs_ramp_load(inputs, in->index, a->time[k], value, a->time[k + 1],
                                a->value[k + 1]);
}

static corot_status enter(live *l, double t, bool first, bool *changed) {
  *changed = false;
  for (int i = 0; i < l->scenario->ninput; i++) {
    const input_def *in = &l->scenario->input[i];
    int k = go_on(&in->values, l->window[i], t);
    if (k == l->window[i] && !first) continue;
    corot_status status = enter_window(l->inputs, in, k);
    if (status == COROT_ENOMEM) return status;
    if (status) return corot_fail(status, "inputs.%s: %s", in->name, corot_error());
    l->window[i] = k;
    *changed = true;
  }
  return COROT_OK;
}

corot_status live_enter(live *l, double t, bool *changed) { return enter(l, t, false, changed); }

void live_exchange(pack *p, live *l) {
  for (int i = 0; i < l->scenario->ninput; i++) corot_pack_int(p, &l->window[i]);
}

corot_status live_create(const scenario *s, const corot_model *model, double t, live **out) {
  bool changed;
  live *l = calloc(1, sizeof *l);
  if (!l) return no_memory();
  l->scenario = s;
  l->window = calloc((size_t)s->ninput + 1, sizeof *l->window);
  for (int i = 0; l->window && i < s->ninput; i++) l->window[i] = -1;
  corot_status status = l->window ? COROT_OK : no_memory();
  if (!status && s->ninput) status = corot_inputs_create(model, &l->inputs);
  if (!status) status = enter(l, t, true, &changed);
  if (status)
    live_destroy(l);
  else
    *out = l;
  return status;
}
